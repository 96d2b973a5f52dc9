// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>

#include "revchain/core/status.hpp"

namespace revchain {

/// What the uppermost pin is held by. As it stands: a firm point on the axis.
struct Support {
    double stiffness = std::numeric_limits<double>::infinity();  ///< sideways, force over length; infinite where firm
    double carriage_weight = 0;  ///< of what moves sideways with the pin, on a support that yields
    double radius = 0;           ///< of the circle in which the support's place of rest is carried round; 0 on the axis

    bool is_firm() const { return std::isinf(stiffness); }
    friend bool operator==(const Support&, const Support&) = default;
};

/// A pin that slides sideways on a spring, Greenhill (1908) §2 (7): for small amplitudes a thread of length W/E, W all
/// that hangs from it. Throws InvalidArgument unless stiffness > 0 and carriage weight >= 0, both finite.
inline Support horizontal_spring(double stiffness, double carriage_weight = 0) {
    detail::require_positive("horizontal_spring", "stiffness", stiffness);
    if (!(carriage_weight >= 0) || !std::isfinite(carriage_weight))
        detail::refuse("horizontal_spring", "carriage weight must be finite and not negative", carriage_weight);
    return {stiffness, carriage_weight, 0};
}

/// A pin carried round the axis: a chair on the arm of a carousel, a hand, Greenhill (1908) §1 (9).
/// Throws InvalidArgument unless radius >= 0 and finite.
inline Support carried_round(double radius) {
    if (!(radius >= 0) || !std::isfinite(radius))
        detail::refuse("carried_round", "radius must be finite and not negative", radius);
    return {.radius = radius};
}

}  // namespace revchain
