// SPDX-License-Identifier: GPL-3.0-or-later
#include "revchain/rope.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::analytic::RopeGiven;
using revchain::analytic::RopePoint;
using revchain::analytic::SkippingRope;
using revchain::analytic::TortuousPoint;
using revchain::analytic::TortuousRope;
using support::Quad;

namespace {

/// The balance of forces  lambda h d(tan psi) = -y ds, from a node, by Runge and Kutta's method in quadruple precision.
struct Integrated {
    Quad strength;  // lambda h
    Quad x = 0, y = 0, slope, arc = 0;

    void go_to(Quad end, int steps) {
        const Quad d = (end - x) / steps;
        const auto bend = [&](Quad offset, Quad tangent) { return -offset * sqrtq(1 + tangent * tangent) / strength; };
        for (int i = 0; i < steps; ++i) {
            const Quad k1 = slope, m1 = bend(y, slope), k2 = slope + d / 2 * m1, m2 = bend(y + d / 2 * k1, k2);
            const Quad k3 = slope + d / 2 * m2, m3 = bend(y + d / 2 * k2, k3), k4 = slope + d * m3,
                       m4 = bend(y + d * k3, k4);
            arc += d / 6 * (sqrtq(1 + k1 * k1) + 2 * (sqrtq(1 + k2 * k2) + sqrtq(1 + k3 * k3)) + sqrtq(1 + k4 * k4));
            y += d / 6 * (k1 + 2 * (k2 + k3) + k4);
            slope += d / 6 * (m1 + 2 * (m2 + m3) + m4);
        }
        x = end;
    }
};

double relative(double value, Quad exact) { return static_cast<double>(fabsq(Quad(value) / exact - 1)); }
double relative(double value, double exact) { return value == exact ? 0 : std::abs(value / exact - 1); }

}  // namespace

TEST_CASE("§5 (1): the skipping rope balances its forces", "[analytic]") {
    for (const double sag : {1e-6, 0.1, 1.0, 3.0}) {
        const SkippingRope rope({.span = 2, .sag = sag});
        Integrated truth{Quad(rope.height_times_tension()), 0, 0, Quad(rope.slope_at_ends()), 0};
        for (const double x : {0.1, 0.45, 1.0}) {
            truth.go_to(x, 20000);
            const RopePoint point = rope.at(x);
            CAPTURE(sag, x);
            CHECK(relative(point.offset, truth.y) <= 3e-13);
            CHECK(relative(point.arc, truth.arc) <= 3e-13);
            CHECK(std::abs(point.slope - static_cast<double>(truth.slope)) <= 2e-12 * rope.slope_at_ends());
            // T / (w h) = ds/dx: the tension's part along the axis is the same everywhere.
            CHECK(relative(point.tension_ratio, std::sqrt(1 + point.slope * point.slope)) <= 2e-15);
        }
        CHECK(relative(rope.at(1.0).offset, sag) <= 1e-15);
        CHECK(relative(2 * rope.at(1.0).arc, rope.length()) <= 1e-15);
    }
}

