// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include "revchain/finite/shapes/described.hpp"
#include "revchain/modes.hpp"
#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/scalar.hpp"
#include "revchain/numeric/status.hpp"
#include "revchain/steady_shapes.hpp"
#include "revchain/two_links.hpp"

namespace revchain {

/// The graphical construction of a steady shape, Greenhill (1908) §3, Figs. 3 and 5, as data. Links lowest first, pins
/// free end first; points as rows (x from the axis, z upwards).
///
/// Funicular polygon: its vertices are the pins, its sides the links, its loads `load`. Diagram of force: from the pole
/// O the line of load goes vertically upwards, one segment for each load; rays OQ_m end at the level of the segment's
/// end. OQ_m is parallel to link m and as long as what pulls along it. Plummets have their weights on the pins and Q_m
/// is the reaction, too; a link of another kind shares weight and centrifugal force between its pins as balance about
/// them asks, and the reaction at a pin lies between the rays of the two links that meet there.
struct ForceDiagram {
    Table<double> pin;  ///< (N + 1, 2) vertices of the funicular polygon; the support's 0, 0 last
    Table<double>
        load;  ///< (N, 2) on every pin but the support: centrifugal force outwards, weight downwards (negative)
    Table<double> ray;       ///< (N, 2) Q_m from O
    Table<double> reaction;  ///< (N, 2) at each link's upper pin, on what hangs below it, from O
    Vector<double> lifted;   ///< (N) x at which each load's line from O meets the horizontal line ON = lambda below O:
                             ///< of a plummet its own, P lifted vertically onto that line. Infinite where a load has no
                             ///< weight, the pin's own x where there is no load
    Table<double>
        centre_of_gravity;    ///< (N, 2) G_m of link m and all below; H_m level with it on the axis, and K_m lambda
                              ///< above: G_m K_m is parallel to the reaction, and to the link above a plummet
    Vector<double> crossing;  ///< (N) z of C_m, where the line of link m meets the axis; infinite where it never does
    double conical_height = 0;
};

/// The diagram of a shape of this chain. Rays are sums of the loads from below, not taken from the inclinations: that
/// they are parallel to the links is the proof of the figure, and holds to rounding: to 5 ulp of the sum of all loads'
/// sizes, measured (tests/cpp/statics.cpp). Cost O(N). Throws InvalidArgument if the shape has other links than the
/// chain.
inline ForceDiagram force_diagram(const Chain<double>& chain, const SteadyShape& shape) {
    const Index n = chain.size();
    if (shape.inclination.size() != n)
        detail::throw_invalid("force_diagram", "the shape must be one of the chain's; its number of links is",
                              shape.inclination.size());
    const auto exact = finite::links_of(chain);
    const auto links = finite::rounded<double>(exact.links);
    const auto weight = [&](double x) { return std::ldexp(x, exact.units.weight_exponent); };
    ForceDiagram d;
    d.conical_height = shape.conical_height;
    d.pin.resize(n + 1, 2), d.load.resize(n, 2), d.ray.resize(n, 2), d.reaction.resize(n, 2);
    d.lifted.resize(n), d.centre_of_gravity.resize(n, 2), d.crossing.resize(n);
    d.pin.col(0) = shape.offset, d.pin.col(1) = shape.height;
    const double lambda = shape.conical_height;
    double outwards = 0, hung = 0;       // of all loads so far
    double from_above = 0, carried = 0;  // what the link below puts on the pin
    double moment_x = 0, moment_z = 0;   // weights times places of the centroids
    for (Index m = 0; m < n; ++m) {
        const auto& link = links[static_cast<std::size_t>(m)];
        const double lower = shape.offset[m], upper = shape.offset[m + 1], across = lower - upper;
        const double low = shape.height[m], high = shape.height[m + 1];
        const double at_lower = link.moment * (lower / lambda) - link.cross * (across / lambda);
        const double at_upper = link.rest * (upper / lambda) + link.cross * (across / lambda);
        const double force = from_above + at_lower, load = carried + link.moment;
        d.load.row(m) << weight(force), -weight(load);
        d.lifted[m] = force == 0 && load == 0 ? lower : lambda * (force / load);
        outwards += force, hung += load;
        d.ray.row(m) << -weight(outwards), weight(hung);
        from_above = at_upper, carried = link.rest;
        d.reaction.row(m) << -weight(outwards + at_upper), weight(hung + link.rest);
        moment_x += link.moment * lower + link.rest * upper, moment_z += link.moment * low + link.rest * high;
        d.centre_of_gravity.row(m) << moment_x / (hung + link.rest), moment_z / (hung + link.rest);
        d.crossing[m] = upper == 0 ? high : high + upper / across * (high - low);
    }
    return d;
}

/// The chain's links, each as long only as it reaches down, hung along the axis: its weights transferred to the axis,
/// level with where they were. Small whirling of that straight chain obeys the very equations of the shape: the shape's
/// conical height is one of its heights and the shape's offsets are that mode, at any inclination and for links of any
/// kind. Perpendicular to the turning plane, too, weights and tensions of the shape are as stiff as this chain.
/// Accuracy: lengths to 2 ulp of the shape's heights. Throws InvalidArgument as `force_diagram`.
inline Chain<double> transferred_to_axis(const Chain<double>& chain, const SteadyShape& shape) {
    if (shape.inclination.size() != chain.size())
        detail::throw_invalid("transferred_to_axis", "the shape must be one of the chain's; its number of links is",
                              shape.inclination.size());
    std::vector<Link<double>> links;
    links.reserve(static_cast<std::size_t>(chain.size()));
    for (Index m = 0; m < chain.size(); ++m) {
        Link<double> link = chain.link(m);
        const double cosine = std::cos(shape.inclination[m]);
        link.length *= cosine, link.centroid *= cosine;  // the ratio of gyration stays
        links.push_back(link);
    }
    return Chain<double>(links);
}

}  // namespace revchain

