// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/models/closed_forms.hpp"
#include "revchain/models/coarse_chain.hpp"
#include "revchain/models/continuous_chain.hpp"
#include "revchain/models/equal_plummets.hpp"
#include "revchain/models/numerical.hpp"
#include "revchain/models/select.hpp"
#include "revchain/models/tapered_chain.hpp"

namespace revchain::models {

/// The models among which `modes` chooses where no tolerance is given: full accuracy, every bound proved by counts.
/// The last always answers.
inline constexpr std::tuple<Aberth, Interpolated, Condensed, Bisection> for_full_accuracy{};

/// The models among which `modes` chooses for a tolerance.
inline constexpr auto for_tolerance = std::tuple_cat(
    std::tuple<ClosedForms, EqualPlummets, ContinuousChain, TaperedChain, CoarseChain, SinglePrecision>{},
    for_full_accuracy);

}  // namespace revchain::models
