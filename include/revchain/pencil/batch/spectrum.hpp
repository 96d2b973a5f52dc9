// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "revchain/pencil/batch/links.hpp"
#include "revchain/pencil/batch/zeros.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// The method of the first approximations. The recurrence alone took 2.5 times as long for all
/// modes of 10 links, and 3 times for 16. `modes`, one chain at a time, takes 2.2 to 2.8 times as
/// long as the recurrence for 17 links, and 1.2 to 1.5 times for 100.
enum class LaneMethod {
    coefficients,  ///< zeros of the expanded polynomial, deflated: cheapest up to 16 links
    recurrence,    ///< zeros of the recurrence, divided by the known zeros: any number of links
};

namespace detail {

/// A Rayleigh quotient stiffness / inertia. `imbalance` is its squared residual over the quotient.
template <class V>
struct LaneQuotient {
    V stiffness, inertia, imbalance;
};

/// Returns the quotient of a shape with the residual `force` at one pin, whose mass is `mass`.
template <class V>
[[gnu::always_inline]] inline LaneQuotient<V> quotient_of(const V& stiffness, const V& inertia,
                                                          const V& force, const V& mass) {
    return {stiffness, inertia, force * force * inertia / (mass * (stiffness * stiffness))};
}

/// Returns the quotient of the shape carried from the free end to the topmost free pin.
template <class V, class Links>
[[gnu::always_inline]] inline LaneQuotient<V> quotient(const Links& links, const V& x) {
    LaneShape<V> s{1.0, 0.0};
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

/// Returns the quotient of the shape carried from both ends to the pin where they agree best.
/// (Upwards alone, rounding errors of low modes would grow.) `work` holds 4 * size * block_lanes
/// numbers.
template <class V, class Links>
[[gnu::always_inline]] inline LaneQuotient<V> twisted_quotient(const Links& links, const V& x,
                                                               double* work) {
    LaneShape<V> s{1.0, 0.0};
    for (std::ptrdiff_t m = 0; m < links.size(); ++m) {
        double* const here = work + 4 * m * block_lanes;
        s.offset.store(here);
        s.force.store(here + block_lanes);
        (s.inertia + s.earlier_inertia).store(here + 2 * block_lanes);
        (s.stiffness + s.earlier_stiffness).store(here + 3 * block_lanes);
        links.rise(m, x, s);
        tidy(m, s);
    }
    LaneShape<V> t{0.0, 1.0};
    LaneQuotient<V> best{V(0.0), V(0.0), V(std::numeric_limits<double>::infinity())};
    for (std::ptrdiff_t m = links.size(); m-- > 0;) {
        links.descend(m, x, t);
        tidy(m, t);
        const double* const here = work + 4 * m * block_lanes;
        const V up = V(1.0) / V::load(here), down = V(1.0) / t.offset;
        const V mass = m == 0 ? links.lower_mass(m) : links.lower_mass(m) + links.upper_mass(m - 1);
        const LaneQuotient<V> q =
            quotient_of(V::load(here + 3 * block_lanes) * up * up +
                            (t.stiffness + t.earlier_stiffness) * down * down,
                        V::load(here + 2 * block_lanes) * up * up +
                            (t.inertia + t.earlier_inertia) * down * down,
                        V::load(here + block_lanes) * up + t.force * down, mass);
        const auto better = q.imbalance < best.imbalance;
        best.stiffness = select(better, q.stiffness, best.stiffness);
        best.inertia = select(better, q.inertia, best.inertia);
        best.imbalance = select(better, q.imbalance, best.imbalance);
    }
    return best;
}

/// The squared residual that suffices: the quotient's relative error is at most this over the gap.
inline constexpr double negligible_imbalance = 1e-18;

/// Returns true if counts show `i` modes below `low` and one more below `high`. This is
/// `modes_below` at two points; one loop over an array of points took 1.3 times as long (rods).
template <class V, class Links>
[[gnu::always_inline]] inline typename V::Mask numbered(const Links& links, std::ptrdiff_t i,
                                                        const V& low, const V& high) {
    V y(1.0), f(0.0), z(1.0), g(0.0);
    typename V::Mask below{}, above{};
    for (std::ptrdiff_t m = 0; m < links.size(); ++m) {
        const V before = y, behind = z;
        links.rise(m, low, y, f);
        links.rise(m, high, z, g);
        below += differ_in_sign(before, y);
        above += differ_in_sign(behind, z);
        if (rescaled_after(m)) {
            rescale(y, f);
            rescale(z, g);
        }
    }
    const V huge(0x1p1000);  // false for NaN
    return (below == typename V::Mask(i)) & (above == typename V::Mask(i + 1)) & (abs(y) < huge) &
           (abs(z) < huge);
}

/// Computes the `count` least mu from `lane` on, as heights 1/mu; `verified`: counts prove each.
template <class V, template <class> class LinksOf>
[[gnu::always_inline]] inline void spectrum(const LaneBlock& block, std::ptrdiff_t count,
                                            LaneMethod method, std::ptrdiff_t lane, double* work,
                                            double* height, std::int64_t* verified) {
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
    // The margin is well above the count's error, which is a tenth of an ulp for each link.
    const V margin((16.0 + 0.25 * static_cast<double>(block.size)) * 0x1p-52);
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        x = written_out ? next_zero(c, block.size - i, x) : next_zero<V>(links, found, i);
        V mu = x, h(0.0);
        typename V::Mask active(-1);
        for (int round = 0; round < 4 && any(active); ++round) {
            const LaneQuotient<V> q =
                written_out ? quotient(links, mu) : twisted_quotient(links, mu, shapes);
            mu = select(active, q.stiffness / q.inertia, mu);
            h = select(active, q.inertia / q.stiffness, h);
            // The quotient's error is at most the square of the residual over the relative gap.
            active = active & (V(negligible_imbalance) < q.imbalance);
        }
        good = good & ~active;
        mu.store(found + i * block_lanes);
        (h / per_length).store(height + i * block_lanes + lane);
    }
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        const V mu = V::load(found + i * block_lanes);
        good = good & numbered<V>(links, i, mu - mu * margin, mu + mu * margin);
    }
    for (std::size_t j = 0; j < V::size; ++j)
        verified[lane + static_cast<std::ptrdiff_t>(j)] = good[j];
}

}  // namespace detail

