// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/spectrum/quotient.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil::spectrum {

/// The results of a twisted vector at a shift mu, to more digits than double: see `Quotient`.
struct FineQuotient {
    double excess = 0;    ///< Rayleigh quotient times mu, less 1
    double error = 0;     ///< bound of its error, with the pencil's error
    double residual = 0;  ///< as in `Quotient`, but evaluated, with a bound of second order
    std::size_t twist = 0;
};

inline constexpr std::size_t fine_packs = 2;

/// A vector as in `Walk`: offset y, and the sum of m y over pins in two words. Rounding residuals
/// are evaluated. With d the difference of the stored offsets, f = mu (sum of m y) - (k + mu X) d
/// of each link is the residual summed over the pins below, and y^T (mu M - K) y = sum of f d.
template <class V>
struct FineWalk {
    V mu, offset, sum, rest;
    V excess, squares, stiffness;  ///< sums of f d, f^2 / k, k d^2
    V forces;                      ///< sum of (force/k)^2 k; with cross masses only
    V offsets;  ///< sum of (1 + mu X/k)^2 k y^2 over the upper pins; with cross masses only
};

template <bool has_cross, bool up, bool fused, class V>
[[gnu::always_inline]] inline void propagate(const LumpedChain& chain, std::size_t begin,
                                             std::size_t end, FineWalk<V>* walk) {
    constexpr std::size_t P = fine_packs;
    FineWalk<V> at[P];
    for (std::size_t p = 0; p < P; ++p) at[p] = walk[p];
    for (std::size_t i = begin; i < end; ++i) {
        const std::size_t m = up ? i : begin + (end - 1 - i);
        const LumpedLink& e = chain.links[m];
        const LumpedRest& rest = chain.rests[m];
#pragma GCC unroll 8
        for (std::size_t p = 0; p < P; ++p) {
            FineWalk<V>& w = at[p];
            const auto pass_pin = [&]() REVCHAIN_INLINED {
                const DoubleWord<V> q = two_product<fused>(V(e.mass), w.offset);
                const DoubleWord<V> total = two_sum(w.sum, up ? q.high : -q.high);
                const V left = q.low + rest.mass * w.offset;
                w.sum = total.high;
                w.rest += up ? total.low + left : total.low - left;
            };
            if (!up) pass_pin();
            const DoubleWord<V> force = two_product<fused>(w.mu, w.sum);
            V stretch = e.flexibility * force.high;
            const V before = w.offset;
            if constexpr (has_cross) {
                const V factor = 1.0 + w.mu * e.cross_ratio;
                w.forces += stretch * force.high;
                stretch = stretch / factor;
                w.offset = up ? before - stretch : before + stretch;
                const V pin = factor * (up ? w.offset : before);
                w.offsets += e.stiffness * (pin * pin);
            } else {
                w.offset = up ? before - stretch : before + stretch;
            }
            const DoubleWord<V> d = up ? two_sum(before, -w.offset) : two_sum(w.offset, -before);
            const DoubleWord<V> spring = two_product<fused>(V(e.stiffness), d.high);
            V f = w.mu * w.rest;
            if constexpr (has_cross) {
                const DoubleWord<V> swung = two_product<fused>(w.mu, d.high);
                const DoubleWord<V> inertia = two_product<fused>(V(rest.cross), swung.high);
                const DoubleWord<V> remains = two_sum(force.high, -spring.high);
                f = (remains.high - inertia.high) +
                    ((remains.low + (force.low - spring.low)) - inertia.low) +
                    (f - ((rest.stiffness * d.high + rest.cross_rest * swung.high) +
                          (rest.cross * swung.low + (e.stiffness + w.mu * rest.cross) * d.low)));
            } else {
                f = (force.high - spring.high) + (force.low - spring.low) +
                    (f - (rest.stiffness * d.high + e.stiffness * d.low));
            }
            w.excess += f * d.high;
            w.squares += e.flexibility * (f * f);
            w.stiffness += spring.high * d.high;
            if (up) pass_pin();
        }
    }
    V size[P], least = std::numeric_limits<double>::infinity(), most;
    for (std::size_t p = 0; p < P; ++p) {
        FineWalk<V>& w = walk[p] = at[p];
        size[p] = max(abs(w.offset), abs(w.mu * w.sum));
        least = min(least, size[p]), most = max(most, size[p]);
    }
    if (!strays(least, most)) return;
    for (std::size_t p = 0; p < P; ++p) {
        FineWalk<V>& w = walk[p];
        const V by = inverse_power(size[p]), square = by * by;
        w.offset *= by, w.sum *= by, w.rest *= by;
        w.excess *= square, w.squares *= square, w.stiffness *= square;
        w.forces *= square, w.offsets *= square;
    }
}

