// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numbers>

#include "revchain/core/status.hpp"

/// The conical pendulum, Greenhill (1908) §1 (1)-(7): the only home of g. Everything else in this library is a length
/// or a ratio of weights; the conical height lambda = g / n^2 is the height of the pendulum that turns with speed n.
/// Units: any consistent set (g in length/s^2). Accuracy: at most 2.1 ulp, measured against 34 digits in
/// tests/cpp/core/conical_pendulum.cpp. All throw InvalidArgument unless every argument is positive and finite.
namespace revchain::conical_pendulum {

inline constexpr double standard_gravity = 9.80665;  // m/s^2, exact by convention (3rd CGPM, 1901)

/// n = sqrt(g / lambda), rad/s. §1 (1)
template <Real T>
T angular_speed(const T& height, const T& gravity = T(standard_gravity)) {
    using std::sqrt;
    detail::require_positive("conical_pendulum::angular_speed", "height", height);
    detail::require_positive("conical_pendulum::angular_speed", "gravity", gravity);
    return sqrt(gravity) / sqrt(height);  // not sqrt(g / lambda): the quotient may leave the range
}

/// lambda = g / n^2. §1 (1)
template <Real T>
T height(const T& angular_speed, const T& gravity = T(standard_gravity)) {
    detail::require_positive("conical_pendulum::height", "angular speed", angular_speed);
    detail::require_positive("conical_pendulum::height", "gravity", gravity);
    return gravity / angular_speed / angular_speed;
}

/// T = 2 pi sqrt(lambda / g), seconds for one revolution. §1 (2)
template <Real T>
T period(const T& height, const T& gravity = T(standard_gravity)) {
    using std::sqrt;
    detail::require_positive("conical_pendulum::period", "height", height);
    detail::require_positive("conical_pendulum::period", "gravity", gravity);
    return T(2) * std::numbers::pi_v<T> * (sqrt(height) / sqrt(gravity));
}

/// lambda = g T^2 / (4 pi^2). §1 (1)
template <Real T>
T height_from_period(const T& period, const T& gravity = T(standard_gravity)) {
    detail::require_positive("conical_pendulum::height_from_period", "period", period);
    detail::require_positive("conical_pendulum::height_from_period", "gravity", gravity);
    const T radian = period / (T(2) * std::numbers::pi_v<T>);
    return gravity * radian * radian;
}

/// Revolutions per second, 1 / T.
template <Real T>
T revolutions_per_second(const T& height, const T& gravity = T(standard_gravity)) {
    return angular_speed(height, gravity) / (T(2) * std::numbers::pi_v<T>);
}

/// lambda = g / (2 pi R)^2, from revolutions per second R.
template <Real T>
T height_from_revolutions_per_second(const T& revolutions, const T& gravity = T(standard_gravity)) {
    detail::require_positive("conical_pendulum::height_from_revolutions_per_second", "revolutions per second",
                             revolutions);
    return height(T(T(2) * std::numbers::pi_v<T> * revolutions), gravity);
}

/// g = 4 pi^2 l / T^2, from the length and the period (of a small double beat) of a simple pendulum. §1 (4)
template <Real T>
T gravity(const T& length, const T& period) {
    detail::require_positive("conical_pendulum::gravity", "length", length);
    detail::require_positive("conical_pendulum::gravity", "period", period);
    const T radian = period / (T(2) * std::numbers::pi_v<T>);
    return length / radian / radian;
}

/// g = pi^2 L from the length L of the pendulum that beats seconds (T = 2): 39.1396 inches in London in 1824 give
/// 386.29 inches/s^2 (§1 (6) prints 386.28). §1 (5)-(6)
template <Real T>
T gravity_from_seconds_pendulum(const T& length) {
    detail::require_positive("conical_pendulum::gravity_from_seconds_pendulum", "length", length);
    return std::numbers::pi_v<T> * std::numbers::pi_v<T> * length;
}

/// lambda = L T^2 / 4 with L the seconds pendulum: the form that needs no g. §1 (7)
template <Real T>
T height_from_seconds_pendulum(const T& seconds_pendulum, const T& period) {
    detail::require_positive("conical_pendulum::height_from_seconds_pendulum", "seconds pendulum", seconds_pendulum);
    detail::require_positive("conical_pendulum::height_from_seconds_pendulum", "period", period);
    const T half = period / T(2);
    return seconds_pendulum * half * half;
}

}  // namespace revchain::conical_pendulum