/// Returns the number of doubles of scratch that `lane_spectrum` needs.
inline std::size_t lane_work(std::ptrdiff_t size) {
    return static_cast<std::size_t>((RigidLanes<Pack<double>>::stored + 5) * size * block_lanes);
}

/// Computes the `count` largest conical heights of `block_lanes` chains, descending, [j *
/// block_lanes + i], in the unit of the lengths. If `verified[i]` is not 0, counts in double show
/// that the mode of that number, and no other, lies within 16 + size/4 ulp of each height of chain
/// i. If it is 0, nothing is proved.
///
/// Method: Laguerre's iteration from the left on y at the support, a polynomial in mu = 1/lambda,
/// with known zeros divided out. Then the Rayleigh quotient of the shape there, whose error is the
/// square of the shape's. A lane depends on its own numbers alone, so results are bitwise
/// independent of a chain's lane. Another kind of processor may change last digits.
/// `aberth_spectrum` has the shifts of one chain side by side, and this function has chains: a
/// third of the time for all modes of 10 links (as long for 40). The lumped masses used there would
/// cancel where centroids lie below their links. Preconditions: weights, lengths and centroids
/// positive and finite; radii of gyration not negative; pendulum lengths >= centroid; 1 <= count <=
/// size; size <= 16 for `coefficients`.
inline void lane_spectrum(const LaneBlock& block, std::ptrdiff_t count, LaneMethod method,
                          double* work, double* height, std::int64_t* verified) {
    simd([&](auto registers) REVCHAIN_INLINED {
        // Eight doubles in a register were slower than four (N = 10, Zen 4).
        using V = Pack<double, std::min(registers.doubles, pack_size), 4>;
        for (std::ptrdiff_t lane = 0; lane < block_lanes;
             lane += static_cast<std::ptrdiff_t>(V::size)) {
            if (block.centroid == nullptr)
                detail::spectrum<V, PlummetLanes>(block, count, method, lane, work, height,
                                                  verified);
            else
                detail::spectrum<V, RigidLanes>(block, count, method, lane, work, height, verified);
        }
    });
}

}  // namespace revchain::pencil
