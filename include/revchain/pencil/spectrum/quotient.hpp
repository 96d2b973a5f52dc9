// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/spectrum/lumped_chain.hpp"
#include "revchain/simd/pack.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil::spectrum {

/// The results of a twisted vector at a shift mu = 1/lambda.
struct Quotient {
    double ratio = 0;       ///< Rayleigh quotient times mu: 1 at an eigenvalue
    double residual = 0;    ///< bound on |(mu M - K) y| in the norm of K^-1 over |y| in that of K
    double rounding = 0;    ///< the part of `residual` due to rounding
    std::size_t twist = 0;  ///< links below the pin where the walks were joined
};

/// The number of packs of shifts walked together. The quotients of `proved_roots` take 2.4 to 6
/// times as long; with them all modes of 300 links took 1.2 to 1.5 times as long, of 1000 1.6 to
/// 2.2 times.
inline constexpr std::size_t quotient_packs = 4;

/// Vectors from one end, one for each shift of a pack: offset y, mu times the spring force G of the
/// next link, and y^T M y (without cross masses mu times it) and y^T K y so far. The sums belong to
/// the stored offsets and their differences: they are the energies of these offsets.
template <class V>
struct Walk {
    V mu, offset, force;
    CompensatedSum<V> inertia, stiffness;  // of plain sums over legs
    V forces;                              ///< bound on the sum of (force/k)^2 k over the links
    V offsets;  ///< bound on the sum of (1 + mu X/k)^2 k y^2 over upper pins; for cross masses
};

/// Carries walks over the links begin ... end - 1, upwards from pin `begin` or downwards from pin
/// `end`. Upwards a walk has passed the mass of its pin, downwards it has not.
template <bool has_cross, bool up, class V>
[[gnu::always_inline]] inline void propagate(const LumpedChain& chain, std::size_t begin,
                                             std::size_t end, Walk<V>* walk) {
    constexpr std::size_t P = quotient_packs;
    V mu[P], offset[P], force[P], inertia[P], stiffness[P], pins[P];
    for (std::size_t p = 0; p < P; ++p)
        mu[p] = walk[p].mu, offset[p] = walk[p].offset, force[p] = walk[p].force;
    for (std::size_t i = begin; i < end; ++i) {
        const LumpedLink e = chain.links[up ? i : begin + (end - 1 - i)];
#pragma GCC unroll 8
        for (std::size_t p = 0; p < P; ++p) {
            const auto pass_pin = [&]() REVCHAIN_INLINED {
                const V q = e.mass * (mu[p] * offset[p]);
                (has_cross ? pins[p] : inertia[p]) += q * offset[p];
                force[p] = up ? force[p] + q : force[p] - q;
            };
            if (!up) pass_pin();
            const V before = offset[p];
            V d = e.flexibility * force[p];
            if constexpr (has_cross) d = d / (1.0 + mu[p] * e.cross_ratio);
            offset[p] = up ? before - d : before + d;
            d = up ? before - offset[p] : offset[p] - before;
            const V square = d * d;
            stiffness[p] += e.stiffness * square;
            if constexpr (has_cross) {
                const V lower = up ? before : offset[p], upper = up ? offset[p] : before;
                const V centroid = e.lower_share * lower + e.upper_share * upper;
                inertia[p] += e.weight * (centroid * centroid);
                inertia[p] += e.turn * square;
            }
            if (up) pass_pin();
        }
    }
    V size[P], least = std::numeric_limits<double>::infinity(), most;
    for (std::size_t p = 0; p < P; ++p) {
        Walk<V>& w = walk[p];
        w.offset = offset[p], w.force = force[p];
        w.inertia.add(inertia[p]), w.stiffness.add(stiffness[p]);
        if constexpr (has_cross) {
            const Bounds& b = chain.bounds[begin / longest_leg];
            const V factor = 1.0 + mu[p] * b.cross_ratio, root = b.root + mu[p] * b.cross_root;
            w.forces += factor * factor * stiffness[p];
            w.offsets += root * root * pins[p] / mu[p];
        }
        size[p] = max(abs(w.offset), abs(w.force));
        least = min(least, size[p]), most = max(most, size[p]);
    }
    if (!strays(least, most)) return;
    for (std::size_t p = 0; p < P; ++p) {
        Walk<V>& w = walk[p];
        const V by = inverse_power(size[p]);
        w.offset *= by, w.force *= by;
        w.inertia.scale(by * by), w.stiffness.scale(by * by);
        w.forces *= by * by, w.offsets *= by * by;
    }
}

