// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "revchain/pencil/batch/links.hpp"
#include "revchain/pencil/batch/quotients.hpp"
#include "revchain/pencil/batch/zeros.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// Where the first approximations come from. With the recurrence alone all modes of 10 links took
/// 2.5 times as long, of 16 3 times. Chains one by one, by `modes`, take 2.2 to 2.8 times as long
/// as the recurrence for 17 links, 1.2 to 1.5 times for 100.
enum class LaneMethod {
    coefficients,  ///< zeros of the polynomial written out, deflated: cheapest up to 16 links
    recurrence,    ///< zeros of the recurrence, known ones divided out: any number of links
};

namespace detail {

/// Squared residual of a shape that will do: the quotient's relative error is at most this over the relative gap.
inline constexpr double negligible_imbalance = 1e-18;

/// `modes_below` at two points side by side, which as one loop over an array of points took 1.3 times as long (rods).
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
        below += differ_in_sign(before, y);
        above += differ_in_sign(behind, z);
        if (rescaled_after(m)) {
            rescale(y, f);
            rescale(z, g);
        }
    }
    const V huge(0x1p1000);  // what is no number is below nothing
    return (below == typename V::Mask(i)) & (above == typename V::Mask(i + 1)) & (abs(y) < huge) & (abs(z) < huge);
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
        typename V::Mask active(-1);
        for (int round = 0; round < 4 && any(active); ++round) {
            const LaneQuotient<V> q = written_out ? quotient(links, mu) : twisted_quotient(links, mu, shapes);
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
    for (std::size_t j = 0; j < V::size; ++j) verified[lane + static_cast<std::ptrdiff_t>(j)] = good[j];
}

}  // namespace detail

/// Numbers of scratch that `lane_spectrum` takes.
inline std::size_t lane_work(std::ptrdiff_t size) {
    return static_cast<std::size_t>((RigidLanes<Pack<double>>::stored + 5) * size * block_lanes);
}

/// The `count` largest conical heights of each of `block_lanes` chains, descending: height[j * block_lanes + i], in the
/// unit of the lengths. Where `verified[i]` is not 0, counts in double at both ends of every
/// interval of a relative 16 + size/4 ulp around chain i's heights say that it holds the mode of that number and no
/// other; elsewhere nothing is known of them.
///
/// Preconditions: weights, lengths and centroids positive and finite, radii of gyration not negative, pendulum lengths
/// at least the centroid; 1 <= count <= size; size <= 16 for LaneMethod::coefficients.
///
/// A recurrence of its own beside that of `aberth_spectrum`: there the shifts of one chain lie side by side, here
/// chains, which takes a third of the time for all modes of 10 links (as long for 40). The lumped masses of that
/// recurrence would not do here: they cancel where centroids lie below their links.
///
/// First approximations by Laguerre's iteration from the left, in y at the support as a polynomial in mu = 1/lambda,
/// known zeros divided out; then the Rayleigh quotient of the shape there, whose error is the square of the shape's.
/// What a lane computes depends on its own numbers alone (finished lanes stand still while others go on), so results
/// are bitwise the same wherever a chain stands; another kind of processor may change last digits.
inline void lane_spectrum(const LaneBlock& block, std::ptrdiff_t count, LaneMethod method, double* work, double* height,
                          std::int64_t* verified) {
    simd([&](auto registers) REVCHAIN_INLINED {
        // Eight doubles to a register were slower than four (N = 10, Zen 4).
        using V = Pack<double, std::min(registers.doubles, pack_size), 4>;
        for (std::ptrdiff_t lane = 0; lane < block_lanes; lane += static_cast<std::ptrdiff_t>(V::size)) {
            if (block.centroid == nullptr) {
                detail::spectrum<V, PlummetLanes>(block, count, method, lane, work, height, verified);
            } else {
                detail::spectrum<V, RigidLanes>(block, count, method, lane, work, height, verified);
            }
        }
    });
}

}  // namespace revchain::pencil
