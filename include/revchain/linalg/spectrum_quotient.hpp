// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linalg/spectrum_pins.hpp"

namespace revchain::linalg::spectrum {

/// What a twisted vector at a shift mu = 1/lambda gives.
struct Quotient {
    double ratio = 0;       ///< Rayleigh quotient times mu: 1 at an eigenvalue
    double residual = 0;    ///< bound on |(mu M - K) y| in the norm of K^-1 over |y| in that of K, rounding and all
    double rounding = 0;    ///< what rounding has in it
    std::size_t twist = 0;  ///< links below the pin where the walks were joined
};

inline constexpr std::size_t quotient_packs = 4;
inline constexpr std::size_t quotient_lanes = quotient_packs * width;

/// Sums of squares in two doubles each, where plain sums over a stretch are added without loss.
struct Accumulator {
    Pack high{}, low{};
    void add(Pack x) {
        const Pack sum = high + x, part = sum - high;
        low += (high - (sum - part)) + (x - part);
        high = sum;
    }
    void scale(Pack by) { high *= by, low *= by; }
    Pack value() const { return high + low; }
};

/// A vector built link by link from one end, for `width` shifts: offset y and mu times the spring force G of the link
/// ahead, with y^T M y (where swings, else mu times it) and y^T K y so far. The sums belong to the offsets as stored and
/// to their differences: whatever rounding did to the recurrence, they are the energies of this very vector.
struct Walk {
    Pack mu{}, offset{}, force{};
    Accumulator inertia, stiffness;
    Pack forces{};   ///< bound on the sum of (force/k)^2 k over the links
    Pack offsets{};  ///< bound on the sum of (1 + mu X/k)^2 k y^2 over the upper pins; where swings only
};

/// Carries walks over the links begin ... end - 1, upwards from pin `begin` or downwards from pin `end`. Going up, a
/// walk has passed the mass of the pin it stands at; going down, it has not.
template <bool swings, bool up>
void carry(const PinnedChain& chain, std::size_t begin, std::size_t end, Walk* walk) {
    constexpr std::size_t P = quotient_packs;
    Pack mu[P], offset[P], force[P], inertia[P], stiffness[P], pins[P];
    for (std::size_t p = 0; p < P; ++p) {
        mu[p] = walk[p].mu, offset[p] = walk[p].offset, force[p] = walk[p].force;
        inertia[p] = stiffness[p] = pins[p] = Pack{};
    }
    for (std::size_t i = begin; i < end; ++i) {
        const PinnedLink e = chain.links[up ? i : begin + (end - 1 - i)];
#pragma GCC unroll 8
        for (std::size_t p = 0; p < P; ++p) {
            const auto pass_pin = [&] {
                const Pack q = e.mass * (mu[p] * offset[p]);
                (swings ? pins[p] : inertia[p]) += q * offset[p];
                force[p] = up ? force[p] + q : force[p] - q;
            };
            if (!up) pass_pin();
            const Pack before = offset[p];
            Pack d = e.flexibility * force[p];
            if constexpr (swings) d = d / (1.0 + mu[p] * e.swing);
            offset[p] = up ? before - d : before + d;
            d = up ? before - offset[p] : offset[p] - before;
            const Pack square = d * d;
            stiffness[p] += e.stiffness * square;
            if constexpr (swings) {
                const Pack centroid = (before + offset[p]) + e.skew * d;
                inertia[p] += e.quarter_weight * (centroid * centroid);
                inertia[p] += e.turn * square;
            }
            if (up) pass_pin();
        }
    }
    for (std::size_t p = 0; p < P; ++p) {
        Walk& w = walk[p];
        w.offset = offset[p], w.force = force[p];
        w.inertia.add(inertia[p]), w.stiffness.add(stiffness[p]);
        if constexpr (swings) {
            const Bounds& b = chain.bounds[begin / longest_leg];
            const Pack factor = 1.0 + mu[p] * b.swing, root = b.root + mu[p] * b.swing_root;
            w.forces += factor * factor * stiffness[p];
            w.offsets += root * root * pins[p] / mu[p];
        }
        const Pack size = magnitude(w.offset) > magnitude(w.force) ? magnitude(w.offset) : magnitude(w.force);
        if (!any((size > 0x1p100) | (size < 0x1p-100))) continue;
        const Pack by = inverse_power(size);
        w.offset *= by, w.force *= by;
        w.inertia.scale(by * by), w.stiffness.scale(by * by);
        w.forces *= by * by, w.offsets *= by * by;
    }
}

/// A walk at a pin where it may be joined with one from the other end.
struct AtPin {
    Pack offset, force, inertia, stiffness, forces, offsets;
    AtPin() = default;
    explicit AtPin(const Walk& w)
        : offset(w.offset),
          force(w.force),
          inertia(w.inertia.value()),
          stiffness(w.stiffness.value()),
          forces(w.forces),
          offsets(w.offsets) {}
};

/// For each shift the Rayleigh quotient of its twisted vector: recurrences from both ends, joined at that pin (of those
/// between `lowest` and `highest` where sizes are looked at) where the residual is least. Its error is the square of the vector's.
/// Cost per shift and link (AVX-512): 0.45 ns without swings, 0.86 with.
template <bool swings>
void quotients(const PinnedChain& chain, const double* shifts, std::size_t lowest, std::size_t highest,
               Quotient* result, std::vector<AtPin>& scratch) {
    constexpr std::size_t P = quotient_packs;
    const std::size_t n = chain.size();
    double largest = 0;
    for (std::size_t i = 0; i < quotient_lanes; ++i) largest = std::max(largest, shifts[i]);
    const std::size_t leg = stretch_length(chain, largest, longest_leg);  // links between two looks at sizes and sums
    const std::size_t legs = (n - 1) / leg;  // twists: pins 0, leg, 2 leg, ... legs * leg < n
    const std::size_t low = std::min(lowest / leg, legs), high = std::min(highest / leg, legs);
    scratch.resize((high - low + 1) * P);

    Walk walk[P];
    for (std::size_t p = 0; p < P; ++p) {
        for (std::size_t i = 0; i < width; ++i) walk[p].mu[i] = shifts[p * width + i];
        walk[p].offset = filled(1.0);
        walk[p].force = chain.tip_mass * walk[p].mu;
        if (!swings) walk[p].inertia.high = walk[p].force;
    }
    for (std::size_t at = 0; at <= high; ++at) {
        if (at > 0) carry<swings, true>(chain, (at - 1) * leg, at * leg, walk);
        if (at < low) continue;
        for (std::size_t p = 0; p < P; ++p) scratch[(at - low) * P + p] = AtPin(walk[p]);
    }

    Mask twist[P]{};
    Pack least[P], inertia[P], stiffness[P], forces[P], offsets[P];
    for (std::size_t p = 0; p < P; ++p) {
        const Pack mu = walk[p].mu;
        walk[p] = Walk{mu, Pack{}, filled(1.0), {}, {}, {}, {}};
        least[p] = filled(std::numeric_limits<double>::infinity());
        inertia[p] = stiffness[p] = forces[p] = offsets[p] = filled(1.0);
    }
    for (std::size_t at = legs + 1, end = n; at-- > low;) {
        const std::size_t begin = at * leg;
        carry<swings, false>(chain, begin, end, walk);
        end = begin;
        if (at > high) continue;
        const double above = chain.flexibility_above[begin];
        for (std::size_t p = 0; p < P; ++p) {
            const AtPin& up = scratch[(at - low) * P + p];
            const AtPin down(walk[p]);
            // each scaled by the other's offset, so that they meet
            const Pack gap = up.force * down.offset - down.force * up.offset;
            const Pack scale_up = down.offset * down.offset, scale_down = up.offset * up.offset;
            const Pack energy = up.stiffness * scale_up + down.stiffness * scale_down;
            const Pack square = gap * gap * above / energy;
            const Mask better = square < least[p];  // false for a NaN: no twist at a node
            least[p] = better ? square : least[p];
            inertia[p] = better ? up.inertia * scale_up + down.inertia * scale_down : inertia[p];
            stiffness[p] = better ? energy : stiffness[p];
            twist[p] = better ? Mask{} + static_cast<long long>(begin) : twist[p];
            if constexpr (swings) {
                forces[p] = better ? up.forces * scale_up + down.forces * scale_down : forces[p];
                offsets[p] = better ? up.offsets * scale_up + down.offsets * scale_down : offsets[p];
            }
        }
    }
    for (std::size_t p = 0; p < P; ++p) {
        const Pack ratio = (swings ? walk[p].mu * inertia[p] : inertia[p]) / stiffness[p];
        for (std::size_t i = 0; i < width; ++i) {
            const double energy = stiffness[p][i];
            const double force_part = swings ? std::sqrt(forces[p][i] / energy) : 1.0;
            const double offset_part = swings ? std::sqrt(offsets[p][i] / energy) : chain.rounding_root;
            const double unit = epsilon<double>() / 2;
            const double rounding =
                unit * ((16 * chain.rounding_root + 10) * force_part + 1.1 * offset_part) * 1.01 + chain.data_error;
            result[p * width + i] = {ratio[i], std::sqrt(least[p][i]) * (1 + 0x1p-40) + rounding, rounding,
                                     static_cast<std::size_t>(twist[p][i])};
        }
    }
}

/// The same for any number of shifts, each joined near its `place`, or with no places given anywhere. Those that live
/// together go together: what lies between the places is walked twice.
inline std::vector<Quotient> quotients_all(const PinnedChain& chain, const std::vector<double>& shifts,
                                           const std::vector<std::size_t>& places = {}) {
    std::vector<std::size_t> order(shifts.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    if (!places.empty())
        std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return places[i] < places[j]; });
    std::vector<Quotient> result(shifts.size());
    std::vector<AtPin> scratch;
    Quotient last[quotient_lanes];
    double padded[quotient_lanes];
    for (std::size_t i = 0; i < shifts.size(); i += quotient_lanes) {
        const std::size_t taken = std::min(quotient_lanes, shifts.size() - i);
        for (std::size_t j = 0; j < quotient_lanes; ++j) padded[j] = shifts[order[i + (j < taken ? j : 0)]];
        constexpr std::size_t slack = 4 * longest_leg;
        const std::size_t lowest = places.empty() ? 0 : places[order[i]] - std::min(places[order[i]], slack);
        const std::size_t highest = places.empty() ? chain.size() : places[order[i + taken - 1]] + slack;
        (chain.swings ? quotients<true> : quotients<false>)(chain, padded, lowest, highest, last, scratch);
        for (std::size_t j = 0; j < taken; ++j) result[order[i + j]] = last[j];
    }
    return result;
}

}  // namespace revchain::linalg::spectrum
