// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>

#include "revchain/finite/branch/corrector.hpp"
#include "revchain/finite/branch/polish.hpp"
#include "revchain/linear/modes_of_one_sense.hpp"
#include "revchain/linear/one_mode.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The branch near the vertical, to leading order in its amplitude A, for a mode phi at height
/// lambda_k:
///     y = A phi,   lambda = lambda_k/(1 + A^2 c),   c = sum sigma d^4/a^3 / (2 sum sigma d^2/a),
/// where d is the link's difference of phi and sigma the effective pull. The lower sum includes the
/// derivative of sigma by log lambda and the spring at a support as one more link. With standing
/// links, or links that lean against their loads, c may be negative: the branch begins towards
/// slower speeds.
struct BranchOnset {
    std::vector<double> reach;  ///< a sin delta of each link over A
    double height = 0;          ///< lambda_k
    double curvature = 0;
    double steepest = 0;  ///< largest |sin delta|/A
    int half_waves = 1;   ///< of the mode

    /// `mode`: offsets of the N + 1 pins, free end first.
    template <class Offsets>
    BranchOnset(const BranchLinks<double>& links, const Offsets& mode, double at) : height(at) {
        const double speed = links.speed_at(height);
        double second = 0, fourth = 0, last = 0;
        for (std::size_t m = 0; m < links.size(); ++m) {
            const auto i = static_cast<Index>(m);
            const double d = links.is_spring(m) ? mode[i] : mode[i] - mode[i + 1];
            const double s = d / links.links[m].length;
            reach.push_back(d);
            second += links.growing_pull(m, speed) * d * s;
            if (!links.is_spring(m)) fourth += links.pull(m, speed) * d * s * s * s;
            steepest = std::max(steepest, std::abs(s));
            half_waves += mode[i] * last < 0;
            if (mode[i] != 0) last = mode[i] < 0 ? -1 : 1;
        }
        curvature = fourth / (2 * second);
    }
    /// Returns true if the branch begins above the height of the mode.
    bool rises() const { return curvature < 0; }
    double amplitude_at(double conical_height) const {
        return std::sqrt((height - conical_height) / (conical_height * curvature));
    }
    BranchState state(const BranchLinks<double>& links, double amplitude) const {
        BranchState result;
        for (std::size_t m = 0; m < links.size(); ++m)
            result.tau.push_back(links.tau_of_reach(m, amplitude * reach[m]));
        result.log_height = std::log(height) - std::log1p(amplitude * amplitude * curvature);
        return result;
    }
    /// Returns the point of a state near the vertical, with tangent and arc to second order.
    BranchPoint point(BranchState state, double amplitude) const {
        BranchPoint result{state, std::move(state), 0, half_waves};
        result.tangent.log_height = -2 * curvature * amplitude * amplitude;
        result.arc = normalise(result.tangent);
        return result;
    }
    BranchPoint point(const BranchLinks<double>& links, double amplitude) const {
        return point(state(links, amplitude), amplitude);
    }
    /// Returns a point of the branch with largest inclination about `steepness`, or less.
    std::optional<BranchPoint> start(Corrector& corrector, double steepness) const {
        for (; steepness > 1e-7; steepness /= 4) {
            const BranchPoint near = point(corrector.links(), steepness / steepest);
            auto found = corrector.corrected(near.state, near.tangent, 0.1 * near.arc);
            if (!found || (found->state.log_height >= std::log(height)) != rises()) continue;
            if (inner(found->tangent, near.tangent) < 0.8) continue;
            found->arc = near.arc;
            if (found->half_waves == 0) found->half_waves = half_waves;
            if (corrector.half_waves_are_kept() && found->half_waves != half_waves) continue;
            return found;
        }
        return std::nullopt;
    }
};

/// Returns the amplitude at a conical height, to leading order; 0 if there is no such state. If the
/// mode's height is close, it is recomputed in double-double (1e-24 relative) from a state inclined
/// by 1e-6.
REVCHAIN_LAZY
double amplitude_at(const BranchSystem& system, const BranchOnset& onset, const Fine& height) {
    const double narrow = as_double(height);
    if (std::abs(onset.height - narrow) > 1e-6 * onset.height)
        return (narrow > onset.height) == onset.rises() ? onset.amplitude_at(narrow) : 0.0;
    const double small = 1e-6 / onset.steepest;
    const BranchPoint at = onset.point(rounded(system.links), small);
    const auto found = polished(system.links, at.state, GivenPlace(at));
    Fine critical(onset.height);
    if (found.shape.converged)
        critical = found.height + found.height * Fine(small * small * onset.curvature);
    const double gap = as_double((critical - height) / height);
    return gap / onset.curvature > 0 ? std::sqrt(gap / onset.curvature) : 0.0;
}

