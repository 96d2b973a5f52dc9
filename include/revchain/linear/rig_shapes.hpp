// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "revchain/linear/rig_counts.hpp"
#include "revchain/linear/rig_shape.hpp"

/// The part of `rig_modes` that finds shapes.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// Finds shapes of rigged chains from the roots of their modes. `Spins`: of the elements whose
/// shapes are found eight at a time.
template <bool Spins = false>
class RigShapeFinder {
   public:
    /// `elements`: the pencil once more, where shapes can be found eight at a time; else null.
    RigShapeFinder(const Rig& rig, Index idle, pencil::SignedPencil<RigWord> sense,
                   std::shared_ptr<const pencil::ElementPencil<RigWord, Spins>> elements, std::vector<RigWord> roots,
                   Index threads)
        : threads_(threads),
          shape_(rig.chain(), idle, std::move(sense)),
          elements_(std::move(elements)),
          roots_(std::move(roots)) {}

    /// Returns the shapes of `count` modes, the first at index `first`, and if asked for residuals
    /// and nodes.
    ModeShapes<double> operator()(Index first, Index count, bool details, Progress* progress) const {
        const Threads used("modes", threads_);
        ModeShapes<double> shapes = room_for_shapes(shape_.chain(), count, details);
        if (elements_)
            in_lanes(shapes, first, progress);
        else
            for (Index j = 0; j < count; ++j) {
                shape_.find(shapes, j, root(first + j));
                advance(progress, 1.0);  // may be cancelled
            }
        return shapes;
    }

   private:
    const RigWord& root(Index j) const { return roots_[static_cast<std::size_t>(j)]; }

    void in_lanes(ModeShapes<double>& shapes, Index from, Progress* progress) const {
        shapes_in_eights(
            shapes, *elements_, shape_.idle(),
            [&](Index j, RigWord& exact, RigWord& rounded) { exact = rounded = root(from + j); },
            [&](Index j) { shape_.find(shapes, j, root(from + j)); },
            [&](Index j, const auto&, std::size_t) { shape_.complete(shapes, j); }, progress);
    }

    Index threads_;
    RigShape shape_;
    std::shared_ptr<const pencil::ElementPencil<RigWord, Spins>> elements_;
    std::vector<RigWord> roots_;
};

}  // namespace revchain::detail
