// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>

#include "revchain/linalg/lane_links.hpp"

namespace revchain::linalg {

/// Where the first approximations come from.
enum class LaneMethod {
    coefficients,  ///< zeros of the polynomial written out, deflated: cheapest up to 16 links
    recurrence,    ///< zeros of the recurrence, known ones divided out: any number of links
};

namespace detail {

/// Laguerre's iteration ends with a step of this relative size: the error left is about its cube.
inline constexpr double last_step = 2e-4;
/// Squared residual of a shape that will do: the quotient's relative error is at most this over the relative gap.
inline constexpr double negligible_imbalance = 1e-18;

/// y at the support with its derivatives, times a power of two.
template <class V, class Links>
[[gnu::always_inline]] inline LaneTaylor<V> taylor(const Links& links, const V& x) {
    LaneTaylor<V> y{V(1.0), V(0.0), V(0.0)}, f{V(0.0), V(0.0), V(0.0)};
    for (std::ptrdiff_t m = 0; m < links.size(); ++m) {
        links.rise(m, x, y, f);
        if (rescaled_after(m)) rescale(y, f);
    }
    return y;
}

/// How many modes lie below x (Sturm): changes of sign of y from pin to pin.
template <class V, class Links>
[[gnu::always_inline]] inline typename V::Mask modes_below(const Links& links, const V& x) {
    V y(1.0), f(0.0);
    typename V::Mask changes{};
    for (std::ptrdiff_t m = 0; m < links.size(); ++m) {
        const V below = y;
        links.rise(m, x, y, f);
        count_change(changes, below, y);
        if (rescaled_after(m)) rescale(y, f);
    }
    return changes;
}

/// Rayleigh quotient stiffness / inertia of a shape; `imbalance` is its squared residual, relative to the quotient.
template <class V>
struct LaneQuotient {
    V stiffness, inertia, imbalance;
};

/// Of a shape that is out of balance by `force` at one pin, which bears `mass`.
template <class V>
[[gnu::always_inline]] inline LaneQuotient<V> quotient_of(const V& stiffness, const V& inertia, const V& force,
                                                          const V& mass) {
    return {stiffness, inertia, force * force * inertia / (mass * (stiffness * stiffness))};
}

/// Of the shape carried from the free end to the topmost pin but the support.
template <class V, class Links>
[[gnu::always_inline]] inline LaneQuotient<V> quotient(const Links& links, const V& x) {
    LaneShape<V> s(1.0, 0.0);
    const std::ptrdiff_t top = links.size() - 1;
    for (std::ptrdiff_t m = 0; m < top; ++m) {
        links.rise(m, x, s);
        tidy(m, s);
    }
    const V k = links.stiffness(top), mass = links.lower_mass(top);
    return quotient_of(((k * s.offset) * s.offset + s.stiffness) + s.earlier_stiffness,
                       ((mass * s.offset) * s.offset + s.inertia) + s.earlier_inertia,
                       s.force - x * (mass * s.offset) + k * s.offset, mass);
}

/// Of the shape carried from both ends to the pin where they meet best: for modes that live low in the chain, which
/// carried on upwards would grow from rounding alone. `work`: 4 * size * block_lanes numbers.
template <class V, class Links>
[[gnu::always_inline]] inline LaneQuotient<V> twisted_quotient(const Links& links, const V& x, double* work) {
    LaneShape<V> s(1.0, 0.0);
    for (std::ptrdiff_t m = 0; m < links.size(); ++m) {
        double* const here = work + 4 * m * block_lanes;
        store(here, s.offset);
        store(here + block_lanes, s.force);
        store(here + 2 * block_lanes, s.inertia + s.earlier_inertia);
        store(here + 3 * block_lanes, s.stiffness + s.earlier_stiffness);
        links.rise(m, x, s);
        tidy(m, s);
    }
    LaneShape<V> t(0.0, 1.0);
    LaneQuotient<V> best{V(0.0), V(0.0), V(std::numeric_limits<double>::infinity())};
    for (std::ptrdiff_t m = links.size(); m-- > 0;) {
        links.descend(m, x, t);
        tidy(m, t);
        const double* const here = work + 4 * m * block_lanes;
        const V up = V(1.0) / load<V>(here), down = V(1.0) / t.offset;
        const V mass = m == 0 ? links.lower_mass(m) : links.lower_mass(m) + links.upper_mass(m - 1);
        const LaneQuotient<V> q =
            quotient_of(load<V>(here + 3 * block_lanes) * up * up + (t.stiffness + t.earlier_stiffness) * down * down,
                        load<V>(here + 2 * block_lanes) * up * up + (t.inertia + t.earlier_inertia) * down * down,
                        load<V>(here + block_lanes) * up + t.force * down, mass);
        const auto better = q.imbalance < best.imbalance;
        best.stiffness = select(better, q.stiffness, best.stiffness);
        best.inertia = select(better, q.inertia, best.inertia);
        best.imbalance = select(better, q.imbalance, best.imbalance);
    }
    return best;
}

/// Laguerre's step towards the next of `left` zeros: from the left of all of them it never passes the first.
template <class V>
[[gnu::always_inline]] inline V laguerre_step(const V& value, const V& slope, const V& square, std::ptrdiff_t left) {
    const V n(static_cast<double>(left)), rest(static_cast<double>(left - 1));
    V under = rest * square;
    under = select(under < V(0.0), V(0.0), under);
    const V root = rough_sqrt(under);
    const V step = n * value / (slope + select(slope < V(0.0), -root, root));
    return select(abs(step) < V(0x1p1000), step, V(0.0));  // none where x is a zero to the last digit
}

/// A zero of c[0] + ... + c[degree] x^degree near its smallest, from x at its left, to about 1e-10; divides it out.
template <class V>
[[gnu::always_inline]] inline V next_zero(V* c, std::ptrdiff_t degree, const V& from) {
    V x = from;
    typename V::Mask active = V(0.0) < V(1.0);
    for (int round = 0; round < 12 && any(active); ++round) {
        V value = c[degree], slope(0.0), curvature(0.0);
        for (std::ptrdiff_t j = degree; j-- > 0;) {
            curvature = curvature * x + slope;
            slope = slope * x + value;
            value = value * x + c[j];
        }
        const V n(static_cast<double>(degree)), rest(static_cast<double>(degree - 1));
        const V step = laguerre_step(value, slope, rest * (slope * slope) - (n + n) * (value * curvature), degree);
        x = select(active, x - step, x);
        active = both(active, V(last_step) * abs(x) < abs(step));  // the last step's error is about its cube
    }
    V carried = c[degree];
    for (std::ptrdiff_t j = degree; j-- > 0;) {
        const V old = c[j];
        c[j] = carried;
        carried = carried * x + old;
    }
    return x;
}

/// A point to the right of the last of `count` known zeros and, by count, to the left of the next; far enough from the
/// known one that dividing it out does not cancel.
template <class V, class Links>
[[gnu::always_inline]] inline V between_zeros(const Links& links, const double* known, std::ptrdiff_t count) {
    if (count == 0) return V(0.0);
    const V last = load<V>(known + (count - 1) * block_lanes);
    V ahead = last * V(0x1p-3);
    if (count > 1) {
        const V gap = last - load<V>(known + (count - 2) * block_lanes);
        ahead = select(ahead < gap, gap, ahead);
    }
    typename V::Mask active = V(0.0) < V(1.0);
    V x = last;
    for (int round = 0; round < 4 && any(active); ++round) {
        ahead = ahead * V(0x1p-7);
        x = select(active, last + ahead, x);
        active = both(active, above(modes_below(links, x), count));
    }
    return x;
}

/// The same for the recurrence; the `known` zeros found so far are divided out.
template <class V, class Links>
[[gnu::always_inline]] inline V next_zero(const Links& links, const double* known, std::ptrdiff_t count) {
    const std::ptrdiff_t left = links.size() - count;
    V x = between_zeros<V>(links, known, count);
    typename V::Mask active = V(0.0) < V(1.0);
    for (int round = 0; round < 40 && any(active); ++round) {
        const LaneTaylor<V> p = taylor(links, x);
        const V over = V(1.0) / p.value;
        V slope = p.slope * over;
        V square = slope * slope - V(2.0) * (p.curvature * over);
        for (std::ptrdiff_t j = 0; j < count; ++j) {
            const V pole = V(1.0) / (x - load<V>(known + j * block_lanes));
            slope = slope - pole;
            square = square - pole * pole;
        }
        const V n(static_cast<double>(left));
        const V step = laguerre_step(V(1.0), slope, n * square - slope * slope, left);
        x = select(active, x - step, x);
        active = both(active, V(1e-6) * abs(x) < abs(step));
    }
    return x;
}

/// Whether by count `i` modes lie below `low` and one more below `high`.
template <class V, class Links>
[[gnu::always_inline]] inline typename V::Mask numbered(const Links& links, std::ptrdiff_t i, const V& low,
                                                        const V& high) {
    V y(1.0), f(0.0), z(1.0), g(0.0);
    typename V::Mask below{}, above{};
    for (std::ptrdiff_t m = 0; m < links.size(); ++m) {
        const V before = y, behind = z;
        links.rise(m, low, y, f);
        links.rise(m, high, z, g);
        count_change(below, before, y);
        count_change(above, behind, z);
        if (rescaled_after(m)) {
            rescale(y, f);
            rescale(z, g);
        }
    }
    const V huge(0x1p1000);  // what is no number is below nothing
    return both(both(equals(below, i), equals(above, i + 1)), both(abs(y) < huge, abs(z) < huge));
}

/// The `count` smallest mu of the lanes at `lane`, as heights 1/mu; `verified` where counts prove each of them.
template <class V, template <class> class LinksOf>
[[gnu::always_inline]] inline void spectrum(const LaneBlock& block, std::ptrdiff_t count, LaneMethod method,
                                            std::ptrdiff_t lane, double* work, double* height, std::int64_t* verified) {
    using Links = LinksOf<V>;
    const Links links(block, lane, work);
    double* const found = work + block.size * Links::stored * block_lanes + lane;
    double* const shapes = found + block.size * block_lanes;
    V c[Links::max_polynomial + 1];
    const bool written_out = method == LaneMethod::coefficients;
    if (written_out) links.polynomial(c);
    V x(0.0);
    const V per_length = links.per_length();
    typename V::Mask good = links.ordinary();
    // Well above the count's own error, a tenth of an ulp for each link.
    const V margin((16.0 + 0.25 * static_cast<double>(block.size)) * 0x1p-52);
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        if (written_out) {
            x = next_zero(c, block.size - i, x);
        } else {
            x = next_zero<V>(links, found, i);
        }
        V mu = x, h(0.0);
        typename V::Mask active = V(0.0) < V(1.0);
        for (int round = 0; round < 4 && any(active); ++round) {
            const LaneQuotient<V> q = written_out ? quotient(links, mu) : twisted_quotient(links, mu, shapes);
            mu = select(active, q.stiffness / q.inertia, mu);
            h = select(active, q.inertia / q.stiffness, h);
            // The quotient's error is at most the square of the residual over the relative gap.
            active = both(active, V(negligible_imbalance) < q.imbalance);
        }
        good = both(good, equals(active, 0));
        store(found + i * block_lanes, mu);
        store(height + i * block_lanes + lane, h / per_length);
    }
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        const V mu = load<V>(found + i * block_lanes);
        good = both(good, numbered<V>(links, i, mu - mu * margin, mu + mu * margin));
    }
    store_mask(verified + lane, good);
}

