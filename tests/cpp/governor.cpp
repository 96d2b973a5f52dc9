// SPDX-License-Identifier: GPL-3.0-or-later
#include "revchain/governor.hpp"

#include <array>

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/tier.hpp"
#include "support/truth.hpp"

using revchain::analytic::Governor;
using revchain::analytic::GovernorMotion;
using revchain::analytic::GovernorRegime;
using support::Quad;

namespace {

/// theta'' = n^2 sin theta cos theta - G sin theta by Taylor series of order 30 in quadruple precision.
class Integrated {
   public:
    explicit Integrated(const Governor& g)
        : square_(Quad(g.angular_speed) * Quad(g.angular_speed) * (1 - Quad(g.axial_inertia))),
          pull_(Quad(g.gravity) / Quad(g.pendulum_length)),
          angle(g.angle),
          rate(g.angle_rate) {}

    void go_to(Quad time) {
        const Quad pace = sqrtq(square_ + fabsq(pull_) + rate * rate) + Quad(1e-300);
        while (now_ != time) {
            const Quad left = time - now_, longest = Quad(0.2) / pace;
            const Quad step = fabsq(left) <= longest ? left : left > 0 ? longest : -longest;
            advance(step);
            now_ = fabsq(left) <= longest ? time : now_ + step;
        }
    }

   private:
    static constexpr std::size_t order = 30;
    Quad square_, pull_, now_ = 0;

    void advance(Quad step) {
        std::array<Quad, order + 1> a{}, w{}, s{}, c{};
        a[0] = angle, w[0] = rate, s[0] = sinq(angle), c[0] = cosq(angle);
        for (std::size_t k = 0; k < order; ++k) {
            Quad product = 0;
            for (std::size_t j = 0; j <= k; ++j) product += s[j] * c[k - j];
            const Quad next = static_cast<Quad>(k + 1);
            a[k + 1] = w[k] / next;
            w[k + 1] = (square_ * product - pull_ * s[k]) / next;
            for (std::size_t j = 1; j <= k + 1; ++j) {
                s[k + 1] += static_cast<Quad>(j) * a[j] * c[k + 1 - j];
                c[k + 1] -= static_cast<Quad>(j) * a[j] * s[k + 1 - j];
            }
            s[k + 1] /= next, c[k + 1] /= next;
        }
        angle = rate = 0;
        for (std::size_t k = order + 1; k-- > 0;) angle = angle * step + a[k], rate = rate * step + w[k];
    }

   public:
    Quad angle, rate;
};

/// Worst error over some times, in the angle over |theta| + |t theta'| and the rate likewise, and the start's own.
double worst_error(const Governor& given, double longest) {
    const GovernorMotion motion(given);
    double worst = 0;
    for (const double direction : {1.0, -1.0}) {
        Integrated truth(given);
        for (const double share : {0.0, 0.03, 0.2, 0.5, 1.0}) {
            const double t = direction * share * longest;
            truth.go_to(t);
            const auto state = motion(t);
            const double pull = given.gravity / given.pendulum_length, n2 = given.angular_speed * given.angular_speed;
            const double force = std::abs(n2) + std::abs(pull);
            const double angle_size =
                std::abs(state.angle) + std::abs(state.angle_rate) * (std::abs(t) + 1 / std::sqrt(force));
            const double jerk = force * std::abs(std::sin(state.angle));
            const double rate_size = std::abs(state.angle_rate) + jerk * (std::abs(t) + 1 / std::sqrt(force));
            worst = std::max(worst, static_cast<double>(fabsq(Quad(state.angle) - truth.angle)) / angle_size);
            worst = std::max(worst, static_cast<double>(fabsq(Quad(state.angle_rate) - truth.rate)) / rate_size);
            CHECK(state.angle >= motion.least_angle() - 1e-12);
            CHECK(state.angle <= motion.greatest_angle() + 1e-12);
        }
    }
    return worst;
}

struct Case {
    const char* name;
    Governor given;
    GovernorRegime regime;
};

}  // namespace

