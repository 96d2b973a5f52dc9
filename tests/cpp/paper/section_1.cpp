// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §1: one plummet, the conical pendulum.
#include <cmath>

#include "paper.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/count.hpp"

namespace pendulum = revchain::conical_pendulum;
using paper::error_in_ulp;
using paper::Quad;

TEMPLATE_TEST_CASE("§1 (1), (2): lambda = g/n^2 = g T^2/(4 pi^2), T = 2 pi sqrt(lambda/g)", "[paper][section_1]", float,
                   double, long double) {
    using T = TestType;
    const T g = T(9.80665);
    const Quad pi = 4 * atanq(Quad(1));
    paper::Random random(101);
    double height = 0, period = 0, same = 0;
    for (int i = 0; i < 1000; ++i) {
        const T n = static_cast<T>(random.log_between(0.01, 100.0));
        const T lambda = pendulum::height(n, g);
        height = std::max(height, error_in_ulp(lambda, Quad(g) / (Quad(n) * Quad(n))));
        const T seconds = pendulum::period(lambda, g);
        period = std::max(period, error_in_ulp(seconds, 2 * pi * sqrtq(Quad(lambda) / Quad(g))));
        same = std::max(same, error_in_ulp(pendulum::height_from_period(seconds, g), Quad(lambda)));
    }
    CAPTURE(height, period, same);
    CHECK(height <= 0.9);  // measured 0.84: two divisions
    CHECK(period <= 1.6);  // measured 1.43: two roots, a quotient, a product, pi
    CHECK(same <= 4.0);    // measured 3.6: twice the period's error and the function's own
}

TEMPLATE_TEST_CASE("§1 (3): at a small inclination lambda is the length l, T = 2 pi sqrt(l/g)", "[paper][section_1]",
                   float, double, long double) {
    using T = TestType;
    const Quad pi = 4 * atanq(Quad(1));
    for (const T l : {T(1), T(0.1), T(39.1396), T(3e-20), T(7e20)}) {
        const revchain::Chain<T> chain({revchain::plummet<T>(T(2.5), l)});
        const auto m = revchain::modes(chain, {.count = revchain::all_modes});
        paper::check_heights(m, {Quad(l)});
        CHECK(m.conical_height[0] == l);
        CHECK(error_in_ulp(m.period()[0], 2 * pi * sqrtq(Quad(l) / Quad(T(pendulum::standard_gravity)))) <= 2.0);
        // "it cannot leave the vertical till lambda < l" (said of the link in §6, true of the plummet)
        CHECK(revchain::count_modes(chain, {.conical_height = T(1.0001) * l}) == 0);
        CHECK(revchain::count_modes(chain, {.conical_height = T(0.9999) * l}) == 1);
    }
}

TEMPLATE_TEST_CASE("§1 (4)-(6): g from the seconds pendulum of 39.1396 inches", "[paper][section_1]", float, double,
                   long double) {
    using T = TestType;
    const T L = T(39.1396L);                                                 // inches, (5)
    const Quad truth = strtoflt128("386.29236841687706059773444", nullptr);  // pi^2 39.1396
    const T g = pendulum::gravity_from_seconds_pendulum(L);
    CHECK(error_in_ulp(g, truth) <= 2.0);                           // measured 1.1 (39.1396 is rounded too)
    CHECK(error_in_ulp(pendulum::gravity(L, T(2)), truth) <= 2.5);  // (4) with T = 2; measured 1.7
    CHECK(std::round(g * T(100)) == T(38629));                      // erratum: 386.28 is printed
    CHECK(std::abs(g - T(386.28)) > T(0.01));
    CHECK(std::round(g / T(12) * T(100)) == T(3219));  // 32.19 feet per second, per second (printed ft./sec.)
}

