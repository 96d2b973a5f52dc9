// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>

#include "revchain/pencil/twisted_lanes.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // packs never leave a translation unit

namespace revchain::pencil {

/// Some heights and how sure they are.
template <std::floating_point T>
struct HeightsInLanes {
    std::array<T, shape_lanes> start;               ///< given: heights nearly right
    std::array<DoubleWord<T>, shape_lanes> height;  ///< Rayleigh quotients of the shapes at these
    std::array<T, shape_lanes> reach;               ///< an eigenvalue is proved to be that near to the exact quotient
    std::array<T, shape_lanes> blur;                ///< how far `height` may be from the exact quotient
};

namespace detail {

/// Rayleigh quotients of the shapes at `start`, `reach` and `blur` as said of `HeightsInLanes`.
template <bool lumped, class Where, class T>
[[gnu::always_inline]] inline void heights_in_lanes(Where, const std::vector<Element<DoubleWord<T>>>& elements,
                                                    const T& unit, ShapesInLanes<T>& s, HeightsInLanes<T>& result) {
    constexpr bool fused = Where::fused;
    constexpr std::size_t width = std::min(Where::doubles, shape_lanes), L = shape_lanes;
    const T u = epsilon<T>() / T(2);
    using V = Pack<T, width, L / width>;
    const V start = V::load(result.start.data());
    const V twist = twisted_in_lanes<lumped>(elements, start, s).pin;
    V y{}, hung{}, hung_error{}, square{}, stiffness{}, work{}, work_size{}, work_error{}, turned{};
    forces_left<lumped, fused, true, V>(
        elements, Pair<V>{start, V{}}, [&](std::size_t m) REVCHAIN_INLINED { return y = next_offset(s, m, twist, y); },
        [&](std::size_t m, const V& force, const V& sizes, const V& offset, const V& stretch) REVCHAIN_INLINED {
            const V k(elements[m].stiffness.high);
            V error = V(unit) * sizes + V(T(2) * u) * abs(force);
            if constexpr (!lumped) {  // the cross mass is as sure as |X| + 2 c, at both pins of a link
                const V of_link = V(T(2) * unit * elements[m].turning.high) * (abs(offset) + abs(stretch));
                error += turned + of_link;
                turned = of_link;
            }
            hung += force;
            hung_error += error + V(T(2) * u) * abs(hung);
            const V whole = abs(hung) + hung_error;
            square += whole * (whole / k);
            stiffness += k * stretch * stretch;
            work += offset * force;
            work_size += abs(offset * force);
            work_error += abs(offset) * error;
        });
    // Each sum has lost less than a 2^-20th part of itself, and `work` less than n + 16 roundings of its terms' sizes.
    const T slack = T(1) + T(0x1p-20), terms = T(elements.size() + 16);
    const V step = work / stiffness;
    const DoubleWord<V> height = two_sum(start, -step);
    for (std::size_t i = 0; i < L; ++i) {
        using std::sqrt;
        result.height[i] = {height.high[i], height.low[i]};
        result.reach[i] = sqrt(square[i] / stiffness[i]) * slack;
        result.blur[i] = ((work_error[i] + terms * u * work_size[i]) / stiffness[i] + terms * u * abs(step)[i]) * slack;
    }
}

}  // namespace detail

/// Better heights from `heights.start`. NaN or infinite where numbers leave the range of T. Precondition and cost as
/// those of `shapes_in_lanes`; `shapes` is scratch.
template <std::floating_point T>
void heights_in_lanes(const ElementPencil<DoubleWord<T>>& pencil, bool lumped, ShapesInLanes<T>& shapes,
                      HeightsInLanes<T>& heights) {
    shapes.make_room(pencil.elements.size());
    const T unit = T(32) * operation_error<DoubleWord<T>>() + T(4) * pencil.entry_error;
    simd([&](auto where) REVCHAIN_INLINED {
        if (lumped)
            detail::heights_in_lanes<true>(where, pencil.elements, unit, shapes, heights);
        else
            detail::heights_in_lanes<false>(where, pencil.elements, unit, shapes, heights);
    });
}

}  // namespace revchain::pencil

#pragma GCC diagnostic pop
