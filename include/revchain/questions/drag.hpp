// SPDX-License-Identifier: MPL-2.0
// Defines what drag.hpp declares.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "revchain/drag.hpp"
#include "revchain/finite/shapes/space_balance.hpp"
#include "revchain/numeric/arc_step.hpp"
#include "revchain/questions/farthest_out.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace finite {

/// A point of the curve of figures over the factor of the drag, and the curve's direction there.
struct DragPoint {
    Figure figure;
    double factor = 0;
    FigureChange tangent{};
    double factor_tangent = 1;
};

/// Follows the figure on the way to the full drag.
class DragWalk {
   public:
    DragWalk(const SpaceBalance& balance, const GaussRule& rule)
        : balance_(&balance), rule_(&rule) {}

    /// Moves the point to the end of the way. Folds are passed; where the way then leads back to
    /// its beginning, the point ends at the first one.
    DragStatus run(DragPoint& at) {
        const std::optional<Corrected> start = corrected(at, nullptr, 1e300);
        if (!start || !directed(at, start->slope, nullptr)) return DragStatus::stalled;
        double step = 0.05;
        std::optional<DragPoint> first_fold;
        while (at.factor < 1) {
            const double last_tangent = at.factor_tangent;
            const bool done = detail::arc_step(step, 1e300, 0.5,
                                               [&](double length) { return attempt(at, length); });
            if (at.factor_tangent * last_tangent < 0 && folds++ == 0) first_fold = at;
            if (done && at.factor > 0 && ++steps < most_steps) continue;
            if (!first_fold) return DragStatus::stalled;
            at = *std::move(first_fold);
            return DragStatus::fold;
        }
        return DragStatus::success;
    }

    int steps = 0, folds = 0;

   private:
    static constexpr int most_steps = 3000;
    static constexpr double closest_to_fold = 1e-4;  ///< step; the factor is flat there

    std::optional<double> attempt(DragPoint& at, double length) const {
        const double left = 1 - at.factor;
        const bool last = length * at.factor_tangent >= left;
        if (last) length = left / at.factor_tangent;
        DragPoint next = at;
        next.figure = moved(at.figure, at.tangent, length);
        next.factor = last ? 1 : at.factor + length * at.factor_tangent;
        const std::optional<Corrected> found =
            corrected(next, last ? nullptr : &at, 0.2 * std::min(length, 0.5));
        if (!found || next.factor > 1 || (folds == 0 && next.factor < 0) ||
            !directed(next, found->slope, &at))
            return {};
        const bool turned = next.factor_tangent * at.factor_tangent < 0;
        if (turned && length > closest_to_fold) return {};
        if (!turned && !((next.factor - at.factor) * at.factor_tangent > 0)) return {};  // a jump
        at = std::move(next);
        const double curved = found->first / std::max(length, 1e-300);
        return std::clamp(0.5 / std::sqrt(curved + 1e-2), 0.5, 3.0);
    }

    struct Corrected {
        double first;        ///< size of the first correction
        FigureChange slope;  ///< derivative of the figure to the factor, 1e-11 from the point
    };

    /// Brings a point onto the curve, across the direction at `along` or, without it, at its
    /// factor. Returns nothing if the first correction is above `limit` or the later ones do not
    /// shrink quickly.
    std::optional<Corrected> corrected(DragPoint& point, const DragPoint* along,
                                       double limit) const {
        double first = 0, last = limit;
        for (int round = 0; round < 12; ++round) {
            SpaceBalance::Solved found = balance_->solve(point.figure, point.factor, *rule_);
            FigureChange change = found.correction;
            double shift = 0;
            if (along != nullptr) {
                shift = -dot(along->tangent, change) /
                        (dot(along->tangent, found.slope) + along->factor_tangent);
                add(change, found.slope, shift);
            }
            const double size = std::max(change.largest(), std::abs(shift));
            if (!(size <= last)) return {};
            if (round == 0) first = size;
            point.figure = moved(std::move(point.figure), change), point.factor += shift;
            if (size < 1e-11) return Corrected{first, std::move(found.slope)};
            last = std::max(0.5 * size, 1e-12);
        }
        return {};
    }

