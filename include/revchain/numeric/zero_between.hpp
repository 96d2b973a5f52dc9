// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "revchain/numeric/progress.hpp"
#include "revchain/numeric/scalar.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// The zero of a function that grows through it once between `low` and `high`: Newton's method, held within the bracket
/// by halving. `value_and_slope(x)` returns a pair. It serves all scalars, unlike root finders of other libraries.
/// Cost: about ten evaluations, and one for each halving where Newton's method fails.
template <Real T, class F>
T zero_between(T low, T high, const F& value_and_slope) {
    constexpr int most = 2 * (std::numeric_limits<T>::max_exponent - std::numeric_limits<T>::min_exponent);
    using std::abs;
    T x = low + (high - low) / T(2), last = high - low;
    for (int round = 0; round < most; ++round) {
        const auto [value, slope] = value_and_slope(x);
        if (value == T(0)) return x;
        (value < T(0) ? low : high) = x;
        T next = x - value / slope;
        // Steps that do not shrink by half are no better than halving, and may creep.
        if (!(next > low && next < high) || abs(next - x) > last / T(2)) next = low + (high - low) / T(2);
        last = abs(next - x);
        if (last <= epsilon<T>() / T(2) * abs(next) || next == x || !(next > low && next < high)) return next;
        x = next;
    }
    return x;
}

/// A zero of a function without a slope, whose values `at_low` and `at_high` have different signs:
/// secants, the value at an end that stays halved (Illinois), and halving where three of them have
/// not halved the bracket. A `value(x)` of 0 ends it: what is near enough may be returned as 0.
/// The last x that `value` saw is within a rounding of the zero. Cost: 6 to 20 evaluations.
template <Real T, class F>
T zero_without_slope(T low, T high, T at_low, T at_high, const F& value) {
    constexpr int most = 400;
    using std::abs;
    if (at_low == T(0)) return low;
    if (at_high == T(0)) return high;
    T x = low, width = high - low;
    int stays = 0;  // the end that stayed in the last round, -1 or 1
    for (int round = 1; round < most; ++round) {
        T next = low - at_low * ((high - low) / (at_high - at_low));
        const bool slow = round % 3 == 0 && high - low > width / T(2);
        if (round % 3 == 0) width = high - low;
        if (slow || !(next >= low && next <= high)) next = low + (high - low) / T(2);
        // a rounding away from both ends, so that the zero is soon between two neighbours
        const T least = epsilon<T>() * abs(next);
        next = std::max(T(low + least), std::min(next, T(high - least)));
        if (!(next > low && next < high)) return x;
        x = next;
        const T here = value(x);
        if (here == T(0)) return x;
        if ((here < T(0)) == (at_low < T(0))) {
            low = x, at_low = here;
            if (stays == 1) at_high = at_high / T(2);
            stays = 1;
        } else {
            high = x, at_high = here;
            if (stays == -1) at_low = at_low / T(2);
            stays = -1;
        }
    }
    return x;
}

/// The zeros of a function that grows through one above the first, third, ... of `places` and falls through one above
/// the others, each below the next place or `end`.
template <class F>
Vector<double> zeros_between(const Vector<double>& places, double end, const F& value_and_slope) {
    Vector<double> zeros(places.size());
    for (Index i = 0; i < places.size(); ++i) {
        look();
        const double sign = i % 2 == 0 ? 1 : -1;
        zeros[i] = zero_between(places[i], i + 1 < places.size() ? places[i + 1] : end, [&](double x) {
            const auto [value, slope] = value_and_slope(x);
            return std::pair(sign * value, sign * slope);
        });
    }
    return zeros;
}

}  // namespace revchain::detail
