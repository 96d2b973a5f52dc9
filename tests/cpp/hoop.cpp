// SPDX-License-Identifier: MPL-2.0
#include "revchain/hoop.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

using support::error_in_ulp;
using support::Quad;
namespace hoop = revchain::hoop;

TEMPLATE_TEST_CASE("§5 (6): hoop, v^2 = g h; it bursts at the speed of a fall through half the breaking length",
                   "[core]", float, double, long double) {
    using T = TestType;
    support::Random random(506);
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        const T v = static_cast<T>(random.log_between(1e-6, 1e6)), g = static_cast<T>(random.log_between(1e-3, 1e3));
        const T h = hoop::tension(v, g);
        worst = std::max({worst, error_in_ulp(h, Quad(v) * v / g), error_in_ulp(hoop::speed(h, g), sqrtq(Quad(g) * h)),
                          error_in_ulp(hoop::speed(h, g), Quad(v))});
        const auto waves = hoop::wave_speeds(v);
        CHECK(waves.standing == 0);
        CHECK(waves.running == 2 * v);
    }
    CAPTURE(worst);
    CHECK(worst <= 3);
    // a fall through h/2 ends with sqrt(2 g h/2)
    CHECK(error_in_ulp(hoop::speed(T(5000), T(9.80665)), sqrtq(2 * Quad(T(9.80665)) * 2500)) <= 2);
    // the ends of the range: no product of two numbers is formed
    const T big = std::sqrt(std::numeric_limits<T>::max()) * T(4);
    CHECK(error_in_ulp(hoop::speed(big, big), Quad(big)) <= 1);
    for (const T bad : {T(0), T(-1), std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity()}) {
        CHECK_THROWS_AS(hoop::speed(bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(hoop::tension(bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(hoop::wave_speeds(bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(hoop::string_revolutions_per_second(T(1), bad), revchain::InvalidArgument);
    }
}
