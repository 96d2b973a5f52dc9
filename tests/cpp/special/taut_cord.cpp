// SPDX-License-Identifier: GPL-3.0-or-later
#include "revchain/special/taut_cord.hpp"

#include "support/catch.hpp"
#include "support/error_metric.hpp"
#include "support/table.hpp"

namespace taut_cord = revchain::analytic::taut_cord;
using revchain::Index;
using revchain::Wide;

TEST_CASE("taut cord: heights, offsets and slopes against 25 digits", "[analytic]") {
    double worst = 0, worst_offset = 0, worst_slope = 0, worst_point = 0;
    const auto rows = support::table(REVCHAIN_TEST_DATA "/taut_cord.csv");
    REQUIRE(rows.size() == 390);
    for (const auto& row : rows) {
        const double lower = std::stod(row[0]), x = std::stod(row[4]);
        const Index k = std::stol(row[1]);
        const taut_cord::Mode mode(k, 1.0, Wide<double>(lower));
        CAPTURE(row, mode.conical_height());
        CHECK(taut_cord::conical_height(k, 1.0, Wide<double>(lower)) == mode.conical_height());
        const double error = support::error_in_ulp(mode.conical_height(), support::quad_of(row[2]));
        CHECK(error <= 1);
        worst = std::max(worst, error);
        const double apart = 2 / std::sqrt(mode.conical_height()) / (std::sqrt(lower + 1) + std::sqrt(lower));
        const auto off = [&](double found, std::size_t column) {
            return std::abs(static_cast<double>(found - support::quad_of(row[column]))) / (1 + apart);
        };
        worst_offset = std::max(worst_offset, off(mode.shape(x), 5));
        worst_slope = std::max(worst_slope, off(mode.slope(x), 6) / std::max(mode.slope(0), 1 / mode.conical_height()));
        worst_point = std::max(worst_point, off(mode.vertical_points()[0], 3) * (1 + apart));
    }
    CAPTURE(worst, worst_offset, worst_slope, worst_point);
    CHECK(worst <= 0.9);  // documented: 2
    CHECK(worst_offset <= 2e-16);
    CHECK(worst_slope <= 3e-16);
    CHECK(worst_point <= 1e-15);
}

TEST_CASE("taut cord: nodes and vertical points are where offsets and slopes vanish, in turn", "[analytic]") {
    for (const double lower : {1e-12, 0.02, 3.0, 1e5})
        for (const Index k : {1, 2, 5, 40}) {
            CAPTURE(lower, k);
            const taut_cord::Mode mode(k, 2.0, Wide<double>(lower));
            const auto nodes = mode.nodes(), points = mode.vertical_points();
            REQUIRE(nodes.size() == k - 1);
            REQUIRE(points.size() == k);
            CHECK(std::abs(mode.shape(points[0]) - 1) <= 1e-15);
            for (Index i = 0; i < k; ++i) {
                CHECK(std::abs(mode.slope(points[i])) <= 1e-13 * std::abs(mode.slope(i > 0 ? nodes[i - 1] : 0.0)));
                if (i + 1 == k) continue;
                CHECK(points[i] < nodes[i]);
                CHECK(nodes[i] < points[i + 1]);
                CHECK(std::abs(mode.shape(nodes[i])) <= 1e-15 * 3.2 * static_cast<double>(k));
            }
        }
}

TEST_CASE("taut cord: far out it is a string under the mean tension", "[analytic]") {
    for (const double lower : {1e4, 1e8, 1e16, 1e200})
        for (const Index k : {1, 4}) {
            const double turns = M_PI * static_cast<double>(k), mean = lower + 0.5;
            const double string = 1 / (mean * turns * turns);
            CHECK(taut_cord::conical_height(k, 1.0, Wide<double>(lower)) ==
                  Approx(string).epsilon(1 / (lower * lower) + 1e-15));
            const taut_cord::Mode mode(k, 1.0, Wide<double>(lower));
            for (const double x : {0.1, 0.37, 0.9})
                CHECK(std::abs(mode.shape(x) - std::sin(turns * x)) <= 2 / lower + 1e-14);
        }
    CHECK_THROWS_AS(taut_cord::conical_height(0, 1.0, Wide<double>(1.0)), revchain::InvalidArgument);
    CHECK_THROWS_AS(taut_cord::Mode(1, 1.0, Wide<double>(0.0)), revchain::InvalidArgument);
    CHECK_THROWS_AS(taut_cord::Mode(1, 1.0, Wide<double>(1e-21)), revchain::InvalidArgument);
    CHECK_THROWS_AS(taut_cord::Mode(1, 1.0, Wide<double>(1.0)).shape(1.1), revchain::InvalidArgument);
}