TEST_CASE("§5: any two of span, length, slack, sag and speed with tension find the rest", "[analytic]") {
    support::Random random(5);
    for (int i = 0; i < 400; ++i) {
        const double span = std::pow(10, random.between(-6, 6)), ratio = std::pow(10, random.between(-6, 6));
        const revchain::Index waves = 1 + i % 3;
        const SkippingRope rope({.span = span, .sag = span * ratio, .angular_speed = 3, .half_waves = waves});
        CAPTURE(span, ratio, waves);
        const auto same = [&](const RopeGiven& given) {
            const SkippingRope other(given);
            // Judged in what was given.
            if (given.span) CHECK(relative(other.span(), *given.span) <= 1e-14);
            if (given.length) CHECK(relative(other.length(), *given.length) <= 1e-14);
            if (given.slack) CHECK(relative(other.slack(), *given.slack) <= 1e-14);
            if (given.sag) CHECK(relative(other.sag(), *given.sag) <= 1e-14);
            if (given.tension && given.angular_speed)
                CHECK(relative(other.tension_in_the_middle(), *given.tension) <= 1e-13);
            return other;
        };
        const double h = rope.tension_in_the_middle();
        same({.span = rope.span(), .slack = rope.slack(), .half_waves = waves});
        same({.span = rope.span(), .sag = rope.sag(), .half_waves = waves});
        same({.slack = rope.slack(), .sag = rope.sag(), .half_waves = waves});
        same({.slack = rope.slack(), .angular_speed = 3, .tension = h, .half_waves = waves});
        same({.sag = rope.sag(), .angular_speed = 3, .tension = h, .half_waves = waves});
        // One of the two that the rope's form does not need gives the other.
        const auto twin = same({.span = rope.span(), .sag = rope.sag(), .tension = h, .half_waves = waves});
        CHECK(relative(twin.angular_speed(), 3.0) <= 1e-13);
        if (rope.slack() > 1e-3 * rope.span()) {
            same({.span = rope.span(), .length = rope.length(), .half_waves = waves});
            same({.span = rope.span(), .angular_speed = 3, .tension = h, .half_waves = waves});
            same({.length = rope.length(), .angular_speed = 3, .tension = h, .half_waves = waves});
            const auto by_arc = rope.at_arc(0.3 * rope.length());
            CHECK(relative(rope.at(by_arc.x).arc, by_arc.arc) <= 1e-12 * (1 + rope.slope_at_ends()));
        }
    }
}

TEST_CASE("§5: slack so small that length and span agree", "[analytic]") {
    for (const double slack : {1e-24, 1e-16, 1e-10}) {
        const SkippingRope rope({.span = 1, .slack = slack});
        CHECK(relative(rope.slack(), slack) <= 1e-14);
        CHECK(relative(rope.sag(), std::sqrt(slack) * 2 / M_PI) <= 1e-9);         // b^2 pi^2 / (4 span) = slack
        CHECK(relative(rope.height_times_tension(), 1 / (M_PI * M_PI)) <= 1e-9);  // (3): lambda h = span^2 / pi^2
        CHECK(relative(rope.moment_of_inertia(), 2 * slack / (M_PI * M_PI)) <= 1e-9);
    }
}

TEST_CASE("§5: the rope drawn out keeps its angular momentum", "[analytic]") {
    const SkippingRope first({.span = 0.25, .length = 2, .angular_speed = 1});
    const double expected[][2] = {{0.5, 1.0321},  {1, 1.2276},      {1.5, 1.9838},
                                  {1.75, 3.5904}, {1.9375, 13.361}, {2 - 1.0 / 512, 417.92}};
    for (const auto& [span, speed] : expected) {
        const SkippingRope drawn = first.drawn_to(span);
        CAPTURE(span);
        CHECK(relative(drawn.angular_speed(), speed) <= 5e-5);  // as printed: five digits
        CHECK(relative(drawn.length(), 2.0) <= 1e-15);
        CHECK(relative(drawn.moment_of_inertia() * drawn.angular_speed(), first.moment_of_inertia()) <= 1e-14);
        // Work: d(J^2 / 2 I) / d span = h g, with mass for weight.
        const double step = 1e-4 * (2 - span);
        const auto energy = [&](double s) {
            const SkippingRope at = first.drawn_to(s);
            return 0.5 * at.moment_of_inertia() * at.angular_speed() * at.angular_speed();
        };
        const double pull = (energy(span + step) - energy(span - step)) / (2 * step);
        CHECK(relative(pull, drawn.tension_in_the_middle() * 9.80665) <= 1e-6);
    }
}

