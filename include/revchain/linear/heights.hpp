// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "revchain/count.hpp"
#include "revchain/linear/plain_pencil.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/floating_point_state.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/pencil/certificate.hpp"
#include "revchain/pencil/proved_roots.hpp"
#include "revchain/pencil/twisted.hpp"

/// This header has stage 1 of `modes`: heights of a range of modes, each with its proved bound.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// A height in the units of the chain's pencils, with a proved relative bound.
template <Real T>
using Height = pencil::Certified<T>;

/// Heights of a range of modes, descending.
template <Real T>
using Heights = std::vector<Height<T>>;

/// Accuracy and progress of the first stage. The range of modes is a separate argument.
template <Real T>
struct HeightsOptions {
    std::optional<T> rtol{};  ///< if absent: as accurate as T allows
    Progress* progress = nullptr;
};

/// Returns true if T suffices: counts in T are proved down to about an ulp for each link.
template <Real T>
bool is_loose(const Chain<T>& chain, const HeightsOptions<T>& options) {
    return std::min(options.rtol.value_or(T(0)), T(0.5)) > T(64) * epsilon<T>() * T(chain.size());
}

/// Exchanges heights in the wrong order (closer than their bounds). Both get the larger bound.
template <Real T>
void restore_order(Heights<T>& heights) {
    for (std::size_t j = 1; j < heights.size(); ++j)
        for (std::size_t i = j; i > 0 && heights[i - 1].eigenvalue < heights[i].eigenvalue; --i) {
            std::swap(heights[i - 1], heights[i]);
            heights[i].error_bound = heights[i - 1].error_bound =
                std::max(heights[i - 1].error_bound, heights[i].error_bound);
        }
}

/// Returns heights number `range` to within `goal` (relative) by bisection on the plain pencil,
/// each proved by two counts. The result is empty without such a pencil or if a proof fails, for a
/// `goal` below about 8 ulp for each link. Cost a link: 5 ns, 7 ns for three bits and 8 modes, 24
/// ns a proof.
REVCHAIN_LAZY
std::optional<Heights<double>> loose_heights(const Chain<double>& chain, const ModeRange& range,
                                             double goal,
                                             const std::function<void(Index)>& finished = {}) {
    const auto pencil = plain_pencil(chain);
    if (!pencil) return std::nullopt;
    // Brackets leave a quarter of the goal on either side to the counts' roundings.
    const double length = std::ldexp(chain.total_length(), -chain.units().length_exponent);
    const auto brackets =
        pencil::bisect(*pencil, range.first - 1, range.count, 0.5 * goal, length, finished);
    Heights<double> result(brackets.size());
    std::atomic<bool> proved = true;
    parallel_for(brackets.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && proved; ++i) {
            const double start = pencil::between(brackets[i].lower, brackets[i].upper);
            const Index j = range.first - 1 + static_cast<Index>(i);
            if (!pencil::lies_within<double>(*pencil, j, start, goal / 2)) proved = false;
            result[i] = {start, pencil::bound_of_margin<double>(goal / 2), start};
        }
    });
    if (!proved) return std::nullopt;
    restore_order<double>(result);
    return result;
}

/// The largest number of elements for finding modes eight at a time: 450 bytes of scratch each.
inline constexpr Index most_in_lanes = 20000;
/// The largest relative error before rounding for which a rounded height is within 2 ulp.
inline constexpr double worst_unrounded = 1.49 * std::numeric_limits<double>::epsilon();

