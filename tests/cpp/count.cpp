// SPDX-License-Identifier: MPL-2.0
#include "revchain/count.hpp"

#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::count_modes;
using revchain::Index;

TEST_CASE("counts on either side of every height", "[linear]") {
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 5, 60}) {
            const auto chain = family.make(n);
            const auto m = revchain::modes(chain, {.count = revchain::all_modes});
            for (Index j = 0; j < m.size(); ++j) {
                const double h = m.conical_height[j];
                CAPTURE(family.name, n, j);
                CHECK(count_modes(chain, {.conical_height = h * (1 - 3 * 0x1p-52)}) == j + 1);
                CHECK(count_modes(chain, {.conical_height = h * (1 + 3 * 0x1p-52)}) == j);
                const double speed = m.angular_speed(9.80665)[j];
                CHECK(count_modes(chain, {.angular_speed = speed * (1 + 4e-16 * 3), .gravity = 9.80665}) == j + 1);
                CHECK(count_modes(chain, {.angular_speed = speed * (1 - 4e-16 * 3), .gravity = 9.80665}) == j);
            }
            CHECK(count_modes(chain, {.conical_height = 1e-250}) == chain.mode_count());
            CHECK(count_modes(chain, {.conical_height = 1e250}) == 0);
        }
    }
}

TEST_CASE("exceeding is strict", "[linear]") {
    const revchain::Chain<double> one(std::vector{revchain::plummet(3.0, 1.0)});
    CHECK(count_modes(one, {.conical_height = 1.0}) == 0);
    CHECK(count_modes(one, {.conical_height = std::nextafter(1.0, 0.0)}) == 1);
    CHECK(count_modes(one, {.angular_speed = 2.0, .gravity = 4.0}) == 0);  // n^2 = g / 1
    CHECK(count_modes(one, {.angular_speed = std::nextafter(2.0, 3.0), .gravity = 4.0}) == 1);
}

TEST_CASE("bad heights and speeds", "[linear]") {
    const auto chain = revchain::Chain<double>::uniform_rods(3);
    const double bad =
        GENERATE(0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN());
    CHECK_THROWS_AS(count_modes(chain, {.conical_height = bad}), revchain::InvalidArgument);
    CHECK_THROWS_AS(count_modes(chain, {.angular_speed = bad, .gravity = 9.8}), revchain::InvalidArgument);
    CHECK_THROWS_AS(count_modes(chain, {.angular_speed = 1.0, .gravity = bad}), revchain::InvalidArgument);
}

TEST_CASE("ties and extremes", "[linear]") {
    support::Random random(61);
    for (int i = 0; i < 2000; ++i) {  // one link: its height is its pendulum length, as given
        const double h = random.between(0.1, 1), l = h * random.between(1, 3), a = random.between(0.5, 2);
        const revchain::Chain<double> one(std::vector{revchain::compound_pendulum<double>(
            {.weight = random.between(0.1, 9), .length = a, .centroid = h, .pendulum_length = l})});
        REQUIRE(count_modes(one, {.conical_height = l}) == 0);
        REQUIRE(count_modes(one, {.conical_height = std::nextafter(l, 0.0)}) == 1);
    }
    const revchain::Chain<double> threaded(
        std::vector{revchain::plummet(1.0, 1.0), revchain::plummet(0.0, 1.0), revchain::plummet(1.0, 1.0)});
    CHECK(threaded.mode_count() == 2);
    for (const double slow : {1e-300, 1e-200, 1e-150})
        CHECK(count_modes(threaded, {.angular_speed = slow, .gravity = 9.8}) == 0);
    for (const double fast : {1e150, 1e200, 1e300})
        CHECK(count_modes(threaded, {.angular_speed = fast, .gravity = 9.8}) == 2);
    CHECK(count_modes(threaded, {.conical_height = 5e-324}) == 2);
    CHECK(count_modes(threaded, {.conical_height = 1.7e308}) == 0);
}
