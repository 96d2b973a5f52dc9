// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "revchain/models/model.hpp"
#include "revchain/numeric/bessel_ratio.hpp"
#include "revchain/numeric/compiled.hpp"

/// Heights of N equally long links, cut out of a cord with line density proportional to x^p. The
/// links are the cord held straight piece by piece, so that each height is below the cord's
/// (Rayleigh, Ritz):
///
///     cord/chain = 1 + c/N^2 (1 - d),   c = j^2 I/(24 J^2),
///     J = J_{p+1}(j),   I = int_0^j J_{p+2}(t)^2 dt/t,
///
/// j = j_{p,k}. c is (L^2/12) int S y''^2 / int S y'^2, S the tension; it is the error of linear
/// finite elements. d is of the next order, 1/N^2. If the density at the free end is not 0, it is
/// log N/N^2 (p = 0) or N^-(2+p) (p < 0). 0 <= d <= `next_order` is measured.
namespace revchain::inline REVCHAIN_BUILD::models::detail {

/// Returns c to about 13 digits, from the sum I = (J_n^2 + 2 (J_{n+1}^2 + J_{n+2}^2 + ...))/(2 n),
/// n = p + 2, by Miller's recurrence, which needs no scale. Cost: 3 ns for each of j - p + 9
/// cbrt(j) + 12 steps.
REVCHAIN_LAZY
double second_order(double exponent, double zero) {
    const double order = exponent + 1, step = 2 / zero;
    double above = 0, here = 1e-100, sum = 0;
    for (Index n = revchain::detail::steps_above(order, zero); n > 0; --n) {
        sum += (n > 1 ? 2 : 1) * here * here;
        const double below = (order + static_cast<double>(n)) * step * here - above;
        above = here, here = below;
    }
    return zero * zero / 48 * (sum / (order + 1) / here / here);
}

/// Returns a bound of d. `share` is the length of a link over the height. Measured: d is at most
/// 0.94 of the bound for exponents from -0.98 to 100 and N >= 2 k (tests/cpp/models/tapered.cpp).
REVCHAIN_LAZY
double next_order(double exponent, Index mode, double share) {
    const double u = std::min(share, 1.0), q = exponent + 1;
    const double end =
        exponent == 0 ? -std::log(u) : -std::expm1(exponent * std::log(u)) / exponent;
    const double thick = mode > 10 && exponent > 0 ? 0.13 * exponent / (exponent + 4) : 0;
    const double steep = mode == 1 ? 0.3 + 0.17 * end : 0.25 + 0.06 * end + thick;
    const double light = exponent >= 0 ? 1 : mode == 1 ? q * (2.25 - 1.25 * q) : q;
    const double x = light * share * share * steep;
    return std::min(1.0, 1.15 * x / (1 + x));
}

/// Returns the middle of the interval that contains the height, and half its width relative to the
/// middle. `cord` is the height of the cord to within `rounding`, `lost` is c/N^2 to 1e-9, `next` a
/// bound of d.
REVCHAIN_LAZY
BoundedHeight enclosed(double cord, double lost, double next, double rounding) {
    const double most = lost * (1 + 1e-9), least = lost * (1 - 1e-9) * (1 - next);
    const double middle = (most + least) / 2, half = (most - least) / 2;
    return {cord / (1 + middle), half / (1 + middle - half) + rounding};
}

}  // namespace revchain::models::detail
