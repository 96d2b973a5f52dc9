// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/bisection.hpp"

namespace revchain::pencil {

/// An eigenvalue with a bound on its relative error that is proved by two counts (infinite: nothing could be proved).
template <Real T>
struct Certified {
    T eigenvalue{};
    T error_bound = std::numeric_limits<T>::infinity();
};

/// Whether the eigenvalue number `j` (from 0, descending) of the exact pencil lies within a relative `margin` of
/// `eigenvalue`: proved counts at both ends of the interval. Cost: one pass of two shifts in S.
template <Real S, Real T>
bool lies_within(const ElementPencil<S>& pencil, Index j, const T& eigenvalue, const Narrow<S>& margin) {
    const S centre(static_cast<Narrow<S>>(eigenvalue));
    const S reach = centre * S(margin);
    const auto count = certified_count<S, 2>(pencil, {centre - reach, centre + reach});
    return count[0].proved && count[1].proved && count[0].above > j && count[1].above <= j;
}

/// The error bound that goes with `lies_within`: relative to the exact eigenvalue, and with the roundings of the two
/// interval ends (in S) and of itself.
template <Real S, Real T>
T bound_of_margin(const T& margin) {
    return margin * (T(1) + T(2) * margin + T(4) * epsilon<T>()) + T(4) * static_cast<T>(operation_error<S>());
}

/// Bisection by proved counts alone, from a first guess; stops where rounding in S leaves a count in doubt. The bound
/// is infinite where not even 1/2 can be proved (seen only where weights span 1e37 and lengths 1e23 together). Used
/// where the fast path's certificate is refused. Cost: about 60 passes in S.
template <Real S, Real T>
Certified<T> bisect_certified(const ElementPencil<S>& pencil, Index j, const T& guess) {
    using M = Narrow<S>;
    const S centre(static_cast<M>(guess));
    S lower = centre, upper = centre;
    bool has_lower = false, has_upper = false;
    for (M margin = M(8) * static_cast<M>(epsilon<T>()); !(has_lower && has_upper); margin = margin * M(16)) {
        if (margin > M(1e6)) return {guess};
        const S stretch = S(M(1)) + S(margin);
        const auto count = certified_count<S, 2>(pencil, {centre / stretch, centre * stretch});
        if (!has_lower && count[0].proved && count[0].above > j) lower = centre / stretch, has_lower = true;
        if (!has_upper && count[1].proved && count[1].above <= j) upper = centre * stretch, has_upper = true;
    }
    const M finest = static_cast<M>(epsilon<T>()) / M(4);
    while (static_cast<M>(upper - lower) > finest * static_cast<M>(lower)) {
        const S third = (upper - lower) / S(M(3));
        const std::array<S, 2> shifts{lower + third, upper - third};
        const auto count = certified_count<S, 2>(pencil, shifts);
        bool moved = false;
        for (std::size_t i = 0; i < 2; ++i) {
            if (!count[i].proved) continue;
            if (count[i].above > j && shifts[i] > lower) lower = shifts[i], moved = true;
            if (count[i].above <= j && shifts[i] < upper) upper = shifts[i], moved = true;
        }
        if (!moved) break;
    }
    const T eigenvalue = static_cast<T>(lower + (upper - lower) / S(M(2)));
    const M below = static_cast<M>(S(static_cast<M>(eigenvalue)) - lower);
    const M above = static_cast<M>(upper - S(static_cast<M>(eigenvalue)));
    const M worst = (below > above ? below : above) / static_cast<M>(lower);
    if (!(worst <= M(0.5))) return {eigenvalue};
    return {eigenvalue, bound_of_margin<S>(static_cast<T>(worst * (M(1) + M(4) * epsilon<M>())))};
}

}  // namespace revchain::pencil
