// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <string>
#include <type_traits>

#include "revchain/held.hpp"

namespace revchain::inline REVCHAIN_BUILD {

template <class System>
void Held<System>::check() const {
    if (by_.span.has_value() == by_.tension.has_value())
        detail::throw_invalid(
            "Held", std::string("give either span or tension, got ") +
                        (by_.span ? "both: span " + detail::in_digits(*by_.span) + ", tension " +
                                        detail::in_digits(by_.tension->high)
                                  : "neither"));
    if (by_.tension) detail::require_positive("Held", "tension", by_.tension->high);
    if (by_.span) detail::require_positive("Held", "span", *by_.span);
    if (by_.span && !(*by_.span < length()))
        detail::throw_invalid(
            "Held", "span must be less than the length " + detail::in_digits(length()), *by_.span);
    check_end("lower", by_.lower), check_end("upper", by_.upper);
    const double apart = by_.span ? std::hypot(*by_.span, by_.upper.radius - by_.lower.radius) : 0;
    if (by_.firm() && by_.span && !(apart < length()))
        detail::throw_invalid(
            "Held",
            "the ends must be nearer to each other than the length " + detail::in_digits(length()),
            apart);
    if constexpr (std::is_same_v<System, Cord>)
        if (!system_.is_uniform() || system_.tip_weight() != 0)
            detail::throw_invalid("Held",
                                  "a held cord must be uniform and without tip weight; for others "
                                  "cut it into links, as Chain::tapered does");
}

template <class System>
void Held<System>::check_end(const std::string& name, const Support& end) const {
    if (!(end.stiffness.high > 0))
        detail::throw_invalid("Held", name + " stiffness must be positive", end.stiffness.high);
    detail::require_not_negative("Held", name + " carriage weight", end.carriage_weight);
    detail::require_finite("Held", name + " radius", end.radius);
    detail::require_yielding("Held", name + " end", end);
    if (by_.tension && end.radius != 0)
        detail::throw_invalid(
            "Held",
            "under a tension both ends must be on the axis; give the span instead; " + name +
                " radius",
            end.radius);
    if (std::is_same_v<System, Cord> && !(end == Support{}))
        detail::throw_invalid(
            "Held",
            "the ends of a cord are firm points on the axis; cut it into links; " + name +
                " stiffness",
            end.stiffness.high);
}

}  // namespace revchain
