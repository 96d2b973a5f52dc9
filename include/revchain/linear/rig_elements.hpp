// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/numeric/compiled.hpp"
#include "revchain/pencil/element.hpp"
#include "revchain/system/rig_links.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// A link of a rig, or a support that yields. It has the stiffness at rest, and as `spin` the
/// momentum over the square of the length, which times a speed is a stiffness.
using RigElement = pencil::SignedElement<Wide<double>>;

/// Returns one link. Stiffness and spin are negative if it stands.
REVCHAIN_LAZY
RigElement rig_element(const detail::RigLink& link, bool stands) {
    constexpr double part = detail::RigLink::error_part;
    RigElement e = RigElement::of(link.tension / link.length, link.spin / link.length, link.lower,
                                  link.upper, link.cross);
    if (stands) e.stiffness = -e.stiffness, e.spin = -e.spin;
    e.error = {1.01 * part * link.size.tension / link.length.high, part * std::abs(e.spin.high),
               part * link.size.lower, part * link.size.upper, part * link.size.cross};
    return e;
}

/// Returns the massless spring of a support that yields, with the carriage at its lower pin; else
/// nothing. The stiffness may come from a quotient of the caller, and its error is that of a
/// quotient.
REVCHAIN_LAZY
std::optional<RigElement> support_element(const Support& support, const ChainUnits& units) {
    using S = Wide<double>;
    if (support.is_firm()) return std::nullopt;
    const S stiffness = ldexp(support.stiffness, units.length_exponent - units.weight_exponent);
    if (!(isfinite(stiffness) && stiffness.high > 0) && !support.is_free())
        detail::throw_invalid("Rig", "the support's stiffness is too far from weight over length",
                              support.stiffness.high);
    const S carriage(std::ldexp(support.carriage_weight, -units.weight_exponent));
    RigElement spring = RigElement::of(stiffness, S(0.0), carriage, S(0.0), S(0.0));
    spring.error.stiffness = 2 * operation_error<S>() * stiffness.high;
    return spring;
}

namespace detail {

/// Returns a chain's element, whose numbers have small relative errors, with own error bounds.
REVCHAIN_LAZY
RigElement with_errors(const pencil::Element<Wide<double>>& e, double part,
                       double stiffness_underflow = 0) {
    return RigElement::of(
        e.stiffness, Wide<double>(0.0), e.lower, e.upper, e.cross,
        {part * e.stiffness.high + stiffness_underflow, 0, part * e.lower.high, part * e.upper.high,
         part * (std::abs(e.cross.high) + 2 * e.turning.high)});
}

/// Returns true if it has no weight, spin or inertia: at the lower end no equation determines it.
REVCHAIN_LAZY
bool is_nothing(const RigElement& e) {
    const Wide<double> none(0.0);
    const auto& off = e.error;
    return e.stiffness == none && e.spin == none && e.lower == none && e.upper == none &&
           e.cross == none && off.stiffness + off.spin + off.lower + off.upper + off.cross == 0;
}

/// A support at the lower end of a chain, and the tension there that pulls the chain straight.
struct LowerEnd {
    Support support{};         ///< on the axis
    Wide<double> tension{};    ///< at this end, in the unit of the weights
    double tension_error = 0;  ///< bound on its absolute error
    bool weightless = false;   ///< true if weights add nothing to the tension

    /// Returns a link of this length under the tension, besides its own weight and the weight
    /// below. Throws InvalidArgument if the tension is beyond the range of the weights.
    RigElement pulled(RigElement e, double length, const ChainUnits& units) const {
        using S = Wide<double>;
        const S pull =
            ldexp(tension, -units.weight_exponent) / S(std::ldexp(length, -units.length_exponent));
        if (!(pull.high > 0x1p-800 && pull.high < 0x1p800))
            detail::throw_invalid("Held", "tension is too far from the weight", tension.high);
        if (weightless) e.stiffness = S(0.0), e.error.stiffness = 0;
        const double error = e.error.stiffness + tension_error / tension.high * pull.high;
        e.stiffness = e.stiffness + pull;
        e.error.stiffness = 1.01 * error + 4 * operation_error<S>() * e.stiffness.high;
        return e;
    }
};

}  // namespace detail

}  // namespace revchain