    /// Sets the direction of the curve, so that it continues that at `before`. Returns false if it
    /// turns by more than half a radian.
    bool directed(DragPoint& point, const FigureChange& slope, const DragPoint* before) const {
        const double size = std::sqrt(dot(slope, slope) + 1);
        if (!(size < 1e300)) return false;
        double cosine = 1, sense = 1;
        if (before != nullptr) {
            cosine = (dot(before->tangent, slope) + before->factor_tangent) / size;
            if (cosine < 0) sense = -1;
        }
        point.tangent = FigureChange{std::vector<Vector3>(balance_->size(), Vector3::Zero())};
        add(point.tangent, slope, sense / size);
        point.factor_tangent = sense / size;
        return std::abs(cosine) > 0.88;
    }

    static void add(FigureChange& to, const FigureChange& change, double share) {
        for (std::size_t m = 0; m < to.direction.size(); ++m)
            to.direction[m] += share * change.direction[m];
        to.support += share * change.support;
    }

    const SpaceBalance* balance_;
    const GaussRule* rule_;
};

}  // namespace finite

namespace detail {

/// Returns the figure from which to start: a shape without drag, or the rig at rest.
REVCHAIN_LAZY
finite::Figure figure_without_drag(const Rig& rig, const finite::RiggedLinks& links,
                                   const DragShapeOptions& options) {
    finite::Figure figure;
    figure.support.x = links.support.radius;
    const auto lead = [&](double inclination) {
        figure.direction.push_back({std::sin(inclination), 0.0, -std::cos(inclination)});
    };
    if (!options.half_waves) {
        for (Index m = 0; m < rig.size(); ++m)
            figure.direction.push_back({0.0, 0.0, rig.stands(m) ? 1.0 : -1.0});
        return figure;
    }
    const SteadyShapes found = steady_shapes(
        rig, RigShapesOptions{.angular_speed = options.angular_speed, .gravity = options.gravity});
    const SteadyShape* farthest = farthest_out(found, *options.half_waves);
    if (farthest == nullptr)
        throw_invalid("drag_shape",
                      "there is no shape without drag with this number of half waves at this speed",
                      *options.half_waves);
    for (const double inclination : farthest->inclination) lead(inclination);
    figure.support.x = std::ldexp(farthest->offset[rig.size()], -links.units.length_exponent);
    return figure;
}

/// Returns the drag coefficients of the links in the units of `links`, for the speed 1.
REVCHAIN_LAZY
std::vector<finite::LinkDrag> drag_of_links(const Rig& rig, const Drag& drag, double speed) {
    constexpr std::string_view place = "drag_shape";
    const Index n = rig.size();
    const auto checked = [&](const std::vector<double>& list, std::string_view name) {
        const auto size = static_cast<Index>(list.size());
        if (size > 1 && size != n)
            throw_invalid(place, std::string(name) + " must have one number or one for each link",
                          size);
        for (const double x : list) require_not_negative(place, name, x);
    };
    checked(drag.coefficient, "coefficient"), checked(drag.diameter, "diameter");
    checked(drag.area, "area"), checked(drag.body_coefficient, "body coefficient");
    require_not_negative(place, "density", drag.density);
    const auto of = [](const std::vector<double>& list, Index m) {
        if (list.empty()) return 0.0;
        return list.size() == 1 ? list[0] : list[static_cast<std::size_t>(m)];
    };
    const auto& of_bodies =
        drag.body_coefficient.empty() ? drag.coefficient : drag.body_coefficient;
    const ChainUnits units = rig.chain().units();
    const int of_length = units.length_exponent, of_weight = units.weight_exponent;
    std::vector<finite::LinkDrag> result;
    for (Index m = 0; m < n; ++m) {
        const Link<double> link = rig.chain().link(m);
        const double pressure = drag.density / 2 * speed * speed;
        const finite::LinkDrag each{
            std::ldexp(pressure * of(drag.coefficient, m) * of(drag.diameter, m),
                       3 * of_length - of_weight),
            std::ldexp(pressure * of(of_bodies, m) * of(drag.area, m), 2 * of_length - of_weight),
            link.centroid / link.length};
        require_finite(place, "drag of a link over the weight", each.line + each.body);
        result.push_back(each);
    }
    return result;
}

}  // namespace detail

