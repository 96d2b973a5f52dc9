// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "revchain/pencil/element.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

namespace detail {

/// cross / pivot, the ratio of two neighbouring offsets, from its difference to 1 where that is small: the slope of a
/// smooth mode is then not the difference of two rounded offsets. The difference in digits of T, enough for offsets
/// that are rounded to T in the end.
template <class T, Real S>
S ratio(const S& cross, const S& pivot) {
    using std::abs;
    const T change = static_cast<T>(cross - pivot) / static_cast<T>(pivot);
    return abs(static_cast<Narrow<S>>(change)) < Narrow<S>(0.5) ? S(T(1)) + S(change) : cross / pivot;
}

/// Dynamic stiffness carried across an element by the one of equations (1) and (2) that rounds less, and the ratio of
/// the offset at `near`'s pin to that at the other; `near_mass` and `far_mass` are the element's own at the two pins.
template <Real S>
struct Across {
    S stiffness, ratio;
};

template <class Ratio, Real S>
Across<S> across(const Element<S>& e, const S& stiffness, const S& near, const S& near_mass, const S& far_mass) {
    using std::abs;
    using T = Narrow<S>;
    const S coupling = stiffness + e.cross;
    const S pivot = not_zero(near + (stiffness - near_mass), stiffness);
    const S inverse = S(T(1)) / pivot;
    const T k = static_cast<T>(stiffness), far = static_cast<T>(far_mass), p = abs(static_cast<T>(pivot));
    const T by_coupling =
        T(2) * abs(static_cast<T>(coupling)) * ((k + e.weight + static_cast<T>(near_mass) + far) / p) + (k + far);
    const T by_weight = (k + far) * (abs(static_cast<T>(near)) / p) + (k + static_cast<T>(e.turning)) * (e.weight / p);
    return {by_coupling < by_weight ? propagate_by_coupling(stiffness, far_mass, coupling, inverse)
                                    : propagate(e, stiffness, near, far_mass, inverse),
            ratio<Ratio>(coupling, pivot)};
}

/// x in another unit, held where it would leave the range of the scalar: all but rigid.
template <Real S>
S rescaled(const S& x, int step) {
    using std::abs;
    using std::ldexp;
    using T = Narrow<S>;
    if (step == 0) return x;
    const S limit(ldexp(T(1), std::numeric_limits<T>::max_exponent / 2));
    if (step > 0 && abs(x) > ldexp(limit, -step)) return x < S(T(0)) ? -limit : limit;
    return ldexp(x, step);
}

}  // namespace detail

/// Where a mode crosses the axis: in `element`, at `share` of its length from its lower pin.
template <Real T>
struct Crossing {
    Index element{};
    T share{};
};

/// Offsets of pins 0 ... N, free end first, the held pin last (0): the largest is 1 in size, the free end positive.
/// Crossings and the free end's sign are those of the exact ratios of neighbours: they outlast offsets that underflow.
template <Real T>
struct Eigenvector {
    Vector<T> offset;
    std::vector<Crossing<T>> crossings;  ///< lowest first, the held pin left out
};

/// Normalises the offsets that a dense solver gives.
template <Real T>
Eigenvector<T> normalised(Vector<T> offset) {
    using std::abs;
    Eigenvector<T> result;
    T largest(0), side(0), sign(0);  // side: the offset last seen off the axis; sign: the first
    for (Index m = 0; m < offset.size(); ++m) {
        const T y = offset[m];
        if (abs(y) > largest) largest = abs(y);
        if (y == T(0)) continue;
        if (sign == T(0)) sign = y;
        if (m + 1 < offset.size() && side != T(0) && (y < T(0)) != (side < T(0)))
            result.crossings.push_back({m - 1, offset[m - 1] == T(0) ? T(0) : offset[m - 1] / (offset[m - 1] - y)});
        side = y;
    }
    if (sign < T(0)) largest = -largest;
    for (T& y : offset) y = y / largest + T(0);  // no -0
    result.offset = std::move(offset);
    return result;
}

