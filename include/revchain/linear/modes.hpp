// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linalg/certificate.hpp"
#include "revchain/linear/mode_table.hpp"

namespace revchain {

/// Whirl speeds of small amplitude, Greenhill (1908) §8 (21) with sec delta = 1: the slowest, any range of mode numbers
/// without the ones before, or those in a window of heights or speeds (which modes lie in it is decided by
/// `ModeCounter::within`, by proved counts, not by the heights returned: a height just above `low` may round to it).
///
/// Method: bisection on counts in T, eight shifts to a pass; a twisted shape and its Rayleigh quotient in `Wide<T>`; two
/// proved counts for every mode; and the shape in `Wide<T>`. With a loose `rtol` the quotient is left out and the rest
/// done in T.
/// Accuracy: conical heights within 0.501 ulp of the exact ones of the stored numbers (measured, N up to 1e5, ten kinds
/// of chain: tests/cpp/linear/modes.cpp), error bound 2 ulp and proved; a loose `rtol` is kept by the bound. Shapes
/// 3.5e-16 of the largest offset; with a loose `rtol` as good as their height, rtol / (gap to the next height). Where
/// `Wide<T>` is T itself (DoubleDouble, a user's own scalar) errors and bounds grow with N: tests/cpp/linear/modes.cpp.
/// Cost: about 0.55 microseconds per link and mode with shapes, 0.3 without (double); O(N k) memory.
/// Throws InvalidArgument for numbers outside 1 ... `chain.mode_count()`, for a window that is none, for numbers and a
/// window together, and for a tolerance that is negative or NaN. An empty window gives no modes. A tolerance out of reach
/// is `Status::tolerance_not_met` with the bounds reached.
template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options = {});

