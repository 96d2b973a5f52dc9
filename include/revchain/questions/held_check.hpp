// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <string>
#include <type_traits>

#include "revchain/held.hpp"

/// The checks that the constructor of `Held` makes. Messages name the datum, the rule and the
/// value.
namespace revchain::inline REVCHAIN_BUILD {

template <class System>
void Held<System>::check() const {
    const HeldBy& by = held_by_;
    if (by.span.has_value() == by.tension.has_value())
        detail::throw_invalid(
            "Held", std::string("give either span or tension, got ") +
                        (by.span ? "both: span " + detail::in_digits(*by.span) + ", tension " +
                                       detail::in_digits(by.tension->high)
                                 : "neither"));
    if (by.tension) detail::require_positive("Held", "tension", by.tension->high);
    if (by.span) detail::require_positive("Held", "span", *by.span);
    if (by.span && !(*by.span < length()))
        detail::throw_invalid(
            "Held", "span must be less than the length " + detail::in_digits(length()), *by.span);
    check_end("lower", by.lower), check_end("upper", by.upper);
    if (by.span && by.firm()) {
        const double apart = std::hypot(*by.span, by.upper.radius - by.lower.radius);
        if (!(apart < length()))
            detail::throw_invalid("Held",
                                  "the ends must be nearer to each other than the length " +
                                      detail::in_digits(length()),
                                  apart);
    }
    if constexpr (std::is_same_v<System, Cord>)
        if (!system_.is_uniform() || system_.tip_weight() != 0)
            detail::throw_invalid(
                "Held",
                "a held cord must be uniform, without particles and tip weight; for others "
                "cut it into links, as Chain::tapered does");
}

/// Checks the support of one end. `name` is "lower" or "upper".
template <class System>
void Held<System>::check_end(const std::string& name, const Support& end) const {
    if (!(end.stiffness.high > 0))
        detail::throw_invalid("Held", name + " stiffness must be positive", end.stiffness.high);
    detail::require_not_negative("Held", name + " carriage weight", end.carriage_weight);
    detail::require_finite("Held", name + " radius", end.radius);
    if (!(end.damping == Wide<double>(0.0)))
        detail::throw_invalid("Held", name + " damping must be 0: an end is firm or on a spring",
                              end.damping.high);
    detail::require_spring_under_carriage("Held", name + " end", end);
    if (held_by_.tension && end.radius != 0)
        detail::throw_invalid("Held",
                              name +
                                  " radius must be 0: under a tension both ends must be on the "
                                  "axis; give the span instead",
                              end.radius);
    if constexpr (std::is_same_v<System, Cord>) {
        const std::string why =
            ": the ends of a cord are firm points on the axis; cut it into links, as "
            "Chain::tapered "
            "does";
        if (end.radius != 0)
            detail::throw_invalid("Held", name + " radius must be 0" + why, end.radius);
        if (!end.is_firm())
            detail::throw_invalid("Held", name + " stiffness must be infinite" + why,
                                  end.stiffness.high);
    }
}

}  // namespace revchain
