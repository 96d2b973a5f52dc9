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
/// are found by bisection and proved by two counts. Cost: 17 ns a link, and the coarse chain.
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
    /// Returns the requested tolerance. Unequal links may need groups of one link to meet it.
    double error_bound(const ChainKind&, const Question& question) const {
        return detail::goal(question);
    }
    double cost(const ChainKind& kind, const Question& question) const {
        const double attempts = 1 + std::clamp(kind.growth / 30, 0.0, 0.5);
        return 6e-7 + attempts * 1.5e-8 * detail::real(kind.size) +
               detail::loose_cost(groups(kind, question), 0.2 * detail::goal(question),
                                  question.count, 7e-9);
    }
    Answer solve(const Chain<double>& chain, const ChainKind& kind,
                 const Question& question) const {
        const auto plain = plain_pencil(chain);
        if (!plain) return Answer::none();
        const double per_length = std::ldexp(1.0, -chain.units().length_exponent);
        double last = last_height(kind, question) * per_length;
        for (int attempt = 0; attempt < 3; ++attempt) {
            const auto coarse =
                pencil::grouped(*plain, last / 2, 1.2 * detail::goal(question) * last);
            if (2 * coarse.pencil.size() > chain.size()) return Answer::none();
            if (coarse.pencil.size() < question.last()) {
                last /= 4;
                continue;
            }
            const auto brackets = pencil::bisect(coarse.pencil, question.first - 1, question.count,
                                                 0.2 * detail::goal(question), last);
            Answer answer{Vector<double>(question.count), Vector<double>(question.count)};
            for (Index i = 0; i < question.count && answer.found; ++i) {
                const auto& bracket = brackets[static_cast<std::size_t>(i)];
                const double start = pencil::between(bracket.lower, bracket.upper),
                             margin = 0.15 * detail::goal(question);
                answer.found =
                    start > last / 2 && pencil::lies_within<double>(
                                            coarse.pencil, question.first - 1 + i, start, margin);
                const double low = start * (1 - margin),
                             high = start * (1 + margin) + coarse.spread;
                answer.conical_height[i] = (low + (high - low) / 2) / per_length;
                answer.error_bound[i] = (high - low) / (2 * low) * (1 + 1e-14);
            }
            if (answer.found && answer.worst_bound() <= detail::goal(question)) return answer;
            last = brackets.back().lower;
        }
        return Answer::none();
    }

   private:
    /// Returns an estimate of the least requested height, from the phase of a wave from end to end.
    /// With a heavy tip the first mode has no wave.
    static double last_height(const ChainKind& kind, const Question& question) {
        const Index last = question.last();
        const bool heavy_tip = kind.tip_share > 0.5;
        double phase = 2 * std::sqrt(kind.length);
        if (!kind.equal) phase = std::accumulate(kind.phase.begin(), kind.phase.end(), 0.0);
        const double wave =
            phase /
            (heavy_tip && last > 1 ? std::numbers::pi * detail::real(last - 1) : zero_of_j0(last));
        return last == 1 ? std::max(kind.tilt, wave * wave) : wave * wave;
    }
    /// Returns an estimate of the number of groups. A group of phase x has a height of at most
    /// x^2/6 between held ends. That height may be 1.2 rtol of the least height.
    static double groups(const ChainKind& kind, const Question& question) {
        const double spread =
            1.2 * std::max(detail::goal(question), 1e-30) * last_height(kind, question);
        const double each = std::sqrt(6 * spread);
        if (kind.equal) return 4 + 2 * std::sqrt(kind.length) / each;
        double sum = 4;
        for (Index i = 0; i < kind.stretches; ++i)
            sum += std::min(kind.links_per_stretch, kind.phase[static_cast<std::size_t>(i)] / each);
        return sum;
    }
};

}  // namespace revchain::models
