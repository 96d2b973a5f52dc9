// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/link_equation.hpp"
#include "revchain/simd/interval_lanes.hpp"

/// The equation of one link for several loads at once: what finite/balance/taylor.hpp needs of
/// finite/balance/link_equation.hpp, for packs.
namespace revchain::finite::detail {

/// What a choice between packs is written in, for numbers.
inline bool any(bool yes) { return yes; }
template <Real T>
const T& if_less(const T& x, const T& y, const T& a, const T& b) {
    return x < y ? a : b;
}

/// The link of each lane: the same in all.
template <class T>
[[gnu::always_inline]] inline decltype(auto) in_lanes(const Link<Interval<Lane<T>>>& link) {
    if constexpr (IsPack<T>) {
        const auto spread = [](const Interval<Lane<T>>& x)
                                REVCHAIN_INLINED { return Interval<T>(T(x.low), T(x.high)); };
        return Link<Interval<T>>{spread(link.length), spread(link.pull), spread(link.cross), spread(link.moment),
                                 spread(link.rest)};
    } else {
        return (link);
    }
}

template <IsPack V>
struct Sine<V> {
    Interval<V> value, slope, half_bend;

    [[gnu::always_inline]] explicit Sine(const Interval<V>& t) {
        const V zero(0), one(1);
        const Interval<V> low(t.low), high(t.high), secant_low = sqrt(Interval<V>(one) + square(low)),
                                                    secant_high = sqrt(Interval<V>(one) + square(high));
        const Interval<V> s0 = low / secant_low, s1 = high / secant_high, c0 = Interval<V>(one) / secant_low,
                          c1 = Interval<V>(one) / secant_high, cc0 = square(c0), cc1 = square(c1);
        value = {s0.low, s1.high};
        slope = hull(c0 * cc0, c1 * cc1);
        slope.high = if_less(t.low, zero, if_less(zero, t.high, one, slope.high), slope.high);
        half_bend = hull(s0 * square(cc0), s1 * square(cc1));
        const V half(0.5), turning(steepest_half_bend);
        half_bend.high = if_less(half, t.low, half_bend.high, if_less(t.high, half, half_bend.high, turning));
        half_bend.low = if_less(-half, t.low, half_bend.low, if_less(t.high, -half, half_bend.low, -turning));
    }
};

/// Encloses the tangents under the loads R, as for numbers.
template <IsPack V>
[[gnu::always_inline]] inline Interval<V> tangent_of(const Interval<V>& stiffness, const Interval<V>& turning,
                                                     const Interval<V>& R) {
    using T = Lane<V>;
    const V zero(0), one(1), twist = turning.middle();
    const auto near = [&](const V& load, const V& k) REVCHAIN_INLINED {
        V t = load / (if_less(zero, twist, k + twist, k));
        for (int round = 0; round < 100; ++round) {
            const V cosine = one / root(one + t * t);
            const V step = (load - k * t - twist * t * cosine) / (k + twist * cosine * cosine * cosine);
            t = t + step;
            if (!any(V(T(4) * epsilon<T>()) * abs(t) < abs(step))) break;
        }
        return t;
    };
    // the first of t, t + step, t + 3 step, ... whose loads are all beyond the end of R; NaN where none of them is
    const auto passed = [&](V t, const V& sign, const V& wanted) REVCHAIN_INLINED {
        V step = V(T(2) * epsilon<T>()) * abs(t) + V(std::numeric_limits<T>::denorm_min());
        for (int round = 0; round < 41; ++round, step = step + step) {
            const Interval<V> load = stiffness * Interval<V>(t) + turning * Sine<V>(Interval<V>(t)).value;
            const V beyond = if_less(zero, sign, load.low - wanted, wanted - load.high);
            const auto yes = ~(beyond < zero) & equal(beyond, beyond);
            if (!any(~yes)) return t;
            t = select(yes, t, t + sign * step);
        }
        return V(std::numeric_limits<T>::quiet_NaN());
    };
    return {passed(near(R.low, if_less(R.low, zero, stiffness.low, stiffness.high)), -one, R.low),
            passed(near(R.high, if_less(R.high, zero, stiffness.high, stiffness.low)), one, R.high)};
}

}  // namespace revchain::finite::detail
