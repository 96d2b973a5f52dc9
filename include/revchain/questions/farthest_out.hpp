// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/numeric/compiled.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Returns the shape with this number of half waves whose free end is farthest out; null if none.
REVCHAIN_LAZY
const SteadyShape* farthest_out(const SteadyShapes& found, Index half_waves) {
    const SteadyShape* farthest = nullptr;
    for (const SteadyShape& shape : found.shapes)
        if (shape.half_waves == half_waves &&
            (farthest == nullptr || shape.offset[0] > farthest->offset[0]))
            farthest = &shape;
    return farthest;
}

}  // namespace revchain::detail
