// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/conical_pendulum.hpp"
#include "revchain/finite/held/curve.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/rig.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// A steady shape of a chain held at both ends, in the units of the chain: links lowest first, pins
/// from the lower end up. Forces are times the conical height lambda (weight times length), so they
/// exist without gravity too. Without gravity weights are masses, and forces these numbers times
/// n^2.
struct HeldShape {
    Vector<double> inclination;  ///< (N) to the upward vertical, rad, in (-pi, pi]; sign of §8
    Vector<double> offset;       ///< (N + 1) of pins; with ends on the axis 0, the second positive
    Vector<double> height;       ///< (N + 1) of pins above the lower end; the last the span
    Vector<double> height_times_tension;  ///< (N + 1) lambda times the force through each pin
    Vector<double> force_inclination;     ///< (N + 1) of that upward force to the vertical, rad
    std::array<double, 2> lower_pull;     ///< lambda times pull on the lower bearing: outwards, up
    std::array<double, 2> upper_pull;     ///< on the upper bearing; up is negative if it hangs
    int half_waves = 1;  ///< 1 + side changes of pins about the line between the rested ends
    double span = 0, conical_height = 0;
    std::array<Support, 2> ends{};  ///< lower and upper support, stiffness times the height
    double residual = 0;            ///< larger of relative moment about a pin and gap over length
    double error_bound = 0;         ///< of every inclination, rad
    bool proved = false;            ///< whether `error_bound` is proved; else it is an estimate
    double condition =
        0;  ///< largest change of an inclination per relative change of span or height
    double moment_of_inertia = 0;  ///< about the axis, weight times length squared, with carriages
    double height_times_energy = 0;  ///< lambda (potential energy) - moment_of_inertia / 2

    /// Returns the speed in rad/s. Throws InvalidArgument without gravity: any speed has this
    /// shape.
    double angular_speed(double gravity = conical_pendulum::standard_gravity) const {
        return conical_pendulum::angular_speed(conical_height, gravity);
    }
};

namespace finite {

/// Counts half waves: changes of side of pins about the line between the rested ends, plus 1.
template <class S>
struct Sides {
    const HeldEnds<S>& ends;
    const S& span;
    int half_waves = 1;
    double last = 0;