namespace revchain::detail {

/// Refuses weights on a string that are not positive, and places, both supports among them, that do not increase.
template <Real T>
void check_string(std::string_view where, const Vector<T>& weight, const Vector<T>& place) {
    using std::isfinite;
    if (place.size() != weight.size() + 2)
        throw_invalid(where, "places must be two more than weights: both supports and every weight", place.size());
    for (Index j = 0; j < weight.size(); ++j) require_positive(where, "weight", weight[j]);
    for (Index j = 0; j < place.size(); ++j)
        if (!isfinite(place[j]) || (j > 0 && !(place[j - 1] < place[j])))
            throw_invalid(where, "places must be finite and increase, place " + std::to_string(j) + " too", place[j]);
}

}  // namespace revchain::detail

namespace revchain {

/// Weights on a thread between two supports, at rest in a vertical plane: a funicular polygon, from the first support
/// to the last.
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

/// The polygon of given horizontal component of tension, the pole's distance from the line of load: rays from the pole
/// to the line of load, sides parallel to them. Weights (n) and places (n + 2), supports among them, in any units.
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
        detail::throw_invalid(where, "places must not be so near the end of the range of numbers", place[n + 1]);
    for (const T& height : {first_height, last_height})
        if (!isfinite(height)) detail::throw_invalid(where, "heights of the supports must be finite", height);
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
        detail::throw_invalid(where, "the polygon leaves the range of numbers, with a horizontal tension of",
                              horizontal_tension);
    return polygon;
}

}  // namespace revchain

