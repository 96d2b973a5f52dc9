// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <type_traits>
#include <vector>

#include "revchain/numeric/double_word.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// The factors of an element's stiffness and spin are x and 0, or x^2 and x.
template <class X>
struct Factors {
    X stiffness{}, spin{};
};

/// Bounds on the absolute errors of an element's numbers.
template <Real M>
struct ElementError {
    M stiffness{}, spin{}, lower{}, upper{}, cross{};
};

namespace detail {
/// An empty member. Members of one empty type must have different addresses, hence the number.
template <int>
struct Nothing {};
}  // namespace detail

/// One element between two neighbouring pins (lower, upper) of symmetric matrices in one unknown x,
///
///     Q(x) = L [ 1 -1 ; -1 1 ] - [ A  X ; X  B ],     L = x k,  or with spins  L = x^2 k + x s,
///
/// with W = A + 2 X + B and c W = A B - X^2. All numbers are stored. None is computed as a
/// difference of others, so counts stay accurate. In a hanging chain k > 0, masses are not
/// negative, and relative errors are small. All numbers are linear in the weights, so no square of
/// a small weight underflows. With `OwnErrors` numbers may have any sign, and c W is stored instead
/// of c, because W may be 0.
template <Real S, bool Spins = false, bool OwnErrors = false>
struct Element {
    using M = Narrow<S>;
    S stiffness{};                                 ///< k
    S lower{}, upper{}, cross{};                   ///< A, B, and X, of any sign
    S turning{};                                   ///< c, the inertia against turning; or c W
    std::conditional_t<OwnErrors, S, M> weight{};  ///< W
    [[no_unique_address]] std::conditional_t<Spins, S, detail::Nothing<0>> spin{};  ///< s
    [[no_unique_address]] std::conditional_t<OwnErrors, ElementError<M>, detail::Nothing<1>>
        error{};

    /// Returns the element with this stiffness, spin and masses.
    static Element of(const S& stiffness, const S& spin, const S& lower, const S& upper,
                      const S& cross,
                      const ElementError<M>& error = {}) requires(Spins&& OwnErrors) {
        const S weight = (lower + cross) + (cross + upper),
                determinant = lower * upper - cross * cross;
        return {stiffness, lower, upper, cross, determinant, weight, spin, error};
    }

    /// Returns the stiffness L at x, which is a number or a pack.
    template <class X>
    [[gnu::always_inline]] X stiffness_at(const Factors<X>& x) const {
        if constexpr (Spins)
            return x.stiffness * X(stiffness) + x.spin * X(spin);
        else
            return x.stiffness * X(stiffness);
    }
    /// Returns the absolute value of the stiffness, |L|.
    template <class X>
    [[gnu::always_inline]] static X size(const X& L) {
        using std::abs;
        return Spins || OwnErrors ? abs(L) : L;
    }
    template <class X>
    [[gnu::always_inline]] static X mass_size(const X& mass) {
        using std::abs;
        return OwnErrors ? abs(mass) : mass;
    }
    /// Returns (L - c) W.
    template <class X>
    [[gnu::always_inline]] X resisted(const X& L) const {
        return OwnErrors ? L * X(weight) - X(turning) : (L - X(turning)) * X(weight);
    }
    /// Returns (L - c) W / pivot. Quotients come first: small weights' products would underflow.
    template <class X>
    [[gnu::always_inline]] X resisted_over(const X& L, const X& inverse) const {
        return OwnErrors ? resisted(L) * inverse : (L - X(turning)) * (X(weight) * inverse);
    }
    /// Returns the sum of the sizes of the terms of `resisted_over`. L and `inverse` are sizes.
    template <class X>
    [[gnu::always_inline]] X resisted_size(const X& L, const X& inverse) const {
        const X resists(mass_size(static_cast<M>(turning))),
            heavy(mass_size(static_cast<M>(weight)));
        return OwnErrors ? (L * heavy + resists) * inverse : (L + resists) * (heavy * inverse);
    }
};

template <Real S>
using SignedElement = Element<S, true, true>;

/// Returns the dynamic stiffness at an element's far pin from `near` at its other pin, by equation
/// (1) of docs/theory/counts.md. `far` is the mass at the far pin, `inverse` is 1 over the pivot.
template <class E, class S>
[[gnu::always_inline]] inline S propagate(const E& e, const S& stiffness, const S& near,
                                          const S& far, const S& inverse) {
    return (stiffness - far) * (near * inverse) - e.resisted_over(stiffness, inverse);
}