namespace detail {

/// A height in the units of the chain's pencils.
template <Real T>
struct Height {
    T value{};
    T error_bound{};      ///< of `value`, relative to the exact height; proved
    Wide<T> unrounded{};  ///< what the shape is computed at
};

/// What the first stage of `modes` gives: the heights of a range of modes, descending.
template <Real T>
struct Heights {
    std::vector<Height<T>> height;
    const char* method = "";
};

/// Whether all can be done in T: counts in T are proved down to about an ulp for each link; below that the certificate
/// needs `Wide<T>`.
template <Real T>
bool is_loose(const Chain<T>& chain, const ModesOptions<T>& options) {
    return std::min(options.rtol.value_or(T(0)), T(0.5)) > T(64) * epsilon<T>() * T(chain.size());
}

/// Height number `j` (from 0) to `goal`, from its bracket: the cheapest certificate first.
template <Real T>
Height<T> refined(const Pencils<T>& pencils, Index j, const linalg::Bracket<T>& bracket, const T& goal, bool loose) {
    using S = Wide<T>;
    using M = Narrow<S>;
    const T start = linalg::between(bracket.lower, bracket.upper);
    if (loose && linalg::lies_within<T>(pencils.rounded(), j, start, goal / T(2)))
        return {start, linalg::bound_of_margin<T>(goal / T(2)), S(start)};
    const auto quotient = [&](const auto& pencil, const auto& height) {
        return linalg::rayleigh_quotient<S>(pencils.wide(), linalg::eigenvector(pencil, height).offset);
    };
    // One round nearly always, two at most: the quotient's error is the square of the vector's. Where no arithmetic is
    // wider than T, rounding in T limits what two counts can prove: then as many ulp as it takes, within a factor of 2.
    T margin = T(2) * epsilon<T>();
    T height = start;
    S fine(start);
    for (int round = 0; round < (std::is_same_v<S, T> ? 24 : 2); ++round) {
        if (round < 2) fine = quotient(pencils.rounded(), height);
        height = static_cast<T>(fine);
        if (linalg::lies_within<S>(pencils.wide(), j, height, static_cast<M>(margin)))
            return {height, linalg::bound_of_margin<S>(margin), fine};
        if constexpr (std::is_same_v<S, T>) margin = margin * T(2);
    }
    const auto sure = linalg::bisect_certified<S>(pencils.wide(), j, start);
    return {sure.eigenvalue, sure.error_bound, quotient(pencils.wide(), S(static_cast<M>(sure.eigenvalue)))};
}

/// Heights closer together than their bounds may come out in the wrong order; exchanged, the larger bound holds for both.
template <Real T>
void restore_order(std::vector<Height<T>>& heights) {
    for (std::size_t j = 1; j < heights.size(); ++j)
        for (std::size_t i = j; i > 0 && heights[i - 1].value < heights[i].value; --i) {
            std::swap(heights[i - 1], heights[i]);
            heights[i].error_bound = heights[i - 1].error_bound =
                std::max(heights[i - 1].error_bound, heights[i].error_bound);
        }
}

/// Stage 1 of `modes`: the heights of `range`, which is not empty, to `options.rtol`. Reports progress up to `share`.
/// This one serves every valid chain; cost as said there.
template <Real T>
Heights<T> heights_by_bisection(const Chain<T>& chain, OnDemand<T>& assembled, const ModeRange& range,
                                const ModesOptions<T>& options, double share) {
    using std::ldexp;
    const Pencils<T>& pencils = assembled.pencils();
    const T goal = std::min(options.rtol.value_or(T(0)), T(0.5));
    const bool loose = is_loose(chain, options);
    const double count = static_cast<double>(range.count);
    const auto brackets =
        linalg::bisect(pencils.rounded(), range.first - 1, range.count, loose ? goal / T(4) : T(2) * epsilon<T>(),
                       pencils.scaled(chain.total_length()),
                       [&](Index done) { advance(options.progress, share * 0.5 * static_cast<double>(done) / count); });
    Heights<T> result{{}, "bisection"};
    result.height.reserve(brackets.size());
    for (const auto& bracket : brackets) {
        const Index j = static_cast<Index>(result.height.size());
        result.height.push_back(refined(pencils, range.first - 1 + j, bracket, goal, loose));
        advance(options.progress, share * (0.5 + 0.5 * static_cast<double>(j + 1) / count));
    }
    restore_order(result.height);
    return result;
}

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

/// Stage 2 of `modes`: shape, residual and nodes of mode `j`. In T where the tolerance is loose and else in `Wide<T>` at
/// the height before it is rounded.
template <Real T>
void find_shape(Modes<T>& modes, Index j, const Chain<T>& chain, const Pencils<T>& pencils, const Height<T>& height,
                bool loose) {
    if (loose)
        set_shape(modes, j, chain, pencils.rounded(), height.value,
                  linalg::eigenvector(pencils.rounded(), height.value));
    else
        set_shape(modes, j, chain, pencils.wide(), height.value, fine_shape<T>(pencils.wide(), height.unrounded));
}

/// Stage 3 of `modes`: proved counts at numbers of T on either side of height `j`, as far away as its error bound says,
/// and where rounding to T leaves that in doubt a little farther.
template <Real T>
void certify(Modes<T>& modes, Index j, const Pencils<T>& pencils, Index mode_count) {
    using std::isfinite;
    const T height = modes.conical_height[j], bound = modes.error_bound[j];
    const Index before = modes.first - 1 + j;
    modes.certificate.lower[j] = T(0);
    modes.certificate.upper[j] = std::numeric_limits<T>::infinity();
    modes.certificate.above_lower[j] = mode_count;
    modes.certificate.above_upper[j] = 0;
    if (!(bound < T(1))) return;
    bool below = false, above = false;
    T reach = height * bound;
    for (int attempt = 0; attempt < 8 && !(below && above); ++attempt, reach = reach + reach) {
        const T lower = height - reach, upper = height + reach;
        if (!(lower > T(0)) || !isfinite(upper)) return;
        const auto count =
            pencils.template certified_count<2>({pencils.scaled(Wide<T>(lower)), pencils.scaled(Wide<T>(upper))});
        if (!below && count[0].proved && count[0].above > before) {
            modes.certificate.lower[j] = lower;
            modes.certificate.above_lower[j] = count[0].above;
            below = true;
        }
        if (!above && count[1].proved && count[1].above <= before) {
            modes.certificate.upper[j] = upper;
            modes.certificate.above_upper[j] = count[1].above;
            above = true;
        }
    }
}

}  // namespace detail

template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options) {
    static_assert(
        !std::is_same_v<T, DoubleWord<double>> && !std::is_same_v<T, DoubleWord<long double>>,
        "a double word is the working arithmetic of a narrower scalar; as a scalar of its own take DoubleDouble");
    detail::check(options);
    detail::OnDemand<T> assembled(chain);
    const ModeRange range = detail::chosen(chain, assembled, options);
    Modes<T> result = detail::room_for_modes(chain, range, options);  // early: it may not fit into memory
    result.method = "bisection";
    if (range.count == 0) return result;

    const double to_heights = options.shapes ? 0.6 : options.certify ? 0.8 : 1.0;
    const auto found = detail::heights_by_bisection(chain, assembled, range, options, to_heights);
    result.method = found.method;
    for (Index j = 0; j < range.count; ++j) {
        const auto& height = found.height[static_cast<std::size_t>(j)];
        detail::set_height(result, j, height.value, height.error_bound, chain.units().length_exponent, options);
        if (options.shapes)
            detail::find_shape(result, j, chain, assembled.pencils(), height, detail::is_loose(chain, options));
        if (options.certify) detail::certify(result, j, assembled.pencils(), chain.mode_count());
        detail::advance(options.progress,
                        to_heights + (1 - to_heights) * static_cast<double>(j + 1) / static_cast<double>(range.count));
    }
    return result;
}

}  // namespace revchain
