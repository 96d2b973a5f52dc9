// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/forced/elements.hpp"
#include "revchain/simd/pack.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// The requested pins, and scratch for the ratios between them.
struct DrivenPins {
    std::vector<std::size_t> pins;  ///< ascending, all below the moved end
    std::vector<double> ratio{};
};

namespace detail {

template <bool fused, class V>
[[gnu::always_inline]] inline DoubleWord<V> product(const DoubleWord<V>& x,
                                                    const DoubleWord<V>& y) {
    const DoubleWord<V> p = two_product<fused>(x.high, y.high);
    return fast_two_sum(p.high, p.low + (x.high * y.low + x.low * y.high));
}
template <bool fused, class V>
[[gnu::always_inline]] inline DoubleWord<V> quotient(const DoubleWord<V>& x,
                                                     const DoubleWord<V>& y) {
    const V q = x.high / y.high;
    const DoubleWord<V> p = two_product<fused>(y.high, q);
    const DoubleWord<V> r = fast_two_sum(p.high, p.low + y.low * q);
    return fast_two_sum(q, ((x.high - r.high) + (x.low - r.low)) / y.high);
}

/// The state carried up for the drives in one pack.
template <class V>
struct DrivenWalk {
    DoubleWord<V> height, spin, below, product;
    V error;  ///< error of `below`
    V row;    ///< the part of `error` from the last element
    V doubt;  ///< sum of the relative errors of the ratios
    typename V::Mask proved, negative, turned;
};

/// Numbers for a pin's sharper bound: y over y above, 1 over the pivot, errors of the row and of D.
template <class V>
struct DrivenRow {
    V ratio, inverse, row, below;
    static constexpr std::size_t stored = 4;
};

template <class V>
[[gnu::always_inline]] inline void start(DrivenWalk<V>& w, const Driving* at) {
    for (std::size_t i = 0; i < V::size; ++i) {
        w.height.high.set(i, at[i].height.high), w.height.low.set(i, at[i].height.low);
        w.spin.high.set(i, at[i].spin.high), w.spin.low.set(i, at[i].spin.low);
    }
    w.proved = typename V::Mask(-1);
}

template <bool turning, bool fused, class V>
[[gnu::always_inline]] inline void rise(const SignedElement<Wide<double>>& e, bool kept,
                                        DrivenWalk<V>& w, DrivenRow<V>* row) {
    constexpr double unit = operation_error<Wide<double>>();
    const DoubleWord<V> k = in_all_lanes<V>(e.stiffness), mass = in_all_lanes<V>(e.lower);
    DoubleWord<V> stiffness = product<fused>(w.height, k);
    V size = abs(stiffness.high);
    if constexpr (turning) {
        const DoubleWord<V> added = product<fused>(w.spin, in_all_lanes<V>(e.spin));
        stiffness = stiffness + added;
        size = size + abs(added.high);
    }
    const DoubleWord<V> pivot = (w.below - mass) + stiffness;
    const DoubleWord<V> coupling = stiffness + in_all_lanes<V>(e.cross);
    const DoubleWord<V> ratio = quotient<fused>(coupling, pivot);
    const DoubleWord<V> carried =
        (stiffness - in_all_lanes<V>(e.upper)) - product<fused>(coupling, ratio);

    constexpr double tiny = 0x1p-960;
    const V of_stiffness = w.height.high * V(e.error.stiffness) + V(12 * unit) * size + V(tiny);
    const V coupled = of_stiffness + V(e.error.cross + 12 * unit * std::abs(e.cross.high));
    const V local = of_stiffness + V(e.error.lower + 12 * unit * std::abs(e.lower.high)) +
                    V(12 * unit) * abs(w.below.high);
    const V above = of_stiffness + V(e.error.upper + 12 * unit * std::abs(e.upper.high));
    const V gain = abs(coupling.high) * V(1 + 0x1p-50) + coupled;
    const V least = abs(pivot.high) * V(1 - 0x1p-50) - (local + w.error);
    const V inverse = V(1.0) / least;
    const V ratio_size = abs(ratio.high);
    const V inherited = inverse * (local + w.error);
    w.proved = w.proved & (V(0.0) < least) & (coupled < V(0x1p-80) * abs(coupling.high));
    w.doubt = w.doubt + (inherited + V(4 * unit + 0x1p-80));
    const V own = above + coupled * ratio_size * V(2.0) +
                  V(8 * unit) * (abs(carried.high) + gain * ratio_size);
    if (row != nullptr)
        *row = {
            ratio.high, V(1.0) / pivot.high,
            w.row + local + V(8 * unit) * abs(pivot.high) + coupled * V(1 + 0x1p-40) / ratio_size,
            w.error};
    w.row = own;
    w.error = V(1 + 0x1p-46) * (gain * (ratio_size * inherited + inverse * coupled) + own);
    w.below = carried;
    w.negative = w.negative + differ_in_sign(pivot.high, V(1.0));
    w.turned = w.turned + differ_in_sign(ratio.high, V(1.0));
    w.product = kept ? ratio : product<fused>(w.product, ratio);
}

}  // namespace detail

