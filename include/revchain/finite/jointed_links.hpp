// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/two_links.hpp"
#include "revchain/linear/jointed_links.hpp"

namespace revchain {

/// All hanging figures of two jointed links at a speed, at any inclination: (14) with its secants,
/// (lambda sec d1 - l1)(lambda sec d2 - p) = c, and (lambda sec d1 - l1) sin d1 = a2 sin d2. Method and count as of two
/// plummets, finite/two_links.hpp: one figure to one side where the height lies below the first of `jointed_links`, one or
/// three to both sides where it lies below the second; no more exist, whatever l2 and a2 are.
/// By half waves, then inclination of the lower link. offset[0] is that of the lower link's centre of oscillation; tension
/// the size of the reaction at each upper pin over the whole weight.
/// Accuracy: 8 ulp of every inclination where figures are not about to meet (measured; tests/cpp/finite/jointed_links.cpp).
/// Throws InvalidArgument as `jointed_links` does, and where lengths are more than a third of the range above the height.
template <Real T>
std::vector<PairShape<T>> jointed_links_shapes(const JointedLinks<T>& links, const T& height) {
    using std::cos;
    using std::hypot;
    using std::sin;
    using std::tan;
    constexpr std::string_view place = "jointed_links_shapes";
    const auto n = detail::jointed_numbers(place, links);
    detail::require_positive(place, "height", height);
    using S = Wide<T>;
    const S scale(T(1) / n.unit);
    auto pair = detail::pair_of<T>(place, n.l1 * scale, n.p * scale, n.share, n.other, height);
    pair.upper = detail::over_height(S(links.upper_length), height);
    auto shapes = detail::pair_shapes(pair, height);
    const T whole = links.lower_weight + links.upper_weight;
    const T w1 = links.lower_weight / whole, w2 = links.upper_weight / whole;
    for (PairShape<T>& shape : shapes) {
        // offsets of both centroids over the height
        const T sine1 = sin(shape.inclination[0]), sine2 = sin(shape.inclination[1]);
        const T first = shape.offset[0] / height - links.lower.square_over_centroid() / height * sine1;
        const T second = links.upper_centroid / height * sine2;
        shape.tension = {w1 * hypot(T(1), first), hypot(T(1), w1 * first + w2 * second)};
    }
    return shapes;
}

}  // namespace revchain
