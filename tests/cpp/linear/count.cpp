// SPDX-License-Identifier: MPL-2.0
#include "revchain/linear/count.hpp"

#include "revchain/linear/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::count_modes;
using revchain::Index;

TEST_CASE("counts on either side of every height", "[linear]") {
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 5, 60}) {
            const auto chain = family.make(n);
            const auto m = revchain::modes(chain, {.shapes = false});
            for (Index j = 0; j < m.size(); ++j) {
                const double h = m.conical_height[j];
                CAPTURE(family.name, n, j);
                CHECK(count_modes(chain, h * (1 - 3 * 0x1p-52)) == j + 1);
                CHECK(count_modes(chain, h * (1 + 3 * 0x1p-52)) == j);
                const double speed = m.angular_speed(9.80665)[j];
                CHECK(count_modes(chain, speed * (1 + 4e-16 * 3), 9.80665) == j + 1);
                CHECK(count_modes(chain, speed * (1 - 4e-16 * 3), 9.80665) == j);
            }
            CHECK(count_modes(chain, 1e-250) == chain.mode_count());
            CHECK(count_modes(chain, 1e250) == 0);
        }
    }
}

TEST_CASE("exceeding is strict", "[linear]") {
    const revchain::Chain<double> one(std::vector{revchain::plummet(3.0, 1.0)});
    CHECK(count_modes(one, 1.0) == 0);
    CHECK(count_modes(one, std::nextafter(1.0, 0.0)) == 1);
    CHECK(count_modes(one, 2.0, 4.0) == 0);  // n^2 = g / 1
    CHECK(count_modes(one, std::nextafter(2.0, 3.0), 4.0) == 1);
}

TEST_CASE("bad heights and speeds", "[linear]") {
    const auto chain = revchain::Chain<double>::uniform_rods(3);
    const double bad =
        GENERATE(0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN());
    CHECK_THROWS_AS(count_modes(chain, bad), revchain::InvalidArgument);
    CHECK_THROWS_AS(count_modes(chain, bad, 9.8), revchain::InvalidArgument);
    CHECK_THROWS_AS(count_modes(chain, 1.0, bad), revchain::InvalidArgument);
}
