// SPDX-License-Identifier: GPL-3.0-or-later
// Greenhill (1908) §7: the link as governor, from rest at an angle alpha, against the paper's forms. Motion from any start
// against integration: tests/cpp/governor.cpp.
#include "paper.hpp"
#include "revchain/governor.hpp"

using paper::error_in_ulp;
using paper::Quad;
using revchain::analytic::EllipticModulus;
using revchain::analytic::Governor;
using revchain::analytic::GovernorMotion;
using revchain::analytic::GovernorRegime;
using revchain::analytic::JacobiFunctions;

namespace {

const double g = 9.80665;

/// Largest difference of theta/2 between a motion and what the paper writes, over a period and a half.
template <class F>
double difference(const GovernorMotion& motion, double time, const F& half_tangent) {
    double worst = 0;
    for (int i = 0; i <= 30; ++i) {
        const double t = time * i / 20;
        worst = std::max(worst, std::abs(std::tan(motion(t).angle / 2) / half_tangent(t) - 1));
    }
    return worst;
}

}  // namespace

TEST_CASE("§7 (2)-(5): between alpha and beta on one side, dn", "[paper][section_7]") {
    paper::Random random(704);
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        const double alpha = random.between(0.5, 3.0), beta = alpha * random.between(0.1, 0.95),
                     n = random.log_between(0.1, 10.0);
        const double ratio = (std::cos(alpha) + std::cos(beta)) / 2;  // (3), lambda/l
        if (!(ratio > 0.01)) continue;
        const double l = g / (n * n) / ratio;
        const GovernorMotion motion({.angular_speed = n, .pendulum_length = l, .gravity = g, .angle = alpha});
        REQUIRE(motion.regime() == GovernorRegime::aside);
        CHECK(std::abs(motion.least_angle() - beta) <= 1e-13);
        CHECK(std::abs(motion.greatest_angle() - alpha) <= 1e-15 * 4);
        const double k = std::tan(beta / 2) / std::tan(alpha / 2),
                     m = n * std::sin(alpha / 2) * std::cos(beta / 2);  // (5)
        const JacobiFunctions f(EllipticModulus::of_complement(k));
        worst = std::max(
            worst, difference(motion, motion.period(), [&](double t) { return std::tan(alpha / 2) * f(m * t).dn; }));
        CHECK(error_in_ulp(motion.period(), Quad(2 * f.complete().K / m)) <= 2000);  // beta through lambda/l, rounded
        for (const double t : {0.1, 0.5, 1.3}) {                                     // (2)
            const auto s = motion(t * motion.period());
            const double square = n * n * (std::cos(s.angle) - std::cos(alpha)) * (std::cos(beta) - std::cos(s.angle));
            CHECK(std::abs(s.angle_rate * s.angle_rate - square) <= 1e-13 * n * n);
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 2e-12);
}

TEST_CASE("§7 (6), (7): small oscillations take 2 pi/(n sin d), half of what is printed", "[paper][section_7]") {
    for (const double ratio : {0.1, 0.5, 0.9}) {
        const double n = 3, height = g / (n * n), l = height / ratio, delta = std::acos(ratio);
        const GovernorMotion motion({.angular_speed = n, .pendulum_length = l, .gravity = g, .angle = delta + 1e-6});
        const double period = 2 * std::numbers::pi / (n * std::sin(delta));
        CHECK(std::abs(motion.period() / period - 1) <= 1e-10);
        CHECK(std::abs(2 * std::numbers::pi * std::sqrt(height / g) / std::sqrt(1 - ratio * ratio) / period - 1) <=
              1e-14);
        CHECK(std::abs(2 * std::numbers::pi * std::sqrt(l / g) * std::sqrt(l * height) /
                           std::sqrt(l * l - height * height) / period -
                       1) <= 1e-14);
        const double printed = 4 * std::numbers::pi * std::sqrt(height / g) / std::sqrt(1 - ratio * ratio);
        CHECK(std::abs(printed / motion.period() - 2) <= 1e-9);
    }
}

