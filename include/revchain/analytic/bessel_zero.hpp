// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numbers>

#include "revchain/analytic/detail/bessel_recurrence.hpp"
#include "revchain/analytic/detail/gsl.hpp"
#include "revchain/core/status.hpp"
#include "revchain/core/zero_of_j0.hpp"

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
    if (k < 1) revchain::detail::refuse(place, "the zeros are numbered from 1", k);
}

}  // namespace detail

/// j_{0,k}: see core/zero_of_j0.hpp.
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

/// Positive zeros of J_order for real order > -1, by number from 1.
/// Far out the phase series is solved. Nearer: Segura's iteration (doi:10.1137/090747762), which stays between the
/// neighbouring zeros, in double from Debye's phase (order < 0, k = 1: Newton from Rayleigh's bound, which lies below
/// the zero, so that no step can pass it), then one Newton step in two doubles.
/// Accuracy: 0.51 ulp (ulp: 2^-52 relative) for orders from -0.999 to 100 and k up to 1e6, measured against 25 digits
/// and against the recurrence in two long doubles; the same step with GSL's J_order leaves 5.5 ulp, with
/// std::cyl_bessel_j 83, with the recurrence in double 1.2. Cost: 0.02 to 0.15 microseconds for zeros above max(30, 8
/// order), 1 to 10 below.
class ZerosOfJ {
   public:
    /// Throws InvalidArgument for an order not above -1 or not finite.
    explicit ZerosOfJ(double order);

    /// j_{order,k}. Throws InvalidArgument for k < 1.
    double operator()(Index k) const;

   private:
    double far_out(const detail::TwoDoubles& place) const;
    double start(Index k) const;

    double order_;
    detail::PhaseSeries far_;
};

/// j_{order,k}, the k-th positive zero of J_order. As `ZerosOfJ`, which is cheaper for several of one order.
inline double zero_of_j(double order, Index k) { return ZerosOfJ(order)(k); }

inline ZerosOfJ::ZerosOfJ(double order) : order_(order), far_(order) {
    if (!(order > -1 && std::isfinite(order)))
        revchain::detail::refuse("analytic::ZerosOfJ", "order must be above -1 and finite", order);
}

inline double ZerosOfJ::operator()(Index k) const {
    detail::require_order("analytic::ZerosOfJ", k);
    const detail::TwoDoubles turns = two_sum(static_cast<double>(k) - 0.25, 0.5 * order_);
    const detail::TwoDoubles place = turns * detail::two_word_pi;  // the zero itself but for the lag
    if (place.high >= detail::PhaseSeries::first(order_)) return far_out(place);
    const double z = start(k);
    const detail::TwoDoubles ratio = detail::bessel_ratio<detail::TwoDoubles>(order_, z);
    return z + ratio.high / (1 - order_ / z * ratio.high);
}

inline double ZerosOfJ::far_out(const detail::TwoDoubles& place) const {
    double z = place.high, moved = 0;
    for (int round = 0; round < 8; ++round) {
        const double lag = far_.lag(z);
        moved = place.low + lag;
        const double step = (z - place.high - moved) / (1 + lag / z);  // lag' is -lag/z but for a (order/z)^4
        z -= step;
        if (std::abs(step) <= 1e-16 * z) break;
    }
    return place.high + (place.low + far_.lag(z));
}

inline double ZerosOfJ::start(Index k) const {
    double z;
    if (order_ < 0 && k == 1) {  // sum over the zeros of j^-6, DLMF 10.21(vii): j < (...)^-1/6
        const double a = order_ + 1, x = std::cbrt(32 * a * a * a * (order_ + 2) * (order_ + 3));
        z = std::sqrt(x);
        for (int round = 0; round < 30; ++round) {
            const double step = 2 * z * detail::bessel_ratio<double>(order_, z);
            const double next = std::sqrt(z * z + step);
            if (!(next > z * (1 + 1e-13))) return next;
            z = next;
        }
        return z;
    }
    const double phase = (static_cast<double>(k) - 0.25) * std::numbers::pi;
    const double n2 = order_ * order_;
    z = phase + 0.5 * order_ * std::numbers::pi;  // at or beyond the zero of Debye's leading phase, which is convex
    double q = 0;
    const auto leading = [&] {
        q = std::sqrt((z - order_) * (z + order_));
        return q - order_ * std::acos(order_ / z);
    };
    for (int round = 0; round < 20; ++round) {
        const double step = (leading() - phase) * z / q;
        z -= step;
        if (std::abs(step) <= 1e-3 * z / q) break;
    }
    const double off = leading() - (1 + 5 * n2 / (3 * q * q)) / (8 * q) - phase;
    z -= off * z / q;
    for (int round = 0; round < 8; ++round) {
        const double rate = std::sqrt(1 - (order_ - 0.5) / z * ((order_ + 0.5) / z));
        const double ratio = detail::bessel_ratio<double>(order_, z);
        const double step = std::atan(rate * ratio / ((order_ + 0.5) / z * ratio - 1)) / rate;
        z -= step;
        if (std::abs(step) <= 1e-5 * z) break;  // of fourth order
    }
    return z;
}

}  // namespace revchain::analytic
