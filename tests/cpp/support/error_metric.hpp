// SPDX-License-Identifier: MPL-2.0
// What "error" means in these tests: relative to the truth, in units of epsilon ("ulp"); 0 where both are 0 or equal
// infinities, infinite where one is NaN or only one is 0.
#pragma once

#include <cmath>
#include <limits>

namespace support {

template <class T, class Truth>
double error_in_ulp(const T& computed, const Truth& truth) {
    if (Truth(computed) == truth) return 0.0;
    if (!(computed == computed) || !(truth == truth) || truth == Truth(0))
        return std::numeric_limits<double>::infinity();
    const Truth relative = (Truth(computed) - truth) / truth;
    const double size = std::abs(static_cast<double>(relative));
    return size / static_cast<double>(std::numeric_limits<T>::epsilon());
}

}  // namespace support
