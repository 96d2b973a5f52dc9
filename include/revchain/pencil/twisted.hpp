// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "revchain/pencil/element.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

namespace detail {

/// Returns a where x < y, else b, like `if_less` of packs.
template <Real M, class S>
S if_less(const M& x, const M& y, const S& a, const S& b) {
    return x < y ? a : b;
}

/// Returns one() where x < y, else other(). For packs both are computed.
template <class M, class F, class G>
[[gnu::always_inline]] inline auto computed_if_less(const M& x, const M& y, const F& one,
                                                    const G& other) {
    if constexpr (IsPack<M>)
        return if_less(x, y, one(), other());
    else
        return x < y ? one() : other();
}

/// The dynamic stiffness at the other pin, the offset here over the offset there, 1 over the pivot.
template <class S>
struct Across {
    S stiffness, ratio, inverse{};
};

/// Carries stiffness across an element from `near` at one pin, by the equation, (1) or (2), that
/// rounds less. `near_mass` and `far_mass` are the element's masses at the two pins. `Lumped`: the
/// element is a point mass. A ratio near 1 is computed from its difference to 1, in the type
/// `Ratio`. So the slope of a smooth mode is not a difference of rounded offsets.
template <class Ratio, bool Lumped = false, class E, class S, class Mass>
[[gnu::always_inline]] inline Across<S> across(const E& e, const S& stiffness, const S& near,
                                               const Mass& near_mass, const Mass& far_mass) {
    using std::abs;
    using V = Narrow<S>;
    const auto size = [](const auto& x) REVCHAIN_INLINED { return abs(static_cast<V>(x)); };
    const S coupling = Lumped ? stiffness : stiffness + S(e.cross), far(far_mass);
    const S pivot = not_zero(S(near + (stiffness - S(near_mass))), e.size(stiffness));
    const S inverse = S(V(1)) / pivot;
    Across<S> result{{}, {}, inverse};
    Ratio change = static_cast<Ratio>(coupling - pivot);
    if constexpr (IsPack<S>)
        change *= inverse;
    else
        change = change / static_cast<Ratio>(pivot);
    result.ratio = computed_if_less(
        size(change), V(Lane<V>(0.5)), [&]() REVCHAIN_INLINED { return S(V(1)) + S(change); },
        [&]() REVCHAIN_INLINED { return coupling * inverse; });
    if constexpr (Lumped) {
        result.stiffness = near_mass == Mass(0) ? stiffness * (near * inverse) - far
                                                : stiffness * ((near - S(near_mass)) * inverse);
    } else {
        const auto mass = [&](const auto& x)
                              REVCHAIN_INLINED { return V(e.mass_size(static_cast<Lane<V>>(x))); };
        const V k = static_cast<V>(e.size(stiffness)), far_size = mass(far_mass),
                over = size(inverse);
        const V of_coupling =
            V(2) * size(coupling) * ((k + mass(e.weight) + mass(near_mass) + far_size) * over);
        const V of_weight = (k + far_size) * (size(near) * over) + e.resisted_size(k, over);
        result.stiffness = computed_if_less(
            of_coupling + (k + far_size), of_weight,
            [&]() REVCHAIN_INLINED {
                return propagate_by_coupling(stiffness, far, coupling, inverse);
            },
            [&]() REVCHAIN_INLINED { return propagate(e, stiffness, near, far, inverse); });
    }
    return result;
}

/// Returns x in another unit, limited to the range of the scalar: the limit is practically rigid.
template <Real S>
S rescaled(const S& x, int step) {
    using std::abs, std::ldexp;
    using T = Narrow<S>;
    if (step == 0) return x;
    const S limit(ldexp(T(1), std::numeric_limits<T>::max_exponent / 2));
    if (step > 0 && abs(x) > ldexp(limit, -step)) return x < S(T(0)) ? -limit : limit;
    return ldexp(x, step);
}

/// Offsets of pins 0 ... n from a twisted factorisation, 1 at `pin`. Below it each is `down` times
/// the offset of the pin above; above it each is `up` times the offset of the pin below.
template <class S>
struct Twisted {
    std::vector<S> offset, down, up;
    Narrow<S> pin;
};

/// Returns offsets of pins 0 ... n of n elements, the last pin held, by twisted factorisation. The
/// dynamic stiffness D of everything below each pin is carried up, and U, that of everything above,
/// is carried down. |D + U| is least where the mode is largest; from there offsets follow outwards
/// by ratios. `rise(m, D)` returns D above element m and the ratio of its lower offset to the
/// upper. `sink(m, U)` returns U below it and the inverse ratio. Both convert to the unit of
/// element m. `forces(m)` returns the size of the terms at the lower pin of element m. `footing` is
/// D at the lowest pin. S may be a pack.
template <class S, class Rise, class Sink, class Forces>
[[gnu::always_inline]] inline Twisted<S> twisted(std::size_t n, const Rise& rise, const Sink& sink,
                                                 const Forces& forces, const S& footing = S{}) {
    using std::abs;
    using V = Narrow<S>;
    using T = Lane<V>;
    const auto number = [](std::size_t m) REVCHAIN_INLINED { return V(T(static_cast<double>(m))); };
    const S zero(V(T(0))), one(V(T(1)));
    Twisted<S> result{std::vector<S>(n + 1), std::vector<S>(n), std::vector<S>(n), number(n - 1)};
    auto& [offset, down, up, pin] = result;
    S below = footing, above = zero;
    for (std::size_t m = 0; m < n; ++m) {
        offset[m] = below;  // the stiffness D, until offsets replace it
        const Across<S> across = rise(m, below);
        below = across.stiffness, down[m] = across.ratio;
    }
    V least(std::numeric_limits<T>::infinity());
    for (std::size_t m = n; m-- > 0;) {
        const Across<S> across = sink(m, above);
        above = across.stiffness, up[m] = across.ratio;
        // The balance is relative to the forces at the pin. Otherwise a light pin that moves far
        // would be chosen instead of the heavy one that determines the mode, and the ratios between
        // them would cancel.
        const V balance = abs(static_cast<V>(offset[m] + above)) / forces(m);
        pin = if_less(balance, least, number(m), pin);
        least = if_less(balance, least, balance, least);
    }
    offset[n] = zero;
    for (std::size_t m = n; m-- > 0;)
        offset[m] = if_less(number(m), pin, down[m] * offset[m + 1], one);
    for (std::size_t m = 1; m < n; ++m)
        offset[m] = if_less(pin, number(m), up[m - 1] * offset[m - 1], offset[m]);
    return result;
}

/// Returns a function (element, pin) for offsets in one unit for all elements; the largest is about
/// 1. `share` is 1 for forces (offsets times weights), and 2 for energies (squares of offsets).
template <Real S, bool Spins, bool OwnErrors, class Offsets>
auto in_one_unit(const ElementPencil<S, Spins, OwnErrors>& pencil, const Offsets& offset,
                 int share) {
    using std::frexp, std::ldexp;
    const auto* const at = offset.data();
    using T = std::decay_t<decltype(*at)>;
    std::optional<int> largest;
    for (std::size_t m = 0; m < pencil.units.size(); ++m)
        for (const T& y : {at[m], at[m + 1]}) {
            if (y == T(0)) continue;
            int exponent = 0;
            frexp(y, &exponent);
            largest = std::max(largest.value_or(std::numeric_limits<int>::min()),
                               exponent + pencil.units[m] / share);
        }
    return [&pencil, at, share, unit = largest.value_or(0)](std::size_t element, std::size_t pin) {
        const T y = pencil.units.empty() ? at[pin]
                                         : T(ldexp(at[pin], pencil.units[element] / share - unit));
        return S(static_cast<std::conditional_t<std::is_same_v<S, T>, S, Narrow<S>>>(y));
    };
}

}  // namespace detail

