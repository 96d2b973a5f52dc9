// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numbers>

#include "revchain/numeric/status.hpp"
#include "revchain/numeric/zero_of_j0.hpp"
#include "revchain/numeric/zeros_of_j.hpp"
#include "revchain/special/bessel_recurrence.hpp"
#include "revchain/special/gsl.hpp"

namespace revchain::analytic {

namespace detail {

/// McMahon's expansion of the k-th positive zero of J_order, four corrections: DLMF 10.21.19.
/// Relative error from k = 20 on: 0.14 ulp for order 0, 0.11 ulp for order 1, before rounding.
inline double mcmahon(int order, double k) {
    const double mu = 4.0 * order * order;
    // beta = (k + order/2 - 1/4) pi with pi in two words: the product alone would cost half an ulp more.
    const double turns = k + 0.5 * order - 0.25;
    const double high = turns * std::numbers::pi;
    const double low = std::fma(turns, std::numbers::pi, -high) + turns * two_word_pi.low;
    const double e = 1.0 / (8.0 * high);
    const double e2 = e * e;
    const double c1 = mu - 1.0;
    const double c3 = 4.0 * (mu - 1.0) * (7.0 * mu - 31.0) / 3.0;
    const double c5 = 32.0 * (mu - 1.0) * ((83.0 * mu - 982.0) * mu + 3779.0) / 15.0;
    const double c7 = 64.0 * (mu - 1.0) * (((6949.0 * mu - 153855.0) * mu + 1585743.0) * mu - 6277237.0) / 105.0;
    return high + (low - e * (c1 + e2 * (c3 + e2 * (c5 + e2 * c7))));
}

inline constexpr Index first_mcmahon = 20;

inline void require_order(std::string_view place, Index k) {
    if (k < 1) revchain::detail::throw_invalid(place, "the zeros are numbered from 1", k);
}

}  // namespace detail

/// j_{0,k}: see numeric/zero_of_j0.hpp.
using revchain::zero_of_j0;

/// j_{1,k}, the k-th positive zero of J_1, k >= 1. Greenhill (1908) §4 (13). Accuracy
/// and errors as `zero_of_j0`; GSL's own zeros are up to 15 ulp off and get one Newton step here.
inline double zero_of_j1(Index k) {
    detail::require_order("analytic::zero_of_j1", k);
    if (k >= detail::first_mcmahon) return detail::mcmahon(1, static_cast<double>(k));
    gsl_sf_result start{};
    gsl_sf_bessel_zero_J1_e(static_cast<unsigned>(k), &start);
    const double z = start.val;
    return z - detail::gsl_value(gsl_sf_bessel_J1_e, z) / detail::gsl_value(gsl_sf_bessel_J0_e, z);  // J_1' = J_0 there
}

/// j_{order,k} for real order > -1: see numeric/zeros_of_j.hpp.
using revchain::ZerosOfJ;

/// j_{order,k}, the k-th positive zero of J_order. As `ZerosOfJ`, which is cheaper for several of one order.
inline double zero_of_j(double order, Index k) { return ZerosOfJ(order)(k); }

}  // namespace revchain::analytic
