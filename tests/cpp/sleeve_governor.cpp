// SPDX-License-Identifier: MPL-2.0
// Governors with a sleeve: numbers of text books, forces in the links (the library differentiates energies), oscillations
// integrated in time, and laws.
#include "revchain/sleeve_governor.hpp"

#include <optional>

#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::GovernorData;
using revchain::GovernorPoint;
using revchain::Index;
using revchain::SleeveGovernor;

namespace {

constexpr double degree = M_PI / 180;

/// The square of the speed from the pulls of the links: moments of a ball's forces about its arm's pivot.
double square_by_forces(const GovernorData& d, double angle, double lift, double friction) {
    const double s = std::sin(angle), c = std::cos(angle), r = d.pivot_offset + d.arm * s;
    const double load = (d.sleeve_mass * d.gravity + d.spring_force + d.spring_stiffness * lift + friction) / d.balls;
    double moment = d.sleeve_arm > 0 ? -d.ball_mass * d.gravity * d.arm * s : d.ball_mass * d.gravity * d.arm * s;
    if (d.sleeve_arm > 0) {
        moment += load * d.sleeve_arm * c;
    } else if (d.lower_arm > 0) {
        const double joint = d.joint > 0 ? d.joint : d.arm, out = d.pivot_offset + joint * s - d.sleeve_offset;
        const double tangent = out / std::sqrt(d.lower_arm * d.lower_arm - out * out);  // of the lower link
        moment += load * joint * (s + c * tangent);
    }
    return moment / (d.ball_mass * r * d.arm * c);
}

/// The governor's point at an angle; none if it cannot reach the angle.
std::optional<GovernorPoint> reached_at(const SleeveGovernor& governor, double angle) {
    try {
        return governor.at(angle);
    } catch (const revchain::InvalidArgument&) {
        return std::nullopt;
    }
}

GovernorData random_governor(support::Random& random) {
    GovernorData d{
        .ball_mass = random.log_between(0.1, 30), .arm = random.log_between(0.05, 3), .gravity = random.between(1, 20)};
    d.balls = 2 + static_cast<int>(random.between(0, 2.99));
    d.pivot_offset = d.arm * random.between(-0.3, 0.5) * (random() < 0.5 ? 0 : 1);
    if (random() < 0.3) {
        d.sleeve_arm = d.arm * random.between(0.2, 1), d.pivot_offset = d.arm * random.between(0.5, 1.5);
    } else {
        d.joint = random() < 0.4 ? d.arm * random.between(0.4, 1) : 0;
        d.lower_arm = d.arm * random.between(1.2, 2), d.sleeve_offset = d.arm * random.between(0, 0.3);
    }
    d.sleeve_mass = d.ball_mass * random.between(0, 10);
    if (random() < 0.5 || d.sleeve_arm > 0) {
        d.spring_force = d.ball_mass * d.gravity * random.between(2, 20);
        d.spring_stiffness = d.spring_force / d.arm * random.between(0, 5);
    }
    d.friction = d.ball_mass * random.between(0, 1);
    if (random() < 0.5) d.shaft_inertia = d.ball_mass * d.arm * d.arm * random.log_between(0.01, 100);
    return d;
}

}  // namespace

TEST_CASE("Watt's governor: 0.7 pi s with the shaft's speed held, 0.388 pi s with a light shaft", "[public]") {
    GovernorData d{.ball_mass = 4, .arm = 1.4, .lower_arm = 1.4, .sleeve_mass = 3, .gravity = 12};
    bool complete = false;
    const auto found = SleeveGovernor(d).equilibria(5, &complete);
    CHECK(complete);
    REQUIRE(found.size() == 2);  // the arms also balance when they hang straight
    CHECK(found[0].inclination == 0);
    CHECK_FALSE(found[0].stable);
    CHECK(std::abs(std::cos(found[1].inclination) - 0.6) <= 2e-16);
    CHECK(std::abs(found[1].period - 0.7 * M_PI) <= 2e-15);
    CHECK(found[1].stable);
    CHECK(std::abs(found[1].height - 0.84) <= 2e-16);
    d.shaft_inertia = 0;
    CHECK(std::abs(SleeveGovernor(d).equilibria(5)[1].period / M_PI - 0.388290137357660) <= 1e-15);
    // g (1 + M/m) / n^2 = h: below this speed it does not open
    CHECK(std::abs(SleeveGovernor(d).speed(0) - std::sqrt(12 * 1.75 / 1.4)) <= 1e-15 * 4);
    CHECK(SleeveGovernor(d).equilibria(3.8).size() == 1);
    CHECK(SleeveGovernor(d).equilibria(3.8)[0].stable);
}