/// A point where a mode crosses the axis: in `element`, at `share` of its length above its lower
/// pin.
template <Real T>
struct Crossing {
    Index element{};
    T share{};
};

/// Offsets of pins 0 ... N, free end first, the held pin last (0). The largest has size 1, and the
/// free end is positive. Crossings and signs are right even where offsets underflow.
template <Real T>
struct Eigenvector {
    Vector<T> offset;
    std::vector<Crossing<T>> crossings;  ///< lowest first, the held pin left out
};

/// Returns the offsets of a dense solver as a normalised eigenvector, with its crossings.
template <Real T>
Eigenvector<T> normalised(Vector<T> offset) {
    using std::abs;
    Eigenvector<T> result;
    T largest(0), side(0), sign(0);  // side: last offset that is not 0; sign: first such offset
    for (Index m = 0; m < offset.size(); ++m) {
        const T y = offset[m];
        if (abs(y) > largest) largest = abs(y);
        if (y == T(0)) continue;
        if (sign == T(0)) sign = y;
        if (m + 1 < offset.size() && side != T(0) && (y < T(0)) != (side < T(0)))
            result.crossings.push_back(
                {m - 1, offset[m - 1] == T(0) ? T(0) : offset[m - 1] / (offset[m - 1] - y)});
        side = y;
    }
    if (sign < T(0)) largest = -largest;
    for (T& y : offset) y = y / largest + T(0);  // no -0
    result.offset = std::move(offset);
    return result;
}

