// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/models/dense.hpp"
#include "revchain/models/heights.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// `height_models` and, for comparison, `models::Dense`, which takes seconds to compile.
/// `select(height_models_with_dense, ...)`, `solve(...)`, `solve_by(...)`.
inline constexpr auto height_models_with_dense = std::tuple_cat(height_models, std::tuple<models::Dense>{});

}  // namespace revchain
