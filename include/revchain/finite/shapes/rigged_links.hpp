// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/shapes/described.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/system/rig_links.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The links of a rig at a speed, and its support. `pull` is the effective tension sigma + n H/a,
/// with H the momentum of flywheels. `moment`, `rest` and `cross` are of the moving weights.
///
/// With a negative pull the tangent decreases as the load grows. A link of length -a and pull
/// -sigma at the opposite inclination obeys the same equations: `swept_links` returns that link.
struct RiggedLinks : Links<Fine> {
    std::vector<detail::RigLink> given;
    std::vector<Posture> posture;
    Fine speed{0.0};  ///< n, signed; 0 without momentum
    SupportEnd<Fine> support{};
    Fine axial_moment{0.0};   ///< of flywheels that turn with the links, about the links
    double total_weight = 0;  ///< total weight of the chain

    bool turned(std::size_t m) const { return links[m].pull < Fine(0); }
    /// Converts tangents of swept links to those of given ones, or back.
    template <class T>
    void turn(std::vector<Interval<T>>& tangents) const {
        for (std::size_t m = 0; m < tangents.size(); ++m)
            if (turned(m)) tangents[m] = -tangents[m];
    }
};

/// Returns sigma + n H/a. It may cancel, so it is enclosed in double-double first.
template <class T>
Interval<T> effective_tension(const detail::RigLink& link, const Fine& speed) {
    if (link.spin == Fine(0)) return enclosed<T>(link.tension);
    const Span pull = enclosed<Far>(link.tension) + enclosed<Far>(speed) * enclosed<Far>(link.spin);
    return {detail::down(static_cast<T>(pull.low)), detail::up(static_cast<T>(pull.high))};
}

inline const SupportEnd<Fine>& support_of(const RiggedLinks& rig) { return rig.support; }
inline const std::vector<Posture>& posture_of(const RiggedLinks& rig) { return rig.posture; }
REVCHAIN_LAZY
bool may_all_stand(const RiggedLinks&) { return true; }

template <class T>
EnclosedLinks<T> swept_links(const RiggedLinks& rig) {
    EnclosedLinks<T> result = enclosed<T>(rig.links);
    for (std::size_t m = 0; m < result.size(); ++m) {
        result[m].pull = effective_tension<T>(rig.given[m], rig.speed);
        if (rig.turned(m)) result[m].pull = -result[m].pull, result[m].length = -result[m].length;
    }
    return result;
}

/// Returns 1 - W/(lambda E), W all moving weight: the part of the spring's stiffness for its pin.
template <class T>
Interval<T> left_to_the_spring(const EnclosedLinks<T>& links,
                               const SupportEnd<Interval<T>>& support) {
    Interval<T> moving = support.carriage;
    for (const Link<Interval<T>>& link : links) moving = moving + link.moment + link.rest;
    return Interval<T>(T(1)) - support.compliance * moving;
}

/// Returns an upper bound for the tangent of the lowest link of a rig in either posture, from
/// lambda pull t + a X s = moment y. The topmost pin is at most (|b| + sum of sigma a/(lambda
/// E))/|1 - W/(lambda E)| from the axis, the others at most the links' reach from it. If lambda E
/// is W, to rounding, there is no bound. The result is then as if they were 1e-6 apart.
template <class T>
T farthest_tangent(const EnclosedLinks<T>& links, const Interval<T>& height, bool,
                   const SupportEnd<Interval<T>>& support) {
    Interval<T> reach(T(0)), moving(T(0)), drawn(support.radius.size());
    for (const Link<Interval<T>>& link : links) {
        reach = reach + Interval<T>(link.length.size());
        if (!support.firm)
            drawn = drawn +
                    support.compliance * Interval<T>(((moving + link.moment) * link.length).size());
        moving = moving + link.moment + link.rest;
    }
    if (!support.firm) {
        const Interval<T> left = left_to_the_spring(links, support);
        drawn = drawn / (left.may_vanish() ? Interval<T>(T(1e-6)) : left.negative() ? -left : left);
    }
    const Interval<T> turning = links[0].length * links[0].cross;
    const Interval<T> far =
        (Interval<T>(links[0].moment.size()) * (reach + drawn) + Interval<T>(turning.size())) /
        (height * links[0].pull);
    return far.high;
}

