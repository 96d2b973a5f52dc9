// SPDX-License-Identifier: MPL-2.0
#include "revchain/numeric/complex_words.hpp"

#include <random>

#include "support/catch.hpp"

using revchain::DoubleDouble;
using Complex = std::complex<DoubleDouble>;

TEST_CASE("complex numbers of two words: products and quotients", "[core]") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> part(-2.0, 2.0);
    const auto number = [&] { return DoubleDouble(part(random)) + DoubleDouble(0x1p-60 * part(random)); };
    const auto size = [](const Complex& z) {
        return std::hypot(static_cast<double>(z.real()), static_cast<double>(z.imag()));
    };
    for (int trial = 0; trial < 1000; ++trial) {
        const Complex x(number(), number()), y(number(), number());
        const Complex square = x * x, back = x * y / y;
        CHECK(size(back - x) <= 4e-31 * size(x));
        CHECK(static_cast<double>(abs(square.real() - (x.real() - x.imag()) * (x.real() + x.imag()))) <=
              4e-32 * size(x) * size(x));
        CHECK(static_cast<double>(abs(square.imag() - DoubleDouble(2) * x.real() * x.imag())) <=
              4e-32 * size(x) * size(x));
    }
    const Complex i(DoubleDouble(0), DoubleDouble(1));
    CHECK(i * i == Complex(DoubleDouble(-1)));
    CHECK(Complex(DoubleDouble(1)) / i == Complex(DoubleDouble(0), DoubleDouble(-1)));
}
