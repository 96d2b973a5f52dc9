// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/branch/polish.hpp"
#include "revchain/finite/shapes/verification.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::finite {

/// The shape next to a point of a branch at which one condition holds: at a given height with what `verified` proves.
/// Where the height is found from something else that is proved of the shape at that height, and the bound adds what
/// Newton's method left of the balance, times the condition; where nothing is proved, as at a fold, it is that alone.
inline std::optional<SteadyShape> shape_at(const Links<Wide<double>>& chain, const BranchState& near,
                                           const Condition<Wide<double>>& condition) {
    auto found = polished(chain.links, near, condition);
    if (!found.shape.converged) return std::nullopt;
    const bool given = condition.gives_height();
    const auto height =
        given ? enclosed<DoubleDouble>(found.height) : Interval<DoubleDouble>(DoubleDouble(found.height));
    SteadyShape shape =
        verified_shape(chain, enclosed<DoubleDouble>(chain.links), found.height, height, std::move(found.shape), given);
    const bool proved = shape.error_bound < 1;
    if (given && proved) return shape;
    shape.condition = found.condition;
    shape.error_bound = (proved ? shape.error_bound : 0x1p-52) + found.condition * (found.residual + 1e-30);
    return shape;
}

}  // namespace revchain::finite
