// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>

#include "revchain/numeric/compiled.hpp"
#include "revchain/sensitivity.hpp"
#include "revchain/system/rig_links.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// The links of a rig at one speed n.
struct LinksAtSpeed {
    using S = Wide<double>;
    const Rig& rig;
    ChainUnits units = rig.chain().units();
    std::vector<RigLink> links = rig_links(rig);
    S speed, turning;  ///< n; n^2/g times the unit of length

    LinksAtSpeed(std::string_view place, const Rig& of, double angular_speed, double gravity)
        : rig(of), speed(angular_speed) {
        if (!std::isfinite(angular_speed) || angular_speed == 0)
            throw_invalid(place, "angular speed must be finite and not 0", angular_speed);
        require_positive(place, "gravity", gravity);
        if (of.has_pin_springs() || of.is_damped()) require_no_pins(place, "derivatives", of);
        turning = ldexp(speed * speed / S(gravity), units.length_exponent);
    }
    const RigLink& link(Index m) const { return links[static_cast<std::size_t>(m)]; }
    S sign(Index m) const { return S(rig.stands(m) ? -1.0 : 1.0); }
    S stiffness(Index m) const {
        return sign(m) * (link(m).tension + speed * link(m).spin) / link(m).length;
    }
    /// Dynamic stiffness at one pin of link m; `at` is the dynamic stiffness at its other pin.
    S across(Index m, const S& at, const S& near, const S& far) const {
        const S k = stiffness(m), coupling = k + turning * link(m).cross;
        return (k - turning * far) - coupling * coupling / (at + k - turning * near);
    }
    /// Dynamic stiffness of the links below index `end`, at their uppermost pin.
    S below(Index end) const {
        S found(0.0);
        for (Index m = 0; m < end; ++m) found = across(m, found, link(m).lower, link(m).upper);
        return found;
    }
    S carriage_weight() const {
        return S(std::ldexp(rig.support().carriage_weight, -units.weight_exponent));
    }
};

/// The offsets y of a mode, and the change dn of its speed for a change of the balance of forces.
struct RigMode : LinksAtSpeed {
    const Vector<double>& offset;
    std::vector<S> slope;  ///< s of each link
    S denominator{0.0};    ///< y^T G y - 2 y^T M y n/g

    RigMode(std::string_view place, const Rig& of, double angular_speed, const Vector<double>& y,
            double gravity)
        : LinksAtSpeed(place, of, angular_speed, gravity), offset(y) {
        if (y.size() != of.size() + 1)
            throw_invalid(place, "there must be " + std::to_string(of.size() + 1) + " offsets",
                          y.size());
        S inertia(0.0), momentum(0.0);  // y^T M y, y^T G y
        for (Index m = 0; m < of.size(); ++m) {
            const RigLink& it = link(m);
            const S lower(y[m]), upper(y[m + 1]), s = (lower - upper) / it.length;
            slope.push_back(s);
            inertia = inertia + (lower * (it.lower * lower + (it.cross + it.cross) * upper) +
                                 it.upper * upper * upper);
            momentum = momentum + sign(m) * (it.spin * it.length * s * s);
        }
        if (!of.support().is_firm()) inertia = inertia + carriage_weight() * top() * top();
        denominator = momentum - S(2.0) * turning * inertia / speed;
        if (!isfinite(denominator) || denominator == S(0.0))
            throw_invalid(
                place,
                "offsets must be finite and move a weight or tilt a flywheel at the angular speed",
                angular_speed);
    }
    S top() const { return S(offset[rig.size()]); }
    /// Returns dn for a change x of y^T (stiffness - n^2/g mass) y, divided by these powers of the
    /// units.
    double rate(const S& x, int weight_power, int length_power) const {
        return std::ldexp(
            static_cast<double>(-x / denominator),
            -weight_power * units.weight_exponent - length_power * units.length_exponent);
    }

    /// A body of a link, the offset of its centre, and the parts of dn for a unit of its weight.
    struct Body {
        S weight, centroid, gyration, centre, bears, moves;
        S resists(const S& s) const { return weight * s * (centroid * centre + gyration * s); }
    };
    Body body(Index m, double weight, double centroid, const S& ratio, const S& borne) const {
        const S h(std::ldexp(centroid, -units.length_exponent)), a = link(m).length;
        const S s = slope[static_cast<std::size_t>(m)], gyration = ratio * (a * a);
        const S centre = S(offset[m + 1]) + h * s;
        return {S(std::ldexp(weight, -units.weight_exponent)),
                h,
                gyration,
                centre,
                sign(m) * h * (s * s) + borne,
                turning * (centre * centre + gyration * (s * s))};
    }
};