TEST_CASE("§7: every regime satisfies the equation of motion", "[analytic]") {
    const Case cases[] = {
        {"dn", {5, 1, 9.81, 1.4, 0}, GovernorRegime::aside},
        {"dn, moving, the other side", {5, 1, 9.81, -1.2, 0.3}, GovernorRegime::aside},
        {"cn, fast axis", {5, 1, 9.81, 2.2, 0.5}, GovernorRegime::through},
        {"cn, slow axis", {1, 1, 9.81, 0.3, -0.2}, GovernorRegime::through},
        {"plain pendulum", {0, 2, 9.81, 2.9, 0}, GovernorRegime::through},
        {"plain pendulum, round", {0, 2, 9.81, 0.1, -6}, GovernorRegime::revolutions},
        {"tn", {5, 1, 9.81, 0.2, 9}, GovernorRegime::revolutions},
        {"gravity reversed: nc", {2, 1, -9.81, 2.5, 0}, GovernorRegime::through},
        {"gravity reversed: dn about the side", {5, 1, -9.81, 1.9, 0.1}, GovernorRegime::aside},
        {"no gravity, about the horizontal", {5, 1, 0, 1.3, 0}, GovernorRegime::aside},
        {"no gravity, round", {5, 1, 0, 1.3, -8}, GovernorRegime::revolutions},
        {"axial inertia", {5, 1, 9.81, 1.4, 0.2, 0.3}, GovernorRegime::aside},
        {"many turns ago", {5, 1, 9.81, 40, 3}, GovernorRegime::through},
        {"units far away", {5e8, 1e-16, 9.81e0, 1e-3, 1e5}, GovernorRegime::aside},
    };
    for (const Case& c : cases) {
        CAPTURE(c.name);
        const GovernorMotion motion(c.given);
        CHECK(motion.regime() == c.regime);
        CHECK(worst_error(c.given, 3 * motion.period()) <= 1e-13);
    }
}

TEST_CASE("§7: next to the separatrices", "[analytic]") {
    // Next to rest at the bottom and at the top, from both sides: e or f is all that is left of numbers of order 1.
    for (const double small : {1e-2, 1e-5, 1e-8}) {
        CAPTURE(small);
        const Governor bottom{5, 1, 9.81, small, 0}, through{5, 1, 9.81, 0, small},
            top{0, 1, 9.81, 0, std::sqrt(4 * 9.81) + small};
        for (const Governor& given : {bottom, through, top}) {
            const GovernorMotion motion(given);
            // At the top f is the small difference of two numbers of some 40, each rounded.
            const double lost = given.angular_speed == 0 ? 80 * 2e-16 / motion.energy_at_top() : 0;
            CHECK(worst_error(given, motion.period()) <= 1e-13 + lost);
        }
    }
}

TEST_CASE("§7 (8), (11): motions that take for ever", "[analytic]") {
    // Started where sech has them; the energy at the bottom is rounding and shows in the end.
    const GovernorMotion none({3, 1, 0, 0.5, 3 * std::sin(0.5)});
    CHECK(none.regime() == GovernorRegime::asymptotic);
    CHECK(none(1e3).angle == Approx(M_PI));
    CHECK(std::abs(none(-1e3).angle) < 1e-100);
    CHECK(none(0.4).angle == Approx(2 * std::atan(std::tan(0.25) * std::exp(1.2))).epsilon(1e-15));
    const GovernorMotion sinh_motion({4, 0.5, 8, 0, 8});  // theta'^2 = 4 g/l at the bottom: just to the top
    CHECK(sinh_motion.regime() == GovernorRegime::asymptotic);
    CHECK(sinh_motion.energy_at_top() == 0);
    for (const double t : {-2.0, -0.1, 0.3, 1.7}) {
        const double c = 8 / (16 * 0.5),
                     m = 4 * std::sqrt(1 + c);  // C = sqrt(lambda/(l + lambda)), m = n sqrt(1 + lambda/l)
        CHECK(sinh_motion(t).angle == Approx(2 * std::atan(std::sqrt(c / (1 + c)) * std::sinh(m * t))).epsilon(1e-14));
    }
}

TEST_CASE("§7 (3): rest and relative equilibrium", "[analytic]") {
    for (const Governor& given :
         {Governor{5, 1, 9.81, 0, 0}, Governor{0, 1, 9.81, 0, 0}, Governor{3, 1, 0, 0, 0}, Governor{0, 1, 0, 1, 0}}) {
        const GovernorMotion motion(given);
        CHECK(motion.regime() == GovernorRegime::rest);
        CHECK(motion(12.0).angle == given.angle);
        CHECK(motion(12.0).angle_rate == 0);
    }
    const double delta = std::acos(9.81 / 25);
    const GovernorMotion motion({5, 1, 9.81, delta, 0});
    CHECK(std::abs(motion(100.0).angle - delta) <= 1e-15 * 500);
}

