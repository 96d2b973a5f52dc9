// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>

#include "revchain/numeric/compiled.hpp"
#include "revchain/sensitivity.hpp"
#include "revchain/system/rig_links.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Data that all derivatives of a whirl speed n use: the offsets y of its mode, and the change dn for a change of the
/// balance of forces.
struct RigMode {
    using S = Wide<double>;
    const Rig& rig;
    const Vector<double>& offset;
    std::vector<RigLink> links;
    S speed, turning;      ///< n; n^2/g times the unit of length
    std::vector<S> slope;  ///< s of each link
    S denominator{0.0};    ///< y^T G y - 2 y^T M y n/g

    RigMode(const Rig& of, double angular_speed, const Vector<double>& y, double gravity)
        : rig(of), offset(y), links(rig_links(of)), speed(angular_speed),
          turning(ldexp(speed * speed / S(gravity), of.chain().units().length_exponent)) {
        const ChainUnits units = rig.chain().units();
        const Index count = rig.size();
        S inertia(0.0), momentum(0.0);  // y^T M y, y^T G y
        for (Index m = 0; m < count; ++m) {
            const RigLink& link = links[static_cast<std::size_t>(m)];
            const S lower(offset[m]), upper(offset[m + 1]), s = (lower - upper) / link.length;
            slope.push_back(s);
            inertia = inertia +
                      (lower * (link.lower * lower + (link.cross + link.cross) * upper) + link.upper * upper * upper);
            const S spins = link.spin * link.length * s * s;
            momentum = momentum + (rig.stands(m) ? -spins : spins);
        }
        if (const Support& support = rig.support(); !support.is_firm())
            inertia = inertia + S(std::ldexp(support.carriage_weight, -units.weight_exponent)) * top() * top();
        denominator = momentum - S(2.0) * turning * inertia / speed;
    }
    S top() const { return S(offset[rig.size()]); }
    /// dn for a change x of y^T (stiffness - n^2/g mass) y, over units of weight and length to these powers.
    double rate(const S& x, int weight_power, int length_power) const {
        const ChainUnits units = rig.chain().units();
        return std::ldexp(static_cast<double>(-x / denominator),
                          -weight_power * units.weight_exponent - length_power * units.length_exponent);
    }

    /// A body of a link: where its centre of gravity is, and what a unit of its weight bears and resists.
    struct Body {
        S weight, centroid, gyration, centre, bears, moves;
        S resists(const S& s) const { return weight * s * (centroid * centre + gyration * s); }
    };
    Body body(Index m, double weight, double centroid, const S& ratio, const S& borne) const {
        const ChainUnits units = rig.chain().units();
        const S h(std::ldexp(centroid, -units.length_exponent)), a = links[static_cast<std::size_t>(m)].length,
            s = slope[static_cast<std::size_t>(m)], gyration = ratio * (a * a), centre = S(offset[m + 1]) + h * s;
        return {S(std::ldexp(weight, -units.weight_exponent)), h, gyration, centre, sign(m) * h * (s * s) + borne,
                turning * (centre * centre + gyration * (s * s))};
    }
    S sign(Index m) const { return S(rig.stands(m) ? -1.0 : 1.0); }
};

