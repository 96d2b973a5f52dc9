// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/numeric/interval.hpp"
#include "revchain/pencil/element.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// A drive to two roundings: the height and, if a stiffness depends on the speed, height times
/// speed.
struct Driving {
    Wide<double> height, spin;
};

/// The response of a string of elements to one moved end. Offsets are relative to the moved end's.
struct Driven {
    bool decided = false;    ///< if false, perhaps at resonance: only `negative` is valid
    double error_bound = 0;  ///< error of unrounded offsets over the largest offset of a pin
    bool reversed = false;   ///< true if the lowest pin moves against the moved end
    Index negative = 0;      ///< negative pivots, without uncertain ones
    double stiffness = 0;    ///< force over offset at the moved end, in units of the last element
    double stiffness_error = 0;
};

namespace detail {

using revchain::detail::around, revchain::detail::in_all_lanes;

inline Interval<Wide<double>> rescaled(const Interval<Wide<double>>& x, int step) {
    return {ldexp(x.low, step), ldexp(x.high, step)};
}

/// The ratio of a pin's offset to the next pin's or, if that is nearly a node, to the next but one.
struct Follows {
    Interval<Wide<double>> ratio;
    int pins = 1;
};

}  // namespace detail

/// Returns the response, and offsets of the pins below the moved end, lowest first, by intervals of
/// two words: for drives that `driven_lanes` leaves undecided. It carries up D, the dynamic
/// stiffness below:
///
///     p = D + L - A,    D' = (L - B) - (L + X)^2 / p,    y = y' (L + X) / p.
///
/// If p vanishes, the pin above is a node. Then it carries for one link the reciprocal of D',
/// C' = p / ((L - B) p - (L + X)^2). D enters each step once, so intervals widen only as the error
/// grows. `end` is 1, the offset of the moved end, if that is a pin of the chain, else 0: errors
/// are relative to the largest offset of a pin. Cost: about 1.5 microseconds for each element.
template <class Offsets>
Driven driven(const SignedPencil<Wide<double>>& pencil, const Driving& at, const Offsets& offset,
              double end = 1) {
    using S = Wide<double>;
    using I = Interval<S>;
    const double unit = operation_error<S>();
    const std::size_t n = pencil.elements.size();
    std::vector<detail::Follows> follows(n);
    I below(S(0.0)), earlier_pivot, earlier_square, earlier_rest;
    bool compliant = false;  // true if `below` is the reciprocal
    Driven result;
    const auto two = [](const S& x, double part) {
        return detail::around(x, std::abs(x.high) * part);
    };
    const I height = two(at.height, 2 * unit), spin = two(at.spin, 2 * unit);
    for (std::size_t m = 0; m < n; ++m) {
        const SignedElement<S>& e = pencil.elements[m];
        const int step = pencil.step_down(m);
        if (step != 0) below = detail::rescaled(below, compliant ? -step : step);
        I stiffness = height * detail::around(e.stiffness, e.error.stiffness);
        if (e.spin.high != 0) stiffness = stiffness + spin * two(e.spin, 4 * unit);
        const I lower = stiffness - detail::around(e.lower, e.error.lower);
        const I upper = stiffness - detail::around(e.upper, e.error.upper);
        const I coupling = stiffness + detail::around(e.cross, e.error.cross);
        const I square = revchain::square(coupling);
        if (compliant) {
            const I whole = I(S(1.0)) + below * lower;
            // the sign of p times the lower p does not depend on the small p
            const I pair = earlier_pivot * (detail::rescaled(earlier_rest, step) + lower) -
                           detail::rescaled(earlier_square, step);
            if (pair.negative()) ++result.negative;
            if (!pair.negative() || whole.may_vanish()) return result;
            const I force = coupling / whole;  // force of all below over the upper pin's offset
            const I ratio = below * force;
            follows[m] = {ratio, 1};
            const I node = detail::rescaled(earlier_rest, step) * below - I(S(1.0));
            follows[m - 1].ratio = follows[m - 1].ratio * detail::rescaled(force, -step) * node;
            below = upper - square * (below / whole);
            compliant = false;
            continue;
        }
        const I pivot = below + lower;
        const double size = std::abs(below.low.high) + std::abs(lower.low.high);
        const bool small = std::abs(pivot.low.high) < 0x1p-40 * size || pivot.may_vanish();
        if (small && m + 1 < n) {
            const I denominator = upper * pivot - square;
            if (denominator.may_vanish() || coupling.may_vanish()) return result;
            earlier_pivot = pivot, earlier_square = square, earlier_rest = upper;
            follows[m] = {I(S(1.0)) / coupling, 2};
            below = pivot / denominator;
            compliant = true;
            continue;
        }
        if (pivot.may_vanish()) return result;
        if (pivot.negative()) ++result.negative;
        const I ratio = coupling / pivot;
        follows[m] = {ratio, 1};
        below = upper - coupling * ratio;
    }
    I above(S(1.0)), before;
    double largest = end, worst = 0;
    bool known = true;
    for (std::size_t m = n; m-- > 0;) {
        const I y = follows[m].ratio * (follows[m].pins == 2 ? before : above);
        const S middle = y.middle();
        const double value = middle.high;
        known = known && std::isfinite(value) && std::isfinite(y.width().high);
        largest = std::max(largest, std::abs(value));
        worst = std::max(worst, y.width().high);
        offset(m, middle);
        before = above, above = y;
        if (m == 0) result.reversed = value < 0;
    }
    result.error_bound = 0.51 * worst / largest;
    result.decided = known && result.error_bound < 1;
    result.stiffness = below.middle().high;
    result.stiffness_error = 0.51 * below.width().high + 0x1p-52 * std::abs(result.stiffness);
    return result;
}

}  // namespace revchain::pencil