/// Returns the state at a height so close to the mode's that double hardly resolves it. It comes
/// from the law of the onset and is balanced in double-double. Returns none if that fails.
REVCHAIN_LAZY
std::optional<BranchPoint> near_vertical(const BranchSystem& system, const BranchOnset& onset,
                                         const Fine& height) {
    const double amplitude = amplitude_at(system, onset, height);
    if (!(amplitude > 0)) return std::nullopt;
    BranchState state = onset.state(rounded(system.links), amplitude);
    const auto found = polished(system.links, state, GivenHeight(height));
    if (!found.shape.converged) return std::nullopt;
    double along = 0, whole = 0;
    for (std::size_t m = 0; m < system.links.size(); ++m) {
        const Fine d = found.shape.offset[m] - found.shape.offset[m + 1];
        const double tau = system.links.tau_of_reach(m, as_double(d));
        along += tau * state.tau[m], whole += state.tau[m] * state.tau[m];
        state.tau[m] = tau;
    }
    if (!(std::abs(along - whole) <= 0.3 * whole)) return std::nullopt;
    state.log_height = std::log(as_double(height));
    return onset.point(std::move(state), amplitude);
}

/// The start of a branch: a mode, or rest if the support is off the axis.
struct BranchRoot {
    std::shared_ptr<const BranchSystem> system;
    Corrector corrector;
    std::optional<BranchOnset> onset;  ///< none for the branch from rest
    double height;                     ///< of the mode; for the branch from rest, of the first mode

    template <class Options>
    static BranchRoot of(std::string_view place, const Chain<double>& chain,
                         const Options& options) {
        require_mode(place, options.mode, chain.mode_count());
        const auto found = detail::one_mode(chain, options.mode);
        return from(BranchSystem(chain), found.conical_height, &found.shape);
    }
    template <class Options>
    static BranchRoot of(std::string_view place, const Rig& rig, const Options& options) {
        const Index mode = options.mode;
        const double gravity = options.gravity;
        const Rotation direction = options.direction;
        detail::require_positive(place, "gravity", gravity);
        if (rig.support().radius > 0) {
            if (mode != 1)
                detail::throw_invalid(place,
                                      "with a support off the axis mode must be 1, the branch from "
                                      "rest; branches lists those born in folds",
                                      mode);
            return from(BranchSystem(rig, gravity, direction),
                        first_height(place, rig, gravity, direction));
        }
        const detail::ModesOfOneSense modes(place, rig, gravity, direction);
        require_mode(place, mode, modes.count());
        const auto found = modes.found(mode, 1).front();
        const Vector<double> shape = modes.shape(found);
        return from(BranchSystem(rig, gravity, direction), found.conical_height, &shape);
    }
    /// Returns the conical height of the slowest mode of a rig; its length if it has none.
    static double first_height(std::string_view place, const Rig& rig, double gravity,
                               Rotation direction) {
        const detail::ModesOfOneSense modes(place, rig, gravity, direction);
        return modes.count() > 0 ? modes.found(1, 1).front().conical_height
                                 : rig.chain().total_length();
    }

    /// Returns the state of the slowly turning, almost straight rig at a log of height or above.
    std::optional<BranchPoint> at_rest(double log_height) {
        const double unit = std::ldexp(1.0, -system->units.length_exponent);
        log_height = std::max(log_height, std::log(height * unit));
        for (int round = 0; round < 12; ++round, log_height += 2) {
            BranchState straight{std::vector<double>(corrector.size(), 0.0), log_height},
                faster = straight;
            faster.log_height = -1;
            auto found = corrector.corrected(straight, faster, 0.1);
            if (found) return found;
        }
        return std::nullopt;
    }

   private:
    static void require_mode(std::string_view place, Index mode, Index count) {
        if (mode < 1 || mode > count)
            detail::throw_invalid(
                place, "mode must be from 1 to the number of modes, " + std::to_string(count),
                mode);
    }
    static BranchRoot from(BranchSystem system, double height,
                           const Vector<double>* mode = nullptr) {
        auto narrow = rounded(system.links);
        std::optional<BranchOnset> onset;
        if (mode) onset.emplace(narrow, *mode, std::ldexp(height, -system.units.length_exponent));
        auto shared = std::make_shared<const BranchSystem>(std::move(system));
        return {std::move(shared), Corrector(std::move(narrow)), std::move(onset), height};
    }
};

}  // namespace revchain::finite
