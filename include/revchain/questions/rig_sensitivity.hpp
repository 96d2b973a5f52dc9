// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>
#include <string_view>

#include "revchain/numeric/compiled.hpp"
#include "revchain/sensitivity.hpp"

namespace revchain {

REVCHAIN_INLINE RigSensitivity sensitivity(const Rig& rig, double angular_speed, const Vector<double>& offset,
                                           double gravity) {
    using S = Wide<double>;
    constexpr std::string_view place = "sensitivity";
    if (!std::isfinite(angular_speed) || angular_speed == 0)
        detail::throw_invalid(place, "angular speed must be finite and not 0", angular_speed);
    detail::require_positive(place, "gravity", gravity);
    if (offset.size() != rig.size() + 1)
        detail::throw_invalid(place, "there must be " + std::to_string(rig.size() + 1) + " offsets", offset.size());
    const auto links = rig_links(rig);
    const ChainUnits units = rig.chain().units();
    const Index count = rig.size();
    const S n(angular_speed);
    // n^2/g times the unit of length, and n over the unit of weight times length times time
    const S turning = ldexp(n * n / S(gravity), units.length_exponent);
    const Support& support = rig.support();
    S inertia(0.0), momentum(0.0);  // y^T M y, y^T G y
    std::vector<S> slope;
    for (Index m = 0; m < count; ++m) {
        const RigLink& link = links[static_cast<std::size_t>(m)];
        const S lower(offset[m]), upper(offset[m + 1]), s = (lower - upper) / link.length;
        slope.push_back(s);
        inertia =
            inertia + (lower * (link.lower * lower + (link.cross + link.cross) * upper) + link.upper * upper * upper);
        const S spins = link.spin * link.length * s * s;
        momentum = momentum + (rig.stands(m) ? -spins : spins);
    }
    const S top(offset[count]);
    if (!support.is_firm())
        inertia = inertia + S(std::ldexp(support.carriage_weight, -units.weight_exponent)) * top * top;
    const S denominator = momentum - S(2.0) * turning * inertia / n;
    if (!isfinite(denominator) || denominator == S(0.0))
        detail::throw_invalid(place, "offsets must be finite and move a weight or tilt a flywheel at the angular speed",
                              angular_speed);
    const auto rate = [&](const S& x) { return static_cast<double>(-x / denominator); };

    RigSensitivity result{};
    for (auto* column :
         {&result.weight, &result.length, &result.centroid, &result.radius_of_gyration, &result.length_in_proportion,
          &result.momentum, &result.displaced_weight, &result.added_weight})
        column->resize(count);
    const auto per_weight = [&](const S& x) { return std::ldexp(rate(x), -units.weight_exponent); };
    const auto per_length = [&](const S& x) { return std::ldexp(rate(x), -units.length_exponent); };
    S above(0.0);  // sum of a s^2 over the links above, of those that stand less
    for (Index m = count; m-- > 0;) {
        const RigLink& link = links[static_cast<std::size_t>(m)];
        const S sign(rig.stands(m) ? -1.0 : 1.0), s = slope[static_cast<std::size_t>(m)], square = s * s,
                                                  a = link.length;
        /// A body of the link: where its centre of gravity is, and what a unit of its weight bears and resists.
        struct Body {
            S weight, centroid, gyration, centre, bears, moves;
        };
        const auto body = [&](double weight, double centroid, const S& ratio) {
            const S h(std::ldexp(centroid, -units.length_exponent)), gyration = ratio * (a * a);
            const S centre = S(offset[m + 1]) + h * s;
            return Body{S(std::ldexp(weight, -units.weight_exponent)),  h, gyration, centre, sign * h * square + above,
                        turning * (centre * centre + gyration * square)};
        };
        const Link<double> own = rig.chain().link(m);
        const Displaced displaced = rig.displaced(m);
        const Flywheel wheel = rig.flywheel(m);
        const bool turns = rig.fluid() == Fluid::turning;
        const Body solid = body(own.weight, own.centroid, own.gyration_ratio);
        const Body fluid =
            body(turns ? -displaced.weight : displaced.added_weight, displaced.centroid, displaced.gyration_ratio);
        result.weight[m] = per_weight(solid.bears - solid.moves);
        result.momentum[m] = std::ldexp(rate(sign * n * square), -units.weight_exponent - units.length_exponent);
        result.displaced_weight[m] = per_weight(turns ? fluid.moves - fluid.bears : -fluid.bears);
        result.added_weight[m] = turns ? 0 : per_weight(-fluid.moves);

        // Slopes go as 1/a where the pins stay; kappa = W h - B h_B + a S.
        const S two(2.0), below = m == 0 ? S(0.0) : links[static_cast<std::size_t>(m - 1)].hung;
        const auto resists = [&](const Body& it) {
            return it.weight * s * (it.centroid * it.centre + it.gyration * s);
        };
        const S axial = S(std::ldexp(wheel.axial_moment, -units.weight_exponent - 2 * units.length_exponent)) * square;
        const S by_length = sign * square * (below - two * (link.tension + n * link.spin)) +
                            turning * two * (resists(solid) + resists(fluid) - axial) / a;
        const S by_centroid = solid.weight * (sign * square - turning * two * solid.centre * s);
        const S radius = sqrt(solid.gyration), by_radius = -(turning * two * solid.weight * radius * square);
        result.length[m] = m == 0 ? 0 : per_length(by_length);  // where nothing hangs, no pin matters
        result.centroid[m] = per_length(by_centroid), result.radius_of_gyration[m] = per_length(by_radius);
        result.length_in_proportion[m] =
            per_length((m == 0 ? S(0.0) : by_length) + (solid.centroid * by_centroid + radius * by_radius) / a);
        above = above + sign * link.length * square;
    }
    if (!support.is_firm()) {
        result.stiffness = std::ldexp(rate(top * top), units.length_exponent - units.weight_exponent);
        result.carriage_weight = std::ldexp(rate(-turning * top * top), -units.weight_exponent);
    }
    return result;
}

REVCHAIN_INLINE double momentum_for_speed(const Rig& rig, Index link, double angular_speed, double gravity) {
    using S = Wide<double>;
    constexpr std::string_view place = "momentum_for_speed";
    if (!std::isfinite(angular_speed) || angular_speed == 0)
        detail::throw_invalid(place, "angular speed must be finite and not 0", angular_speed);
    detail::require_positive(place, "gravity", gravity);
    if (link < 1 || link > rig.size())
        detail::throw_invalid(place, "link must be from 1, the lowest, to " + std::to_string(rig.size()), link);
    const auto links = rig_links(rig);
    const ChainUnits units = rig.chain().units();
    const S n(angular_speed), turning = ldexp(n * n / S(gravity), units.length_exponent);
    const auto stiffness = [&](std::size_t m) {
        const S k = (links[m].tension + n * links[m].spin) / links[m].length;
        return rig.stands(static_cast<Index>(m)) ? -k : k;
    };
    // what holds one pin of a link, seen from its other pin
    const auto across = [&](std::size_t m, const S& at, const S& near, const S& far) {
        const S k = stiffness(m), coupling = k + turning * links[m].cross;
        return (k - turning * far) - coupling * coupling / (at + k - turning * near);
    };
    const std::size_t number = static_cast<std::size_t>(link) - 1;
    S below(0.0), above(0.0);
    for (std::size_t m = 0; m < number; ++m) below = across(m, below, links[m].lower, links[m].upper);
    const Support& support = rig.support();
    bool held = support.is_firm();
    if (!held)
        above = S(std::ldexp(support.stiffness, units.length_exponent - units.weight_exponent)) -
                turning * S(std::ldexp(support.carriage_weight, -units.weight_exponent));
    for (std::size_t m = links.size(); m-- > number + 1; held = false)
        above = held ? stiffness(m) - turning * links[m].lower : across(m, above, links[m].upper, links[m].lower);
    const RigLink& it = links[number];
    const S p = below - turning * it.lower, q = above - turning * it.upper, x = turning * it.cross;
    const S k = held ? -p : (x * x - p * q) / (p + q - x - x);
    const S tension = (rig.stands(link - 1) ? -k : k) * it.length;
    const double needed = std::ldexp(static_cast<double>((tension - it.tension) * it.length / n),
                                     units.weight_exponent + units.length_exponent);
    if (!std::isfinite(needed))
        detail::throw_invalid(place,
                              "no finite momentum of link " + std::to_string(link) +
                                  " makes this a whirl speed; choose "
                                  "another link or angular speed",
                              angular_speed);
    return needed;
}

}  // namespace revchain
