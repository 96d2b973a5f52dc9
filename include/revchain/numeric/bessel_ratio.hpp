// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "revchain/numeric/bessel_phase.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// The number of orders above `order` at which Miller's recurrence begins; the error is 1e-20.
inline Index steps_above(double order, double z) {
    return static_cast<Index>(std::max(0.0, z - order) + 9 * std::cbrt(std::max(z, 1.0)) + 12);
}

/// Returns J_order(z) / J_{order+1}(z) by Miller's recurrence in S; order > -1, z >= 2e-8. Cost: 3
/// ns a step in double, 15 ns in two doubles; there are z - order + 9 cbrt(z) + 12 steps.
template <class S>
S bessel_ratio(double order, double z) {
    const S step = S(2.0) / S(z);
    S above(0.0), here(1e-100);
    for (Index n = steps_above(order, z); n > 0; --n) {
        const S below = (S(order) + S(static_cast<double>(n))) * step * here - above;
        above = here;
        here = below;
    }
    return here / above;
}

}  // namespace revchain::detail
