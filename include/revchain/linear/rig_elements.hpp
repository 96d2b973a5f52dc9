// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/numeric/compiled.hpp"
#include "revchain/pencil/element.hpp"
#include "revchain/system/rig_links.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// A link of a rig, or a support that yields: stiffness at rest, and as `spin` the momentum over
/// the square of the length, a stiffness once multiplied by a speed.
using RigElement = pencil::SignedElement<Wide<double>>;

/// One link: stiffness and spin negative where it stands.
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

/// A support that yields: its spring, massless, with the carriage at its lower pin; nothing if it
/// is firm. The error of the stiffness is that of a quotient from which a caller may have found it.
REVCHAIN_LAZY
std::optional<RigElement> support_element(const Support& support, const ChainUnits& units) {
    using S = Wide<double>;
    if (support.is_firm()) return std::nullopt;
    const S stiffness = ldexp(support.stiffness, units.length_exponent - units.weight_exponent);
    if (!(isfinite(stiffness) && stiffness.high > 0))
        detail::throw_invalid("Rig", "the support's stiffness is too far from weight over length",
                              support.stiffness.high);
    const S carriage(std::ldexp(support.carriage_weight, -units.weight_exponent));
    RigElement spring = RigElement::of(stiffness, S(0.0), carriage, S(0.0), S(0.0));
    spring.error.stiffness = 2 * operation_error<S>() * stiffness.high;
    return spring;
}

namespace detail {

/// An element of a chain, whose numbers have small relative errors, with errors of its own.
REVCHAIN_LAZY
RigElement with_errors(const pencil::Element<Wide<double>>& e, double part,
                       double stiffness_underflow = 0) {
    return RigElement::of(
        e.stiffness, Wide<double>(0.0), e.lower, e.upper, e.cross,
        {part * e.stiffness.high + stiffness_underflow, 0, part * e.lower.high, part * e.upper.high,
         part * (std::abs(e.cross.high) + 2 * e.turning.high)});
}

/// Whether it has no weight, spin or inertia: at the lower end no equation determines such links.
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
    bool weightless = false;   ///< whether weights add nothing to the tension

    /// A link of this length under the tension, besides its own weight and what hangs below. Throws
    /// InvalidArgument where the tension is beyond the range of the weights.
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
