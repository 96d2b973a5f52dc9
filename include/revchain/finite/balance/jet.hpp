// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/support_end.hpp"

namespace revchain::finite {

/// A function of x over a cell: what it, its first and its second derivative stay within, and value and slope at the
/// cell's centre.
template <Real T>
struct Jet {
    Interval<T> value, slope, bend, centre_value, centre_slope;

    friend Jet operator+(const Jet& x, const Jet& y) {
        return {x.value + y.value, x.slope + y.slope, x.bend + y.bend, x.centre_value + y.centre_value,
                x.centre_slope + y.centre_slope};
    }
    friend Jet operator-(const Jet& x, const Jet& y) {
        return {x.value - y.value, x.slope - y.slope, x.bend - y.bend, x.centre_value - y.centre_value,
                x.centre_slope - y.centre_slope};
    }
    friend Jet operator*(const Interval<T>& k, const Jet& x) {
        return {k * x.value, k * x.slope, k * x.bend, k * x.centre_value, k * x.centre_slope};
    }
};

/// x itself over low ... high, its centre, and what the mean value theorem needs of it.
template <Real T>
class Cell {
   public:
    Cell(const T& low, const T& high) : range_(low, high) {
        const T centre = range_.middle();
        const Interval<T> off = range_ - Interval<T>(centre);
        using std::max;
        centre_ = Interval<T>(centre);
        const T reach = max(T(-off.low), off.high);
        off_ = {-reach, reach};
        half_square_ = {T(0), revchain::detail::up(T(revchain::detail::up(T(reach * reach)) / T(2)))};
    }
    Jet<T> x() const { return {range_, Interval<T>(T(1)), Interval<T>(T(0)), centre_, Interval<T>(T(1))}; }

    /// The same jet, made narrower by Taylor's formula about the centre, to first and to second order.
    Jet<T> centred(Jet<T> f) const {
        f.slope = common(f.slope, f.centre_slope + f.bend * off_);
        f.value = common(f.value, f.centre_value + f.slope * off_);
        f.value = common(f.value, f.centre_value + f.centre_slope * off_ + f.bend * half_square_);
        return f;
    }

   private:
    Interval<T> range_, centre_, off_, half_square_;
};

namespace detail {
using revchain::detail::down;
using revchain::detail::up;

/// Sine of the inclination whose tangent is t, and its derivatives along t, over an interval of t: each takes its
/// extremes at the ends or where the next derivative turns.
template <Real T>
struct Sine {
    Interval<T> value, slope, half_bend;  // s, (1+t^2)^-3/2, t (1+t^2)^-5/2 = -s''/3

    explicit Sine(const Interval<T>& t) {
        using std::abs;
        const Interval<T> one(T(1));
        const auto at = [&](const T& x) {  // sine and cosine
            if (is_horizontal(x)) {        // 1 to the last digit of T; its square might overflow
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
        // +-(1/2)(5/4)^(-5/2) = +-0.28621670111997307...
        constexpr double turning = 0.2862167011199732;
        if (t.contains(half)) half_bend.high = T(turning);
        if (t.contains(-half)) half_bend.low = T(-turning);
    }
};

/// t with  lambda pull t + length cross s(t) = R,  for pull + min(0, length cross)/lambda > 0, so that it grows with R.
template <Real T>
Interval<T> tangent(const Interval<T>& stiffness, const Interval<T>& turning, const Interval<T>& R) {
    using std::abs;
    const auto f = [&](const T& t) { return stiffness * Interval<T>(t) + turning * Sine<T>(Interval<T>(t)).value; };
    const auto near = [&](const T& wanted) {  // Newton's method from the side where it cannot overshoot
        const T k = stiffness.middle(), c = turning.middle();
        T t = wanted / (c > T(0) ? k + c : k);
        for (int round = 0; round < 60; ++round) {
            const T cosine = cosine_at(t);
            const T step = (wanted - k * t - c * t * cosine) / (k + c * cosine * cosine * cosine);
            t = t + step;
            if (!(abs(step) > T(4) * epsilon<T>() * abs(t))) break;
        }
        return t;
    };
    constexpr int tries = 40;
    Interval<T> t(near(R.low), R.low == R.high ? near(R.low) : near(R.high));
    T step = T(2) * epsilon<T>() * abs(t.low) + std::numeric_limits<T>::denorm_min();
    for (int round = 0; !(f(t.low).high <= R.low); ++round, step = step * T(2)) {
        if (round == tries) return Interval<T>(std::numeric_limits<T>::quiet_NaN());
        t.low = t.low - step;
    }
    step = T(2) * epsilon<T>() * abs(t.high) + std::numeric_limits<T>::denorm_min();
    for (int round = 0; !(f(t.high).low >= R.high); ++round, step = step * T(2)) {
        if (round == tries) return Interval<T>(std::numeric_limits<T>::quiet_NaN());
        t.high = t.high + step;
    }
    return t;
}

}  // namespace detail

/// Offset of the support over a cell of tangents of the lowest link: zero for every steady shape. `height` is lambda.
/// Of a support that is not a firm point on the axis: how far it is off where it is held.
template <Real T, class End = OnAxis>
Jet<T> support_offset(const std::vector<Link<Interval<T>>>& links, const Interval<T>& height, const Cell<T>& cell,
                      const End& support = {}) {
    const Interval<T> three(T(3));
    Jet<T> y, sum, t = cell.x();  // offset of the pin below; H; tangent
    for (std::size_t m = 0; m < links.size(); ++m) {
        const Link<Interval<T>>& link = links[m];
        const bool plummet = link.cross.low == T(0) && link.cross.high == T(0);
        const Interval<T> stiffness = height * link.pull, turning = link.length * link.cross;
        Jet<T> R;
        if (m > 0) {
            R = cell.centred(sum + link.moment * y);
            if (plummet) {
                t = (Interval<T>(T(1)) / stiffness) * R;
            } else {
                t.value = detail::tangent(stiffness, turning, R.value);
                t.centre_value = detail::tangent(stiffness, turning, R.centre_value);
                const detail::Sine<T> over(t.value), centre(t.centre_value);
                const Interval<T> growth = stiffness + turning * over.slope;
                t.slope = R.slope / growth;
                t.centre_slope = R.centre_slope / (stiffness + turning * centre.slope);
                t.bend = (R.bend + three * turning * over.half_bend * square(t.slope)) / growth;
            }
            t = cell.centred(t);
        }
        const detail::Sine<T> over(t.value), centre(t.centre_value);
        Jet<T> s{over.value, over.slope * t.slope, over.slope * t.bend - three * over.half_bend * square(t.slope),
                 centre.value, centre.slope * t.centre_slope};
        s = cell.centred(s);
        if (m == 0) {  // y0 = lambda t + a X s/(W h/a), moment over itself being 1
            R = stiffness * t;
            if (!plummet) R = R + turning * s;
            y = cell.centred((Interval<T>(T(1)) / link.moment) * R);
        }
        y = cell.centred(y - link.length * s);
        sum = R;
        if (!(link.rest.low == T(0) && link.rest.high == T(0))) sum = sum + link.rest * y;
        sum = cell.centred(sum);
    }
    return support.miss(cell, y, sum);
}

}  // namespace revchain::finite
