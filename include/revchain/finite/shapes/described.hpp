// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numbers>

#include "revchain/conical_pendulum.hpp"
#include "revchain/finite/balance/newton.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD {

struct SteadyShape;  // revchain/steady_shapes.hpp

namespace finite {

/// Returns g/n^2 in double-double; infinite or 0 if out of range.
REVCHAIN_LAZY
Fine height_at_speed(double angular_speed, double gravity) {
    int of_speed = 0, of_gravity = 0;
    const Fine n(std::frexp(angular_speed, &of_speed)), g(std::frexp(gravity, &of_gravity));
    return ldexp(g / n / n, of_gravity - 2 * of_speed);
}

/// Returns angle + pi, or angle - pi if `backwards`, rounded once.
REVCHAIN_LAZY
double beyond(double angle, bool backwards) {
    const DoubleWord<double> sum = two_sum(backwards ? -std::numbers::pi : std::numbers::pi, angle);
    return sum.high + (sum.low + (backwards ? -1.2246467991473532e-16 : 1.2246467991473532e-16));
}

/// A shape of a chain or a rig from the offsets of its pins, without error bound.
template <class Shape = SteadyShape, class AnyLinks>
Shape described(const AnyLinks& chain, const Fine& height, const Balanced<Fine>& found) {
    const std::vector<double> hung = chain.hung();
    const std::size_t n = chain.links.size();
    const auto size = static_cast<Index>(n);
    const auto length = [&](const Fine& x) {
        return std::ldexp(as_double(x), chain.units.length_exponent);
    };
    const auto weight = [&](double x) { return std::ldexp(x, chain.units.weight_exponent); };
    Shape shape;
    shape.inclination.resize(size), shape.tension.resize(size),
        shape.reaction_inclination.resize(size);
    shape.offset.resize(size + 1), shape.height.resize(size + 1);
    std::vector<Fine> up(n + 1);
    for (std::size_t m = n; m-- > 0;)
        up[m] = up[m + 1] - cosine_in(found, chain.links, m) * chain.links[m].length;
    Fine sideways(0), energy(0), inertia(0);  // sideways: lambda times the pull at the upper pin
    double last_sign = 0, reach = 0, worst_moment = 0;
    for (std::size_t m = 0; m <= n; ++m) {
        const auto i = static_cast<Index>(m);
        shape.offset[i] = length(found.offset[m]), shape.height[i] = length(up[m]);
        if (m == n) break;
        const Link<Fine>& link = chain.links[m];
        const Fine &lower = found.offset[m], &upper = found.offset[m + 1];
        if (const double y = as_double(lower); y != 0) {
            if (y * last_sign < 0) ++shape.half_waves;
            last_sign = y > 0 ? 1 : -1;
        }
        const Fine d = lower - upper, cosine = cosine_in(found, chain.links, m),
                   tangent = tangent_in(found, chain.links, m);
        const double inclination = std::atan(as_double(tangent));
        shape.inclination[i] = found.stands(m) ? beyond(inclination, d < Fine(0)) : inclination;
        // `left` is lambda times the moment about the upper pin over the length
        const Fine left =
            height * link.pull * tangent + link.cross * d - sideways - link.moment * lower;
        worst_moment =
            std::max(worst_moment, std::abs(as_double(left * link.length * cosine / height)));
        reach += as_double(link.length);
        sideways = sideways + link.moment * lower + link.rest * upper;
        const double across = as_double(sideways / height);
        shape.tension[i] = weight(std::hypot(hung[m], across));
        shape.reaction_inclination[i] = std::atan2(across, hung[m]);
        // (lower, upper) [A X; X B] (lower, upper), with A + X = moment and X + B = rest
        inertia =
            inertia + link.moment * lower * lower + link.rest * upper * upper - link.cross * d * d;
        energy = energy - link.pull * link.length * cosine;
    }
    shape.residual = worst_moment / (chain.total_weight * reach);
    shape.conical_height = length(height);
    shape.moment_of_inertia =
        weight(std::ldexp(as_double(inertia), 2 * chain.units.length_exponent));
    shape.effective_energy = weight(length(energy - inertia / (Fine(2) * height)));
    chain.add_support(shape, height, found);
    return shape;
}

}  // namespace finite
}  // namespace revchain