TEST_CASE("Porter's governor: numbers of text books", "[public]") {
    const SleeveGovernor equal(
        {.ball_mass = 2.3, .arm = 0.33, .lower_arm = 0.33, .sleeve_mass = 9.5122, .gravity = 9.81});
    CHECK(std::abs(equal.speed(27 * degree) * 30 / M_PI - 125) <= 5e-5);
    const SleeveGovernor unequal(
        {.ball_mass = 30 / 9.81, .arm = 0.2, .lower_arm = 0.25, .sleeve_mass = 225 / 9.81, .gravity = 9.81});
    CHECK(std::abs(unequal.speed(30 * degree) - 20.7264) <= 5e-5);
    CHECK(std::abs(unequal.speed(40 * degree) - 21.8109) <= 5e-5);
    // equal arms that meet in the axis: effort c (m + M) g for a small change c, power 4 c^2 / (1 + 2 c) (m + M) g h
    const double c = 1e-6, h = 0.33 * std::cos(27 * degree);
    const auto e = equal.effort(27 * degree, c);
    CHECK(std::abs(e.effort / (c * (2.3 + 9.5122) * 9.81) - 1) <= 1e-5);
    CHECK(std::abs(e.power / (4 * c * c * (2.3 + 9.5122) * 9.81 * h) - 1) <= 1e-4);
}

TEST_CASE("random governors: speeds by forces, friction, all equilibria", "[public]") {
    support::Random random(1);
    Index compared = 0, roots = 0, at_rest = 0;
    for (int k = 0; k < 10000; ++k) {
        const GovernorData d = random_governor(random);
        const SleeveGovernor governor(d);
        const double angle = random.between(0.05, 1.2);
        const std::optional<GovernorPoint> reached = reached_at(governor, angle);
        if (!reached) continue;
        const GovernorPoint& p = *reached;
        if (p.ball_radius < 0.05 * d.arm) continue;
        CAPTURE(k, angle, p.lift, d.sleeve_arm, d.lower_arm, d.pivot_offset, d.arm);
        // friction lets the sleeve stay from the one square to the other; where it falls as the arms rise, the other way
        const auto [low, high] = std::minmax(
            {square_by_forces(d, angle, p.lift, -d.friction), square_by_forces(d, angle, p.lift, d.friction)});
        for (const auto& [speed, square] :
             {std::pair(p.speed, square_by_forces(d, angle, p.lift, 0)), {p.low_speed, low}, {p.high_speed, high}}) {
            if (square == low && square <= 0 && high > 0) {
                CHECK(speed == 0);  // friction holds the sleeve at rest, too
                ++at_rest;
            } else if (square <= 0) {
                CHECK(std::isnan(speed));
            } else {
                REQUIRE(std::abs(speed * speed / square - 1) <= 1e-12);
                ++compared;
            }
        }
        if (k % 10 != 0 || !(p.speed > 0)) continue;
        // all sign changes of the unbalanced moment are found
        bool complete = false;
        const auto all = governor.equilibria(p.speed, &complete);
        REQUIRE(complete);
        Index changes = 0;
        const int steps = 4000;
        double last = 0;
        for (int i = 1; i < steps; ++i) {
            const double a = -M_PI / 2 + M_PI * i / steps;
            double off = std::numeric_limits<double>::quiet_NaN();
            try {
                const GovernorPoint at = governor.at(a);
                if (at.ball_radius > 0) off = square_by_forces(d, a, at.lift, 0) - p.speed * p.speed;
            } catch (const revchain::InvalidArgument&) {
            }
            if (last * off < 0) ++changes;
            last = off;
        }
        const auto inside = std::count_if(all.begin(), all.end(),
                                          [&](const GovernorPoint& at) { return at.ball_radius > 1e-12 * d.arm; });
        CHECK(inside >= changes);
        CHECK(std::any_of(all.begin(), all.end(),
                          [&](const GovernorPoint& at) { return std::abs(at.inclination - angle) <= 1e-7; }));
        for (const GovernorPoint& at : all) {
            ++roots;
            if (at.ball_radius > 1e-3 * d.arm)
                CHECK(std::abs(square_by_forces(d, at.inclination, at.lift, 0) / (p.speed * p.speed) - 1) <= 1e-10);
        }
    }
    CHECK(compared > 20000);
    CHECK(roots > 900);
    CHECK(at_rest > 3);
}

