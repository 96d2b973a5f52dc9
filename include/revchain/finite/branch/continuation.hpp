// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/branch/corrector.hpp"
#include "revchain/numeric/arc_step.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Follows one branch of steady shapes by its arc, through folds.
///
/// A step goes along the tangent and is corrected across it. It is accepted if Newton's method
/// contracts at once, the direction turns by less than 26 degrees and the state half way, predicted
/// from both ends, is on the branch (after a jump to a neighbour it is not). For a chain with
/// h >= 0 and l <= a for all links, the half waves must be the same. Otherwise half the step is
/// tried. This is a check, not a proof. Cost: 4 to 7 Newton steps of O(N) for an accepted step.
class BranchWalk {
   public:
    BranchWalk(Corrector& corrector, BranchPoint start, double step = 0.05, double longest = 0.5)
        : longest_(longest),
          corrector_(&corrector),
          before_(start),
          here_(std::move(start)),
          step_(step) {}

    /// Returns a walk whose last step joins two neighbouring points.
    static BranchWalk between(Corrector& corrector, const BranchPoint& before,
                              const BranchPoint& here) {
        BranchWalk walk(corrector, here);
        walk.before_ = before;
        return walk;
    }

    const BranchLinks<double>& links() const { return corrector_->links(); }
    const BranchPoint& before() const { return before_; }
    const BranchPoint& here() const { return here_; }

    /// Takes one step; returns false if no step above 1e-9 of arc is accepted.
    bool advance() {
        constexpr double max_tau = 0.75;
        const double longest = std::min(longest_, max_tau / (largest_tau(here_.tangent) + 1e-300));
        return detail::arc_step(step_, longest, 0.5, [&](double step) -> std::optional<double> {
            auto next = at(here_, step);
            if (!next) return {};
            const double cosine = inner(next->tangent, here_.tangent);
            if (!(cosine > 0.9) || !on_the_way(*next)) return {};
            if (corrector_->half_waves_are_kept() && next->half_waves != here_.half_waves)
                return {};
            before_ = std::move(here_), here_ = std::move(*next);
            return cosine > 0.98 ? 1.6 : cosine > 0.95 ? 1.1 : 0.8;
        });
    }

    /// Returns the point at a distance `reach` of arc in the plane across the direction of `from`.
    std::optional<BranchPoint> at(const BranchPoint& from, double reach) const {
        BranchState there = moved(from.state, reach, from.tangent);
        auto next =
            corrector_->corrected(std::move(there), from.tangent, 0.3 * std::abs(reach) + 1e-9);
        if (!next) return next;
        next->arc = from.arc + reach;
        if (next->half_waves == 0) next->half_waves = from.half_waves;
        return next;
    }

    std::optional<BranchPoint> within(double share) const {
        return at(before_, share * (here_.arc - before_.arc));
    }

   private:
    /// Returns true if the middle of the cubic through both ends and tangents is on the branch.
    bool on_the_way(const BranchPoint& next) const {
        const double reach = next.arc - here_.arc;
        BranchState middle = moved(here_.state, reach / 8, here_.tangent);
        middle = moved(std::move(middle), 0.5, moved(next.state, -1, here_.state));
        middle = moved(std::move(middle), -reach / 8, next.tangent);
        const auto change = corrector_->step(middle, moved(here_.tangent, 1, next.tangent));
        return size_of(change.correction) <= 0.02 * reach + 1e-9;
    }

    double longest_;  ///< longest step along the arc
    Corrector* corrector_;
    BranchPoint before_, here_;
    double step_;
};

}  // namespace revchain::finite
