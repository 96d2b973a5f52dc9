// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/pencil/signed.hpp"
#include "revchain/system/rig_links.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// A link of a rig, or what yields at its support: stiffness at rest, and momentum over the square of the length as
/// `spin`: times a speed it is stiffness.
using RigElement = pencil::SignedElement<Wide<double>>;

/// One link: stiffness and spin negative where it stands.
inline RigElement rig_element(const detail::RigLink& link, bool stands) {
    constexpr double part = detail::RigLink::error_part;
    RigElement e{link.tension / link.length, link.spin / link.length, link.lower, link.upper, link.cross};
    if (stands) e.stiffness = -e.stiffness, e.spin = -e.spin;
    e.error = {1.01 * part * link.size.tension / link.length.high, part * std::abs(e.spin.high), part * link.size.lower,
               part * link.size.upper, part * link.size.cross};
    return e;
}

namespace detail {

/// Whether it bears, spins and moves nothing, for certain. Lowest links of which this is so, with none below, hang
/// along with the rest: no equation holds them.
inline bool is_nothing(const RigElement& e) {
    const Wide<double> none(0.0);
    const auto& [k, s, lower, upper, cross, error] = e;
    return k == none && s == none && lower == none && upper == none && cross == none &&
           error.stiffness + error.spin + error.lower + error.upper + error.cross == 0;
}

}  // namespace detail

/// A support that yields: its spring, massless, with the carriage at its lower pin. None where it is firm. The error
/// of the stiffness is that of the quotient a caller may have found it as.
/// Throws InvalidArgument where its stiffness is beyond the range of weights over lengths.
inline std::optional<RigElement> support_element(const Rig& rig) {
    using S = Wide<double>;
    const Support& support = rig.support();
    if (support.is_firm()) return std::nullopt;
    const ChainUnits units = rig.chain().units();
    const S stiffness = ldexp(support.stiffness, units.length_exponent - units.weight_exponent);
    if (!(isfinite(stiffness) && stiffness.high > 0))
        detail::throw_invalid("Rig", "the support's stiffness is too far from weight over length",
                              support.stiffness.high);
    RigElement spring{stiffness, S(0.0), S(std::ldexp(support.carriage_weight, -units.weight_exponent))};
    spring.error.stiffness = 2 * operation_error<S>() * stiffness.high;
    return spring;
}

}  // namespace revchain