/// An eigenvector before rounding: the free end of offset / `largest` is positive.
template <Real S>
struct UnroundedEigenvector {
    std::vector<S> offset;
    S largest;
    std::vector<Crossing<Narrow<S>>> crossings;
};

/// Returns offsets with their largest size and the elements that cross the axis.
template <Real S>
UnroundedEigenvector<S> with_crossings(std::vector<S> offset) {
    using T = Narrow<S>;
    using std::abs;
    UnroundedEigenvector<S> result{std::move(offset), S(T(0)), {}};
    const auto& y = result.offset;
    for (const S& each : y)
        if (abs(each) > result.largest) result.largest = abs(each);
    for (std::size_t m = 0; m + 1 < y.size(); ++m)
        if (static_cast<T>(y[m]) * static_cast<T>(y[m + 1]) < T(0))
            result.crossings.push_back(
                {static_cast<Index>(m), static_cast<T>(y[m] / (y[m] - y[m + 1]))});
    if (y.front() < S(T(0))) result.largest = -result.largest;  // the free end must be positive
    return result;
}

/// Returns the eigenvector of the pencil at an eigenvalue, by `detail::twisted`. (The plain upward
/// recurrence loses 3e-11 near the support at N = 1e5.) Source: Dhillon, Parlett (2004),
/// doi:10.1016/j.laa.2003.12.028, applied to elements. Cost: two passes; scratch of three numbers
/// of S per link. Accuracy, relative to the largest offset, measured
/// (tests/cpp/pencil/twisted.cpp): with S a double word 3.5e-16 for all modes up to N = 1000 and
/// 6e-17 for the slowest at N = 1e5. With S = double it is 1.5e-15 / gap up to N = 1000 and 6e-13
/// at 1e5. The gap (at most 1) is the relative distance to the next eigenvalue. An error e in
/// `eigenvalue` adds e / gap. `Ratio` is the scalar of ratios of neighbours; if it is S, slopes are
/// as accurate as offsets.
template <class Ratio, Real S, bool Spins, bool OwnErrors>
UnroundedEigenvector<S> unrounded_eigenvector(const ElementPencil<S, Spins, OwnErrors>& pencil,
                                              const S& root) {
    using std::abs;
    using T = Narrow<S>;
    if constexpr (OwnErrors)
        if (pencil.has_joints()) return with_crossings(jointed_vector(pencil, root));
    const auto& elements = pencil.elements;
    const Factors<S> x = pencil.factors(root);
    const auto rise = [&](std::size_t m, S& below) {
        const auto& e = elements[m];
        below = detail::rescaled(below, pencil.step_down(m));
        return detail::across<Ratio>(e, e.stiffness_at(x), below, e.lower, e.upper);
    };
    const auto sink = [&](std::size_t m, S& above) {
        const auto& e = elements[m];
        const S stiffness = e.stiffness_at(x);
        if (m + 1 == elements.size())
            return detail::Across<S>{stiffness - e.lower, S(T(0))};  // the support is rigid
        above = detail::rescaled(above, -pencil.step_down(m + 1));
        return detail::across<Ratio>(e, stiffness, above, e.upper, e.lower);
    };
    const auto meeting = [&](const auto& e, const S& mass) {
        return abs(static_cast<T>(e.stiffness_at(x))) + abs(static_cast<T>(mass));
    };
    const auto forces = [&](std::size_t m) {
        const T own = meeting(elements[m], elements[m].lower);
        if (m == 0)
            return pencil.ground ? own + meeting(*pencil.ground, pencil.ground->upper) : own;
        const auto& hung = elements[m - 1];
        return own + detail::rescaled(meeting(hung, hung.upper), pencil.step_down(m));
    };
    const S footing =
        pencil.ground ? S(pencil.ground->stiffness_at(x) - pencil.ground->upper) : S(T(0));
    auto [offset, down, up, pin] = detail::twisted<S>(elements.size(), rise, sink, forces, footing);
    UnroundedEigenvector<S> result{std::move(offset), S(T(0)), {}};
    for (const S& y : result.offset)
        if (abs(y) > result.largest) result.largest = abs(y);
    for (std::size_t m = 0; m < elements.size(); ++m) {
        const bool lies_below = T(static_cast<double>(m)) < pin;
        const T ratio = static_cast<T>(lies_below ? down[m] : up[m]);
        if (!(ratio < T(0))) continue;
        const T share = lies_below ? ratio / (ratio - T(1)) : T(1) / (T(1) - ratio);
        result.crossings.push_back({static_cast<Index>(m), share});
        if (lies_below) result.largest = -result.largest;  // the free end must be positive
    }
    return result;
}

