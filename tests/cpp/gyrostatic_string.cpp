// SPDX-License-Identifier: MPL-2.0
// Against the balance of a pin between two links, each with the mass matrix of its body written from energies, in
// quadruple precision.
#include "revchain/gyrostatic_string.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

using revchain::GyrostaticString;
using revchain::InvalidArgument;
using revchain::link_phase;
using revchain::plane_rotation;
using revchain::wave_speeds;
using support::Quad;
using support::Random;

namespace {

using String = GyrostaticString<double>;

String random_string(Random& random) {
    const double a = random.log_between(1e-3, 1e3), weight = random.log_between(1e-3, 1e3);
    return {.weight = weight,
            .length = a,
            .tension = weight * random.log_between(1e-2, 1e4),
            .momentum = weight * a * random.between(-1, 1),
            .centroid = a * random.between(0, 1),
            .radius_of_gyration = a * random.between(0, 0.5)};
}

/// 4 sin^2(theta/2) of the balance  k (2 - 2 cos) = (n^2/g) (A + B + 2 X cos),  A, X, B from W (y^2 + rho^2 tilt^2).
Quad four_sines(const String& s, Quad n) {
    const Quad W = s.weight, a = s.length, h = s.centroid, rho = s.radius_of_gyration, w = n * n / Quad(s.gravity);
    const auto energy = [&](Quad lower, Quad upper) {
        const Quad tilt = (lower - upper) / a, y = upper + h * tilt;
        return W * (y * y + rho * rho * tilt * tilt);
    };
    const Quad A = energy(1, 0), B = energy(0, 1), X = (energy(1, 1) - A - B) / 2;
    const Quad k = (Quad(s.tension) + n * Quad(s.momentum) / a) / a;
    // with cos = 1 - q/2:  k q = w (A + B + 2 X - X q)
    return w * (A + B + 2 * X) / (k + w * X);
}

Quad exact_phase(const String& s, Quad n) { return 2 * asinq(sqrtq(four_sines(s, n)) / 2); }

}  // namespace

TEST_CASE("a circular wave's phase", "[gyrostatic_string]") {
    Random random(1);
    int passing = 0;
    double worst = 0;
    for (int round = 0; round < 3000; ++round) {
        const String s = random_string(random);
        const double n = (random() < 0.5 ? -1 : 1) * std::sqrt(s.gravity / s.length * random.log_between(1e-6, 1e3));
        const Quad q = four_sines(s, n);
        const auto found = link_phase(s, n);
        CAPTURE(round, n, static_cast<double>(q));
        if (q < 0) {
            CHECK(found.phase == 0);
            const Quad exact = 2 * asinhq(sqrtq(-q) / 2);
            if (static_cast<double>(-q) < 10)
                CHECK(std::abs(static_cast<double>(Quad(found.attenuation) / exact - 1)) < 1e-12);
        } else if (q > 4) {
            CHECK(found.phase == std::numbers::pi);
            const Quad exact = 2 * acoshq(sqrtq(q) / 2);
            if (static_cast<double>(q) > 4.001 && static_cast<double>(q) < 40)
                CHECK(std::abs(static_cast<double>(Quad(found.attenuation) / exact - 1)) < 1e-12);
        } else {
            ++passing;
            CHECK(found.attenuation == 0);
            const Quad a = s.length, w = Quad(n) * Quad(n) / Quad(s.gravity), p = Quad(s.centroid) / a,
                       r = Quad(s.radius_of_gyration) / a;
            const Quad terms = Quad(s.tension) / a + fabsq(Quad(n) * Quad(s.momentum)) / (a * a) +
                               w * Quad(s.weight) * (p * (1 - p) + r * r);
            const Quad cancelled = terms * q / (w * Quad(s.weight));
            const double error = static_cast<double>(fabsq(Quad(found.phase) / exact_phase(s, n) - 1));
            worst = std::max(worst, error * static_cast<double>(sqrtq(1 - q / 4) / cancelled) / 0x1p-52);
        }
    }
    CHECK(passing > 1000);
    CAPTURE(worst);
    CHECK(worst < 4);
}

TEST_CASE("a circular wave's speeds are those of its phase", "[gyrostatic_string]") {
    Random random(2);
    for (int round = 0; round < 1000; ++round) {
        const String s = random_string(random);
        const double theta = random.log_between(1e-6, 3.14);
        const auto [forward, backward] = wave_speeds(s, theta);
        CAPTURE(round, theta, forward, backward);
        CHECK(forward > 0);
        CHECK(backward < 0);
        const Quad wanted = 4 * sinq(Quad(theta) / 2) * sinq(Quad(theta) / 2);
        for (const double n : {forward, backward}) {
            const Quad n1 = n, slope = (four_sines(s, n1 * (1 + Quad(1e-12))) - four_sines(s, n1)) / Quad(1e-12);
            CHECK(std::abs(static_cast<double>((four_sines(s, n1) - wanted) / slope)) < 2e-15);
        }
        if (s.momentum > 0) CHECK(forward > -backward);
    }
}

TEST_CASE("the plane of a vibration turns, by however little", "[gyrostatic_string]") {
    Random random(3);
    int passing = 0;
    for (int round = 0; round < 3000; ++round) {
        String s = random_string(random);
        s.momentum *= random.log_between(1e-20, 1);
        const double n = std::sqrt(s.gravity / s.length * random.log_between(1e-4, 10));
        const Quad ahead = four_sines(s, n), back = four_sines(s, -Quad(n));
        const double turned = plane_rotation(s, n);
        CAPTURE(round, n, s.momentum, turned);
        if (!(ahead > 0 && ahead < 4 && back > 0 && back < 4)) {
            CHECK(std::isnan(turned));
            continue;
        }
        if (std::max(static_cast<double>(ahead), static_cast<double>(back)) > 3.9) continue;
        ++passing;
        // difference of the phases, where need be from its differential
        const Quad exact = (exact_phase(s, -Quad(n)) - exact_phase(s, n)) / 2;
        if (std::abs(s.momentum) > 1e-12 * s.weight * s.length) {
            CHECK(std::abs(static_cast<double>(Quad(turned) / exact - 1)) < 1e-13);
        }
        CHECK((turned > 0) == (s.momentum > 0));
    }
    CHECK(passing > 500);
}

TEST_CASE("a string that cannot be is refused", "[gyrostatic_string]") {
    const String good{.weight = 1, .length = 1, .tension = 10, .momentum = 0.1, .centroid = 0.5};
    for (double String::*number : {&String::weight, &String::length, &String::tension, &String::gravity}) {
        String bad = good;
        bad.*number = 0;
        CHECK_THROWS_AS(link_phase(bad, 1.0), InvalidArgument);
        CHECK_THROWS_AS(wave_speeds(bad, 1.0), InvalidArgument);
        CHECK_THROWS_AS(plane_rotation(bad, 1.0), InvalidArgument);
    }
    CHECK_THROWS_AS(link_phase(good, std::nan("")), InvalidArgument);
    CHECK_THROWS_AS(wave_speeds(good, 0.0), InvalidArgument);
    CHECK_THROWS_AS(wave_speeds(good, 3.2), InvalidArgument);
    CHECK_THROWS_AS(plane_rotation(good, -1.0), InvalidArgument);
}
