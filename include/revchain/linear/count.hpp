// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>
#include <memory>
#include <string_view>

#include "revchain/count.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {

/// Returns the number of roots above x, by the proved counts `count(x)`. A root within 2^20
/// roundings of x may count as equal to it. Throws InvalidArgument if the number is not proved;
/// `place` and `value` are for the message.
template <Real S, class T, class Count>
Index number_above(S x, std::string_view place, const T& value, const Count& count) {
    if (const pencil::CertifiedCount found = count(x); found.proved) return found.above;
    x = x + x * S(operation_error<S>() * Narrow<S>(1 << 20));
    if (const pencil::CertifiedCount found = count(x); found.proved) return found.above;
    throw_invalid(place,
                  "rounding leaves in doubt how many modes of this system are slower; use one a "
                  "little beside it",
                  value);
}

}  // namespace detail

template <Real T>
Index ModeCounter<T>::above(const Wide<T>& height, const T& rough, std::string_view given,
                            const T& value) const {
    using std::ldexp;
    const T scaled = pencils_.scaled(rough);
    using limits = std::numeric_limits<T>;
    if (!(scaled < ldexp(T(1), limits::max_exponent - limits::digits))) return 0;
    if (scaled < ldexp(T(1), limits::min_exponent + limits::digits)) return mode_count_;
    return detail::number_above(pencils_.scaled(height), given, value, [&](const Wide<T>& x) {
        return pencils_.template certified_count<1>({x})[0];
    });
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
    /// The pencils, if they are assembled and small enough to be kept with a result (70 kB); else
    /// null.
    std::shared_ptr<const Pencils<T>> kept_pencils() const {
        constexpr Index most_links = 512;
        if (!counter_ || chain_.size() > most_links) return nullptr;
        return {counter_, &counter_->pencils_};
    }

   private:
    const Chain<T>& chain_;
    std::shared_ptr<const ModeCounter<T>> counter_;
};

}  // namespace detail
}  // namespace revchain
