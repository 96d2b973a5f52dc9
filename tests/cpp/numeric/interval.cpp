// SPDX-License-Identifier: MPL-2.0
#include <random>

#include "revchain/numeric/double_double.hpp"
#include "revchain/numeric/interval.hpp"
#include "support/catch.hpp"

namespace {

using revchain::DoubleDouble;
using revchain::Interval;
using Far = DoubleDouble;

template <class T>
bool unknown(const T& x) {
    return !(x == x);
}

TEMPLATE_TEST_CASE("an unknown end of an interval stays unknown", "[interval]", double, DoubleDouble) {
    using T = TestType;
    const T nan = std::numeric_limits<T>::quiet_NaN();
    const Interval<T> all(nan, nan), above(T(1), nan), below(nan, T(1)), known(T(2), T(3));
    for (const Interval<T>& x : {hull(all, known), hull(known, all)}) CHECK((unknown(x.low) && unknown(x.high)));
    for (const Interval<T>& x : {hull(above, known), hull(known, above)}) CHECK((x.low == T(1) && unknown(x.high)));
    for (const Interval<T>& x : {hull(below, known), hull(known, below)}) CHECK((unknown(x.low) && x.high == T(3)));
    for (const Interval<T>& x : {all, above, below}) {
        CHECK(unknown(x.size()));
        CHECK(unknown(square(x).high));
        CHECK_FALSE(square(x).low > T(1));
    }
    const T large(1e200);
    CHECK(unknown((Interval<T>(large) * Interval<T>(large)).low));
}

TEST_CASE("a quotient by an empty interval is unknown", "[interval]") {
    const auto quotient = revchain::Interval<double>(1.0, 2.0) / revchain::Interval<double>(1e-3, -1e-3);
    CHECK(std::isnan(quotient.low));
    CHECK(std::isnan(quotient.high));
}

TEST_CASE("quotients, products and roots of two words hold the exact ones where second words underflow", "[interval]") {
    // The exact value: the same operation on numbers 2^600 times larger, whose second words do not underflow.
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> digits(0.5, 1), exponent(-1070, -900), other(-300, 300);
    const auto number = [&](double e) {
        return ldexp(Far(digits(random), digits(random) * 0x1p-54), static_cast<int>(e));
    };
    const auto holds = [](const Interval<Far>& wide, const Far& exact, int scale) {
        return ldexp(wide.low, scale) <= exact && exact <= ldexp(wide.high, scale);
    };
    int failures = 0;
    for (int i = 0; i < 200'000; ++i) {
        const Far faint = number(exponent(random)), plain = number(other(random));
        const Interval<Far> x(faint), y(plain);
        const Far scaled = ldexp(faint, 600), factor = number(exponent(random) + 800);
        failures += !holds(x / y, scaled / plain, 600);
        failures += !holds(-x / y, -scaled / plain, 600);
        failures += !holds(sqrt(x), sqrt(scaled), 300);
        failures += !holds(Interval<Far>(factor) * Interval<Far>(ldexp(faint, 100)), factor * ldexp(faint, 900), 800);
    }
    CHECK(failures == 0);
}

}  // namespace