/// An eigenvector before it is rounded to the narrower scalar: divide the offsets by `largest`, whose sign makes the
/// free end positive.
template <Real S>
struct UnroundedEigenvector {
    std::vector<S> offset;
    S largest;
    std::vector<Crossing<Narrow<S>>> crossings;
};

namespace detail {

/// Offsets of pins 0 ... n of a string of n elements, the last pin held, by twisted factorisation:
/// dynamic stiffness D of what hangs below each pin, going up, and E of what holds it from above,
/// going down; they balance best (|D + E| least) where the mode is largest, and from there the
/// offsets follow outwards by ratios without cancellation. `rise(m, D)` returns D above element m
/// and the ratio of its lower offset to the upper; `sink(m, E)` E below it and the inverse ratio.
/// Both bring what they are given into the unit of element m. `forces(m)` returns the size of what
/// meets at the lower pin of element m. `footing` is D at the lowest pin.
template <Real S, class Rise, class Sink, class Forces>
UnroundedEigenvector<S> twisted(std::size_t n, const Rise& rise, const Sink& sink, const Forces& forces,
                                const S& footing = S(Narrow<S>(0))) {
    using std::abs;
    using T = Narrow<S>;
    struct Pin {
        S stiffness_below;  // D
        S down;             // offset of this pin over that of the pin above
        S up;               // offset of the pin above over that of this pin
    };
    std::vector<Pin> pins(n);
    S below = footing, above(T(0));
    for (std::size_t m = 0; m < n; ++m) {
        const Across<S> across = rise(m, below);
        pins[m].stiffness_below = below, pins[m].down = across.ratio;
        below = across.stiffness;
    }
    std::size_t twist = n - 1;
    T least = std::numeric_limits<T>::infinity();
    for (std::size_t m = n; m-- > 0;) {
        const Across<S> across = sink(m, above);
        above = across.stiffness, pins[m].up = across.ratio;
        // In units of the forces at the pin: unscaled, a light pin that moves far beats the heavy one that sets the
        // mode, and the ratios between them cancel.
        const T balance = abs(static_cast<T>(pins[m].stiffness_below + above)) / forces(m);
        if (balance < least) least = balance, twist = m;
    }
    UnroundedEigenvector<S> result{std::vector<S>(n + 1), S(T(0)), {}};
    std::vector<S>& offset = result.offset;
    offset[twist] = S(T(1));
    for (std::size_t m = twist; m-- > 0;) offset[m] = pins[m].down * offset[m + 1];
    for (std::size_t m = twist; m < n; ++m) offset[m + 1] = pins[m].up * offset[m];
    for (const S& y : offset)
        if (abs(y) > result.largest) result.largest = abs(y);
    for (std::size_t m = 0; m < n; ++m) {
        const T down = static_cast<T>(pins[m].down), up = static_cast<T>(pins[m].up);
        if (m < twist && down < T(0)) {
            result.crossings.push_back({static_cast<Index>(m), down / (down - T(1))});
            result.largest = -result.largest;  // the free end is to be positive; each crossing below changes its sign
        }
        if (m >= twist && up < T(0)) result.crossings.push_back({static_cast<Index>(m), T(1) / (T(1) - up)});
    }
    return result;
}

}  // namespace detail

