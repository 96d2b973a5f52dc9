// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <vector>

#include "revchain/pencil/element.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil::spectrum {

/// One link of the all-modes engine: an elastic, massless link between two pins with lumped mass,
/// and the mass -X on the difference of the two offsets. With p = h/a and q = 1 - p its own inertia
/// is
///
///     A y_l^2 + 2 X y_l y_u + B y_u^2 = W (p y_l + q y_u)^2 + turn (y_l - y_u)^2,
///
/// the motion of the centroid and the rotation about it: two squares, whatever the sign of X.
struct LumpedLink {
    double flexibility;  ///< 1/k
    double stiffness;    ///< k
    double mass;         ///< mass of the pin above: B + X of this link and A + X of the next
    double cross_ratio;  ///< X/k
    double weight;       ///< W
    double lower_share;  ///< (A + X)/W = h/a
    double upper_share;  ///< (B + X)/W = 1 - h/a
    double turn;         ///< the element's c = W rho^2/a^2
};

/// The pencil's numbers minus the rounded numbers of `LumpedLink`, and the cross mass X.
struct LumpedRest {
    double stiffness, mass, cross, cross_rest;
};

/// The largest number of links between two checks of sizes and sums.
inline constexpr std::size_t longest_leg = 16;

/// Bounds of a run of links: largest X/k, largest root = (k/m)^1/2 (m is the mass of the pin
/// above), and largest root X/k.
struct Bounds {
    double cross_ratio = 0, root = 0, cross_root = 0;
};

/// The pencil as lumped pins and links. Every number is within the relative `data_error`.
struct LumpedChain {
    std::vector<LumpedLink> links;
    std::vector<LumpedRest> rests;          ///< of each link
    std::vector<double> flexibility_above;  ///< [t]: sum of 1/k over the links t ... N-1
    double tip_mass = 0;                    ///< mass of pin 0
    double tip_mass_rest = 0;
    double rounding_root = 0;           ///< square root of C (docs/theory/spectrum.md)
    std::vector<Bounds> bounds;         ///< of each run of `longest_leg` links
    double largest_cross_ratio = 0;     ///< max X/k
    double max_mass_to_stiffness = 0;   ///< max (m + |X|)/k: growth in a link, over mu
    double skew_against_turn = 0;       ///< max p q (W / turn)^(1/2): cancellation
    double skew_against_stiffness = 0;  ///< max p q (W / k)^(1/2)
    double data_error = 0;              ///< relative error from the wide entries
    bool has_cross = false;             ///< true if some X is not 0
    bool fit = true;                    ///< masses are >= 0, and squares of all numbers are normal

    std::size_t size() const { return links.size(); }
};

