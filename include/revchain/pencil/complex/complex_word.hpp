// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>

#include "revchain/numeric/double_word.hpp"

namespace revchain::pencil {

/// A complex number of two double words; std::complex is for the built-in scalars alone.
struct ComplexWord {
    using S = DoubleWord<double>;
    S real{}, imag{};

    ComplexWord() = default;
    ComplexWord(const S& x) : real(x) {}  // NOLINT(google-explicit-constructor): a real number is one
    ComplexWord(const S& x, const S& y) : real(x), imag(y) {}
    explicit ComplexWord(const std::complex<double>& z) : real(z.real()), imag(z.imag()) {}
    explicit operator std::complex<double>() const { return {static_cast<double>(real), static_cast<double>(imag)}; }

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
    /// Scaled by Smith's rule, so that the square of the divisor does not leave the range.
    friend ComplexWord operator/(const ComplexWord& x, const ComplexWord& y) {
        if (abs(y.real) < abs(y.imag)) {
            const S r = y.real / y.imag, size = y.imag + y.real * r;
            return {(x.real * r + x.imag) / size, (x.imag * r - x.real) / size};
        }
        const S r = y.imag / y.real, size = y.real + y.imag * r;
        return {(x.real + x.imag * r) / size, (x.imag - x.real * r) / size};
    }
    /// Its size, to some ulp of double.
    friend double size_of(const ComplexWord& x) { return std::abs(std::complex<double>(x)); }
};

/// A disc in the complex plane: all numbers within `radius` of `centre`. Every operation returns a disc that holds what
/// comes of any numbers of its operands, rounding included. Discs, unlike rectangles, do not grow by being turned.
struct Disc {
    ComplexWord centre{};
    double radius = 0;

    Disc() = default;
    Disc(const ComplexWord& z, double r = 0) : centre(z), radius(r) {}  // NOLINT(google-explicit-constructor)
    Disc(const DoubleWord<double>& x) : centre(x) {}                    // NOLINT(google-explicit-constructor)

    /// Error of one complex operation relative to the sizes that enter it (2 to 7 operations a component), and the
    /// inflation that takes in the rounding of radii.
    static double unit() { return 16 * operation_error<DoubleWord<double>>(); }
    static double inflated(double radius) { return radius * (1 + 32 * epsilon<double>()) + 1e-300; }

    friend Disc operator-(const Disc& x) { return {-x.centre, x.radius}; }
    friend Disc operator+(const Disc& x, const Disc& y) {
        return {x.centre + y.centre, inflated(x.radius + y.radius + unit() * (size_of(x.centre) + size_of(y.centre)))};
    }
    friend Disc operator-(const Disc& x, const Disc& y) { return x + (-y); }
    friend Disc operator*(const Disc& x, const Disc& y) {
        const double a = size_of(x.centre), b = size_of(y.centre);
        return {x.centre * y.centre, inflated(a * y.radius + b * x.radius + x.radius * y.radius + unit() * (a * b))};
    }
    /// Infinite where y may be 0.
    friend Disc operator/(const Disc& x, const Disc& y) {
        const double a = size_of(x.centre), b = size_of(y.centre) * (1 - 8 * epsilon<double>());
        const double least = b - y.radius;
        if (!(least > 0)) return {ComplexWord(DoubleWord<double>(0.0)), std::numeric_limits<double>::infinity()};
        return {x.centre / y.centre, inflated((a / b * y.radius + x.radius) / least + unit() * (a / b))};
    }
};

}  // namespace revchain::pencil
