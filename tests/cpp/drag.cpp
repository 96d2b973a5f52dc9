// SPDX-License-Identifier: MPL-2.0
// Shapes with air drag: closed forms, the work of the drag by another rule, limits. Lagrange's equations are in
// tests/python/test_drag.py.
#include "revchain/drag.hpp"

#include "revchain/branches.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/tier.hpp"

using namespace revchain;

namespace {

/// The power of the drag from the places of the pins: the rule of midpoints on each link, extrapolated.
double power_of_drag(const Rig& rig, const Drag& air, const DragShape& shape, double n) {
    const auto of = [](const std::vector<double>& list, Index m) {
        return list.empty() ? 0.0 : list.size() == 1 ? list[0] : list[static_cast<std::size_t>(m)];
    };
    const auto rule = [&](int parts) {
        double power = 0;
        for (Index m = 0; m < rig.size(); ++m) {
            const auto lower = shape.position.row(m), upper = shape.position.row(m + 1);
            const double a = rig.chain().length()[m];
            const double u[3] = {(lower[0] - upper[0]) / a, (lower[1] - upper[1]) / a, (lower[2] - upper[2]) / a};
            const auto moved = [&](double s, bool across) {
                const double x = upper[0] + s * u[0], y = upper[1] + s * u[1];
                double v[3] = {-n * y, n * x, 0};
                const double slip = across ? u[0] * v[0] + u[1] * v[1] : 0;
                double square = 0;
                for (int k = 0; k < 3; ++k) v[k] -= slip * u[k], square += v[k] * v[k];
                return square * std::sqrt(square);  // force times velocity: what is across does no other work
            };
            const double pressure = air.density / 2;
            for (int k = 0; k < parts; ++k)
                power += pressure * of(air.coefficient, m) * of(air.diameter, m) * a / parts *
                         moved(a * (k + 0.5) / parts, true);
            power += pressure * of(air.coefficient, m) * of(air.area, m) * moved(rig.chain().link(m).centroid, false);
        }
        return power;
    };
    return (4 * rule(2000) - rule(1000)) / 3;
}

}  // namespace

TEST_CASE("random carried chains: torque from the force on the support, power from the drag", "[questions]") {
    support::Random random(7);
    int solved = 0, count = support::by_tier(60, 600);
    for (int k = 0; k < count; ++k) {
        const auto n = static_cast<Index>(random.between(1, 12.99));
        std::vector<Link<double>> links;
        double length = 0, weight = 0;
        for (Index m = 0; m < n; ++m) {
            const double a = random.log_between(0.1, 10), w = random.log_between(0.01, 100);
            links.push_back(compound_pendulum<double>({.weight = w,
                                                       .length = a,
                                                       .centroid = a * random.between(0.05, 1.5),
                                                       .radius_of_gyration = a * random()}));
            length += a, weight += w;
        }
        const double speed = std::sqrt(9.81 / length) * random.log_between(0.3, 5);
        const Rig rig(Chain<double>(links), {.support = carried_round(length * random.log_between(0.03, 3))});
        const double strength = weight / 9.81 / length * random.log_between(1e-3, 10);
        const Drag air{
            .coefficient = {1.1}, .diameter = {strength / length}, .area = {strength / double(n) * random()}};
        const DragShape shape = drag_shape(rig, air, {.angular_speed = speed, .gravity = 9.81});
        CAPTURE(k, n, speed, to_string(shape.status), shape.factor, shape.folds);
        if (shape.status != DragStatus::success) continue;
        ++solved;
        CHECK(shape.factor == 1);
        CHECK(shape.residual <= 1e-14);
        CHECK(shape.error_estimate <= 1e-13);
        CHECK(std::abs(shape.power / power_of_drag(rig, air, shape, speed) - 1) <= 1e-7);
        for (Index m = 0; m < n; ++m) {
            const double a = rig.chain().length()[m];
            CHECK(std::abs((shape.position.row(m) - shape.position.row(m + 1)).norm() / a - 1) <= 1e-13 * length / a);
            CHECK(std::abs(shape.position(m, 2) - shape.position(m + 1, 2) + a * std::cos(shape.inclination[m])) <=
                  1e-15 * length + 4e-16 * a);
        }
    }
    CHECK(solved >= count * 97 / 100);
}

