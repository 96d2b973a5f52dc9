// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/numeric/zero_of_j0.hpp"
#include "revchain/numeric/zeros_of_j.hpp"
#include "revchain/special/bessel_recurrence.hpp"
#include "revchain/special/gsl.hpp"

namespace revchain::inline REVCHAIN_BUILD::analytic {

using revchain::detail::zero_of_j0, revchain::detail::ZerosOfJ;

/// j_{1,k}, the k-th positive zero of J_1, k >= 1. Greenhill (1908) §4 (13). Accuracy and errors
/// as `zero_of_j0`. GSL's zeros have errors up to 15 ulp and get one Newton step here.
inline double zero_of_j1(Index k) {
    constexpr std::string_view where = "analytic::zero_of_j1";
    if (k < 1) revchain::detail::throw_invalid(where, "the zeros are numbered from 1", k);
    if (k >= 20) return revchain::detail::mcmahon(1, k);
    gsl_sf_result start{};
    gsl_sf_bessel_zero_J1_e(static_cast<unsigned>(k), &start);
    const double z = start.val;  // J_1' = J_0 there
    return z - detail::gsl_value(gsl_sf_bessel_J1_e, z) / detail::gsl_value(gsl_sf_bessel_J0_e, z);
}

/// j_{order,k}, the k-th positive zero of J_order, order > -1; for several, use `ZerosOfJ`.
inline double zero_of_j(double order, Index k) { return ZerosOfJ(order)(k); }

}  // namespace revchain::analytic