/// The state of a walk at a pin where it may be joined to a walk from the other end.
template <class V>
struct AtPin {
    V offset, force, inertia, stiffness, forces, offsets;
    [[gnu::always_inline]] static AtPin of(const Walk<V>& w) {
        return {w.offset, w.force, w.inertia.value(), w.stiffness.value(), w.forces, w.offsets};
    }
};

/// Returns the residual from rounding and the pencil's error; `forces`, `offsets`: sums over |y|^2.
template <bool has_cross>
double vector_rounding(const LumpedChain& chain, double mu, double forces, double offsets) {
    // This bound covers pins without mass: y_m^2 <= Phi_m |y|_K^2.
    const double most = (1 + mu * chain.largest_cross_ratio) * chain.rounding_root;
    const double force_part = has_cross ? std::sqrt(forces) : 1.0;
    const double offset_part =
        has_cross ? std::fmin(std::sqrt(offsets), most) : chain.rounding_root;
    const double unit = epsilon<double>() / 2 + chain.data_error;
    return unit * ((16 * chain.rounding_root + 10) * force_part + 1.1 * offset_part) * 1.01;
}

/// `leg` links between checks. Twists are at pins 0, leg, ... `last` leg < n, number `low` to
/// `high`.
struct Legs {
    std::size_t leg, last, low, high;
};

inline Legs legs_of(const LumpedChain& chain, const double* shifts, std::size_t count,
                    std::size_t lowest, std::size_t highest, std::size_t longest) {
    double largest = 0;
    for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, shifts[i]);
    const std::size_t leg = links_between_checks(chain, largest, longest),
                      last = (chain.size() - 1) / leg;
    return {leg, last, std::min(lowest / leg, last), std::min(highest / leg, last)};
}

/// Computes for each shift the Rayleigh quotient of its twisted vector, whose error is the square
/// of the vector's. Recurrences from both ends are joined at the pin of least residual from
/// `lowest` to `highest` that `longest`, a power of 2, divides. Cost (AVX-512) a link: 0.45 ns,
/// with cross masses 0.86 ns.
template <bool has_cross, class V>
[[gnu::always_inline]] inline void quotients(const LumpedChain& chain, const double* shifts,
                                             std::size_t lowest, std::size_t highest,
                                             std::size_t longest, Quotient* result,
                                             std::vector<AtPin<V>>& scratch) {
    constexpr std::size_t P = quotient_packs;
    const std::size_t n = chain.size();
    const auto [leg, legs, low, high] =
        legs_of(chain, shifts, P * V::size, lowest, highest, longest);
    scratch.resize((high - low + 1) * P);

    Walk<V> walk[P];
    for (std::size_t p = 0; p < P; ++p) {
        walk[p].mu = V::load(shifts + p * V::size);
        walk[p].offset = V(1.0);
        walk[p].force = chain.tip_mass * walk[p].mu;
        if (!has_cross) walk[p].inertia.add(walk[p].force);
    }
    for (std::size_t at = 0; at <= high; ++at) {
        if (at > 0) propagate<has_cross, true>(chain, (at - 1) * leg, at * leg, walk);
        if (at < low) continue;
        for (std::size_t p = 0; p < P; ++p) scratch[(at - low) * P + p] = AtPin<V>::of(walk[p]);
    }

    V twist[P], least[P], inertia[P], stiffness[P], forces[P], offsets[P];
    for (std::size_t p = 0; p < P; ++p) {
        walk[p] = Walk<V>{walk[p].mu, V(0.0), V(1.0), {}, {}, {}, {}};
        least[p] = V(std::numeric_limits<double>::infinity());
        inertia[p] = stiffness[p] = forces[p] = offsets[p] = V(1.0);
    }
    for (std::size_t at = legs + 1, end = n; at-- > low;) {
        const std::size_t begin = at * leg;
        propagate<has_cross, false>(chain, begin, end, walk);
        end = begin;
        if (at > high) continue;
        const double above = chain.flexibility_above[begin];
        for (std::size_t p = 0; p < P; ++p) {
            const AtPin<V>& up = scratch[(at - low) * P + p];
            const AtPin<V> down = AtPin<V>::of(walk[p]);
            // Each vector is scaled by the other's offset, so that they meet.
            const V gap = up.force * down.offset - down.force * up.offset;
            const V scale_up = down.offset * down.offset, scale_down = up.offset * up.offset;
            const V energy = up.stiffness * scale_up + down.stiffness * scale_down;
            const V square = gap * gap * above / energy;
            const auto better = square < least[p];  // false for a NaN: no twist at a node
            least[p] = select(better, square, least[p]);
            inertia[p] =
                select(better, up.inertia * scale_up + down.inertia * scale_down, inertia[p]);
            stiffness[p] = select(better, energy, stiffness[p]);
            twist[p] = select(better, V(static_cast<double>(begin)), twist[p]);
            if constexpr (has_cross) {
                forces[p] =
                    select(better, up.forces * scale_up + down.forces * scale_down, forces[p]);
                offsets[p] =
                    select(better, up.offsets * scale_up + down.offsets * scale_down, offsets[p]);
            }
        }
    }
    for (std::size_t p = 0; p < P; ++p) {
        const V ratio = (has_cross ? walk[p].mu * inertia[p] : inertia[p]) / stiffness[p];
        for (std::size_t i = 0; i < V::size; ++i) {
            const double energy = stiffness[p][i];
            const double rounding = vector_rounding<has_cross>(
                chain, walk[p].mu[i], forces[p][i] / energy, offsets[p][i] / energy);
            // The factor 1.01 covers terms of second order only where `rounding` is small.
            const double residual = rounding < 0x1p-10
                                        ? std::sqrt(least[p][i]) * (1 + 0x1p-20) + rounding
                                        : std::numeric_limits<double>::infinity();
            result[p * V::size + i] = {ratio[i], residual, rounding,
                                       static_cast<std::size_t>(twist[p][i])};
        }
    }
}