TEST_CASE("without drag the shape from rest is that of the branch from rest, to the last bits", "[questions]") {
    for (const Index n : {1, 10, 100})
        for (const double speed : {0.5, 2.0, 10.0, 100.0})
            for (const double radius : {0.1, 2.0}) {
                const Rig rig(Chain<double>::uniform_rods(n, 3.0, 10.0), {.support = carried_round(radius)});
                const SteadyShape plane = steady_shape(rig, RigOnBranchOptions{.angular_speed = speed});
                const DragShape shape = drag_shape(rig, {}, {.angular_speed = speed});
                CAPTURE(n, speed, radius);
                REQUIRE(shape.status == DragStatus::success);
                CHECK((shape.position.col(0) - plane.offset).cwiseAbs().maxCoeff() <= 4e-16 * (3 + radius));
                CHECK((shape.position.col(2) - plane.height).cwiseAbs().maxCoeff() <= 4e-16 * 3);
                CHECK(shape.position.col(1).isZero(0));
                CHECK(((shape.tension - plane.tension).array() / plane.tension.array()).abs().maxCoeff() <= 4e-16);
                CHECK(shape.torque == 0);
            }
}

TEST_CASE("a fold in the drag is met at one place, from every drag beyond it", "[questions]") {
    const Rig rig(Chain<double>::uniform_rods(10, 3.0, 9.81), {.support = carried_round(0.5)});
    double first = 0;
    for (const double diameter : {0.1, 1.0, 100.0}) {
        const DragShape shape =
            drag_shape(rig, {.coefficient = {1.2}, .diameter = {diameter}}, {.angular_speed = 10.0, .half_waves = 1});
        REQUIRE(shape.status == DragStatus::fold);
        if (first == 0) first = shape.factor * diameter;
        CHECK(std::abs(shape.factor * diameter / first - 1) <= 1e-6);
        const DragShape rested =
            drag_shape(rig, {.coefficient = {1.2}, .diameter = {diameter}}, {.angular_speed = 10.0});
        CHECK(rested.status == DragStatus::success);
        CHECK(rested.residual <= 1e-15);
    }
}

TEST_CASE("at speeds beyond all bounds there is no fold before the way begins", "[questions]") {
    const Rig rig(Chain<double>({plummet(9.81, 2.0)}), {.support = carried_round(0.5)});
    for (const double coefficient : {0.5, 0.0})
        for (const double speed : {1e8, 5e8, 1e9, 1e12, 1e20, 1e50}) {
            const DragShape shape =
                drag_shape(rig, {.coefficient = {coefficient}, .area = {0.05}}, {.angular_speed = speed});
            CAPTURE(coefficient, speed, to_string(shape.status), shape.factor);
            CHECK(shape.status != DragStatus::fold);
            CHECK(shape.folds == 0);
            CHECK(shape.factor >= 0);
        }
}

TEST_CASE("what shapes with drag refuse", "[questions]") {
    using Catch::Matchers::Contains;
    const Chain<double> chain({plummet(1.0, 1.0), plummet(2.0, 1.0)});
    const Rig rig(chain, {.support = carried_round(0.5)});
    const Drag air{.coefficient = {1.0}, .diameter = {0.1}};
    const auto asked = [&](const Rig& of, const Drag& drag, double speed = 1.0) {
        return drag_shape(of, drag, {.angular_speed = speed});
    };
    CHECK_THROWS_WITH(asked(Rig(chain, {}), air), Contains("no steady whirl") && Contains("give the support a radius"));
    CHECK_THROWS_WITH(asked(rig, air, 0.0), Contains("angular speed"));
    CHECK_THROWS_WITH(asked(rig, {.coefficient = {1.0, 1.0, 1.0}}), Contains("one number or one for each link"));
    CHECK_THROWS_WITH(asked(rig, {.coefficient = {-1.0}}), Contains("coefficient") && Contains("not negative"));
    CHECK_THROWS_WITH(asked(Rig(chain, {.support = carried_round(0.5), .pins = {{.stiffness = 1}, {}}}), air),
                      Contains("springs at pins"));
    CHECK_THROWS_WITH(asked(Rig(chain, {.support = carried_round(0.5), .fluid = Fluid::turning}), air),
                      Contains("no drag"));
    CHECK_THROWS_WITH(asked(Rig(chain, {.support = {.stiffness = 0.0, .carriage_weight = 1}}), air),
                      Contains("on the axis"));
    CHECK_THROWS_WITH(drag_shape(rig, air, {.angular_speed = 1.0, .half_waves = 7}), Contains("half waves"));
}
