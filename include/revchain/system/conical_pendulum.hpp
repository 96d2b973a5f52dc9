// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/zero_between.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Throws InvalidArgument because `mode` has not left the vertical at the given speed or height. It
/// leaves the vertical at the height `critical`. The message names the quantity that was given.
template <class Options>
[[noreturn]] void throw_too_slow(std::string_view place, Index mode, double critical, double height,
                                 const Options& options) {
    const std::string there = ", where mode " + std::to_string(mode) + " leaves the vertical";
    if (!options.angular_speed)
        throw_rule(place, "conical height", "less than " + in_digits(critical) + there, height);
    const double speed = conical_pendulum::angular_speed(critical, options.gravity);
    throw_rule(place, "angular speed", "greater than " + in_digits(speed) + " rad/s" + there,
               std::abs(*options.angular_speed));
}

}  // namespace detail

template <Real T>
HeldPlummet<T> held_plummet(const T& upper_thread, const T& lower_thread, const T& distance,
                            const T& height) {
    using std::frexp, std::ldexp, std::sqrt;
    constexpr std::string_view place = "held_plummet";
    detail::require_positive(place, "upper thread", upper_thread, "lower thread", lower_thread,
                             "distance", distance, "height", height);
    // Kahan's order of the sides, for the area of a thin triangle.
    T a = upper_thread, b = lower_thread, c = distance;
    if (a < b) std::swap(a, b);
    if (b < c) std::swap(b, c);
    if (a < b) std::swap(a, b);
    const T slack = c - (a - b);
    if (!(slack >= T(0)))
        detail::throw_invalid(place, "distance must make a triangle with the two threads",
                              distance);
    // The roots are taken first, because a product of two lengths may leave the range.
    const T radius =
        sqrt(a + (b + c)) * sqrt(a + (b - c)) / T(2) * (sqrt(slack) * sqrt(c + (a - b)) / distance);
    // Computed in two words, with lengths scaled to about 1, because depth and depth - distance
    // cancel in a thin triangle.
    using S = Wide<T>;
    int unit = 0, short_unit = 0;
    frexp(a, &unit), frexp(distance, &short_unit);
    const S u(ldexp(upper_thread, -unit)), l(ldexp(lower_thread, -unit));
    const S d(ldexp(distance, -unit)), x(height);
    const S rise =
        ldexp(S(upper_thread) - S(lower_thread), -short_unit) / S(ldexp(distance, -short_unit));
    const S along = rise * (u + l);
    const S depth = ldexp(d + along, unit - 1), above_lower = ldexp(along - d, unit - 1);
    if (x >= depth) {
        const InclinedPendulum<T> hung = inclined_pendulum(upper_thread, height);
        return {hung.radius, hung.depth, hung.tension, T(0), true, false};
    }
    if (x <= above_lower) {
        const InclinedPendulum<T> hung = inclined_pendulum(lower_thread, height);
        return {hung.radius, distance + hung.depth, T(0), hung.tension, false, true};
    }
    const T upper = upper_thread / distance * (static_cast<T>(S(x - above_lower)) / height);
    const T lower = lower_thread / distance * (static_cast<T>(S(depth - x)) / height);
    return {radius, static_cast<T>(depth), upper, lower, true, true};
}

template <Real T>
CarriedInclinations<T> carried_inclinations(const T& length, const T& height, const T& radius) {
    using std::atan, std::cbrt, std::sqrt;
    constexpr std::string_view place = "carried_inclinations";
    detail::require_positive(place, "length", length, "height", height, "radius", radius);
    // The zeros in t = tan d of the following function are wanted: t (lambda - cos d) - b in units
    // of l. It is convex for t > 0 with the slope lambda - cos^3 d. Near resonance lambda - cos d
    // is formed as gap + (1 - cos d), gap = lambda - l, which loses no digits.
    const T gap = (height - length) / length, lacking = (length - radius) / length;
    const T c = height / length, r = radius / length;
    const T farthest = (T(1) + r) / c;  // |c t| <= r + 1
    if (!(farthest <= std::numeric_limits<T>::max() / T(2)) || !(c > T(0)))
        detail::throw_invalid(
            place, "height must be larger, else the tangent of an inclination overflows", height);
    const auto function = [&](const T& t) {
        const T secant = sqrt(T(1) + t * t), cosine = T(1) / secant;
        const T versed = t / (secant + T(1)) * (t / secant);
        const T slope = c - cosine * cosine * cosine;
        // here l sin d is nearly l, so the difference of the two is computed directly
        if (t < T(-1)) return std::pair<T, T>(c * t + lacking - cosine / (secant - t), slope);
        if (T(2) * c < T(1)) return std::pair<T, T>(t * (c - cosine) - r, slope);
        return std::pair<T, T>(t * (gap + versed) - r,
                               gap + versed * (T(1) + cosine + cosine * cosine));
    };
    const auto negative = [&](const T& t) {  // used where the function falls
        const auto [value, slope] = function(t);
        return std::pair<T, T>(-value, -slope);
    };
    CarriedInclinations<T> result;
    const auto add = [&](const T& t) {
        result.inclination[static_cast<std::size_t>(result.count++)] = atan(t);
    };
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