/// Returns the results of `solve(registers, has_cross, shifts, lowest, highest, results)` for any
/// number of shifts; each call takes `packs` packs. Each shift is joined near its entry in
/// `places`, or anywhere if that is empty. Shifts are sorted by place, because links between the
/// places are walked twice.
template <class Result, std::size_t packs, class Solve>
std::vector<Result> in_packs(const LumpedChain& chain, const std::vector<double>& shifts,
                             const std::vector<std::size_t>& places, const Solve& solve) {
    std::vector<std::size_t> order(shifts.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    if (!places.empty())
        std::sort(order.begin(), order.end(),
                  [&](std::size_t i, std::size_t j) { return places[i] < places[j]; });
    std::vector<Result> result(shifts.size());
    revchain::detail::parallel_for(
        shifts.size(), packs * most_doubles, [&](std::size_t begin, std::size_t end) {
            simd([&](auto registers) REVCHAIN_INLINED {
                constexpr std::size_t together = packs * registers.doubles, slack = 4 * longest_leg;
                Result found[together];
                double padded[together];
                for (std::size_t i = begin; i < end; i += together) {
                    revchain::detail::check_interrupt();
                    const std::size_t taken = std::min(together, end - i);
                    for (std::size_t j = 0; j < together; ++j)
                        padded[j] = shifts[order[i + (j < taken ? j : 0)]];
                    const std::size_t lowest =
                        places.empty() ? 0 : places[order[i]] - std::min(places[order[i]], slack);
                    const std::size_t highest =
                        places.empty() ? chain.size() : places[order[i + taken - 1]] + slack;
                    if (chain.has_cross)
                        solve(registers, std::true_type(), padded, lowest, highest, found);
                    else
                        solve(registers, std::false_type(), padded, lowest, highest, found);
                    for (std::size_t j = 0; j < taken; ++j) result[order[i + j]] = found[j];
                }
            });
        });
    return result;
}

inline std::vector<Quotient> quotients_all(const LumpedChain& chain,
                                           const std::vector<double>& shifts,
                                           const std::vector<std::size_t>& places = {},
                                           std::size_t longest = longest_leg) {
    return in_packs<Quotient, quotient_packs>(
        chain, shifts, places,
        [&](auto registers, auto has_cross, const double* some, std::size_t lowest,
            std::size_t highest, Quotient* found) REVCHAIN_INLINED {
            std::vector<AtPin<Pack<double, registers.doubles>>> scratch;
            quotients<has_cross.value>(chain, some, lowest, highest, longest, found, scratch);
        });
}

}  // namespace revchain::pencil::spectrum
