// SPDX-License-Identifier: MPL-2.0
#include "revchain/conical_pendulum.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

namespace pendulum = revchain::conical_pendulum;
using support::error_in_ulp;
using support::Quad;

// Every function against quadruple precision, at ordinary, tiny and huge arguments. The bounds are the measured maxima, rounded up.
TEMPLATE_TEST_CASE("the conical pendulum to 2.1 ulp", "[core]", float, double, long double) {
    using T = TestType;
    support::Random random(3);
    double speed = 0, height = 0, period = 0, back = 0, turns = 0, gravity = 0, seconds = 0, seconds_height = 0,
           from_turns = 0;
    for (int i = 0; i < 20000; ++i) {
        const double reach = i % 3 == 0 ? 1.0 : 9.0;
        const T x = static_cast<T>(std::pow(10.0, random.between(-reach, reach)));
        const T g = static_cast<T>(std::pow(10.0, random.between(-reach, reach)));
        const Quad X = x, G = g, pi = 4 * atanq(Quad(1));
        speed = std::max(speed, error_in_ulp(pendulum::angular_speed(x, g), sqrtq(G / X)));
        height = std::max(height, error_in_ulp(pendulum::height(x, g), G / (X * X)));
        period = std::max(period, error_in_ulp(pendulum::period(x, g), 2 * pi * sqrtq(X / G)));
        back = std::max(back, error_in_ulp(pendulum::height_from_period(x, g), G * X * X / (4 * pi * pi)));
        turns = std::max(turns, error_in_ulp(pendulum::revolutions_per_second(x, g), sqrtq(G / X) / (2 * pi)));
        from_turns = std::max(
            from_turns, error_in_ulp(pendulum::height_from_revolutions_per_second(x, g), G / (4 * pi * pi * X * X)));
        gravity = std::max(gravity, error_in_ulp(pendulum::gravity(g, x), 4 * pi * pi * G / (X * X)));
        seconds = std::max(seconds, error_in_ulp(pendulum::gravity_from_seconds_pendulum(x), pi * pi * X));
        seconds_height =
            std::max(seconds_height, error_in_ulp(pendulum::height_from_seconds_pendulum(g, x), G * X * X / 4));
    }
    CAPTURE(speed, height, period, back, turns, gravity, seconds, seconds_height, from_turns);
    CHECK(speed <= 1.3);
    CHECK(height <= 1.0);
    CHECK(period <= 1.8);
    CHECK(back <= 2.1);
    CHECK(turns <= 1.8);
    CHECK(from_turns <= 2.9);
    CHECK(gravity <= 2.1);
    CHECK(seconds <= 1.1);
    CHECK(seconds_height <= 1.0);
}

TEST_CASE("quotients that would leave the range do not", "[core]") {
    CHECK(pendulum::angular_speed(1e-300, 1e300) == Approx(1e300));
    CHECK(pendulum::period(1e300, 1e-300) == Approx(2 * 3.141592653589793 * 1e300));
}

TEST_CASE("what is not positive and finite is refused", "[core]") {
    const double bad =
        GENERATE(0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN());
    CHECK_THROWS_AS(pendulum::angular_speed(bad, 9.8), revchain::InvalidArgument);
    CHECK_THROWS_AS(pendulum::angular_speed(1.0, bad), revchain::InvalidArgument);
    CHECK_THROWS_AS(pendulum::height(bad, 9.8), revchain::InvalidArgument);
    CHECK_THROWS_AS(pendulum::height(1.0, bad), revchain::InvalidArgument);
    CHECK_THROWS_AS(pendulum::period(bad, 9.8), revchain::InvalidArgument);
    CHECK_THROWS_AS(pendulum::period(1.0, bad), revchain::InvalidArgument);
    CHECK_THROWS_AS(pendulum::height_from_period(bad, 9.8), revchain::InvalidArgument);
    CHECK_THROWS_AS(pendulum::gravity(bad, 1.0), revchain::InvalidArgument);
    CHECK_THROWS_AS(pendulum::gravity(1.0, bad), revchain::InvalidArgument);
    CHECK_THROWS_AS(pendulum::gravity_from_seconds_pendulum(bad), revchain::InvalidArgument);
    CHECK_THROWS_AS(pendulum::height_from_seconds_pendulum(bad, 1.0), revchain::InvalidArgument);
}
