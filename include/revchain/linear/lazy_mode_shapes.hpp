// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Shapes of k modes of a chain of N links, with or without residuals and nodes.
template <Real T>
struct ModeShapes {
    Table<T> offset;               ///< (k, N+1)
    Vector<T> residual;            ///< (k,), or empty
    std::vector<Vector<T>> nodes;  ///< k lists, or none
};

/// Shapes, residuals and nodes, computed at first use. Copies and threads share them.
template <Real T>
class LazyModeShapes {
   public:
    LazyModeShapes() = default;
    /// `find(first, count, details, progress)` returns the shapes of `count` modes; the first has
    /// index `first` in the result. Without `details` it may omit residuals and nodes.
    using Find =
        std::function<ModeShapes<T>(Index first, Index count, bool details, Progress* progress)>;
    explicit LazyModeShapes(Find find) : state_(std::make_shared<State>()) {
        state_->find = std::move(find);
    }
    explicit LazyModeShapes(ModeShapes<T> known) : state_(std::make_shared<State>()) {
        state_->find = [](Index, Index, bool, Progress*) { return ModeShapes<T>(); };
        state_->known = std::move(known);
        state_->has_offsets = state_->has_details = true;
    }

    const Table<T>& offsets(Index count, Progress* progress) const {
        return known(count, false, progress).offset;
    }
    const ModeShapes<T>& details(Index count, Progress* progress) const {
        return known(count, true, progress);
    }
    Vector<T> one(Index count, Index j) const {
        if (j < 0 || j >= count)
            throw_invalid("Modes::shape",
                          "the index must be from 0 to " + std::to_string(count - 1), j);
        const std::scoped_lock lock(state().mutex);
        if (state_->has_offsets) return state_->known.offset.row(j).transpose();
        return state_->find(j, 1, false, nullptr).offset.row(0).transpose();
    }
    /// Returns the shapes of `count` modes, the first at index `first`, and does not store them.
    ModeShapes<T> some(Index first, Index count, bool details, Progress* progress) const {
        return state().find(first, count, details, progress);
    }
    /// Returns an owner of everything that was returned by reference.
    std::shared_ptr<const void> owner() const { return state_; }

   private:
    struct State {
        Find find;
        ModeShapes<T> known;
        bool has_offsets = false, has_details = false;
        std::mutex mutex;
    };
    const ModeShapes<T>& known(Index count, bool details, Progress* progress) const {
        if (!state_ && count == 0) {
            static const ModeShapes<T> none;
            return none;
        }
        State& state = this->state();
        const std::scoped_lock lock(state.mutex);
        if (!(details ? state.has_details : state.has_offsets)) {
            ModeShapes<T> found = state.find(0, count, details, progress);
            state.has_details = details || found.residual.size() == count;
            // Known offsets are not replaced, because another thread may read them.
            if (!state.has_offsets) state.known.offset = std::move(found.offset);
            state.known.residual = std::move(found.residual),
            state.known.nodes = std::move(found.nodes);
            state.has_offsets = true;
        }
        return state.known;
    }
    State& state() const {
        if (!state_) throw_invalid("Modes", "shapes need modes that `modes` has found");
        return *state_;
    }
    std::shared_ptr<State> state_;
};

/// Gives access to the shapes behind the accessors of a result.
struct ShapesBehind {
    template <class Result>
    static auto& of(Result& result) {
        return result.lazy_shapes_;
    }
};

}  // namespace revchain::detail
