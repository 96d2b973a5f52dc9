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

/// Finds shapes of rigged chains from the roots of their modes.
class RigShapeFinder {
   public:
    /// `elements`: the pencil once more, where shapes can be found eight at a time; else null.
    RigShapeFinder(const Rig& rig, Index idle, pencil::SignedPencil<RigWord> sense,
                   std::shared_ptr<const pencil::ElementPencil<RigWord>> elements, std::vector<RigWord> roots,
                   Index threads)
        : threads_(threads),
          shape_(rig.chain(), idle, std::move(sense)),
          elements_(std::move(elements)),
          roots_(std::move(roots)) {}

    /// Returns the shapes of `count` modes, the first at index `first`, and if asked for residuals and nodes.
    ModeShapes<double> operator()(Index first, Index count, bool details, Progress* progress) const {
        const Threads used("modes", threads_);
        ModeShapes<double> shapes = room_for_shapes(shape_.chain(), count, details);
        if (elements_ && elements_->spin.empty())
            in_lanes<false>(shapes, first, progress);
        else if (elements_)
            in_lanes<true>(shapes, first, progress);
        else
            for (Index j = 0; j < count; ++j) {
                shape_.find(shapes, j, root(first + j));
                advance(progress, 1.0);  // may be cancelled
            }
        return shapes;
    }

   private:
    const RigWord& root(Index j) const { return roots_[static_cast<std::size_t>(j)]; }

    template <bool spinning>
    void in_lanes(ModeShapes<double>& shapes, Index from, Progress* progress) const {
        const FloatingPointStateGuard quiet;
        const bool lumped = pencil::is_lumped(*elements_), details = shapes.residual.size() > 0;
        const std::size_t pins = elements_->elements.size() + 1;
        pencil::for_eights<double>(static_cast<std::size_t>(shapes.offset.rows()), pins,
                                   [&](std::size_t first, std::size_t there, pencil::ShapesInLanes<double>& found) {
                                       const auto j = static_cast<Index>(first);
                                       pencil::RootsInLanes<double> at;
                                       std::vector<double> rows(pencil::shape_lanes * pins);
                                       for (std::size_t i = 0; i < pencil::shape_lanes; ++i)
                                           at.exact[i] = at.rounded[i] =
                                               root(from + j + static_cast<Index>(std::min(i, there - 1)));
                                       pencil::shapes_in_lanes<spinning>(*elements_, lumped, at, details, found);
                                       found.store_rows(rows.data(), pins, there);
                                       for (std::size_t i = 0; i < there; ++i) {
                                           const Index mode = j + static_cast<Index>(i);
                                           if (found.found[i]) {
                                               if (details) shapes.residual[mode] = found.residual[i];
                                               shape_.set_offsets(shapes, mode, &rows[i * pins]);
                                           } else {
                                               shape_.find(shapes, mode, root(from + mode));
                                           }
                                           advance(progress, 1.0);  // may be cancelled
                                       }
                                   });
    }

    Index threads_;
    RigShape shape_;
    std::shared_ptr<const pencil::ElementPencil<RigWord>> elements_;
    std::vector<RigWord> roots_;
};

}  // namespace revchain::detail
