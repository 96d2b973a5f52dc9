// SPDX-License-Identifier: MPL-2.0
#include "revchain/numeric/called_words.hpp"

#include <random>

#include "support/catch.hpp"

using revchain::DoubleDouble, revchain::detail::CalledWords;
using Complex = std::complex<CalledWords>;

TEST_CASE("complex numbers of two words: products and quotients", "[core]") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> part(-2.0, 2.0);
    const auto number = [&] { return CalledWords(part(random)) + 0x1p-60 * CalledWords(part(random)); };
    const auto size = [](const Complex& z) {
        return std::hypot(static_cast<double>(z.real()), static_cast<double>(z.imag()));
    };
    for (int trial = 0; trial < 1000; ++trial) {
        const Complex x(number(), number()), y(number(), number());
        const Complex square = x * x, back = x * y / y;
        CHECK(size(back - x) <= 4e-31 * size(x));
        CHECK(static_cast<double>(abs(square.real() - (x.real() - x.imag()) * (x.real() + x.imag()))) <=
              4e-32 * size(x) * size(x));
        CHECK(static_cast<double>(abs(square.imag() - 2 * x.real() * x.imag())) <= 4e-32 * size(x) * size(x));
    }
    const Complex i(CalledWords(0), CalledWords(1));
    CHECK(i * i == Complex(CalledWords(-1)));
    CHECK(Complex(CalledWords(1)) / i == Complex(CalledWords(0), CalledWords(-1)));
}

TEST_CASE("numbers of two words by calls are those of DoubleDouble", "[core]") {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> part(-2.0, 2.0);
    const auto number = [&] { return DoubleDouble(part(random), 0x1p-60 * part(random)); };
    for (int trial = 0; trial < 1000; ++trial) {
        const DoubleDouble x = number(), y = number();
        const CalledWords a = x, b = y;
        CHECK(a + b == x + y);
        CHECK(a - b == x - y);
        CHECK(a * b == x * y);
        CHECK(a / b == x / y);
        CHECK(-a == -x);
        CHECK(abs(a) == abs(x));
        CHECK(sqrt(abs(a)) == sqrt(abs(x)));
        CalledWords c = a;
        CHECK((((c += b) *= a) -= b) / a == ((x + y) * x - y) / x);
    }
    CHECK(isnan(CalledWords(std::numeric_limits<CalledWords>::quiet_NaN())));
    CHECK(isinf(CalledWords(std::numeric_limits<CalledWords>::infinity())));
}
