// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/links.hpp"

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

using detail::down;
using detail::up;

/// The largest value of t (1+t^2)^-5/2, at t = 1/2: (1/2)(5/4)^(-5/2) = 0.28621670111997307...
inline constexpr double steepest_half_bend = 0.2862167011199732;

/// Encloses the sine of the inclination of tangent t, and its derivatives by t, for t in an
/// interval. Each has its extremes at an end of the interval or where the next derivative is 0.
template <class T>
struct Sine {
    Interval<T> value, slope, half_bend;  // s, (1+t^2)^-3/2, t (1+t^2)^-5/2 = -s''/3

    explicit Sine(const Interval<T>& t) {
        using std::abs;
        const Interval<T> one(T(1));
        const auto at = [&](const T& x) {  // returns sine and cosine
            if (is_horizontal(x)) {        // the sine is 1 to the last digit; x^2 may overflow
                const Interval<T> sine(down(T(1)), T(1));
                return std::pair(x < T(0) ? -sine : sine, one / Interval<T>(abs(x)));
            }
            const Interval<T> tangent(x), secant = sqrt(one + square(tangent));
            return std::pair(tangent / secant, one / secant);
        };
        if (!(t.low <= t.high)) {
            value = slope = half_bend = Interval<T>(std::numeric_limits<T>::quiet_NaN());
            return;
        }
        const auto [low, c0] = at(t.low);
        const auto [high, c1] = t.low == t.high ? std::pair(low, c0) : at(t.high);
        value = {low.low, high.high};
        const Interval<T> g0 = c0 * square(c0), g1 = c1 * square(c1);
        slope = hull(g0, g1);
        if (t.low < T(0) && t.high > T(0)) slope.high = T(1);
        const Interval<T> b0 = low * square(square(c0)), b1 = high * square(square(c1));
        half_bend = hull(b0, b1);
        const T half = T(1) / T(2);
        if (t.contains(half)) half_bend.high = T(steepest_half_bend);
        if (t.contains(-half)) half_bend.low = T(-steepest_half_bend);
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

/// Returns the tangent under the load R by Newton's method. It starts at t, on a side from which
/// the method does not overshoot.
template <class S>
S tangent_from(S t, const S& stiffness, const S& turning, const S& R) {
    using std::abs;
    for (int round = 0; round < 100; ++round) {
        const S cosine = cosine_at(t), slope = stiffness + turning * cosine * cosine * cosine;
        const S step = (R - stiffness * t - turning * t * cosine) / slope;
        t = t + step;
        if (!(abs(step) > S(4) * epsilon<S>() * abs(t))) break;
    }
    return t;
}

/// Returns the tangent under the load R. It requires stiffness + min(0, turning) > 0, so that the
/// load increases with the tangent.
template <class S>
S tangent_of(const S& stiffness, const S& turning, const S& R) {
    if (is_zero(turning)) return R / stiffness;
    const S slope = turning > S(0) ? stiffness + turning : stiffness;
    return tangent_from(S(R / slope), stiffness, turning, R);
}

/// Returns the first of t, t + step, t + 3 step, t + 7 step, ... to pass a test; NaN after `tries`.
template <class T, class Test>
T first_passing(T t, T step, int tries, const Test& passes) {
    for (int round = 0; round < tries; ++round, step = step * T(2)) {
        if (passes(t)) return t;
        t = t + step;
    }
    return std::numeric_limits<T>::quiet_NaN();
}
/// Returns the first step away from a tangent that Newton's method found.
template <class T>
T rounding_step(const T& t) {
    using std::abs;
    return T(2) * epsilon<T>() * abs(t) + std::numeric_limits<T>::denorm_min();
}

/// Encloses the tangents under the loads R, for a stiffness of any width; NaN if no bound is found.
template <Real T>
Interval<T> tangent_of(const Interval<T>& stiffness, const Interval<T>& turning,
                       const Interval<T>& R) {
    if (is_zero(turning)) return R / stiffness;
    const bool wide = stiffness.width() > T(16) * epsilon<T>() * stiffness.low;
    const auto near = [&](const T& load, const T& steepest) {
        return tangent_of(wide ? steepest : stiffness.middle(), turning.middle(), load);
    };
    const T low = near(R.low, R.low < T(0) ? stiffness.low : stiffness.high);
    const T high = !wide && R.low == R.high
                       ? low
                       : near(R.high, R.high < T(0) ? stiffness.high : stiffness.low);
    const auto load = [&](const T& t) {
        return stiffness * Interval<T>(t) + turning * sine_at(Interval<T>(t));
    };
    constexpr int tries = 41;
    return {first_passing(low, T(-rounding_step(low)), tries,
                          [&](const T& t) { return load(t).high <= R.low; }),
            first_passing(high, rounding_step(high), tries,
                          [&](const T& t) { return load(t).low >= R.high; })};
}

}  // namespace revchain::finite
