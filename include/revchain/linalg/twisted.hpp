// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>

#include "revchain/linalg/element_pencil.hpp"

namespace revchain::linalg {

/// Eigenvector of the pencil at an eigenvalue, offsets of pins 0 ... N with the held pin N last (0); |largest| near 1.
///
/// Twisted factorisation: dynamic stiffness D of what hangs below each pin, going up, and E of what holds it from
/// above, going down; they balance best (|D + E| least) where the mode is largest, and from there the offsets follow
/// outwards by ratios without cancellation. The plain upward recurrence loses 3e-11 near the support at N = 1e5.
/// Dhillon, Parlett (2004), doi:10.1016/j.laa.2003.12.028, carried over to elements.
/// Cost: two passes, two numbers per link of scratch. Accuracy, measured in double against the exact vector, of the
/// largest offset: 4e-14 / gap up to N = 1000, 1.4e-12 for the three slowest modes at N = 1e5, where gap (at most 1) is
/// the relative distance to the next eigenvalue (tests/cpp/linalg/twisted.cpp). An error e in `eigenvalue` adds e / gap.
template <Real T>
Vector<T> eigenvector(const ElementPencil<T>& pencil, const T& eigenvalue) {
    using std::abs;
    const Index n = pencil.size();
    const T floor = epsilon<T>() * epsilon<T>();
    Vector<T> offset(n + 1), from_below(n), from_above(n);  // offset holds D first
    T d(0);
    for (Index m = 0; m < n; ++m) {
        const Element<T>& e = pencil.elements[static_cast<std::size_t>(m)];
        const T stiffness = eigenvalue * e.stiffness;
        offset[m] = d;
        T pivot = d + (stiffness - e.lower);
        if (pivot == T(0)) pivot = stiffness * floor;
        d = ((stiffness - e.upper) * d - (stiffness * e.weight - e.coupling)) / pivot;
        from_below[m] = (stiffness + (e.weight - e.lower - e.upper) / T(2)) / pivot;  // y_{m} / y_{m+1}
    }
    Index twist = n - 1;
    T least = std::numeric_limits<T>::infinity();
    T above(0);
    for (Index m = n - 1; m >= 0; --m) {
        const Element<T>& e = pencil.elements[static_cast<std::size_t>(m)];
        const T stiffness = eigenvalue * e.stiffness;
        const T cross = stiffness + (e.weight - e.lower - e.upper) / T(2);
        if (m == n - 1) {  // the held pin: infinitely stiff above
            from_above[m] = T(0);
            above = stiffness - e.lower;
        } else {
            T pivot = above + (stiffness - e.upper);
            if (pivot == T(0)) pivot = stiffness * floor;
            from_above[m] = cross / pivot;  // y_{m+1} / y_{m}
            above = ((stiffness - e.lower) * above - (stiffness * e.weight - e.coupling)) / pivot;
        }
        const T balance = abs(offset[m] + above);
        if (balance < least) {
            least = balance;
            twist = m;
        }
    }
    offset[twist] = T(1);
    for (Index m = twist; m-- > 0;) offset[m] = from_below[m] * offset[m + 1];
    for (Index m = twist; m < n; ++m) offset[m + 1] = from_above[m] * offset[m];
    return offset;
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
/// the forces' terms that meet at a pin, max |(lambda K - M) y| / max (|lambda K| |y| + |M| |y|). Cost: one pass.
template <Real T>
T relative_residual(const ElementPencil<T>& pencil, const T& eigenvalue, const Vector<T>& offset) {
    using std::abs;
    T largest(0), worst(0), force(0), size(0);  // force and size carried over from the link below
    for (Index m = 0; m < pencil.size(); ++m) {
        const Element<T>& e = pencil.elements[static_cast<std::size_t>(m)];
        const T k = eigenvalue * e.stiffness;
        const T cross = (e.weight - e.lower - e.upper) / T(2);
        const T lower = offset[m], upper = offset[m + 1];
        const T spring = k * (lower - upper);
        const T spring_size = k * (abs(lower) + abs(upper));
        worst = std::max(worst, abs(force + (spring - (e.lower * lower + cross * upper))));
        largest = std::max(largest, size + spring_size + abs(e.lower * lower) + abs(cross * upper));
        force = -spring - (cross * lower + e.upper * upper);
        size = spring_size + abs(cross * lower) + abs(e.upper * upper);
    }
    return largest > T(0) ? worst / largest : T(0);
}

}  // namespace revchain::linalg
