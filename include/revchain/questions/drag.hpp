// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "revchain/branches.hpp"
#include "revchain/drag.hpp"
#include "revchain/finite/balance/air_drag.hpp"
#include "revchain/finite/shapes/rigged_links.hpp"
#include "revchain/numeric/arc_step.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace finite {

using Fine3 = Space<Fine>;
using Matrix2 = Eigen::Matrix<double, 2, 2>;

/// A figure in space: directions of the links, each from its upper pin to its lower one, and the
/// place of the support, which moves if it yields.
struct Figure {
    std::vector<Fine3> direction;
    Fine3 support{};
};

/// A change of a figure, or its derivative to the factor of the drag.
struct FigureChange {
    std::vector<Vector3> direction;  ///< each across its link
    Vector3 support = Vector3::Zero();

    /// Mean product over the links and the support.
    friend double dot(const FigureChange& x, const FigureChange& y) {
        double sum = x.support.dot(y.support);
        for (std::size_t m = 0; m < x.direction.size(); ++m)
            sum += x.direction[m].dot(y.direction[m]);
        return sum / static_cast<double>(x.direction.size() + 1);
    }
    double largest() const {
        double most = support.norm();
        for (const Vector3& each : direction) most = std::max(most, each.norm());
        return most;
    }
};

/// Returns a figure moved by `share` of a change, with directions of length 1.
REVCHAIN_LAZY
Figure moved(Figure figure, const FigureChange& change, double share = 1) {
    const auto fine = [](const Vector3& v) { return Fine3{Fine(v[0]), Fine(v[1]), Fine(v[2])}; };
    for (std::size_t m = 0; m < figure.direction.size(); ++m) {
        Fine3& u = figure.direction[m];
        u = u + Fine(share) * fine(change.direction[m]);
        u = (Fine(1.0) / sqrt(dot(u, u))) * u;
    }
    figure.support = figure.support + Fine(share) * fine(change.support);
    return figure;
}

/// The balance of a rig's links in space, with drag. Per link, with T the pull from below without
/// the weights, P the places of the pins, u the direction and lambda the height,
///     G = T_below + (moment P_below - length cross u)/lambda + lever - (tension + n spin) z
/// must lie along u; T = T_below + (moment P_below + rest P)/lambda + force. Here offsets are
/// horizontal, and force and lever are those of the drag. In a plane without drag this is the
/// balance of `finite::Link`.
class SpaceBalance {
   public:
    SpaceBalance(RiggedLinks links, const Fine& height, std::vector<LinkDrag> drag)
        : links_(std::move(links)), height_(height), drag_(std::move(drag)) {}

    const RiggedLinks& links() const { return links_; }
    std::size_t size() const { return drag_.size(); }

    /// Returns the places of the pins, free end first.
    std::vector<Fine3> pins(const Figure& figure) const {
        std::vector<Fine3> place(size() + 1);
        place[size()] = figure.support;
        for (std::size_t m = size(); m-- > 0;)
            place[m] = place[m + 1] + links_.links[m].length * figure.direction[m];
        return place;
    }

    struct Solved {
        FigureChange correction;   ///< Newton's step at this factor
        FigureChange slope;        ///< derivative of the figure to the factor
        std::vector<Fine3> pull;   ///< T at each upper pin
        double residual = 0;       ///< largest unbalanced moment over (weight times length)
    };