TEMPLATE_TEST_CASE("§1 (7): lambda = L T^2/4, T = 2 sqrt(lambda/L), without g or pi", "[paper][section_1]", float,
                   double, long double) {
    using T = TestType;
    const T L = T(39.1396L);
    CHECK(pendulum::height_from_seconds_pendulum(L, T(2)) == L);
    CHECK(pendulum::height_from_seconds_pendulum(L, T(1)) == L / T(4));
    double there = 0, back = 0;
    paper::Random random(107);
    for (int i = 0; i < 1000; ++i) {
        const T seconds = static_cast<T>(random.log_between(0.01, 100.0));
        const T lambda = pendulum::height_from_seconds_pendulum(L, seconds);
        there = std::max(there, error_in_ulp(lambda, Quad(L) * Quad(seconds) * Quad(seconds) / 4));
        // The same by way of g
        back = std::max(back, error_in_ulp(pendulum::period(lambda, pendulum::gravity_from_seconds_pendulum(L)),
                                           2 * sqrtq(Quad(lambda) / Quad(L))));
    }
    CAPTURE(there, back);
    CHECK(there <= 0.9);  // measured 0.86
    CHECK(back <= 1.6);   // measured 1.49
}

TEMPLATE_TEST_CASE("§1: a plummet at any inclination, cos d = lambda/l, weight to centrifugal force as lambda to y",
                   "[paper][section_1]", float, double, long double) {
    using T = TestType;
    paper::Random random(108);
    double worst = 0;
    for (int i = 0; i < 4000; ++i) {
        const T l = static_cast<T>(random.log_between(1e-12, 1e12));
        // from nearly vertical to nearly horizontal
        const T height = i % 2 == 0 ? static_cast<T>(l * random.log_between(1e-12, 1.0))
                                    : static_cast<T>(l * (1 - random.log_between(1e-7, 1.0)));
        const auto found = revchain::inclined_pendulum(l, height);
        if (!(height < l)) continue;
        const Quad L = l, H = height, radius = sqrtq((L - H) * (L + H));
        worst = std::max({worst, error_in_ulp(found.radius, radius), error_in_ulp(found.tension, L / H),
                          error_in_ulp(found.inclination, atan2q(radius, H))});
        CHECK(found.depth == height);
    }
    CAPTURE(worst);
    CHECK(worst <= 1.6);
    for (const T height : {T(1), T(1.5), T(1e30)}) {  // it does not leave the vertical
        const auto found = revchain::inclined_pendulum(T(1), height);
        CHECK(found.inclination == 0);
        CHECK(found.radius == 0);
        CHECK(found.depth == 1);
        CHECK(found.tension == 1);
    }
}

