// SPDX-License-Identifier: GPL-3.0-or-later
#include "revchain/analytic/bessel_zero.hpp"

#include <fstream>
#include <sstream>

#include "support/catch.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

namespace analytic = revchain::analytic;
using support::Quad;

TEST_CASE("zeros of J0 and J1 against 25 digits, up to the millionth", "[analytic]") {
    std::ifstream file(REVCHAIN_TEST_DATA "/bessel_zeros.csv");
    std::string line;
    REQUIRE(std::getline(file, line));
    double worst[2] = {0, 0};
    int rows = 0;
    while (std::getline(file, line)) {
        std::istringstream fields(line);
        std::string order, k, zero;
        REQUIRE(std::getline(std::getline(std::getline(fields, order, ','), k, ','), zero));
        const Quad truth = strtoflt128(zero.c_str(), nullptr);
        const revchain::Index number = std::stol(k);
        const double computed = order == "0" ? analytic::zero_of_j0(number) : analytic::zero_of_j1(number);
        CAPTURE(order, k, computed);
        double& w = worst[order == "0" ? 0 : 1];
        w = std::max(w, support::error_in_ulp(computed, truth));
        ++rows;
    }
    CHECK(rows == 140);
    CAPTURE(worst[0], worst[1]);
    CHECK(worst[0] <= 0.42);  // measured 0.419
    CHECK(worst[1] <= 0.45);  // measured 0.443
}

TEST_CASE("the two methods meet without a step", "[analytic]") {
    // Increments approach pi from below (J0) and from above (J1): a wrong digit at the change of method would show.
    for (revchain::Index k = 15; k < 25; ++k) {
        const double d0 = analytic::zero_of_j0(k + 1) - analytic::zero_of_j0(k),
                     d1 = analytic::zero_of_j0(k + 2) - analytic::zero_of_j0(k + 1);
        CHECK(d0 < d1);
        CHECK(d1 < M_PI);
        const double e0 = analytic::zero_of_j1(k + 1) - analytic::zero_of_j1(k),
                     e1 = analytic::zero_of_j1(k + 2) - analytic::zero_of_j1(k + 1);
        CHECK(e0 > e1);
        CHECK(e1 > M_PI);
    }
}

TEST_CASE("zeros are numbered from 1", "[analytic]") {
    CHECK_THROWS_AS(analytic::zero_of_j0(0), revchain::InvalidArgument);
    CHECK_THROWS_AS(analytic::zero_of_j1(-1), revchain::InvalidArgument);
}
