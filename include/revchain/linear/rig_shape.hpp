// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "revchain/linear/counted_roots.hpp"
#include "revchain/linear/mode_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Finds the shape of a mode from its root.
class RigShape {
   public:
    /// `idle`: the lowest pins that the pencil leaves out.
    RigShape(const Chain<double>& chain, Index idle, pencil::SignedPencil<RigWord> sense)
        : chain_(chain), idle_(idle), sense_(std::move(sense)) {}

    const Chain<double>& chain() const { return chain_; }
    Index idle() const { return idle_; }

    /// Stores the shape of mode j, with residual and nodes where there is room for them.
    void find(ModeShapes<double>& shapes, Index j, const RigWord& at) const {
        const auto vector = pencil::twisted_vector(sense_, at);
        Vector<double> rounded(sense_.size() + 1);
        for (Index i = 0; i <= sense_.size(); ++i)
            rounded[i] = static_cast<double>(vector[static_cast<std::size_t>(i)]);
        if (shapes.residual.size() > 0) shapes.residual[j] = pencil::relative_residual(sense_, at, rounded);
        const Index pins = shapes.offset.cols() - idle_;
        shapes.offset.row(j).tail(pins) = rounded.head(pins).transpose();
        complete(shapes, j);
    }

    /// Stores the offsets of idle pins and, where there is room for them, nodes. Links left out
    /// hang along, but for one that holds the lower end.
    void complete(ModeShapes<double>& shapes, Index j) const {
        auto offset = shapes.offset.row(j);
        offset.head(idle_).setConstant(sense_.ground ? 0.0 : offset[idle_]);
        if (shapes.residual.size() > 0) shapes.nodes[static_cast<std::size_t>(j)] = nodes(chain_, crossings_of(offset));
    }

   private:
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

    Chain<double> chain_;
    Index idle_;
    pencil::SignedPencil<RigWord> sense_;
};

}  // namespace revchain::detail