TEMPLATE_TEST_CASE("§1: a plummet held by a second thread, forces balanced", "[paper][section_1]", float, double,
                   long double) {
    using T = TestType;
    paper::Random random(109);
    double places = 0, forces = 0;
    int slack = 0, slack_above = 0;
    for (int i = 0; i < 4000; ++i) {
        const T upper = static_cast<T>(random.log_between(0.01, 100.0));
        const T lower = static_cast<T>(upper * random.log_between(0.1, 10.0));
        const double least = std::abs(static_cast<double>(upper - lower)), most = static_cast<double>(upper + lower);
        const T distance = static_cast<T>(least + (most - least) * random.between(1e-3, 0.999));
        const T height = static_cast<T>(upper * random.log_between(0.01, 10.0));
        const auto found = revchain::held_plummet(upper, lower, distance, height);
        const Quad u = upper, v = lower, d = distance, h = height;
        Quad depth = (d * d + u * u - v * v) / (2 * d), radius = sqrtq((u - depth) * (u + depth));
        const bool lower_taut = depth > h, upper_taut = depth - d < h;
        if (!lower_taut) depth = std::min(h, u), radius = sqrtq((u - depth) * (u + depth));
        if (!upper_taut) depth = d + h, radius = sqrtq((v - h) * (v + h));
        places = std::max({places, error_in_ulp(found.radius, radius),
                           static_cast<double>(fabsq(found.depth - depth) / std::max(u, v)) /
                               static_cast<double>(revchain::epsilon<T>())});
        // Weight 1 downwards, radius/height outwards, threads along (-radius, depth), (-radius, depth - distance).
        const Quad t1 = found.upper_tension / u, t2 = found.lower_tension / v;
        const Quad across = radius / h - (t1 + t2) * radius, down = 1 - t1 * depth - t2 * (depth - d);
        const Quad size = fabsq(t1 * radius) + fabsq(t2 * radius) + radius / h,
                   height_size = 1 + fabsq(t1) * u + fabsq(t2) * v;
        forces = std::max(forces, static_cast<double>(std::max(fabsq(across) / size, fabsq(down) / height_size)) /
                                      static_cast<double>(revchain::epsilon<T>()));
        // "the lower thread is taut when the plummet would fly out farther": lambda < depth
        CHECK(found.lower_taut == lower_taut);
        CHECK(found.upper_taut == upper_taut);
        CHECK((found.lower_tension > 0) == lower_taut);
        CHECK((found.upper_tension > 0) == upper_taut);
        CHECK(radius * radius + depth * depth <= u * u * (1 + Quad(1e-30)));
        CHECK(radius * radius + (depth - d) * (depth - d) <= v * v * (1 + Quad(1e-30)));
        slack += !lower_taut, slack_above += !upper_taut;
    }
    CAPTURE(places, forces);
    CHECK(places <= 2.5);
    CHECK(forces <= 3.3);
    CHECK(slack > 100);
    CHECK(slack_above > 20);
    // distances and units at the ends of the range
    for (const int e : {0, std::numeric_limits<T>::max_exponent - 3, std::numeric_limits<T>::min_exponent + 3}) {
        const T unit = std::ldexp(T(1), e);
        const auto far = revchain::held_plummet(unit, unit, unit, unit),
                   near = revchain::held_plummet(T(1), T(1), T(1), T(1));
        CHECK(error_in_ulp(far.radius, Quad(near.radius) * unit) <= 2);
        CHECK(error_in_ulp(far.depth, Quad(near.depth) * unit) <= 2);
        CHECK(error_in_ulp(far.upper_tension, Quad(near.upper_tension)) <= 2);
    }
    const T least = std::numeric_limits<T>::denorm_min();
    CHECK(error_in_ulp(revchain::held_plummet(T(1), T(1), T(4) * least, least).radius, Quad(1)) <= 2);
    CHECK_THROWS_AS(revchain::held_plummet(T(1), T(1), T(2.5), T(1)), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::held_plummet(T(3), T(1), T(1), T(1)), revchain::InvalidArgument);
}

TEMPLATE_TEST_CASE("§1 (8): whirling machine, R/W = CA/CN: the pull lies along the thread", "[paper][section_1]", float,
                   double, long double) {
    using T = TestType;
    paper::Random random(110);
    for (int i = 0; i < 500; ++i) {
        const T arm = static_cast<T>(random.log_between(0.01, 10.0)),
                height = static_cast<T>(random.log_between(0.01, 10.0)),
                radius = static_cast<T>(random.log_between(0.01, 10.0));
        // On the plummet P = (y, 0, -lambda) act y/lambda outwards, R backwards and its weight, (y/lambda, -R, -1), against
        // the thread along A - P = (-y, arm, lambda): parallel where R = arm/lambda.
        CHECK(error_in_ulp(revchain::air_resistance(arm, height), Quad(arm) / height) <= 0.5);
        CHECK(error_in_ulp(revchain::whirling_thread(arm, height, radius),
                           sqrtq(Quad(arm) * arm + Quad(height) * height + Quad(radius) * radius)) <= 2);
    }
}

TEMPLATE_TEST_CASE("§1 (9): support carried round, lambda/(lambda - l), against it past the resonance",
                   "[paper][section_1]", float, double, long double) {
    using T = TestType;
    paper::Random random(111);
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        const T l = static_cast<T>(random.log_between(1e-6, 1e6)),
                height = static_cast<T>(l * random.log_between(1e-6, 1e6));
        worst = std::max(worst, error_in_ulp(revchain::carried_response(l, height), Quad(height) / (Quad(height) - l)));
        CHECK((revchain::carried_response(l, height) > 0) == (height > l));
    }
    CAPTURE(worst);
    CHECK(worst <= 1.0);
    CHECK(std::isinf(revchain::carried_response(T(2), T(2))));
}