template <Real S>
LumpedChain lumped(const ElementPencil<S>& wide) {
    LumpedChain chain;
    const std::size_t n = wide.elements.size();
    chain.links.reserve(n);
    chain.rests.reserve(n);
    chain.fit = wide.units.empty();
    double cancelled = 1;
    const S zero(0.0);
    const auto in_range = [](double x) { return x > 0x1p-150 && x < 0x1p150; };
    S carried = zero;  // B + X of the link below
    double carried_size = 0;
    for (std::size_t m = 0; m < n; ++m) {
        const Element<S>& e = wide.elements[m];
        const S cross = e.cross, mass = carried + (e.lower + cross);
        const double x = static_cast<double>(cross);
        const double cross_size = std::abs(x) + 2 * static_cast<double>(e.turning);  // for errors
        const double size = carried_size + (static_cast<double>(e.lower) + cross_size);
        carried = e.upper + cross;
        carried_size = static_cast<double>(e.upper) + cross_size;
        const double pin = static_cast<double>(mass), rest = static_cast<double>(mass - S(pin));
        // Negative masses are not supported, nor sums that cancel to less than 2^-30.
        chain.fit = chain.fit && (pin == 0 || in_range(pin));
        if (pin != 0) cancelled = std::max(cancelled, size / pin);
        (m == 0 ? chain.tip_mass : chain.links[m - 1].mass) = pin;
        (m == 0 ? chain.tip_mass_rest : chain.rests[m - 1].mass) = rest;
        const double k = static_cast<double>(e.stiffness);
        const double cross_ratio = static_cast<double>(cross / e.stiffness);
        const S weight(e.weight);
        const bool massless = e.weight == 0;
        chain.links.push_back({static_cast<double>(S(1.0) / e.stiffness), k, 0.0, cross_ratio,
                               e.weight,
                               massless ? 0.0 : static_cast<double>((e.lower + cross) / weight),
                               massless ? 0.0 : static_cast<double>((e.upper + cross) / weight),
                               static_cast<double>(e.turning)});
        chain.rests.push_back(
            {static_cast<double>(e.stiffness - S(k)), 0.0, x, static_cast<double>(cross - S(x))});
        const LumpedLink& last = chain.links.back();
        const double shares = last.lower_share * last.upper_share;
        if (shares != 0 && last.lower_share != 0.5) {
            const double skewed = shares * std::sqrt(e.weight);
            chain.skew_against_turn =
                std::max(chain.skew_against_turn, skewed / std::sqrt(last.turn));
            chain.skew_against_stiffness =
                std::max(chain.skew_against_stiffness, skewed / std::sqrt(k));
        }
        chain.has_cross = chain.has_cross || x != 0;
        chain.fit = chain.fit && in_range(k) && (cross == zero || in_range(x));
        if (cross != zero) cancelled = std::max(cancelled, cross_size / x);
    }
    chain.fit = chain.fit && cancelled < 0x1p30;
    chain.data_error = 16 * cancelled * static_cast<double>(wide.entry_error);
    chain.bounds.assign((n - 1) / longest_leg + 1, {});
    for (std::size_t m = 0; m < n; ++m) {
        const LumpedLink& link = chain.links[m];
        Bounds& b = chain.bounds[m / longest_leg];
        const double root = m + 1 < n ? std::sqrt(link.stiffness / link.mass) : 0;  // held pin
        b.cross_ratio = std::max(b.cross_ratio, link.cross_ratio);
        chain.largest_cross_ratio = std::max(chain.largest_cross_ratio, link.cross_ratio);
        b.root = std::max(b.root, root);
        b.cross_root = std::max(b.cross_root, root * link.cross_ratio);
    }
    chain.flexibility_above.assign(n + 1, 0.0);
    double square = 0;
    for (std::size_t m = n; m-- > 0;) {
        const LumpedLink& link = chain.links[m];
        chain.flexibility_above[m] = chain.flexibility_above[m + 1] + link.flexibility;
        square += link.stiffness * chain.flexibility_above[m];
        const double below = m == 0 ? chain.tip_mass : chain.links[m - 1].mass;
        const double mass =
            std::max(link.mass, below) + std::abs(link.cross_ratio) * link.stiffness;
        chain.max_mass_to_stiffness =
            std::max(chain.max_mass_to_stiffness, mass * link.flexibility);
    }
    chain.rounding_root = std::sqrt(square) * (1 + 0x1p-20);
    return chain;
}

/// Returns the number of links between checks of sizes, a power of 2. Growth stays below 2^300.
inline std::size_t links_between_checks(const LumpedChain& chain, double largest_shift,
                                        std::size_t longest) {
    const double growth = std::log2(4.0 + 2.0 * largest_shift * chain.max_mass_to_stiffness);
    return std::bit_floor(
        std::clamp(static_cast<std::size_t>(300.0 / growth), std::size_t(1), longest));
}

template <class V>
[[gnu::always_inline]] inline bool strays(const V& least, const V& most) {
    return any((bits(least) - bits(V(0x1p-100))) | (bits(V(0x1p100)) - bits(most)));  // or NaN
}

}  // namespace revchain::pencil::spectrum