    /// Balances forces and solves for Newton's step. Elimination goes from the free end up: the
    /// change of T is `stiffness` times that of P, plus `load`, whose columns belong to the
    /// correction and to the slope.
    Solved solve(const Figure& figure, double factor, const GaussRule& rule) const {
        struct Row {
            Matrix2 pin, load;
            Matrix32 frame;
        };
        const std::size_t n = size();
        const std::vector<Fine3> place = pins(figure);
        std::vector<Row> rows(n);
        Solved result;
        Matrix32 stiffness = Matrix32::Zero(), load = Matrix32::Zero(), flat = Matrix32::Zero();
        flat(0, 0) = flat(1, 1) = 1;
        Fine3 pull;
        double reach = 0;
        for (std::size_t m = 0; m < n; ++m) {
            const Link<Fine>& link = links_.links[m];
            const Fine3 &u = figure.direction[m], &upper = place[m + 1];
            const auto level = [&](const Fine3& p) {
                return Fine3{p.x / height_, p.y / height_, Fine(0.0)};
            };
            DragSlopes slopes;
            const DragForces<Fine> air =
                drag_on_link(drag_[m], rule, link.length, upper, u, &slopes);
            const Fine3 carried = link.moment * level(place[m]);
            const Fine3 hung{Fine(0.0), Fine(0.0), link.pull};
            const Fine3 on_link = pull + carried - link.length * (link.cross * level(u)) +
                                  Fine(factor) * air.lever - hung;
            const Fine along = dot(on_link, u);
            const Vector3 off = as_vector(on_link - along * u);
            reach += as_double(link.length);
            result.residual = std::max(result.residual, off.norm() * as_double(link.length));

            const double lambda = as_double(height_), a = as_double(link.length);
            const double moment = as_double(link.moment) / lambda;
            Row& row = rows[m];
            row.frame = across(as_vector(u));
            const Matrix2 level_frame = row.frame.topRows<2>();
            const Matrix32 below = stiffness + moment * flat;
            const Matrix32 turned = a * below * level_frame;
            const Matrix32 of_turn = turned + factor * slopes.lever_direction * row.frame -
                                     a * as_double(link.cross) / lambda * flat * level_frame;
            Matrix2 pivot = row.frame.transpose() * of_turn;
            pivot.diagonal().array() -= as_double(along);
            Matrix32 given = load;
            given.col(0) += off, given.col(1) += as_vector(air.lever);
            const Matrix2 inverse = pivot.inverse();
            row.load = -inverse * (row.frame.transpose() * given);
            row.pin =
                -inverse * (row.frame.transpose() * (below + factor * slopes.lever_pin));
            const Matrix32 force_of_turn =
                turned + factor * slopes.force_direction * row.frame;
            load.col(1) += as_vector(air.force);
            load += force_of_turn * row.load;
            stiffness = below + as_double(link.rest) / lambda * flat + factor * slopes.force_pin +
                        force_of_turn * row.pin;
            pull = pull + carried + link.rest * level(upper) + Fine(factor) * air.force;
            result.pull.push_back(pull);
        }
        Matrix2 change = Matrix2::Zero();  // of the pin above, for each column
        if (links_.support.yields()) {
            const SupportEnd<Fine>& end = links_.support;
            const Fine held = end.carriage - end.stiffness;
            const Fine x = pull.x + (held * place[n].x + end.stiffness * end.radius) / height_,
                       y = pull.y + held * place[n].y / height_;
            Matrix2 top = stiffness.topRows<2>(), given = load.topRows<2>();
            top.diagonal().array() += as_double(held / height_);
            given.col(0) += Eigen::Matrix<double, 2, 1>(as_double(x), as_double(y));
            change = -top.inverse() * given;
            result.residual =
                std::max(result.residual, std::hypot(as_double(x), as_double(y)) * reach);
        }
        result.residual /= links_.total_weight * reach;
        result.correction.support.head<2>() = change.col(0);
        result.slope.support.head<2>() = change.col(1);
        result.correction.direction.resize(n), result.slope.direction.resize(n);
        for (std::size_t m = n; m-- > 0;) {
            const Matrix32 turn = rows[m].frame * (rows[m].pin * change + rows[m].load);
            result.correction.direction[m] = turn.col(0), result.slope.direction[m] = turn.col(1);
            change += as_double(links_.links[m].length) * turn.topRows<2>();
        }
        return result;
    }

   private:
    /// Returns two unit vectors across a direction and each other, as columns.
    static Matrix32 across(const Vector3& u) {
        Eigen::Index least = 0;
        u.cwiseAbs().minCoeff(&least);
        const Vector3 x = (Vector3::Unit(least) - u[least] * u).normalized();
        Matrix32 frame;
        frame.col(0) = x;
        frame.col(1) << u[1] * x[2] - u[2] * x[1], u[2] * x[0] - u[0] * x[2],
            u[0] * x[1] - u[1] * x[0];
        return frame;
    }

    RiggedLinks links_;
    Fine height_;
    std::vector<LinkDrag> drag_;
};

/// A point of the curve of figures over the factor of the drag, and the curve's direction there.
struct DragPoint {
    Figure figure;
    double factor = 0;
    FigureChange tangent{};
    double factor_tangent = 1;
};

/// Follows the figure from no drag to the full drag.
class DragWalk {
   public:
    DragWalk(const SpaceBalance& balance, const GaussRule& rule)
        : balance_(&balance), rule_(&rule) {}

    DragStatus run(DragPoint& at) {
        if (!corrected(at, nullptr, 1e300) || !directed(at, nullptr)) return DragStatus::stalled;
        double step = 0.05;
        for (steps = 0; steps < most_steps && at.factor < 1; ++steps) {
            bool fold = false;
            const bool done = detail::arc_step(step, 1e300, 0.5, [&](double length) {
                return attempt(at, length, fold);
            });
            if (fold) return DragStatus::fold;
            if (!done) return DragStatus::stalled;
        }
        return at.factor == 1 ? DragStatus::success : DragStatus::stalled;
    }

    int steps = 0;

   private:
    static constexpr int most_steps = 10'000;
    static constexpr double closest_to_fold = 1e-4;  ///< step; the factor is flat there

    std::optional<double> attempt(DragPoint& at, double length, bool& fold) const {
        const double left = 1 - at.factor;
        const bool last = length * at.factor_tangent >= left;
        if (last) length = left / at.factor_tangent;
        DragPoint next = at;
        next.figure = moved(at.figure, at.tangent, length);
        next.factor = last ? 1 : at.factor + length * at.factor_tangent;
        const std::optional<double> first =
            corrected(next, last ? nullptr : &at, 0.2 * std::min(length, 0.5));
        if (!first || next.factor < 0 || next.factor > 1 || !directed(next, &at)) return {};
        if (next.factor_tangent <= 0) {
            fold = length < closest_to_fold;
            if (!fold) return {};
        }
        at = std::move(next);
        const double curved = *first / std::max(length, 1e-300);
        return std::clamp(0.5 / std::sqrt(curved + 1e-2), 0.5, 3.0);
    }

