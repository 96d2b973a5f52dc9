// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/branch/polish.hpp"
#include "revchain/finite/shapes/verification.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A shape found by Newton's method at a height, with what `verified` proves at heights in
/// `within`.
inline SteadyShape verified_shape(const BranchSystem& system, const Fine& height, const Interval<Far>& within,
                                  Balanced<Fine> found, bool height_is_given) {
    if (!system.rig)
        return verified_shape(system.chain, enclosed<Far>(system.chain.links), height, within, std::move(found),
                              height_is_given);
    const RiggedLinks rig = system.rigged_at(height);
    found.offset.resize(rig.links.size() + 1);  // without the firm end of a spring
    found.posture = rig.posture;
    return verified_shape(rig, folded_links(rig), height, within, std::move(found), height_is_given);
}

/// The shape near a point of a branch that satisfies a condition. At a given height its bound is
/// that of `verified`. If the height is found, the bound adds the residual of Newton's method times
/// the condition number; where nothing is proved, as at a fold, it is that alone.
inline std::optional<SteadyShape> shape_at(const BranchSystem& system, const BranchState& near,
                                           const Condition& condition) {
    auto found = polished(system.links, near, condition);
    if (!found.shape.converged) return std::nullopt;
    const bool given = condition.gives_height();
    const auto height = given ? enclosed<Far>(found.height) : Interval<Far>(Far(found.height));
    SteadyShape shape = verified_shape(system, found.height, height, std::move(found.shape), given);
    const bool proved = shape.error_bound < 1;
    if (given && proved) return shape;
    shape.condition = found.condition;
    shape.error_bound = (proved ? shape.error_bound : 0x1p-52) + found.condition * (found.residual + 1e-30);
    return shape;
}

}  // namespace revchain::finite
