// SPDX-License-Identifier: GPL-3.0-or-later
#include "revchain/rope.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::analytic::SkippingRope;
using revchain::analytic::TortuousGiven;
using revchain::analytic::TortuousPoint;
using revchain::analytic::TortuousRope;
using support::Quad;

namespace {

const Quad pi = 4 * atanq(Quad(1));

double relative(double value, Quad exact) { return static_cast<double>(fabsq(Quad(value) / exact - 1)); }

/// The balance of forces  d(T dr/ds)/ds = -r/lambda  in space, by Runge and Kutta's method in quadruple precision.
struct Integrated {
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
        Integrated truth{lambda, h, 0, first, 0, 0, 0, h * first * rope.at(0).angle_slope};
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
