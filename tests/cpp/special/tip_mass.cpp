// SPDX-License-Identifier: GPL-3.0-or-later
#include "revchain/special/tip_mass.hpp"

#include "revchain/special/heavy_chain.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/table.hpp"

namespace tip_mass = revchain::analytic::tip_mass;
namespace heavy_chain = revchain::analytic::heavy_chain;
using revchain::Index;
using Quad = __float128;

TEST_CASE("tip mass: heights against 25 digits", "[analytic]") {
    double worst = 0;
    const auto rows = support::table(REVCHAIN_TEST_DATA "/tip_mass.csv");
    REQUIRE(rows.size() == 108);
    for (const auto& row : rows) {
        const tip_mass::Mode mode(std::stol(row[1]), 1.0, std::stod(row[0]));
        const double error = support::error_in_ulp(mode.conical_height(), support::quad_of(row[2]));
        CAPTURE(row, mode.conical_height());
        CHECK(error <= 1);
        worst = std::max(worst, error);
    }
    CAPTURE(worst);
    CHECK(worst <= 0.99);  // documented: 2
}

TEST_CASE("tip mass: offsets and slopes against 20 digits", "[analytic]") {
    double worst = 0, worst_slope = 0;
    int rows = 0;
    for (const auto& row : support::table(REVCHAIN_TEST_DATA "/chain_shapes.csv")) {
        if (row[0] != "tip") continue;
        const double tip = std::stod(row[1]), x = std::stod(row[3]);
        const tip_mass::Mode mode(std::stol(row[2]), 1.0, tip);
        const double height = mode.conical_height(), largest = row[2] == "1" ? 1 : std::sqrt(1 + tip / height);
        const double apart = 2 / std::sqrt(height) / (std::sqrt(tip + 1) + std::sqrt(tip));
        const double off = static_cast<double>(mode.shape(x) - support::quad_of(row[4]));
        const double off_slope = static_cast<double>(mode.slope(x) - support::quad_of(row[5]));
        worst = std::max(worst, std::abs(off) / (1 + apart) / largest);
        worst_slope = std::max(worst_slope, std::abs(off_slope) * height / (1 + apart));
        ++rows;
    }
    CHECK(rows == 196);
    CAPTURE(worst, worst_slope);
    CHECK(worst <= 4.5e-16);        // measured 4.2e-16; documented: 6e-16
    CHECK(worst_slope <= 5.6e-16);  // measured 5.3e-16
}

TEST_CASE("tip mass: none is the uniform chain, and next to none is next to it", "[analytic]") {
    const auto uniform = heavy_chain::conical_heights(400, 0.7);
    for (const double tip : {0.0, 5e-324, 1e-300, 1e-30}) {
        CAPTURE(tip);
        const auto heights = tip_mass::conical_heights(400, 0.7, tip);
        for (Index k = 0; k < 400; ++k) CHECK(support::error_in_ulp(heights[k], Quad(uniform[k])) <= 2.5);
        for (const Index k : {1, 2, 6, 30}) {
            const tip_mass::Mode mode(k, 0.7, tip);
            CHECK(mode.shape(5e-324) == 1);
            CHECK(mode.slope(5e-324) * mode.conical_height() == Approx(-1).epsilon(1e-15));
            const auto nodes = mode.nodes(), expected = heavy_chain::nodes(k, 0.7);
            REQUIRE(nodes.size() == k - 1);
            for (Index i = 0; i < k - 1; ++i) CHECK(std::abs(nodes[i] - expected[i]) <= 1e-15 * 0.7);
            for (int i = 0; i <= 30; ++i) {
                const double x = 0.7 * i / 30;
                CHECK(std::abs(mode.shape(x) - heavy_chain::shape(x, k, 0.7)) <= 4e-16 * (1 + 3.2 * double(k)));
                CHECK(std::abs(mode.slope(x) - heavy_chain::slope(x, k, 0.7)) * mode.conical_height() <=
                      4e-16 * (1 + 3.2 * double(k)));
            }
        }
    }
    // The first effect of a tip is that of more chain: d ln lambda / d tip = 1/length, for every mode.
    for (Index k = 0; k < 3; ++k) {
        const double tip = 1e-9;
        const double rise =
            tip_mass::conical_heights(k + 1, 1.0, tip)[k] / heavy_chain::conical_heights(k + 1, 1.0)[k] - 1;
        CHECK(rise / tip == Approx(1).epsilon(1e-5));
    }
}

TEST_CASE("tip mass: a heavy one is a plummet, and a string between two ends", "[analytic]") {
    for (const double length : {1.0, 3e5}) {
        for (const double ratio : {1e6, 1e9, 1e15, 1e100, 1e250}) {
            const double tip = ratio * length;
            CAPTURE(length, ratio);
            const auto heights = tip_mass::conical_heights(50, length, tip);
            CHECK(std::abs(heights[0] / length - (1 - 1 / (6 * ratio))) <= 1e-15 + 1 / (ratio * ratio));
            for (Index k = 1; k < 50; ++k) {  // half waves on threads of the mean tension
                const double turn = M_PI * static_cast<double>(k);
                CHECK(std::abs(heights[k] * ratio / length * (turn * turn) - 1) <= 3 / ratio + 1e-15);
            }
            const tip_mass::Mode first(1, length, tip), fourth(4, length, tip);
            const double largest = std::sqrt(tip) / std::sqrt(fourth.conical_height());
            for (int i = 0; i <= 20; ++i) {
                const double x = length * i / 20;
                CHECK(std::abs(first.shape(x) - (1 - i / 20.0)) <= 1 / ratio + 1e-15);
                CHECK(std::abs(fourth.shape(x) / largest + std::sin(3 * M_PI * i / 20.0)) <=
                      3 / std::sqrt(ratio) + 1e-14);
            }
            const auto nodes = fourth.nodes();
            CHECK(nodes[0] == Approx(fourth.conical_height()).epsilon(3 / ratio + 1e-15));
            CHECK(std::abs(nodes[1] / length - 1 / 3.0) <= 3 / ratio + 1e-15);
            CHECK(std::abs(nodes[2] / length - 2 / 3.0) <= 3 / ratio + 1e-15);
        }
    }
}

