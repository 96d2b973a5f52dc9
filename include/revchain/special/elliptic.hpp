// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "revchain/numeric/status.hpp"

/// Elliptic integrals and functions of a modulus kappa and its complement kappa' =
/// sqrt(1 - kappa^2), each accurate to its last digit. Near kappa = 1 all results depend on kappa',
/// which cannot be computed from kappa. GSL takes kappa^2 only and silently loses all accuracy
/// there (bench/elliptic.cpp).
namespace revchain::inline REVCHAIN_BUILD::analytic {
namespace detail {
using revchain::detail::require_finite, revchain::detail::require_positive;
using revchain::detail::throw_invalid;
}  // namespace detail

/// kappa and kappa', both in [0, 1].
class EllipticModulus {
   public:
    static EllipticModulus of(double modulus) {
        check("modulus", modulus);
        return {modulus, std::sqrt((1 - modulus) * (1 + modulus))};
    }
    static EllipticModulus of_complement(double complementary_modulus) {
        check("complementary modulus", complementary_modulus);
        return of(complementary_modulus).complement();
    }
    /// kappa : kappa' = opposite : adjacent, both at least 0 and not both 0.
    static EllipticModulus of_ratio(double opposite, double adjacent) {
        const double whole = std::hypot(opposite, adjacent);
        const auto is_side = [](double x) { return x >= 0 && std::isfinite(x); };
        if (!(is_side(opposite) && is_side(adjacent) && whole > 0 && std::isfinite(whole)))
            detail::throw_invalid("analytic::EllipticModulus",
                                  "the sides must not be negative, infinite or both 0",
                                  is_side(opposite) ? adjacent : opposite);
        return {opposite / whole, adjacent / whole};
    }
    double modulus() const { return modulus_; }
    double complementary_modulus() const { return complement_; }
    EllipticModulus complement() const { return {complement_, modulus_}; }

   private:
    EllipticModulus(double modulus, double complement)
        : modulus_(modulus), complement_(complement) {}
    static void check(std::string_view name, double value) {
        if (!(value >= 0 && value <= 1))
            detail::throw_invalid("analytic::EllipticModulus",
                                  std::string(name) + " must lie between 0 and 1", value);
    }
    double modulus_, complement_;
};

namespace detail {

/// Bulirsch's complete integral of
/// (a cos^2 + b sin^2) / ((cos^2 + p sin^2) sqrt(cos^2 + kappa'^2 sin^2)) over a quarter turn,
/// p > 0, kappa' > 0. doi:10.1007/BF02165405. For a, b >= 0 all terms have one sign.
inline double complete_integral(double complement, double p, double a, double b) {
    double e = complement, scale = 1;
    p = std::sqrt(p);
    b /= p;
    for (int round = 0; round < 64; ++round) {  // 14 rounds for kappa' = 1e-300
        const double before = a, mean = scale;
        a += b / p;
        const double ratio = e / p;
        b = 2 * std::fma(before, ratio, b);
        p += ratio;
        scale += complement;
        if (std::abs(mean - complement) <= mean * 1e-8) break;
        complement = 2 * std::sqrt(e);
        e = complement * scale;
    }
    return 0.5 * std::numbers::pi * (std::fma(a, scale, b) / (scale * (scale + p)));
}

}  // namespace detail

/// Integrals over a quarter turn with Delta = sqrt(cos^2 + kappa'^2 sin^2): K of 1/Delta, E of
/// Delta, D = (K - E)/kappa^2 of sin^2/Delta, B = K - D of cos^2/Delta. DLMF 19.2.8
struct CompleteIntegrals {
    double K, E, D, B;
};

/// The four integrals. Accuracy: 1.5e-15 relative. K and D are infinite for kappa' = 0.
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
