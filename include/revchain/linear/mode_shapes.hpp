// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "revchain/linear/lazy_mode_shapes.hpp"
#include "revchain/linear/one_mode.hpp"
#include "revchain/numeric/floating_point_state.hpp"
#include "revchain/numeric/large_memory.hpp"
#include "revchain/pencil/proved_roots.hpp"

/// This header has stage 2 of `modes`: shapes, residuals and nodes of modes of known heights.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// Returns distances of the lower pins of links from the free end, along the chain.
template <Real T>
std::vector<Wide<T>> pin_places(const Chain<T>& chain) {
    std::vector<Wide<T>> places;
    places.reserve(static_cast<std::size_t>(chain.size()));
    Wide<T> below(T(0));
    for (Index m = 0; m < chain.size(); ++m)
        places.push_back(below), below = below + Wide<T>(chain.length()[m]);
    return places;
}

/// Returns distances of crossings from the free end along the chain; `places` is its `pin_places`.
template <Real T>
Vector<T> nodes(const Chain<T>& chain, const std::vector<Wide<T>>& places,
                const std::vector<pencil::Crossing<T>>& crossings) {
    Vector<T> found(static_cast<Index>(crossings.size()));
    Index i = 0;
    for (const pencil::Crossing<T>& crossing : crossings)
        found[i++] = static_cast<T>(places[static_cast<std::size_t>(crossing.element)] +
                                    T(crossing.share * chain.length()[crossing.element]));
    return found;
}

template <Real T>
ModeShapes<T> room_for_shapes(const Chain<T>& chain, Index count, bool details = true) {
    const Index more = details ? count : 0;
    ModeShapes<T> shapes{Table<T>(count, chain.size() + 1), Vector<T>(more),
                         std::vector<Vector<T>>(static_cast<std::size_t>(more))};
    will_be_filled(shapes.offset.data(),
                   static_cast<std::size_t>(shapes.offset.size()) * sizeof(T));
    return shapes;
}

/// Stores the shape of mode `j` and, if there is room, nodes and residual. `height` is scaled.
template <Real T, Real S>
void set_shape(ModeShapes<T>& shapes, Index j, const Chain<T>& chain,
               const pencil::ElementPencil<S>& pencil, const T& height,
               const pencil::Eigenvector<T>& vector) {
    shapes.offset.row(j) = vector.offset.transpose();
    if (shapes.residual.size() == 0) return;
    shapes.residual[j] = pencil::relative_residual(pencil, height, vector.offset);
    shapes.nodes[static_cast<std::size_t>(j)] = nodes(chain, pin_places(chain), vector.crossings);
}

/// Finds shapes of the modes of `shapes`, `pencil::shape_lanes` at a time, and residuals if there
/// is room. Pins of the pencil are stored from column `idle` on. `root(j, exact, rounded)` sets a
/// mode's root. `alone(j)` finds a shape that lanes cannot find. `take(j, found, lane)` receives
/// the others.
template <bool Spins, std::floating_point T, class Root, class Alone, class Take>
void shapes_by_lanes(ModeShapes<T>& shapes,
                     const pencil::ElementPencil<DoubleWord<T>, Spins>& pencil, Index idle,
                     const Root& root, const Alone& alone, const Take& take, Progress* progress) {
    const FloatingPointStateGuard quiet;
    const bool lumped = pencil::is_lumped(pencil), details = shapes.residual.size() > 0;
    const auto stride = static_cast<std::size_t>(shapes.offset.cols());
    const auto count = static_cast<std::size_t>(shapes.offset.rows()),
               pins = stride - static_cast<std::size_t>(idle);
    const auto find = [&](std::size_t first, std::size_t there, pencil::ShapesInLanes<T>& found) {
        pencil::RootsInLanes<T> roots;
        for (std::size_t i = 0; i < pencil::shape_lanes; ++i)
            root(static_cast<Index>(first + std::min(i, there - 1)), roots.exact[i],
                 roots.rounded[i]);
        pencil::shapes_in_lanes(pencil, lumped, roots, details, found);
        found.store_rows(&shapes.offset(static_cast<Index>(first), idle), stride, pins, there);
        for (std::size_t i = 0; i < there; ++i) {
            const auto j = static_cast<Index>(first + i);
            if (found.found[i]) {
                if (details) shapes.residual[j] = found.residual[i];
                take(j, found, i);
            } else {
                alone(j);
            }
            advance(progress, 1.0);  // may throw Cancelled
        }
    };
    pencil::for_lanes<T>(count, pencil.elements.size(), find);
}

