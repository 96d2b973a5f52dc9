// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/continuation.hpp"
#include "revchain/finite/polish.hpp"

namespace revchain::finite {

/// A state near the vertical by the onset's law as a point: tangent and arc, from the vertical, to second order.
inline BranchPoint point_of_onset(const BranchOnset& onset, BranchState state, double amplitude) {
    BranchPoint point{state, std::move(state), 0, onset.half_waves};
    point.tangent.log_height = -2 * onset.curvature * amplitude * amplitude;
    point.arc = std::sqrt(inner(point.tangent, point.tangent));
    for (double& rise : point.tangent.rise) rise /= point.arc;
    point.tangent.log_height /= point.arc;
    return point;
}

/// The amplitude at a conical height, to leading order; 0 where there is no such state. Next to that of the mode the
/// difference of the two takes more than double: the mode's height is then told in two words, from a state inclined by
/// 1e-6 balanced with the height free (to 1e-24 relative).
inline double amplitude_at(const Links<Wide<double>>& chain, const BranchOnset& onset, const Wide<double>& height) {
    using S = Wide<double>;
    const double narrow = static_cast<double>(height);
    if (onset.height - narrow > 1e-6 * onset.height) return onset.amplitude_at(narrow);
    const double small = 1e-6 / onset.steepest;
    const BranchPoint at = point_of_onset(onset, onset.state(rounded<double>(chain.links), small), small);
    const auto found = polished(chain.links, at.state, GivenPlace<S>(at));
    S critical(onset.height);
    if (found.shape.converged) critical = found.height + found.height * S(small * small * onset.curvature);
    const double gap = static_cast<double>((critical - height) / height);
    return gap > 0 ? std::sqrt(gap / onset.curvature) : 0.0;
}

/// The state at a height so near that of the mode that double tells it badly from the vertical: from the onset's law,
/// balanced in two words. None where that does not lead to it.
inline std::optional<BranchPoint> near_vertical(const Links<Wide<double>>& chain, const BranchOnset& onset,
                                                const Wide<double>& height) {
    using S = Wide<double>;
    const double amplitude = amplitude_at(chain, onset, height);
    if (!(amplitude > 0)) return std::nullopt;
    BranchState state = onset.state(rounded<double>(chain.links), amplitude);
    const auto found = polished(chain.links, state, GivenHeight<S>(height));
    if (!found.shape.converged) return std::nullopt;
    double along = 0, whole = 0;
    for (std::size_t m = 0; m < chain.links.size(); ++m) {
        const S d = found.shape.offset[m] - found.shape.offset[m + 1];
        const double rise = std::atanh(static_cast<double>(d / chain.links[m].length));
        along += rise * state.rise[m], whole += state.rise[m] * state.rise[m];
        state.rise[m] = rise;
    }
    if (!(std::abs(along - whole) <= 0.3 * whole)) return std::nullopt;
    state.log_height = std::log(static_cast<double>(height));
    return point_of_onset(onset, std::move(state), amplitude);
}

}  // namespace revchain::finite
