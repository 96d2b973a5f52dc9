// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numbers>

#include "revchain/conical_pendulum.hpp"
#include "revchain/finite/held/cord_series.hpp"
#include "revchain/finite/held/curve.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/gauss_rule.hpp"
#include "revchain/system/cord.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// A point of a cord held at both ends.
struct HeldCordPlace {
    double arc_length;      ///< from the lower end
    double offset, height;  ///< offset from the axis; height above the lower end
    double inclination;     ///< to the upward vertical, rad; positive where it rises to the axis
    double height_times_tension;  ///< lambda times the tension
};

/// A steady shape of a uniform cord whose ends are held on the axis. Forces are times the conical
/// height, as in `HeldShape`. There are eight points a step, dense where the cord turns sharply.
struct HeldCordShape {
    Vector<double> arc_length, offset, height, inclination, height_times_tension;  ///< (n) upwards
    std::array<double, 2> lower_pull;  ///< lambda times pull on the lower bearing: outwards, up
    std::array<double, 2> upper_pull;  ///< lambda times pull on the upper bearing
    int half_waves = 1;
    double span = 0, length = 0, weight = 0, conical_height = 0;
    double residual =
        0;  ///< error of T - lambda z w + w y^2/2 over the largest tension, or gap, at the end
    double error_bound = 0;  ///< estimate, of inclinations (rad) and offsets over length
    double condition =
        0;  ///< largest change of an inclination per relative change of span or height
    double moment_of_inertia = 0;  ///< about the axis, weight times length squared

    /// Returns the point at an arc length from the lower end. Throws InvalidArgument outside 0 ...
    /// length.
    HeldCordPlace operator()(double arc) const;

    std::vector<finite::HeldCordState> steps;  ///< for interpolation; lengths over the cord's
};

/// Shapes of a cord held at both ends; see `HeldShapes`.
struct HeldCordShapes {
    std::vector<HeldCordShape> shapes;
    std::vector<int> missing;
    bool complete = false;  ///< proved that no shape is missing; only for a span without gravity
};

namespace finite {

/// A cord held at both ends, with lengths over its own length.
class HeldCord {
   public:
    using S = double;

    HeldEnd<double> operator()(const HeldForces<double>& forces, bool) const {
        return cord_end(forces, [](const CordSeries&, double) {});
    }
    struct Nothing {};
    static Nothing kept() { return {}; }
    static void keep(Nothing) {}

    static double length() { return 1; }
    /// Returns lambda times the tension at the upper end.
    double top_pull(const HeldForces<double>& forces) const {
        return std::hypot((*this)(forces, false).across, forces.along + forces.height);
    }
    HeldCurve<HeldCord> curve() { return {*this, 1, 1}; }

