// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "revchain/rig.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

/// Throws InvalidArgument for a carriage weight on a firm support, which cannot move.
inline void require_spring_under_carriage(std::string_view place, const std::string& name,
                                          const Support& support) {
    if (support.is_firm() && support.carriage_weight > 0)
        throw_invalid(place,
                      name +
                          " must have a stiffness (0: it rolls freely): what moves sideways needs "
                          "a support that yields; carriage weight",
                      support.carriage_weight);
}

/// Throws InvalidArgument for a rig with springs or dashpots at pins, or a support that is damped or
/// rolls freely. `what` is what cannot be found for it.
inline void require_no_pins(std::string_view place, std::string_view what, const Rig& rig,
                            bool dashpots_matter = true) {
    const auto refuse = [&](std::string_view with) {
        throw_invalid(
            place, std::string(what) + " cannot be found for a rig with " + std::string(with));
    };
    if (rig.has_pin_springs()) refuse("springs at pins: leave them out");
    if (rig.has_drag()) refuse("linear drag: leave it out");
    if (rig.support().damping.high > 0 || (dashpots_matter && rig.is_damped()))
        refuse("dashpots: leave them out");
    if (rig.support().is_free()) refuse("a trolley that rolls freely: give it a stiffness");
}

inline Flywheel turned_flywheel(std::string_view place, double weight, double radius_of_gyration,
                                double spin, double gravity) {
    require_not_negative(place, "weight", weight, "radius of gyration", radius_of_gyration);
    require_finite(place, "spin", spin);
    require_positive(place, "gravity", gravity);
    using S = Wide<double>;
    int heavy = 0, far = 0;  // products of numbers near 1 have all digits of both words
    const S part = S(std::frexp(weight, &heavy)), radius = S(std::frexp(radius_of_gyration, &far));
    const S moment = ldexp(S(part * radius * radius), heavy + 2 * far);
    const S momentum = moment * spin / S(gravity);
    if (!isfinite(moment) || !isfinite(momentum))
        throw_invalid(
            place,
            "weight x radius of gyration^2 x spin / gravity must be finite; radius of gyration",
            radius_of_gyration);
    return {momentum, moment};
}

}  // namespace detail

inline Flywheel free_flywheel(double weight, double radius_of_gyration, double spin,
                              double gravity) {
    return {detail::turned_flywheel("free_flywheel", weight, radius_of_gyration, spin, gravity)
                .momentum,
            0};
}

inline Flywheel driven_flywheel(double weight, double radius_of_gyration, double spin,
                                double gravity) {
    return detail::turned_flywheel("driven_flywheel", weight, radius_of_gyration, spin, gravity);
}

inline void Rig::check() const {
    const auto as_long = [&](std::size_t stored, std::string_view name) {
        if (stored != 0 && stored != static_cast<std::size_t>(size()))
            detail::throw_invalid("Rig",
                                  std::string(name) +
                                      " must be empty or have one entry for each of the " +
                                      std::to_string(size()) + " links",
                                  stored);
    };
    as_long(with_.posture.size(), "posture"), as_long(with_.flywheels.size(), "flywheels");
    as_long(with_.displaced.size(), "displaced"), as_long(with_.pins.size(), "pins");
    as_long(with_.drag.size(), "drag");
    const Support& support = with_.support;
    if (!(support.stiffness.high >= 0))
        detail::throw_invalid("Rig", "the stiffness of the support must not be negative",
                              support.stiffness.high);
    detail::require_not_negative("Rig", "damping of the support", support.damping.high);
    if (support.is_firm() && support.damping.high > 0)
        detail::throw_invalid("Rig",
                              "the support must have a stiffness (0: it rolls freely): a firm one "
                              "does not move its dashpot; damping",
                              support.damping.high);
    if (support.is_free() && with_.fluid == Fluid::turning)
        detail::throw_invalid("Rig", "a trolley that rolls freely cannot be in a fluid that turns");
    if (support.is_free() && support.radius != 0)
        detail::throw_invalid("Rig", "a trolley that rolls freely has no radius: its radius",
                              support.radius);
    detail::require_not_negative("Rig", "carriage weight", support.carriage_weight,
                                 "radius of the support", support.radius);
    detail::require_spring_under_carriage("Rig", "the support", support);
    if (with_.flywheels.empty() && with_.displaced.empty() && with_.pins.empty() &&
        with_.drag.empty())
        return;
    const auto check_link = [&](Index m, std::string_view place) {
        const Flywheel wheel = flywheel(m);
        detail::require_finite(place, "momentum", wheel.momentum.high);
        detail::require_not_negative(place, "axial moment", wheel.axial_moment.high);
        const Pin joint = pin(m);
        detail::require_not_negative(place, "stiffness of the upper pin", joint.stiffness.high,
                                     "damping of the upper pin", joint.damping.high);
        detail::require_not_negative(place, "linear drag", drag(m).high);
        const Displaced fluid = displaced(m);
        detail::require_not_negative(place, "weight displaced", fluid.weight);
        detail::require_finite(place, "centre of buoyancy", fluid.centroid);
        detail::require_not_negative(place, "added weight", fluid.added_weight,
                                     "(radius of gyration / length)^2 of the fluid displaced",
                                     static_cast<double>(fluid.gyration_ratio));
    };
    Index m = 0;
    try {
        for (; m < size(); ++m) check_link(m, "Rig");
    } catch (const InvalidArgument&) {  // checked again, to name the link
        check_link(m, "Rig: links[" + std::to_string(m) + "]");
        throw;
    }
}

}  // namespace revchain
