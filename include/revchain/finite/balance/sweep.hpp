// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/link_equation.hpp"
#include "revchain/finite/balance/support_end.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The result of the upward sweep: offset of the topmost pin and H, lambda times the pull across.
template <class F>
struct SweepEnd {
    F offset{}, sum{};
    bool reached = true;  ///< false if some link has no inclination that carries its load
};

/// Returns the end of the upward sweep of Greenhill (1908) §8 (4), (12): every link in balance,
/// from the tangent t of the lowest one. `S` are numbers or intervals; `F` are these or Taylor
/// series. `rules` holds what differs between sweeps:
///   propagate(m, R, t)  sets t to the tangent of link m under the load R; false if there is none;
///   sine(m, t)       returns the sine of the inclination of link m;
///   upright(t)       returns lambda pull t, the load of the lowest link without its sine term;
///   tighten(f)       returns f, or a narrower enclosure;
///   pass(m, t, y)    receives the tangent of link m and the offset of its lower pin.
template <class S, class F, class Rules>
SweepEnd<F> sweep_up(const std::vector<Link<S>>& links, F t, Rules& rules) {
    SweepEnd<F> end;
    F &y = end.offset, &sum = end.sum;
    for (std::size_t m = 0; m < links.size(); ++m) {
        const Link<S>& link = links[m];
        F R;
        if (m > 0) {
            R = rules.tighten(sum + link.moment * y);
            end.reached = rules.propagate(m, R, t);
            if (!end.reached) return end;
            t = rules.tighten(t);
        }
        const F s = rules.tighten(rules.sine(m, t));
        if (m == 0) {
            R = rules.upright(t);
            if (!is_zero(link.cross)) R = R + turning_of(link) * s;
            y = rules.tighten(R / link.moment);
        }
        rules.pass(m, t, y);
        y = rules.tighten(y - link.length * s);
        sum = is_zero(link.rest) ? rules.tighten(R) : rules.tighten(R + link.rest * y);
    }
    return end;
}

/// The rules of a sweep in numbers or intervals, for hanging links.
template <class S>
struct PlainSweep {
    const std::vector<Link<S>>& links;
    const S& height;
    std::vector<S>*tangents = nullptr, *offsets = nullptr;  ///< filled for links and lower pins

    const S& tighten(const S& x) const { return x; }
    bool propagate(std::size_t m, const S& R, S& t) const {
        const S stiffness = height * links[m].pull, turning = turning_of(links[m]);
        t = is_zero(turning) ? S(R / stiffness) : tangent_of(stiffness, turning, R);
        return true;
    }
    S sine(std::size_t, const S& t) const { return sine_at(t); }
    S upright(const S& t) const { return height * links[0].pull * t; }
    void pass(std::size_t, const S& t, const S& y) const {
        if (tangents) tangents->push_back(t);
        if (offsets) offsets->push_back(y);
    }
};

/// Returns the offsets of all pins, free end first, of links in balance above a lowest link of the
/// given tangent. The last offset, at the support, is 0 for a steady shape.
template <class S>
std::vector<S> swept(const std::vector<Link<S>>& links, const S& height, const S& lowest_tangent) {
    std::vector<S> y;
    y.reserve(links.size() + 1);
    PlainSweep<S> rules{links, height, nullptr, &y};
    y.push_back(sweep_up(links, lowest_tangent, rules).offset);
    return y;
}

/// Returns the distance of the topmost pin from its `support`, for a tangent of the lowest link or
/// an interval of tangents. Puts the tangents of all links into `tangents`.
template <class S, class End = OnAxis>
S support_offset(const std::vector<Link<S>>& links, const S& height, const S& lowest,
                 const End& support = {}, std::vector<S>* tangents = nullptr) {
    PlainSweep<S> rules{links, height, tangents};
    const SweepEnd<S> end = sweep_up(links, lowest, rules);
    return support.miss(end.offset, end.sum);
}

/// Returns the sign of `support_offset` at one tangent; 0 if rounding leaves it undecided.
template <Real T, class End = OnAxis>
int sign_at(const EnclosedLinks<T>& links, const Interval<T>& height, const T& t,
            const End& support = {}) {
    return support_offset(links, height, Interval<T>(t), support).sign();
}

}  // namespace revchain::finite
