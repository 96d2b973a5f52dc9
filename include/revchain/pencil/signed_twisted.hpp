// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/signed.hpp"
#include "revchain/pencil/twisted.hpp"

/// Vectors of a family Q(x) with numbers of any sign, and what follows from them. See twisted.hpp.
namespace revchain::pencil {

/// y with Q(x) y = 0 at an eigenvalue, offsets of pins 0 ... N, the held pin last (0); the largest is 1 in size, the
/// free end positive (by the signs of ratios, which outlast offsets that underflow).
///
/// Twisted factorisation as in `eigenvector`, in S by the equation of `SignedCounter`. Cost: two passes.
template <Real S>
std::vector<S> twisted_vector(const SignedPencil<S>& pencil, const S& x) {
    using std::abs;
    using T = Narrow<S>;
    struct Pin {
        S below, down, up;  // dynamic stiffness below; offset over that of the pin above; the other way round
    };
    const Factors<S> f = pencil.factors(x);
    const std::size_t n = pencil.elements.size();
    const auto stiffness = [&](std::size_t m) {
        return f.stiffness * pencil.elements[m].stiffness + f.spin * pencil.elements[m].spin;
    };
    const auto pivot = [](const S& p, const S& scale) {
        const T least = static_cast<T>(abs(scale)) * static_cast<T>(epsilon<S>()) * T(1e-10) + least_pivot<T>();
        return abs(p) < S(least) ? S(least) : p;
    };
    std::vector<Pin> pins(n);
    S below(T(0)), above(T(0));
    for (std::size_t m = 0; m < n; ++m) {
        const SignedElement<S>& e = pencil.elements[m];
        const S L = stiffness(m), C = L + e.cross;
        pins[m].below = below;
        const S p = pivot(below + (L - e.lower), L);
        pins[m].down = C / p;
        below = e.above(L, below, e.weight(), e.determinant(), p);
    }
    std::size_t twist = n - 1;
    T least = std::numeric_limits<T>::infinity();
    const auto size_of = [](const S& value) { return static_cast<T>(abs(value)); };
    for (std::size_t m = n; m-- > 0;) {
        const SignedElement<S>& e = pencil.elements[m];
        const S L = stiffness(m), C = L + e.cross;
        if (m + 1 == n) {
            pins[m].up = S(T(0)), above = L - e.lower;
        } else {  // the same element upside down
            const SignedElement<S> turned{e.stiffness, e.spin, e.upper, e.lower, e.cross};
            const S p = pivot(above + (L - e.upper), L);
            pins[m].up = C / p;
            above = turned.above(L, above, e.weight(), e.determinant(), p);
        }
        T forces = size_of(L) + size_of(e.lower);
        if (m > 0) forces = forces + size_of(stiffness(m - 1)) + size_of(pencil.elements[m - 1].upper);
        const T balance = size_of(pins[m].below + above) / forces;
        if (balance < least) least = balance, twist = m;
    }
    std::vector<S> offset(n + 1);
    offset[twist] = S(T(1));
    for (std::size_t m = twist; m-- > 0;) offset[m] = pins[m].down * offset[m + 1];
    for (std::size_t m = twist; m < n; ++m) offset[m + 1] = pins[m].up * offset[m];
    S largest(T(0));
    for (const S& y : offset)
        if (abs(y) > largest) largest = abs(y);
    for (std::size_t m = 0; m < twist; ++m)
        if (pins[m].down < S(T(0))) largest = -largest;
    for (S& y : offset) y = y / largest + S(T(0));
    return offset;
}

/// The x next to `near` with y^T Q(x) y = 0, by Newton's method: its error is the square of that of y.
/// Cost: one pass, and three steps on three numbers.
template <Real S>
S rayleigh_root(const SignedPencil<S>& pencil, const std::vector<S>& y, const S& near) {
    const S zero(Narrow<S>(0));
    S stiffness = zero, spin = zero, mass = zero;
    for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
        const SignedElement<S>& e = pencil.elements[m];
        const S difference = y[m] - y[m + 1], square = difference * difference, cross = e.cross * y[m + 1];
        stiffness = stiffness + e.stiffness * square;
        spin = spin + e.spin * square;
        mass = mass + (y[m] * (e.lower * y[m] + cross + cross) + e.upper * y[m + 1] * y[m + 1]);
    }
    if (!pencil.quadratic) return mass / stiffness;
    S x = near;
    for (int step = 0; step < 3; ++step) {
        const S slope = stiffness * (x + x) + spin;
        if (slope == zero) break;
        x = x - ((stiffness * x + spin) * x - mass) / slope;
    }
    return x;
}

/// Backward error of (x, y): the largest force left unbalanced at a pin over the largest sum of the sizes of its terms.
template <Real S, Real T>
T relative_residual(const SignedPencil<S>& pencil, const S& x, const Vector<T>& offset) {
    using std::abs;
    using M = Narrow<S>;
    const auto size_of = [](const S& value) { return abs(static_cast<M>(value)); };
    const Factors<S> f = pencil.factors(x);
    M largest(0), worst(0), size(0);
    S force(M(0));  // carried over from the link below
    for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
        const SignedElement<S>& e = pencil.elements[m];
        const S lower(static_cast<M>(offset[static_cast<Index>(m)])),
            upper(static_cast<M>(offset[static_cast<Index>(m) + 1]));
        const S spring = (f.stiffness * e.stiffness + f.spin * e.spin) * (lower - upper);
        const M spring_size =
            (size_of(f.stiffness * e.stiffness) + size_of(f.spin * e.spin)) * (size_of(lower) + size_of(upper));
        worst = std::max(worst, size_of(force + (spring - (e.lower * lower + e.cross * upper))));
        largest = std::max(largest, size + spring_size + size_of(e.lower * lower) + size_of(e.cross * upper));
        force = -spring - (e.cross * lower + e.upper * upper);
        size = spring_size + size_of(e.cross * lower) + size_of(e.upper * upper);
    }
    return largest > M(0) ? static_cast<T>(worst / largest) : T(0);
}

}  // namespace revchain::pencil
