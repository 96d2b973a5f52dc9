// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/numeric/double_word.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// A plain sum, for scalars without words. The sums below have one word more than their terms.
template <class S>
struct CompensatedSum {
    S high{};

    void add(const S& x) { high = high + x; }
    S value() const { return high; }
};

/// A sum of n double words in three words. Error: one rounding, and (2 n u)^3/2 of the terms'
/// sizes.
template <std::floating_point T>
struct CompensatedSum<DoubleWord<T>> {
    T high{}, middle{}, low{};

    void add(const DoubleWord<T>& x) {
        const DoubleWord<T> first = two_sum(high, x.high), second = two_sum(middle, x.low);
        const DoubleWord<T> both = two_sum(first.low, second.high);
        high = first.high;
        middle = both.high;
        low += both.low + second.low;
    }
    DoubleWord<T> value() const { return two_sum(high, middle) + DoubleWord<T>(low); }
};

/// A sum of numbers, or of packs lane by lane, in two words. The second word sums the rounding
/// errors of the first. The relative error for n terms of one sign is u + (n u)^2, u = epsilon/2.
template <Word V>
struct CompensatedSum<V> {
    V high{}, low{};

    [[gnu::always_inline]] void add(const V& x) {
        const DoubleWord<V> total = two_sum(high, x);
        high = total.high;
        low += total.low;
    }
    /// Adds x if |x| <= |high|, or if x is the first number.
    [[gnu::always_inline]] void add_smaller(const V& x) {
        const DoubleWord<V> total = fast_two_sum(high, x);
        high = total.high;
        low += total.low;
    }
    [[gnu::always_inline]] void add(const CompensatedSum& x) {
        add(x.high);
        low += x.low;
    }
    /// Multiplies the sum by a number; exact for powers of two.
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