TEST_CASE("§5: of all ropes of a length the one that whirls has the largest moment of inertia", "[analytic]") {
    // The paper's remark. Offsets of a polygon, moved at random and brought back to the length and the span.
    const SkippingRope rope({.span = 1, .length = 1.6});
    constexpr int links = 400;
    std::vector<double> angle(links);
    const double piece = rope.length() / links;
    for (int i = 0; i < links; ++i)
        angle[static_cast<std::size_t>(i)] = std::atan(rope.at_arc((i + 0.5) * piece).slope);
    const auto inertia = [&](const std::vector<double>& a, double& span, double& end) {
        double y = 0, sum = 0;
        span = 0;
        for (const double v : a) {
            const double dy = piece * std::sin(v);
            sum += piece * (y * y + y * dy + dy * dy / 3);
            y += dy, span += piece * std::cos(v);
        }
        end = y;
        return sum;
    };
    double span, end;
    const double best = inertia(angle, span, end);
    CHECK(relative(best, rope.moment_of_inertia()) <= 2e-4);
    support::Random random(11);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> moved = angle;
        const double size = 0.05, wave = 1 + trial % 7, phase = random.between(0, 6.28);
        for (int i = 0; i < links; ++i)
            moved[static_cast<std::size_t>(i)] += size * std::sin(wave * M_PI * i / links + phase);
        // Back to the ends by two smooth corrections.
        for (int round = 0; round < 50; ++round) {
            inertia(moved, span, end);
            double ss = 0, sc = 0, cc = 0;
            for (const double v : moved)
                ss += std::sin(v) * std::sin(v), sc += std::sin(v) * std::cos(v), cc += std::cos(v) * std::cos(v);
            const double off_span = (rope.span() - span) / piece, off_end = -end / piece, det = ss * cc - sc * sc;
            // d span = -sin, d end = cos: least change that mends both
            const double p = (off_span * cc + off_end * sc) / det, q = (off_end * ss + off_span * sc) / det;
            for (double& v : moved) v += -p * std::sin(v) + q * std::cos(v);
        }
        const double other = inertia(moved, span, end);
        REQUIRE(std::abs(span - rope.span()) <= 1e-9);
        REQUIRE(std::abs(end) <= 1e-9);
        CHECK(other < best);
    }
}

TEST_CASE("§5: what no rope does is refused", "[analytic]") {
    CHECK_THROWS_AS(SkippingRope({.span = 1}), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 1, .length = 2, .sag = 0.5}), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 1, .length = 1}), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 1, .length = 0.5}), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.length = 1, .sag = 0.5}), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 1, .sag = -0.5}), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 10, .angular_speed = 1, .tension = 1e-3}), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 1, .tension = 1}), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 1, .sag = 0.5, .angular_speed = 1, .tension = 1}), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 1, .sag = 0.5}).angular_speed(), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 1, .sag = 0.5, .half_waves = 0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 1, .sag = 0.5}).at(1.1), revchain::InvalidArgument);
    CHECK_THROWS_AS(SkippingRope({.span = 1, .sag = 0.5}).at_arc(-1), revchain::InvalidArgument);
}

namespace {

const Quad pi = 4 * atanq(Quad(1));

/// The balance of forces  d(T dr/ds)/ds = -r/lambda  in space, by Runge and Kutta's method in quadruple precision.
struct IntegratedInSpace {
    Quad height, pull;  // lambda, h
    Quad x = 0, y, z = 0, arc = 0, force_y = 0, force_z;

    void go_to(Quad end, int steps) {
        struct Rates {
            Quad y, z, force_y, force_z, arc;
        };
        const auto rates = [&](Quad at_y, Quad at_z, Quad fy, Quad fz) {
            const Quad stretch = sqrtq(1 + (fy / pull) * (fy / pull) + (fz / pull) * (fz / pull));  // ds/dx
            return Rates{fy / pull, fz / pull, -at_y / height * stretch, -at_z / height * stretch, stretch};
        };
        const Quad d = (end - x) / steps;
        for (int i = 0; i < steps; ++i) {
            const Rates a = rates(y, z, force_y, force_z);
            const auto on = [&](const Rates& r, Quad t) {
                return rates(y + t * r.y, z + t * r.z, force_y + t * r.force_y, force_z + t * r.force_z);
            };
            const Rates b = on(a, d / 2), c = on(b, d / 2), e = on(c, d);
            y += d / 6 * (a.y + 2 * (b.y + c.y) + e.y), z += d / 6 * (a.z + 2 * (b.z + c.z) + e.z);
            force_y += d / 6 * (a.force_y + 2 * (b.force_y + c.force_y) + e.force_y);
            force_z += d / 6 * (a.force_z + 2 * (b.force_z + c.force_z) + e.force_z);
            arc += d / 6 * (a.arc + 2 * (b.arc + c.arc) + e.arc);
        }
        x = end;
    }
};

}  // namespace

