// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/branch/corrector.hpp"
#include "revchain/finite/branch/polish.hpp"
#include "revchain/linear/one_mode.hpp"

namespace revchain::finite {

/// The branch near the vertical, to leading order in its amplitude: with phi the mode, lambda_k its height,
///     y = A phi,   lambda = lambda_k/(1 + A^2 curvature),   curvature = sum sigma d^4/a^3 / (2 sum sigma d^2/a).
struct BranchOnset {
    std::vector<double> reach;  ///< a sin delta of each link over A: differences of the mode
    double height = 0;          ///< lambda_k
    double curvature = 0;
    double steepest = 0;  ///< largest |sin delta|/A
    int half_waves = 1;   ///< of the mode

    /// `mode`: offsets of the N + 1 pins, free end first.
    template <class Offsets>
    BranchOnset(const std::vector<Link<double>>& links, const Offsets& mode, double height_of_mode)
        : height(height_of_mode) {
        double second = 0, fourth = 0, last = 0;
        for (std::size_t m = 0; m < links.size(); ++m) {
            const auto i = static_cast<Index>(m);
            const double d = mode[i] - mode[i + 1], s = d / links[m].length;
            reach.push_back(d);
            second += links[m].pull * d * s, fourth += links[m].pull * d * s * s * s;
            steepest = std::max(steepest, std::abs(s));
            half_waves += mode[i] * last < 0;
            if (mode[i] != 0) last = mode[i] < 0 ? -1 : 1;
        }
        curvature = fourth / (2 * second);
    }
    double amplitude_at(double conical_height) const {
        return std::sqrt((height - conical_height) / (conical_height * curvature));
    }
    BranchState state(const std::vector<Link<double>>& links, double amplitude) const {
        BranchState result;
        for (std::size_t m = 0; m < links.size(); ++m)
            result.rise.push_back(std::atanh(amplitude * reach[m] / links[m].length));
        result.log_height = std::log(height) - std::log1p(amplitude * amplitude * curvature);
        return result;
    }
    /// A state near the vertical by this law as a point: tangent and arc, from the vertical, to second order.
    BranchPoint point(BranchState state, double amplitude) const {
        BranchPoint result{state, std::move(state), 0, half_waves};
        result.tangent.log_height = -2 * curvature * amplitude * amplitude;
        result.arc = normalise(result.tangent);
        return result;
    }
    BranchPoint point(const std::vector<Link<double>>& links, double amplitude) const {
        return point(state(links, amplitude), amplitude);
    }
    /// A point of the branch with the largest inclination about `steepness`; smaller where that does not do.
    std::optional<BranchPoint> start(Corrector& corrector, double steepness) const {
        for (; steepness > 1e-7; steepness /= 4) {
            const BranchPoint near = point(corrector.links(), steepness / steepest);
            auto found = corrector.corrected(near.state, near.tangent, 0.1 * near.arc);
            if (!found || found->state.log_height >= std::log(height)) continue;
            // modes close to one another: the neighbour's branch
            if (corrector.half_waves_are_kept() && found->half_waves != 0 && found->half_waves != half_waves) continue;
            if (inner(found->tangent, near.tangent) < 0.8) continue;
            found->arc = near.arc;
            if (found->half_waves == 0) found->half_waves = half_waves;
            return found;
        }
        return std::nullopt;
    }
};

/// The amplitude at a conical height, to leading order; 0 where there is no such state. Next to that of the mode the
/// difference of the two takes more than double: the mode's height is then told in double-double, from a state inclined
/// by 1e-6 balanced with the height free (to 1e-24 relative).
inline double amplitude_at(const Links<Wide<double>>& chain, const BranchOnset& onset, const Wide<double>& height) {
    using S = Wide<double>;
    const double narrow = static_cast<double>(height);
    if (onset.height - narrow > 1e-6 * onset.height) return onset.amplitude_at(narrow);
    const double small = 1e-6 / onset.steepest;
    const BranchPoint at = onset.point(rounded<double>(chain.links), small);
    const auto found = polished(chain.links, at.state, GivenPlace<S>(at));
    S critical(onset.height);
    if (found.shape.converged) critical = found.height + found.height * S(small * small * onset.curvature);
    const double gap = static_cast<double>((critical - height) / height);
    return gap > 0 ? std::sqrt(gap / onset.curvature) : 0.0;
}

/// The state at a height so near that of the mode that double tells it badly from the vertical: from the onset's law,
/// balanced in double-double. None where that does not lead to it.
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
    return onset.point(std::move(state), amplitude);
}

/// The mode a branch starts from, and its links.
struct BranchRoot {
    Links<Wide<double>> chain;
    Corrector corrector;
    BranchOnset onset;
    double height;  ///< of the mode, in the chain's unit

    static BranchRoot of(std::string_view place, const Chain<double>& chain, Index mode) {
        if (mode < 1 || mode > chain.mode_count())
            revchain::detail::throw_invalid(
                place, "mode must be from 1 to the number of modes, " + std::to_string(chain.mode_count()), mode);
        const auto found = revchain::detail::one_mode(chain, mode);
        auto links = links_of(chain);
        const double height = found.conical_height, unit = std::ldexp(1.0, -links.units.length_exponent);
        auto narrow = rounded<double>(links.links);
        BranchOnset onset(narrow, found.shape, height * unit);
        return {std::move(links), Corrector(std::move(narrow)), std::move(onset), height};
    }
};

}  // namespace revchain::finite
