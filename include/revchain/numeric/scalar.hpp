// SPDX-License-Identifier: MPL-2.0
#pragma once

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(_M_FP_FAST) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "revchain: -ffast-math (/fp:fast) breaks bounds and counts; compile without it (-O3 is fine)"
#endif
#if defined(__FLT_EVAL_METHOD__) && (__FLT_EVAL_METHOD__ == 1 || __FLT_EVAL_METHOD__ == 2)
#error "revchain: excess precision (x87) breaks error bounds; compile with -msse2 -mfpmath=sse"
#endif

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD {

using Index = Eigen::Index;

namespace detail {
/// The number pi to the last digit of T; libc++ 14 has the value of double for long double.
template <class T>
inline constexpr T pi = std::numbers::pi_v<T>;
template <>
inline constexpr long double pi<long double> = 3.14159265358979323846264338327950288L;

// These functions of a scalar, besides its operators, are found in std or next to the type.
using std::abs, std::frexp, std::isfinite, std::ldexp, std::sqrt;
template <class T>
concept HasRealFunctions = requires(T x, int* exponent) {
    { abs(x) } -> std::convertible_to<T>;
    { sqrt(x) } -> std::convertible_to<T>;
    { ldexp(x, 1) } -> std::convertible_to<T>;
    { frexp(x, exponent) } -> std::convertible_to<T>;
    { isfinite(x) } -> std::convertible_to<bool>;
};
}  // namespace detail

/// A binary floating-point scalar: float, double, long double, or any type with the same operators,
/// `std::numeric_limits`, and `abs`, `sqrt`, `ldexp`, `frexp`, `isfinite` found next to the type.
template <class T>
concept Real =
    std::numeric_limits<T>::is_specialized && !std::numeric_limits<T>::is_integer &&
    std::numeric_limits<T>::radix == 2 && detail::HasRealFunctions<T> && requires(T x, T y) {
    { x + y } -> std::convertible_to<T>;
    { x - y } -> std::convertible_to<T>;
    { x* y } -> std::convertible_to<T>;
    { x / y } -> std::convertible_to<T>;
    { -x } -> std::convertible_to<T>;
    { x < y } -> std::convertible_to<bool>;
    { x == y } -> std::convertible_to<bool>;
    T(1);
    T(0.5);
};

// Results hold the next two types, whose memory comes from `malloc`, whatever the compiler's flags.
// How Eigen allocates other matrices depends on the instruction set.

/// A column of numbers.
template <class T>
using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1, Eigen::DontAlign>;

/// A table of numbers, one row per item (row-major, like numpy).
template <class T>
using Table = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor | Eigen::DontAlign>;

/// A square matrix. Of public types only `RecurrencePencil` and `Deviation` hold one.
template <class T>
using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

/// Returns the gap from 1 to the next number, 2^-52 for double. An "ulp" is a relative `epsilon`.
template <Real T>
inline T epsilon() {
    return std::numeric_limits<T>::epsilon();
}

}  // namespace revchain
