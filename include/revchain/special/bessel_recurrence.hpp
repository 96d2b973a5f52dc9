// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/numeric/bessel_ratio.hpp"

namespace revchain::inline REVCHAIN_BUILD::analytic::detail {

using revchain::detail::bessel_ratio, revchain::detail::PhaseSeries;
using revchain::detail::steps_above, revchain::detail::two_word_pi, revchain::detail::TwoDoubles;

/// Gamma(order+1) (z/2)^-order J_order(z), which is 1 at z = 0, for -1 < order <= 1e4, z >= 0.
/// Method: power series where it is short, phase and modulus for large z, else Miller's recurrence
/// with Neumann's sum for (z/2)^order. Accuracy: absolute error 2e-16 (1 + z) times the largest
/// value at z and beyond. Cost: 3 ns a step of `bessel_ratio`.
class ScaledBessel {
   public:
    explicit ScaledBessel(double order) : order_(order), far_(order) {}

    double operator()(double z) const {
        const double x = 0.25 * z * z;
        if (x <= order_ + 1) return by_power_series(x);
        return z >= PhaseSeries::first(order_) ? far_out(z) : by_recurrence(z);
    }

   private:
    double by_power_series(double x) const {
        double term = 1, total = 1;
        for (double m = 1; std::abs(term) > 1e-17 * std::abs(total) && m < 60; ++m)
            total += term *= -x / (m * (order_ + m));
        return total;
    }
    double by_recurrence(double z) const {
        // Neumann's sum cancels near order -1, so it is taken one order higher there.
        const double base = order_ < 0 ? order_ + 1 : order_, step = 2 / z;
        const auto more = static_cast<Index>(0.6 * std::min(base, z));
        const Index last = (steps_above(base, z) + more + 10) / 2 * 2;
        // weight of J_{base+2m}: (base+2m) (base+1)_{m-1} / m!, scaled
        double above = 0, here = 1e-100, weight = 1, total = here;
        for (Index n = last; n > 0; --n) {
            const double below = (base + static_cast<double>(n)) * step * here - above;
            above = here;
            here = below;
            if (n % 2 != 0) {
                const double m = 0.5 * static_cast<double>(n + 1);
                weight *= m / (base + 2 * m);
                if (m > 1) weight *= (base + 2 * m - 2) / (base + m - 1);
                total += weight * here;
            }
            // the quotient below keeps its value; orders of thousands would overflow
            if (std::abs(here) > 1e100) here *= 1e-100, above *= 1e-100, total *= 1e-100;
            if (weight < 1e-100) weight *= 1e100, total *= 1e100;
        }
        if (order_ < 0) here = (base * step * here - above) / (base * step);
        return here / total * weight;
    }
    double far_out(double z) const {
        const TwoDoubles phase = TwoDoubles(z) - two_word_pi * (0.5 * order_ + 0.25) - far_.lag(z);
        const double cosine = std::cos(phase.high) - phase.low * std::sin(phase.high);
        const double scale = order_ < 100
                                 ? std::tgamma(order_ + 1) / std::pow(0.5 * z, order_)
                                 : std::exp(std::lgamma(order_ + 1) - order_ * std::log(0.5 * z));
        return scale * std::sqrt(2 * far_.density(z) / (two_word_pi.high * z)) * cosine;
    }

    double order_;
    PhaseSeries far_;
};

/// ln x for x > 0: absolute error 1e-25.
inline TwoDoubles logarithm(const TwoDoubles& x) {
    constexpr TwoDoubles ln2{0.6931471805599453, 2.3190468138462996e-17};
    int exponent = 0;
    TwoDoubles m = frexp(x, &exponent);
    if (m.high < 0.7) m = ldexp(m, 1), --exponent;
    const TwoDoubles s = (m - 1.0) / (m + 1.0), s2 = s * s;
    TwoDoubles power = s, total = s;
    for (double n = 3; n < 33; n += 2) total = total + (power = power * s2) / TwoDoubles(n);
    return total * 2.0 + ln2 * static_cast<double>(exponent);
}

/// Bessel functions of both kinds of orders 0, 1, 2 in two doubles, 1e-5 <= z <= 45, by Miller's
/// recurrence and Neumann's series (DLMF 10.23.15). Absolute error 1e-20 of the modulus.
/// Cost: 1 to 2 microseconds.
struct Cylinders {
    TwoDoubles J0, J1, J2, Y0, Y1, Y2;

    explicit Cylinders(const TwoDoubles& z) {
        constexpr TwoDoubles euler{0.5772156649015329, -4.942915152430645e-18};
        const TwoDoubles step = TwoDoubles(2.0) / z;
        TwoDoubles above(0.0), here(1e-100), sum(0.0), sum0(0.0), sum1(0.0);
        Index n = static_cast<Index>(z.high + 11 * std::cbrt(std::max(z.high, 1.0)) + 22) / 4 * 4;
        for (; n > 0; --n) {  // here = J_n, above = J_{n+1}
            const TwoDoubles below = step * static_cast<double>(n) * here - above;
            if (n % 2 == 0) {
                sum = sum + here;
                const double two = n % 4 == 0 ? 2.0 : -2.0;
                const TwoDoubles part = TwoDoubles(two) / TwoDoubles(static_cast<double>(n));
                sum0 = sum0 + part * here;
                sum1 = sum1 + part * (below - above);
            }
            if (n == 2) J2 = here;
            if (n == 1) J1 = here;
            above = here;
            here = below;
        }
        const TwoDoubles scale = TwoDoubles(1.0) / (here + sum * 2.0);
        const TwoDoubles two_over_pi = TwoDoubles(2.0) / two_word_pi;
        J0 = here * scale, J1 = J1 * scale, J2 = J2 * scale;
        const TwoDoubles log = logarithm(ldexp(z, -1)) + euler;
        Y0 = two_over_pi * (log * J0 - sum0 * scale * 2.0);
        Y1 = two_over_pi * (log * J1 - J0 / z + sum1 * scale);
        Y2 = step * Y1 - Y0;
    }
};

}  // namespace revchain::analytic::detail
