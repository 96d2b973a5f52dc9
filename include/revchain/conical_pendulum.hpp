// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <utility>

#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/status.hpp"
#include "revchain/numeric/zero_between.hpp"

/// The conical pendulum, Greenhill (1908) §1 (1)-(7): the only home of g. Everything else in this library is a length
/// or a ratio of weights; the conical height lambda = g / n^2 is the height of the pendulum that turns with speed n.
/// Units: any consistent set (g in length/s^2). Accuracy: at most 2.1 ulp, measured against 34 digits in
/// tests/cpp/conical_pendulum.cpp. All throw InvalidArgument unless every argument is positive and finite.
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
    return T(2) * detail::pi<T> * (sqrt(height) / sqrt(gravity));
}

/// lambda = g T^2 / (4 pi^2). §1 (1)
template <Real T>
T height_from_period(const T& period, const T& gravity = T(standard_gravity)) {
    detail::require_positive("conical_pendulum::height_from_period", "period", period);
    detail::require_positive("conical_pendulum::height_from_period", "gravity", gravity);
    const T radian = period / (T(2) * detail::pi<T>);
    return gravity * radian * radian;
}

/// Revolutions per second, 1 / T.
template <Real T>
T revolutions_per_second(const T& height, const T& gravity = T(standard_gravity)) {
    return angular_speed(height, gravity) / (T(2) * detail::pi<T>);
}

/// lambda = g / (2 pi R)^2, from revolutions per second R.
template <Real T>
T height_from_revolutions_per_second(const T& revolutions, const T& gravity = T(standard_gravity)) {
    detail::require_positive("conical_pendulum::height_from_revolutions_per_second", "revolutions per second",
                             revolutions);
    return height(T(T(2) * detail::pi<T> * revolutions), gravity);
}

/// g = 4 pi^2 l / T^2, from the length and the period (of a small double beat) of a simple pendulum. §1 (4)
template <Real T>
T gravity(const T& length, const T& period) {
    detail::require_positive("conical_pendulum::gravity", "length", length);
    detail::require_positive("conical_pendulum::gravity", "period", period);
    const T radian = period / (T(2) * detail::pi<T>);
    return length / radian / radian;
}