TEST_CASE("§7 (4)-(10): what the paper gives of dn and cn", "[analytic]") {
    const double n = 5, l = 1, g = 9.81, c = g / (n * n * l);
    const GovernorMotion aside({n, l, g, 1.5, 0});
    const double alpha = aside.greatest_angle(), beta = aside.least_angle();
    CHECK(alpha == Approx(1.5).epsilon(1e-15));
    CHECK((std::cos(alpha) + std::cos(beta)) / 2 == Approx(c).epsilon(1e-15));  // (3)
    CHECK(aside.modulus().complementary_modulus() ==
          Approx(std::tan(beta / 2) / std::tan(alpha / 2)).epsilon(1e-14));  // (5)
    const double m = n * std::sin(alpha / 2) * std::cos(beta / 2);
    CHECK(aside.period() == Approx(2 * revchain::analytic::complete_integrals(aside.modulus()).K / m).epsilon(1e-14));
    const GovernorMotion through({n, l, g, 2.3, 0});
    const double k2 = through.modulus().modulus() * through.modulus().modulus(), lambda = c * l;
    CHECK(k2 == Approx(std::pow(std::sin(1.15), 2) * (2 * lambda + l * (1 - std::cos(2.3))) /
                       (2 * (lambda - l * std::cos(2.3))))
                    .epsilon(1e-14));  // (10)
    CHECK(through.least_angle() == Approx(-2.3).epsilon(1e-15));
    // (7), whose period is half of the one printed: near relative equilibrium.
    const double delta = std::acos(c);
    CHECK(GovernorMotion({n, l, g, delta + 1e-5, 0}).period() ==
          Approx(2 * M_PI / (n * std::sin(delta))).epsilon(1e-9));
    CHECK_THROWS_AS(GovernorMotion({n, -1, g, 0, 0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(GovernorMotion({n, 1, g, std::nan(""), 0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(GovernorMotion({n, 1, g, 0, 0, 1.5}), revchain::InvalidArgument);
    CHECK_THROWS_AS(aside(std::numeric_limits<double>::infinity()), revchain::InvalidArgument);
}

TEST_CASE("§7: random starts", "[analytic]") {
    support::Random random(3);
    double worst = 0;
    for (int i = 0; i < support::by_tier(60, 300); ++i) {
        Governor given{random.between(0, 6), random.between(0.2, 3), random.between(-20, 20), random.between(-3.1, 3.1),
                       0};
        if (i % 3) given.angle_rate = random.between(-10, 10);
        CAPTURE(given.angular_speed, given.pendulum_length, given.gravity, given.angle, given.angle_rate);
        worst = std::max(worst, worst_error(given, 3.0));
        REQUIRE(worst <= 2e-13);
    }
}

TEST_CASE("a governor of about the conical height starts where it was put", "[analytic]") {
    support::Random random(77);
    for (int i = 0; i < 600; ++i) {
        const double n = random.log_between(0.1, 10.0), gravity = 9.80665;
        const double off = i % 3 == 0 ? 0.0 : random.log_between(1e-16, 1e-2) * (i % 2 == 0 ? 1 : -1);
        const Governor given{.angular_speed = n,
                             .pendulum_length = gravity / (n * n) * (1 + off),
                             .gravity = gravity,
                             .angle = random.log_between(1e-8, 1.0),
                             .angle_rate = i % 4 == 0 ? 0 : n * random.log_between(1e-12, 1e-3)};
        const GovernorMotion motion(given);
        CAPTURE(n, off, given.angle, given.angle_rate);
        CHECK(std::abs(motion(0).angle - given.angle) <= 1e-14 * std::min(motion.greatest_angle(), 7.0));
        CHECK(std::abs(motion(0).angle_rate - given.angle_rate) <= 1e-14 * (given.angle_rate + n * given.angle));
        CHECK(motion.least_angle() <= given.angle * (1 + 1e-14));
        CHECK(motion.greatest_angle() >= given.angle * (1 - 1e-14));
    }
}
