// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/linalg/spectrum.hpp"
#include "revchain/linear/heights.hpp"

namespace revchain::detail {

/// Where interpolating the characteristic polynomial pays: several modes, and more of them than blocks do well with
/// (measured at N = 1000 and 10,000 with plummets and rods; flat within a factor of 2 in the second number).
template <Real T>
bool spectrum_pays(const Chain<T>& chain, const ModeRange& range) {
    return range.count >= 8 && range.first - 1 + range.count >= chain.size() / 256;
}

/// Stage 1 of `modes` where the tolerance leaves room for bounds of some 30 ulp; nothing where it does not, or for chains
/// that `linalg::all_eigenvalues` has no fast way for. Cost: 1 to 2 ns per link and mode.
inline std::optional<Heights<double>> heights_by_spectrum(OnDemand<double>& assembled, const ModeRange& range,
                                                          Index mode_count, const ModesOptions<double>& options) {
    const double goal = std::clamp(options.rtol.value_or(0.0), 2 * epsilon<double>(), 0.5);
    const auto& wide = assembled.pencils().wide();
    if (wide.size() < 2) return std::nullopt;
    const auto pinned = linalg::spectrum::pinned(wide);
    if (!pinned.fit) return std::nullopt;
    Heights<double> result{{}, "spectrum"};
    const Index first = range.first - 1;
    for (const auto& sure : linalg::all_eigenvalues(wide, pinned, first, first + range.count, mode_count, goal))
        result.height.push_back({sure.eigenvalue, sure.error_bound, sure.unrounded});
    restore_order(result.height);
    return result;
}

}  // namespace revchain::detail
