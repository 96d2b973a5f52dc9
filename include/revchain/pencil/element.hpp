// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/numeric/double_word.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// One element between two neighbouring pins (lower, upper) of the pencil  lambda K - M:
///
///     K = k [ 1 -1 ; -1 1 ],     M = [ A  X ; X  B ],     A + 2 X + B = W,     A B - X^2 = c W.
///
/// All are data of their own, never differences of one another: that is what keeps the counts accurate. All are linear
/// in the weights: no square of a small one underflows.
template <Real S>
struct Element {
    S stiffness{};       ///< k > 0
    S lower{};           ///< A >= 0
    S upper{};           ///< B >= 0
    S cross{};           ///< X, of any sign
    S turning{};         ///< c >= 0, what the element resists turning with
    Narrow<S> weight{};  ///< W >= 0
};

/// Dynamic stiffness carried across an element, by equation (1) of docs/theory/counts.md: from `near` at the pin where
/// it is known to the other, whose own mass is `far`; `stiffness` is L = lambda k, `inverse` one over the pivot.
template <Real S>
S propagate(const Element<S>& e, const S& stiffness, const S& near, const S& far, const S& inverse) {
    return (stiffness - far) * (near * inverse) - (stiffness - e.turning) * (S(e.weight) * inverse);
}

/// This form has one operation less after the division. It is for pencils in one unit, whose products stay in range.
template <Real S>
S propagate_in_one_unit(const Element<S>& e, const S& stiffness, const S& near, const S& far, const S& pivot) {
    return ((stiffness - far) * near - (stiffness - e.turning) * S(e.weight)) / pivot;
}

/// Propagates by equation (2), from the coupling L + X of the two pins: accurate where it and the pivot are small.
template <Real S>
S propagate_by_coupling(const S& stiffness, const S& far, const S& coupling, const S& inverse) {
    return (stiffness - far) - coupling * (coupling * inverse);
}

/// The least size of a pivot: its reciprocal can still be split into two halves for a product of double words.
template <Real M>
M least_pivot() {
    using std::ldexp;
    using limits = std::numeric_limits<M>;
    return ldexp(M(1), limits::min_exponent + (limits::digits + 1) / 2 + 3);
}

/// The pivot, or where it is 0 or too small to divide by something positive and tiny: an eigenvalue at the shift is not
/// above it.
template <Real S>
S not_zero(const S& pivot, const S& stiffness) {
    using std::abs;
    const S least(least_pivot<Narrow<S>>());
    return abs(pivot) < least ? stiffness * (S(epsilon<S>()) * S(epsilon<S>())) + least : pivot;
}

/// Factors of the stiffness and of the spin of each element: x and none, or x^2 and x.
template <class S>
struct Factors {
    S stiffness{}, spin{};
};

/// A symmetric pencil lambda K - M kept as its elements, lowest first, never assembled: neighbouring stiffnesses, once
/// added, lose the slowest modes. The last element's upper pin is held. lambda K y = M y has positive eigenvalues.
template <Real S>
struct ElementPencil {
    std::vector<Element<S>> elements;
    /// Where weights differ too widely for one unit: element m is in units of 2^units[m], exponents that never fall on
    /// the way up and end at 0. Else empty.
    std::vector<int> units;
    /// With momentum: s of each element, of any sign. Its L is then x^2 k + x s, and the family quadratic in x, with a
    /// positive root for each mode in one sense of rotation. Else empty.
    std::vector<S> spin;
    /// Bound on the error of every number in `elements` and of each spin, relative to it and, of the cross mass, to
    /// |X| + 2 c; besides what underflows: less than `least_pivot` in masses, `stiffness_underflow` in stiffnesses.
    Narrow<S> entry_error{};
    Narrow<S> stiffness_underflow = largest_underflow();

    Index size() const { return static_cast<Index>(elements.size()); }
    /// 4/a times the least positive number, a the shortest length there can be beside one of 1.
    static Narrow<S> largest_underflow() {
        using std::ldexp;
        using limits = std::numeric_limits<Narrow<S>>;
        return ldexp(limits::min() * limits::epsilon(), limits::max_exponent / 4 + 2);
    }
    /// The exponent by which what is carried across pin m from below grows less: in the unit of element m from that of
    /// m - 1.
    int step_down(std::size_t m) const { return units.empty() || m == 0 ? 0 : units[m - 1] - units[m]; }
};

/// Returns the pencil in a narrower scalar, with one more rounding in each entry.
template <Real T, Real S>
ElementPencil<T> rounded(const ElementPencil<S>& wide) {
    if constexpr (std::is_same_v<T, S>) {
        return wide;
    } else {
        ElementPencil<T> pencil;
        pencil.elements.reserve(wide.elements.size());
        for (const Element<S>& e : wide.elements)
            pencil.elements.push_back({static_cast<T>(e.stiffness), static_cast<T>(e.lower), static_cast<T>(e.upper),
                                       static_cast<T>(e.cross), static_cast<T>(e.turning), static_cast<T>(e.weight)});
        pencil.units = wide.units;
        pencil.spin.reserve(wide.spin.size());
        for (const S& spin : wide.spin) pencil.spin.push_back(static_cast<T>(spin));
        pencil.entry_error = static_cast<T>(wide.entry_error) + epsilon<T>();
        if constexpr (std::numeric_limits<T>::min_exponent == std::numeric_limits<Narrow<S>>::min_exponent)
            pencil.stiffness_underflow = static_cast<T>(wide.stiffness_underflow);
        return pencil;
    }
}

}  // namespace revchain::pencil
