// SPDX-License-Identifier: MPL-2.0
#pragma once

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
