// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include "revchain/finite/balance/link_equation.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/simd/interval_lanes.hpp"

/// Solves the equation of one link for several loads at once, in packs (for balance/taylor.hpp).
namespace revchain::inline REVCHAIN_BUILD::finite {

/// Define `any` and `if_less` for numbers, so that templates can use numbers and packs alike.
REVCHAIN_LAZY
bool any(bool yes) { return yes; }
template <Real T>
const T& if_less(const T& x, const T& y, const T& a, const T& b) {
    return x < y ? a : b;
}

/// Returns the link copied to every lane of a pack; for a number type, the link itself.
template <class T>
[[gnu::always_inline]] inline decltype(auto) in_lanes(const Link<Interval<Lane<T>>>& link) {
    if constexpr (IsPack<T>) {
        const auto spread = [](const Interval<Lane<T>>& x)
                                REVCHAIN_INLINED { return Interval<T>(T(x.low), T(x.high)); };
        return Link<Interval<T>>{spread(link.length), spread(link.pull), spread(link.cross),
                                 spread(link.moment), spread(link.rest)};
    } else {
        return (link);
    }
}

template <IsPack V>
struct Sine<V> {
    Interval<V> value, slope, half_bend;

    [[gnu::always_inline]] explicit Sine(const Interval<V>& t) {
        const V zero(0), one(1);
        const std::array<Interval<V>, 2> end{Interval<V>(t.low), Interval<V>(t.high)};
        std::array<Interval<V>, 2> sine, cube, bend;
        for (std::size_t i = 0; i < 2; ++i) {
            const Interval<V> cosine = Interval<V>(one) / sqrt(Interval<V>(one) + square(end[i])),
                              squared = square(cosine);
            sine[i] = end[i] * cosine, cube[i] = cosine * squared,
            bend[i] = sine[i] * square(squared);
        }
        value = {sine[0].low, sine[1].high};
        slope = hull(cube[0], cube[1]), half_bend = hull(bend[0], bend[1]);
        slope.high = if_less(t.low, zero, if_less(zero, t.high, one, slope.high), slope.high);
        const V half(0.5), turning(steepest_half_bend);
        half_bend.high =
            if_less(half, t.low, half_bend.high, if_less(t.high, half, half_bend.high, turning));
        half_bend.low =
            if_less(-half, t.low, half_bend.low, if_less(t.high, -half, half_bend.low, -turning));
    }
};

/// Encloses the tangents under the loads R; NaN if no bounds are found. From t, Newton's result,
/// each end is the first of t, t + step, t + 3 step, ... with a load certainly beyond R.
template <IsPack V>
[[gnu::always_inline]] inline Interval<V> tangent_of(const Interval<V>& stiffness,
                                                     const Interval<V>& turning,
                                                     const Interval<V>& R) {
    using T = Lane<V>;
    const V zero(0), one(1), twist = turning.middle();
    const std::array<V, 2> wanted{-R.low, R.high};  // the load is odd in t; both are upper ends
    std::array<V, 2> above;
    for (std::size_t end = 0; end < 2; ++end) {
        const V k = if_less(wanted[end], zero, stiffness.high, stiffness.low);
        V t = wanted[end] / if_less(zero, twist, k + twist, k);
        for (int round = 0; round < 100; ++round) {
            const V cosine = one / root(one + t * t);
            const V step =
                (wanted[end] - k * t - twist * t * cosine) / (k + twist * cosine * cosine * cosine);
            t = t + step;
            if (!any(V(T(4) * epsilon<T>()) * abs(t) < abs(step))) break;
        }
        V step = V(T(2) * epsilon<T>()) * abs(t) + V(std::numeric_limits<T>::denorm_min());
        V found(std::numeric_limits<T>::quiet_NaN());
        for (int round = 0; round < 41; ++round, t = t + step, step = step + step) {
            const V load =
                (stiffness * Interval<V>(t) + turning * Sine<V>(Interval<V>(t)).value).low;
            const auto first = ~equal(found, found) & ~(load < wanted[end]) & equal(load, load);
            found = select(first, t, found);
            if (!any(~equal(found, found))) break;
        }
        above[end] = found;
    }
    return {-above[0], above[1]};
}

}  // namespace revchain::finite
