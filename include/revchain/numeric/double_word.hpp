// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <compare>
#include <limits>
#include <type_traits>

#include "revchain/numeric/scalar.hpp"
#include "revchain/numeric/word.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// An unevaluated sum high + low with |low| <= ulp(high)/2: twice the digits of T. (No maintained
/// header-only library offers one without Boost.) Relative error of one operation (u = epsilon/2):
/// + and - 3u^2, * 5u^2, / 15u^2, up to terms in u^3. `operation_error<DoubleWord<T>>()` is at
/// least twice that, for compilers that contract a product and a sum into one fused operation.
/// Valid while no low part underflows. Algorithms 4, 6, 9, 12, 15 and 17 of Joldes, Muller, Popescu
/// (2017), doi:10.1145/3121432.
template <Word T>
struct DoubleWord {
    static_assert(std::numeric_limits<Lane<T>>::is_iec559,
                  "double words need correctly rounded sums");
    T high{};
    T low{};

    constexpr DoubleWord() = default;
    [[gnu::always_inline]] constexpr DoubleWord(const T& x)
        : high(x) {}  // NOLINT(google-explicit-constructor): a T is a DoubleWord
    template <class Number>
    requires(std::is_arithmetic_v<Number>&& std::numeric_limits<Number>::digits <=
             std::numeric_limits<T>::digits) constexpr DoubleWord(Number x)
        : high(static_cast<T>(x)) {}  // NOLINT(google-explicit-constructor)
    [[gnu::always_inline]] constexpr DoubleWord(const T& h, const T& l) : high(h), low(l) {}
    [[gnu::always_inline]] constexpr explicit operator T() const { return high; }

    friend constexpr bool operator==(const DoubleWord& x, const DoubleWord& y) = default;
    friend constexpr auto operator<=>(const DoubleWord& x,
                                      const DoubleWord& y) =
        default;  // NOLINT(modernize-use-nullptr)
    friend constexpr DoubleWord operator-(const DoubleWord& x) { return {-x.high, -x.low}; }
};

/// Returns x + y = high + low exactly (Knuth).
template <Word T>
[[gnu::always_inline]] constexpr DoubleWord<T> two_sum(const T& x_given, const T& y_given) {
    const T x = detail::rounded(x_given), y = detail::rounded(y_given);
    const T s = x + y;
    const T v = s - x;
    return {s, (x - (s - v)) + (y - v)};
}

/// Returns x + y = high + low exactly, for |x| >= |y| or x = 0 (Dekker).
template <Word T>
[[gnu::always_inline]] constexpr DoubleWord<T> fast_two_sum(const T& x_given, const T& y_given) {
    const T x = detail::rounded(x_given), y = detail::rounded(y_given);
    const T s = x + y;
    return {s, y - (s - x)};
}

namespace detail {
template <class T>
inline constexpr bool has_fast_fma =
#if (defined(__FP_FAST_FMA) && defined(__FP_FAST_FMAF)) || defined(__FMA__)
    std::is_same_v<T, double> || std::is_same_v<T, float>;
#else
    false;
#endif
}  // namespace detail

/// Returns x y = high + low exactly, if x y 2^-digits is normal and |x|, |y| are below half the
/// largest number. `fused` uses one fused multiply-add, which must be an instruction of the target,
/// because a library call is slower than Dekker's product. Dekker's product is used otherwise, and
/// is right on every target. It cuts halves of float and double from the bits, so all their
/// products are exact and may be fused with sums. Only long double uses Veltkamp's split, which
/// fusing would spoil.
template <bool fused, Word T>
[[gnu::always_inline]] inline DoubleWord<T> two_product(const T& x, const T& y) {
    const T p = detail::rounded(T(x * y));
    if constexpr (fused && IsPack<T>) {
        return {p, multiply_subtract(x, y, p)};
    } else if constexpr (fused) {
        return {p, std::fma(x, y, -p)};
    } else {
        const T xh = upper_half(x), yh = upper_half(y);
        const T xl = x - xh, yl = y - yh;
        return {p, ((xh * yh - p) + xh * yl + xl * yh) + xl * yl};
    }
}

/// Returns x y = high + low, fused if the whole program is compiled for fused multiply-add.
template <Word T>
[[gnu::always_inline]] inline DoubleWord<T> two_product(const T& x, const T& y) {
    return two_product<detail::has_fast_fma<Lane<T>>, T>(x, y);
}

template <Word T>
[[gnu::always_inline]] constexpr DoubleWord<T> operator+(const DoubleWord<T>& x,
                                                         const DoubleWord<T>& y) {
    const DoubleWord<T> s = two_sum(x.high, y.high);
    const DoubleWord<T> t = two_sum(x.low, y.low);
    const DoubleWord<T> v = fast_two_sum(s.high, s.low + t.high);
    return fast_two_sum(v.high, t.low + v.low);
}

template <Word T>
[[gnu::always_inline]] constexpr DoubleWord<T> operator+(const DoubleWord<T>& x,
                                                         const std::type_identity_t<T>& y) {
    const DoubleWord<T> s = two_sum(x.high, y);
    return fast_two_sum(s.high, x.low + s.low);
}

template <Word T>
[[gnu::always_inline]] constexpr DoubleWord<T> operator-(const DoubleWord<T>& x,
                                                         const DoubleWord<T>& y) {
    return x + (-y);
}

template <Word T>
[[gnu::always_inline]] constexpr DoubleWord<T> operator-(const DoubleWord<T>& x,
                                                         const std::type_identity_t<T>& y) {
    return x + (-y);
}

