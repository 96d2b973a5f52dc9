// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD::analytic::detail {

/// Returns the mode or count called `name`. Throws InvalidArgument unless it is at least 1 and the
/// length positive and finite.
inline Index check(std::string_view where, std::string_view name, Index number, double length) {
    if (number < 1)
        revchain::detail::throw_invalid(where, std::string(name) + " must be at least 1", number);
    revchain::detail::require_positive(where, "length", length);
    return number;
}

/// Throws InvalidArgument unless 0 <= x <= length.
inline void check_place(std::string_view where, double x, double length) {
    if (!(x >= 0 && x <= length))
        revchain::detail::throw_invalid(where, "x must lie between 0 (free end) and the length", x);
}

/// f(1) ... f(count).
template <class F>
Vector<double> for_numbers(Index count, const F& f) {
    return Vector<double>::NullaryExpr(count, [&](Index i) {
        revchain::detail::check_interrupt();
        return f(i + 1);
    });
}

/// The points length (zero(i) / end)^2, i < mode, at which mode `mode` has the zeros of a Bessel
/// function; `end` is its argument at the support.
template <class Zero>
Vector<double> places_of_zeros(Index mode, double length, double end, const Zero& zero) {
    return for_numbers(mode - 1, [&](Index i) {
        const double ratio = zero(i) / end;
        return length * (ratio * ratio);
    });
}

}  // namespace revchain::analytic::detail
