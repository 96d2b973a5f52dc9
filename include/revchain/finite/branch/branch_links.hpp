// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/finite/balance/link_equation.hpp"
#include "revchain/finite/shapes/rigged_links.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A link at a tau, with derivatives of the sine by tau (`slope`) and of the tangent by the sine.
struct Inclined {
    double tangent, sine, secant, slope, steepening;
};

/// The links of a chain or a rig for branches, lowest first. sin(inclination) = tanh tau defines
/// the tau of a link. A standing link obeys the equations of a hanging one with the opposite pull.
/// A spring at the support is one more link, fixed at the radius above. Its stretch over `length`,
/// the total length of the links, is sinh tau; its `pull` is stiffness times `length`.
template <class S>
struct BranchLinks {
    std::vector<Link<S>> links;  ///< `pull` without what flywheels add
    std::vector<S> spin{};       ///< momentum over length, signed as `pull`; empty if all are 0
    S pace{0.0};                 ///< n sqrt(lambda), signed
    S radius{0.0};               ///< of the support
    bool spring = false;
    bool plain = true;  ///< whether all pulls are positive and the support is firm, on the axis

    BranchLinks() = default;
    explicit BranchLinks(std::vector<Link<S>> chain) : links(std::move(chain)) {}

    std::size_t size() const { return links.size(); }
    std::size_t bodies() const { return links.size() - spring; }
    bool is_spring(std::size_t m) const { return spring && m + 1 == links.size(); }
    bool is_symmetric() const { return is_zero(radius); }

    /// Returns n at a height; 0 without flywheels.
    S speed_at(const S& height) const {
        using std::sqrt;
        return spin.empty() ? S(0.0) : S(pace / sqrt(height));
    }
    S pull(std::size_t m, const S& n) const {
        return spin.empty() ? links[m].pull : S(links[m].pull + n * spin[m]);
    }
    /// Returns the derivative of lambda times the pull by log lambda, over lambda.
    S growing_pull(std::size_t m, const S& n) const { return pull(m, S(n * S(0.5))); }

    Inclined inclined(std::size_t m, double tau) const {
        if (is_spring(m)) return {std::sinh(tau), std::sinh(tau), 1, std::cosh(tau), 1};
        // from e^|tau| - 1, accurate at small inclinations
        const double e = std::expm1(std::abs(tau)), inverse = 0.5 / (1 + e),
                     secant = 1 + e * e * inverse,
                     tangent = std::copysign(e * (e + 2) * inverse, tau);
        return {tangent, tangent / secant, secant, 1 / (secant * secant), secant * secant * secant};
    }
    /// Returns tau of a link with a given distance between its pins across the axis.
    double tau_of_reach(std::size_t m, double reach) const {
        const double share = reach / as_double(links[m].length);
        return is_spring(m) ? std::asinh(share) : std::atanh(share);
    }
};

REVCHAIN_LAZY
BranchLinks<double> rounded(const BranchLinks<Fine>& from) {
    BranchLinks<double> to(rounded<double>(from.links));
    for (const Fine& x : from.spin) to.spin.push_back(as_double(x));
    to.pace = as_double(from.pace), to.radius = as_double(from.radius);
    to.spring = from.spring, to.plain = from.plain;
    return to;
}

/// A chain or a rig, with its numbers that do not depend on the speed.
struct BranchSystem {
    using S = Fine;
    Links<S> chain;          ///< set for a chain
    std::optional<Rig> rig;  ///< set for a rig
    BranchLinks<S> links;
    ChainUnits units;
    S bearing{0.0};    ///< the weight on the topmost pin, in the unit of weights
    double axial = 0;  ///< moment of inertia of flywheels that turn with the links, about the links
    double gravity = conical_pendulum::standard_gravity;
    Rotation direction = Rotation::forward;

    explicit BranchSystem(const Chain<double>& of)
        : chain(links_of(of)), links(chain.links), units(chain.units) {
        bearing = ldexp(of.weight_below(of.size()), -units.weight_exponent);
    }
    BranchSystem(const Rig& of, double g, Rotation sense)
        : rig(of), units(of.chain().units()), gravity(g), direction(sense) {
        using std::sqrt;
        detail::require_no_pins("branches", "branches", of, false);
        for (const detail::RigLink& link : detail::rig_links(of)) {
            const bool stands = of.stands(static_cast<Index>(links.links.size()));
            links.links.push_back({link.length, stands ? -link.tension : link.tension, link.cross,
                                   link.moment, link.rest});
            if (of.has_momentum()) links.spin.push_back(stands ? -link.spin : link.spin);
            bearing = link.hung;
        }
        const S root = sqrt(ldexp(S(gravity), -units.length_exponent));
        links.pace = direction == Rotation::forward ? root : -root, links.plain = false;
        const auto in_lengths = [&](double x) { return std::ldexp(x, -units.length_exponent); };
        const auto in_weights = [&](double x) { return std::ldexp(x, -units.weight_exponent); };
        const Support& support = of.support();
        links.radius = S(in_lengths(support.radius));
        for (Index m = 0; m < of.size(); ++m)
            axial += in_lengths(in_lengths(in_weights(of.flywheel(m).axial_moment.high)));
        if (support.is_firm()) return;
        S reach(0.0);
        for (const Link<S>& link : links.links) reach = reach + link.length;
        const S stiffness = ldexp(support.stiffness, units.length_exponent - units.weight_exponent);
        links.links.push_back(
            {reach, stiffness * reach, S(0.0), S(in_weights(support.carriage_weight)), S(0.0)});
        if (!links.spin.empty()) links.spin.push_back(S(0.0));
        links.spring = true;
    }
    bool stands(std::size_t m) const { return rig && rig->stands(static_cast<Index>(m)); }
    RiggedLinks rigged_at(const S& height) const {
        using std::sqrt;
        const S whole = ldexp(height, units.length_exponent), n = sqrt(S(gravity) / whole);
        return rigged_links(*rig, whole, direction == Rotation::forward ? n : -n);
    }
};

/// Returns the links of a rig for `verified`: standing links hang with the opposite pull.
REVCHAIN_LAZY
EnclosedLinks<Far> folded_links(const RiggedLinks& rig) {
    EnclosedLinks<Far> result = enclosed<Far>(rig.links);
    for (std::size_t m = 0; m < result.size(); ++m) {
        result[m].pull = effective_tension<Far>(rig.given[m], rig.speed);
        if (rig.posture[m] == Posture::stands) result[m].pull = -result[m].pull;
    }
    return result;
}

}  // namespace revchain::finite