    /// Brings a point onto the curve, across the direction at `along` or, without it, at its
    /// factor. Returns the size of the first correction if it is at most `limit` and the later
    /// ones shrink quickly.
    std::optional<double> corrected(DragPoint& point, const DragPoint* along, double limit) const {
        double first = 0, last = limit;
        for (int round = 0; round < 12; ++round) {
            const SpaceBalance::Solved found = balance_->solve(point.figure, point.factor, *rule_);
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
            if (size < 1e-11) return first;
            last = std::max(0.5 * size, 1e-12);
        }
        return {};
    }

    /// Sets the direction of the curve, so that it continues that at `before`. Returns false if it
    /// turns by more than half a radian.
    bool directed(DragPoint& point, const DragPoint* before) const {
        FigureChange slope = balance_->solve(point.figure, point.factor, *rule_).slope;
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

/// Returns the steady shape without drag from which to start. `speed` may be negative.
REVCHAIN_LAZY
SteadyShape shape_without_drag(const Rig& rig, const DragShapeOptions& options) {
    const double speed = options.angular_speed;
    if (!options.half_waves)
        return steady_shape(rig, RigOnBranchOptions{.angular_speed = std::abs(speed),
                                                    .gravity = options.gravity,
                                                    .direction = speed > 0 ? Rotation::forward
                                                                           : Rotation::backward});
    const SteadyShapes found =
        steady_shapes(rig, RigShapesOptions{.angular_speed = speed, .gravity = options.gravity});
    const SteadyShape* farthest = nullptr;
    for (const SteadyShape& shape : found.shapes)
        if (shape.half_waves == *options.half_waves &&
            (farthest == nullptr || shape.offset[0] > farthest->offset[0]))
            farthest = &shape;
    if (farthest == nullptr)
        throw_invalid("drag_shape", "there is no shape with this number of half waves at this speed",
                      *options.half_waves);
    return *farthest;
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
    const auto& of_bodies = drag.body_coefficient.empty() ? drag.coefficient : drag.body_coefficient;
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
                              "a radius (carried_round), got",
                              rig.support().radius);
    detail::require_no_pins(place, "a shape with drag", rig, false);
    if (rig.fluid() == Fluid::turning)
        detail::throw_invalid(place,
                              "a fluid that turns with the chain has no drag: leave the drag out "
                              "or let the fluid be still; links",
                              rig.size());
    const std::vector<LinkDrag> of_links = detail::drag_of_links(rig, drag, speed);
    const SteadyShape start = detail::shape_without_drag(rig, options);
    const Fine height = height_at_speed(std::abs(speed), options.gravity);
    RiggedLinks links = rigged_links(rig, height, Fine(speed));
    const ChainUnits units = links.units;
    const SpaceBalance balance(std::move(links), ldexp(height, -units.length_exponent), of_links);
    const auto n = static_cast<std::size_t>(rig.size());

    DragPoint at;
    for (const double d : start.inclination)
        at.figure.direction.push_back({Fine(std::sin(d)), Fine(0.0), Fine(-std::cos(d))});
    const double outward = start.offset[rig.size()];
    at.figure.support.x = Fine(std::ldexp(outward, -units.length_exponent));
    at.figure = moved(std::move(at.figure),
                      {std::vector<Vector3>(n, Vector3::Zero())});  // of length 1 in two words
    const GaussRule rule = detail::gauss_rule(12), finer = detail::gauss_rule(16);
    DragWalk walk(balance, rule);
    DragShape shape;
    shape.status = walk.run(at);
    shape.steps = walk.steps, shape.factor = at.factor;
    SpaceBalance::Solved found = balance.solve(at.figure, at.factor, rule);
    for (int round = 0; round < 4 && found.correction.largest() > 1e-20; ++round) {
        if (!(found.correction.largest() < 1e-6)) break;
        at.figure = moved(std::move(at.figure), found.correction);
        found = balance.solve(at.figure, at.factor, rule);
    }
    shape.residual = found.residual;
    shape.error_estimate = balance.solve(at.figure, at.factor, finer).correction.largest() +
                           2 * epsilon<double>();

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
        shape.tension[i] = std::ldexp(std::hypot(pull[0], pull[1], hung[m] - pull[2]),
                                      units.weight_exponent);
    }
    const Fine3 &top = at.figure.support, &pull = found.pull[n - 1];
    shape.torque = std::ldexp(as_double(top.y * pull.x - top.x * pull.y),
                              units.weight_exponent + units.length_exponent);
    shape.power = shape.torque * std::abs(speed);
    return shape;
}

}  // namespace revchain
