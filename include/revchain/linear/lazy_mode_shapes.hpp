// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain {

template <Real T>
struct ModeShapes;  // revchain/modes.hpp

namespace detail {

/// The shapes of a result, computed when they are first asked for and kept. Copies share them; threads may, too.
template <Real T>
class LazyModeShapes {
   public:
    LazyModeShapes() = default;
    /// `find(first, count, progress)` returns the shapes of `count` modes; the first has index `first` in the result.
    template <class Find>
    explicit LazyModeShapes(Find find) : state_(std::make_shared<FoundBy<Find>>(std::move(find))) {}
    explicit LazyModeShapes(ModeShapes<T> known) : state_(std::make_shared<State>()) {
        state_->known = std::move(known);
    }

    const ModeShapes<T>& all(Index count, Progress* progress) const {
        if (!state_ && count == 0) {
            static const ModeShapes<T> none;
            return none;
        }
        const std::scoped_lock lock(state().mutex);
        if (!state_->known) state_->known = state_->find(0, count, progress);
        return *state_->known;
    }
    Vector<T> one(Index count, Index j) const {
        if (j < 0 || j >= count)
            throw_invalid("Modes::shape", "the index must be from 0 to " + std::to_string(count - 1), j);
        const std::scoped_lock lock(state().mutex);
        if (state_->known) return state_->known->offset.row(j).transpose();
        return state_->find(j, 1, nullptr).offset.row(0).transpose();
    }
    /// Returns the shapes of `count` modes, the first at index `first`, and does not keep them.
    ModeShapes<T> some(Index first, Index count, Progress* progress) const {
        return state().find(first, count, progress);
    }

   private:
    struct State {
        virtual ~State() = default;
        virtual ModeShapes<T> find(Index, Index, Progress*) const { return {}; }  // where they are known already
        std::optional<ModeShapes<T>> known;
        std::mutex mutex;
    };
    template <class Find>
    struct FoundBy final : State {
        explicit FoundBy(Find by) : found(std::move(by)) {}
        ModeShapes<T> find(Index first, Index count, Progress* progress) const override {
            return found(first, count, progress);
        }
        Find found;
    };
    State& state() const {
        if (!state_) throw_invalid("Modes", "shapes need modes that `modes` has found");
        return *state_;
    }
    std::shared_ptr<State> state_;
};

}  // namespace detail
}  // namespace revchain
