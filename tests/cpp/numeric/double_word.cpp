// SPDX-License-Identifier: MPL-2.0
#include "revchain/numeric/double_word.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::DoubleWord;
using support::quad;
using support::Quad;

namespace {

template <class T>
DoubleWord<T> random_word(support::Random& random) {
    const T high = static_cast<T>(random.between(-1, 1) * std::pow(2.0, random.between(-20, 20)));
    const T low = high * std::numeric_limits<T>::epsilon() * static_cast<T>(random.between(-0.499, 0.499));
    return revchain::fast_two_sum(high, low);
}

double relative(Quad got, Quad want) {
    return want == 0 ? static_cast<double>(fabsq(got)) : static_cast<double>(fabsq((got - want) / want));
}

}  // namespace

// float and double: the exact result of one operation fits (nearly) in 113 bits.
TEMPLATE_TEST_CASE("double-word operations keep their bounds", "[core]", float, double) {
    using T = TestType;
    const double u = std::numeric_limits<T>::epsilon() / 2;
    const double floor = 1e-33;  // of the reference
    support::Random random(1);
    double worst_sum = 0, worst_product = 0, worst_quotient = 0, worst_root = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto x = random_word<T>(random), y = random_word<T>(random);
        // relative to |x| + |y| would be weaker: the accurate sum keeps a RELATIVE error even under cancellation
        worst_sum =
            std::max({worst_sum, relative(quad(x + y), quad(x) + quad(y)), relative(quad(x - y), quad(x) - quad(y)),
                      relative(quad(x + y.high), quad(x) + Quad(y.high))});
        worst_product = std::max({worst_product, relative(quad(x * y), quad(x) * quad(y)),
                                  relative(quad(x * y.high), quad(x) * Quad(y.high))});
        worst_quotient = std::max(worst_quotient, relative(quad(x / y), quad(x) / quad(y)));
        worst_root = std::max(worst_root, relative(quad(sqrt(abs(x))), sqrtq(fabsq(quad(x)))));
    }
    CAPTURE(worst_sum / (u * u), worst_product / (u * u), worst_quotient / (u * u), worst_root / (u * u));
    // The theorems: 3u^2, 5u^2, 15u^2; operation_error is 32u^2.
    CHECK(worst_sum <= 3 * u * u * (1 + 10 * u) + floor);
    CHECK(worst_product <= 5 * u * u + floor);
    CHECK(worst_quotient <= 15 * u * u * (1 + 10 * u) + floor);
    CHECK(worst_root <= 15 * u * u + floor);
    CHECK(static_cast<double>(revchain::operation_error<DoubleWord<T>>()) == 32 * u * u);
}

TEST_CASE("sums that cancel", "[core]") {
    const DoubleWord<double> x(1.0, 0x1p-60), y(-1.0, 0x1p-80);
    CHECK(quad(x + y) == Quad(0x1p-60) + Quad(0x1p-80));
    CHECK(quad(x - x) == 0);
}

TEMPLATE_TEST_CASE("sums and products of two numbers are exact", "[core]", float, double, long double) {
    using T = TestType;
    support::Random random(2);
    for (int i = 0; i < 20000; ++i) {
        const T x = static_cast<T>(random.between(-1, 1)) * static_cast<T>(random.between(0.5, 1));
        const T y = static_cast<T>(random.between(-1, 1)) / static_cast<T>(random.between(0.5, 1));
        const auto s = revchain::two_sum(x, y);
        CHECK(Quad(s.high) + Quad(s.low) == Quad(x) + Quad(y));
        CHECK(s.high == x + y);
        const auto p = revchain::two_product(x, y);
        CHECK(p.high == x * y);
        if constexpr (sizeof(T) <= 8) {
            CHECK(Quad(p.high) + Quad(p.low) == Quad(x) * Quad(y));
        } else {  // 128 bits do not fit in the reference: the low part is compared with the rest of a split product
            const T cut = static_cast<T>(0x1p33L);
            const T head = (x * cut + x) - x * cut;  // a few leading bits of x
            CHECK(Quad(revchain::two_product(head, y).high) + Quad(revchain::two_product(head, y).low) ==
                  Quad(head) * Quad(y));
            CHECK(static_cast<double>(fabsq((Quad(p.high) + Quad(p.low)) - Quad(x) * Quad(y))) <= 1e-34);
        }
    }
}

TEST_CASE("order, conversion and scaling", "[core]") {
    using D = DoubleWord<double>;
    CHECK(D(1.0, 1e-20) > D(1.0));
    CHECK(D(1.0, -1e-20) < D(1.0));
    CHECK(D(1.0) == D(1));
    CHECK(static_cast<double>(D(1.0, 1e-20)) == 1.0);
    CHECK(ldexp(D(1.0, 1e-20), 3) == D(8.0, 8e-20));
    int exponent = 0;
    CHECK(frexp(D(8.0, 8e-20), &exponent) == D(0.5, 5e-21));
    CHECK(exponent == 4);
    CHECK(abs(D(-1.0, 1e-20)) == D(1.0, -1e-20));
    CHECK(isfinite(D(1)));
    CHECK_FALSE(isfinite(D(std::numeric_limits<double>::infinity())));
    CHECK(sqrt(D(0)) == D(0));
    CHECK(std::numeric_limits<D>::digits == 106);
    STATIC_REQUIRE(revchain::Real<D>);
    STATIC_REQUIRE(revchain::Real<DoubleWord<long double>>);
    STATIC_REQUIRE(std::is_same_v<revchain::Wide<float>, double>);
}
