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
/// -sigma at the opposite inclination obeys the same equations: `links_for_sweep` returns that
/// link.
struct RiggedLinks : Links<Fine> {
    std::vector<detail::RigLink> given;
    std::vector<Posture> posture;
    Fine speed{0.0};  ///< n, signed; 0 without momentum
    SupportEnd<Fine> support{};
    Fine axial_moment{0.0};  ///< of flywheels that turn with the links, about the links

    const SupportEnd<Fine>& upper_end() const { return support; }
    const std::vector<Posture>& postures() const { return posture; }
    static bool may_all_stand() { return true; }
    bool turned(std::size_t m) const { return links[m].pull < Fine(0); }
    template <class T>
    EnclosedLinks<T> links_for_sweep() const;
    std::vector<double> hung() const {
        std::vector<double> weights;
        for (const detail::RigLink& link : given) weights.push_back(as_double(link.hung));
        return weights;
    }
    /// Half waves count the support; the energy includes the spring's and - n H cos of the
    /// inclinations, the moment of inertia the carriage's.
    template <class Shape, class Found>
    void add_support(Shape& shape, const Fine& height, const Found& found) const;
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

template <class T>
EnclosedLinks<T> RiggedLinks::links_for_sweep() const {
    EnclosedLinks<T> result = enclosed<T>(links);
    for (std::size_t m = 0; m < result.size(); ++m) {
        result[m].pull = effective_tension<T>(given[m], speed);
        if (turned(m)) result[m].pull = -result[m].pull, result[m].length = -result[m].length;
    }
    return result;
}

template <class Shape, class Found>
void RiggedLinks::add_support(Shape& shape, const Fine& height, const Found& found) const {
    const Fine top = found.offset.back();
    double last = 0;
    for (const double y : shape.offset.head(shape.offset.size() - 1))
        if (y != 0) last = y;
    if (as_double(top) * last < 0) ++shape.half_waves;
    const Fine drawn = top - support.radius,
               inertia = axial_moment + (support.firm ? Fine(0) : support.carriage * top * top);
    Fine energy = -inertia / (Fine(2) * height);
    if (!support.firm) energy = energy + support.stiffness * drawn * drawn / (Fine(2) * height);
    const int of_weight = units.weight_exponent, of_length = units.length_exponent;
    shape.moment_of_inertia += std::ldexp(as_double(inertia), of_weight + 2 * of_length);
    shape.effective_energy += std::ldexp(as_double(energy), of_weight + of_length);
}

/// Returns a rig at a height and a speed in its own units. Throws InvalidArgument if an effective
/// tension, or the moment of the moving weight of the lowest link, cannot be distinguished from 0.
REVCHAIN_LAZY
RiggedLinks rigged_links(const Rig& rig, const Fine& height, const Fine& speed) {
    if (rig.has_pin_springs() || rig.has_drag() || rig.support().damping.high > 0)
        detail::require_no_pins("steady_shapes", "steady shapes", rig, false);
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
        // A trolley that rolls freely has a spring that is too soft to be seen in double words.
        constexpr double unseen = 0x1p-200;
        result.support.stiffness = held.is_free()
                                       ? Fine(unseen)
                                       : ldexp(height, -result.units.length_exponent) * stiffness;
        result.support.compliance = Fine(1.0) / result.support.stiffness;
        result.support.carriage =
            Fine(std::ldexp(held.carriage_weight, -result.units.weight_exponent));
    }
    return result;
}

}  // namespace revchain::finite
