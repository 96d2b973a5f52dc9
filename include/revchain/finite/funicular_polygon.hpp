// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/core/double_word.hpp"
#include "revchain/linear/string_places.hpp"

namespace revchain {

/// Weights on a thread between two supports, at rest in a vertical plane: a funicular polygon, from the first support to
/// the last.
template <Real T>
struct FunicularPolygon {
    Vector<T> place;   ///< (n + 2) x of supports and weights
    Vector<T> height;  ///< (n + 2) z
    Vector<T>
        rise;  ///< (n + 1) vertical component of each side's tension: the ray from the pole (0, 0) of the diagram of
               ///< force ends at (horizontal_tension, rise)
    Vector<T> tension;       ///< (n + 1) of each side, as long as its ray
    T horizontal_tension{};  ///< the same in all sides
};

/// The polygon of given horizontal component of tension, the pole's distance from the line of load: rays from the pole to
/// the line of load, sides parallel to them. Weights (n) and places (n + 2), supports among them, in any units.
/// Accuracy: heights to half an ulp and 1e-28 of the drop below the chord. Cost O(n). Throws InvalidArgument unless
/// weights are positive, places increase and all is finite, heights and tensions too.
template <Real T>
FunicularPolygon<T> funicular_polygon(const Vector<T>& weight, const Vector<T>& place, const T& horizontal_tension,
                                      const T& first_height = T(0), const T& last_height = T(0)) {
    using std::hypot;
    using std::isfinite;
    constexpr std::string_view where = "funicular_polygon";
    const Index n = weight.size();
    detail::check_string(where, weight, place);
    detail::require_positive(where, "horizontal tension", horizontal_tension);
    if (!(place.cwiseAbs().maxCoeff() <= std::numeric_limits<T>::max() * epsilon<T>()))
        detail::refuse(where, "places must not be so near the end of the range of numbers", place[n + 1]);
    for (const T& height : {first_height, last_height})
        if (!isfinite(height)) detail::refuse(where, "heights of the supports must be finite", height);
    FunicularPolygon<T> polygon{place, Vector<T>(n + 2), Vector<T>(n + 1), Vector<T>(n + 1), horizontal_tension};
    // Moments about the last support: what the first one carries, then weights as they come.
    const Vector<T>& at = place;
    using S = Wide<T>;
    const auto wide = [](const T& x) { return S(static_cast<Narrow<S>>(x)); };
    const S span = wide(at[n + 1]) - wide(at[0]), pull = wide(horizontal_tension);
    S lifts = pull * (wide(first_height) - wide(last_height)) / span;
    for (Index j = 0; j < n; ++j) lifts = lifts + wide(weight[j]) * (wide(at[n + 1]) - wide(at[j + 1])) / span;
    S rise = -lifts, height = wide(first_height);
    polygon.height[0] = first_height;
    for (Index j = 0; j <= n; ++j) {
        if (j > 0) rise = rise + wide(weight[j - 1]);
        polygon.rise[j] = static_cast<T>(rise);
        polygon.tension[j] = hypot(horizontal_tension, polygon.rise[j]);
        height = height + rise / pull * (wide(at[j + 1]) - wide(at[j]));
        polygon.height[j + 1] = static_cast<T>(height);
    }
    polygon.height[n + 1] = last_height;
    if (!polygon.height.allFinite() || !polygon.tension.allFinite())
        detail::refuse(where, "the polygon leaves the range of numbers, with a horizontal tension of",
                       horizontal_tension);
    return polygon;
}

}  // namespace revchain
