// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/core/double_word.hpp"

namespace revchain {

/// Sum of numbers, or of packs, in two words: what rounding takes from the first is added to the second. Relative error
/// of n terms of one sign: u + (n u)^2, u = epsilon/2.
template <Word V>
class CompensatedSum {
   public:
    [[gnu::always_inline]] void add(const V& x) {
        const DoubleWord<V> total = two_sum(sum_, x);
        sum_ = total.high;
        rest_ = rest_ + total.low;
    }
    /// Exact for powers of two.
    [[gnu::always_inline]] void scale(const V& by) {
        sum_ = sum_ * by;
        rest_ = rest_ * by;
    }
    [[gnu::always_inline]] V value() const { return sum_ + rest_; }

   private:
    V sum_{}, rest_{};
};

}  // namespace revchain