template <class V>
[[gnu::always_inline]] inline void spectrum(const LaneBlock& block, std::ptrdiff_t count, LaneMethod method,
                                            double* work, double* height, std::int64_t* verified) {
    for (std::ptrdiff_t lane = 0; lane < block_lanes; lane += V::width) {
        if (block.centroid == nullptr)
            spectrum<V, PlummetLanes>(block, count, method, lane, work, height, verified);
        else
            spectrum<V, RigidLanes>(block, count, method, lane, work, height, verified);
    }
}

#if defined(__x86_64__)
// The same code in the instructions of newer processors, whatever the program is compiled for. Everything it calls is
// inlined, as it must be: a function compiled for the old ones cannot hold these registers.
[[gnu::target("avx2,fma")]] inline void spectrum_avx2(const LaneBlock& block, std::ptrdiff_t count, LaneMethod method,
                                                      double* work, double* height, std::int64_t* verified) {
    spectrum<Lanes<32, 4>>(block, count, method, work, height, verified);
}
// AVX-512 for its 32 registers: eight doubles to a register were slower than four (N = 10, Zen 4).
[[gnu::target("avx2,fma,avx512f,avx512dq,avx512vl")]] inline void spectrum_avx512(const LaneBlock& block,
                                                                                  std::ptrdiff_t count,
                                                                                  LaneMethod method, double* work,
                                                                                  double* height,
                                                                                  std::int64_t* verified) {
    spectrum<Lanes<32, 4>>(block, count, method, work, height, verified);
}
#endif

}  // namespace detail

