// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "revchain/compound_link.hpp"
#include "revchain/paper/two_links.hpp"
#include "revchain/paper/two_links_shapes.hpp"

/// Two links, or one link on something that yields: whirl speeds and steady shapes in closed form.
///
///     // two equal plummets on threads of 0.5 m; the lower one comes first
///     const auto lambda = revchain::two_plummets(1.0, 0.5, 1.0, 0.5);
///     lambda[0];                 // 0.853553 m, conical height of the slower mode
///     lambda[1];                 // 0.146447 m
///     const auto shapes = revchain::two_plummets_shapes(1.0, 0.5, 1.0, 0.5, 0.4);
///     shapes.size();             // 1 steady shape at the speed with a conical height of 0.4 m
///     shapes[0].inclination[0];  // 1.145 rad: the lower thread
///     // a boat hung from its davits by 3 m of tackle
///     revchain::link_on_thread(3.0, revchain::CompoundLink<double>{1.0, 0.8})[0];  // 4.18075 m
///
/// Greenhill (1908) §2, §6 and §8 (13)-(17). Lengths and weights in any units, angles in rad. Pairs
/// of conical heights are roots of a quadratic, computed without a difference of nearly equal
/// numbers, O(1). Functions throw InvalidArgument for numbers that are not finite, and for lengths
/// and weights that are not positive unless a function says otherwise.
namespace revchain::inline REVCHAIN_BUILD {

/// Two conical heights, the larger one (the slower mode) first.
template <Real T>
using HeightPair = std::array<T, 2>;

/// Both heights of two plummets on threads: (lambda - l1)(lambda - l2) = W1 l1 l2 / (W1 + W2), §2
/// (5); 1 is the lower plummet. Accuracy: 3 ulp (tests/cpp/paper/section_2.cpp).
template <Real T>
[[nodiscard]] HeightPair<T> two_plummets(const T& lower_weight, const T& lower_thread,
                                         const T& upper_weight, const T& upper_thread) {
    constexpr std::string_view place = "two_plummets";
    detail::require_positive(place, "lower weight", lower_weight, "lower thread", lower_thread,
                             "upper weight", upper_weight, "upper thread", upper_thread);
    return detail::coupled_roots(
        place, lower_thread, upper_thread,
        detail::upper_share(upper_weight, upper_thread, lower_weight, lower_thread),
        detail::upper_share(lower_weight, lower_thread, upper_weight, upper_thread));
}

/// Both heights of two plummets on a thread of total length 2a: (lambda - a)^2 = (mu a^2 + x^2) /
/// (1 + mu), §2 (6). `half_length` is a, `x` the distance of the upper plummet from the middle on
/// either side, `weight_ratio` mu = W1/W2. A negative mu is a float below, in a fluid that turns
/// with it; heights are then real where |x| >= a sqrt(-mu) (Stokes). Accuracy: 4 ulp. Throws
/// InvalidArgument for complex heights, |x| >= a and mu <= -1.
template <Real T>
[[nodiscard]] HeightPair<T> two_plummets_from_the_middle(const T& half_length, const T& x,
                                                         const T& weight_ratio) {
    using std::abs, std::sqrt;
    constexpr std::string_view place = "two_plummets_from_the_middle";
    detail::require_positive(place, "half length", half_length);
    if (!(abs(x) < half_length))
        detail::throw_invalid(place, "x must lie within the half length on either side", x);
    if (!(weight_ratio > T(-1)) || !(weight_ratio <= std::numeric_limits<T>::max()))
        detail::throw_invalid(place, "weight ratio must be greater than -1 and finite",
                              weight_ratio);
    const T share = x / half_length, whole = T(1) + weight_ratio;
    T square = (weight_ratio + share * share) / whole;
    if (weight_ratio < T(0)) {  // a difference: formed in two words
        using S = Wide<T>;
        const T unit = detail::inverse_power_near(half_length);
        const S half(half_length * unit), at(x * unit), ratio(weight_ratio);
        square = static_cast<T>(S((ratio * half * half + at * at) / (half * half))) / whole;
    }
    if (square < T(0))
        detail::throw_invalid(place,
                              "x must be at least half length sqrt(-ratio) on either side, else "
                              "both heights are complex",
                              x);
    const T larger = T(1) + sqrt(square);
    return {half_length * larger,
            (half_length - x) / whole / larger * ((half_length + x) / half_length)};
}

/// Both heights of a compound link on a thread, (lambda - l)(lambda - a) = a h, §6 (11). Accuracy:
/// 4 ulp.
template <Real T>
[[nodiscard]] HeightPair<T> link_on_thread(const T& thread, const CompoundLink<T>& link) {
    return detail::hung_link("link_on_thread", "thread", thread, link);
}

/// Both heights of a compound link whose support yields sideways on a spring: those on a thread as
/// long as the deflection of the spring. Accuracy: 4 ulp.
template <Real T>
[[nodiscard]] HeightPair<T> link_on_spring(const T& deflection, const CompoundLink<T>& link) {
    return detail::hung_link("link_on_spring", "deflection", deflection, link);
}

/// Deflection W/E of a spring with stiffness E under the weight W, §2 (7).
template <Real T>
[[nodiscard]] T spring_deflection(const T& weight, const T& stiffness) {
    detail::require_positive("spring_deflection", "weight", weight, "stiffness", stiffness);
    return weight / stiffness;
}

/// Seconds a day that a clock loses if its pendulum hangs on the spring of `link_on_spring`:
/// 86400 (1 - sqrt(l / lambda[0])). Accuracy: 8 ulp.
template <Real T>
[[nodiscard]] T seconds_lost_per_day(const T& deflection, const CompoundLink<T>& link) {
    using std::max, std::sqrt;
    detail::require_positive("seconds_lost_per_day", "deflection", deflection);
    detail::check("seconds_lost_per_day", link);
    const T unit = detail::inverse_power_near(max(deflection, link.pendulum_length()));
    const T l = link.pendulum_length() * unit, c = deflection * unit;
    const T half =
        detail::pendulum_difference(CompoundLink<T>{deflection, T(0)}, link) * unit / T(2);
    const T coupling = c * (link.centroid * unit), root = sqrt(half * half + coupling);
    const T height = l + (half < T(0) ? coupling / (root - half) : half + root);
    const T whole = sqrt(height);
    const T over = whole * (whole + sqrt(l));
    // 86400 (lambda - l) / over; 86400 first where the product of the other factors may underflow
    return half < T(0) ? T(86400) * c * (link.centroid * unit / (root - half)) / over
                       : T(86400) * ((half + root) / over);
}

/// Height of the motion in which a link stands on its lowest point, above a thread or a moving
/// hand: (l + lambda)(a - lambda) = a h, §6 (12), with h and l measured upwards from that point. It
/// is 0 (no such motion) if the radius of gyration is 0 and h >= a. Accuracy: 5 ulp.
template <Real T>
[[nodiscard]] T standing_link(const T& thread, const CompoundLink<T>& link) {
    detail::require_positive("standing_link", "thread", thread);
    detail::check("standing_link", link);
    return detail::standing_root(T((link.centroid - thread) + link.square_over_centroid()),
                                 detail::squares_over_centroid(link).times(thread));
}

/// Thread on which a link stands at a given height: a = lambda (l + lambda)/(l + lambda - h), §6
/// (13). Accuracy: 3 ulp.
template <Real T>
[[nodiscard]] T thread_of_standing_link(const T& height, const CompoundLink<T>& link) {
    detail::require_positive("thread_of_standing_link", "height", height);
    detail::check("thread_of_standing_link", link);
    const Wide<T> rest = detail::squares_over_centroid(link).value() + Wide<T>(height);
    using P = detail::Product<Wide<T>>;
    return static_cast<T>(P::of(rest + Wide<T>(link.centroid)).over(rest).times(height).value());
}

/// Height of a plummet that stands on a stiff massless rod above another plummet, which hangs by a
/// thread: (l1 + lambda)(l2 - lambda) = W1 l1 l2 / (W1 + W2), §2 (8). Accuracy: 4 ulp.
template <Real T>
[[nodiscard]] T standing_plummet(const T& standing_weight, const T& rod, const T& hung_weight,
                                 const T& thread) {
    detail::require_positive("standing_plummet", "standing weight", standing_weight, "rod", rod,
                             "hung weight", hung_weight, "thread", thread);
    return detail::standing_root(T(rod - thread),
                                 detail::upper_share(standing_weight, rod, hung_weight, thread));
}

/// A steady shape of two links, lowest first, with its free end (or lowest centre of oscillation)
/// on the positive side.
template <Real T>
struct PairShape {
    std::array<T, 2> inclination;  ///< to the vertical
    std::array<T, 2> offset;  ///< of the lower plummet (or centre of oscillation), and of the joint
    std::array<T, 2> tension;  ///< of each thread over the whole weight