template <Word T>
[[gnu::always_inline]] inline DoubleWord<T> operator*(const DoubleWord<T>& x,
                                                      const DoubleWord<T>& y) {
    const DoubleWord<T> p = two_product(x.high, y.high);
    return fast_two_sum(p.high, p.low + (x.low * y.low + x.high * y.low + x.low * y.high));
}

template <Word T>
[[gnu::always_inline]] inline DoubleWord<T> operator*(const DoubleWord<T>& x,
                                                      const std::type_identity_t<T>& y) {
    const DoubleWord<T> p = two_product(x.high, y);
    return fast_two_sum(p.high, p.low + x.low * y);
}

template <Word T>
[[gnu::always_inline]] inline DoubleWord<T> operator/(const DoubleWord<T>& x,
                                                      const DoubleWord<T>& y) {
    const T q = x.high / y.high;
    const DoubleWord<T> r = y * q;
    return fast_two_sum(q, ((x.high - r.high) + (x.low - r.low)) / y.high);
}

template <std::floating_point T>
inline DoubleWord<T> abs(const DoubleWord<T>& x) {
    return x.high < T(0) || (x.high == T(0) && x.low < T(0)) ? -x : x;
}

template <std::floating_point T>
inline DoubleWord<T> ldexp(const DoubleWord<T>& x, int exponent) {
    return {std::ldexp(x.high, exponent), std::ldexp(x.low, exponent)};
}

template <std::floating_point T>
inline DoubleWord<T> frexp(const DoubleWord<T>& x, int* exponent) {
    const T high = std::frexp(x.high, exponent);
    return {high, std::ldexp(x.low, -*exponent)};
}

template <std::floating_point T>
inline bool isfinite(const DoubleWord<T>& x) {
    return std::isfinite(x.high) && std::isfinite(x.low);
}

/// Returns true if x is finite and its low part is at most the rounding error of the sum.
template <std::floating_point T>
inline bool is_normalised(const DoubleWord<T>& x) {
    return std::isfinite(x.high) && x.high + x.low == x.high;
}

/// Returns the square root by one Newton step from the root of the high part.
template <std::floating_point T>
inline DoubleWord<T> sqrt(const DoubleWord<T>& x) {
    const T s = std::sqrt(x.high);
    if (!(s > T(0))) return DoubleWord<T>(s);
    const DoubleWord<T> rest = x - two_product(s, s);
    return fast_two_sum(s, rest.high / (s + s));
}

template <IsPack V>
[[gnu::always_inline]] inline DoubleWord<V> if_less(const V& x, const V& y, const DoubleWord<V>& a,
                                                    const DoubleWord<V>& b) {
    return {if_less(x, y, a.high, b.high), if_less(x, y, a.low, b.low)};
}

namespace detail {

/// Returns x in every lane of a pack.
template <IsPack V>
[[gnu::always_inline]] inline DoubleWord<V> in_all_lanes(const DoubleWord<Lane<V>>& x) {
    return {V(x.high), V(x.low)};
}

template <class T>
struct Wider : std::type_identity<T> {};
template <>
struct Wider<float> : std::type_identity<double> {};
template <>
struct Wider<double> : std::type_identity<DoubleWord<double>> {};
template <>
struct Wider<long double> : std::type_identity<DoubleWord<long double>> {};

template <class S>
inline constexpr bool is_double_word = false;
template <class T>
inline constexpr bool is_double_word<DoubleWord<T>> = true;

template <class S>
struct Narrower : std::type_identity<S> {};
template <class T>
struct Narrower<DoubleWord<T>> : std::type_identity<T> {};
}  // namespace detail

/// The arithmetic in which results in T are certified: double for float, a double word for double
/// and long double. For other types it is T, and bounds then grow with the number of links.
template <class T>
using Wide = typename detail::Wider<T>::type;

/// The type of sizes and errors of numbers of type S: T for a double word of T, else S.
template <class S>
using Narrow = typename detail::Narrower<S>::type;

/// Returns true if x is finite and, if it is a double word, normalised.
template <Real S>
bool is_normalised(const S& x) {
    using std::isfinite;
    return isfinite(x);
}

/// Returns a bound on the relative error of one operation + - * / in S.
template <class S>
constexpr Narrow<S> operation_error() {
    return static_cast<Narrow<S>>(std::numeric_limits<S>::epsilon()) / Narrow<S>(2);
}

}  // namespace revchain

template <std::floating_point T>
struct std::numeric_limits<revchain::DoubleWord<T>> : std::numeric_limits<T> {
    static constexpr int digits = 2 * std::numeric_limits<T>::digits;
    static constexpr int digits10 = (digits - 1) * 30103 / 100000;
    static constexpr int max_digits10 = 2 + digits * 30103 / 100000;
    static constexpr bool is_iec559 = false;
    static constexpr revchain::DoubleWord<T> min() { return std::numeric_limits<T>::min(); }
    static constexpr revchain::DoubleWord<T> max() { return std::numeric_limits<T>::max(); }
    static constexpr revchain::DoubleWord<T> lowest() { return std::numeric_limits<T>::lowest(); }
    static constexpr revchain::DoubleWord<T> infinity() {
        return std::numeric_limits<T>::infinity();
    }
    static constexpr revchain::DoubleWord<T> quiet_NaN() {
        return std::numeric_limits<T>::quiet_NaN();
    }
    /// Returns 64 u^2: four times the bound of the least accurate operation, division.
    static constexpr revchain::DoubleWord<T> epsilon() {
        return std::numeric_limits<T>::epsilon() * std::numeric_limits<T>::epsilon() * T(16);
    }
};
