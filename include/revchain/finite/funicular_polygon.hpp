// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/core/scalar.hpp"
#include "revchain/core/status.hpp"

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
/// Accuracy: heights to n ulp of the drop from the chord. Cost O(n). Throws InvalidArgument unless weights are positive,
/// places increase and all is finite.
template <Real T>
FunicularPolygon<T> funicular_polygon(const Vector<T>& weight, const Vector<T>& place, const T& horizontal_tension,
                                      const T& first_height = T(0), const T& last_height = T(0)) {
    using std::hypot;
    using std::isfinite;
    constexpr std::string_view where = "funicular_polygon";
    const Index n = weight.size();
    if (place.size() != n + 2)
        detail::refuse(where, "places must be two more than weights: both supports and every weight; got",
                       place.size());
    for (Index j = 0; j < n; ++j) detail::require_positive(where, "weight", weight[j]);
    for (Index j = 0; j <= n; ++j)
        if (!isfinite(place[j]) || !isfinite(place[j + 1]) || !(place[j] < place[j + 1]))
            detail::refuse(where, "places must be finite and increase, after", place[j]);
    detail::require_positive(where, "horizontal tension", horizontal_tension);
    if (!isfinite(first_height) || !isfinite(last_height))
        detail::refuse(where, "heights of the supports must be finite, got",
                       isfinite(first_height) ? last_height : first_height);
    FunicularPolygon<T> polygon{place, Vector<T>(n + 2), Vector<T>(n + 1), Vector<T>(n + 1), horizontal_tension};
    const T span = place[n + 1] - place[0];
    // Moments about the last support: what the first one carries, then weights as they come.
    T lifts = horizontal_tension * ((first_height - last_height) / span);
    for (Index j = 0; j < n; ++j) lifts += weight[j] * ((place[n + 1] - place[j + 1]) / span);
    T rise = -lifts;
    polygon.height[0] = first_height;
    for (Index j = 0; j <= n; ++j) {
        if (j > 0) rise += weight[j - 1];
        polygon.rise[j] = rise;
        polygon.tension[j] = hypot(horizontal_tension, rise);
        polygon.height[j + 1] = polygon.height[j] + rise / horizontal_tension * (place[j + 1] - place[j]);
    }
    polygon.height[n + 1] = last_height;
    return polygon;
}

}  // namespace revchain