/// Finds shapes of modes of a chain from heights in the units of its pencils.
template <Real T>
class ShapeFinder {
   public:
    /// `loose`: T suffices at the height given; else shapes are found in `Wide<T>` at the height
    /// before it was rounded. `pencils`: those of the chain, or null if they are assembled again.
    ShapeFinder(const Chain<T>& chain, Heights<T> height, bool loose,
                std::shared_ptr<const Pencils<T>> pencils = nullptr)
        : chain_(chain), height_(std::move(height)), loose_(loose), pencils_(std::move(pencils)) {}

    /// Returns shapes of `count` modes from index `from` on, with residuals and nodes if `details`.
    ModeShapes<T> operator()(Index from, Index count, bool details, Progress* progress) const {
        if (count == 0) return room_for_shapes(chain_, 0);
        const Heights<T> height = heights(from, count);
        ModeShapes<T> shapes = room_for_shapes(chain_, count, details);
        std::optional<Pencils<T>> own;
        const Pencils<T>& pencils = pencils_ ? *pencils_ : own.emplace(chain_);
        if constexpr (std::is_same_v<T, double>)
            if (pencils.wide().units.empty() && chain_.size() <= most_in_lanes) {
                in_lanes(shapes, pencils, height, progress);
                return shapes;
            }
        parallel_for(count, 1, [&](Index start, Index end) {
            for (Index j = start; j < end; ++j) {
                alone(shapes, j, pencils, height[static_cast<std::size_t>(j)]);
                advance(progress, 1.0);  // may throw Cancelled
            }
        });
        return shapes;
    }

    const Chain<T>& chain() const { return chain_; }
    Heights<T> heights(Index from, Index count) const {
        return Heights<T>(height_.begin() + from, height_.begin() + from + count);
    }

   private:
    void alone(ModeShapes<T>& shapes, Index j, const Pencils<T>& pencils,
               const Height<T>& at) const {
        const T& height = at.eigenvalue;
        if (loose_)
            set_shape(shapes, j, chain_, pencils.rounded(), height,
                      pencil::eigenvector(pencils.rounded(), height));
        else
            set_shape(shapes, j, chain_, pencils.wide(), height,
                      fine_shape<T>(pencils.wide(), at.unrounded));
    }

    void in_lanes(ModeShapes<T>& shapes, const Pencils<T>& pencils, const Heights<T>& height,
                  Progress* progress) const {
        const bool details = shapes.residual.size() > 0;
        const auto places = details ? pin_places(chain_) : std::vector<Wide<T>>();
        const auto root = [&](Index j, Wide<T>& exact, Wide<T>& rounded) {
            const Height<T>& at = height[static_cast<std::size_t>(j)];
            exact = loose_ ? Wide<T>(at.eigenvalue) : at.unrounded;
            rounded = at.eigenvalue;
        };
        const auto take = [&](Index j, const pencil::ShapesInLanes<T>& found, std::size_t lane) {
            if (!details) return;
            const auto crossed = found.crossings(lane, &shapes.offset(j, 0));
            shapes.nodes[static_cast<std::size_t>(j)] = nodes(chain_, places, crossed);
        };
        const auto one = [&](Index j) {
            alone(shapes, j, pencils, height[static_cast<std::size_t>(j)]);
        };
        shapes_by_lanes(shapes, pencils.wide(), 0, root, one, take, progress);
    }

    Chain<T> chain_;
    Heights<T> height_;
    bool loose_;
    std::shared_ptr<const Pencils<T>> pencils_;
};

}  // namespace revchain::detail