template <class V>
inline constexpr std::size_t driven_together = 2 * V::size;
inline constexpr std::size_t most_driven_together = 2 * most_doubles;

/// Computes `driven` for `driven_together` drives, one in a SIMD lane, in words of two doubles,
/// with a running bound like that of `certified_count`. All elements are in one unit. Drives near a
/// resonance, or with a pin nearly a node, are left undecided. Calls `offset(lane, which, value)`
/// for each requested pin, highest first. The bound is the relative error of the value. Cost:
/// `bench_response`.
template <bool turning, bool fused, class V, class Offsets>
[[gnu::always_inline]] inline void driven_lanes(
    const std::vector<SignedElement<Wide<double>>>& elements, const Driving* at, DrivenPins& wanted,
    Driven* result, const Offsets& offset) {
    constexpr std::size_t P = 2, L = V::size;
    detail::DrivenWalk<V> walks[P];
    for (std::size_t p = 0; p < P; ++p) detail::start(walks[p], at + p * L);
    const std::size_t n = elements.size(), count = wanted.pins.size();
    wanted.ratio.resize(std::max(wanted.ratio.size(), count * 2 * P * L));
    double* const ratios = wanted.ratio.data();
    std::size_t next = 0;  // the index of the next requested pin
    const auto put_away = [&](std::size_t which) REVCHAIN_INLINED {
        for (std::size_t p = 0; p < P; ++p) {
            walks[p].product.high.store(ratios + (which * P + p) * 2 * L);
            walks[p].product.low.store(ratios + (which * P + p) * 2 * L + L);
        }
    };
    for (std::size_t m = 0; m < n; ++m) {
        const bool kept = m == 0 || (next < count && wanted.pins[next] == m);
        if (kept && m > 0 && next > 0) put_away(next - 1);
        if (next < count && wanted.pins[next] == m) ++next;
#pragma GCC unroll 2
        for (std::size_t p = 0; p < P; ++p)
            detail::rise<turning, fused>(elements[m], kept, walks[p],
                                         static_cast<detail::DrivenRow<V>*>(nullptr));
    }
    if (count > 0) put_away(count - 1);
    DoubleWord<V> y[P];
    for (std::size_t p = 0; p < P; ++p) y[p] = DoubleWord<V>(V(1.0));
    typename V::Mask finite[P];
    for (std::size_t p = 0; p < P; ++p) finite[p] = typename V::Mask(-1);
    for (std::size_t which = count; which-- > 0;)
        for (std::size_t p = 0; p < P; ++p) {
            const double* from = ratios + (which * P + p) * 2 * L;
            y[p] = detail::product<fused>(y[p], DoubleWord<V>(V::load(from), V::load(from + L)));
            finite[p] = finite[p] & (abs(y[p].high) < V(std::numeric_limits<double>::max()));
            for (std::size_t i = 0; i < L; ++i)
                offset(p * L + i, which, Wide<double>(y[p].high[i], y[p].low[i]));
        }
    for (std::size_t p = 0; p < P; ++p)
        for (std::size_t i = 0; i < L; ++i) {
            const auto& w = walks[p];
            Driven& r = result[p * L + i];
            const double doubt = w.doubt[i];
            r.decided = w.proved[i] != 0 && finite[p][i] != 0 && doubt < 0x1p-10;
            r.error_bound = doubt * (1 + doubt) * (1 + 0x1p-20);
            r.reversed = w.turned[i] % 2 != 0;
            r.negative = static_cast<Index>(w.negative[i]);
            r.stiffness = w.below.high[i];
            r.stiffness_error = w.error[i] + 0x1p-52 * std::abs(r.stiffness);
        }
}

