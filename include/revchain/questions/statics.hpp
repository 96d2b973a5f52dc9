// SPDX-License-Identifier: MPL-2.0
// Defines what statics.hpp declares.
#pragma once

#include "revchain/finite/shapes/described.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/double_word.hpp"
#include "revchain/paper/two_links.hpp"
#include "revchain/statics.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

REVCHAIN_LAZY
void check_shape(std::string_view where, const Chain<double>& chain, const SteadyShape& shape) {
    const Index links = shape.inclination.size();
    if (links != chain.size())
        throw_invalid(where, "the shape must be one of the chain's; its number of links is", links);
}

/// Throws InvalidArgument for weights that are not positive, and for positions that do not increase.
template <Real T>
void check_string(std::string_view where, const Vector<T>& weight, const Vector<T>& position) {
    using std::isfinite;
    if (position.size() != weight.size() + 2)
        throw_invalid(where,
                      "positions must be two more than weights: both supports and every weight",
                      position.size());
    for (Index j = 0; j < weight.size(); ++j) require_positive(where, "weight", weight[j]);
    for (Index j = 0; j < position.size(); ++j)
        if (!isfinite(position[j]) || (j > 0 && !(position[j - 1] < position[j])))
            throw_invalid(
                where,
                "positions must be finite and increase, position " + std::to_string(j) + " too",
                position[j]);
}

}  // namespace detail

inline ForceDiagram force_diagram(const Chain<double>& chain, const SteadyShape& shape) {
    detail::check_shape("force_diagram", chain, shape);
    const Index n = chain.size();
    const auto exact = finite::links_of(chain);
    const auto links = finite::rounded<double>(exact.links);
    const auto weight = [&](double x) { return std::ldexp(x, exact.units.weight_exponent); };
    ForceDiagram d;
    d.conical_height = shape.conical_height;
    for (auto* points : {&d.load, &d.ray, &d.reaction, &d.centre_of_gravity}) points->resize(n, 2);
    d.pin.resize(n + 1, 2), d.lifted.resize(n), d.crossing.resize(n);
    d.pin.col(0) = shape.offset, d.pin.col(1) = shape.height;
    const double lambda = shape.conical_height;
    double outwards = 0, hung = 0;       // sums of all loads so far
    double from_above = 0, carried = 0;  // load of the link below on the pin
    double moment_x = 0, moment_z = 0;   // weights times coordinates of the centroids
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
        moment_x += link.moment * lower + link.rest * upper,
            moment_z += link.moment * low + link.rest * high;
        d.centre_of_gravity.row(m) << moment_x / (hung + link.rest), moment_z / (hung + link.rest);
        d.crossing[m] = upper == 0 ? high : high + upper / across * (high - low);
    }
    return d;
}

inline Chain<double> transferred_to_axis(const Chain<double>& chain, const SteadyShape& shape) {
    detail::check_shape("transferred_to_axis", chain, shape);
    std::vector<Link<double>> links;
    for (Index m = 0; m < chain.size(); ++m) {
        Link<double> link = chain.link(m);
        const double cosine = std::cos(shape.inclination[m]);
        link.length *= cosine, link.centroid *= cosine;  // the ratio of gyration stays
        links.push_back(link);
    }
    return Chain<double>(links);
}