REVCHAIN_DEFINE
DragShape drag_shape(const Rig& rig, const Drag& drag, const DragShapeOptions& options) {
    using namespace finite;
    constexpr std::string_view place = "drag_shape";
    detail::require_positive(place, "gravity", options.gravity);
    const double speed = options.angular_speed;
    detail::require_positive(place, "magnitude of the angular speed", std::abs(speed));
    if (rig.support().radius == 0)
        detail::throw_invalid(place,
                              "with its support on the axis a chain with drag has no steady whirl: "
                              "ball joints pass on no torque to balance the drag; give the support "
                              "a radius (carried_round); its radius",
                              rig.support().radius);
    detail::require_no_pins(place, "a shape with drag", rig, false);
    if (rig.fluid() == Fluid::turning)
        detail::throw_invalid(place,
                              "a fluid that turns with the chain has no drag: leave the drag out "
                              "or let the fluid be still");
    const std::vector<LinkDrag> of_links = detail::drag_of_links(rig, drag, speed);
    const Fine height = height_at_speed(std::abs(speed), options.gravity);
    RiggedLinks links = rigged_links(rig, height, Fine(speed));
    const ChainUnits units = links.units;
    const auto n = static_cast<std::size_t>(rig.size());
    DragPoint at{moved(detail::figure_without_drag(rig, links, options),
                       {std::vector<Vector3>(n, Vector3::Zero())})};  // length 1 in two words
    SpaceBalance balance(std::move(links), ldexp(height, -units.length_exponent), of_links);
    if (!options.half_waves) balance.way = DragWay::growing_speed;
    const GaussRule rule = detail::gauss_rule(12), finer = detail::gauss_rule(16);
    DragWalk walk(balance, rule);
    DragShape shape;
    shape.status = walk.run(at);
    shape.steps = walk.steps, shape.folds = walk.folds, shape.factor = at.factor;
    SpaceBalance::Solved found = balance.solve(at.figure, at.factor, rule);
    for (int round = 0; round < 4 && found.correction.largest() > 1e-20; ++round) {
        if (!(found.correction.largest() < 1e-6)) break;
        at.figure = moved(std::move(at.figure), found.correction);
        found = balance.solve(at.figure, at.factor, rule);
    }
    shape.residual = found.residual;
    shape.error_estimate =
        balance.solve(at.figure, at.factor, finer).correction.largest() + 2 * epsilon<double>();

    const auto length = [&](const Fine& x) {
        return std::ldexp(as_double(x), units.length_exponent);
    };
    const std::vector<Fine3> pins = balance.pins(at.figure);
    const std::vector<double> hung = balance.links().hung();
    shape.position.resize(rig.size() + 1, 3), shape.inclination.resize(rig.size());
    shape.azimuth.resize(rig.size()), shape.tension.resize(rig.size());
    for (std::size_t m = 0; m <= n; ++m) {
        const auto i = static_cast<Index>(m);
        shape.position.row(i) << length(pins[m].x), length(pins[m].y), length(pins[m].z);
        if (m == n) break;
        const Vector3 u = as_vector(at.figure.direction[m]), pull = as_vector(found.pull[m]);
        shape.inclination[i] = std::atan2(std::hypot(u[0], u[1]), -u[2]);
        shape.azimuth[i] = std::atan2(u[1], u[0]);
        shape.tension[i] =
            std::ldexp(std::hypot(pull[0], pull[1], hung[m] - pull[2]), units.weight_exponent);
    }
    const Fine3 &top = at.figure.support, &pull = found.pull[n - 1];
    shape.torque = std::ldexp(as_double(top.y * pull.x - top.x * pull.y),
                              units.weight_exponent + units.length_exponent);
    shape.power = shape.torque * std::abs(speed);
    return shape;
}

}  // namespace revchain
