// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/branches.hpp"
#include "revchain/models/model.hpp"

namespace revchain::inline REVCHAIN_BUILD::models {

/// The conical height at which the shape that grows out of a mode has its lowest link at a given
/// inclination, by the exact equations along the branch. Bounds are estimates: twice the error of
/// the shape's inclinations over the inclination of the lowest link, and 4 ulp. Cost: 4
/// to 10 microseconds a link and mode (bench_tradeoff: 5 to 1000 links).
struct FiniteAmplitude {
    static constexpr std::string_view name = "finite amplitude";
    static constexpr bool is_linear = false;

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (!(question.inclination > 0)) return Fit::no("no inclination given");
        if (kind.mode_count < kind.size) return Fit::no("a link without inertia");
        if (question.inclination > std::numbers::pi / 2 - 1e-6)
            return Fit::no("too near a right angle");
        return {};
    }
    double error_bound(const ChainKind&, const Question& question) const {
        return 1e-15 * (1 + 1 / std::max(question.inclination, 1e-30));
    }
    double cost(const ChainKind& kind, const Question& question) const {
        return detail::real(question.count) * (6e-6 + 8.2e-6 * detail::real(kind.size));
    }
    Answer solve(const Chain<double>& chain, const ChainKind& kind,
                 const Question& question) const {
        Answer answer{Vector<double>(question.count), Vector<double>(question.count)};
        for (Index j = 0; j < question.count; ++j) {
            const ShapesOnBranch found = shapes_on_branch(
                chain, {.mode = question.first + j, .tip_inclination = question.inclination}, 1);
            if (found.shapes.empty()) return Answer::none();
            answer.conical_height[j] = found.shapes.front().conical_height;
            answer.error_bound[j] =
                std::max(error_bound(kind, question),
                         2 * found.shapes.front().error_bound / question.inclination);
        }
        return answer;
    }
};

}  // namespace revchain::models
