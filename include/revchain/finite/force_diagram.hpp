// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/steady_shape.hpp"

namespace revchain {

/// The graphical construction of a steady shape, Greenhill (1908) §3, Figs. 3 and 5, as data. Links lowest first, pins free
/// end first; points as rows (x from the axis, z upwards).
///
/// Funicular polygon: its vertices are the pins, its sides the links, its loads `load`. Diagram of force: from the pole O
/// the line of load goes vertically upwards, one segment for each load; rays OQ_m end at the level of the segment's end.
/// OQ_m is parallel to link m and as long as what pulls along it. Plummets have their weights on the pins and Q_m is the
/// reaction, too; a link of another kind shares weight and centrifugal force between its pins as balance about them asks,
/// and the reaction at a pin lies between the rays of the two links that meet there.
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

/// The diagram of a shape of this chain. Rays are sums of the loads from below, not taken from the inclinations: that they
/// are parallel to the links is the proof of the figure, and holds to rounding: to 5 ulp of the sum of all loads' sizes,
/// measured (tests/cpp/finite/force_diagram.cpp). Cost O(N). Throws InvalidArgument if the shape has other links than
/// the chain.
inline ForceDiagram force_diagram(const Chain<double>& chain, const SteadyShape& shape) {
    const Index n = chain.size();
    if (shape.inclination.size() != n)
        detail::refuse("force_diagram", "the shape must be one of the chain's; its number of links is",
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

/// The chain's links, each as long only as it reaches down, hung along the axis: its weights transferred to the axis, level
/// with where they were. Small whirling of that straight chain obeys the very equations of the shape: the shape's conical
/// height is one of its heights and the shape's offsets are that mode, at any inclination and for links of any kind.
/// Perpendicular to the turning plane, too, weights and tensions of the shape are as stiff as this chain.
/// Accuracy: lengths to 2 ulp of the shape's heights. Throws InvalidArgument as `force_diagram`.
inline Chain<double> transferred_to_axis(const Chain<double>& chain, const SteadyShape& shape) {
    if (shape.inclination.size() != chain.size())
        detail::refuse("transferred_to_axis", "the shape must be one of the chain's; its number of links is",
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