/// Returns `propagate` with one operation less after the division, if all products stay in range.
template <class E, class X>
[[gnu::always_inline]] inline X propagate_in_one_unit(const E& e, const X& stiffness, const X& near,
                                                      const X& far, const X& pivot) {
    return ((stiffness - far) * near - e.resisted(stiffness)) / pivot;
}

/// Returns equation (2), from the pins' coupling L + X: accurate if it and the pivot are small.
template <class S>
[[gnu::always_inline]] inline S propagate_by_coupling(const S& stiffness, const S& far,
                                                      const S& coupling, const S& inverse) {
    return (stiffness - far) - coupling * (coupling * inverse);
}

/// Returns the least pivot whose reciprocal can be halved for a product of double words.
template <Real M>
M least_pivot() {
    using std::ldexp;
    using limits = std::numeric_limits<M>;
    return ldexp(M(1), limits::min_exponent + (limits::digits + 1) / 2 + 3);
}

/// Returns the pivot, or a tiny positive number if it is tiny: an eigenvalue at the shift then
/// counts as not above it. `size` is |L|.
template <class S>
[[gnu::always_inline]] inline S not_zero(const S& pivot, const S& size) {
    using std::abs;
    using M = Lane<Narrow<S>>;
    const S least(least_pivot<M>());
    if constexpr (IsPack<S>)
        return if_less(abs(pivot), least, size * (epsilon<M>() * epsilon<M>()) + least, pivot);
    else
        return abs(pivot) < least ? size * (S(epsilon<S>()) * S(epsilon<S>())) + least : pivot;
}

/// The joint at the upper pin of an element, between its rotation and that of the element above,
/// or the vertical. Rotations are differences of offsets over levers.
template <Real S>
struct Joint {
    S lever{};      ///< length of the link, negative if it stands; 0: a support that yields
    S stiffness{};  ///< of the torsion spring
    S damping{};    ///< of the dashpot, or of a support's dashpot, in the unit of a stiffness
    S drag{};       ///< a sixth of the linear drag of the element, in that unit: its matrix is that
                    ///< of a uniform rod's mass, [2 1; 1 2] of it
};

/// A family of matrices Q(x), stored as elements, lowest first. It is never assembled: sums of
/// neighbouring stiffnesses lose the slowest modes. The last element's upper pin is held. Without
/// spins Q is lambda K - M of a hanging chain, with positive eigenvalues. With spins modes of one
/// sense have roots x > 0.
template <Real S, bool Spins = false, bool OwnErrors = false>
struct ElementPencil {
    static constexpr bool own_errors = OwnErrors;

    std::vector<Element<S, Spins, OwnErrors>> elements;
    /// With own errors: the element that ties the lowest pin to the ground, if that pin is held.
    std::optional<Element<S, Spins, OwnErrors>> ground{};
    bool quadratic = Spins && !OwnErrors;  ///< L = x^2 k + x s, not L = x k
    /// With own errors: springs and dashpots at all pins (pencil/jointed.hpp), or empty.
    [[no_unique_address]] std::conditional_t<OwnErrors, std::vector<Joint<S>>, detail::Nothing<2>>
        joints{};
    /// Not empty if one unit does not suffice: element m is in units of 2^units[m], ascending to 0.
    std::vector<int> units;
    /// Without own errors: the relative error of every number (for the cross mass relative to |X| +
    /// 2 c). Underflow adds `least_pivot` to masses and `stiffness_underflow` to stiffnesses.
    Narrow<S> entry_error{};
    Narrow<S> stiffness_underflow = largest_underflow();

    Index size() const { return static_cast<Index>(elements.size()); }
    template <class X>
    [[gnu::always_inline]] Factors<X> factors(const X& x) const {
        if (OwnErrors ? quadratic : Spins) return {x * x, x};
        return {x, {}};
    }
    /// Returns 4/a times the least positive number; a is the shortest length possible beside 1.
    static Narrow<S> largest_underflow() {
        using std::ldexp;
        using limits = std::numeric_limits<Narrow<S>>;
        return ldexp(limits::min() * limits::epsilon(), limits::max_exponent / 4 + 2);
    }
    /// Returns the exponent of the factor from the unit of element m - 1 to that of element m.
    int step_down(std::size_t m) const {
        return units.empty() || m == 0 ? 0 : units[m - 1] - units[m];
    }
    bool has_joints() const {
        if constexpr (OwnErrors)
            return !joints.empty();
        else
            return false;
    }
    /// Returns the pencil with every spin reversed: its roots x have the other sign.
    ElementPencil reversed() const {
        ElementPencil other = *this;
        for (auto& e : other.elements) e.spin = -e.spin;
        if (other.ground) other.ground->spin = -other.ground->spin;
        return other;
    }
};