TEST_CASE("§7 (8)-(10): just to the lowest point, sech; through it, cn", "[paper][section_7]") {
    paper::Random random(709);
    const double n = 4;
    double sech = 0, worst = 0;
    for (int i = 0; i < 100; ++i) {
        const double alpha = random.between(0.3, 2.8), l_just = g / (n * n) / std::pow(std::cos(alpha / 2), 2);
        // lambda/l = (1 + cos alpha)/2, as nearly as it can be written down
        const GovernorMotion just({.angular_speed = n, .pendulum_length = l_just, .gravity = g, .angle = alpha});
        const double m = n * std::sin(alpha / 2);
        for (const double t : {0.2, 0.7, 1.5})
            sech = std::max(sech, std::abs(std::tan(just(t / m).angle / 2) / (std::tan(alpha / 2) / std::cosh(t)) - 1));
        const double l = l_just * random.between(0.1, 0.95), ratio = g / (n * n) / l;
        const GovernorMotion through({.angular_speed = n, .pendulum_length = l, .gravity = g, .angle = alpha});
        REQUIRE(through.regime() == GovernorRegime::through);
        const double square = std::pow(std::sin(alpha / 2), 2) * (2 * ratio + 1 - std::cos(alpha)) /
                              (2 * (ratio - std::cos(alpha)));  // (10)
        const JacobiFunctions f(EllipticModulus::of(std::sqrt(square)));
        const double rate = n * std::sqrt(ratio - std::cos(alpha));
        CHECK(std::abs(through.period() / (4 * f.complete().K / rate) - 1) <= 1e-11);
        for (int j = 0; j <= 30; ++j) {
            const double t = through.period() * j / 20;
            worst = std::max(worst, std::abs(through(t).angle - 2 * std::atan(std::tan(alpha / 2) * f(rate * t).cn)));
        }
    }
    CAPTURE(sech, worst);
    CHECK(sech <= 1e-13);
    CHECK(worst <= 1e-10);  // kappa from (10) next to 1
    // No rotation: the common pendulum, kappa = sin(alpha/2)
    const GovernorMotion still({.angular_speed = 0, .pendulum_length = 1, .gravity = g, .angle = 2});
    CHECK(error_in_ulp(still.modulus().modulus(), Quad(std::sin(1.0))) <= 2);
}

TEST_CASE("§7 (11)-(13): to the top, sinh; revolutions, tn; gravity reversed, nc", "[paper][section_7]") {
    const double n = 2, l = 1.5, c = g / (n * n) / l;
    // (11) from the lowest point with just the energy: theta'^2 = n^2 (D^2 - (1 - c)^2), D = 1 + c
    const double start = n * std::sqrt((1 + c) * (1 + c) - (1 - c) * (1 - c));
    const GovernorMotion top({.angular_speed = n, .pendulum_length = l, .gravity = g, .angle = 0, .angle_rate = start});
    const double C = std::sqrt(c / (1 + c)), m = n * std::sqrt(1 + c);
    for (const double t : {0.1, 0.3, 0.6})
        CHECK(std::abs(std::tan(top(t).angle / 2) / (C * std::sinh(m * t)) - 1) <= 1e-13);
    // (12) with more: D > 1 + c
    for (const double D : {1.01 + c, 2 + c, 100 + c}) {
        const double A = c - D, B = c + D;
        const GovernorMotion round({.angular_speed = n,
                                    .pendulum_length = l,
                                    .gravity = g,
                                    .angle = 0,
                                    .angle_rate = n * std::sqrt((D - 1 + c) * (D + 1 - c))});
        REQUIRE(round.regime() == GovernorRegime::revolutions);
        const double scale = std::sqrt((B - 1) / (B + 1)), rate = n / 2 * std::sqrt((1 - A) * (1 + B));
        const JacobiFunctions f(EllipticModulus::of(std::sqrt(2 * (B - A) / ((1 + B) * (1 - A)))));
        CHECK(std::abs(round.period() / (2 * f.complete().K / rate) - 1) <= 1e-12);
        for (const double share : {0.05, 0.2, 0.45}) {
            const double t = share * round.period();
            const auto j = f(rate * t);
            CHECK(std::abs(std::tan(round(t).angle / 2) / (scale * j.sn / j.cn) - 1) <= 1e-11);
        }
    }
    // (13) from rest at beta, through the highest point: -g
    const double beta = 0.8;
    const GovernorMotion over({.angular_speed = n, .pendulum_length = l, .gravity = -g, .angle = beta});
    const double rate = n * std::sqrt(std::cos(beta) + c);
    const double square = std::pow(std::cos(beta / 2), 2) * (1 + std::cos(beta) + 2 * c) / (2 * (std::cos(beta) + c));
    const JacobiFunctions f(EllipticModulus::of(std::sqrt(square)));
    for (const double t : {0.1, 0.2, 0.3})
        CHECK(std::abs(std::tan(over(t).angle / 2) / (std::tan(beta / 2) / f(rate * t).cn) - 1) <= 1e-12);
}
