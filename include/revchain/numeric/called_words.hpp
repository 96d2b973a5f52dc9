// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <complex>

#include "revchain/numeric/double_double.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// A DoubleDouble for dense matrices of Eigen, whose operations are function calls. GCC inlines
/// those of DoubleDouble at hundreds of places of Eigen's solvers: with them
/// src/compiled/stability.cpp takes four times as long to compile. Calls make an operation slower,
/// 1.4 times in `modes`.
class CalledWords : public DoubleDouble {
   public:
    using DoubleDouble::DoubleDouble;
    CalledWords() = default;
    constexpr CalledWords(const DoubleDouble& x) : DoubleDouble(x) {}  // NOLINT: the same number

    [[gnu::noinline]] friend CalledWords operator+(CalledWords x, CalledWords y) {
        return words(x) + words(y);
    }
    [[gnu::noinline]] friend CalledWords operator-(CalledWords x, CalledWords y) {
        return words(x) - words(y);
    }
    [[gnu::noinline]] friend CalledWords operator*(CalledWords x, CalledWords y) {
        return words(x) * words(y);
    }
    [[gnu::noinline]] friend CalledWords operator/(CalledWords x, CalledWords y) {
        return words(x) / words(y);
    }
    friend CalledWords operator-(const CalledWords& x) { return -words(x); }
    CalledWords& operator+=(const CalledWords& y) { return *this = *this + y; }
    CalledWords& operator-=(const CalledWords& y) { return *this = *this - y; }
    CalledWords& operator*=(const CalledWords& y) { return *this = *this * y; }
    CalledWords& operator/=(const CalledWords& y) { return *this = *this / y; }

    friend CalledWords abs(const CalledWords& x) { return abs(words(x)); }
    [[gnu::noinline]] friend CalledWords sqrt(const CalledWords& x) { return sqrt(words(x)); }
    friend bool isinf(const CalledWords& x) { return std::isinf(x.high()); }
    friend bool isnan(const CalledWords& x) { return std::isnan(x.high()); }

   private:
    static const DoubleDouble& words(const CalledWords& x) { return x; }
};

/// These are products and quotients of complex numbers of two words, also for Eigen. The standard
/// does not specify std::complex's operators for such scalars, and those of libc++ do not compile.
inline std::complex<CalledWords> operator*(const std::complex<CalledWords>& x,
                                           const std::complex<CalledWords>& y) {
    return {x.real() * y.real() - x.imag() * y.imag(), x.real() * y.imag() + x.imag() * y.real()};
}
inline std::complex<CalledWords> operator/(const std::complex<CalledWords>& x,
                                           const std::complex<CalledWords>& y) {
    const CalledWords size = y.real() * y.real() + y.imag() * y.imag();
    return {(x.real() * y.real() + x.imag() * y.imag()) / size,
            (x.imag() * y.real() - x.real() * y.imag()) / size};
}

}  // namespace revchain::detail

template <>
struct std::numeric_limits<revchain::detail::CalledWords>
    : std::numeric_limits<revchain::DoubleDouble> {};

template <>
struct Eigen::NumTraits<revchain::detail::CalledWords>
    : Eigen::GenericNumTraits<revchain::detail::CalledWords> {
    enum { ReadCost = 2, AddCost = 20, MulCost = 20 };
};
