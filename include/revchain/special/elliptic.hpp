// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "revchain/numeric/status.hpp"

/// Complete elliptic integrals of a modulus kappa. A modulus is stored together with the
/// complementary modulus kappa' = sqrt(1 - kappa^2), each accurate to its last digit. Near kappa =
/// 1 all results depend on kappa', which cannot be computed from kappa. GSL accepts kappa or
/// kappa^2 but no complementary modulus, and silently loses all accuracy there
/// (bench/elliptic.cpp).
namespace revchain::inline REVCHAIN_BUILD::analytic {
namespace detail {
using revchain::detail::require_finite, revchain::detail::require_positive;
using revchain::detail::throw_invalid;
}  // namespace detail

/// The modulus kappa and the complementary modulus kappa', both in [0, 1].
class EllipticModulus {
   public:
    static EllipticModulus of(double modulus) {
        check("modulus", modulus);
        return {modulus, std::sqrt((1 - modulus) * (1 + modulus))};
    }
    static EllipticModulus of_complement(double complementary_modulus) {
        check("complementary modulus", complementary_modulus);
        return of(complementary_modulus).swapped();
    }
    /// Returns the modulus with kappa : kappa' = opposite : adjacent. Throws InvalidArgument unless
    /// both are finite and at least 0, and one is positive.
    static EllipticModulus of_ratio(double opposite, double adjacent) {
        const auto is_side = [](double x) { return x >= 0 && std::isfinite(x); };
        if (!(is_side(opposite) && is_side(adjacent) && opposite + adjacent > 0))
            detail::throw_invalid("analytic::EllipticModulus",
                                  "the sides must be finite, not negative and not both 0",
                                  is_side(opposite) ? adjacent : opposite);
        double whole = std::hypot(opposite, adjacent);
        // in another unit if the hypotenuse overflows or has few digits
        if (!std::isfinite(whole) || whole < 0x1p-960) {
            const double unit = whole < 1 ? 0x1p512 : 0x1p-512;
            opposite *= unit, adjacent *= unit;
            whole = std::hypot(opposite, adjacent);
        }
        return {opposite / whole, adjacent / whole};
    }
    double modulus() const { return modulus_; }
    double complementary_modulus() const { return complementary_; }
    /// Returns the modulus kappa', whose complementary modulus is kappa.
    EllipticModulus swapped() const { return {complementary_, modulus_}; }

   private:
    EllipticModulus(double modulus, double complementary)
        : modulus_(modulus), complementary_(complementary) {}
    static void check(std::string_view name, double value) {
        if (!(value >= 0 && value <= 1))
            detail::throw_invalid("analytic::EllipticModulus",
                                  std::string(name) + " must lie between 0 and 1", value);
    }
    double modulus_, complementary_;
};

namespace detail {

/// Returns the integral of
///
///     (a cos^2 + b sin^2) / ((cos^2 + p sin^2) sqrt(cos^2 + kappa'^2 sin^2))
///
/// over a quarter turn, for kappa' > 0, p > 0 and any weights a and b of cos^2 and sin^2. It is
/// accurate for a, b >= 0, where all terms have one sign, so that none cancel. Method: Bulirsch,
/// doi:10.1007/BF02165405. The two means are not halved: both grow by a factor of 2 a round.
inline double complete_integral(double kappa_prime, double p, double a, double b) {
    double arithmetic = 1, geometric = kappa_prime, product = kappa_prime;
    p = std::sqrt(p);
    b /= p;
    for (int i = 0; i < 64; ++i) {  // 14 rounds for kappa' = 1e-300
        const double a_before = a, before = arithmetic;
        a += b / p;
        const double ratio = product / p;
        b = 2 * std::fma(a_before, ratio, b);
        p += ratio;
        arithmetic += geometric;
        if (std::abs(before - geometric) <= before * 1e-8) break;
        geometric = 2 * std::sqrt(product);
        product = geometric * arithmetic;
    }
    return 0.5 * std::numbers::pi * (std::fma(a, arithmetic, b) / (arithmetic * (arithmetic + p)));
}

}  // namespace detail

/// Integrals over a quarter turn with Delta = sqrt(cos^2 + kappa'^2 sin^2): K of 1/Delta, E of
/// Delta, D = (K - E)/kappa^2 of sin^2/Delta, B = K - D of cos^2/Delta. DLMF 19.2.8.
struct CompleteIntegrals {
    double K, E, D, B;
};

/// Returns the four integrals. Accuracy: 1.5e-15 relative. K and D are infinite for kappa' = 0.
/// Cost: 0.1 microseconds.
inline CompleteIntegrals complete_integrals(const EllipticModulus& modulus) {
    const double c = modulus.complementary_modulus();
    if (c == 0) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        return {infinity, 1, infinity, 1};
    }
    return {detail::complete_integral(c, 1, 1, 1), detail::complete_integral(c, 1, 1, c * c),
            detail::complete_integral(c, 1, 0, 1), detail::complete_integral(c, 1, 1, 0)};
}

}  // namespace revchain::analytic
