// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "revchain/linear/counted_roots.hpp"
#include "revchain/linear/mode_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Finds the shape of a mode from its root.
class RigShape {
   public:
    /// `idle` is the number of lowest pins that the pencil omits.
    RigShape(const Chain<double>& chain, Index idle, pencil::SignedPencil<RigWord> sense)
        : chain_(chain), places_(pin_places(chain)), idle_(idle), sense_(std::move(sense)) {}

    const Chain<double>& chain() const { return chain_; }
    Index idle() const { return idle_; }

    /// Stores the shape of mode j and, if there is room, its residual and nodes.
    void find(ModeShapes<double>& shapes, Index j, const RigWord& at) const {
        const auto vector = pencil::twisted_vector(sense_, at);
        Vector<double> rounded(sense_.size() + 1);
        for (Index i = 0; i <= sense_.size(); ++i)
            rounded[i] = static_cast<double>(vector[static_cast<std::size_t>(i)]);
        if (shapes.residual.size() > 0)
            shapes.residual[j] = pencil::relative_residual(sense_, at, rounded);
        const Index pins = shapes.offset.cols() - idle_;
        shapes.offset.row(j).tail(pins) = rounded.head(pins).transpose();
        complete(shapes, j);
    }

    /// Stores offsets of idle pins, which follow the rest unless held, and nodes if there is room.
    void complete(ModeShapes<double>& shapes, Index j) const {
        auto offset = shapes.offset.row(j);
        offset.head(idle_).setConstant(sense_.ground ? 0.0 : offset[idle_]);
        if (shapes.residual.size() == 0) return;
        shapes.nodes[static_cast<std::size_t>(j)] = nodes(chain_, places_, crossings_of(offset));
    }

   private:
    template <class Offsets>
    static std::vector<pencil::Crossing<double>> crossings_of(const Offsets& offset) {
        std::vector<pencil::Crossing<double>> crossings;
        double last = 0;
        for (Index m = 0; m + 1 < offset.size(); ++m) {
            const double lower = offset[m], upper = offset[m + 1];
            if (lower != 0) last = lower;
            const bool crosses = upper != 0 && last != 0 && (upper < 0) != (last < 0);
            if (crosses) crossings.push_back({m, lower / (lower - upper)});
        }
        return crossings;
    }

    Chain<double> chain_;
    std::vector<RigWord> places_;
    Index idle_;
    pencil::SignedPencil<RigWord> sense_;
};

/// Finds shapes of rigged chains from the roots of their modes. `Spins` is that of the elements.
template <bool Spins = false>
class RigShapeFinder {
   public:
    /// `elements` is the same pencil if shapes can be found eight at a time, else null.
    RigShapeFinder(const Rig& rig, Index idle, pencil::SignedPencil<RigWord> sense,
                   std::shared_ptr<const pencil::ElementPencil<RigWord, Spins>> elements,
                   std::vector<RigWord> roots, Index threads)
        : threads_(threads),
          shape_(rig.chain(), idle, std::move(sense)),
          elements_(std::move(elements)),
          roots_(std::move(roots)) {}

    /// Returns shapes of `count` modes from index `first` on; residuals and nodes if `details`.
    ModeShapes<double> operator()(Index first, Index count, bool details,
                                  Progress* progress) const {
        const Threads used("modes", threads_);
        ModeShapes<double> shapes = room_for_shapes(shape_.chain(), count, details);
        if (elements_)
            in_lanes(shapes, first, progress);
        else
            for (Index j = 0; j < count; ++j) {
                shape_.find(shapes, j, root(first + j));
                advance(progress, 1.0);  // may throw Cancelled
            }
        return shapes;
    }

   private:
    const RigWord& root(Index j) const { return roots_[static_cast<std::size_t>(j)]; }

    void in_lanes(ModeShapes<double>& shapes, Index from, Progress* progress) const {
        shapes_by_lanes(
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