    /// One more than the number of sign changes of the offsets.
    int half_waves() const { return offset[1] < T(0) ? 2 : 1; }
};

/// The shapes in which two plummets hang at the speed with conical height `height`, §2 (4); at most
/// four, sorted by half waves, then by the inclination of the lower thread. None if `height` is at
/// least the first of `two_plummets`. Proof that no other exists:
/// revchain/paper/two_links_shapes.hpp. Cost: 1 microsecond a shape. Accuracy: inclinations 4 ulp
/// for the data as given, also near a fold and near the vertical.
template <Real T>
[[nodiscard]] std::vector<PairShape<T>> two_plummets_shapes(const T& lower_weight,
                                                            const T& lower_thread,
                                                            const T& upper_weight,
                                                            const T& upper_thread,
                                                            const T& height) {
    constexpr std::string_view place = "two_plummets_shapes";
    detail::require_positive(place, "lower weight", lower_weight, "lower thread", lower_thread,
                             "upper weight", upper_weight, "upper thread", upper_thread, "height",
                             height);
    return detail::hanging_shapes(detail::plummet_pair(place, lower_weight, lower_thread,
                                                       upper_weight, upper_thread, height));
}

/// The shapes in which a compound link hangs on a thread, §6 (10), both with the tension of the
/// thread; otherwise as `two_plummets_shapes`.
template <Real T>
[[nodiscard]] std::vector<PairShape<T>> link_on_thread_shapes(const T& thread,
                                                              const CompoundLink<T>& link,
                                                              const T& height) {
    auto shapes =
        detail::hanging_shapes(detail::link_pair("link_on_thread_shapes", thread, link, height));
    for (PairShape<T>& shape : shapes) shape.tension[0] = shape.tension[1];
    return shapes;
}

/// The shape in which a plummet stands above another one on a stiff massless rod, §2 (8), if
/// `height` is below `standing_plummet`. inclination[0] is the rod's to the upward vertical,
/// tension[0] its thrust, negative. Otherwise as `two_plummets_shapes`.
template <Real T>
[[nodiscard]] std::optional<PairShape<T>> standing_plummet_shape(const T& standing_weight,
                                                                 const T& rod, const T& hung_weight,
                                                                 const T& thread, const T& height) {
    constexpr std::string_view place = "standing_plummet_shape";
    detail::require_positive(place, "standing weight", standing_weight, "rod", rod, "hung weight",
                             hung_weight, "thread", thread, "height", height);
    return detail::standing_shape(
        detail::plummet_pair(place, standing_weight, rod, hung_weight, thread, height));
}

/// The shape in which a compound link stands on its lowest point, §6 (12) with the secants of (10).
/// Both tensions are that of the thread. Otherwise as `standing_plummet_shape`.
template <Real T>
[[nodiscard]] std::optional<PairShape<T>> standing_link_shape(const T& thread,
                                                              const CompoundLink<T>& link,
                                                              const T& height) {
    auto shape =
        detail::standing_shape(detail::link_pair("standing_link_shape", thread, link, height));
    if (shape) shape->tension[0] = shape->tension[1];
    return shape;
}

/// Two links jointed together, as a bell and its clapper: `lower` (suffix 1 in the paper), `upper`
/// (2).
template <Real T>
struct JointedLinks {
    T lower_weight;              ///< W1 > 0
    CompoundLink<T> lower;       ///< h1, k1
    T upper_weight;              ///< W2 > 0
    T upper_length;              ///< a2 > 0, from the support to the joint
    T upper_centroid;            ///< h2, from the support; negative if above it, as a bell's may be
    T upper_radius_of_gyration;  ///< k2 >= 0, about the centroid
};

/// Both heights of two jointed links: the roots of a2 h1/(lambda - l1) = (m + 1)(lambda - l2) + l2
/// - a2, §8 (14), with m = W2 h2/(W1 a2). For l2 = a2 this is (lambda - l1)(lambda - l2) = l2
/// h1/(m + 1), (15). The second height is 0 if both radii of gyration are 0 and the upper centroid
/// is at the support. Accuracy: 3 ulp (tests/cpp/two_links.cpp). Also throws InvalidArgument for
/// weights more than 1e77 apart, if a2 or h1 is 1e77 times smaller than l1, a2, |h2| or k2 (in
/// double), and unless W2 h2 + W1 a2 > 0 (the upper link hangs).
template <Real T>
[[nodiscard]] HeightPair<T> jointed_links(const JointedLinks<T>& links) {
    const auto n = detail::jointed_numbers("jointed_links", links);
    const Wide<T> product = n.l1 * n.p;
    const auto roots =
        detail::coupled_roots<Wide<T>>(n.l1, n.p, n.share * product, n.other * product);
    return {static_cast<T>(roots[0]) / n.unit, static_cast<T>(roots[1]) / n.unit};
}

/// The shapes in which two jointed links hang: (lambda sec d1 - l1)(lambda sec d2 - p) = a2 h1/(m +
/// 1) with p = (m l2 + a2)/(m + 1), and (lambda sec d1 - l1) sin d1 = a2 sin d2, §8 (14). offset[0]
/// is that of the lower link's centre of oscillation. Tensions are the magnitudes of the forces at
/// each link's upper pin over the whole weight. Accuracy (tests/cpp/two_links.cpp): inclinations 8
/// ulp unless shapes are about to meet, tensions 4 ulp of the sizes of their terms. Otherwise as
/// `two_plummets_shapes` and `jointed_links`.
template <Real T>
[[nodiscard]] std::vector<PairShape<T>> jointed_links_shapes(const JointedLinks<T>& links,
                                                             const T& height) {
    using std::hypot, std::sin;
    using S = Wide<T>;
    constexpr std::string_view place = "jointed_links_shapes";
    const auto n = detail::jointed_numbers(place, links);
    detail::require_positive(place, "height", height);
    const S scale(T(1) / n.unit);
    auto pair = detail::pair_of<T>(place, n.l1 * scale, n.p * scale, n.share, n.other, height);
    pair.upper = detail::in_lengths<T>(links.upper_length, height);
    auto shapes = detail::hanging_shapes(pair);
    const T whole = links.lower_weight + links.upper_weight;
    const T w1 = links.lower_weight / whole, w2 = links.upper_weight / whole;
    for (PairShape<T>& shape : shapes) {
        // offsets of both centroids over the height; of the lower one from the joint or from the
        // centre of oscillation, whichever is nearer
        const T below = links.lower.centroid, above = links.lower.square_over_centroid();
        const T first = shape.offset[below < above ? 1 : 0] / height +
                        (below < above ? below : -above) / height * sin(shape.inclination[0]);
        const T second = links.upper_centroid / height * sin(shape.inclination[1]);
        shape.tension = {w1 * hypot(T(1), first), hypot(T(1), w1 * first + w2 * second)};
    }
    return shapes;
}

/// Distance of the clapper's pin below the support of its bell with which both swing, or whirl at
/// any inclination, as one piece, so that the bell is silent: a2 = w (l2 - l1)/(w + l1 - h1) with w
/// = W2 h2/W1, §8 (16), at the height l1 + a2. Accuracy: 4 ulp for the data as given, also where l1
/// and l2 nearly agree. Also throws InvalidArgument unless the clapper has the shorter pendulum
/// length.
template <Real T>
[[nodiscard]] T pin_of_silent_clapper(const T& bell_weight, const CompoundLink<T>& bell,
                                      const T& clapper_weight, const CompoundLink<T>& clapper) {
    constexpr std::string_view place = "pin_of_silent_clapper";
    detail::require_positive(place, "bell weight", bell_weight);
    detail::check(place, bell);
    detail::require_positive(place, "clapper weight", clapper_weight);
    detail::check(place, clapper);
    using std::max;
    const T longer = detail::pendulum_difference(bell, clapper);
    if (!(longer > T(0)))
        detail::throw_invalid(place, "the clapper's pendulum length must be less than the bell's",
                              clapper.pendulum_length());
    const T heavy = max(bell_weight, clapper_weight);
    const T w1 = clapper_weight / heavy, w2 = bell_weight / heavy;
    return w2 * bell.centroid / (w2 * bell.centroid + w1 * clapper.square_over_centroid()) * longer;
}

/// Distance CD from the pin C of a uniform rod, at the distance `pin` = CG from its middle G, to
/// the point D where the rod does not bend: CG.CD = CA^2, A the end above C, §8 (17). Accuracy: 2.5
/// ulp for pins up to 0.49 length. Also throws InvalidArgument unless length/6 < pin < length/2:
/// for C in the middle third D is off the rod.
template <Real T>
[[nodiscard]] T joint_without_bending(const T& length, const T& pin) {
    constexpr std::string_view place = "joint_without_bending";
    detail::require_positive(place, "length", length);
    const T above = length / T(2) - pin;  // CA
    if (!(above > T(0) && pin > length / T(6)))
        detail::throw_invalid(place, "pin must be more than length/6 and less than length/2", pin);
    return above / pin * above;
}

}  // namespace revchain
