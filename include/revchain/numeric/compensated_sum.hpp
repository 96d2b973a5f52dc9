// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/numeric/double_word.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// Sum of numbers, or of packs lane by lane, in two words: the second is the sum of the rounding errors of the first.
/// Relative error of n terms of one sign: u + (n u)^2, u = epsilon/2.
template <Word V>
struct CompensatedSum {
    V high{}, low{};

    [[gnu::always_inline]] void add(const V& x) {
        const DoubleWord<V> total = two_sum(high, x);
        high = total.high;
        low += total.low;
    }
    /// Adds x where |x| <= |high|, or where it is the first number.
    [[gnu::always_inline]] void add_smaller(const V& x) {
        const DoubleWord<V> total = fast_two_sum(high, x);
        high = total.high;
        low += total.low;
    }
    [[gnu::always_inline]] void add(const CompensatedSum& x) {
        add(x.high);
        low += x.low;
    }
    /// Exact for powers of two.
    [[gnu::always_inline]] void scale(const V& by) {
        high *= by;
        low *= by;
    }
    [[gnu::always_inline]] void normalise() {
        const DoubleWord<V> total = fast_two_sum(high, low);
        high = total.high;
        low = total.low;
    }
    [[gnu::always_inline]] V value() const { return high + low; }
};

}  // namespace revchain
