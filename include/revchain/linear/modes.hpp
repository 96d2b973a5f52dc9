// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linalg/certificate.hpp"
#include "revchain/linear/mode_table.hpp"

namespace revchain {

/// The `count` slowest whirl speeds of small amplitude, Greenhill (1908) §8 (21) with sec delta = 1.
///
/// Method: bisection on counts in T, eight shifts to a pass; twisted shapes; a Rayleigh quotient in `Wide<T>`; and two
/// proved counts and the shape in `Wide<T>` for every mode. With a loose `rtol` the quotient is left out and the rest
/// done in T.
/// Accuracy: conical heights within 0.501 ulp of the exact ones of the stored numbers (measured, N up to 1e5, ten kinds
/// of chain: tests/cpp/linear/modes.cpp), error bound 2 ulp and proved; a loose `rtol` is kept by the bound. Shapes
/// 3.5e-16 of the largest offset; with a loose `rtol` as good as their height, rtol / (gap to the next height).
/// Cost: about 0.55 microseconds per link and mode with shapes, 0.3 without (double); O(N k) memory.
/// Throws InvalidArgument for count < 1 or above `chain.mode_count()`, and for a tolerance that is negative or NaN; a
/// tolerance out of reach is `Status::tolerance_not_met` with the bounds reached.
template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options = {});

namespace detail {

/// The eigenvector in `Wide<T>` at a height in `Wide<T>`, rounded to T.
template <Real T>
linalg::Eigenvector<T> fine_shape(const linalg::ElementPencil<Wide<T>>& wide, const Wide<T>& height) {
    if constexpr (std::is_same_v<Narrow<Wide<T>>, T>) {
        return linalg::eigenvector(wide, height);
    } else {
        const auto vector = linalg::eigenvector(wide, height);
        linalg::Eigenvector<T> rounded{vector.offset.template cast<T>(), {}};
        for (const auto& crossing : vector.crossings)
            rounded.crossings.push_back({crossing.element, static_cast<T>(crossing.share)});
        return rounded;
    }
}

/// Height number `j` to `goal`, from its bracket: the cheapest certificate first. `shape`, if asked for, is computed in
/// T where the tolerance is loose and else in `Wide<T>` at the height before it is rounded.
template <Real T>
linalg::Certified<T> polish(const linalg::ElementPencil<Wide<T>>& wide, const linalg::ElementPencil<T>& pencil, Index j,
                            const linalg::Bracket<T>& bracket, const T& goal, bool loose,
                            linalg::Eigenvector<T>* shape) {
    using S = Wide<T>;
    using M = Narrow<S>;
    const T start = linalg::between(bracket.lower, bracket.upper);
    if (loose) {
        const T margin = goal / T(2);
        if (linalg::lies_within<T>(pencil, j, start, margin)) {
            if (shape != nullptr) *shape = linalg::eigenvector(pencil, start);
            return {start, linalg::bound_of_margin<T>(margin)};
        }
    }
    // One round nearly always, two at most: the quotient's error is the square of the vector's.
    const T margin = T(2) * epsilon<T>();
    T height = start;
    for (int round = 0; round < 2; ++round) {
        const S quotient = linalg::rayleigh_quotient<S>(wide, linalg::eigenvector(pencil, height).offset);
        height = static_cast<T>(quotient);
        if (linalg::lies_within<S>(wide, j, height, static_cast<M>(margin))) {
            if (shape != nullptr) *shape = fine_shape<T>(wide, quotient);
            return {height, linalg::bound_of_margin<S>(margin)};
        }
    }
    const auto sure = linalg::bisect_certified<S>(wide, j, start);
    if (shape != nullptr) {
        const S near(static_cast<M>(sure.eigenvalue));
        *shape = fine_shape<T>(wide, linalg::rayleigh_quotient<S>(wide, linalg::eigenvector(wide, near).offset));
    }
    return sure;
}

/// Heights closer together than their bounds may come out in the wrong order; exchanged, the larger bound holds for both.
template <Real T>
void restore_order(Modes<T>& modes) {
    for (Index j = 1; j < modes.size(); ++j)
        for (Index i = j; i > 0 && modes.conical_height[i - 1] < modes.conical_height[i]; --i) {
            std::swap(modes.conical_height[i - 1], modes.conical_height[i]);
            modes.error_bound[i] = std::max(modes.error_bound[i - 1], modes.error_bound[i]);
            modes.error_bound[i - 1] = modes.error_bound[i];
        }
}

}  // namespace detail

template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options) {
    using std::ldexp;
    detail::check(chain, options);
    const Index count = options.count.value_or(chain.mode_count());
    const AssembledChain<T> assembled = assemble(chain);
    const linalg::ElementPencil<T> pencil = linalg::rounded<T>(assembled.pencil);

    const T finest = T(2) * epsilon<T>();
    const T goal = std::min(options.rtol.value_or(T(0)), T(0.5));
    // Counts in T are proved down to about an ulp for each link; below that the certificate needs Wide<T>.
    const bool loose = goal > T(64) * epsilon<T>() * T(chain.size());

    const T guess = ldexp(chain.total_length(), -assembled.units.length_exponent);
    Modes<T> result = detail::room_for_modes(chain, options, "bisection");  // early: it may not fit into memory
    const auto brackets = linalg::bisect(pencil, count, loose ? goal / T(4) : finest, guess, [&](Index done) {
        detail::advance(options.progress, 0.3 * static_cast<double>(done) / static_cast<double>(count));
    });
    linalg::Eigenvector<T> shape;
    for (Index j = 0; j < count; ++j) {
        const auto sure = detail::polish(assembled.pencil, pencil, j, brackets[static_cast<std::size_t>(j)], goal,
                                         loose, options.shapes ? &shape : nullptr);
        detail::set_height(result, j, sure.eigenvalue, sure.error_bound, assembled.units.length_exponent, options);
        if (options.shapes && loose) detail::set_shape(result, j, chain, pencil, sure.eigenvalue, shape);
        if (options.shapes && !loose) detail::set_shape(result, j, chain, assembled.pencil, sure.eigenvalue, shape);
        detail::advance(options.progress, 0.3 + 0.7 * static_cast<double>(j + 1) / static_cast<double>(count));
    }
    detail::restore_order(result);
    return result;
}

}  // namespace revchain
