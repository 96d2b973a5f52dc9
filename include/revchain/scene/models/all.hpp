// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/scene/models/dense.hpp"
#include "revchain/scene/models/heights.hpp"

namespace revchain {

/// `height_models`, and what no one chooses but some compare with: `models::Dense`, which takes seconds to compile. `select(all_height_models, ...)`, `solve(...)`, `solve_by(...)`.
inline constexpr auto all_height_models = std::tuple_cat(height_models, std::tuple<models::Dense>{});

}  // namespace revchain