/// Returns offsets of pins 0 ... N in S, held pin last: largest size 1, free end positive.
template <Real S, bool Spins, bool OwnErrors>
std::vector<S> twisted_vector(const ElementPencil<S, Spins, OwnErrors>& pencil, const S& root) {
    auto [offset, largest, crossings] = unrounded_eigenvector<S>(pencil, root);
    for (S& y : offset) y = y / largest + S(Narrow<S>(0));
    return std::move(offset);
}

/// Returns the eigenvector, rounded to the narrower scalar. For a pencil with own errors, ratios of
/// neighbours have the digits of S.
template <Real S, bool Spins, bool OwnErrors>
Eigenvector<Narrow<S>> eigenvector(const ElementPencil<S, Spins, OwnErrors>& pencil,
                                   const S& root) {
    using T = Narrow<S>;
    using Ratio = std::conditional_t<OwnErrors, S, T>;
    UnroundedEigenvector<S> vector = unrounded_eigenvector<Ratio>(pencil, root);
    Eigenvector<T> result{Vector<T>(pencil.size() + 1), std::move(vector.crossings)};
    for (Index m = 0; m <= pencil.size(); ++m)
        result.offset[m] =
            static_cast<T>(vector.offset[static_cast<std::size_t>(m)] / vector.largest + S(T(0)));
    return result;
}

/// Returns y^T M y of one element, from the offsets of its pins.
template <class E, Real S>
S mass_form(const E& e, const S& lower, const S& upper) {
    const S cross = e.cross * upper;
    return lower * (e.lower * lower + (cross + cross)) + e.upper * upper * upper;
}

