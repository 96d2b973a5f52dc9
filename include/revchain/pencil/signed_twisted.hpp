// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/signed.hpp"
#include "revchain/pencil/twisted.hpp"

/// Vectors of a family Q(x) with numbers of any sign, and what follows from them. See twisted.hpp.
namespace revchain::inline REVCHAIN_BUILD::pencil {

/// y with Q(x) y = 0 at an eigenvalue, offsets of pins 0 ... N, the held pin last (0); the largest is 1 in size, the
/// free end positive (by the signs of ratios, which outlast offsets that underflow).
///
/// Twisted factorisation as in `eigenvector`, in S by the equation of `SignedCounter`. Cost: two passes.
template <Real S>
std::vector<S> twisted_vector(const SignedPencil<S>& pencil, const S& x) {
    using std::abs;
    using T = Narrow<S>;
    const Factors<S> f = pencil.factors(x);
    const auto& elements = pencil.elements;
    const auto stiffness = [&](const SignedElement<S>& e) { return f.stiffness * e.stiffness + f.spin * e.spin; };
    const auto across = [&](const SignedElement<S>& e, const S& below) {
        const S L = stiffness(e), p = below + (L - e.lower);
        const T least = static_cast<T>(abs(L)) * static_cast<T>(epsilon<S>()) * T(1e-10) + least_pivot<T>();
        const S pivot = abs(p) < S(least) ? S(least) : p;
        return detail::Across<S>{e.above(L, below, e.weight(), e.determinant(), pivot), (L + e.cross) / pivot};
    };
    const auto rise = [&](std::size_t m, const S& below) { return across(elements[m], below); };
    const auto sink = [&](std::size_t m, const S& above) {
        const SignedElement<S>& e = elements[m];
        if (m + 1 == elements.size()) return detail::Across<S>{stiffness(e) - e.lower, S(T(0))};
        return across({e.stiffness, e.spin, e.upper, e.lower, e.cross}, above);  // upside down
    };
    const auto size_of = [](const S& value) { return static_cast<T>(abs(value)); };
    const auto forces = [&](std::size_t m) {
        const T own = size_of(stiffness(elements[m])) + size_of(elements[m].lower);
        if (m == 0 && !pencil.ground) return own;
        const SignedElement<S>& below = m == 0 ? *pencil.ground : elements[m - 1];
        return own + size_of(stiffness(below)) + size_of(below.upper);
    };
    const S footing = pencil.ground ? S(stiffness(*pencil.ground) - pencil.ground->upper) : S(T(0));
    auto [offset, largest, crossings] = detail::twisted<S>(elements.size(), rise, sink, forces, footing);
    for (S& y : offset) y = y / largest + S(T(0));
    return offset;
}

/// The x next to `near` with y^T Q(x) y = 0, by Newton's method: its error is the square of that of y.
/// Cost: one pass, and three steps on three numbers.
template <Real S>
S rayleigh_root(const SignedPencil<S>& pencil, const std::vector<S>& y, const S& near) {
    const S zero(Narrow<S>(0));
    S stiffness = zero, spin = zero, mass = zero;
    const auto add = [&](const SignedElement<S>& e, const S& lower, const S& upper) {
        const S difference = lower - upper, square = difference * difference;
        stiffness = stiffness + e.stiffness * square;
        spin = spin + e.spin * square;
        mass = mass + mass_form(e, lower, upper);
    };
    if (pencil.ground) add(*pencil.ground, zero, y[0]);
    for (std::size_t m = 0; m < pencil.elements.size(); ++m) add(pencil.elements[m], y[m], y[m + 1]);
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
    const Factors<S> f = pencil.factors(x);
    const auto loaded = [&](const SignedElement<S>& e, const S& lower, const S& upper) {
        const S spring = f.stiffness * e.stiffness, spin = f.spin * e.spin;
        return detail::LoadedElement<S>{
            spring + spin, abs(static_cast<M>(spring)) + abs(static_cast<M>(spin)), e.lower, e.cross, e.upper, lower,
            upper};
    };
    const auto y = [&](std::size_t pin) { return S(static_cast<M>(offset[static_cast<Index>(pin)])); };
    const auto link = [&](std::size_t m) { return loaded(pencil.elements[m], y(m), y(m + 1)); };
    const auto ground = pencil.ground ? loaded(*pencil.ground, S(M(0)), y(0)) : detail::LoadedElement<S>{};
    return static_cast<T>(detail::relative_residual<S>(pencil.elements.size(), link, ground));
}

}  // namespace revchain::pencil
