// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/numeric/interval.hpp"
#include "revchain/simd/pack.hpp"

/// Intervals side by side, one in each lane of two packs, as for numbers (numeric/interval.hpp) but
/// without branches. The ends are NaN in a lane where nothing is known.
namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

template <IsPack V>
[[gnu::always_inline]] inline V margin(const V& x) {
    using T = Lane<V>;
    return abs(x) * V(T(3) * operation_error<T>()) + V(underflow<T>);
}
template <IsPack V>
[[gnu::always_inline]] inline V down(const V& x) {
    return x - margin(x);
}
template <IsPack V>
[[gnu::always_inline]] inline V up(const V& x) {
    return x + margin(x);
}
/// Returns 0, or NaN where x is not finite.
template <IsPack V>
[[gnu::always_inline]] inline V unknown(const V& x) {
    return x - x;
}

}  // namespace detail

template <IsPack V>
[[gnu::always_inline]] inline Interval<V> operator+(const Interval<V>& x, const Interval<V>& y) {
    return {detail::down(x.low + y.low), detail::up(x.high + y.high)};
}
template <IsPack V>
[[gnu::always_inline]] inline Interval<V> operator-(const Interval<V>& x, const Interval<V>& y) {
    return {detail::down(x.low - y.high), detail::up(x.high - y.low)};
}
template <IsPack V>
[[gnu::always_inline]] inline Interval<V> operator*(const Interval<V>& x, const Interval<V>& y) {
    const V a = x.low * y.low, b = x.low * y.high, c = x.high * y.low, d = x.high * y.high;
    const V open = detail::unknown((a + b) + (c + d));
    return {detail::down(min(min(a, b), min(c, d)) + open),
            detail::up(max(max(a, b), max(c, d)) + open)};
}
/// Returns the quotient; NaN unless y is positive.
template <IsPack V>
[[gnu::always_inline]] inline Interval<V> operator/(const Interval<V>& x, const Interval<V>& y) {
    const V zero(0),
        open = if_less(zero, y.low, zero, V(std::numeric_limits<Lane<V>>::quiet_NaN()));
    return {detail::down(x.low / if_less(x.low, zero, y.low, y.high) + open),
            detail::up(x.high / if_less(x.high, zero, y.high, y.low) + open)};
}
template <IsPack V>
[[gnu::always_inline]] inline Interval<V> square(const Interval<V>& x) {
    const V zero(0), a = x.low * x.low, b = x.high * x.high, open = detail::unknown(a + b);
    const V least = if_less(zero, x.low, a, if_less(x.high, zero, b, zero));
    return {max(detail::down(least), zero) + open, detail::up(max(a, b) + open)};
}
/// Returns the root of a positive number.
template <IsPack V>
[[gnu::always_inline]] inline Interval<V> sqrt(const Interval<V>& x) {
    return {detail::down(root(x.low)), detail::up(root(x.high))};
}
template <IsPack V>
[[gnu::always_inline]] inline Interval<V> common(const Interval<V>& x, const Interval<V>& y) {
    return {select(equal(y.low, y.low), if_less(y.low, x.low, x.low, y.low), x.low),
            select(equal(y.high, y.high), if_less(x.high, y.high, x.high, y.high), x.high)};
}
template <IsPack V>
[[gnu::always_inline]] inline Interval<V> hull(const Interval<V>& x, const Interval<V>& y) {
    return {min(x.low, y.low) + detail::unknown(x.low + y.low),
            max(x.high, y.high) + detail::unknown(x.high + y.high)};
}

}  // namespace revchain