/// Transverse oscillation of a string of weights held at both ends, and of a funicular polygon perpendicular to its
/// plane.
namespace revchain {

/// A string of weights as a chain that hangs: its weights and spacings, the last support above, and at the other end
/// instead of the first support a weight 2^(digits + 47) times all others together, which stretches it evenly and does
/// not move, both to less than a rounding of a rounding. Its modes from the second on, heights times `factor`, are
/// those of the string.
template <Real T>
struct StringOfWeights {
    Chain<T> chain;
    T factor{};
};

/// Weights (n) at places (n + 2, both supports among them) on a thread of uniform tension.
///
/// Greenhill (1908) §3: the weights of a funicular polygon between two supports, transferred vertically to one
/// horizontal line and held there on a thread of uniform tension, the horizontal component in the polygon, oscillate as
/// the weights of the polygon do perpendicular to its plane. Exactly so while oscillations are small: a side of length
/// a and tension T resists with T/a, which is the horizontal component over the horizontal length.
/// Throws InvalidArgument unless there are weights, all positive, places increase and all is finite.
template <Real T>
StringOfWeights<T> string_of_weights(const Vector<T>& weight, const Vector<T>& place, const T& tension,
                                     std::string_view where = "string_of_weights") {
    using std::ldexp;
    const Index n = weight.size();
    if (n == 0) detail::throw_invalid(where, "there must be a weight; their number is", n);
    detail::check_string(where, weight, place);
    detail::require_positive(where, "tension", tension);
    const T unit = detail::inverse_power_near(weight.maxCoeff());
    T total(0);
    for (Index j = 0; j < n; ++j) total += weight[j] * unit;
    const T heavy = ldexp(T(1) / detail::inverse_power_near(total), std::numeric_limits<T>::digits + 47);
    std::vector<Link<T>> links{plummet<T>(heavy, place[1] - place[0])};
    for (Index j = 0; j < n; ++j) links.push_back(plummet<T>(weight[j] * unit, place[j + 2] - place[j + 1]));
    return {Chain<T>(links), heavy / (tension * unit)};
}

/// Small transverse oscillations of a string of weights, slowest first.
template <Real T>
struct TransverseModes {
    Vector<T> conical_height;  ///< (n) of the pendulum that keeps time with it: period 2 pi sqrt(height/g)
    Vector<T> error_bound;     ///< (n) relative
    Table<T> shape;            ///< (n, n + 2) of supports and weights; largest 1, the first weight to the positive side

    Vector<T> period(const T& gravity = T(conical_pendulum::standard_gravity)) const {
        Vector<T> seconds(conical_height.size());
        for (Index k = 0; k < seconds.size(); ++k) seconds[k] = conical_pendulum::period(conical_height[k], gravity);
        return seconds;
    }
};

/// All of them, by `modes` of the equivalent chain. Accuracy: heights to 2 ulp (measured;
/// tests/cpp/finite/funicular_polygon.cpp), within `error_bound`, which adds to the proved bound of `modes` the
/// roundings of spacings and factor. Throws as string_of_weights does, and where a height is out of range.
template <Real T>
TransverseModes<T> transverse_modes(const Vector<T>& weight, const Vector<T>& place, const T& tension) {
    using std::isfinite;
    constexpr std::string_view where = "transverse_modes";
    const StringOfWeights<T> string = string_of_weights(weight, place, tension, where);
    const Modes<T> found = modes(string.chain, {.first = 2, .count = all_modes});
    TransverseModes<T> result{found.conical_height, found.error_bound, found.shapes().offset};
    for (Index k = 0; k < found.size(); ++k) {
        result.conical_height[k] = found.conical_height[k] * string.factor;
        if (!isfinite(result.conical_height[k]) || result.conical_height[k] == T(0))
            detail::throw_invalid(where, "the conical heights leave the range of numbers, with a tension of", tension);
        result.error_bound[k] += T(3) * epsilon<T>();
        if (result.shape(k, 1) < T(0)) result.shape.row(k) = -result.shape.row(k);
        result.shape(k, 0) = T(0);  // the heavy weight: less than 2^-digits
        result.shape(k, result.shape.cols() - 1) = T(0);
    }
    return result;
}

}  // namespace revchain