TEST_CASE("friction in the axis is the limit of that beside it", "[public]") {
    const SleeveGovernor governor(
        {.ball_mass = 1, .arm = 0.3, .lower_arm = 0.35, .sleeve_mass = 0.5, .friction = 3, .gravity = 9.81});
    const GovernorPoint in = governor.at(0), beside = governor.at(1e-4);
    CHECK(std::abs(in.low_speed / beside.low_speed - 1) < 1e-7);
    CHECK(std::abs(in.high_speed / beside.high_speed - 1) < 1e-7);
    CHECK(in.low_speed < 0.95 * in.speed);
    CHECK(in.speed < 0.95 * in.high_speed);
    CHECK(governor.effort(0, 0.01).effort > 0);
}

TEST_CASE("periods are those of oscillations integrated in time", "[public]") {
    support::Random random(2);
    int compared = 0;
    for (int k = 0; k < 60 && compared < 25; ++k) {
        const GovernorData d = random_governor(random);
        const SleeveGovernor governor(d);
        const double angle = random.between(0.3, 0.9);
        const std::optional<GovernorPoint> reached = reached_at(governor, angle);
        if (!reached) continue;
        const GovernorPoint& p = *reached;
        if (!(p.period > 0) || p.ball_radius < 0.1 * d.arm) continue;
        // Energy and, if the shaft is free, angular momentum; forces from differences of energies.
        const auto place = [&](double x) {
            const double s = std::sin(x), c = std::cos(x);
            const bool lever = d.sleeve_arm > 0;
            const double joint = d.joint > 0 ? d.joint : d.arm, out = d.pivot_offset - d.sleeve_offset + joint * s;
            const double y = lever ? d.sleeve_arm * s : -joint * c - std::sqrt(d.lower_arm * d.lower_arm - out * out);
            return std::array{d.pivot_offset + d.arm * s, lever ? d.arm * c : -d.arm * c, y};
        };
        const double y0 = place(0)[2], balls = d.balls * d.ball_mass;
        const auto inertia = [&](double x) { return balls * place(x)[0] * place(x)[0]; };
        const double momentum = p.speed * (d.shaft_inertia + inertia(angle));
        const auto energy = [&](double x) {
            const auto [r, h, y] = place(x);
            const double lift = y - y0, J = balls * r * r;
            const double V = balls * d.gravity * h + (d.sleeve_mass * d.gravity + d.spring_force) * lift +
                             d.spring_stiffness / 2 * lift * lift;
            return V + (std::isinf(d.shaft_inertia) ? -p.speed * p.speed * J / 2
                                                    : momentum * momentum / (2 * (d.shaft_inertia + J)));
        };
        const double e = 1e-3;
        const double stiff = (-energy(angle + 2 * e) + 16 * energy(angle + e) - 30 * energy(angle) +
                              16 * energy(angle - e) - energy(angle - 2 * e)) /
                             (12 * e * e);
        double moving = 0;
        const auto slope = [&](std::size_t i) { return (place(angle + e)[i] - place(angle - e)[i]) / (2 * e); };
        moving += balls * (slope(0) * slope(0) + slope(1) * slope(1)) + d.sleeve_mass * slope(2) * slope(2);
        CAPTURE(k, angle, d.sleeve_arm, d.shaft_inertia, p.period);
        CHECK(std::abs(p.period / (2 * M_PI * std::sqrt(moving / stiff)) - 1) <= 1e-4);
        ++compared;
    }
    CHECK(compared == 25);
}

TEST_CASE("Hartnell: an isochronous spring has one speed at all inclinations", "[public]") {
    // Without gravity the ball's pull m n^2 r a cos balances F b cos / 2 at every inclination if F is in proportion to r.
    const double n = 30, m = 1.5, a = 0.12, b = 0.06, r0 = 0.12;
    const SleeveGovernor governor({.ball_mass = m,
                                   .arm = a,
                                   .pivot_offset = r0,
                                   .sleeve_arm = b,
                                   .spring_stiffness = 2 * m * n * n * a * a / (b * b),
                                   .spring_force = 2 * m * n * n * r0 * a / b,
                                   .gravity = 1e-12});
    for (const double angle : {-0.5, -0.1, 0.0, 0.2, 0.6}) CHECK(std::abs(governor.speed(angle) - n) <= 1e-10);
}