    void operator()(const S& y, const S& z) {
        const S& foot = ends.lower.radius;
        const S beside = ends.is_symmetric() ? y : y - foot - (ends.upper.radius - foot) * z / span;
        const double sign = beside > S(0) ? 1 : -1;
        if (sign * last < 0) ++half_waves;
        last = sign;
    }
};

/// Returns the shape for forces at the lower end, with directions near `direction`.
REVCHAIN_LAZY
HeldShape described(const Links<Fine>& chain, const HeldEnds<Fine>& ends,
                    const HeldForces<Fine>& forces, const Fine& span,
                    std::vector<Direction<Fine>>& direction) {
    const auto size = static_cast<Index>(chain.links.size());
    const auto narrow = [](const Fine& x) { return as_double(x); };
    const auto in_long = [](const Fine& x) { return static_cast<long double>(Far(x)); };
    const auto length = [&](double x) { return std::ldexp(x, chain.units.length_exponent); };
    const auto moment = [&](double x) {
        return std::ldexp(x, chain.units.length_exponent + chain.units.weight_exponent);
    };
    HeldShape shape;
    for (Vector<double>* v :
         {&shape.offset, &shape.height, &shape.height_times_tension, &shape.force_inclination})
        v->setZero(size + 1);
    shape.inclination.resize(size);
    Fine rise(0), hung(0), inertia(0), energy(0), spring(0);
    double reach = 0;
    const auto through = [&](Index pin, double across, double along) {
        shape.height_times_tension[pin] = moment(std::hypot(across, along));
        shape.force_inclination[pin] = std::atan2(across, along);
    };
    Sides<Fine> sides{ends, span};
    const SupportEnd<Fine>&lower = ends.lower, &upper = ends.upper;
    const Fine foot = lower.firm ? lower.radius : lower.radius - lower.compliance * forces.across;
    const Fine push = lower.firm ? forces.across : forces.across + lower.carriage * foot;
    through(0, narrow(push), narrow(forces.along));
    shape.offset[0] = length(narrow(foot));
    if (!lower.firm) sides(foot, Fine(0));
    Fine head(0);
    std::vector<HeldChange<double>> turned;
    const HeldEnd<Fine> end = held_sweep(
        chain.links, ends, forces, direction,
        [&](std::size_t m, const Fine& y, const Fine& R, const Fine& H, const Fine& stiffness,
            const HeldChange<Fine>& change) {
            const Link<Fine>& link = chain.links[m];
            const auto i = static_cast<Index>(m);
            const auto& [s, c] = direction[m];
            head = y - link.length * s;
            const Fine top = rise + link.length * c;
            const Fine V = forces.height * link.pull + forces.along;
            const Fine unbalanced = V * s + link.length * link.cross * s * c - R * c;
            shape.residual = std::max(shape.residual, std::abs(narrow(unbalanced / stiffness)));
            shape.inclination[i] = as_double(std::atan2(in_long(s), in_long(c)));
            inertia = inertia + link.moment * y * y + link.rest * head * head -
                      link.cross * link.length * link.length * s * s;
            energy = energy + link.moment * rise + link.rest * top;
            hung = hung + link.moment + link.rest;
            through(i + 1, narrow(H), narrow(forces.height * hung + forces.along));
            if (i + 1 < size || !upper.firm) sides(head, top);
            shape.offset[i + 1] = length(narrow(i + 1 == size && upper.firm ? upper.radius : head));
            shape.height[i + 1] = length(narrow(top));
            rise = top, reach += narrow(link.length);
            turned.push_back({narrow(change[0]), narrow(change[1]), narrow(change[2])});
        });
    shape.span = shape.height[size] = length(narrow(span));
    shape.conical_height = length(narrow(forces.height));
    const double gap = std::max(std::abs(narrow(end.offset)), std::abs(narrow(end.rise - span)));
    shape.residual = std::max(shape.residual, gap / reach);
    shape.half_waves = sides.half_waves;
    for (const bool above : {false, true}) {
        const SupportEnd<Fine>& held = above ? upper : lower;
        Support& support = shape.ends[above];
        support.radius = length(narrow(held.radius));
        if (held.firm) continue;
        const Fine y = above ? head : foot, drawn = y - held.radius;
        inertia = inertia + held.carriage * y * y, spring = spring + held.stiffness * drawn * drawn;
        support.stiffness = std::ldexp(narrow(held.stiffness), chain.units.weight_exponent);
        support.carriage_weight = std::ldexp(narrow(held.carriage), chain.units.weight_exponent);
    }
    shape.lower_pull = {moment(-narrow(push)), moment(narrow(forces.along))};
    shape.upper_pull = {moment(narrow(end.across)),
                        moment(-narrow(forces.along + forces.height * hung))};
    shape.moment_of_inertia = length(moment(narrow(inertia)));
    shape.height_times_energy =
        length(moment(narrow(forces.height * energy + (spring - inertia) / Fine(2))));

    // A change of span or height changes the two forces, and both change the links.
    const auto condition = [&](const Fine& y, const Fine& z, double direct) {
        const auto [across, along] = end.forces_to_move(y, z);
        const double a = narrow(across), b = narrow(along);
        for (const HeldChange<double>& t : turned)
            shape.condition =
                std::max(shape.condition, std::abs(t[0] * a + t[1] * b + t[2] * direct));
    };
    const Fine& lambda = forces.height;
    condition(Fine(0), span, 0);
    condition(-end.offset_change[2] * lambda, -end.rise_change[2] * lambda, narrow(lambda));
    shape.error_bound = epsilon<double>() * (2 + shape.condition);
    return shape;
}

}  // namespace finite
}  // namespace revchain
