// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numbers>
#include <numeric>

#include "revchain/linear/plain_pencil.hpp"
#include "revchain/models/bisection.hpp"
#include "revchain/numeric/zero_of_j0.hpp"
#include "revchain/pencil/certificate.hpp"
#include "revchain/pencil/grouped.hpp"

namespace revchain::inline REVCHAIN_BUILD::models {

using revchain::detail::zero_of_j0;

/// Merges groups of neighbouring links. Each group becomes one equivalent link that hangs between
/// its two pins as the links would without inertia. This lowers every conical height, by at most
/// the largest height that a group has between held pins (pencil/grouped.hpp). All heights are
/// proved to lie between the coarse ones and the coarse ones plus that largest height. Groups are
/// as long as the tolerance permits: short at the free end, long above. Heights of the coarse chain
/// are found by bisection and proved by two counts. Cost: for each attempt 15 ns a link, and the
/// heights of the coarse chain. One attempt suffices if links are similar.
///
/// The relative tolerance g is spent as follows. Let L be the estimate of the least requested
/// height. Groups have heights of at most `group_share` g L. Bisection brackets each coarse height
/// to `bracket_share` g. Counts prove that it lies within `proof_share` g of the middle of the
/// bracket: that is more than half the bracket. The bound is half the width of the proved interval,
/// (2 proof_share + group_share)/2 g = 0.75 g for the height L. It is g for a height of 0.7 L, so L
/// may be too large by a factor of 1.4.
struct CoarseChain {
    static constexpr std::string_view name = "coarse chain";

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (kind.size < ChainKind::least_sampled) return Fit::no("fewer than 24 links");
        if (kind.mode_count < kind.size) return Fit::no("a link without inertia");
        if (!kind.centroids_below) return Fit::no("a centroid above its pin");
        if (question.rtol <= 0) return Fit::no("no tolerance to spend");
        if (!(2 * groups(kind, question) <= detail::real(kind.size)))
            return Fit::no("as many groups as links, for that tolerance");
        return {};
    }
    /// Returns the requested tolerance: `solve` returns an answer only if its bounds are within it.
    double error_bound(const ChainKind&, const Question& question) const {
        return detail::goal(question);
    }
    /// Returns the predicted time. The estimate of the least height is worse, and a second attempt
    /// more likely, the more the weights grow upwards.
    double cost(const ChainKind& kind, const Question& question) const {
        constexpr double fixed = 6e-7, per_link = 1.5e-8, per_group = 7e-9;  // seconds
        const double attempts = 1 + std::clamp(kind.growth / 30, 0.0, 0.5);
        return fixed + attempts * per_link * detail::real(kind.size) +
               detail::loose_cost(groups(kind, question), bracket_share * detail::goal(question),
                                  question.count, per_group);
    }
    Answer solve(const Chain<double>& chain, const ChainKind& kind,
                 const Question& question) const {
        const auto plain = plain_pencil(chain);
        if (!plain) return Answer::none();
        const double per_length = std::ldexp(1.0, -chain.units().length_exponent);
        double least_height = estimated_least_height(kind, question) * per_length;
        for (int attempt = 0; attempt < most_attempts; ++attempt) {
            // Counts on the groups are proved down to this shift: half the estimate.
            const double least_shift = least_height / 2;
            const auto coarse = pencil::grouped(
                *plain, least_shift, group_share * detail::goal(question) * least_height);
            if (2 * coarse.pencil.size() > chain.size()) return Answer::none();
            if (coarse.pencil.size() < question.last()) {  // too few groups: the estimate is high
                least_height /= 4;
                continue;
            }
            const auto brackets =
                pencil::bisect(coarse.pencil, question.first - 1, question.count,
                               bracket_share * detail::goal(question), least_height);
            Answer answer{Vector<double>(question.count), Vector<double>(question.count)};
            for (Index i = 0; i < question.count && answer.found; ++i) {
                const auto& bracket = brackets[static_cast<std::size_t>(i)];
                const double start = pencil::between(bracket.lower, bracket.upper),
                             margin = proof_share * detail::goal(question);
                const double low = start * (1 - margin),
                             high = start * (1 + margin) + coarse.spread;
                answer.found =
                    low > least_shift && pencil::lies_within<double>(
                                             coarse.pencil, question.first - 1 + i, start, margin);
                answer.conical_height[i] = (low + (high - low) / 2) / per_length;
                answer.error_bound[i] = (high - low) / (2 * low) * (1 + 1e-14);  // with roundings
            }
            if (answer.found && answer.worst_bound() <= detail::goal(question)) return answer;
            // The coarse height, a lower bound of the exact one, is the next estimate.
            least_height = brackets.back().lower;
        }
        return Answer::none();
    }

   private:
    static constexpr int most_attempts = 3;
    static constexpr double group_share = 1.2, bracket_share = 0.2, proof_share = 0.15;

    /// Returns an estimate of the least requested height, that of mode number n. A wave of conical
    /// height h has the phase p/sqrt(h) (radians) from end to end, with p the phase of a wave of
    /// height 1. In mode n this phase is the n-th zero of J0 for a uniform cord. It is (n - 1) pi
    /// if more than half the weight is in the lowest link, which then hardly moves. Then the first
    /// mode has no wave: the chain swings as a whole. `ChainKind::tilt`, the height of the chain as
    /// one rigid link, is less than its largest height.
    static double estimated_least_height(const ChainKind& kind, const Question& question) {
        const Index number = question.last();
        const bool heavy_tip = kind.tip_share > 0.5;
        double phase = 2 * std::sqrt(kind.length);
        if (!kind.equal) phase = std::accumulate(kind.phase.begin(), kind.phase.end(), 0.0);
        const double root =
            phase / (heavy_tip && number > 1 ? std::numbers::pi * detail::real(number - 1)
                                             : zero_of_j0(number));
        return number == 1 ? std::max(kind.tilt, root * root) : root * root;
    }
    /// Returns an estimate of the number of groups. A group across which a wave of height 1 has the
    /// phase x has a height of at most x^2/6 between held ends, and may have that of `group_share`.
    static double groups(const ChainKind& kind, const Question& question) {
        const double most = group_share * std::max(detail::goal(question), 1e-30) *
                            estimated_least_height(kind, question);
        const double each = std::sqrt(6 * most);  // the phase across one group
        if (kind.equal) return 4 + 2 * std::sqrt(kind.length) / each;
        double sum = 4;
        for (Index i = 0; i < kind.stretches; ++i)
            sum += std::min(kind.links_per_stretch, kind.phase[static_cast<std::size_t>(i)] / each);
        return sum;
    }
};

}  // namespace revchain::models
