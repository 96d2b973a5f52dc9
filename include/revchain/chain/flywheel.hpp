// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include "revchain/core/conical_pendulum.hpp"

namespace revchain {

/// Angular momentum that a link carries along its own axis, counted from its lower pin to its upper one: for a hanging
/// link the sense of a positive bodily rotation. What of it is kept and what turns with the link are two numbers,
///     p = momentum + axial_moment n cos(inclination) / g.
/// The flywheel's weight, and its inertia across the axis, belong to the link's own numbers.
struct Flywheel {
    double momentum = 0;      ///< H, kept whatever the link does; weight times length times time, any sign
    double axial_moment = 0;  ///< C >= 0, weight times length squared (over g: a moment of inertia)

    friend bool operator==(const Flywheel&, const Flywheel&) = default;
};

namespace detail {
inline Flywheel turned_flywheel(std::string_view place, double weight, double radius_of_gyration, double spin,
                                double gravity) {
    const auto not_negative = [&](std::string_view name, double x) {
        if (!(x >= 0) || !std::isfinite(x)) refuse(place, std::string(name) + " must be finite and not negative", x);
    };
    not_negative("weight", weight), not_negative("radius of gyration", radius_of_gyration);
    if (!std::isfinite(spin)) refuse(place, "spin must be finite", spin);
    require_positive(place, "gravity", gravity);
    const double moment = weight * radius_of_gyration * radius_of_gyration, momentum = moment / gravity * spin;
    if (!std::isfinite(moment) || !std::isfinite(momentum))
        refuse(place, "weight radius of gyration^2 spin / gravity must be finite; radius of gyration",
               radius_of_gyration);
    return {momentum, moment};
}
}  // namespace detail

/// A wheel on free bearings: it keeps its spin, `spin` rad/s about the link's axis as seen from outside.
/// Throws InvalidArgument for negative weight or radius of gyration, gravity not positive, numbers not finite.
inline Flywheel free_flywheel(double weight, double radius_of_gyration, double spin,
                              double gravity = conical_pendulum::standard_gravity) {
    return {detail::turned_flywheel("free_flywheel", weight, radius_of_gyration, spin, gravity).momentum, 0};
}

/// A wheel that a motor turns with `spin` rad/s relative to a link, which itself turns about its axis with the whole.
/// Throws as free_flywheel does.
inline Flywheel driven_flywheel(double weight, double radius_of_gyration, double spin,
                                double gravity = conical_pendulum::standard_gravity) {
    return detail::turned_flywheel("driven_flywheel", weight, radius_of_gyration, spin, gravity);
}

}  // namespace revchain
