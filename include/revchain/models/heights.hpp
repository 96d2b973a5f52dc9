// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/models/closed_forms.hpp"
#include "revchain/models/coarse_chain.hpp"
#include "revchain/models/continuous_chain.hpp"
#include "revchain/models/double_double.hpp"
#include "revchain/models/equal_plummets.hpp"
#include "revchain/models/finite_amplitude.hpp"
#include "revchain/models/numerical.hpp"
#include "revchain/models/select.hpp"
#include "revchain/models/tapered_chain.hpp"

namespace revchain {

/// All models for conical heights, in the order in which they are listed. The last always answers.
inline constexpr std::tuple<models::ClosedForms, models::ConicalPendulum, models::EqualPlummets,
                            models::ContinuousChain, models::TaperedChain, models::CoarseChain, models::SinglePrecision,
                            models::AllTogether, models::Spectrum, models::Blocks, models::TwoWords,
                            models::FiniteAmplitude, models::ElementBisection>
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

inline Solution solve_by(std::string_view model, const Chain<double>& chain, const Question& question) {
    return solve_by(height_models, model, chain, question);
}

}  // namespace revchain