/// Computes sharper bounds for drives that `driven_lanes` decided. They are of first order in the
/// errors, and rigorous by the known bounds of ratios and pivots. Let G = (height K - M)^-1 with
/// the moved end held. Its diagonal g follows from the top down by  g = 1/p + (y/y')^2 g'.  Let r
/// be the error of each row over its offset, and E the error of D, which contains the rows below.
/// Then
///
///     |error of y_i| <= |y_i| (sum over j >= i of |g_j| r_j  +  |g_i| E_i).
///
/// A coupling's error enters the row of its lower pin by the offset of the upper one. `end` is as
/// for `driven`. The errors of ratios that `driven_lanes` adds up count both sides of a node twice,
/// without signs. Cost: about that of `driven_lanes` and four numbers an element.
template <bool turning, bool fused, class V>
[[gnu::always_inline]] inline void sharpen(const std::vector<SignedElement<Wide<double>>>& elements,
                                           const Driving* at, Driven* result,
                                           std::vector<double>& scratch, double end = 1) {
    constexpr std::size_t P = 2, L = V::size, stored = detail::DrivenRow<V>::stored;
    detail::DrivenWalk<V> walks[P];
    for (std::size_t p = 0; p < P; ++p) detail::start(walks[p], at + p * L);
    const std::size_t n = elements.size();
    scratch.resize(std::max(scratch.size(), n * P * stored * L));
    for (std::size_t m = 0; m < n; ++m) {
#pragma GCC unroll 2
        for (std::size_t p = 0; p < P; ++p) {
            detail::DrivenRow<V> row;
            detail::rise<turning, fused>(elements[m], true, walks[p], &row);
            double* const to = scratch.data() + (m * P + p) * stored * L;
            row.ratio.store(to), row.inverse.store(to + L), row.row.store(to + 2 * L),
                row.below.store(to + 3 * L);
        }
    }
    for (std::size_t p = 0; p < P; ++p) {
        const V known = V(4.0) * walks[p].doubt + V(0x1p-48);  // of squared ratios and pivots
        V y(1.0), largest(end), g(0.0), slack(0.0), sum(0.0), worst(0.0);
        for (std::size_t m = n; m-- > 0;) {
            const double* from = scratch.data() + (m * P + p) * stored * L;
            const V ratio = V::load(from), inverse = V::load(from + L), row = V::load(from + 2 * L);
            const V below = V::load(from + 3 * L), square = ratio * ratio;
            y = y * abs(ratio);
            slack = V(1 + 0x1p-40) * (V(1.0) + known) *
                    (square * slack + known * (abs(inverse) + square * abs(g)));
            g = inverse + square * g;
            const V size = abs(g) + slack;
            sum = sum + size * row;
            worst = max(worst, y * (sum + size * below));
            largest = max(largest, y);
        }
        const V multiplied(static_cast<double>(n) * 8 * operation_error<Wide<double>>());
        const V bound =
            (worst / largest) * (V(1.0) + V(4.0) * walks[p].doubt) * V(1 + 0x1p-20) + multiplied;
        for (std::size_t i = 0; i < L; ++i)
            if (bound[i] < result[p * L + i].error_bound) result[p * L + i].error_bound = bound[i];
    }
}

}  // namespace revchain::pencil