/// Returns a shape of a rig from the offsets of its pins. Half waves count the support. The energy
/// includes the spring's and - n H cos of inclinations, the moment of inertia the carriage's.
template <class Shape = SteadyShape>
Shape described(const RiggedLinks& rig, const Fine& height, const Balanced<Fine>& found) {
    std::vector<double> hung;
    for (const detail::RigLink& link : rig.given) hung.push_back(as_double(link.hung));
    Shape shape = described<Shape>(rig, height, found, hung, rig.total_weight);
    const Fine top = found.offset.back();
    double last = 0;
    for (const double y : shape.offset.head(shape.offset.size() - 1))
        if (y != 0) last = y;
    if (as_double(top) * last < 0) ++shape.half_waves;
    const SupportEnd<Fine>& support = rig.support;
    const Fine drawn = top - support.radius,
               inertia = rig.axial_moment + (support.firm ? Fine(0) : support.carriage * top * top);
    Fine energy = -inertia / (Fine(2) * height);
    if (!support.firm) energy = energy + support.stiffness * drawn * drawn / (Fine(2) * height);
    const int weight = rig.units.weight_exponent, length = rig.units.length_exponent;
    shape.moment_of_inertia += std::ldexp(as_double(inertia), weight + 2 * length);
    shape.effective_energy += std::ldexp(as_double(energy), weight + length);
    return shape;
}

/// Returns a rig at a height and a speed in its own units. Throws InvalidArgument if an effective
/// tension, or the moment of the moving weight of the lowest link, cannot be distinguished from 0.
REVCHAIN_LAZY
RiggedLinks rigged_links(const Rig& rig, const Fine& height, const Fine& speed) {
    RiggedLinks result;
    result.units = rig.chain().units();
    result.given = detail::rig_links(rig);
    result.total_weight = std::ldexp(rig.chain().total_weight(), -result.units.weight_exponent);
    if (rig.has_momentum()) result.speed = speed;
    for (Index m = 0; m < rig.size(); ++m) {
        const detail::RigLink& link = result.given[static_cast<std::size_t>(m)];
        const Fine pull =
            link.spin == Fine(0) ? link.tension : link.tension + result.speed * link.spin;
        const auto reject = [&](std::string_view what) {
            detail::throw_invalid("steady_shapes",
                                  "links[" + std::to_string(m) + "]: " + std::string(what),
                                  pull.high);
        };
        if (effective_tension<Far>(link, result.speed).may_vanish())
            reject(
                "the effective tension (tension and n times momentum over length) must not vanish "
                "at this speed");
        if (m == 0 && enclosed<Far>(link.moment).may_vanish())
            reject("the lowest link's weight that moves must not balance about its upper pin");
        result.links.push_back({link.length, pull, link.cross, link.moment, link.rest});
        result.posture.push_back(rig.stands(m) ? Posture::stands : Posture::hangs);
        result.axial_moment = result.axial_moment + ldexp(rig.flywheel(m).axial_moment,
                                                          -result.units.weight_exponent -
                                                              2 * result.units.length_exponent);
    }
    const Support& held = rig.support();
    const auto length = [&](double x) {
        return Fine(std::ldexp(x, -result.units.length_exponent));
    };
    const Fine none(0.0), radius = length(held.radius);
    result.support = {radius, none, none, none, held.radius == 0, held.is_firm()};
    if (!held.is_firm()) {
        const Fine stiffness =
            ldexp(held.stiffness, result.units.length_exponent - result.units.weight_exponent);
        result.support.stiffness = ldexp(height, -result.units.length_exponent) * stiffness;
        result.support.compliance = Fine(1.0) / result.support.stiffness;
        result.support.carriage =
            Fine(std::ldexp(held.carriage_weight, -result.units.weight_exponent));
    }
    return result;
}

}  // namespace revchain::finite
