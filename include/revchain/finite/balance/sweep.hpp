// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/support_end.hpp"

namespace revchain::finite {

namespace detail {

/// t with  stiffness t + turning t/sqrt(1 + t^2) = R  where it grows with R, by Newton's method: |R| and turning decide
/// from which side it cannot overshoot.
template <class S>
S tangent_of(const S& stiffness, const S& turning, const S& R) {
    using std::abs;
    if (turning == S(0)) return R / stiffness;
    S t = R / (turning > S(0) ? stiffness + turning : stiffness);
    for (int round = 0; round < 100; ++round) {
        const S cosine = cosine_at(t);
        const S step = (R - stiffness * t - turning * t * cosine) / (stiffness + turning * cosine * cosine * cosine);
        t = t + step;
        if (!(abs(step) > S(4) * operation_error<S>() * abs(t))) break;
    }
    return t;
}

}  // namespace detail

/// Offsets of all pins, free end first, of the chain whose lowest link hangs at an inclination of given tangent and
/// whose every link is in balance: Greenhill (1908) §8 (4), (12). The last is that of the support: 0 for a steady
/// shape.
template <class S>
std::vector<S> swept(const std::vector<Link<S>>& links, const S& height, const S& lowest_tangent) {
    std::vector<S> y;
    y.reserve(links.size() + 1);
    S sum(0), t = lowest_tangent;
    for (std::size_t m = 0; m < links.size(); ++m) {
        const Link<S>& link = links[m];
        const S stiffness = height * link.pull, turning = link.length * link.cross;
        S R;
        if (m > 0) {
            R = sum + link.moment * y.back();
            t = detail::tangent_of(stiffness, turning, R);
        }
        const S s = t * detail::cosine_at(t);
        if (m == 0) {
            R = stiffness * t + turning * s;
            y.push_back(R / link.moment);
        }
        y.push_back(y.back() - link.length * s);
        sum = R + link.rest * y.back();
    }
    return y;
}

/// How far the topmost pin is then off where it is held.
template <class S, class End>
S missed(const std::vector<Link<S>>& links, const S& height, const S& lowest_tangent, const End& support) {
    const std::vector<S> y = swept(links, height, lowest_tangent);
    S sum(0);
    if constexpr (is_held<End>)
        for (std::size_t m = 0; m < links.size(); ++m) sum = sum + links[m].moment * y[m] + links[m].rest * y[m + 1];
    return support.miss(y.back(), sum);
}

}  // namespace revchain::finite
