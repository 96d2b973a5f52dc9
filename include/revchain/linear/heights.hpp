// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "revchain/count.hpp"
#include "revchain/linear/plain_pencil.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/pencil/certificate.hpp"
#include "revchain/pencil/twisted.hpp"

/// Stage 1 of `modes`: the heights of a range of mode numbers, each with its proved bound. Shapes come after.
namespace revchain::detail {

/// A height in the units of the chain's pencils; the bound is relative to the exact height, and proved.
template <Real T>
using Height = pencil::Certified<T>;

/// Heights of a range of modes, descending.
template <Real T>
using Heights = std::vector<Height<T>>;

/// Accuracy and progress of the first stage; the range of modes is passed beside them.
template <Real T>
struct HeightsOptions {
    std::optional<T> rtol{};  ///< absent: as accurate as T allows
    Progress* progress = nullptr;
};

/// Whether all can be done in T: counts in T are proved down to about an ulp for each link; below that the certificate
/// needs `Wide<T>`.
template <Real T>
bool is_loose(const Chain<T>& chain, const HeightsOptions<T>& options) {
    return std::min(options.rtol.value_or(T(0)), T(0.5)) > T(64) * epsilon<T>() * T(chain.size());
}

/// Heights closer together than their bounds may come out in the wrong order; exchanged, the larger bound holds for
/// both.
template <Real T>
void restore_order(Heights<T>& heights) {
    for (std::size_t j = 1; j < heights.size(); ++j)
        for (std::size_t i = j; i > 0 && heights[i - 1].eigenvalue < heights[i].eigenvalue; --i) {
            std::swap(heights[i - 1], heights[i]);
            heights[i].error_bound = heights[i - 1].error_bound =
                std::max(heights[i - 1].error_bound, heights[i].error_bound);
        }
}

/// Heights number `range` to within `goal` (relative) by bisection in P, float or double, on the plain pencil, each
/// proved by two counts there, in double. Nothing where there is no such pencil or rounding leaves one in doubt: about
/// where `goal` is below 8 ulp of P for each link.
/// Cost for each link: 5 ns, 7 ns for each three bits and 8 modes (float: 5), and 24 ns a mode for the proof.
template <std::floating_point P>
std::optional<Heights<double>> loose_heights(const Chain<double>& chain, const ModeRange& range, double goal,
                                             const std::function<void(Index)>& finished = {}) {
    const auto pencil = plain_pencil(chain);
    if (!pencil) return std::nullopt;
    // Brackets leave a quarter of the goal on either side to the counts' roundings.
    const auto brackets =
        pencil::bisect(pencil::rounded<P>(*pencil), range.first - 1, range.count, static_cast<P>(0.5 * goal),
                       static_cast<P>(std::ldexp(chain.total_length(), -chain.units().length_exponent)), finished);
    Heights<double> result(brackets.size());
    std::atomic<bool> proved = true;
    parallel_for(brackets.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && proved; ++i) {
            const double start = pencil::between<double>(brackets[i].lower, brackets[i].upper);
            const Index j = range.first - 1 + static_cast<Index>(i);
            if (!pencil::lies_within<double>(*pencil, j, start, goal / 2)) proved = false;
            result[i] = {start, pencil::bound_of_margin<double>(goal / 2), start};
        }
    });
    if (!proved) return std::nullopt;
    restore_order<double>(result);
    return result;
}

/// Stage 1 of `modes`: the heights of `range`, which is not empty, to `options.rtol`.
/// This one serves every valid chain; cost as said there.
template <Real T>
Heights<T> heights_by_bisection(const Chain<T>& chain, LazyCounter<T>& assembled, const ModeRange& range,
                                const HeightsOptions<T>& options) {
    const T goal = std::min(options.rtol.value_or(T(0)), T(0.5));
    const bool loose = is_loose(chain, options);
    const double count = static_cast<double>(range.count);
    const auto half_way = [&](Index done) { advance(options.progress, 0.5 * static_cast<double>(done) / count); };
    if constexpr (std::is_same_v<T, double>)
        if (loose)
            if (auto found = loose_heights<double>(chain, range, goal, half_way)) return std::move(*found);
    const Pencils<T>& pencils = assembled.pencils();
    const auto brackets =
        pencil::bisect(pencils.rounded(), range.first - 1, range.count, loose ? goal / T(4) : T(2) * epsilon<T>(),
                       pencils.scaled(chain.total_length()), half_way);
    Heights<T> result(brackets.size());
    parallel_for(brackets.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index j = range.first - 1 + static_cast<Index>(i);
            const T start = pencil::between(brackets[i].lower, brackets[i].upper);
            const bool near = loose && pencil::lies_within<T>(pencils.rounded(), j, start, goal / T(2));
            result[i] = near ? Height<T>{start, pencil::bound_of_margin<T>(goal / T(2)), Wide<T>(start)}
                             : pencil::certified_eigenvalue<Wide<T>, T>(pencils.wide(), pencils.rounded(), j, start);
            advance(options.progress, 0.5 + 0.5 * static_cast<double>(i + 1) / count);
        }
    });
    restore_order<T>(result);
    return result;
}

}  // namespace revchain::detail
