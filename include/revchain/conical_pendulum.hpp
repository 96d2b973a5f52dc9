// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/status.hpp"

/// The conical pendulum, and one plummet: free, on two threads, or carried round a circle.
///
///     namespace pendulum = revchain::conical_pendulum;
///     pendulum::angular_speed(0.5);                          // 4.42869 rad/s, 0.5 m high
///     pendulum::height_from_period(2.0);                     // 0.993621 m: one revolution in 2 s
///     const auto p = revchain::inclined_pendulum(1.0, 0.5);  // a thread of 1 m at the first speed
///     p.inclination;                                         // 1.0472 rad: 60 degrees
///     p.tension;                                             // 2 times the weight
///
/// Greenhill (1908) §1. A conical pendulum of height lambda turns with the angular speed n = sqrt(g
/// / lambda); lambda is the conical height of that speed. Units: any consistent set if gravity is
/// given, else metres and seconds; angles in rad. Functions are O(1) and throw InvalidArgument
/// unless arguments are positive and finite.
namespace revchain::inline REVCHAIN_BUILD {

/// Direction of rotation: positive or negative angular speed. It matters to flywheels.
enum class Rotation { forward, backward };

/// Speed, period, gravity and conical height from each other, §1 (1)-(7).
/// Accuracy: 2.1 ulp, measured against 34 digits in tests/cpp/conical_pendulum.cpp;
/// `height_from_revolutions_per_second` 2.9 ulp.
namespace conical_pendulum {

inline constexpr double standard_gravity = 9.80665;  ///< m/s^2, exact (3rd CGPM, 1901)

/// n = sqrt(g / lambda), rad/s. §1 (1)
template <Real T>
[[nodiscard]] T angular_speed(const T& height, const T& gravity = T(standard_gravity)) {
    using std::sqrt;
    detail::require_positive("conical_pendulum::angular_speed", "height", height, "gravity",
                             gravity);
    return sqrt(gravity) / sqrt(height);  // not sqrt(g / lambda): the quotient may leave the range
}

/// lambda = g / n^2. §1 (1)
template <Real T>
[[nodiscard]] T height(const T& angular_speed, const T& gravity = T(standard_gravity)) {
    detail::require_positive("conical_pendulum::height", "angular speed", angular_speed, "gravity",
                             gravity);
    return gravity / angular_speed / angular_speed;
}

/// T = 2 pi sqrt(lambda / g), seconds for one revolution. §1 (2)
template <Real T>
[[nodiscard]] T period(const T& height, const T& gravity = T(standard_gravity)) {
    using std::sqrt;
    detail::require_positive("conical_pendulum::period", "height", height, "gravity", gravity);
    return T(2) * detail::pi<T> * (sqrt(height) / sqrt(gravity));
}

/// lambda = g T^2 / (4 pi^2). §1 (1)
template <Real T>
[[nodiscard]] T height_from_period(const T& period, const T& gravity = T(standard_gravity)) {
    detail::require_positive("conical_pendulum::height_from_period", "period", period, "gravity",
                             gravity);
    const T radian = period / (T(2) * detail::pi<T>);
    return gravity * radian * radian;
}

/// Revolutions per second, 1 / T.
template <Real T>
[[nodiscard]] T revolutions_per_second(const T& height, const T& gravity = T(standard_gravity)) {
    return angular_speed(height, gravity) / (T(2) * detail::pi<T>);
}

/// lambda = g / (2 pi R)^2 from R revolutions per second.
template <Real T>
[[nodiscard]] T height_from_revolutions_per_second(const T& revolutions,
                                                   const T& gravity = T(standard_gravity)) {
    detail::require_positive("conical_pendulum::height_from_revolutions_per_second",
                             "revolutions per second", revolutions);
    return height(T(T(2) * detail::pi<T> * revolutions), gravity);
}

/// g = 4 pi^2 l / T^2 from the length of a simple pendulum and its period for a small swing. §1 (4)
template <Real T>
[[nodiscard]] T gravity(const T& length, const T& period) {
    detail::require_positive("conical_pendulum::gravity", "length", length, "period", period);
    const T radian = period / (T(2) * detail::pi<T>);
    return length / radian / radian;
}

/// g = pi^2 L from the length L of the pendulum that beats seconds (T = 2), §1 (5)-(6). The 39.1396
/// inches of London in 1824 give 386.29 inches/s^2; §1 (6) prints 386.28.
template <Real T>
[[nodiscard]] T gravity_from_seconds_pendulum(const T& length) {
    detail::require_positive("conical_pendulum::gravity_from_seconds_pendulum", "length", length);
    return detail::pi<T> * detail::pi<T> * length;
}

/// lambda = L T^2 / 4 from the length L of the seconds pendulum; needs no g. §1 (7)
template <Real T>
[[nodiscard]] T height_from_seconds_pendulum(const T& seconds_pendulum, const T& period) {
    detail::require_positive("conical_pendulum::height_from_seconds_pendulum", "seconds pendulum",
                             seconds_pendulum, "period", period);
    const T half = period / T(2);
    return seconds_pendulum * half * half;
}

}  // namespace conical_pendulum

namespace detail {

/// Throws InvalidArgument unless options give exactly one of conical height and angular speed.
template <class Options>
void require_one_speed(std::string_view place, const Options& options) {
    if (options.conical_height.has_value() == options.angular_speed.has_value())
        throw_invalid(place, "give either conical_height or angular_speed");
}

/// The conical height that options give directly or by the angular speed. Throws InvalidArgument
/// unless exactly one is given.
template <class Options>
double height_given(std::string_view place, const Options& options) {
    require_one_speed(place, options);
    const double height = options.conical_height
                              ? *options.conical_height
                              : conical_pendulum::height(*options.angular_speed, options.gravity);
    require_positive(place, options.conical_height ? "conical height" : "gravity / angular_speed^2",
                     height);
    return height;
}

}  // namespace detail

/// A plummet at a steady inclination. Tension is over the weight.
template <Real T>
struct InclinedPendulum {
    T inclination;  ///< of the thread to the vertical, 0 ... pi/2
    T radius;       ///< of the circle
    T depth;        ///< below the point of support on the axis
    T tension;
};

/// The plummet on a thread of `length` at the speed with conical height `height`: cos(inclination)
/// = height / length. It hangs straight down if height >= length. For a compound link see
/// `swung_link`. §1 (1), §6 (1). Accuracy: 3 ulp (tests/cpp/paper/section_1.cpp).
template <Real T>
[[nodiscard]] InclinedPendulum<T> inclined_pendulum(const T& length, const T& height) {
    using std::asin, std::sqrt;
    detail::require_positive("inclined_pendulum", "length", length, "height", height);
    if (!(height < length)) return {T(0), T(0), length, T(1)};
    // Half angles: the arc cosine of a ratio near 1 would lose half the digits.
    const T ratio = height / length, half_sine = sqrt((length - height) / length / T(2));
    return {T(2) * asin(half_sine),
            length * (sqrt((length - height) / length) * sqrt(T(1) + ratio)), height,
            length / height};
}

/// A plummet on two threads tied to the axis. Tensions are over the weight.
template <Real T>
struct HeldPlummet {
    T radius, depth;  ///< of the plummet: from the axis, and below the upper point
    T upper_tension, lower_tension;
    /// If false, that thread is slack, its tension is 0, and the plummet is on the other one alone
    bool upper_taut, lower_taut;
};

/// The plummet held by threads from two points of the axis, the lower one `distance` below the
/// upper one. §1. Let D be the depth with both threads straight. The lower thread is slack if
/// height >= D, the upper one if height <= D - distance; the plummet is then a conical pendulum on
/// the other. Accuracy: 3 ulp; a depth or tension that is a small difference of two terms has an
/// error of 1e-29 of the larger one. Also throws InvalidArgument unless the three lengths form a
/// triangle.
template <Real T>
[[nodiscard]] HeldPlummet<T> held_plummet(const T& upper_thread, const T& lower_thread,
                                          const T& distance, const T& height);

/// Resistance of the air over the weight, CA / CN, measured with the whirling machine: the arm is
/// perpendicular to the vertical plane through the axis and the plummet. §1 (8). Accuracy: 0.5 ulp.
template <Real T>
[[nodiscard]] T air_resistance(const T& arm, const T& height) {
    detail::require_positive("air_resistance", "arm", arm, "height", height);
    return arm / height;
}

/// Thread that the whirling machine needs for a circle of `radius`: sqrt(arm^2 + height^2 +
/// radius^2). Accuracy: 2 ulp.
template <Real T>
[[nodiscard]] T whirling_thread(const T& arm, const T& height, const T& radius) {
    using std::hypot;
    detail::require_positive("whirling_thread", "arm", arm, "height", height, "radius", radius);
    return hypot(hypot(arm, height), radius);
}

/// Offset of a plummet over that of its support, if the support is carried round a circle or to and
/// fro and the thread is nearly vertical: lambda / (lambda - l), negative for lambda < l, infinite
/// at resonance. §1 (9). Accuracy: 1.1 ulp for lambda and l as given.
template <Real T>
[[nodiscard]] T carried_response(const T& length, const T& height) {
    detail::require_positive("carried_response", "length", length, "height", height);
    return height / (height - length);
}

/// Steady inclinations of the thread, ascending, positive outwards. The first `count` are used.
template <Real T>
struct CarriedInclinations {
    std::array<T, 3> inclination{};
    int count = 0;
};

/// The steady inclinations d between -pi/2 and pi/2 of a plummet whose support runs in a circle of
/// radius b: lambda tan d = b + l sin d, §1 (9). One is outwards. Two more are inwards if lambda <
/// l and b^(2/3) <= l^(2/3) - lambda^(2/3). Accuracy: 4 ulp, times 1 / |1 - (cos d_meet / cos d)^3|
/// near the inclination d_meet at which the inner two meet. Cost: 0.3 microseconds.
template <Real T>
[[nodiscard]] CarriedInclinations<T> carried_inclinations(const T& length, const T& height,
                                                          const T& radius);

}  // namespace revchain

#include "revchain/system/conical_pendulum.hpp"
