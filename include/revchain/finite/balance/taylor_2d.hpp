// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/jet.hpp"

namespace revchain::finite {

/// A function of x (lambda times the tangent of the lowest link) and lambda over a rectangle: what it and its
/// derivatives to the second order stay within, and its value and slopes at the centre.
template <Real T>
struct Surface {
    Interval<T> value, x, h, xx, xh, hh;  ///< h: along lambda
    Interval<T> centre_value, centre_x, centre_h;

    friend Surface operator+(const Surface& f, const Surface& g) {
        return {f.value + g.value,
                f.x + g.x,
                f.h + g.h,
                f.xx + g.xx,
                f.xh + g.xh,
                f.hh + g.hh,
                f.centre_value + g.centre_value,
                f.centre_x + g.centre_x,
                f.centre_h + g.centre_h};
    }
    friend Surface operator*(const Interval<T>& k, const Surface& f) {
        return {k * f.value,        k * f.x,        k * f.h,       k * f.xx, k * f.xh, k * f.hh,
                k * f.centre_value, k * f.centre_x, k * f.centre_h};
    }
};

/// x = lambda times tangents of the lowest link, and heights lambda, both from a low to a high end.
template <Real T>
struct Rectangle {
    T low, high, height_low, height_high;

    Interval<T> x() const { return {low, high}; }
    Interval<T> height() const { return {height_low, height_high}; }
};

namespace detail {

/// What the mean value theorem and Taylor's formula about the centre of a rectangle need of it.
template <Real T>
class Centre {
   public:
    explicit Centre(const Rectangle<T>& over)
        : x(over.x().middle()),
          height(over.height().middle()),
          off_x_(around(over.x(), x)),
          off_h_(around(over.height(), height)),
          half_xx_(half_square(off_x_)),
          half_hh_(half_square(off_h_)),
          off_xh_(off_x_ * off_h_) {}

    T x, height;

    /// The same, made narrower.
    Surface<T> centred(Surface<T> f) const {
        f.x = common(f.x, f.centre_x + f.xx * off_x_ + f.xh * off_h_);
        f.h = common(f.h, f.centre_h + f.xh * off_x_ + f.hh * off_h_);
        f.value = common(f.value, f.centre_value + f.x * off_x_ + f.h * off_h_);
        f.value = common(f.value, f.centre_value + f.centre_x * off_x_ + f.centre_h * off_h_ + f.xx * half_xx_ +
                                      f.xh * off_xh_ + f.hh * half_hh_);
        return f;
    }

   private:
    static Interval<T> around(const Interval<T>& range, const T& centre) {
        const Interval<T> off = range - Interval<T>(centre);
        const T reach = std::max(T(-off.low), off.high);
        return {-reach, reach};
    }
    static Interval<T> half_square(const Interval<T>& off) {
        return {T(0), revchain::detail::up(T(revchain::detail::up(T(off.high * off.high)) / T(2)))};
    }
    Interval<T> off_x_, off_h_, half_xx_, half_hh_, off_xh_;
};

/// t with  lambda pull t + length cross s(t) = R  over ranges of lambda pull (wide) and of R: |t| falls with the one
/// and grows with the other.
template <Real T>
Interval<T> tangent_over(const Interval<T>& stiffness, const Interval<T>& turning, const Interval<T>& R) {
    const T& for_low = R.low < T(0) ? stiffness.low : stiffness.high;
    const T& for_high = R.high < T(0) ? stiffness.high : stiffness.low;
    return {tangent(Interval<T>(for_low), turning, Interval<T>(R.low)).low,
            tangent(Interval<T>(for_high), turning, Interval<T>(R.high)).high};
}

}  // namespace detail

/// Offset of the support over a rectangle of x = lambda t, t the tangent of the lowest link, and heights lambda: zero
/// for every steady shape. NaN where a link may have several inclinations.
template <Real T>
Surface<T> support_surface(const std::vector<Link<Interval<T>>>& links, const Rectangle<T>& over) {
    const detail::Centre<T> centre(over);
    const Interval<T> zero(T(0)), one(T(1)), two(T(2)), three(T(3)), height = over.height(), middle(centre.height);
    Surface<T> y, sum;  // offset of the pin below; H
    const Interval<T> steepness = one / height, at_centre = one / middle, x(over.x()), x_centre(centre.x);
    Surface<T> t;
    t.value = x * steepness, t.x = steepness, t.h = -(t.value * steepness);
    t.xx = zero, t.xh = -square(steepness), t.hh = two * t.value * square(steepness);
    t.centre_value = x_centre * at_centre, t.centre_x = at_centre, t.centre_h = -(t.centre_value * at_centre);
    t = centre.centred(t);
    for (std::size_t m = 0; m < links.size(); ++m) {
        const Link<Interval<T>>& link = links[m];
        const bool plummet = link.cross.low == T(0) && link.cross.high == T(0);
        const Interval<T> stiffness = height * link.pull, centre_stiffness = middle * link.pull,
                          turning = link.length * link.cross;
        Surface<T> R;
        if (m > 0) {
            R = centre.centred(sum + link.moment * y);
            t.value = plummet ? R.value / stiffness : detail::tangent_over(stiffness, turning, R.value);
            t.centre_value = plummet ? R.centre_value / centre_stiffness
                                     : detail::tangent_over(centre_stiffness, turning, R.centre_value);
            Interval<T> growth = stiffness, centre_growth = centre_stiffness, bend = zero;
            if (!plummet) {
                const detail::Sine<T> along(t.value);
                growth = growth + turning * along.slope;
                centre_growth = centre_growth + turning * detail::Sine<T>(t.centre_value).slope;
                bend = three * turning * along.half_bend;
            }
            t.x = R.x / growth, t.centre_x = R.centre_x / centre_growth;
            t.h = (R.h - link.pull * t.value) / growth;
            t.centre_h = (R.centre_h - link.pull * t.centre_value) / centre_growth;
            t.xx = (R.xx + bend * square(t.x)) / growth;
            t.xh = (R.xh - link.pull * t.x + bend * t.x * t.h) / growth;
            t.hh = (R.hh - two * link.pull * t.h + bend * square(t.h)) / growth;
            t = centre.centred(t);
        }
        const detail::Sine<T> along(t.value), there(t.centre_value);
        const Interval<T> bend = three * along.half_bend;
        const Surface<T> s =
            centre.centred({along.value, along.slope * t.x, along.slope * t.h, along.slope * t.xx - bend * square(t.x),
                            along.slope * t.xh - bend * t.x * t.h, along.slope * t.hh - bend * square(t.h), there.value,
                            there.slope * t.centre_x, there.slope * t.centre_h});
        if (m == 0) {  // y0 = x + a X s/(W h/a), moment over itself being 1
            const Interval<T>& pull = link.pull;
            R = {pull * x, pull, zero, zero, zero, zero, pull * x_centre, pull, zero};
            if (!plummet) R = R + turning * s;
            y = centre.centred((one / link.moment) * R);
        }
        y = centre.centred(y + -link.length * s);
        sum = R;
        if (!(link.rest.low == T(0) && link.rest.high == T(0))) sum = sum + link.rest * y;
        sum = centre.centred(sum);
    }
    return y;
}

}  // namespace revchain::finite
