// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/conical_pendulum.hpp"

/// A closed chain that runs in a circle (the rim of a wheel), and a nearly straight string.
///
///     revchain::hoop::tension(20.0);   // 40.7886 m of rim weigh as much as the tension at 20 m/s
///     revchain::hoop::speed(10000.0);  // 313.156 m/s bursts a rim with a breaking length of 10 km
///
/// Greenhill (1908) §5 (3)-(6). A tension is given as the length h of chain that has this weight.
/// Units: any consistent set. Accuracy: 3 ulp. All functions are O(1) and throw InvalidArgument
/// unless every argument is positive and finite.
namespace revchain::inline REVCHAIN_BUILD::hoop {

/// h = v^2 / g of a rim that runs with speed v; the same for every radius. §5 (6)
template <Real T>
[[nodiscard]] T tension(const T& speed, const T& gravity = T(conical_pendulum::standard_gravity)) {
    detail::require_positive("hoop::tension", "speed", speed, "gravity", gravity);
    return speed / gravity * speed;
}

/// v = sqrt(g h): the speed of a rim with tension h (it bursts if h is its breaking length), and of
/// transverse waves on a string with that tension. §5 (3), (6)
template <Real T>
[[nodiscard]] T speed(const T& tension, const T& gravity = T(conical_pendulum::standard_gravity)) {
    using std::sqrt;
    detail::require_positive("hoop::speed", "tension", tension, "gravity", gravity);
    return sqrt(tension) * sqrt(gravity);
}

/// Speeds in space of the two waves on a rim.
template <Real T>
struct WaveSpeeds {
    T standing;  ///< of the wave against the rim: 0, it stands still in space
    T running;   ///< of the wave with the rim: twice its speed
};

/// Speeds of the waves on a rim that runs with `speed`. §5, after (6)
template <Real T>
[[nodiscard]] WaveSpeeds<T> wave_speeds(const T& speed) {
    detail::require_positive("hoop::wave_speeds", "speed", speed);
    return {T(0), T(2) * speed};
}

/// Revolutions (or complete vibrations) per second of a nearly straight string in one half wave:
/// sqrt(g h) / (2 span). With span 2a this is the paper's R = sqrt(g h / a^2) / 4. §5 (3)
template <Real T>
[[nodiscard]] T string_revolutions_per_second(
    const T& span, const T& tension, const T& gravity = T(conical_pendulum::standard_gravity)) {
    detail::require_positive("hoop::string_revolutions_per_second", "span", span);
    return speed(tension, gravity) / span / T(2);
}

}  // namespace revchain::hoop