template <Real S>
using SignedPencil = ElementPencil<S, true, true>;

/// Returns the pencil in a narrower scalar, without own errors; each entry is rounded once more.
template <Real T, Real S, bool Spins, bool OwnErrors>
ElementPencil<T, Spins, OwnErrors> rounded(const ElementPencil<S, Spins, OwnErrors>& wide) {
    if constexpr (std::is_same_v<T, S>) {
        return wide;
    } else {
        ElementPencil<T, Spins, OwnErrors> pencil;
        const auto narrow = [](const Element<S, Spins, OwnErrors>& e) {
            Element<T, Spins, OwnErrors> result{
                static_cast<T>(e.stiffness), static_cast<T>(e.lower),   static_cast<T>(e.upper),
                static_cast<T>(e.cross),     static_cast<T>(e.turning), static_cast<T>(e.weight)};
            if constexpr (Spins) result.spin = static_cast<T>(e.spin);
            return result;
        };
        pencil.elements.reserve(wide.elements.size());
        for (const auto& e : wide.elements) pencil.elements.push_back(narrow(e));
        if (wide.ground) pencil.ground = narrow(*wide.ground);
        if constexpr (OwnErrors)
            for (const Joint<S>& joint : wide.joints)
                pencil.joints.push_back(
                    {static_cast<T>(joint.lever), static_cast<T>(joint.stiffness),
                     static_cast<T>(joint.damping), static_cast<T>(joint.drag)});
        pencil.quadratic = wide.quadratic;
        pencil.units = wide.units;
        pencil.entry_error = static_cast<T>(wide.entry_error) + epsilon<T>();
        if constexpr (std::numeric_limits<T>::min_exponent ==
                      std::numeric_limits<Narrow<S>>::min_exponent)
            pencil.stiffness_underflow = static_cast<T>(wide.stiffness_underflow);
        return pencil;
    }
}

/// Returns true if a number of an element is certainly 0.
template <Real S>
bool vanishes(const S& x, const Narrow<S>& error) {
    return x == S(Narrow<S>(0)) && error == Narrow<S>(0);
}

/// Returns a pencil with own errors as one with small relative errors. It returns nothing if an
/// error exceeds 1e-20 of a number, the lowest pin is held, or weights have several units.
/// Precondition: stiffnesses > 0, masses >= 0. `Spins` says whether the family is quadratic.
template <bool Spins, Real S>
std::optional<ElementPencil<S, Spins>> positive_elements(const SignedPencil<S>& pencil) {
    using std::abs;
    if (pencil.ground || !pencil.units.empty()) return std::nullopt;
    using M = Narrow<S>;
    const S zero(M(0));
    ElementPencil<S, Spins> result;
    result.elements.reserve(pencil.elements.size());
    M worst(0);
    const auto add = [&](const M& error, const M& size) {
        worst = std::max(worst, error == M(0) ? error : error / size);
    };
    for (const SignedElement<S>& e : pencil.elements) {
        const S turning = e.weight > zero ? e.turning / e.weight : zero;
        result.elements.push_back({e.stiffness, e.lower, e.upper, e.cross,
                                   turning > zero ? turning : zero, static_cast<M>(e.weight)});
        if constexpr (Spins) {
            result.elements.back().spin = e.spin;
            add(e.error.spin, static_cast<M>(abs(e.spin)));
        }
        add(e.error.stiffness, static_cast<M>(e.stiffness));
        add(e.error.lower, static_cast<M>(e.lower));
        add(e.error.upper, static_cast<M>(e.upper));
        add(e.error.cross, static_cast<M>(abs(e.cross) + turning + turning));
    }
    result.entry_error = worst;
    if (!(worst < M(1e-20))) return std::nullopt;
    return result;
}

}  // namespace revchain::pencil
