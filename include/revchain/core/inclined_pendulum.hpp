// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <utility>

#include "revchain/core/double_word.hpp"
#include "revchain/core/status.hpp"

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

/// A plummet on a thread of `length` turning at the speed whose conical height is `height`: it leaves the vertical where
/// height < length, and then hangs at that depth, cos(inclination) = height/length, tension length/height. §1 (1), §6 (1).
/// For a compound link `length` is its pendulum length, and the tension's part is not that of the pin.
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

/// `upper_thread` and `lower_thread` from two points of the axis, the lower `distance` below the upper; the equations of
/// the polygon KN, NP, PC', C'K of §1. The lower thread is taut where depth > height. Accuracy: 3 ulp; where a depth or
/// a tension nearly vanishes, 1e-29 of the larger of the two terms whose difference it is.
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
    if (!(slack >= T(0))) detail::refuse(place, "distance must make a triangle with the two threads", distance);
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

/// The whirling machine: a plummet whose thread hangs from an arm `arm` long, its length adjusted until the arm stands at
/// right angles to the vertical plane through axis and plummet. Resistance of the air over the weight, CA / CN. §1 (8)
template <Real T>
T air_resistance(const T& arm, const T& height) {
    detail::require_positive("air_resistance", "arm", arm);
    detail::require_positive("air_resistance", "height", height);
    return arm / height;
}

/// The thread that the machine then needs for the plummet to run in a circle of `radius`: sqrt(arm^2 + height^2 + radius^2).
template <Real T>
T whirling_thread(const T& arm, const T& height, const T& radius) {
    using std::hypot;
    detail::require_positive("whirling_thread", "arm", arm);
    detail::require_positive("whirling_thread", "height", height);
    detail::require_positive("whirling_thread", "radius", radius);
    return hypot(hypot(arm, height), radius);
}

}  // namespace revchain
