// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <utility>

#include "revchain/core/status.hpp"
#include "revchain/core/zero_between.hpp"

/// A plummet whose support is carried round a circle (or to and fro) at the speed of conical height lambda.
/// Greenhill (1908) §1 (9).
namespace revchain {

/// Offset of the plummet over that of its support while the thread is nearly vertical: lambda / (lambda - l), of one sign
/// with it where lambda > l and against it where lambda < l; infinite at resonance. Accuracy: 1.1 ulp, in lambda and l as
/// given. Throws InvalidArgument unless both are positive and finite.
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
        detail::refuse(place, "height must not be so small beside length and radius", height);
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
