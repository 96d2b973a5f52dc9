// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "revchain/finite/balance/air_drag.hpp"
#include "revchain/finite/shapes/rigged_links.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

using Fine3 = Space<Fine>;
using Matrix2 = Eigen::Matrix<double, 2, 2>;

/// A figure in space: directions of the links, each from its upper pin to its lower one, and the
/// place of the support, which moves if it yields.
struct Figure {
    std::vector<Fine3> direction;
    Fine3 support{};
};

/// A change of a figure, or its derivative along a way to the full drag.
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

/// How a shape with the full drag is approached: a factor from 0 to 1 multiplies the drag, or the
/// square of the speed and with it the drag.
enum class DragWay { growing_drag, growing_speed };

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

    DragWay way = DragWay::growing_drag;

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
        FigureChange correction;  ///< Newton's step at this factor
        FigureChange slope;       ///< derivative of the figure to the factor
        std::vector<Fine3> pull;  ///< T at each upper pin
        double residual = 0;      ///< largest unbalanced moment over (weight times length)
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
        const bool speeds_up = way == DragWay::growing_speed;
        const Fine turning = speeds_up ? Fine(factor) / height_ : Fine(1.0) / height_;  // n^2/g
        const double turns = as_double(turning);
        const auto grows = [&](const Fine3& carried) {  // with the factor
            return speeds_up ? Vector3(as_vector(carried) / as_double(height_)) : Vector3::Zero();
        };
        for (std::size_t m = 0; m < n; ++m) {
            const Link<Fine>& link = links_.links[m];
            const Fine3 &u = figure.direction[m], &upper = place[m + 1];
            const auto level = [](const Fine3& p) { return Fine3{p.x, p.y, Fine(0.0)}; };
            DragSlopes slopes;
            const DragForces<Fine> air =
                drag_on_link(drag_[m], rule, link.length, upper, u, &slopes);
            const Fine3 turned_about =
                            link.moment * level(place[m]) - link.length * (link.cross * level(u)),
                        carried = link.moment * level(place[m]) + link.rest * level(upper);
            const Fine3 hung{Fine(0.0), Fine(0.0), link.pull};
            const Fine3 on_link = pull + turning * turned_about + Fine(factor) * air.lever - hung;
            const Fine along = dot(on_link, u);
            const Vector3 off = as_vector(on_link - along * u);
            reach += as_double(link.length);
            result.residual = std::max(result.residual, off.norm() * as_double(link.length));

            const double a = as_double(link.length);
            Row& row = rows[m];
            row.frame = across(as_vector(u));
            const Matrix2 level_frame = row.frame.topRows<2>();
            const Matrix32 below = stiffness + turns * as_double(link.moment) * flat;
            const Matrix32 turned = a * below * level_frame;
            const Matrix32 of_turn = turned + factor * slopes.lever_direction * row.frame -
                                     turns * a * as_double(link.cross) * flat * level_frame;
            Matrix2 pivot = row.frame.transpose() * of_turn;
            pivot.diagonal().array() -= as_double(along);
            Matrix32 given = load;
            given.col(0) += off, given.col(1) += as_vector(air.lever) + grows(turned_about);
            const Matrix2 inverse = pivot.inverse();
            row.load = -inverse * (row.frame.transpose() * given);
            row.pin = -inverse * (row.frame.transpose() * (below + factor * slopes.lever_pin));
            const Matrix32 force_of_turn = turned + factor * slopes.force_direction * row.frame;
            load.col(1) += as_vector(air.force) + grows(carried);
            load += force_of_turn * row.load;
            stiffness = below + turns * as_double(link.rest) * flat + factor * slopes.force_pin +
                        force_of_turn * row.pin;
            pull = pull + turning * carried + Fine(factor) * air.force;
            result.pull.push_back(pull);
        }
        Matrix2 change = Matrix2::Zero();  // of the pin above, for each column
        if (links_.support.yields()) {
            const SupportEnd<Fine>& end = links_.support;
            const Fine spring = end.stiffness / height_, held = turning * end.carriage - spring;
            const Fine3& pin = place[n];
            const Fine x = pull.x + held * pin.x + spring * end.radius, y = pull.y + held * pin.y;
            Matrix2 top = stiffness.topRows<2>(), given = load.topRows<2>();
            top.diagonal().array() += as_double(held);
            given.col(0) += Eigen::Matrix<double, 2, 1>(as_double(x), as_double(y));
            given.col(1) += grows(end.carriage * pin).head<2>();
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

}  // namespace revchain::finite
