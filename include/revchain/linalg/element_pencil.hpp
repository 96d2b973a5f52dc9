// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/core/double_word.hpp"

namespace revchain::linalg {

/// One element between two neighbouring pins (lower, upper) of the pencil  lambda K - M:
///
///     K = k [ 1 -1 ; -1 1 ],     M = [ A  X ; X  B ],     A + 2 X + B = W,     A B - X^2 = C.
///
/// W and C = W^2 rho^2 / a^2 are data of their own, never differences: that is what keeps the counts accurate.
template <Real S>
struct Element {
    S stiffness{};       ///< k > 0
    S lower{};           ///< A >= 0
    S upper{};           ///< B >= 0
    S coupling{};        ///< C >= 0, determinant of the mass matrix
    Narrow<S> weight{};  ///< W >= 0
};

/// X = (W - A - B) / 2, off the diagonal of the mass matrix.
template <Real S>
S cross_mass(const Element<S>& e) {
    return ((S(e.weight) - e.lower) - e.upper) * S(Narrow<S>(0.5));
}

/// Dynamic stiffness carried across an element, equation (1) of docs/accuracy.md: from `near` at the pin where it is
/// known to the other, whose own mass is `far`; `stiffness` is lambda k.
template <Real S>
S carried(const Element<S>& e, const S& stiffness, const S& near, const S& far, const S& pivot) {
    return ((stiffness - far) * near - (stiffness * S(e.weight) - e.coupling)) / pivot;
}

/// The pivot, or where it is exactly 0 something positive and tiny: an eigenvalue at the shift is not above it.
template <Real S>
S not_zero(const S& pivot, const S& stiffness) {
    return pivot == S(Narrow<S>(0)) ? stiffness * (S(epsilon<S>()) * S(epsilon<S>())) : pivot;
}

/// A symmetric pencil lambda K - M kept as its elements, lowest first, never assembled: neighbouring stiffnesses, once
/// added, lose the slowest modes. The last element's upper pin is held. lambda K y = M y has positive eigenvalues.
template <Real S>
struct ElementPencil {
    std::vector<Element<S>> elements;
    Narrow<S> entry_error{};  ///< bound on the relative error of every number in `elements`

    Index size() const { return static_cast<Index>(elements.size()); }
};

/// The same pencil in a narrower scalar; one more rounding in each entry. Where an entry leaves the normal range of T
/// its relative error is not known: `entry_error` is then infinite and nothing is proved with this pencil.
template <Real T, Real S>
ElementPencil<T> rounded(const ElementPencil<S>& wide) {
    if constexpr (std::is_same_v<T, S>) {
        return wide;
    } else {
        ElementPencil<T> pencil;
        pencil.elements.reserve(wide.elements.size());
        for (const Element<S>& e : wide.elements)
            pencil.elements.push_back({static_cast<T>(e.stiffness), static_cast<T>(e.lower), static_cast<T>(e.upper),
                                       static_cast<T>(e.coupling), static_cast<T>(e.weight)});
        using std::abs;
        pencil.entry_error = static_cast<T>(wide.entry_error) + epsilon<T>();
        for (const Element<T>& e : pencil.elements)
            for (const T& entry : {e.stiffness, e.lower, e.upper, e.weight})
                if (entry != T(0) && abs(entry) < std::numeric_limits<T>::min())
                    pencil.entry_error = std::numeric_limits<T>::infinity();
        return pencil;
    }
}

}  // namespace revchain::linalg
