// SPDX-License-Identifier: GPL-3.0-or-later
#include "revchain/special/bessel_zero.hpp"

#include <fstream>
#include <sstream>

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/table.hpp"
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

TEST_CASE("zeros of J of real order against 25 digits, up to the millionth", "[analytic]") {
    double worst = 0;
    const auto rows = support::table(REVCHAIN_TEST_DATA "/bessel_zeros_real.csv");
    REQUIRE(rows.size() == 306);
    for (const auto& row : rows) {
        const double computed = analytic::zero_of_j(std::stod(row[0]), std::stol(row[1]));
        const double error = support::error_in_ulp(computed, support::quad_of(row[2]));
        CAPTURE(row, computed);
        CHECK(error <= 0.51);
        worst = std::max(worst, error);
    }
    CAPTURE(worst);
    CHECK(worst <= 0.47);  // measured 0.461
}

namespace {
/// How far z is from the zero next to it, in ulp, by the recurrence in two long doubles.
double off_in_ulp(double order, double z) {
    using Wide = revchain::DoubleWord<long double>;
    const long double ratio = analytic::detail::bessel_ratio<Wide>(order, z).high;
    const long double step = ratio / (1 - static_cast<long double>(order) / z * ratio);
    return static_cast<double>(std::abs(step) / z) / std::numeric_limits<double>::epsilon();
}
}  // namespace

TEST_CASE("zeros of J of random orders: within 0.51 ulp, none left out, none twice", "[analytic]") {
    support::Random random(4);
    double worst = 0;
    for (int run = 0; run < 60; ++run) {
        const double order = run % 3 == 0 ? random.between(-0.999, 0) : random.between(0, run % 3 == 1 ? 10 : 100);
        const analytic::ZerosOfJ zeros(order), next(order + 1);
        double z = zeros(1);
        CAPTURE(order);
        if (order < 0) CHECK(z * z > 4 * (order + 1));  // Rayleigh's first sum, DLMF 10.21(vii)
        if (order >= 0) CHECK(z > order);
        for (revchain::Index k = 1; k <= 320; ++k) {  // beyond where the method changes, at max(30, 8 order)
            CAPTURE(k);
            if (k % 7 == 1) worst = std::max(worst, off_in_ulp(order, z));
            const double between = next(k), following = zeros(k + 1);  // the zeros of neighbouring orders interlace
            REQUIRE(z < between);
            REQUIRE(between < following);
            z = following;
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 0.51);  // measured 0.501
}

TEST_CASE("a million zeros of J: their distances tend to pi from the side of the order", "[analytic]") {
    for (const double order : {-0.99, -0.3, 2.2, 99.5}) {  // from above where |order| > 1/2 (Sturm)
        const analytic::ZerosOfJ zeros(order);
        const double sign = std::abs(order) > 0.5 ? 1 : -1;
        double z = zeros(2), before = sign > 0 ? 100 : 0;
        revchain::Index wrong = 0;
        for (revchain::Index k = 3; k <= 1'000'000; ++k) {
            const double next = zeros(k), distance = next - z, rounding = 3e-16 * next;
            if (sign * (distance - before) > rounding || sign * (M_PI - distance) > rounding) ++wrong;
            z = next, before = distance;
        }
        CAPTURE(order);
        CHECK(wrong == 0);
    }
}

TEST_CASE("zeros of J of real order: both methods agree where they meet", "[analytic]") {
    for (const double order : {-0.9, 0.0, 2.5, 3.75, 5.0, 31.4, 100.0}) {
        const analytic::ZerosOfJ zeros(order);
        const double first = analytic::detail::PhaseSeries::first(order);
        const auto k = static_cast<revchain::Index>(first / M_PI - order / 2);
        for (revchain::Index i = std::max<revchain::Index>(1, k - 3); i < k + 6; ++i) {
            CAPTURE(order, i);
            CHECK(off_in_ulp(order, zeros(i)) <= 0.51);
        }
    }
}

TEST_CASE("zeros of J of real order: what is known otherwise", "[analytic]") {
    const Quad pi = 4 * atanq(Quad(1));
    for (const revchain::Index k : {1, 2, 3, 7, 10, 20, 500, 1'000'000}) {
        const double n = static_cast<double>(k);
        CHECK(support::error_in_ulp(analytic::zero_of_j(0.5, k), Quad(n) * pi) <= 0.5);
        CHECK(support::error_in_ulp(analytic::zero_of_j(-0.5, k), Quad(n - 0.5) * pi) <= 0.5);
        CHECK(support::error_in_ulp(analytic::zero_of_j(0, k), Quad(analytic::zero_of_j0(k))) <= 1);
        CHECK(support::error_in_ulp(analytic::zero_of_j(1, k), Quad(analytic::zero_of_j1(k))) <= 1);
    }
    // Next to order -1 the first zero goes as 2 sqrt(order + 1) (1 + (order + 1)/4 + ...).
    for (const double a : {0x1p-52, 0x1p-40, 0x1p-25})
        CHECK(support::error_in_ulp(analytic::zero_of_j(a - 1, 1), 2 * sqrtq(Quad(a)) * (1 + Quad(a) / 4)) <= 0.51);
    // Great orders: order + 1.8557571 order^(1/3) + 1.03315 order^(-1/3) - ..., DLMF 10.21.40
    for (const double order : {1e3, 1e4, 1e5}) {
        const double c = std::cbrt(order);
        CHECK(std::abs(analytic::zero_of_j(order, 1) - (order + 1.855757081489239 * c + 1.033150 / c -
                                                        0.003971 / order - 0.0908 / (order * c * c))) < 1e-6);
        CHECK(off_in_ulp(order, analytic::zero_of_j(order, 1)) <= 0.51);
    }
}

TEST_CASE("zeros of J of real order: bad input", "[analytic]") {
    const double bad = GENERATE(-1.0, -2.0, std::numeric_limits<double>::infinity(), std::nan(""));
    CHECK_THROWS_AS(analytic::zero_of_j(bad, 1), revchain::InvalidArgument);
    CHECK_THROWS_AS(analytic::zero_of_j(0.3, 0), revchain::InvalidArgument);
}

TEST_CASE("zeros are numbered from 1", "[analytic]") {
    CHECK_THROWS_AS(analytic::zero_of_j0(0), revchain::InvalidArgument);
    CHECK_THROWS_AS(analytic::zero_of_j1(-1), revchain::InvalidArgument);
}