/// g = pi^2 L from the length L of the pendulum that beats seconds (T = 2): 39.1396 inches in London in 1824 give
/// 386.29 inches/s^2 (§1 (6) prints 386.28). §1 (5)-(6)
template <Real T>
T gravity_from_seconds_pendulum(const T& length) {
    detail::require_positive("conical_pendulum::gravity_from_seconds_pendulum", "length", length);
    return detail::pi<T> * detail::pi<T> * length;
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

/// One plummet at any inclination, free or held, and the whirling machine: Greenhill (1908) §1. Lengths in any unit,
/// tensions over the plummet's weight. Accuracy: 3 ulp, measured in tests/cpp/paper/section_1.cpp. All throw
/// InvalidArgument unless lengths and heights are positive and finite.
namespace revchain {

/// Where a plummet swings round, and how its thread pulls.
template <Real T>
struct InclinedPendulum {
    T inclination;  ///< of the thread to the vertical, rad, 0 ... pi/2
    T radius;       ///< of the circle
    T depth;        ///< below the point of support on the axis
    T tension;      ///< over the weight
};

/// A plummet on a thread of `length` turning at the speed whose conical height is `height`: it leaves the vertical
/// where height < length, and then hangs at that depth, cos(inclination) = height/length, tension length/height. §1
/// (1), §6 (1). For a compound link `length` is its pendulum length, and the tension's part is not that of the pin.
template <Real T>
InclinedPendulum<T> inclined_pendulum(const T& length, const T& height) {
    using std::asin;
    using std::sqrt;
    detail::require_positive("inclined_pendulum", "length", length);
    detail::require_positive("inclined_pendulum", "height", height);
    if (!(height < length)) return {T(0), T(0), length, T(1)};
    // Half angles: the arc cosine of a ratio near 1 would lose half the digits.
    const T ratio = height / length, half_sine = sqrt((length - height) / length / T(2));
    return {T(2) * asin(half_sine), length * (sqrt((length - height) / length) * sqrt(T(1) + ratio)), height,
            length / height};
}

/// A plummet on two threads tied to the axis, which holds it from flying out as far as it would.
template <Real T>
struct HeldPlummet {
    T radius, depth;  ///< of the plummet: from the axis, and below the upper point
    T upper_tension, lower_tension;
    bool upper_taut,
        lower_taut;  ///< tensions not negative: else that thread is slack, and the plummet swings on the other
};

/// `upper_thread` and `lower_thread` from two points of the axis, the lower `distance` below the upper; the equations
/// of the polygon KN, NP, PC', C'K of §1. The lower thread is taut where depth > height. Accuracy: 3 ulp; where a depth
/// or a tension nearly vanishes, 1e-29 of the larger of the two terms whose difference it is.
/// Throws InvalidArgument unless the three lengths make a triangle.
template <Real T>
HeldPlummet<T> held_plummet(const T& upper_thread, const T& lower_thread, const T& distance, const T& height) {
    using std::sqrt;
    constexpr std::string_view place = "held_plummet";
    detail::require_positive(place, "upper thread", upper_thread);
    detail::require_positive(place, "lower thread", lower_thread);
    detail::require_positive(place, "distance", distance);
    detail::require_positive(place, "height", height);
    // Kahan's order of the sides for the area of a thin triangle.
    T a = upper_thread, b = lower_thread, c = distance;
    if (a < b) std::swap(a, b);
    if (b < c) std::swap(b, c);
    if (a < b) std::swap(a, b);
    const T slack = c - (a - b);
    if (!(slack >= T(0))) detail::throw_invalid(place, "distance must make a triangle with the two threads", distance);
    // No product of two lengths, which may leave the range.
    const T radius = sqrt(a + (b + c)) * sqrt(a + (b - c)) / T(2) * (sqrt(slack) * sqrt(c + (a - b)) / distance);
    // In two words, of lengths near 1: of a thin triangle depth and depth - distance are differences.
    using S = Wide<T>;
    using std::frexp;
    using std::ldexp;
    int unit = 0, short_unit = 0;
    frexp(a, &unit), frexp(distance, &short_unit);
    const auto wide = [](const T& x, int power) { return S(static_cast<Narrow<S>>(ldexp(x, power))); };
    const S u = wide(upper_thread, -unit), l = wide(lower_thread, -unit), d = wide(distance, -unit),
            x = wide(height, 0);
    const S rise = ldexp(wide(upper_thread, 0) - wide(lower_thread, 0), -short_unit) / wide(distance, -short_unit);
    const S along = rise * (u + l), depth = ldexp(d + along, unit - 1), above_lower = ldexp(along - d, unit - 1);
    const T upper = upper_thread / distance * (static_cast<T>(S(x - above_lower)) / height);
    const T lower = lower_thread / distance * (static_cast<T>(S(depth - x)) / height);
    return {radius, static_cast<T>(depth), upper, lower, upper >= T(0), lower >= T(0)};
}

/// The whirling machine: a plummet whose thread hangs from an arm `arm` long, its length adjusted until the arm stands
/// at right angles to the vertical plane through axis and plummet. Resistance of the air over the weight, CA / CN. §1
/// (8)
template <Real T>
T air_resistance(const T& arm, const T& height) {
    detail::require_positive("air_resistance", "arm", arm);
    detail::require_positive("air_resistance", "height", height);
    return arm / height;
}

/// The thread that the machine then needs for the plummet to run in a circle of `radius`: sqrt(arm^2 + height^2 +
/// radius^2).
template <Real T>
T whirling_thread(const T& arm, const T& height, const T& radius) {
    using std::hypot;
    detail::require_positive("whirling_thread", "arm", arm);
    detail::require_positive("whirling_thread", "height", height);
    detail::require_positive("whirling_thread", "radius", radius);
    return hypot(hypot(arm, height), radius);
}

}  // namespace revchain

/// A plummet whose support is carried round a circle (or to and fro) at the speed of conical height lambda.
/// Greenhill (1908) §1 (9).
namespace revchain {

/// Offset of the plummet over that of its support while the thread is nearly vertical: lambda / (lambda - l), of one
/// sign with it where lambda > l and against it where lambda < l; infinite at resonance. Accuracy: 1.1 ulp, in lambda
/// and l as given. Throws InvalidArgument unless both are positive and finite.
template <Real T>
T carried_response(const T& length, const T& height) {
    detail::require_positive("carried_response", "length", length);
    detail::require_positive("carried_response", "height", height);
    return height / (height - length);
}

/// Steady inclinations of the thread, ascending, outwards positive: `count` of the three places hold one.
template <Real T>
struct CarriedInclinations {
    std::array<T, 3> inclination{};
    int count = 0;
};

/// All steady inclinations between -pi/2 and pi/2 of a plummet whose support runs in a circle of `radius` (b > 0):
/// lambda tan d = b + l sin d. One always, outwards; two more, inwards, where lambda < l and
/// b^(2/3) <= l^(2/3) - lambda^(2/3), of which one is the resonance curve's unstable part.
/// Accuracy: 4 ulp, times 1/(1 - (cos of where the inner two meet / cos d)^3) next to that place. Cost: a microsecond.
/// Throws InvalidArgument unless all three are positive and finite, or where the tangent would not be.
template <Real T>
CarriedInclinations<T> carried_inclinations(const T& length, const T& height, const T& radius) {
    using std::atan;
    using std::cbrt;
    using std::sqrt;
    constexpr std::string_view place = "carried_inclinations";
    detail::require_positive(place, "length", length);
    detail::require_positive(place, "height", height);
    detail::require_positive(place, "radius", radius);
    // In t = tan d, over l:  t (lambda - cos d) - b, convex for t > 0, its slope lambda - cos^3 d; next to resonance
    // lambda - cos d = gap + 1 - cos d,  gap = lambda - l, keeps its digits.
    const T gap = (height - length) / length, lacking = (length - radius) / length;
    const T c = height / length, r = radius / length;
    const T farthest = (T(1) + r) / c;  // |c t| <= r + 1
    if (!(farthest <= std::numeric_limits<T>::max() / T(2)) || !(c > T(0)))
        detail::throw_invalid(place, "height must not be so small beside length and radius", height);
    const auto function = [&](const T& t) {
        const T secant = sqrt(T(1) + t * t), cosine = T(1) / secant, versed = t / (secant + T(1)) * (t / secant);
        const T slope = c - cosine * cosine * cosine;
        // inwards and flown out, l sin d all but as long as l: what both lack of it
        if (t < T(-1)) return std::pair<T, T>(c * t + lacking - cosine / (secant - t), slope);
        if (T(2) * c < T(1)) return std::pair<T, T>(t * (c - cosine) - r, slope);
        return std::pair<T, T>(t * (gap + versed) - r, gap + versed * (T(1) + cosine + cosine * cosine));
    };
    const auto negative = [&](const T& t) {  // decreasing there: turned round
        const auto [value, slope] = function(t);
        return std::pair<T, T>(-value, -slope);
    };
    CarriedInclinations<T> result;
    const auto add = [&](const T& t) { result.inclination[static_cast<std::size_t>(result.count++)] = atan(t); };
    T turn(0);  // slope 0 at |t| = sqrt(c^(-2/3) - 1): a maximum on the inner side
    if (gap < T(0)) {
        const T root = cbrt(c);
        turn = sqrt(-gap / (T(1) + root + root * root) * (T(1) + root)) / root;
        if (!(function(-turn).first < T(0))) {
            add(detail::zero_between(T(-farthest), T(-turn), function));
            add(detail::zero_between(T(-turn), T(0), negative));
        }
    }
    add(detail::zero_between(turn, farthest, function));
    return result;
}

}  // namespace revchain