TEST_CASE("governors: what is refused", "[public]") {
    using Catch::Matchers::Contains;
    const GovernorData d{.ball_mass = 1, .arm = 1};
    const auto with = [&](auto change) {
        GovernorData changed = d;
        change(changed);
        return SleeveGovernor(changed);
    };
    CHECK_THROWS_WITH(with([](auto& x) { x.ball_mass = 0; }), Contains("ball mass"));
    CHECK_THROWS_WITH(with([](auto& x) { x.sleeve_mass = 1; }),
                      Contains("needs a sleeve: give lower_arm or sleeve_arm, got 1"));
    CHECK_THROWS_WITH(with([](auto& x) { x.lower_arm = 1, x.sleeve_arm = 1; }), Contains("not both"));
    CHECK_THROWS_WITH(with([](auto& x) { x.lower_arm = 1, x.sleeve_mass = -1; }), Contains("sleeve mass"));
    CHECK_THROWS_WITH(with([](auto& x) { x.lower_arm = 1, x.pivot_offset = 1.5; }),
                      Contains("long enough to reach the sleeve"));
    CHECK_THROWS_WITH(with([](auto& x) { x.balls = 0; }), Contains("balls must be at least 1"));
    const SleeveGovernor governor(d);
    CHECK_THROWS_WITH(governor.at(2.0), Contains("cannot reach"));
    CHECK_THROWS_WITH(governor.equilibria(-1), Contains("speed"));
    CHECK_THROWS_WITH(governor.effort(0.5, 0), Contains("change"));
    CHECK_THROWS_WITH(SleeveGovernor({.ball_mass = 1, .arm = 1}).effort(0.5), Contains("effort: needs a sleeve"));
    CHECK_THROWS_WITH(SleeveGovernor({.ball_mass = 1, .arm = 0.3, .sleeve_arm = 0.1, .spring_force = -100}).effort(0.2),
                      Contains("effort: inclination must have an equilibrium at a speed above 0"));
}

TEST_CASE("governor: all but isochronous, the search ends", "[public]") {
    // spring and balls balance at 1 rad/s at every inclination, apart from gravity
    for (const double gravity : {1e-2, 1e-4, 1e-9, 1e-300}) {
        const SleeveGovernor hartnell({.ball_mass = 1,
                                       .arm = 1,
                                       .pivot_offset = 1,
                                       .sleeve_arm = 1,
                                       .spring_stiffness = 2,
                                       .spring_force = 2,
                                       .gravity = gravity});
        bool complete = false;
        const auto found = hartnell.equilibria(1, &complete);
        CHECK(complete == (gravity >= 1e-2));
        if (complete) CHECK(found.size() == 1);
    }
}

TEST_CASE("governor: arms all but straight across at high speeds", "[public]") {
    // equal arms: cos = (n_0 / n)^2 with n_0^2 = (1 + sleeve / ball) g / arm
    const SleeveGovernor porter({.ball_mass = 2.3, .arm = 0.33, .lower_arm = 0.33, .sleeve_mass = 9.5});
    const double slowest = std::sqrt((1 + 9.5 / 2.3) * 9.80665 / 0.33);
    for (const double ratio : {1.5, 20.0, 100.0, 150.0, 200.0, 1e3, 1e6, 1e30}) {
        CAPTURE(ratio);
        bool complete = false;
        const auto found = porter.equilibria(ratio * slowest, &complete);
        REQUIRE(found.size() >= 1);
        CHECK(found.front().inclination == 0);
        if (found.size() == 1) {
            CHECK_FALSE(complete);  // nearer to the horizontal than doubles tell
            CHECK(ratio > 1e3);
            continue;
        }
        // the cosine of the lower link is found from its sine, to 1e-16 over the cosine
        CHECK(std::abs(std::cos(found[1].inclination) - 1 / (ratio * ratio)) < 1e-12 + 1e-16 * ratio * ratio);
        CHECK(found[1].stable);
        if (ratio <= 100) CHECK(complete);
    }
    CHECK_THROWS_AS(porter.equilibria(1e200), revchain::InvalidArgument);
}
