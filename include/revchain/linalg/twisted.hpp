// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "revchain/linalg/element_pencil.hpp"

namespace revchain::linalg {

namespace detail {

/// cross / pivot, the ratio of two neighbouring offsets, from its difference to 1 where that is small: the slope of a
/// smooth mode is then not the difference of two rounded offsets.
template <Real S>
S ratio(const S& cross, const S& pivot) {
    using std::abs;
    using T = Narrow<S>;
    const T change = static_cast<T>(cross - pivot) / static_cast<T>(pivot);
    return abs(change) < T(0.5) ? S(T(1)) + S(change) : cross / pivot;
}

}  // namespace detail

/// Scales offsets so that the largest is 1 in size and the free end (else the lowest pin off the axis) positive.
template <class Offsets>
void normalise(Offsets& offset) {
    using S = std::decay_t<decltype(offset[0])>;
    using std::abs;
    const S zero(Narrow<S>(0));
    S largest = zero, sign = zero;
    for (const S& y : offset) {
        if (abs(y) > abs(largest)) largest = abs(y);
        if (sign == zero) sign = y;
    }
    if (sign < zero) largest = -largest;
    for (S& y : offset) y = y / largest + zero;  // no -0
}

/// Eigenvector of the pencil at an eigenvalue: offsets of pins 0 ... N, the held pin N last (0), normalised.
///
/// Twisted factorisation: dynamic stiffness D of what hangs below each pin, going up, and E of what holds it from
/// above, going down; they balance best (|D + E| least) where the mode is largest, and from there the offsets follow
/// outwards by ratios without cancellation. The plain upward recurrence loses 3e-11 near the support at N = 1e5.
/// Dhillon, Parlett (2004), doi:10.1016/j.laa.2003.12.028, carried over to elements.
/// Cost: two passes, four numbers of S per link of scratch. Accuracy, of the largest offset, measured: with S a double
/// word 3.5e-16 for all modes up to N = 1000 and 6e-17 for the slowest at N = 1e5 (tests/cpp/linalg/twisted.cpp); with
/// S = double 1.5e-15 / gap up to N = 1000 and 6e-13 at 1e5, where gap (at most 1) is the relative distance to the next
/// eigenvalue. An error e in `eigenvalue` adds e / gap.
template <Real S>
Vector<Narrow<S>> eigenvector(const ElementPencil<S>& pencil, const S& eigenvalue) {
    using std::abs;
    using T = Narrow<S>;
    const Index n = pencil.size();
    const S floor = S(epsilon<S>()) * S(epsilon<S>()), zero(T(0));
    struct Pin {
        S stiffness_below;  // D
        S down;             // offset of this pin over that of the pin above
        S up;               // offset of the pin above over that of this pin
    };
    std::vector<Pin> pins(static_cast<std::size_t>(n));
    const auto cross_of = [](const Element<S>& e, const S& stiffness) {
        return stiffness + ((S(e.weight) - e.lower) - e.upper) * S(T(0.5));
    };
    S below = zero;
    for (std::size_t m = 0; m < pins.size(); ++m) {
        const Element<S>& e = pencil.elements[m];
        const S stiffness = eigenvalue * e.stiffness;
        pins[m].stiffness_below = below;
        S pivot = below + (stiffness - e.lower);
        if (pivot == zero) pivot = stiffness * floor;
        below = ((stiffness - e.upper) * below - (stiffness * S(e.weight) - e.coupling)) / pivot;
        pins[m].down = detail::ratio(cross_of(e, stiffness), pivot);
    }
    std::size_t twist = pins.size() - 1;
    T least = std::numeric_limits<T>::infinity();
    S above = zero;
    for (std::size_t m = pins.size(); m-- > 0;) {
        const Element<S>& e = pencil.elements[m];
        const S stiffness = eigenvalue * e.stiffness;
        if (m + 1 == pins.size()) {  // the held pin: infinitely stiff above
            pins[m].up = zero;
            above = stiffness - e.lower;
        } else {
            S pivot = above + (stiffness - e.upper);
            if (pivot == zero) pivot = stiffness * floor;
            pins[m].up = detail::ratio(cross_of(e, stiffness), pivot);
            above = ((stiffness - e.lower) * above - (stiffness * S(e.weight) - e.coupling)) / pivot;
        }
        // In units of the forces at the pin: unscaled, a light pin that moves far beats the heavy one that sets the mode,
        // and the ratios between them cancel.
        T forces = static_cast<T>(stiffness) + static_cast<T>(e.lower);
        if (m > 0) {
            const Element<S>& hung = pencil.elements[m - 1];
            forces = forces + static_cast<T>(eigenvalue * hung.stiffness) + static_cast<T>(hung.upper);
        }
        const T balance = abs(static_cast<T>(pins[m].stiffness_below + above)) / forces;
        if (balance < least) {
            least = balance;
            twist = m;
        }
    }
    std::vector<S> offset(pins.size() + 1);
    offset[twist] = S(T(1));
    for (std::size_t m = twist; m-- > 0;) offset[m] = pins[m].down * offset[m + 1];
    for (std::size_t m = twist; m < pins.size(); ++m) offset[m + 1] = pins[m].up * offset[m];
    normalise(offset);
    Vector<T> rounded(n + 1);
    for (Index m = 0; m <= n; ++m) rounded[m] = static_cast<T>(offset[static_cast<std::size_t>(m)]);
    return rounded;
}

/// lambda = y^T M y / y^T K y in S, element by element, from offsets in a narrower scalar: its error is the square of
/// theirs, so that offsets good to 1e-13 give a quotient good to 1e-25. Both sums have positive terms only.
/// Preconditions: offsets of pins 0 ... N, not all 0. Cost: one pass, no division.
template <Real S, Real T>
S rayleigh_quotient(const ElementPencil<S>& pencil, const Vector<T>& offset) {
    S inertia(0), stiffness(0);
    for (Index m = 0; m < pencil.size(); ++m) {
        const Element<S>& e = pencil.elements[static_cast<std::size_t>(m)];
        const S lower(static_cast<Narrow<S>>(offset[m])), upper(static_cast<Narrow<S>>(offset[m + 1]));
        const S difference = lower - upper;
        // M in the form A y^2 + B y'^2 + 2 X y y' with 2 X = W - A - B
        const S twice_cross = (S(e.weight) - e.lower) - e.upper;
        inertia = inertia + (lower * (e.lower * lower + twice_cross * upper) + e.upper * upper * upper);
        stiffness = stiffness + e.stiffness * difference * difference;
    }
    return inertia / stiffness;
}

/// Backward error of (eigenvalue, offset): the largest force left unbalanced at a pin, relative to the largest sum of
/// the forces' terms that meet at a pin, max |(lambda K - M) y| / max (|lambda K| |y| + |M| |y|). Evaluated in S, so
/// that what is reported is the error of the offsets and not of the evaluation. Cost: one pass.
template <Real S, Real T>
T relative_residual(const ElementPencil<S>& pencil, const T& eigenvalue, const Vector<T>& offset) {
    using std::abs;
    using M = Narrow<S>;
    const auto size_of = [](const S& x) { return abs(static_cast<M>(x)); };
    M largest(0), worst(0), size(0);
    S force(M(0));  // carried over from the link below
    for (Index m = 0; m < pencil.size(); ++m) {
        const Element<S>& e = pencil.elements[static_cast<std::size_t>(m)];
        const S k = e.stiffness * S(static_cast<M>(eigenvalue));
        const S cross = ((S(e.weight) - e.lower) - e.upper) * S(M(0.5));
        const S lower(static_cast<M>(offset[m])), upper(static_cast<M>(offset[m + 1]));
        const S spring = k * (lower - upper);
        const M spring_size = size_of(k) * (size_of(lower) + size_of(upper));
        worst = std::max(worst, size_of(force + (spring - (e.lower * lower + cross * upper))));
        largest = std::max(largest, size + spring_size + size_of(e.lower * lower) + size_of(cross * upper));
        force = -spring - (cross * lower + e.upper * upper);
        size = spring_size + size_of(cross * lower) + size_of(e.upper * upper);
    }
    return largest > M(0) ? static_cast<T>(worst / largest) : T(0);
}

}  // namespace revchain::linalg