/// Derivatives for the numbers of link m; `above` is the sum of a s^2 over the links above it, less those that stand.
inline void link_sensitivity(const RigMode& mode, Index m, const Wide<double>& above, RigSensitivity& result) {
    using S = Wide<double>;
    const Rig& rig = mode.rig;
    const ChainUnits units = rig.chain().units();
    const RigLink& link = mode.links[static_cast<std::size_t>(m)];
    const S s = mode.slope[static_cast<std::size_t>(m)], square = s * s, sign = mode.sign(m), turning = mode.turning;
    const Link<double> own = rig.chain().link(m);
    const Displaced displaced = rig.displaced(m);
    const bool turns = rig.fluid() == Fluid::turning;
    const RigMode::Body solid = mode.body(m, own.weight, own.centroid, own.gyration_ratio, above);
    const RigMode::Body fluid = mode.body(m, turns ? -displaced.weight : displaced.added_weight, displaced.centroid,
                                          displaced.gyration_ratio, above);
    result.weight[m] = mode.rate(solid.bears - solid.moves, 1, 0);
    result.momentum[m] = mode.rate(sign * mode.speed * square, 1, 1);
    result.displaced_weight[m] = mode.rate(turns ? fluid.moves - fluid.bears : -fluid.bears, 1, 0);
    result.added_weight[m] = turns ? 0 : mode.rate(-fluid.moves, 1, 0);

    // Slopes go as 1/a where the pins stay; kappa = W h - B h_B + a S.
    const S two(2.0), below = m == 0 ? S(0.0) : mode.links[static_cast<std::size_t>(m - 1)].hung;
    const S axial =
        ldexp(rig.flywheel(m).axial_moment, -units.weight_exponent - 2 * units.length_exponent) * square;
    const S by_length = sign * square * (below - two * (link.tension + mode.speed * link.spin)) +
                        turning * two * (solid.resists(s) + fluid.resists(s) - axial) / link.length;
    const S by_centroid = solid.weight * (sign * square - turning * two * solid.centre * s);
    const S radius = sqrt(solid.gyration), by_radius = -(turning * two * solid.weight * radius * square);
    result.length[m] = m == 0 ? 0 : mode.rate(by_length, 0, 1);  // where nothing hangs, no pin matters
    result.centroid[m] = mode.rate(by_centroid, 0, 1);
    result.radius_of_gyration[m] = mode.rate(by_radius, 0, 1);
    result.length_in_proportion[m] = mode.rate(
        (m == 0 ? S(0.0) : by_length) + (solid.centroid * by_centroid + radius * by_radius) / link.length, 0, 1);
}

}  // namespace detail

REVCHAIN_INLINE RigSensitivity sensitivity(const Rig& rig, double angular_speed, const Vector<double>& offset,
                                           double gravity) {
    using S = Wide<double>;
    constexpr std::string_view place = "sensitivity";
    if (!std::isfinite(angular_speed) || angular_speed == 0)
        detail::throw_invalid(place, "angular speed must be finite and not 0", angular_speed);
    detail::require_positive(place, "gravity", gravity);
    if (offset.size() != rig.size() + 1)
        detail::throw_invalid(place, "there must be " + std::to_string(rig.size() + 1) + " offsets", offset.size());
    const detail::RigMode mode(rig, angular_speed, offset, gravity);
    if (!isfinite(mode.denominator) || mode.denominator == S(0.0))
        detail::throw_invalid(place, "offsets must be finite and move a weight or tilt a flywheel at the angular speed",
                              angular_speed);
    RigSensitivity result{};
    for (auto* column :
         {&result.weight, &result.length, &result.centroid, &result.radius_of_gyration, &result.length_in_proportion,
          &result.momentum, &result.displaced_weight, &result.added_weight})
        column->resize(rig.size());
    S above(0.0);
    for (Index m = rig.size(); m-- > 0;) {
        detail::link_sensitivity(mode, m, above, result);
        const S s = mode.slope[static_cast<std::size_t>(m)];
        above = above + mode.sign(m) * mode.links[static_cast<std::size_t>(m)].length * (s * s);
    }
    if (!rig.support().is_firm()) {
        result.stiffness = mode.rate(mode.top() * mode.top(), 1, -1);
        result.carriage_weight = mode.rate(-mode.turning * mode.top() * mode.top(), 1, 0);
    }
    return result;
}

namespace detail {

/// The links of a rig at one speed as springs at their pins.
class LinksAtSpeed {
   public:
    using S = Wide<double>;

