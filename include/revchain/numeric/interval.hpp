// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>

#include "revchain/numeric/double_word.hpp"

/// Interval arithmetic for proofs. Results are rounded to nearest and widened by three times the
/// error of one operation, so they hold without directed rounding, with or without contraction.
/// Libraries that switch the rounding mode (Boost.Numeric.Interval) need -frounding-math in the
/// user's program. Where the lost digit and a half matters, wider numbers are used.
namespace revchain::inline REVCHAIN_BUILD {

/// An interval, low <= number <= high. The ends are NaN if nothing is known (an overflow), so
/// comparisons fail. If T is a pack, each lane holds an interval (simd/interval_lanes.hpp).
template <class T>
requires(Real<T> || IsPack<T>) struct Interval {
    T low{}, high{};

    [[gnu::always_inline]] constexpr Interval() = default;
    [[gnu::always_inline]] constexpr Interval(const T& x)
        : low(x), high(x) {}  // NOLINT(google-explicit-constructor): a T is an interval
    [[gnu::always_inline]] constexpr Interval(const T& l, const T& h) : low(l), high(h) {}

    bool positive() const { return low > T(0); }
    bool negative() const { return high < T(0); }
    /// Returns true if the number may be 0, also if nothing is known.
    bool may_vanish() const { return !(positive() || negative()); }
    bool contains(const T& x) const { return low <= x && x <= high; }
    /// Returns 1 or -1, or 0 if the number may vanish.
    int sign() const { return positive() ? 1 : negative() ? -1 : 0; }
    /// Returns the largest absolute value; NaN if an end is NaN.
    T size() const {
        using std::abs;
        const T a = abs(low), b = abs(high);
        return !(a == a) || a > b ? a : b;
    }
    [[gnu::always_inline]] T width() const { return high - low; }
    [[gnu::always_inline]] T middle() const { return low + (high - low) / T(2); }

    [[gnu::always_inline]] friend Interval operator-(const Interval& x) {
        return {-x.high, -x.low};
    }
};

namespace detail {

/// The bound on the absolute error from underflow: at most five roundings by the smallest number.
template <Real T>
inline constexpr auto underflow = 16 * std::numeric_limits<T>::denorm_min();

/// These return bounds, from below and from above, of an exact result that was rounded to x.
template <Real T>
T down(const T& x) {
    using std::abs;
    return x - (abs(x) * (T(3) * operation_error<T>()) + underflow<T>);
}
template <Real T>
T up(const T& x) {
    using std::abs;
    return x + (abs(x) * (T(3) * operation_error<T>()) + underflow<T>);
}

/// Returns an interval that holds x and whose ends are 0 or at least 2^-960. (Quotients and roots
/// of smaller double words lose digits. Other scalars are rounded correctly.)
template <Real T>
Interval<T> without_faint_ends(const Interval<T>& x) {
    if constexpr (std::numeric_limits<T>::is_iec559) {
        return x;
    } else {
        const T least(0x1p-960), zero(0);
        return {-least < x.low && x.low < least ? (x.low < zero ? T(-least) : zero) : x.low,
                -least < x.high && x.high < least ? (x.high > zero ? least : zero) : x.high};
    }
}

inline Interval<Wide<double>> around(const Wide<double>& x, double error) {
    using S = Wide<double>;
    return {x - S(error), x + S(error)};
}

}  // namespace detail

template <Real T>
Interval<T> operator+(const Interval<T>& x, const Interval<T>& y) {
    return {detail::down(T(x.low + y.low)), detail::up(T(x.high + y.high))};
}
template <Real T>
Interval<T> operator-(const Interval<T>& x, const Interval<T>& y) {
    return {detail::down(T(x.low - y.high)), detail::up(T(x.high - y.low))};
}
template <Real T>
Interval<T> operator*(const Interval<T>& x, const Interval<T>& y) {
    if (x.low >= T(0)) {
        const T low = y.low < T(0) ? x.high * y.low : x.low * y.low;
        const T high = y.high < T(0) ? x.low * y.high : x.high * y.high;
        return {detail::down(low), detail::up(high)};
    }
    if (y.low >= T(0)) return y * x;
    const T a = x.low * y.low, b = x.low * y.high, c = x.high * y.low, d = x.high * y.high;
    if (!(a == a && b == b && c == c && d == d)) return {a + b + c + d, a + b + c + d};  // NaN
    return {detail::down(std::min(std::min(a, b), std::min(c, d))),
            detail::up(std::max(std::max(a, b), std::max(c, d)))};
}
/// Returns the quotient; NaN unless y excludes 0, and where it is empty.
template <Real T>
Interval<T> operator/(const Interval<T>& dividend, const Interval<T>& y) {
    if (y.negative() && !y.positive()) return -dividend / -y;
    const Interval<T> x = detail::without_faint_ends(dividend);
    if (!y.positive() || y.negative())
        return {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::quiet_NaN()};
    const T low = x.low < T(0) ? x.low / y.low : x.low / y.high;
    const T high = x.high < T(0) ? x.high / y.high : x.high / y.low;
    return {detail::down(low), detail::up(high)};
}
template <Real T>
Interval<T> square(const Interval<T>& x) {
    using std::abs;
    const T a = abs(x.low), b = abs(x.high), high = x.size();
    const T low = x.may_vanish() ? T(0) : std::min(a, b);
    return {std::max(T(0), detail::down(T(low * low))), detail::up(T(high * high))};
}
/// Returns the root of a number that is not negative.
template <Real T>
Interval<T> sqrt(const Interval<T>& radicand) {
    using std::sqrt;
    const Interval<T> x = detail::without_faint_ends(radicand);
    return {std::max(T(0), detail::down(T(sqrt(std::max(T(0), x.low))))),
            detail::up(T(sqrt(x.high)))};
}

/// Returns the intersection of two intervals that hold the same number.
template <Real T>
Interval<T> common(const Interval<T>& x, const Interval<T>& y) {
    return {x.low > y.low || !(y.low == y.low) ? x.low : y.low,
            x.high < y.high || !(y.high == y.high) ? x.high : y.high};
}
/// Returns the smallest interval that contains both. An end is NaN if that end of x or of y is NaN.
template <Real T>
Interval<T> hull(const Interval<T>& x, const Interval<T>& y) {
    return {!(x.low == x.low) || x.low < y.low ? x.low : y.low,
            !(x.high == x.high) || x.high > y.high ? x.high : y.high};
}

}  // namespace revchain
