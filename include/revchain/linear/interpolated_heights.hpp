// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/linear/condensed_heights.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/floating_point_state.hpp"
#include "revchain/pencil/spectrum/interpolated.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Returns heights of many modes, or nothing on failure. Cost: as `pencil::all_eigenvalues`.
REVCHAIN_LAZY
std::optional<Heights<double>> heights_by_interpolation(LazyCounter<double>& assembled,
                                                        const ModeRange& range, Index mode_count,
                                                        const HeightsOptions<double>& options) {
    const double goal = std::clamp(options.rtol.value_or(0.0), 2 * epsilon<double>(), 0.5);
    const auto& wide = assembled.pencils().wide();
    if (wide.size() < 2) return std::nullopt;
    const FloatingPointStateGuard quiet;
    const auto lumped = pencil::spectrum::lumped(wide);
    if (!lumped.fit) return std::nullopt;
    Heights<double> result;
    constexpr Index together = 2048;  // modes between two reports
    for (Index done = 0; done < range.count;) {
        const Index first = range.first - 1 + done, count = std::min(range.count - done, together);
        const auto found =
            pencil::all_eigenvalues(wide, lumped, first, first + count, mode_count, goal);
        result.insert(result.end(), found.begin(), found.end());
        done += count;
        advance(options.progress, static_cast<double>(done) / static_cast<double>(range.count));
    }
    restore_order<double>(result);
    return result;
}

}  // namespace revchain::detail