TEST_CASE("tip mass: laws of all weights", "[analytic]") {
    support::Random random(11);
    for (int run = 0; run < 150; ++run) {
        const double length = random.log_between(1e-3, 1e3), tip = length * random.log_between(1e-12, 1e12);
        const Index k = 1 + static_cast<Index>(random() * random() * 40);
        CAPTURE(length, tip, k);
        const tip_mass::Mode mode(k, length, tip);
        const double height = mode.conical_height(), largest = k == 1 ? 1 : std::sqrt(1 + tip / height),
                     turns = 3.2 * double(k);
        // Mode k has z_L above j_{0,k}, and z_L - z_0 below k pi.
        const auto heights = tip_mass::conical_heights(k + 1, length, tip);
        CHECK(heights[k - 1] == height);
        CHECK(heights[k] < height);
        CHECK(height <= heavy_chain::conical_heights(k, tip + length)[k - 1] * (1 + 1e-15));
        const double string = M_PI * double(k), stiff = std::sqrt(tip + length) + std::sqrt(tip);
        CHECK(height >= length / stiff * (length / stiff) * 4 / (string * string));
        CHECK(std::abs(mode.shape(0) - 1) <= 4e-16 * (1 + turns));
        CHECK(std::abs(mode.slope(0) * height + 1) <= 4e-16 * (1 + turns));
        CHECK(std::abs(mode.shape(length)) <= 4e-16 * (1 + turns) * largest);
        const auto nodes = mode.nodes();
        double before = 0;
        for (Index i = 0; i < k - 1; ++i) {
            CHECK(nodes[i] > before);
            CHECK(mode.shape(before + 0.5 * (nodes[i] - before)) * (i % 2 == 0 ? 1 : -1) > 0);
            CHECK(std::abs(mode.shape(nodes[i])) <= 1e-15 * (1 + turns) * largest);
            before = nodes[i];
        }
        CHECK(before < length);
    }
}

TEST_CASE("tip mass: heights of neighbouring weights do not step where the method changes", "[analytic]") {
    // z_0 = 30 and 1e-5, z_L = 45: followed through them, ln lambda against ln tip has bounded second differences.
    for (const Index k : {1, 2, 5, 9, 10, 11, 13, 14, 15, 16, 17, 30}) {
        double before = 0, rise_before = 0;
        for (int i = 0; i <= 3000; ++i) {
            const double tip = 1e-12 * std::pow(10.0, i * 16.0 / 3000);
            const double log = std::log(tip_mass::Mode(k, 1.0, tip).conical_height());
            if (i > 0) {
                CAPTURE(k, tip);
                if (i > 1) CHECK(std::abs((log - before) - rise_before) <= 3e-4);
                rise_before = log - before;
            }
            before = log;
        }
    }
}

TEST_CASE("tip mass: any unit of length", "[analytic]") {
    for (const int power : {-980, -300, 300, 1010}) {
        for (const double tip : {0.0, 0.01, 1.0, 300.0}) {
            CAPTURE(power, tip);
            const tip_mass::Mode mode(3, 1.5, tip), other(3, std::ldexp(1.5, power), std::ldexp(tip, power));
            CHECK(other.conical_height() == std::ldexp(mode.conical_height(), power));
            CHECK(other.shape(std::ldexp(0.4, power)) == mode.shape(0.4));
            CHECK(other.slope(std::ldexp(0.4, power)) == std::ldexp(mode.slope(0.4), -power));
            CHECK(other.nodes()[1] == std::ldexp(mode.nodes()[1], power));
        }
    }
}

TEST_CASE("tip mass: bad input", "[analytic]") {
    const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
    for (const double bad : {-1.0, -1e-300, 1e251, inf, nan}) {
        CHECK_THROWS_AS(tip_mass::conical_heights(1, 1.0, bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(tip_mass::Mode(1, 1.0, bad), revchain::InvalidArgument);
    }
    for (const double bad : {0.0, -1.0, inf, nan}) {
        CHECK_THROWS_AS(tip_mass::conical_heights(1, bad, 1.0), revchain::InvalidArgument);
        CHECK_THROWS_AS(tip_mass::Mode(1, bad, 1.0), revchain::InvalidArgument);
    }
    CHECK_THROWS_AS(tip_mass::conical_heights(0, 1.0, 1.0), revchain::InvalidArgument);
    CHECK_THROWS_AS(tip_mass::Mode(0, 1.0, 1.0), revchain::InvalidArgument);
    const tip_mass::Mode mode(1, 1.0, 2.0);
    for (const double bad : {-1e-9, 1.0000001, inf, nan}) {
        CHECK_THROWS_AS(mode.shape(bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(mode.slope(bad), revchain::InvalidArgument);
    }
}