/// Returns the root x of y^T Q(x) y = 0 in S, from offsets of pins 0 ... N, not all 0, which may be
/// in a narrower scalar. Its error is the square of theirs (offsets good to 1e-13 give a root good
/// to 1e-25). For a hanging chain without spins it is y^T M y / y^T K y, two sums of positive
/// terms. For a quadratic family it is the root next to `near`, by Newton's method. Cost: one pass,
/// no division.
template <Real S, bool Spins, bool OwnErrors, class Offsets>
S rayleigh_quotient(const ElementPencil<S, Spins, OwnErrors>& pencil, const Offsets& offset,
                    const S& near = {}) {
    const auto offsets = detail::in_one_unit(pencil, offset, 2);
    const S zero(Narrow<S>(0));
    S mass = zero, stiffness = zero, spin = zero;
    const auto add = [&](const auto& e, const S& lower, const S& upper) {
        const S difference = lower - upper, square = difference * difference;
        mass = mass + mass_form(e, lower, upper);
        stiffness = stiffness + e.stiffness * square;
        if constexpr (Spins) spin = spin + e.spin * square;
    };
    if (pencil.ground) add(*pencil.ground, zero, offsets(0, 0));
    for (std::size_t m = 0; m < pencil.elements.size(); ++m)
        add(pencil.elements[m], offsets(m, m), offsets(m, m + 1));
    if constexpr (OwnErrors)
        if (pencil.has_joints()) {
            std::vector<S> all;
            for (std::size_t m = 0; m <= pencil.elements.size(); ++m) all.push_back(offsets(0, m));
            stiffness = stiffness + spring_form(pencil, all);
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

/// Returns the backward error of a root and offsets, max |Q(x) y| / max (|L| |y| + |M| |y|): the
/// largest residual force over the largest sum of the sizes of the terms at a pin. It is evaluated
/// in S, so that it is the error of the offsets and not of the evaluation. Cost: one pass.
template <Real S, bool Spins, bool OwnErrors, Real X, Real T>
T relative_residual(const ElementPencil<S, Spins, OwnErrors>& pencil, const X& root,
                    const Vector<T>& offset) {
    using std::abs;
    using M = Narrow<S>;
    const auto size_of = [](const S& x) { return abs(static_cast<M>(x)); };
    const auto offsets = detail::in_one_unit(pencil, offset, 1);
    const Factors<S> x =
        pencil.factors(S(static_cast<std::conditional_t<std::is_same_v<X, S>, S, M>>(root)));
    if constexpr (OwnErrors)
        if (pencil.has_joints()) {
            std::vector<S> all;
            for (std::size_t m = 0; m <= pencil.elements.size(); ++m) all.push_back(offsets(0, m));
            return static_cast<T>(jointed_residual(pencil, x, all));
        }
    M largest(0), worst(0), size(0);
    S force(M(0));  // the force of the link below
    const auto pass = [&](const auto& e, const S& lower, const S& upper, bool is_ground) {
        S spring = x.stiffness * e.stiffness;
        M stiffness_size = size_of(spring);
        if constexpr (Spins) {
            spring = spring + x.spin * e.spin;
            stiffness_size += size_of(x.spin * e.spin);
        }
        spring = spring * (lower - upper);
        const M spring_size = stiffness_size * (size_of(lower) + size_of(upper));
        if (!is_ground) {
            const M masses = size_of(e.lower * lower) + size_of(e.cross * upper);
            worst =
                std::max(worst, size_of(force + (spring - (e.lower * lower + e.cross * upper))));
            largest = std::max(largest, size + spring_size + masses);
        }
        force = -spring - (e.cross * lower + e.upper * upper);
        size = spring_size + size_of(e.cross * lower) + size_of(e.upper * upper);
    };
    if (pencil.ground) pass(*pencil.ground, S(M(0)), offsets(0, 0), true);
    for (std::size_t m = 0; m < pencil.elements.size(); ++m)
        pass(pencil.elements[m], offsets(m, m), offsets(m, m + 1), false);
    return largest > M(0) ? static_cast<T>(worst / largest) : T(0);
}

}  // namespace revchain::pencil
