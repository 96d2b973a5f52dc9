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
#include "revchain/numeric/parallel.hpp"
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

/// Returns distances of crossings from the free end along the chain. `places` is its `pin_places`;
/// element 0 is link number `idle`.
template <Real T>
Vector<T> nodes(const Chain<T>& chain, const std::vector<Wide<T>>& places,
                const std::vector<pencil::Crossing<T>>& crossings, Index idle = 0) {
    Vector<T> found(static_cast<Index>(crossings.size()));
    Index i = 0;
    for (const auto& [element, share] : crossings) {
        const Index m = idle + element;
        found[i++] =
            static_cast<T>(places[static_cast<std::size_t>(m)] + T(share * chain.length()[m]));
    }
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

/// The lowest pins of a chain that its pencil omits. They move with the next pin, or are held.
struct IdlePins {
    Index count = 0;
    bool held = false;
};

/// The root of a mode, and the rounded root for which its residual is computed.
template <Real T>
struct ShapeRoot {
    Wide<T> exact, rounded;
};

/// Returns shapes of `count` modes of a chain or rig, with residuals and nodes if `details`.
/// `root(j)` returns a mode's `ShapeRoot`. Shapes are found `pencil::shape_lanes` at a time from
/// `elements`. If it is null, and for shapes that lanes cannot find, each is found alone:
/// `visit(f)` calls f with the pencil to use.
template <Real T, bool Spins, class Root, class Visit>
ModeShapes<T> found_shapes(const Chain<T>& chain, const IdlePins& idle, Index count, bool details,
                           const Root& root, const pencil::ElementPencil<Wide<T>, Spins>* elements,
                           const Visit& visit, Progress* progress) {
    ModeShapes<T> shapes = room_for_shapes(chain, count, details);
    const auto places = details ? pin_places(chain) : std::vector<Wide<T>>();
    const Index pins = shapes.offset.cols() - idle.count;
    const auto complete = [&](Index j, const std::vector<pencil::Crossing<T>>& crossings) {
        auto offset = shapes.offset.row(j);
        offset.head(idle.count).setConstant(idle.held ? T(0) : offset[idle.count]);
        if (details)
            shapes.nodes[static_cast<std::size_t>(j)] = nodes(chain, places, crossings, idle.count);
        advance(progress, 1.0);  // may throw Cancelled
    };
    const auto alone = [&](Index j) {
        visit([&]<class S, bool Signed, bool OwnErrors>(
                  const pencil::ElementPencil<S, Signed, OwnErrors>& pencil) {
            const ShapeRoot<T> x = root(j);
            const auto vector = pencil::eigenvector(pencil, static_cast<S>(x.exact));
            shapes.offset.row(j).tail(pins) = vector.offset.head(pins).transpose();
            if (details)
                shapes.residual[j] = pencil::relative_residual(pencil, x.rounded, vector.offset);
            complete(j, vector.crossings);
        });
    };
    if constexpr (std::is_same_v<T, double>)
        if (elements) {
            const FloatingPointStateGuard quiet;
            const bool lumped = pencil::is_lumped(*elements);
            const auto find = [&](std::size_t first, std::size_t there,
                                  pencil::ShapesInLanes<T>& found) {
                pencil::RootsInLanes<T> roots;
                for (std::size_t i = 0; i < pencil::shape_lanes; ++i) {
                    const ShapeRoot<T> x = root(static_cast<Index>(first + std::min(i, there - 1)));
                    roots.exact[i] = x.exact, roots.rounded[i] = x.rounded;
                }
                pencil::shapes_in_lanes(*elements, lumped, roots, details, found);
                found.store_rows(&shapes.offset(static_cast<Index>(first), idle.count),
                                 static_cast<std::size_t>(shapes.offset.cols()),
                                 static_cast<std::size_t>(pins), there);
                for (std::size_t i = 0; i < there; ++i) {
                    const auto j = static_cast<Index>(first + i);
                    if (!found.found[i]) {
                        alone(j);
                    } else if (details) {
                        shapes.residual[j] = found.residual[i];
                        complete(j, found.crossings(i, &shapes.offset(j, idle.count)));
                    } else {
                        complete(j, {});
                    }
                }
            };
            pencil::for_lanes<T>(static_cast<std::size_t>(count), elements->elements.size(), find);
            return shapes;
        }
    parallel_for(count, 1, [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j) alone(j);
    });
    return shapes;
}

/// Finds shapes of modes of a chain from heights in the units of its pencils.
template <Real T>
struct ShapeFinder {
    Chain<T> chain;
    Heights<T> height;
    /// True if T suffices. Shapes are then found at the rounded heights, else before rounding.
    bool loose = false;
    /// The pencils of the chain. If it is null, each call assembles them.
    std::shared_ptr<const Pencils<T>> kept{};

    /// Returns shapes of `count` modes from index `from` on; see `found_shapes`.
    ModeShapes<T> operator()(Index from, Index count, bool details, Progress* progress) const {
        if (count == 0) return room_for_shapes(chain, 0);
        std::optional<Pencils<T>> own;
        const Pencils<T>& pencils = kept ? *kept : own.emplace(chain);
        const auto root = [&](Index j) -> ShapeRoot<T> {
            const Height<T>& at = height[static_cast<std::size_t>(from + j)];
            return {loose ? Wide<T>(at.eigenvalue) : at.unrounded, at.eigenvalue};
        };
        const bool lanes = pencils.wide().units.empty() && chain.size() <= most_in_lanes;
        const auto visit = [&](const auto& f) {
            if (loose)
                f(pencils.rounded());
            else
                f(pencils.wide());
        };
        return found_shapes(chain, {}, count, details, root, lanes ? &pencils.wide() : nullptr,
                            visit, progress);
    }
};

/// Returns shapes that `find(first, count, details, progress)` computes on `threads` threads when
/// read.
template <Real T, class Find>
LazyModeShapes<T> shapes_when_read(Find find, Index threads) {
    return LazyModeShapes<T>([find = std::move(find), threads](Index first, Index count,
                                                               bool details, Progress* progress) {
        const Threads used("modes", threads);
        return find(first, count, details, progress);
    });
}

}  // namespace revchain::detail
