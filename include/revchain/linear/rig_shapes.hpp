// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "revchain/linear/mode_shapes.hpp"
#include "revchain/linear/rig_counts.hpp"

/// The part of `rig_modes` that finds shapes.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// Finds shapes of rigged chains from the roots of their modes. `Spins`: of the elements whose shapes are found eight at
/// a time.
template <bool Spins = false>
class RigShapeFinder {
   public:
    /// `elements`: the pencil once more, where shapes can be found eight at a time; else null.
    RigShapeFinder(const Rig& rig, Index idle, pencil::SignedPencil<RigWord> sense,
                   std::shared_ptr<const pencil::ElementPencil<RigWord, Spins>> elements, std::vector<RigWord> roots,
                   Index threads)
        : threads_(threads),
          chain_(rig.chain()),
          idle_(idle),
          sense_(std::move(sense)),
          elements_(std::move(elements)),
          roots_(std::move(roots)) {}

    /// Returns the shapes of `count` modes, the first at index `first`, and if asked for residuals and nodes.
    ModeShapes<double> operator()(Index first, Index count, bool details, Progress* progress) const {
        const Threads used("modes", threads_);
        ModeShapes<double> shapes = room_for_shapes(chain_, count, details);
        if (elements_)
            in_lanes(shapes, first, progress);
        else
            for (Index j = 0; j < count; ++j) {
                alone(shapes, j, root(first + j));
                advance(progress, 1.0);  // may be cancelled
            }
        return shapes;
    }

   private:
    const RigWord& root(Index j) const { return roots_[static_cast<std::size_t>(j)]; }

    void alone(ModeShapes<double>& shapes, Index j, const RigWord& at) const {
        const auto vector = pencil::twisted_vector(sense_, at);
        Vector<double> rounded(sense_.size() + 1);
        for (Index i = 0; i <= sense_.size(); ++i)
            rounded[i] = static_cast<double>(vector[static_cast<std::size_t>(i)]);
        if (shapes.residual.size() > 0) shapes.residual[j] = pencil::relative_residual(sense_, at, rounded);
        set_offsets(shapes, j, rounded.data());
    }

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
                                       pencil::shapes_in_lanes(*elements_, lumped, at, details, found);
                                       found.store_rows(rows.data(), pins, there);
                                       for (std::size_t i = 0; i < there; ++i) {
                                           const Index mode = j + static_cast<Index>(i);
                                           if (found.found[i]) {
                                               if (details) shapes.residual[mode] = found.residual[i];
                                               set_offsets(shapes, mode, &rows[i * pins]);
                                           } else {
                                               alone(shapes, mode, root(from + mode));
                                           }
                                           advance(progress, 1.0);  // may be cancelled
                                       }
                                   });
    }

    /// Stores the offsets of the pencil's pins, and nodes where there is room for them.
    void set_offsets(ModeShapes<double>& shapes, Index j, const double* pins) const {
        double* const offset = &shapes.offset(j, 0);
        std::fill_n(offset, idle_, pins[0]);
        std::copy_n(pins, shapes.offset.cols() - idle_, offset + idle_);
        if (shapes.residual.size() > 0)
            shapes.nodes[static_cast<std::size_t>(j)] = nodes(chain_, crossings_of(shapes.offset.row(j)));
    }

    /// The links on which offsets change sign, and where.
    template <class Offsets>
    static std::vector<pencil::Crossing<double>> crossings_of(const Offsets& offset) {
        std::vector<pencil::Crossing<double>> crossings;
        double last = 0;
        for (Index m = 0; m + 1 < offset.size(); ++m) {
            const double lower = offset[m], upper = offset[m + 1];
            if (lower != 0) last = lower;
            if (upper != 0 && (upper < 0) != (last < 0) && last != 0) crossings.push_back({m, lower / (lower - upper)});
        }
        return crossings;
    }

    Index threads_;
    Chain<double> chain_;
    Index idle_;
    pencil::SignedPencil<RigWord> sense_;
    std::shared_ptr<const pencil::ElementPencil<RigWord, Spins>> elements_;
    std::vector<RigWord> roots_;
};

}  // namespace revchain::detail
