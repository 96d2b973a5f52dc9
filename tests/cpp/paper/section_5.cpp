// SPDX-License-Identifier: GPL-3.0-or-later
// Greenhill (1908) §5: the chain without gravity. a is half the distance between nodes, b the sag, h the tension-length.
// Its differential equation, the variational remark and the inverse questions: tests/cpp/rope.cpp;
// "a tortuous curve": tests/cpp/rope.cpp.
#include "paper.hpp"
#include "revchain/hoop.hpp"
#include "revchain/rope.hpp"

using paper::error_in_ulp;
using paper::Quad;
using revchain::analytic::JacobiFunctions;
using revchain::analytic::SkippingRope;
namespace hoop = revchain::hoop;

TEST_CASE("§5 (1), (2): y = b sn(K x/a), modulus and K from b, a and lambda h", "[paper][section_5]") {
    paper::Random random(501);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
        const double a = random.log_between(1e-6, 1e6), b = a * random.log_between(1e-6, 1e4);
        const SkippingRope rope({.span = 2 * a, .sag = b});
        const Quad strength = rope.height_times_tension(), B = b, A = a, root = sqrtq(4 * strength + B * B);
        const JacobiFunctions functions(rope.modulus());
        const double K = functions.complete().K;
        worst = std::max({worst, error_in_ulp(rope.modulus().modulus(), B / root),
                          error_in_ulp(K, A * root / (2 * strength)),
                          error_in_ulp(rope.modulus().modulus() * K, A * B / (2 * strength))});
        const double x = a * random.between(0.0, 1.0);
        const auto f = functions(K * x / a);
        CHECK(std::abs(rope.at(x).offset - b * f.sn) <= 3e-15 * b * (f.sn + K * x / a * f.cn * f.dn));
    }
    CAPTURE(worst);
    CHECK(worst <= 40);
}

TEST_CASE("§5 (3)-(5): nearly straight, lambda h = (2a/pi)^2, R = sqrt(g h)/4a, y = b sin(pi x/2a)",
          "[paper][section_5]") {
    const double a = 1.5, b = 1e-7;
    const SkippingRope rope({.span = 2 * a, .sag = b, .angular_speed = 40.0});
    const double half_pi = std::numbers::pi / 2;
    CHECK(std::abs(rope.height_times_tension() / (a * a / (half_pi * half_pi)) - 1) <=
          3e-14);  // (3), and (5): 4 a^2/pi^2
    const double revolutions = rope.angular_speed() / (2 * std::numbers::pi);
    const double h = rope.tension_in_the_middle();
    CHECK(std::abs(0.25 * std::sqrt(9.80665 * h) / a / revolutions - 1) <= 3e-14);  // (3), the comma that is missing
    CHECK(std::abs(hoop::string_revolutions_per_second(2 * a, h) / revolutions - 1) <= 3e-14);
    for (const double x : {0.2, 0.9, 1.5, 2.6})
        CHECK(std::abs(rope.at(x).offset / (b * std::sin(half_pi * x / a)) - 1) <= 3e-14);  // (4)
    // "its C.G., at a distance b / (pi/2) from the axis": the mean of (4)
    CHECK(std::abs(rope.moment_of_inertia() / (2 * a * b * b / 2) - 1) <= 3e-14);
    // (5), the balance of the whole: 2 w h (pi/2) b/a = 2 w a b / ((pi/2) lambda)
    CHECK(std::abs(h * half_pi * b / a / (a * b / (half_pi * rope.conical_height())) - 1) <= 3e-14);
    // The velocity of waves, sqrt(g h): up and down a half wave in the time of one revolution
    CHECK(std::abs(hoop::speed(h) / (2 * 2 * a * revolutions) - 1) <= 3e-14);
}

TEST_CASE("§5 text: drawn out straight, the angular velocity as the moment of inertia falls", "[paper][section_5]") {
    // Length 2, ends 2a apart; speed over that at a = 1/8, from quadratures in 15 digits.
    const SkippingRope rope({.span = 0.25, .length = 2.0, .angular_speed = 1.0});
    const double half_spans[]{0.125, 0.25, 0.5, 0.75, 0.875, 31.0 / 32, 1023.0 / 1024};
    const double speeds[]{1, 1.0321, 1.2276, 1.9838, 3.5904, 13.361, 417.92};
    double last_speed = 0, last_energy = 0;
    for (std::size_t i = 0; i < 7; ++i) {
        const SkippingRope drawn = rope.drawn_to(2 * half_spans[i]);
        CHECK(std::abs(drawn.angular_speed() / speeds[i] - 1) <= 5e-5);
        CHECK(std::abs(drawn.length() - 2) <= 2e-15);
        const double momentum = drawn.moment_of_inertia() * drawn.angular_speed();
        CHECK(std::abs(momentum / rope.moment_of_inertia() - 1) <= 1e-14);
        const double energy = momentum * drawn.angular_speed() / 2;
        CHECK(drawn.angular_speed() > last_speed);
        CHECK(energy > last_energy);
        last_speed = drawn.angular_speed(), last_energy = energy;
    }
    // Work done on it is the pull times the way: dE/d(2a) = h g, over the mass per length.
    for (const double span : {0.4, 1.0, 1.7}) {
        const auto energy = [&](double at) {
            const SkippingRope drawn = rope.drawn_to(at);
            return drawn.moment_of_inertia() * drawn.angular_speed() * drawn.angular_speed() / 2;
        };
        const double step = 1e-3;  // five points: fourth order
        const double rate =
            (8 * (energy(span + step) - energy(span - step)) - energy(span + 2 * step) + energy(span - 2 * step)) /
            (12 * step);
        CHECK(std::abs(rate / (9.80665 * rope.drawn_to(span).tension_in_the_middle()) - 1) <= 1e-9);
    }
}
