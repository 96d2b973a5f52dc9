// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/link_equation.hpp"
#include "revchain/finite/balance/support_end.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Result of the upward sweep: the offset of the topmost pin, and H, which is lambda times the sideways pull on it.
template <class F>
struct SweepEnd {
    F offset{}, sum{};
    bool reached = true;  ///< false where no inclination of some link carries its load
};

/// The upward sweep of Greenhill (1908) §8 (4), (12): every link in balance, from the tangent t of the lowest one. All
/// arithmetics share it: `S` are numbers or intervals, `F` too or Taylor series. `rules` holds what differs:
///   propagate(m, R, t)   sets t to the tangent of link m under the load R; false where there is none;
///   sine(m, t)       the sine of the inclination of link m;
///   upright(t)       lambda pull t, the load R of the lowest link less its part with the sine;
///   tighten(f)       f, or an enclosure that is narrower;
///   pass(m, t, y)    sees the tangent of link m and the offset of its lower pin.
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

/// The sweep in numbers or in intervals of them. Links hang.
template <class S>
struct PlainSweep {
    const std::vector<Link<S>>& links;
    const S& height;
    std::vector<S>*tangents = nullptr, *offsets = nullptr;  ///< where to put those of links and lower pins

    const S& tighten(const S& x) const { return x; }
    bool propagate(std::size_t m, const S& R, S& t) const {
        t = tangent_of(S(height * links[m].pull), turning_of(links[m]), R);
        return true;
    }
    S sine(std::size_t, const S& t) const { return sine_at(t); }
    S upright(const S& t) const { return height * links[0].pull * t; }
    void pass(std::size_t, const S& t, const S& y) const {
        if (tangents) tangents->push_back(t);
        if (offsets) offsets->push_back(y);
    }
};

/// Offsets of all pins, free end first, of the chain whose lowest link hangs at an inclination of given tangent and
/// whose every link is in balance. The last is that of the support: 0 for a steady shape.
template <class S>
std::vector<S> swept(const std::vector<Link<S>>& links, const S& height, const S& lowest_tangent) {
    std::vector<S> y;
    y.reserve(links.size() + 1);
    PlainSweep<S> rules{links, height, nullptr, &y};
    y.push_back(sweep_up(links, lowest_tangent, rules).offset);
    return y;
}

/// How far the topmost pin is from where the `support` holds it, for a tangent of the lowest link or for all of an
/// interval; puts the tangents of all links into `tangents`.
template <class S, class End = OnAxis>
S support_offset(const std::vector<Link<S>>& links, const S& height, const S& lowest, const End& support = {},
                 std::vector<S>* tangents = nullptr) {
    PlainSweep<S> rules{links, height, tangents};
    const SweepEnd<S> end = sweep_up(links, lowest, rules);
    return support.miss(end.offset, end.sum);
}

/// Its sign at one tangent: 0 where rounding leaves it open.
template <Real T, class End = OnAxis>
int sign_at(const EnclosedLinks<T>& links, const Interval<T>& height, const T& t, const End& support = {}) {
    return support_offset(links, height, Interval<T>(t), support).sign();
}

}  // namespace revchain::finite