/// Numbers of scratch that `lane_spectrum` takes.
inline std::size_t lane_work(std::ptrdiff_t size) {
    return static_cast<std::size_t>((RigidLanes<Lanes<16, 1>>::stored + 5) * size * block_lanes);
}

/// The `count` largest conical heights of each of `block_lanes` chains, descending: height[j * block_lanes + i], in the
/// unit of the lengths. Where `verified[i]` is not 0, counts in double at both ends of every
/// interval of a relative 16 + size/4 ulp around chain i's heights say that it holds the mode of that number and no
/// other; elsewhere nothing is known of them.
///
/// Preconditions: weights, lengths and centroids positive and finite, radii of gyration not negative, pendulum lengths
/// at least the centroid; 1 <= count <= size; size <= 16 for LaneMethod::coefficients.
///
/// First approximations by Laguerre's iteration from the left, in y at the support as a polynomial in mu = 1/lambda,
/// known zeros divided out; then the Rayleigh quotient of the shape there, whose error is the square of the shape's.
/// What a lane computes depends on its own numbers alone (finished lanes stand still while others go on), so results are
/// bitwise the same wherever a chain stands; another kind of processor may change last digits.
inline void lane_spectrum(const LaneBlock& block, std::ptrdiff_t count, LaneMethod method, double* work, double* height,
                          std::int64_t* verified) {
#if defined(__x86_64__)
    static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    static const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                               __builtin_cpu_supports("avx512vl");
    if (avx512) return detail::spectrum_avx512(block, count, method, work, height, verified);
    if (avx2) return detail::spectrum_avx2(block, count, method, work, height, verified);
#endif
    detail::spectrum<Lanes<16, 4>>(block, count, method, work, height, verified);
}

}  // namespace revchain::linalg
