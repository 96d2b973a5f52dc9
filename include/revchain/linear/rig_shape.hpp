// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>
#include <vector>

#include "revchain/linear/counted_roots.hpp"
#include "revchain/linear/mode_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Finds shapes of rigged chains from the roots of their modes.
template <bool Spins = false>
struct RigShapeFinder {
    Chain<double> chain;
    Index idle = 0;  ///< the number of lowest pins that the pencil omits
    pencil::SignedPencil<RigWord> sense;
    std::vector<RigWord> roots;
    /// The same pencil as elements, with which eight shapes are found at a time. Null: one at a time.
    std::shared_ptr<const pencil::ElementPencil<RigWord, Spins>> elements{};

    /// Returns shapes of `count` modes from index `from` on; see `found_shapes`.
    ModeShapes<double> operator()(Index from, Index count, bool details, Progress* progress) const {
        const auto root = [&](Index j) -> ShapeRoot<double> {
            const RigWord& x = roots[static_cast<std::size_t>(from + j)];
            return {x, x};
        };
        return found_shapes(
            chain, {idle, sense.ground.has_value()}, count, details, root, elements.get(),
            [&](const auto& f) { f(sense); }, progress);
    }
};

}  // namespace revchain::detail
