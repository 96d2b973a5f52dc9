// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/scene/models/closed_forms.hpp"
#include "revchain/scene/models/coarse_chain.hpp"
#include "revchain/scene/models/continuous_chain.hpp"
#include "revchain/scene/models/equal_plummets.hpp"
#include "revchain/scene/models/finite_amplitude.hpp"
#include "revchain/scene/models/numerical.hpp"
#include "revchain/scene/models/tapered_chain.hpp"
#include "revchain/scene/models/two_words.hpp"
#include "revchain/scene/select.hpp"

namespace revchain {

/// All models for conical heights, in the order in which they are listed. The last always answers.
inline constexpr std::tuple<models::ClosedForms, models::EqualPlummets, models::ContinuousChain, models::TaperedChain,
                            models::CoarseChain, models::SinglePrecision, models::AllTogether, models::Spectrum,
                            models::Blocks, models::TwoWords, models::FiniteAmplitude, models::ElementBisection>
    height_models{};

/// `select` and `solve` among all of them.
inline auto select(const Chain<double>& chain, const Question& question,
                   std::optional<double> time_budget = std::nullopt) {
    return select(height_models, chain, question, time_budget);
}
inline Solution solve(const Chain<double>& chain, const Question& question,
                      std::optional<double> time_budget = std::nullopt) {
    return solve(height_models, chain, question, time_budget);
}

/// By the model of that name, whatever others would cost. No heights, and `tolerance_not_met`, where it does not apply or
/// finds no answer; that status, too, where its bound is larger than the tolerance.
/// Throws InvalidArgument as `select`, and for a name that no model has.
inline Solution solve_by(std::string_view model, const Chain<double>& chain, const Question& question) {
    const ChainKind kind(chain);
    detail::check(kind, question);
    const auto estimates = detail::estimates(height_models, kind, question);
    for (std::size_t i = 0; i < estimates.size(); ++i) {
        if (estimates[i].name != model) continue;
        Solution found{{{}, {}, false}, estimates[i].name, Status::tolerance_not_met};
        if (!estimates[i].fit.applies) return found;
        found.answer = detail::asked(height_models, i, chain, kind, question);
        if (found.answer.worst_bound() <= detail::goal(question)) found.status = Status::success;
        return found;
    }
    detail::refuse("solve_by", "there is no model " + std::string(model));
}

}  // namespace revchain
