// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/conical_pendulum.hpp"

/// An endless chain that runs round in a circle, the rim of a wheel, a tyre; and the straight string of small whirl.
/// Greenhill (1908) §5 (3)-(6). Tensions as lengths h of chain that weigh as much. Accuracy: 3 ulp. All throw
/// InvalidArgument unless every argument is positive and finite.
namespace revchain::hoop {

/// h = v^2 / g, of the speed along the rim; the circle may have any radius. §5 (6)
template <Real T>
T tension(const T& speed, const T& gravity = T(conical_pendulum::standard_gravity)) {
    detail::require_positive("hoop::tension", "speed", speed);
    detail::require_positive("hoop::tension", "gravity", gravity);
    return speed / gravity * speed;
}

/// v = sqrt(g h): of the rim where the tension is h; with h the breaking length, at which it bursts; and of transverse
/// waves along a string so stretched, relative to it. §5 (3), (6)
template <Real T>
T speed(const T& tension, const T& gravity = T(conical_pendulum::standard_gravity)) {
    using std::sqrt;
    detail::require_positive("hoop::speed", "tension", tension);
    detail::require_positive("hoop::speed", "gravity", gravity);
    return sqrt(tension) * sqrt(gravity);
}

/// In space, of the waves on a rim that runs with `speed`: those against it stand still and are seen, those with it run
/// twice as fast. §5, after (6)
template <Real T>
struct WaveSpeeds {
    T standing, running;
};
template <Real T>
WaveSpeeds<T> wave_speeds(const T& speed) {
    detail::require_positive("hoop::wave_speeds", "speed", speed);
    return {T(0), T(2) * speed};
}

/// Revolutions (or double vibrations) per second of a nearly straight string in one half wave: v / (2 span) with
/// v = sqrt(g h); the paper's R = sqrt(g h / a^2) / 4 with span 2 a. §5 (3)
template <Real T>
T string_revolutions_per_second(const T& span, const T& tension,
                                const T& gravity = T(conical_pendulum::standard_gravity)) {
    detail::require_positive("hoop::string_revolutions_per_second", "span", span);
    return speed(tension, gravity) / span / T(2);
}

}  // namespace revchain::hoop