/// Computes `quotients` to twice the digits: the same vector up to rounding, with a residual that
/// includes roundings. Walks join at a pin that `longest`, a power of 2, divides. Accuracy:
/// docs/theory/spectrum.md, "To the last digit". Cost: about three times `quotients`.
template <bool has_cross, bool fused, class V>
[[gnu::always_inline]] inline void fine_quotients(const LumpedChain& chain, const double* shifts,
                                                  std::size_t lowest, std::size_t highest,
                                                  std::size_t longest, FineQuotient* result,
                                                  std::vector<FineWalk<V>>& scratch) {
    constexpr std::size_t P = fine_packs;
    const std::size_t n = chain.size();
    const auto [leg, legs, low, high] =
        legs_of(chain, shifts, P * V::size, lowest, highest, longest);
    scratch.resize((high - low + 1) * P);

    FineWalk<V> walk[P];
    for (std::size_t p = 0; p < P; ++p) {
        walk[p].mu = V::load(shifts + p * V::size);
        walk[p].offset = V(1.0);
        walk[p].sum = V(chain.tip_mass);
        walk[p].rest = V(chain.tip_mass_rest);
    }
    for (std::size_t at = 0; at <= high; ++at) {
        if (at > 0) propagate<has_cross, true, fused>(chain, (at - 1) * leg, at * leg, walk);
        if (at < low) continue;
        for (std::size_t p = 0; p < P; ++p) scratch[(at - low) * P + p] = walk[p];
    }

    FineWalk<V> joined[P];
    V least[P], twist[P];
    for (std::size_t p = 0; p < P; ++p) {
        const V mu = walk[p].mu;
        walk[p] = FineWalk<V>{mu, V(0.0), 1.0 / mu, {}, {}, {}, {}, {}, {}};
        least[p] = V(std::numeric_limits<double>::infinity());
    }
    for (std::size_t at = legs + 1, end = n; at-- > low;) {
        const std::size_t begin = at * leg;
        propagate<has_cross, false, fused>(chain, begin, end, walk);
        end = begin;
        if (at > high) continue;
        const double above = chain.flexibility_above[begin];
        for (std::size_t p = 0; p < P; ++p) {
            const FineWalk<V>&a = scratch[(at - low) * P + p], &b = walk[p];
            FineWalk<V>& j = joined[p];
            // Each vector is scaled by the other's offset, so that they meet.
            const DoubleWord<V> up = two_product<fused>(a.sum, b.offset);
            const DoubleWord<V> down = two_product<fused>(b.sum, a.offset);
            const V gap = b.mu * ((up.high - down.high) +
                                  ((up.low - down.low) + (a.rest * b.offset - b.rest * a.offset)));
            const V scale_up = b.offset * b.offset, scale_down = a.offset * a.offset;
            const V energy = a.stiffness * scale_up + b.stiffness * scale_down;
            const V square = gap * gap * above / energy;
            const auto better = square < least[p];  // false for a NaN: no twist at a node
            const auto take = [&](V& to, const V& from_up, const V& from_down) REVCHAIN_INLINED {
                to = select(better, from_up * scale_up + from_down * scale_down, to);
            };
            least[p] = select(better, square, least[p]);
            twist[p] = select(better, V(static_cast<double>(begin)), twist[p]);
            take(j.stiffness, a.stiffness, b.stiffness);
            take(j.squares, a.squares, b.squares);
            if constexpr (has_cross) {
                take(j.forces, a.forces, b.forces);
                take(j.offsets, a.offsets, b.offsets);
            }
            take(j.excess, a.excess, b.excess);
            j.excess = select(better, j.excess + gap * (a.offset * b.offset), j.excess);
        }
    }
    for (std::size_t p = 0; p < P; ++p)
        for (std::size_t i = 0; i < V::size; ++i) {
            const double mu = shifts[p * V::size + i], energy = joined[p].stiffness[i];
            const double rounding = vector_rounding<has_cross>(
                chain, mu, joined[p].forces[i] / energy, joined[p].offsets[i] / energy);
            const double sums = 8 * epsilon<double>() * (static_cast<double>(n) + 16);
            const double second = rounding * (sums + 2 * chain.data_error / epsilon<double>());
            const double evaluated =
                std::sqrt(joined[p].squares[i] / energy) + std::sqrt(least[p][i]);
            const double residual = evaluated * (1 + 0x1p-20) + second;
            // This is at least mu X d^2 over |y|^2.
            const double swung = has_cross ? std::sqrt(joined[p].forces[i] / energy) : 1.0;
            const double data = chain.data_error * (3 + 3 * swung);
            const double error = second + sums * residual + data;
            const bool good =
                rounding < 0x1p-10 && residual < 0x1p-10 && energy > 0x1p-900 && energy < 0x1p1000;
            result[p * V::size + i] = {joined[p].excess[i] / energy, error,
                                       good ? residual : std::numeric_limits<double>::infinity(),
                                       static_cast<std::size_t>(twist[p][i])};
        }
}

inline std::vector<FineQuotient> fine_quotients_all(const LumpedChain& chain,
                                                    const std::vector<double>& shifts,
                                                    const std::vector<std::size_t>& places,
                                                    std::size_t longest = longest_leg) {
    return in_packs<FineQuotient, fine_packs>(
        chain, shifts, places,
        [&](auto registers, auto has_cross, const double* some, std::size_t lowest,
            std::size_t highest, FineQuotient* found) REVCHAIN_INLINED {
            std::vector<FineWalk<Pack<double, registers.doubles>>> scratch;
            fine_quotients<has_cross.value, registers.fused>(chain, some, lowest, highest, longest,
                                                             found, scratch);
        });
}

}  // namespace revchain::pencil::spectrum
