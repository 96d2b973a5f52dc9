// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>

#include "revchain/numeric/double_word.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// A complex number of two double words. (std::complex is for built-in scalars only.)
struct ComplexWord {
    using S = DoubleWord<double>;
    S real{}, imag{};

    ComplexWord() = default;
    ComplexWord(const S& x) : real(x) {}  // NOLINT(google-explicit-constructor)
    ComplexWord(const S& x, const S& y) : real(x), imag(y) {}
    explicit ComplexWord(const std::complex<double>& z) : real(z.real()), imag(z.imag()) {}
    explicit operator std::complex<double>() const {
        return {static_cast<double>(real), static_cast<double>(imag)};
    }

    friend ComplexWord operator-(const ComplexWord& x) { return {-x.real, -x.imag}; }
    friend ComplexWord operator+(const ComplexWord& x, const ComplexWord& y) {
        return {x.real + y.real, x.imag + y.imag};
    }
    friend ComplexWord operator-(const ComplexWord& x, const ComplexWord& y) {
        return {x.real - y.real, x.imag - y.imag};
    }
    friend ComplexWord operator*(const ComplexWord& x, const ComplexWord& y) {
        return {x.real * y.real - x.imag * y.imag, x.real * y.imag + x.imag * y.real};
    }
    /// Divides by Smith's rule: the square of the divisor cannot overflow.
    friend ComplexWord operator/(const ComplexWord& x, const ComplexWord& y) {
        if (abs(y.real) < abs(y.imag)) {
            const S r = y.real / y.imag, size = y.imag + y.real * r;
            return {(x.real * r + x.imag) / size, (x.imag * r - x.real) / size};
        }
        const S r = y.imag / y.real, size = y.real + y.imag * r;
        return {(x.real + x.imag * r) / size, (x.imag - x.real * r) / size};
    }
    /// Returns the absolute value, to a few ulp of double.
    friend double size_of(const ComplexWord& x) { return std::abs(std::complex<double>(x)); }
};

}  // namespace revchain::pencil
