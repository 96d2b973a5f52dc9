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

/// The models among which `modes` chooses; where no tolerance is given, among those whose bounds are proved. The last
/// always answers.
inline constexpr std::tuple<ClosedForms, EqualPlummets, ContinuousChain, TaperedChain, CoarseChain, SinglePrecision,
                            Aberth, Interpolated, Condensed, Bisection>
    for_modes{};

}  // namespace revchain::models