    /// Returns the state with `half_waves` half waves; see `HeldCurve::from_straight`.
    std::optional<HeldState> at_height(int half_waves, double span, double height) {
        const double waves = half_waves * std::numbers::pi, along = 1 / (waves * waves);
        return curve().from_straight(1 - span, span, height, [&](double slack) {
            return HeldForces<double>{-2 * std::sqrt(slack) * along, along, 0};
        });
    }
};

REVCHAIN_LAZY
HeldCordPlace place_of(const HeldCordShape& shape, const HeldCordState& x) {
    return {x.arc * shape.length, x.offset * shape.length, x.rise * shape.length,
            std::atan2(-x.across, x.along),
            std::hypot(x.across, x.along) * shape.length * shape.weight};
}

REVCHAIN_LAZY
HeldCordShape described(const HeldState& state, double span, double length, double weight) {
    constexpr int per_step = 8;
    HeldCordShape shape;
    shape.span = span, shape.length = length, shape.weight = weight;
    const double lambda = state.forces.height;
    shape.conical_height = lambda * length;
    std::vector<std::pair<HeldCordState, CordChange>> samples;
    double largest_tension = 0, steepest = 0, inertia = 0;
    HeldCordState last;
    const HeldEnd<double> end =
        cord_end(state.forces, [&](const CordSeries& series, double duration) {
            shape.steps.push_back(series.place(0));
            for (int i = 0; i < per_step; ++i) {
                const double t = duration * i / per_step;
                samples.emplace_back(series.place(t), series.change(t, lambda));
            }
            last = series.place(duration);
            static const auto rule = detail::gauss_rule(24);
            for (const auto& [t, part] : rule) {
                const HeldCordState x = series.place(duration * t);
                inertia += part * duration * std::hypot(x.across, x.along) * x.offset * x.offset;
            }
        });
    shape.moment_of_inertia = inertia * length * length * weight;
    samples.emplace_back(last, CordChange(samples.back().second));
    const auto count = static_cast<Index>(samples.size());
    for (Vector<double>* v : {&shape.arc_length, &shape.offset, &shape.height, &shape.inclination,
                              &shape.height_times_tension})
        v->resize(count);
    double sign = 0;
    for (Index i = 0; i < count; ++i) {
        const HeldCordState& x = samples[static_cast<std::size_t>(i)].first;
        const HeldCordPlace p = place_of(shape, x);
        shape.arc_length[i] = p.arc_length, shape.offset[i] = p.offset, shape.height[i] = p.height;
        shape.inclination[i] = p.inclination,
        shape.height_times_tension[i] = p.height_times_tension;
        const double pull = std::hypot(x.across, x.along);
        largest_tension = std::max(largest_tension, pull);
        steepest =
            std::max(steepest, std::abs(x.along * x.offset + lambda * x.across) / (pull * pull));
        if (i > 0 && i + 1 < count && x.offset != 0) {
            if (x.offset * sign < 0) ++shape.half_waves;
            sign = x.offset > 0 ? 1 : -1;
        }
    }
    shape.arc_length[count - 1] = length, shape.offset[count - 1] = 0,
                             shape.height[count - 1] = span;
    const double unit = length * weight;
    shape.lower_pull = {-state.forces.across * unit, state.forces.along * unit};
    shape.upper_pull = {end.across * unit, -(state.forces.along + lambda) * unit};
    const double first = std::hypot(state.forces.across, state.forces.along);
    const double integral =
        std::hypot(last.across, last.along) - lambda * last.rise + last.offset * last.offset / 2;
    shape.residual = std::max({std::abs(integral - first) / largest_tension, std::abs(end.offset),
                               std::abs(end.rise - span / length)});

    // A change of span or height changes two forces, and both change inclinations.
    const auto condition = [&](double y, double z, double direct) {
        const auto forces = end.forces_to_move(y, z);
        double most = 0;
        for (const auto& sample : samples) {
            const HeldCordState& x = sample.first;
            const CordChange& change = sample.second;
            const auto changed = [&](double HeldCordState::*part) {
                return change[0].*part * forces[0] + change[1].*part * forces[1] +
                       change[2].*part * direct;
            };
            const double turn = changed(&HeldCordState::across) * x.along -
                                changed(&HeldCordState::along) * x.across;
            most = std::max(most, std::abs(turn) / (x.across * x.across + x.along * x.along));
        }
        return most;
    };
    shape.condition =
        std::max(condition(0, span / length, 0),
                 condition(-end.offset_change[2] * lambda, -end.rise_change[2] * lambda, lambda));
    const double moved = std::max(condition(0, 1, 0), condition(1, 0, 0));
    // The bound covers rounding of forces and end, and of the arc at sharp turns.
    shape.error_bound = epsilon<double>() * (2 + 2 * shape.condition + 2 * moved + steepest);
    return shape;
}

/// Returns the shape of each number of half waves at a span and height (0: no gravity).
REVCHAIN_LAZY
HeldCordShapes held_cord_shapes(const Cord& cord, double span, double height, int max_half_waves) {
    const double length = cord.length();
    auto result = each_half_wave<HeldCordShapes>(max_half_waves, [&](int k, const auto& add) {
        if (const auto state = HeldCord().at_height(k, span / length, height / length))
            add(std::optional(described(*state, span, length, cord.weight())));
    });
    // Without gravity length/span = 2 E/((1 - kappa^2) K) - 1 = 1 + 2 d log K/d log kappa. It
    // increases with kappa, since K has positive terms: each number of half waves has one kappa.
    result.complete = height == 0 && result.missing.empty();
    return result;
}

/// Returns all shapes with a given tension at the upper end times height.
REVCHAIN_LAZY
HeldCordShapes held_cord_shapes_under_tension(const Cord& cord, double height_times_tension,
                                              double height, int max_half_waves) {
    const double length = cord.length(), weight = cord.weight();
    return each_half_wave<HeldCordShapes>(max_half_waves, [&](int k, const auto& add) {
        HeldCord held;
        each_under(held, k, height / length, height_times_tension / length / weight,
                   [&](const HeldState& found) {
                       add(std::optional(described(found, found.span * length, length, weight)));
                   });
    });
}

}  // namespace finite

inline HeldCordPlace HeldCordShape::operator()(double arc) const {
    if (!(arc >= 0 && arc <= length))
        detail::throw_invalid("HeldCordShape", "arc length must lie between 0 and the length", arc);
    const double scaled = arc / length;
    const auto after =
        std::upper_bound(steps.begin() + 1, steps.end(), scaled,
                         [](double x, const finite::HeldCordState& step) { return x < step.arc; });
    const finite::CordSeries series(*(after - 1), conical_height / length);
    const double duration = 1.05 * series.reach();
    HeldCordPlace place = finite::place_of(*this, series.place(series.time_at(scaled, duration)));
    place.arc_length = arc;
    return place;
}

}  // namespace revchain