TEMPLATE_TEST_CASE("§1: support carried round, any inclination: every root of lambda tan d = b + l sin d",
                   "[paper][section_1]", float, double, long double) {
    using T = TestType;
    paper::Random random(112);
    const double unit = static_cast<double>(revchain::epsilon<T>());
    double worst = 0;
    int three = 0;
    for (int i = 0; i < 3000; ++i) {
        const T l = static_cast<T>(random.log_between(1e-3, 1e3)),
                height = static_cast<T>(l * random.log_between(1e-3, 10.0)),
                b = static_cast<T>(l * random.log_between(1e-6, 10.0));
        const auto found = revchain::carried_inclinations(l, height, b);
        const Quad c = Quad(height) / l, r = Quad(b) / l;
        const auto f = [&](Quad d) { return c * tanq(d) - r - sinq(d); };
        // b^(2/3) < l^(2/3) - lambda^(2/3): the astroid of where two roots meet
        const double inside = 1 - std::cbrt(static_cast<double>(c * c)) - std::cbrt(static_cast<double>(r * r));
        if (std::abs(inside) > 1e3 * unit) CHECK(found.count == (inside > 0 ? 3 : 1));
        three += found.count == 3;
        for (int j = 0; j < found.count; ++j) {
            const Quad d = found.inclination[static_cast<std::size_t>(j)];
            if (j > 0)
                CHECK(found.inclination[static_cast<std::size_t>(j)] >=
                      found.inclination[static_cast<std::size_t>(j - 1)]);
            // error in d = f/f', what data rounded to T can explain: (c tan d + r + sin d) unit / f'
            const Quad slope = fabsq(c / (cosq(d) * cosq(d)) - cosq(d));
            const Quad size = c * fabsq(tanq(d)) + r + fabsq(sinq(d)) + slope * fabsq(d);
            worst = std::max(worst, static_cast<double>(fabsq(f(d)) / size) / unit);
        }
    }
    CAPTURE(worst, three);
    CHECK(worst <= 0.8);
    CHECK(three > 300);
}

TEMPLATE_TEST_CASE("§1: support carried round, next to resonance", "[paper][section_1]", float, double, long double) {
    using T = TestType;
    paper::Random random(113);
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        const T gap = static_cast<T>(random.log_between(1e-6, 1e-2)),
                r = static_cast<T>(random.log_between(1e-12, 1e-2));
        const T height = i % 3 == 0 ? T(1) : i % 3 == 1 ? T(1) + gap : T(1) - gap;
        const auto found = revchain::carried_inclinations(T(1), height, r);
        // the outer root in tan d: t (lambda - cos d) = r, by Newton's method from it
        Quad t = tanq(Quad(found.inclination[static_cast<std::size_t>(found.count - 1)]));
        for (int j = 0; j < 4; ++j) {
            const Quad c = 1 / sqrtq(1 + t * t);
            t -= (t * (height - c) - r) / (height - c * c * c);
        }
        worst = std::max(worst, error_in_ulp(found.inclination[static_cast<std::size_t>(found.count - 1)], atanq(t)));
    }
    CAPTURE(worst);
    CHECK(worst <= 1.8);
    CHECK_THROWS_AS(revchain::carried_inclinations(std::numeric_limits<T>::max(), T(0.25), T(0.1)),
                    revchain::InvalidArgument);
}

TEST_CASE("§1: what cannot be is refused with its value", "[paper][section_1]") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, nan, inf}) {
        CHECK_THROWS_AS(revchain::inclined_pendulum(bad, 1.0), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::inclined_pendulum(1.0, bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::carried_response(1.0, bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::carried_inclinations(1.0, 1.0, bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::held_plummet(1.0, 1.0, 1.0, bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::air_resistance(bad, 1.0), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::whirling_thread(1.0, 1.0, bad), revchain::InvalidArgument);
    }
    CHECK_THROWS_WITH(revchain::held_plummet(1.0, 1.0, 2.5, 1.0),
                      "revchain::held_plummet: distance must make a triangle with the two threads, got 2.5");
}