TEST_CASE("§5 text: the tortuous rope balances its forces", "[analytic]") {
    support::Random random(55);
    double worst = 0;
    for (int i = 0; i < 12; ++i) {
        const double second = random.log_between(0.1, 10.0), first = second * random.log_between(1e-3, 1.0);
        const TortuousRope rope({.least_radius = first,
                                 .greatest_radius = second,
                                 .angular_speed = 3.0,
                                 .tension = random.log_between(0.1, 10.0)});
        const Quad lambda = rope.conical_height(), h = Quad(rope.height_times_tension()) / lambda;
        IntegratedInSpace truth{lambda, h, 0, first, 0, 0, 0, h * first * rope.at(0).angle_slope};
        for (const double share : {0.2, 0.5, 1.0, 1.7}) {
            const double x = share * rope.half_wave();
            truth.go_to(x, 20000);
            const TortuousPoint point = rope.at(x);
            const Quad radius = hypotq(truth.y, truth.z), angle = atan2q(truth.z, truth.y);
            const Quad turns = nearbyintq((point.angle - angle) / (2 * pi));
            CAPTURE(first, second, share);
            worst = std::max({worst, relative(point.radius, radius), relative(point.arc, truth.arc),
                              static_cast<double>(fabsq(point.angle - angle - 2 * pi * turns))});
            CHECK(turns <= share + 0.5);
            CHECK(relative(point.tension_ratio, sqrtq(1 + (truth.force_y / h) * (truth.force_y / h) +
                                                      (truth.force_z / h) * (truth.force_z / h))) <= 1e-12);
            const Quad slope = (truth.y * truth.force_y + truth.z * truth.force_z) / (radius * h);
            CHECK(std::abs(point.radius_slope - static_cast<double>(slope)) <= 1e-12 * (1 + point.tension_ratio));
            const Quad twist = (truth.y * truth.force_z - truth.z * truth.force_y) / (radius * radius * h);
            CHECK(relative(point.angle_slope, twist) <= 1e-12);
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 1e-12);
}

TEST_CASE("§5 text: the tortuous rope between plane rope and helix", "[analytic]") {
    support::Random random(56);
    for (int i = 0; i < 200; ++i) {
        const double b = random.log_between(1e-6, 1e6), n = random.log_between(0.1, 10.0);
        const double h = random.log_between(1e-3, 1e3) * b;
        // plane: the skipping rope from node to node
        const TortuousRope plane({.least_radius = 0, .greatest_radius = b, .angular_speed = n, .tension = h});
        const SkippingRope skipping({.sag = b, .angular_speed = n, .tension = h});
        CAPTURE(b, n, h);
        CHECK(relative(plane.half_wave(), skipping.span()) <= 2e-13);
        CHECK(relative(plane.half_wave_length(), skipping.length()) <= 2e-13);
        CHECK(plane.half_wave_angle() == std::numbers::pi);
        const double x = random.between(0.01, 0.99) * plane.half_wave();
        CHECK(relative(plane.at(x).radius, skipping.at(std::min(x, skipping.span())).offset) <= 1e-11);
        CHECK(relative(plane.at(x).tension_ratio, skipping.at(std::min(x, skipping.span())).tension_ratio) <= 1e-12);
        CHECK(plane.at(x).angle == std::numbers::pi / 2);
        CHECK(plane.at(-x).angle == -std::numbers::pi / 2);
        // all but plane: half a turn at each passage of the axis
        const double least = 1e-12 * std::min(b, plane.height_times_tension() / b);
        const TortuousRope near_plane({.least_radius = least, .greatest_radius = b, .angular_speed = n, .tension = h});
        CHECK(relative(near_plane.half_wave_angle(), Quad(std::numbers::pi)) <= 1e-9);
        CHECK(relative(near_plane.half_wave(), plane.half_wave()) <= 1e-14);
        // helix: T theta'^2 = w/lambda along the rope, all of it at one distance
        const TortuousRope helix({.least_radius = b, .greatest_radius = b, .angular_speed = n, .tension = h});
        const auto point = helix.at(0.7 * helix.half_wave());
        CHECK(relative(point.radius, Quad(b)) <= 1e-15);
        CHECK(std::abs(point.radius_slope) == 0);
        const Quad twist = Quad(point.angle_slope) / point.tension_ratio;  // per length of rope, ds/dx = T/(w h)
        CHECK(relative(static_cast<double>(point.tension_ratio * Quad(h) * twist * twist),
                       1 / Quad(helix.conical_height())) <= 1e-14);
        CHECK(relative(point.angle, Quad(point.angle_slope) * point.x) <= 1e-14);
        // ds^2 = dx^2 (1 + (radius angle')^2)
        CHECK(relative(point.tension_ratio, sqrtq(1 + Quad(b) * b * point.angle_slope * point.angle_slope)) <= 1e-14);
        CHECK(relative(point.arc, Quad(point.tension_ratio) * point.x) <= 1e-14);
    }
}

TEST_CASE("The tortuous rope: half waves repeat, slopes are consistent, wrong calls are refused", "[analytic]") {
    support::Random random(57);
    for (int i = 0; i < 200; ++i) {
        const double second = random.log_between(1e-3, 1e3), first = second * random.log_between(1e-8, 1.0);
        const TortuousRope rope({.least_radius = first,
                                 .greatest_radius = second,
                                 .angular_speed = random.log_between(0.1, 10.0),
                                 .tension = random.log_between(1e-3, 1e3)});
        const double x = random.between(0.05, 0.95) * rope.half_wave();
        const auto here = rope.at(x), there = rope.at(x + rope.half_wave()), back = rope.at(-x);
        CAPTURE(first, second, x);
        CHECK(relative(there.radius, Quad(here.radius)) <= 1e-11);
        CHECK(relative(there.angle, Quad(here.angle) + rope.half_wave_angle()) <= 1e-12);
        CHECK(relative(there.arc, Quad(here.arc) + rope.half_wave_length()) <= 1e-12);
        CHECK(back.angle == -here.angle);
        CHECK(back.arc == -here.arc);
        CHECK(here.radius >= first * (1 - 1e-15));
        CHECK(here.radius <= second * (1 + 1e-15));
        // (ds/dx)^2 = 1 + radius'^2 + (radius angle')^2 = tension^2
        const Quad twist = Quad(here.radius) * here.angle_slope;
        CHECK(relative(here.tension_ratio, sqrtq(1 + Quad(here.radius_slope) * here.radius_slope + twist * twist)) <=
              1e-13);
    }
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double bad : {-1.0, nan, inf}) {
        CHECK_THROWS_AS(TortuousRope({bad, 1, 1, 1}), revchain::InvalidArgument);
        CHECK_THROWS_AS(TortuousRope({0, bad, 1, 1}), revchain::InvalidArgument);
        CHECK_THROWS_AS(TortuousRope({0, 1, bad, 1}), revchain::InvalidArgument);
        CHECK_THROWS_AS(TortuousRope({0, 1, 1, bad}), revchain::InvalidArgument);
    }
    CHECK_THROWS_AS(TortuousRope({2, 1, 1, 1}), revchain::InvalidArgument);
    CHECK_THROWS_AS(TortuousRope({1, 1, 1e146, 1e-18}), revchain::InvalidArgument);      // c^2 below the normal numbers
    CHECK_THROWS_AS(TortuousRope({1, 1e100, 1e60, 1e-100}), revchain::InvalidArgument);  // slopes beyond double
    CHECK_THROWS_AS(TortuousRope({0, 1, 1, 1}).at(nan), revchain::InvalidArgument);
}