/// Eigenvector of the pencil at an eigenvalue, by `detail::twisted`. The plain upward recurrence loses 3e-11 near the
/// support at N = 1e5. Dhillon, Parlett (2004), doi:10.1016/j.laa.2003.12.028, carried over to elements.
/// Cost: two passes, four numbers of S per link of scratch. Accuracy, of the largest offset, measured: with S a double
/// word 3.5e-16 for all modes up to N = 1000 and 6e-17 for the slowest at N = 1e5 (tests/cpp/pencil/twisted.cpp); with
/// S = double 1.5e-15 / gap up to N = 1000 and 6e-13 at 1e5, where gap (at most 1) is the relative distance to the next
/// eigenvalue. An error e in `eigenvalue` adds e / gap.
/// Ratio: what the ratios of neighbours are kept in. With S itself the slopes, too, are good to the digits of S.
template <class Ratio, Real S>
UnroundedEigenvector<S> unrounded_eigenvector(const ElementPencil<S>& pencil, const S& eigenvalue) {
    using T = Narrow<S>;
    const auto& elements = pencil.elements;
    const auto rise = [&](std::size_t m, S& below) {
        const Element<S>& e = elements[m];
        below = detail::rescaled(below, pencil.step_down(m));
        return detail::across<Ratio>(e, eigenvalue * e.stiffness, below, e.lower, e.upper);
    };
    const auto sink = [&](std::size_t m, S& above) {
        const Element<S>& e = elements[m];
        const S stiffness = eigenvalue * e.stiffness;
        if (m + 1 == elements.size()) return detail::Across<S>{stiffness - e.lower, S(T(0))};  // infinitely stiff above
        above = detail::rescaled(above, -pencil.step_down(m + 1));
        return detail::across<Ratio>(e, stiffness, above, e.upper, e.lower);
    };
    const auto forces = [&](std::size_t m) {
        const T own = static_cast<T>(eigenvalue * elements[m].stiffness) + static_cast<T>(elements[m].lower);
        if (m == 0) return own;
        const Element<S>& hung = elements[m - 1];
        return own + detail::rescaled(static_cast<T>(eigenvalue * hung.stiffness) + static_cast<T>(hung.upper),
                                      pencil.step_down(m));
    };
    return detail::twisted<S>(elements.size(), rise, sink, forces);
}

/// Returns the eigenvector, rounded to the narrower scalar.
template <Real S>
Eigenvector<Narrow<S>> eigenvector(const ElementPencil<S>& pencil, const S& eigenvalue) {
    using T = Narrow<S>;
    UnroundedEigenvector<S> vector = unrounded_eigenvector<Narrow<S>>(pencil, eigenvalue);
    Eigenvector<T> result{Vector<T>(pencil.size() + 1), std::move(vector.crossings)};
    for (Index m = 0; m <= pencil.size(); ++m)
        result.offset[m] = static_cast<T>(vector.offset[static_cast<std::size_t>(m)] / vector.largest + S(T(0)));
    return result;
}

namespace detail {

/// A function (element, pin) that returns offsets brought to one unit for all elements where their own differ: forces
/// are as offsets times weights (`share` 1), energies as squares of offsets times weights (`share` 2). The largest is
/// then of the order of 1.
template <Real S, Real T>
auto in_one_unit(const ElementPencil<S>& pencil, const Vector<T>& offset, int share) {
    using std::frexp;
    using std::ldexp;
    std::optional<int> largest;
    for (std::size_t m = 0; m < pencil.units.size(); ++m)
        for (const T& y : {offset[static_cast<Index>(m)], offset[static_cast<Index>(m) + 1]}) {
            if (y == T(0)) continue;
            int exponent = 0;
            frexp(y, &exponent);
            largest = std::max(largest.value_or(std::numeric_limits<int>::min()), exponent + pencil.units[m] / share);
        }
    return [&pencil, &offset, share, unit = largest.value_or(0)](std::size_t element, Index pin) {
        const T& y = offset[pin];
        return S(static_cast<Narrow<S>>(pencil.units.empty() ? y : T(ldexp(y, pencil.units[element] / share - unit))));
    };
}

}  // namespace detail

/// y^T M y of one element, from the offsets of its pins.
template <class E, Real S>
S mass_form(const E& e, const S& lower, const S& upper) {
    const S cross = e.cross * upper;
    return lower * (e.lower * lower + (cross + cross)) + e.upper * upper * upper;
}

