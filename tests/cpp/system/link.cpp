// SPDX-License-Identifier: MPL-2.0
#include "revchain/system/link.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::compound_pendulum;
using support::quad;
using support::Quad;

TEMPLATE_TEST_CASE("makers", "[chain]", float, double, long double) {
    using T = TestType;
    const auto plummet = revchain::plummet<T>(T(2), T(0.3));
    CHECK(plummet.weight == T(2));
    CHECK(plummet.centroid == T(0.3));
    CHECK(plummet.gyration_ratio == revchain::Wide<T>(T(0)));
    CHECK(pendulum_length(plummet) == T(0.3));
    CHECK(radius_of_gyration(plummet) == T(0));

    const auto rod = revchain::uniform_rod<T>(T(2), T(0.3));
    CHECK(rod.centroid == T(0.3) / 2);
    CHECK(pendulum_length(rod) == Approx(static_cast<double>(T(0.2))));
    const double error = static_cast<double>(fabsq(quad(rod.gyration_ratio) * 12 - 1));
    CHECK(error <= 16 * std::pow(static_cast<double>(revchain::epsilon<T>()), 2) + (sizeof(T) == 4 ? 1e-16 : 1e-33));
}

// What the user gave comes back bit by bit, and enters the equations exactly: rho^2 is kept in twice the digits.
TEMPLATE_TEST_CASE("pendulum length and radius of gyration are given back exactly", "[chain]", float, double,
                   long double) {
    using T = TestType;
    support::Random random(5);
    using limits = std::numeric_limits<T>;
    for (const T unit : {T(1), limits::min() * T(0x1p25), limits::max() / T(0x1p25)}) {
        for (int i = 0; i < 20000; ++i) {
            const T a = static_cast<T>(random.between(0.1, 10)) * unit,
                    h = static_cast<T>(random.between(-1, 1)) * unit;
            const T rho = static_cast<T>(random.log_between(1e-3, 1e3)) * unit;
            const T l = h * static_cast<T>(1 + random.log_between(1e-3, 1e3));
            CHECK(radius_of_gyration(compound_pendulum<T>(
                      {.weight = 1, .length = a, .centroid = h, .radius_of_gyration = rho})) == rho);
            CHECK(pendulum_length(
                      compound_pendulum<T>({.weight = 1, .length = a, .centroid = h, .pendulum_length = l})) == l);
        }
    }
}

TEST_CASE("centroid at the pin", "[chain]") {
    const auto wheel = compound_pendulum<double>({.weight = 1, .length = 1, .centroid = 0, .radius_of_gyration = 0.5});
    CHECK(std::isinf(pendulum_length(wheel)));
    CHECK(radius_of_gyration(wheel) == 0.5);
}

TEST_CASE("impossible bodies are refused with a reason", "[chain]") {
    using Catch::Matchers::ContainsSubstring;
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH(
        compound_pendulum<double>({.weight = 1, .length = 1, .centroid = 0.5, .pendulum_length = 0.4}),
        ContainsSubstring("imaginary radius of gyration") && ContainsSubstring("0.5") && ContainsSubstring("0.4"));
    CHECK_THROWS_WITH(compound_pendulum<double>({.weight = 1, .length = 1, .centroid = 0.5}),
                      ContainsSubstring("either"));
    CHECK_THROWS_WITH(
        compound_pendulum<double>(
            {.weight = 1, .length = 1, .centroid = 0.5, .pendulum_length = 0.6, .radius_of_gyration = 0.1}),
        ContainsSubstring("either"));
    CHECK_THROWS_WITH(compound_pendulum<double>({.weight = 1, .length = 1, .centroid = 0, .pendulum_length = 0.6}),
                      ContainsSubstring("radius of gyration instead"));
    CHECK_THROWS_AS(compound_pendulum<double>({.weight = 1, .length = 1, .centroid = 0.5, .radius_of_gyration = -0.1}),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(
        compound_pendulum<double>({.weight = 1, .length = 1, .centroid = 0.5, .radius_of_gyration = infinity}),
        revchain::InvalidArgument);
    CHECK_THROWS_AS(compound_pendulum<double>({.weight = 1, .length = 1, .centroid = nan, .pendulum_length = 0.6}),
                    revchain::InvalidArgument);
    CHECK_THROWS_WITH(
        compound_pendulum<double>({.weight = 1, .length = 1, .centroid = 0.5, .radius_of_gyration = 1e-200}),
        ContainsSubstring("too far apart"));
    CHECK(revchain::radius_of_gyration(revchain::uniform_rod<double>(1.0, 1.2e300)) == 1.2e300 / std::sqrt(12.0));
}