template <Real T>
FunicularPolygon<T> funicular_polygon(const std::type_identity_t<Vector<T>>& weight,
                                      const std::type_identity_t<Vector<T>>& position,
                                      const T& horizontal_tension, const T& first_height,
                                      const T& last_height) {
    using std::hypot, std::isfinite;
    constexpr std::string_view where = "funicular_polygon";
    const Index n = weight.size();
    detail::check_string(where, weight, position);
    detail::require_positive(where, "horizontal tension", horizontal_tension);
    if (!(position.cwiseAbs().maxCoeff() <= std::numeric_limits<T>::max() * epsilon<T>()))
        detail::throw_invalid(where,
                              "positions must not be so near the end of the range of numbers",
                              position[n + 1]);
    for (const T& height : {first_height, last_height})
        if (!isfinite(height))
            detail::throw_invalid(where, "heights of the supports must be finite", height);
    FunicularPolygon<T> polygon{position, Vector<T>(n + 2), Vector<T>(n + 1), Vector<T>(n + 1),
                                horizontal_tension};
    using S = Wide<T>;
    const auto wide = [](const T& x) { return S(static_cast<Narrow<S>>(x)); };
    const S end = wide(position[n + 1]), span = end - wide(position[0]),
            pull = wide(horizontal_tension);
    // Moments about the last support give the load of the first one.
    S lifts = pull * (wide(first_height) - wide(last_height)) / span;
    for (Index j = 0; j < n; ++j)
        lifts = lifts + wide(weight[j]) * (end - wide(position[j + 1])) / span;
    S rise = -lifts, height = wide(first_height);
    polygon.height[0] = first_height;
    for (Index j = 0; j <= n; ++j) {
        if (j > 0) rise = rise + wide(weight[j - 1]);
        polygon.rise[j] = static_cast<T>(rise);
        polygon.tension[j] = hypot(horizontal_tension, polygon.rise[j]);
        height = height + rise / pull * (wide(position[j + 1]) - wide(position[j]));
        polygon.height[j + 1] = static_cast<T>(height);
    }
    polygon.height[n + 1] = last_height;
    if (!polygon.height.allFinite() || !polygon.tension.allFinite())
        detail::throw_invalid(
            where, "the polygon leaves the range of numbers, with a horizontal tension of",
            horizontal_tension);
    return polygon;
}

template <Real T>
TransverseModes<T> transverse_modes(const std::type_identity_t<Vector<T>>& weight,
                                    const std::type_identity_t<Vector<T>>& position,
                                    const T& tension) {
    using std::isfinite, std::ldexp;
    constexpr std::string_view where = "transverse_modes";
    const Index n = weight.size();
    if (n == 0) detail::throw_invalid(where, "there must be a weight; their number is", n);
    detail::check_string(where, weight, position);
    detail::require_positive(where, "tension", tension);
    // The string hangs as a chain from its last support. A weight 2^(digits + 47) times all others
    // replaces the first support: it stretches the chain evenly and does not move, both to far less
    // than a rounding. Mode k of the string is mode k + 1 of the chain, with the height multiplied
    // by `factor`.
    const T unit = detail::inverse_power_near(weight.maxCoeff());
    T total(0);
    for (Index j = 0; j < n; ++j) total += weight[j] * unit;
    const T heavy =
        ldexp(T(1) / detail::inverse_power_near(total), std::numeric_limits<T>::digits + 47);
    std::vector<Link<T>> links{plummet<T>(heavy, position[1] - position[0])};
    for (Index j = 0; j < n; ++j)
        links.push_back(plummet<T>(weight[j] * unit, position[j + 2] - position[j + 1]));
    const Modes<T> found = modes(Chain<T>(links), {.first = 2, .count = all_modes});
    const T factor = heavy / (tension * unit);
    TransverseModes<T> result{found.conical_height, found.error_bound, found.shapes()};
    for (Index k = 0; k < found.size(); ++k) {
        result.conical_height[k] = found.conical_height[k] * factor;
        if (!isfinite(result.conical_height[k]) || result.conical_height[k] == T(0))
            detail::throw_invalid(
                where, "the conical heights leave the range of numbers, with a tension of",
                tension);
        result.error_bound[k] += T(3) * epsilon<T>();
        if (result.shape(k, 1) < T(0)) result.shape.row(k) = -result.shape.row(k);
        result.shape(k, 0) = result.shape(k, n + 1) =
            T(0);  // the heavy weight moves less than 2^-digits
    }
    return result;
}

}  // namespace revchain