/// lambda = y^T M y / y^T K y in S, element by element, from offsets in a narrower scalar: its error is the square of
/// theirs, so that offsets good to 1e-13 give a quotient good to 1e-25. Both sums have positive terms only.
/// Preconditions: offsets of pins 0 ... N, not all 0. Cost: one pass, no division.
template <Real S, Real T>
S rayleigh_quotient(const ElementPencil<S>& pencil, const Vector<T>& offset) {
    const auto offsets = detail::in_one_unit(pencil, offset, 2);
    S inertia(0), stiffness(0);
    for (std::size_t m = 0; m < pencil.elements.size(); ++m) {
        const Element<S>& e = pencil.elements[m];
        const S lower = offsets(m, static_cast<Index>(m)), upper = offsets(m, static_cast<Index>(m) + 1);
        const S difference = lower - upper;
        inertia = inertia + mass_form(e, lower, upper);
        stiffness = stiffness + e.stiffness * difference * difference;
    }
    return inertia / stiffness;
}

namespace detail {

/// The largest force left unbalanced at a pin over the largest sum of the sizes of its terms, of a
/// string of elements whose last pin is held. `link(m)` returns element m: its stiffness at the
/// eigenvalue, the size of what that is made of, the masses, and the offsets of its pins. `ground`
/// is the element below the lowest pin, if there is one.
template <Real S>
struct LoadedElement {
    S stiffness;
    Narrow<S> stiffness_size;
    S lower_mass, cross, upper_mass, lower, upper;
};
template <Real S, class Link>
Narrow<S> relative_residual(std::size_t n, const Link& link, const LoadedElement<S>& ground = {}) {
    using std::abs;
    using M = Narrow<S>;
    const auto size_of = [](const S& x) { return abs(static_cast<M>(x)); };
    M largest(0), worst(0), size(0);
    S force(M(0));  // from the link below
    for (std::size_t m = 0; m <= n; ++m) {
        const LoadedElement<S> e = m == 0 ? ground : link(m - 1);
        const S spring = e.stiffness * (e.lower - e.upper);
        const M spring_size = e.stiffness_size * (size_of(e.lower) + size_of(e.upper));
        if (m > 0) {
            const M terms = size_of(e.lower_mass * e.lower) + size_of(e.cross * e.upper);
            worst = std::max(worst, size_of(force + (spring - (e.lower_mass * e.lower + e.cross * e.upper))));
            largest = std::max(largest, size + spring_size + terms);
        }
        force = -spring - (e.cross * e.lower + e.upper_mass * e.upper);
        size = spring_size + size_of(e.cross * e.lower) + size_of(e.upper_mass * e.upper);
    }
    return largest > M(0) ? worst / largest : M(0);
}

}  // namespace detail

/// Backward error of (eigenvalue, offset): the largest force left unbalanced at a pin, relative to the largest sum of
/// the forces' terms that meet at a pin, max |(lambda K - M) y| / max (|lambda K| |y| + |M| |y|). Evaluated in S, so
/// that what is reported is the error of the offsets and not of the evaluation. Cost: one pass.
template <Real S, Real T>
T relative_residual(const ElementPencil<S>& pencil, const T& eigenvalue, const Vector<T>& offset) {
    using std::abs;
    using M = Narrow<S>;
    const auto offsets = detail::in_one_unit(pencil, offset, 1);
    const auto link = [&](std::size_t m) {
        const Element<S>& e = pencil.elements[m];
        const S k = e.stiffness * S(static_cast<M>(eigenvalue));
        const Index pin = static_cast<Index>(m);
        return detail::LoadedElement<S>{
            k, abs(static_cast<M>(k)), e.lower, e.cross, e.upper, offsets(m, pin), offsets(m, pin + 1)};
    };
    return static_cast<T>(detail::relative_residual<S>(pencil.elements.size(), link));
}

}  // namespace revchain::pencil
