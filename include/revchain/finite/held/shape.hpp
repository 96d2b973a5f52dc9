// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/conical_pendulum.hpp"
#include "revchain/finite/held/curve.hpp"

namespace revchain {

/// One steady shape of a chain whose two ends are held on the axis: links lowest first, pins from the lower end up, in
/// the units of the chain.
///
/// Forces are given times the conical height lambda, weight times length: a number with gravity and without it. Over
/// lambda they are in the unit of the weights; without gravity weights stand for masses, and forces are these numbers
/// times n^2.
struct HeldShape {
    Vector<double> inclination;  ///< (N) of each link to the upward vertical, rad, within (-pi, pi]; §8's sign
    Vector<double> offset;       ///< (N + 1) of each pin from the axis; both ends 0, the second positive
    Vector<double> height;       ///< (N + 1) of each pin above the lower end; the last the span
    Vector<double> height_times_tension;  ///< (N + 1) lambda times the force through each pin
    Vector<double> force_inclination;     ///< (N + 1) of that force, as it pulls upwards, to the vertical, rad
    std::array<double, 2> lower_pull;     ///< lambda times the chain's pull on its lower bearing: outwards, and up
    std::array<double, 2> upper_pull;     ///< the same on the upper bearing: up is negative where it hangs
    int half_waves = 1;                   ///< sign changes of the offsets, and one
    double span = 0, conical_height = 0;
    double residual = 0;  ///< largest moment left over about a pin, over the force and the length; of the ends, a gap
    double error_bound = 0;          ///< of every inclination, rad
    bool proved = false;             ///< whether that is proved, else it is an estimate
    double condition = 0;            ///< largest change of an inclination for a relative change 1 of span or height
    double moment_of_inertia = 0;    ///< about the axis, weight times length squared
    double height_times_energy = 0;  ///< lambda times (sum of weight times height) less moment_of_inertia / 2

    /// rad/s. Throws InvalidArgument where there is no gravity: then any speed has this shape.
    double angular_speed(double gravity = conical_pendulum::standard_gravity) const {
        return conical_pendulum::angular_speed(conical_height, gravity);
    }
};

namespace finite {

/// Everything about a shape from the forces at its lower end and the directions found there.
inline HeldShape described(const Links<Wide<double>>& chain, const HeldForces<Wide<double>>& forces,
                           const Wide<double>& span, std::vector<Direction<Wide<double>>>& direction) {
    using S = Wide<double>;
    const auto size = static_cast<Index>(chain.links.size());
    const auto narrow = [](const S& x) { return static_cast<double>(x); };
    const auto length = [&](double x) { return std::ldexp(x, chain.units.length_exponent); };
    const auto moment = [&](double x) {
        return std::ldexp(x, chain.units.length_exponent + chain.units.weight_exponent);
    };
    HeldShape shape;
    for (Vector<double>* v : {&shape.offset, &shape.height, &shape.height_times_tension, &shape.force_inclination})
        v->setZero(size + 1);
    shape.inclination.resize(size);
    S rise(0), hung(0), inertia(0), energy(0);
    double reach = 0, last_sign = 0;
    const auto through = [&](Index pin, double across, double along) {
        shape.height_times_tension[pin] = moment(std::hypot(across, along));
        shape.force_inclination[pin] = std::atan2(across, along);
    };
    through(0, narrow(forces.across), narrow(forces.along));
    std::vector<HeldChange<double>> turned;
    const HeldEnd<S> end = held_sweep(
        chain.links, forces, direction,
        [&](std::size_t m, const S& y, const S& R, const S& H, const S& growth, const HeldChange<S>& change) {
            const Link<S>& link = chain.links[m];
            const auto i = static_cast<Index>(m);
            const auto& [s, c] = direction[m];
            const S upper = y - link.length * s, top = rise + link.length * c;
            const S V = forces.height * link.pull + forces.along;
            const S left = V * s + link.length * link.cross * s * c - R * c;
            shape.residual = std::max(shape.residual, std::abs(narrow(left / growth)));
            shape.inclination[i] =
                static_cast<double>(std::atan2(static_cast<long double>(s.high) + static_cast<long double>(s.low),
                                               static_cast<long double>(c.high) + static_cast<long double>(c.low)));
            inertia = inertia + link.moment * y * y + link.rest * upper * upper -
                      link.cross * link.length * link.length * s * s;
            energy = energy + link.moment * rise + link.rest * top;
            hung = hung + link.moment + link.rest;
            through(i + 1, narrow(H), narrow(forces.height * hung + forces.along));
            if (i + 1 < size) {
                const double sign = upper > S(0) ? 1 : -1;
                if (sign * last_sign < 0) ++shape.half_waves;
                last_sign = sign;
                shape.offset[i + 1] = length(narrow(upper));
            }
            shape.height[i + 1] = length(narrow(top));
            rise = top, reach += narrow(link.length);
            turned.push_back({narrow(change[0]), narrow(change[1]), narrow(change[2])});
        });
    shape.span = shape.height[size] = length(narrow(span));
    shape.conical_height = length(narrow(forces.height));
    const double gap = std::max(std::abs(narrow(end.offset)), std::abs(narrow(end.rise - span)));
    shape.residual = std::max(shape.residual, gap / reach);
    shape.lower_pull = {moment(-narrow(forces.across)), moment(narrow(forces.along))};
    shape.upper_pull = {moment(narrow(end.across)), moment(-narrow(forces.along + forces.height * hung))};
    shape.moment_of_inertia = length(moment(narrow(inertia)));
    shape.height_times_energy = length(moment(narrow(forces.height * energy - inertia / S(2))));

    // What a change of the span, or of the height, asks of the two forces, and both of the links.
    const auto condition = [&](const S& y, const S& z, double direct) {
        const auto [across, along] = end.forces_to_move(y, z);
        const double a = narrow(across), b = narrow(along);
        for (const HeldChange<double>& t : turned)
            shape.condition = std::max(shape.condition, std::abs(t[0] * a + t[1] * b + t[2] * direct));
    };
    const S& lambda = forces.height;
    condition(S(0), span, 0);
    condition(-end.offset_change[2] * lambda, -end.rise_change[2] * lambda, narrow(lambda));
    // An estimate until something is proved: rounding in double of the data.
    shape.error_bound = epsilon<double>() * (2 + shape.condition);
    return shape;
}

}  // namespace finite
}  // namespace revchain
