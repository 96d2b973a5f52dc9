// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/bisection.hpp"
#include "revchain/pencil/twisted_lanes.hpp"

/// Roots (heights, or x with spins) of several modes, by Rayleigh quotients of twisted vectors.
namespace revchain::inline REVCHAIN_BUILD::pencil {

template <std::floating_point T>
struct QuotientsInLanes {
    std::array<T, shape_lanes> start;             ///< input: approximate roots
    std::array<DoubleWord<T>, shape_lanes> root;  ///< y^T Q(x) y = 0, with y the vector at `start`
    std::array<T, shape_lanes> reach;             ///< proved distance of an exact root from it
    std::array<T, shape_lanes> blur;              ///< error of `root` as the quotient's root
};

namespace detail {

/// Returns the root x of x^2 k + x s = m, for k and m positive.
template <std::floating_point T>
T positive_root(const T& k, const T& s, const T& m) {
    using std::sqrt;
    const T root = sqrt(s * s + T(4) * k * m);
    return s > T(0) ? T(2) * m / (root + s) : (root - s) / (T(2) * k);
}

template <class Where, class Terms, bool Spins, class T>
[[gnu::always_inline]] inline void approach_in_lanes(
    Where, Terms terms, const ElementPencil<DoubleWord<T>, Spins>& pencil, Index first,
    Bracket<T>* brackets, std::size_t count, ShapesInLanes<T>& s, T* roots) {
    using std::abs;
    constexpr std::size_t width = std::min(Where::doubles, shape_lanes), L = shape_lanes;
    constexpr T near(0x1p-24), next_near(0x1p-40);
    constexpr int most_rounds = 100;
    using V = Pack<T, width, L / width>;
    const std::size_t n = pencil.elements.size();
    for (std::size_t j = 0; j < count; ++j)
        roots[j] = between(brackets[j].lower, brackets[j].upper);
    // `root` is the number of the root in each lane. A finished lane takes the next root.
    std::array<std::size_t, L> root;
    std::array<int, L> rounds{};
    std::array<bool, L> busy{};
    std::array<T, L> step_before{}, pin_before{};
    std::size_t next = 0;
    for (std::size_t i = 0; i < L; ++i)
        busy[i] = next < count, root[i] = busy[i] ? next++ : count - 1;
    while (std::any_of(busy.begin(), busy.end(), [](bool is) { return is; })) {
        revchain::detail::check_interrupt();
        V x;
        for (std::size_t i = 0; i < L; ++i) x.set(i, roots[root[i]]);
        const TwistInLanes<V> joined = twisted_in_lanes(terms, pencil, x, s);
        V stiffness{}, spin{}, mass{}, lower{};
        lower = next_offset(s, 0, joined.pin, lower);
        for (std::size_t m = 0; m < n; ++m) {
            const auto& e = pencil.elements[m];
            const V upper = m + 1 < n ? next_offset(s, m + 1, joined.pin, lower) : V{};
            const V stretch = lower - upper, square = stretch * stretch;
            stiffness += V(e.stiffness.high) * square;
            if constexpr (Spins) spin += V(e.spin.high) * square;
            mass += V(e.lower.high) * lower * lower;
            if constexpr (!Terms::lumped)
                mass += upper * (V(e.upper.high) * upper + V(T(2) * e.cross.high) * lower);
            lower = upper;
        }
        for (std::size_t i = 0; i < L; ++i) {
            const std::size_t j = root[i];
            if (!busy[i]) continue;
            Bracket<T>& bracket = brackets[j];
            const T at = roots[j];
            const T quotient =
                Spins ? positive_root(stiffness[i], spin[i], mass[i]) : mass[i] / stiffness[i];
            const bool exceeds =
                static_cast<Index>(joined.above[i]) > first + static_cast<Index>(j);
            (exceeds ? bracket.lower : bracket.upper) = at;
            // A step squares the error, times a factor of the pin. Two at one pin predict the next
            // step.
            const T step = abs(quotient - at), shrunk = step / step_before[i];
            const bool same_pin = rounds[i] > 0 && joined.pin[i] == pin_before[i];
            bool done =
                step <= near * at || (same_pin && step * (shrunk * shrunk) <= next_near * at);
            step_before[i] = step, pin_before[i] = joined.pin[i];
            const bool inside = quotient > bracket.lower && quotient < bracket.upper;
            roots[j] = done || inside ? quotient : between(bracket.lower, bracket.upper);
            done = done || ++rounds[i] == most_rounds ||
                   !(bracket.upper - bracket.lower > T(8) * epsilon<T>() * at);
            if (!done) continue;
            busy[i] = next < count, rounds[i] = 0;
            if (busy[i]) root[i] = next++;
        }
    }
}

template <class Where, class Terms, bool Spins, class T>
[[gnu::always_inline]] inline void quotients_in_lanes(
    Where, Terms terms, const ElementPencil<DoubleWord<T>, Spins>& pencil, const T& unit,
    ShapesInLanes<T>& s, QuotientsInLanes<T>& result) {
    constexpr bool fused = Where::fused;
    constexpr std::size_t width = std::min(Where::doubles, shape_lanes), L = shape_lanes;
    const T u = epsilon<T>() / T(2);
    using V = Pack<T, width, L / width>;
    const V start = V::load(result.start.data());
    [[maybe_unused]] const Factors<V> at = pencil.factors(start);
    const V twist = twisted_in_lanes(terms, pencil, start, s).pin;
    V y{}, hung{}, hung_error{}, square{}, stiffness{}, work{}, work_size{}, work_error{}, turned{};
    V slope{}, slope_size{}, pull{};  // of y^T Q(x) y: d/dx, and the squared norm of d/dx (L y)
    forces_left<fused, true, V>(
        terms, pencil, factors_in_pairs<fused, Spins>(start, V{}),
        [&](std::size_t m) REVCHAIN_INLINED { return y = next_offset(s, m, twist, y); },
        [&](std::size_t m, const V& force, const V& sizes, const V& offset,
            const V& stretch) REVCHAIN_INLINED {
            const auto& e = pencil.elements[m];
            const V k(e.stiffness.high);
            V error = V(unit) * sizes + V(T(2) * u) * abs(force);
            if constexpr (!Terms::lumped) {  // the error of |X| + 2 c, at both pins
                const V of_link = V(T(2) * unit * e.turning.high) * (abs(offset) + abs(stretch));
                error += turned + of_link;
                turned = of_link;
            }
            hung += force;
            hung_error += error + V(T(2) * u) * abs(hung);
            const V whole = abs(hung) + hung_error;
            square += whole * (whole / k);
            const V energy = stretch * stretch;
            stiffness += k * energy;
            if constexpr (Spins) {
                const V spin(e.spin.high), twice = V(T(2)) * at.spin * k, rate = twice + spin;
                slope += rate * energy;
                slope_size += (twice + abs(spin)) * energy;
                pull += rate * rate * energy / k;
            }
            work += offset * force;
            work_size += abs(offset * force);
            work_error += abs(offset) * error;
        });
    // Each sum has an error below 2^-20 of itself, `work` below n + 16 roundings of its terms.
    const T slack = T(1) + T(0x1p-20), terms_added = T(pencil.elements.size() + 16);
    for (std::size_t i = 0; i < L; ++i) {
        using std::abs, std::sqrt;
        const T x = result.start[i], rate = Spins ? slope[i] : stiffness[i], step = work[i] / rate;
        const DoubleWord<T> root = two_sum(x, -step);
        T reach = sqrt(square[i] / stiffness[i]);
        T blur =
            (work_error[i] + terms_added * u * work_size[i]) / rate + terms_added * u * abs(step);
        if constexpr (Spins) {
            // The residual moves from `start` to the root, and Newton's step leaves an error.
            reach = (reach + abs(step) * sqrt(pull[i] / stiffness[i])) / x;
            blur += step * (step * (stiffness[i] / rate));
            if (!(rate > T(0x1p-20) * slope_size[i] &&
                  abs(step) * stiffness[i] < T(0x1p-22) * rate))
                blur = std::numeric_limits<T>::infinity();
        }
        result.root[i] = root, result.reach[i] = reach * slack, result.blur[i] = blur * slack;
    }
}

}  // namespace detail

/// Returns roots to eleven digits or more from brackets of the roots number `first`, `first` + 1,
/// ... (from 0, descending): inverse iteration with Rayleigh quotients; counts keep it inside the
/// brackets. Cost: 2.5 ns a link, root and round; 3 rounds from a factor of 2, 2 from 3 per cent.
template <std::floating_point T, bool Spins>
std::vector<T> approached(const ElementPencil<DoubleWord<T>, Spins>& pencil, bool lumped,
                          Index first, std::vector<Bracket<T>> brackets) {
    std::vector<T> roots(brackets.size());
    revchain::detail::parallel_for(
        brackets.size(), 8 * shape_lanes, [&](std::size_t begin, std::size_t end) {
            with_shapes_in_lanes<T>(pencil.elements.size(), [&](ShapesInLanes<T>& shapes) {
                shapes.make_room(pencil.elements.size());
                simd([&](auto where) REVCHAIN_INLINED {
                    const auto approach = [&](auto terms) REVCHAIN_INLINED {
                        detail::approach_in_lanes(
                            where, terms, pencil, first + static_cast<Index>(begin),
                            &brackets[begin], end - begin, shapes, &roots[begin]);
                    };
                    if (lumped)
                        approach(detail::Terms<true>());
                    else
                        approach(detail::Terms<false>());
                });
            });
        });
    return roots;
}

/// Computes better roots from `quotients.start`; they are NaN or infinite where T overflows or
/// underflows. Preconditions: as `shapes_in_lanes`; K > 0; masses >= 0. Cost: 6 ns a link and root.
template <std::floating_point T, bool Spins>
void quotients_in_lanes(const ElementPencil<DoubleWord<T>, Spins>& pencil, bool lumped,
                        ShapesInLanes<T>& shapes, QuotientsInLanes<T>& quotients) {
    shapes.make_room(pencil.elements.size());
    const T unit = T(32) * operation_error<DoubleWord<T>>() + T(4) * pencil.entry_error;
    simd([&](auto where) REVCHAIN_INLINED {
        if (lumped)
            detail::quotients_in_lanes(where, detail::Terms<true>(), pencil, unit, shapes,
                                       quotients);
        else
            detail::quotients_in_lanes(where, detail::Terms<false>(), pencil, unit, shapes,
                                       quotients);
    });
}

}  // namespace revchain::pencil
