// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include "revchain/finite/balance/links.hpp"
#include "revchain/numeric/compiled.hpp"

/// The equation of one link, lambda pull t + length cross s(t) = R, with t the tangent and s the
/// sine of its inclination. `stiffness` is lambda pull, `turning` is length cross.
namespace revchain::inline REVCHAIN_BUILD::finite {

template <class S>
bool is_zero(const S& x) {
    return x == S(0);
}
template <Real T>
bool is_zero(const Interval<T>& x) {
    return x.low == T(0) && x.high == T(0);
}

template <class S>
bool is_positive(const S& x) {
    return x > S(0);
}
template <Real T>
bool is_positive(const Interval<T>& x) {
    return x.positive();
}

/// Returns length times cross, exactly 0 for a plummet: a product of intervals would be wider.
template <class S>
S turning_of(const Link<S>& link) {
    return is_zero(link.cross) ? link.cross : link.length * link.cross;
}

/// The largest value of t (1+t^2)^-5/2, at t = 1/2: (1/2)(5/4)^(-5/2) = 0.28621670111997307...
inline constexpr double steepest_half_bend = 0.2862167011199732;

/// Define `any` and `if_less` for numbers, so that templates can use numbers and packs alike.
REVCHAIN_LAZY
bool any(bool yes) { return yes; }
template <Real T>
const T& if_less(const T& x, const T& y, const T& a, const T& b) {
    return x < y ? a : b;
}

/// Returns enclosures of the sine and the cosine of the inclination of one tangent. Packs need only
/// one division, for a sine one ulp wider, and have no branch for a tangent with a large square.
template <class T>
[[gnu::always_inline]] inline std::array<Interval<T>, 2> sine_and_cosine(const T& x) {
    using std::abs;
    const Interval<T> tangent(x), one(T(1));
    if constexpr (IsPack<T>) {
        const Interval<T> cosine = one / sqrt(one + square(tangent));
        return {tangent * cosine, cosine};
    } else {
        if (is_horizontal(x)) {  // the sine is 1 to the last digit
            const Interval<T> sine(detail::down(T(1)), T(1));
            return {x < T(0) ? -sine : sine, one / Interval<T>(abs(x))};
        }
        const Interval<T> secant = sqrt(one + square(tangent));
        return {tangent / secant, one / secant};
    }
}

/// Encloses the sine of the inclination of tangent t, and its derivatives by t, for t in an
/// interval. Each has its extremes at an end of the interval or where the next derivative is 0.
template <class T>
struct Sine {
    Interval<T> value, slope, half_bend;  // s, (1+t^2)^-3/2, t (1+t^2)^-5/2 = -s''/3

    explicit Sine(const Interval<T>& t) {
        const T zero(0), one(1), half(0.5), steepest(steepest_half_bend);
        bool is_point = false;
        if constexpr (!IsPack<T>) {
            if (!(t.low <= t.high)) {
                value = slope = half_bend = Interval<T>(std::numeric_limits<T>::quiet_NaN());
                return;
            }
            is_point = t.low == t.high;
        }
        const auto [low, c0] = sine_and_cosine(t.low);
        const auto [high, c1] = is_point ? std::array{low, c0} : sine_and_cosine(t.high);
        value = {low.low, high.high};
        const Interval<T> squared0 = square(c0), squared1 = square(c1);
        slope = hull(c0 * squared0, c1 * squared1);
        slope.high = if_less(t.low, zero, if_less(zero, t.high, one, slope.high), slope.high);
        half_bend = hull(low * square(squared0), high * square(squared1));
        half_bend.high =
            if_less(half, t.low, half_bend.high, if_less(t.high, half, half_bend.high, steepest));
        half_bend.low =
            if_less(-half, t.low, half_bend.low, if_less(t.high, -half, half_bend.low, -steepest));
    }
};

template <class S>
S sine_at(const S& tangent) {
    return tangent * cosine_at(tangent);
}
template <Real T>
Interval<T> sine_at(const Interval<T>& tangent) {
    return Sine<T>(tangent).value;
}

/// Returns the tangent under the load R by Newton's method. It starts at `start`, on a side from
/// which the method does not overshoot.
template <class S>
[[gnu::always_inline]] inline S tangent_from(const S& start, const S& stiffness, const S& turning,
                                             const S& R) {
    using std::abs;
    S t = start;
    for (int round = 0; round < 100; ++round) {
        const S cosine = cosine_at(t), slope = stiffness + turning * cosine * cosine * cosine;
        const S step = (R - stiffness * t - turning * t * cosine) / slope;
        t = t + step;
        if (!any(abs(step) > S(4) * S(epsilon<Lane<S>>()) * abs(t))) break;
    }
    return t;
}

/// Returns the tangent under the load R of a link other than a plummet. It requires stiffness +
/// min(0, turning) > 0, so that the load increases with the tangent.
template <class S>
[[gnu::always_inline]] inline S tangent_of(const S& stiffness, const S& turning, const S& R) {
    const S slope = if_less(S(0), turning, S(stiffness + turning), stiffness);
    return tangent_from(S(R / slope), stiffness, turning, R);
}

/// Returns the first step away from a tangent that Newton's method found.
template <class T>
[[gnu::always_inline]] inline T rounding_step(const T& t) {
    using std::abs;
    using N = Lane<T>;
    return T(1.5) * T(epsilon<N>()) * abs(t) + T(std::numeric_limits<N>::denorm_min());
}

/// Encloses the tangents under the loads R of a link other than a plummet; NaN if no bounds are
/// found. From t, Newton's result, each end is the first of t, t + step, t + 3 step, ... whose load
/// is certainly beyond R. The load is odd in t, so both ends are upper ends.
template <class T>
[[gnu::always_inline]] inline Interval<T> tangent_of(const Interval<T>& stiffness,
                                                     const Interval<T>& turning,
                                                     const Interval<T>& R) {
    const auto upper_end = [&](const T& wanted) REVCHAIN_INLINED {
        T t = tangent_of(if_less(wanted, T(0), stiffness.high, stiffness.low),
                         if_less(wanted, T(0), turning.high, turning.low), wanted);
        T step = rounding_step(t), load(0);
        for (int round = 0; round < 41; ++round, step = step + step) {
            load = (stiffness * Interval<T>(t) + turning * sine_and_cosine(t)[0]).low;
            if (!any(load < wanted)) break;
            t = if_less(load, wanted, T(t + step), t);
        }
        const T nan(std::numeric_limits<Lane<T>>::quiet_NaN());
        return if_less(load, wanted, nan, T(t + (load - load)));
    };
    return {-upper_end(-R.low), upper_end(R.high)};
}

}  // namespace revchain::finite