/// Roots of a range of numbers, eight at a time, of a chain's or a rig's pencil in two words and
/// rounded. A root that this does not prove to the relative error `worst` is `alone(number,
/// bracket)`. Nothing where the counts `certified(x)` leave numbers in doubt.
template <bool Spins, class Certified, class Alone>
std::optional<Heights<double>> roots_in_lanes(
    const pencil::ElementPencil<Wide<double>, Spins>& elements,
    const pencil::ElementPencil<double, Spins>& rounded, const Certified& certified,
    const ModeRange& range, Index available, double guess, double worst,
    const std::function<void(Index)>& finished, const Alone& alone) {
    if (elements.size() > most_in_lanes) return std::nullopt;
    const FloatingPointStateGuard quiet;
    const auto roots = pencil::proved_range(elements, rounded, certified, range.first - 1,
                                            range.count, available, guess, worst, finished);
    if (!roots) return std::nullopt;
    Heights<double> found;
    found.reserve(roots->size());
    for (const auto& root : *roots) {
        if (std::isfinite(root.off)) {
            found.push_back({root.root.high, root.bound(), root.root});
            continue;
        }
        const Index j = range.first - 1 + static_cast<Index>(found.size());
        found.push_back(
            alone(j, pencil::bisect(rounded, j, 1, 2 * epsilon<double>(), guess).front()));
    }
    return found;
}

/// Heights to 2 ulp, eight at a time. Nothing where one unit of weight does not serve, or where
/// counts leave numbers in doubt.
REVCHAIN_LAZY
std::optional<Heights<double>> heights_in_lanes(const Pencils<double>& pencils,
                                                const ModeRange& range, Index available,
                                                double guess,
                                                const std::function<void(Index)>& finished) {
    const auto& wide = pencils.wide();
    const auto& rounded = pencils.rounded();
    if (!wide.units.empty()) return std::nullopt;
    auto heights = roots_in_lanes(
        wide, rounded,
        [&](double height) { return pencil::certified_count<double, 1>(rounded, {height})[0]; },
        range, available, guess, worst_unrounded, finished,
        [&](Index j, const pencil::Bracket<double>& bracket) {
            const double start = pencil::between(bracket.lower, bracket.upper);
            return pencil::certified_eigenvalue(wide, rounded, j, start);
        });
    if (heights) restore_order<double>(*heights);
    return heights;
}

/// Does stage 1 of `modes` for every valid chain, to `options.rtol`. `range` must not be empty.
template <Real T>
Heights<T> heights_by_bisection(const Chain<T>& chain, LazyCounter<T>& assembled,
                                const ModeRange& range, const HeightsOptions<T>& options) {
    const T goal = std::min(options.rtol.value_or(T(0)), T(0.5));
    const bool loose = is_loose(chain, options);
    const double count = static_cast<double>(range.count);
    const auto half_way = [&](Index done) {
        advance(options.progress, 0.5 * static_cast<double>(done) / count);
    };
    if constexpr (std::is_same_v<T, double>)
        if (loose)
            if (auto found = loose_heights(chain, range, goal, half_way)) return std::move(*found);
    const Pencils<T>& pencils = assembled.pencils();
    const T length = pencils.scaled(chain.total_length());
    if constexpr (std::is_same_v<T, double>)
        if (auto found = heights_in_lanes(pencils, range, chain.mode_count(), length, half_way))
            return std::move(*found);
    const auto brackets =
        pencil::bisect(pencils.rounded(), range.first - 1, range.count,
                       loose ? goal / T(4) : T(2) * epsilon<T>(), length, half_way);
    Heights<T> result(brackets.size());
    parallel_for(brackets.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index j = range.first - 1 + static_cast<Index>(i);
            const T start = pencil::between(brackets[i].lower, brackets[i].upper);
            const bool near =
                loose && pencil::lies_within<T>(pencils.rounded(), j, start, goal / T(2));
            result[i] =
                near ? Height<T>{start, pencil::bound_of_margin<T>(goal / T(2)), Wide<T>(start)}
                     : pencil::certified_eigenvalue<Wide<T>, T>(pencils.wide(), pencils.rounded(),
                                                                j, start);
            advance(options.progress, 0.5 + 0.5 * static_cast<double>(i + 1) / count);
        }
    });
    restore_order<T>(result);
    return result;
}

}  // namespace revchain::detail
