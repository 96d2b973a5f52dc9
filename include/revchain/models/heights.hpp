// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/models/double_double.hpp"
#include "revchain/models/finite_amplitude.hpp"
#include "revchain/models/for_modes.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::models {

/// All models for conical heights, in the order in which they are listed. They are the models of
/// `modes`, and those for large inclinations and for tolerances below the precision of double. The
/// last always answers.
inline constexpr std::tuple<ClosedForms, ConicalPendulum, EqualPlummets, ContinuousChain,
                            TaperedChain, CoarseChain, Aberth, Interpolated, Condensed,
                            DoubleDoubleBisection, FiniteAmplitude, Bisection>
    height_models{};

/// Call `select` and `solve` with all these models.
REVCHAIN_LAZY
auto select(const Chain<double>& chain, const Question& question,
            std::optional<double> time_budget = std::nullopt) {
    return select(height_models, chain, question, time_budget);
}
REVCHAIN_LAZY
Solution solve(const Chain<double>& chain, const Question& question,
               std::optional<double> time_budget = std::nullopt) {
    return solve(height_models, chain, question, time_budget);
}

REVCHAIN_LAZY
Solution solve_by(std::string_view model, const Chain<double>& chain, const Question& question) {
    return solve_by(height_models, model, chain, question);
}

}  // namespace revchain::models