    LinksAtSpeed(std::string_view place, const Rig& rig, double angular_speed, double gravity)
        : rig_(rig), links_(rig_links(rig)), speed_(angular_speed) {
        if (!std::isfinite(angular_speed) || angular_speed == 0)
            throw_invalid(place, "angular speed must be finite and not 0", angular_speed);
        require_positive(place, "gravity", gravity);
        turning_ = ldexp(speed_ * speed_ / S(gravity), rig.chain().units().length_exponent);
    }

    const RigLink& link(std::size_t m) const { return links_[m]; }
    std::size_t size() const { return links_.size(); }
    S turning() const { return turning_; }
    S stiffness(std::size_t m) const {
        const S k = (links_[m].tension + speed_ * links_[m].spin) / links_[m].length;
        return rig_.stands(static_cast<Index>(m)) ? -k : k;
    }
    /// Dynamic stiffness at one pin of link m, where that at its other pin is `at`.
    S across(std::size_t m, const S& at, const S& near, const S& far) const {
        const S k = stiffness(m), coupling = k + turning_ * links_[m].cross;
        return (k - turning_ * far) - coupling * coupling / (at + k - turning_ * near);
    }
    /// The links below index `end`, seen from their uppermost pin.
    S below(std::size_t end) const {
        S found(0.0);
        for (std::size_t m = 0; m < end; ++m) found = across(m, found, links_[m].lower, links_[m].upper);
        return found;
    }
    /// Dynamic stiffness of the carriage: its weight times -`turning`.
    S carriage() const {
        return -turning_ * S(std::ldexp(rig_.support().carriage_weight, -rig_.chain().units().weight_exponent));
    }

   private:
    const Rig& rig_;
    std::vector<RigLink> links_;
    S speed_, turning_{};
};

}  // namespace detail

REVCHAIN_INLINE double momentum_for_speed(const Rig& rig, Index link, double angular_speed, double gravity) {
    using S = Wide<double>;
    constexpr std::string_view place = "momentum_for_speed";
    const detail::LinksAtSpeed links(place, rig, angular_speed, gravity);
    if (link < 0 || link >= rig.size())
        detail::throw_invalid(place, "link must be from 0, the lowest, to " + std::to_string(rig.size() - 1), link);
    const auto number = static_cast<std::size_t>(link);
    const ChainUnits units = rig.chain().units();
    S above(0.0);
    bool held = rig.support().is_firm();
    if (!held)
        above = ldexp(rig.support().stiffness, units.length_exponent - units.weight_exponent) + links.carriage();
    const S turning = links.turning();
    for (std::size_t m = links.size(); m-- > number + 1; held = false)
        above = held ? links.stiffness(m) - turning * links.link(m).lower
                     : links.across(m, above, links.link(m).upper, links.link(m).lower);
    const detail::RigLink& it = links.link(number);
    const S p = links.below(number) - turning * it.lower, q = above - turning * it.upper, x = turning * it.cross;
    const S k = held ? -p : (x * x - p * q) / (p + q - x - x);
    const S tension = (rig.stands(link) ? -k : k) * it.length;
    const double needed = std::ldexp(static_cast<double>((tension - it.tension) * it.length / S(angular_speed)),
                                     units.weight_exponent + units.length_exponent);
    if (!std::isfinite(needed))
        detail::throw_invalid(place,
                              "no finite momentum of links[" + std::to_string(link) +
                                  "] makes this a whirl speed; choose another link or angular speed",
                              angular_speed);
    return needed;
}

REVCHAIN_INLINE double stiffness_for_speed(const Rig& rig, double angular_speed, double gravity) {
    constexpr std::string_view place = "stiffness_for_speed";
    const detail::LinksAtSpeed links(place, rig, angular_speed, gravity);
    const ChainUnits units = rig.chain().units();
    const double needed = std::ldexp(static_cast<double>(-(links.below(links.size()) + links.carriage())),
                                     units.weight_exponent - units.length_exponent);
    if (!(needed > 0) || !std::isfinite(needed))
        detail::throw_invalid(place, "no positive stiffness of the support makes this a whirl speed; choose another",
                              angular_speed);
    return needed;
}

}  // namespace revchain
