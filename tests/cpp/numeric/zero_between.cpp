// SPDX-License-Identifier: MPL-2.0
#include "revchain/numeric/zero_between.hpp"

#include <cmath>

#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/numeric/double_double.hpp"
#include "support/catch.hpp"

using revchain::DoubleDouble;
using revchain::detail::SignChange;
using revchain::detail::zero_between;

namespace {

/// A function that grows through 0.
struct Case {
    double low, high, zero;
    double (*value)(double);
    double (*slope)(double);
};
const Case cases[]{
    {0, 2, std::sqrt(2.0), [](double x) { return x * x - 2; }, [](double x) { return 2 * x; }},
    {-3, 40, 0.5, [](double x) { return std::exp(x - 0.5) - 1; }, [](double x) { return std::exp(x - 0.5); }},
    {-8, 9, 0.25, [](double x) { return std::atan(8 * x - 2); },
     [](double x) { return 8 / (1 + std::pow(8 * x - 2, 2)); }},
    {0.1, 1e6, 3, [](double x) { return 1 - 3 / x; }, [](double x) { return 3 / (x * x); }},
    {0, 1, 1e-9, [](double x) { return x - 1e-9; }, [](double) { return 1.0; }},
};

}  // namespace

TEST_CASE("zeros by Newton's method within a bracket", "[core]") {
    int evaluations = 0;
    for (const Case& one : cases) {
        CAPTURE(one.zero);
        const auto function = [&](double x) {
            ++evaluations;
            return std::pair(one.value(x), one.slope(x));
        };
        CHECK(std::abs(zero_between(one.low, one.high, function) / one.zero - 1) <= 0x1p-51);
        CHECK(std::abs(zero_between(one.low, one.high, function, 1e-3) / one.zero - 1) <= 1e-3);
        const double start = one.zero * (1 + 1e-9);
        const auto last = revchain::detail::newton_between(one.low, one.high, function, start, 1e-6);
        CHECK(last.from == start);  // one step from next to it
        CHECK(std::abs((last.from - last.step) / one.zero - 1) <= 0x1p-51);
    }
    CAPTURE(evaluations);
    CHECK(evaluations <= 102);
}

TEST_CASE("zeros in double-double", "[core]") {
    const DoubleDouble two(2), low(1);
    const DoubleDouble by_slope =
        zero_between(low, two, [&](const DoubleDouble& x) { return std::pair(x * x - two, two * x); });
    const auto value = [&](const DoubleDouble& x) { return x * x - two; };
    const DoubleDouble by_value = zero_between(SignChange<DoubleDouble>{{low, value(low)}, {two, value(two)}}, value);
    for (const DoubleDouble& root : {by_slope, by_value}) CHECK(std::abs((root - sqrt(two)).high()) <= 2e-31);
}

TEST_CASE("zeros without a slope, of functions that grow or fall", "[core]") {
    int evaluations = 0;
    for (const double sign : {1.0, -1.0})
        for (const Case& one : cases) {
            CAPTURE(one.zero);
            const auto function = [&](double x) {
                ++evaluations;
                return sign * one.value(x);
            };
            const SignChange<double> ends{{one.low, function(one.low)}, {one.high, function(one.high)}};
            CHECK(std::abs(zero_between(ends, function) / one.zero - 1) <= 0x1p-51);
            CHECK(std::abs(zero_between(ends, function, {.width = 1e-3}) - one.zero) <= 2e-3);
            CHECK(std::abs(one.value(zero_between(ends, function, {.value = 1e-3}))) <= 1e-3);
        }
    CAPTURE(evaluations);
    CHECK(evaluations <= 328);
    const auto value = [](double x) { return x < 0.7 ? x - 0.5 : std::nan(""); };
    CHECK(zero_between(SignChange<double>{{0.0, 0.0}, {1.0, 0.5}}, value) == 0);
    CHECK(std::isnan(zero_between(SignChange<double>{{0.0, -0.5}, {1.0, 0.1}}, value)));
    CHECK(std::isnan(zero_between(SignChange<double>{{0.0, 0.5}, {1.0, 0.1}}, value)));
}

TEST_CASE("sign changes from a guess, and numbers brought together by halving", "[core]") {
    const auto value = [](double x) { return std::log(x / 3e7); };
    for (const double guess : {1e-5, 2e7, 4e7, 1e20}) {
        const auto found = revchain::detail::sign_change_near(guess, value);
        CHECK((found.low.value <= 0 && found.high.value >= 0));
        CHECK(found.high.x == 2 * found.low.x);
    }
    const auto at_zero = revchain::detail::sign_change_near(3e7, value);
    CHECK((at_zero.low.x == 3e7 && at_zero.high.x == 3e7));
    CHECK(zero_between(at_zero, value) == 3e7);

    const auto whole = revchain::detail::halved<long>(0, 1000, [](long n) { return n * n < 777 ? -1 : 1; });
    CHECK(whole == std::pair(27L, 28L));
    const auto real = revchain::detail::halved(1.0, 2.0, [](double x) { return x * x < 2 ? -1 : 1; });
    CHECK(real.second == std::nextafter(real.first, 2.0));
    CHECK((real.first * real.first < 2 && real.second * real.second >= 2));
    CHECK(revchain::detail::halved(0.0, 8.0, [](double) { return 0; }) == std::pair(0.0, 8.0));
}

TEST_CASE("compensated sums of double words and of other scalars", "[core]") {
    revchain::CompensatedSum<revchain::DoubleWord<double>> three;
    revchain::CompensatedSum<DoubleDouble> plain;
    for (int i = 0; i < 1000; ++i) {
        three.add({1.0, 0x1p-60}), three.add({0x1p-110, 0});
        plain.add(DoubleDouble(0.5));
    }
    CHECK(three.value() == revchain::DoubleWord<double>(1000, 1000 * 0x1p-60 + 1000 * 0x1p-110));
    CHECK(plain.value() == DoubleDouble(500));
}
