// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>
#include <memory>

#include "revchain/count.hpp"

namespace revchain::inline REVCHAIN_BUILD {

template <Real T>
Index ModeCounter<T>::above(const Wide<T>& height, const T& rough) const {
    using std::ldexp;
    const T scaled = pencils_.scaled(rough);
    using limits = std::numeric_limits<T>;
    if (!(scaled < ldexp(T(1), limits::max_exponent - limits::digits))) return 0;
    if (scaled < ldexp(T(1), limits::min_exponent + limits::digits)) return mode_count_;
    const Wide<T> shift = pencils_.scaled(height);
    const auto sure = pencils_.template certified_count<1>({shift});
    if (sure[0].proved) return sure[0].above;
    const Wide<T> tie(operation_error<Wide<T>>() * Narrow<Wide<T>>(1 << 20));
    return pencil::certified_count<Wide<T>, 1>(pencils_.wide(), {shift + shift * tie})[0].above;
}

namespace detail {

/// The counter of a chain and its pencils, assembled at first use. The chain must outlive it.
template <Real T>
class LazyCounter {
   public:
    explicit LazyCounter(const Chain<T>& chain) : chain_(chain) {}
    const ModeCounter<T>& counter() {
        if (!counter_) counter_ = std::make_shared<const ModeCounter<T>>(chain_);
        return *counter_;
    }
    const Pencils<T>& pencils() { return counter().pencils_; }
    bool is_of(const Chain<T>& chain) const { return &chain == &chain_; }
    /// The pencils, if they are assembled and small enough to be kept with a result (0.6 MB); else
    /// null.
    std::shared_ptr<const Pencils<T>> kept_pencils() const {
        constexpr Index most_links = 4096;
        if (!counter_ || chain_.size() > most_links) return nullptr;
        return {counter_, &counter_->pencils_};
    }

   private:
    const Chain<T>& chain_;
    std::shared_ptr<const ModeCounter<T>> counter_;
};

}  // namespace detail
}  // namespace revchain
