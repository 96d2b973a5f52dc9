// SPDX-License-Identifier: MPL-2.0
#include "revchain/numeric/arc_step.hpp"

#include <cmath>
#include <complex>
#include <functional>
#include <vector>

#include "support/catch.hpp"

using revchain::detail::arc_step;

namespace {

/// A walk on the unit circle. A step is refused beyond `turn` radians.
struct Circle {
    std::complex<double> at = 1.0;
    double turn = 0.1;
    std::vector<double> tried{};

    std::optional<double> operator()(double step) {
        tried.push_back(step);
        const auto guess = at + step * std::complex<double>(0, 1) * at, next = guess / std::abs(guess);
        if (std::arg(next / at) > turn) return {};
        at = next;
        return 2.0;
    }
};

}  // namespace

TEST_CASE("arc_step goes round a circle: refused steps are shortened, accepted ones lead on") {
    Circle circle;
    double step = 0.05, angle = 0;
    int steps = 0;
    for (auto last = circle.at; angle < 6.28; last = circle.at, ++steps) {
        REQUIRE(arc_step(step, 1.0, 0.5, std::ref(circle)));
        const double turned = std::arg(circle.at / last);
        CHECK(turned > 0.049);  // the step before, or half of a refused one that was twice as long
        CHECK(turned <= 0.1);
        angle += turned;
    }
    CHECK(steps < 6.28 / 0.049);
    CHECK(circle.tried.size() < 3 * static_cast<std::size_t>(steps));
}

TEST_CASE("arc_step keeps to the longest step and to the share that is asked for") {
    Circle circle{1.0, 0.1};
    double step = 0.4;
    REQUIRE(arc_step(step, 0.3, 0.4, std::ref(circle)));
    REQUIRE(circle.tried.size() == 3);
    CHECK(circle.tried[0] == 0.3);
    CHECK(circle.tried[1] == 0.3 * 0.4);
    CHECK(circle.tried[2] == 0.3 * 0.4 * 0.4);
    CHECK(step == 2 * circle.tried[2]);
}

TEST_CASE("arc_step gives up below 1e-9 and leaves the point where it is") {
    Circle circle{1.0, -1};
    double step = 0.1;
    CHECK_FALSE(arc_step(step, 1.0, 0.5, std::ref(circle)));
    CHECK(step <= 1e-9);
    CHECK(circle.at == 1.0);
    CHECK(circle.tried.back() > 1e-9);
}

TEST_CASE("arc_step can be interrupted") {
    struct Stop {};
    revchain::detail::interrupt = [] { throw Stop(); };
    Circle circle;
    double step = 0.1;
    CHECK_THROWS_AS(arc_step(step, 1.0, 0.5, std::ref(circle)), Stop);
    revchain::detail::interrupt = nullptr;
    CHECK(circle.tried.empty());
}
