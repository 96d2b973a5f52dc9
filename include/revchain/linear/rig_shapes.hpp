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
        shapes.offset.row(j).tail(shapes.offset.cols() - idle_) = rounded.head(shapes.offset.cols() - idle_).transpose();
        complete(shapes, j);
    }

    void in_lanes(ModeShapes<double>& shapes, Index from, Progress* progress) const {
        shapes_in_eights(
            shapes, *elements_, idle_,
            [&](Index j, RigWord& exact, RigWord& rounded) { exact = rounded = root(from + j); },
            [&](Index j) { alone(shapes, j, root(from + j)); },
            [&](Index j, const auto&, std::size_t) { complete(shapes, j); }, progress);
    }

    /// Offsets of the idle pins and, where there is room for them, nodes.
    void complete(ModeShapes<double>& shapes, Index j) const {
        auto offset = shapes.offset.row(j);
        offset.head(idle_).setConstant(offset[idle_]);
        if (shapes.residual.size() > 0)
            shapes.nodes[static_cast<std::size_t>(j)] = nodes(chain_, crossings_of(offset));
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
