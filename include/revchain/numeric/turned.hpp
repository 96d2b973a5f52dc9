// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <complex>

#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/double_double.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Returns exp(i angle) of a large angle, reduced in double-double.
REVCHAIN_LAZY
std::complex<double> turned(const DoubleDouble& angle) {
    const DoubleDouble turn(6.283185307179586, 2.4492935982947064e-16);
    const DoubleDouble rest = angle - turn * DoubleDouble(std::nearbyint((angle / turn).high()));
    const double c = std::cos(rest.high()), s = std::sin(rest.high());
    return {c - s * rest.low(), s + c * rest.low()};
}

}  // namespace revchain::detail