/// Sets the derivatives by the data of link m. `above` sums a s^2 over the links above; standing
/// links count negative.
REVCHAIN_LAZY
void link_sensitivity(const RigMode& mode, Index m, const Wide<double>& above,
                      RigSensitivity& result) {
    using S = Wide<double>;
    const Rig& rig = mode.rig;
    const RigLink& link = mode.link(m);
    const S s = mode.slope[static_cast<std::size_t>(m)], square = s * s, sign = mode.sign(m);
    const S twice = mode.turning * S(2.0);
    const Link<double> own = rig.chain().link(m);
    const Displaced displaced = rig.displaced(m);
    const bool turns = rig.fluid() == Fluid::turning;
    const double moved = turns ? -displaced.weight : displaced.added_weight;
    const auto solid = mode.body(m, own.weight, own.centroid, own.gyration_ratio, above);
    const auto fluid = mode.body(m, moved, displaced.centroid, displaced.gyration_ratio, above);
    result.weight[m] = mode.rate(solid.bears - solid.moves, 1, 0);
    result.momentum[m] = mode.rate(sign * mode.speed * square, 1, 1);
    result.displaced_weight[m] = mode.rate(turns ? fluid.moves - fluid.bears : -fluid.bears, 1, 0);
    result.added_weight[m] = turns ? 0 : mode.rate(-fluid.moves, 1, 0);

    // With fixed pins, slopes are proportional to 1/a; kappa = W h - B h_B + a S.
    const S axial = ldexp(rig.flywheel(m).axial_moment,
                          -mode.units.weight_exponent - 2 * mode.units.length_exponent) *
                    square;
    S by_length(0.0);  // 0 for the lowest link: nothing hangs from its lower pin
    if (m > 0)
        by_length = sign * square *
                        (mode.link(m - 1).hung - S(2.0) * (link.tension + mode.speed * link.spin)) +
                    twice * (solid.resists(s) + fluid.resists(s) - axial) / link.length;
    const S by_centroid = solid.weight * (sign * square - twice * solid.centre * s);
    const S radius = sqrt(solid.gyration), by_radius = -(twice * solid.weight * radius * square);
    const S in_proportion = (solid.centroid * by_centroid + radius * by_radius) / link.length;
    result.length[m] = mode.rate(by_length, 0, 1);
    result.centroid[m] = mode.rate(by_centroid, 0, 1);
    result.radius_of_gyration[m] = mode.rate(by_radius, 0, 1);
    result.length_in_proportion[m] = mode.rate(by_length + in_proportion, 0, 1);
}

}  // namespace detail

REVCHAIN_DEFINE
RigSensitivity sensitivity(const Rig& rig, double angular_speed, const Vector<double>& offset,
                           double gravity) {
    const detail::RigMode mode("sensitivity", rig, angular_speed, offset, gravity);
    RigSensitivity result{};
    for (auto* column : {&result.weight, &result.length, &result.centroid,
                         &result.radius_of_gyration, &result.length_in_proportion, &result.momentum,
                         &result.displaced_weight, &result.added_weight})
        column->resize(rig.size());
    Wide<double> above(0.0);
    for (Index m = rig.size(); m-- > 0;) {
        detail::link_sensitivity(mode, m, above, result);
        const Wide<double> s = mode.slope[static_cast<std::size_t>(m)];
        above = above + mode.sign(m) * mode.link(m).length * (s * s);
    }
    if (!rig.support().is_firm()) {
        result.stiffness = mode.rate(mode.top() * mode.top(), 1, -1);
        result.carriage_weight = mode.rate(-mode.turning * mode.top() * mode.top(), 1, 0);
    }
    return result;
}

REVCHAIN_DEFINE
double momentum_for_speed(const Rig& rig, Index link, double angular_speed, double gravity) {
    using S = Wide<double>;
    constexpr std::string_view place = "momentum_for_speed";
    const detail::LinksAtSpeed links(place, rig, angular_speed, gravity);
    if (link < 0 || link >= rig.size())
        detail::throw_invalid(
            place, "link must be from 0, the lowest, to " + std::to_string(rig.size() - 1), link);
    const ChainUnits& units = links.units;
    const S turning = links.turning;
    S above(0.0);
    bool held = rig.support().is_firm();
    if (!held)
        above = ldexp(rig.support().stiffness, units.length_exponent - units.weight_exponent) -
                turning * links.carriage_weight();
    for (Index m = rig.size(); m-- > link + 1; held = false)
        above = held ? links.stiffness(m) - turning * links.link(m).lower
                     : links.across(m, above, links.link(m).upper, links.link(m).lower);
    const detail::RigLink& it = links.link(link);
    const S p = links.below(link) - turning * it.lower, q = above - turning * it.upper;
    const S x = turning * it.cross, k = held ? -p : (x * x - p * q) / (p + q - x - x);
    const S tension = links.sign(link) * k * it.length;
    const S needed_spin = (tension - it.tension) * it.length / S(angular_speed);
    const double needed =
        std::ldexp(needed_spin.high, units.weight_exponent + units.length_exponent);
    if (std::isfinite(needed)) return needed;
    detail::throw_invalid(place,
                          "no finite momentum of links[" + std::to_string(link) +
                              "] makes this a whirl speed; choose another link or angular speed",
                          angular_speed);
}

REVCHAIN_DEFINE
double stiffness_for_speed(const Rig& rig, double angular_speed, double gravity) {
    constexpr std::string_view place = "stiffness_for_speed";
    const detail::LinksAtSpeed links(place, rig, angular_speed, gravity);
    const Wide<double> sum = links.turning * links.carriage_weight() - links.below(rig.size());
    const double needed =
        std::ldexp(sum.high, links.units.weight_exponent - links.units.length_exponent);
    if (needed > 0 && std::isfinite(needed)) return needed;
    detail::throw_invalid(
        place, "no positive stiffness of the support makes this a whirl speed; choose another",
        angular_speed);
}

}  // namespace revchain
