// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "revchain/finite/balance/link_equation.hpp"
#include "revchain/finite/balance/links.hpp"
#include "revchain/finite/held/shape.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A shape given by its links, their inclinations and lambda times the pulls along them.
struct PulledLinks {
    std::vector<Link<Fine>> links;
    std::vector<double> inclination, pull;
    std::vector<double> doubt;  // errors of pulls over rounding
    double upper_offset = 0;
    std::vector<double> momentum, axial;  // of flywheels: lambda n times momentum, inertia
    std::vector<double> damping;  // lambda n times that of the dashpot at each upper pin; or empty
    double stiffness = std::numeric_limits<double>::infinity();  // lambda times that of the support
    double carriage = 0;
    double lower_stiffness = std::numeric_limits<double>::infinity();  // of a held lower end
    double lower_carriage = 0;
    bool held = false;         // whether the lower end is held too
    bool turns_freely = true;  // whether the support exerts no torque about the axis
    ChainUnits units;

    explicit PulledLinks(const ChainUnits& of) : units(of) {}

    bool yields() const { return !std::isinf(stiffness); }
    /// Returns true if the upper end is on a spring and moves no mass.
    bool top_is_massless() const {
        return yields() && carriage == 0 && is_zero(links.back().rest) &&
               is_zero(links.back().cross);
    }
    bool lower_yields() const { return held && !std::isinf(lower_stiffness); }

    /// Adds a link. Merges it with the last if they are in line and their pin has no mass and no
    /// dashpot.
    void add(const Link<Fine>& link, double delta, double pulled, double off, double turning = 0,
             double about = 0) {
        if (!links.empty()) {
            Link<Fine>& below = links.back();
            const bool massless = is_zero(below.rest) && is_zero(below.cross) &&
                                  is_zero(link.moment) && is_zero(link.cross);
            const bool plain = turning == 0 && about == 0 && momentum.back() == 0 &&
                               axial.back() == 0 && (damping.empty() || damping.back() == 0);
            const auto alike = [](double x, double z, double size) {
                return std::abs(x - z) <= 1e-9 * size;
            };
            if (massless && plain && alike(delta, inclination.back(), 1) &&
                alike(pulled, pull.back(), std::abs(pulled))) {
                below.length = below.length + link.length, below.rest = link.rest;
                return;
            }
        }
        links.push_back(link), inclination.push_back(delta), pull.push_back(pulled),
            doubt.push_back(off);
        momentum.push_back(turning), axial.push_back(about);
    }
};

/// lambda times the pull along each link, and its error over rounding.
struct Pulls {
    std::vector<double> pull, doubt;
};

/// Returns the pulls of a shape, from the force (H, tau) on the lowest pin, in the given units. A
/// pull is the load over the cosine or, for a nearly level link, the load resolved along the link.
template <class Shape>
Pulls pulls(const std::vector<Link<double>>& links, const Shape& shape, const ChainUnits& units,
            double H = 0, double tau = 0) {
    const auto length = [&](double x) { return std::ldexp(x, -units.length_exponent); };
    Pulls result;
    double sizes = std::abs(H);
    for (Index m = 0; m < shape.inclination.size(); ++m) {
        const Link<double>& link = links[static_cast<std::size_t>(m)];
        const double s = std::sin(shape.inclination[m]), c = std::cos(shape.inclination[m]);
        const double lower = link.moment * length(shape.offset[m]),
                     upper = link.rest * length(shape.offset[m + 1]);
        const double R = H + lower, V = length(shape.conical_height) * link.pull + tau;
        const double turned = link.cross * link.length * s;
        sizes += std::abs(lower);
        const double over = V / c, off_over = std::abs(over) * (1 + std::abs(s / c)),
                     off_along = std::abs(V * c) + (sizes + std::abs(turned)) * std::abs(s);
        H = R + upper, sizes += std::abs(upper);
        result.pull.push_back(off_over < off_along ? over : V * c + (R - turned) * s);
        result.doubt.push_back(std::min(off_over, off_along));
    }
    return result;
}

REVCHAIN_LAZY
PulledLinks pulled_links(const Links<Fine>& chain, const SteadyShape& shape) {
    PulledLinks result(chain.units);
    const std::vector<Link<double>> links = rounded<double>(chain.links);
    const auto [pull, doubt] = pulls(links, shape, chain.units);
    for (std::size_t i = 0; i < links.size(); ++i)
        result.add(chain.links[i], shape.inclination[static_cast<Index>(i)], pull[i], doubt[i]);
    return result;
}

REVCHAIN_LAZY
PulledLinks pulled_links(const Links<Fine>& chain, const HeldShape& shape) {
    const auto length = [&](double x) { return std::ldexp(x, -chain.units.length_exponent); };
    const auto weight = [&](double x) { return std::ldexp(x, -chain.units.weight_exponent); };
    PulledLinks result(chain.units);
    result.links = chain.links, result.held = true;
    const auto& [lower, upper] = shape.ends;
    result.turns_freely = lower.radius == 0 && upper.radius == 0;
    result.stiffness = weight(upper.stiffness.high),
    result.carriage = weight(upper.carriage_weight);
    result.lower_stiffness = weight(lower.stiffness.high),
    result.lower_carriage = weight(lower.carriage_weight);
    result.momentum.resize(result.links.size()), result.axial.resize(result.links.size());
    result.inclination.assign(shape.inclination.begin(), shape.inclination.end());
    const double H = length(weight(-shape.lower_pull[0])),
                 tau = length(weight(shape.lower_pull[1]));
    Pulls found = pulls(rounded<double>(chain.links), shape, chain.units, H, tau);
    result.pull = std::move(found.pull), result.doubt = std::move(found.doubt);
    result.upper_offset = length(shape.offset[shape.inclination.size()]);
    return result;
}

/// Throws InvalidArgument unless a shape has the links of a chain.
template <class Shape>
void require_shape_of(const Chain<double>& chain, const Shape& shape) {
    const Index size = shape.inclination.size();
    if (size != chain.size())
        detail::throw_invalid("stability", "the shape is not of this chain; its links number",
                              size);
    const double rounding = 1e-12 * (chain.total_length() + std::abs(shape.offset[chain.size()]));
    for (Index m = 0; m < chain.size(); ++m) {
        const double across = shape.offset[m] - shape.offset[m + 1],
                     along = shape.height[m] - shape.height[m + 1];
        const double length = std::hypot(across, along);
        if (std::abs(length - chain.length()[m]) <= rounding) continue;
        const std::string link = "links[" + std::to_string(m) + "]";
        detail::throw_invalid("stability",
                              "the shape is not of this chain; in it " + link + " is as long as",
                              length);
    }
}

}  // namespace revchain::finite
