// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "revchain/numeric/double_double.hpp"
#include "revchain/special/jacobi.hpp"

namespace revchain::inline REVCHAIN_BUILD::analytic {
namespace detail {

/// Duplication stops where the differences over the mean are at most this. The series omit its
/// sixth power.
inline constexpr double carlson_spread = 2e-3;

/// Carlson's R_F(x, y, z) = 1/2 int_0^inf dt / sqrt((t + x)(t + y)(t + z)); at most one of x, y, z
/// is 0. doi:10.1007/BF02198293; DLMF 19.36.1.
inline double carlson_rf(double x, double y, double z) {
    double mean = (x + y + z) / 3, shrunk = 1;
    const double dx = mean - x, dy = mean - y;
    const double spread = std::max({std::abs(dx), std::abs(dy), std::abs(mean - z)});
    while (shrunk * spread > carlson_spread * mean) {
        const double a = std::sqrt(x), b = std::sqrt(y), c = std::sqrt(z),
                     lambda = a * b + c * (a + b);
        for (double* each : {&x, &y, &z, &mean}) *each = 0.25 * (*each + lambda);
        shrunk *= 0.25;
    }
    const double X = dx * shrunk / mean, Y = dy * shrunk / mean, Z = -(X + Y);
    const double e2 = X * Y - Z * Z, e3 = X * Y * Z;
    return (1 + e2 * (e2 / 24 - 0.1 - 3 * e3 / 44) + e3 / 14) / std::sqrt(mean);
}

/// arctan(sqrt e) / sqrt e, continued to e > -1; `rest` is 1 + e, accurate to its last digit.
inline double arctangent_ratio(double e, double rest) {
    if (std::abs(e) < 1e-5) return 1 + e * (e * (0.2 - e / 7) - 1.0 / 3);
    const double root = std::sqrt(std::abs(e));
    if (e < -0.5) return (std::log1p(root) - 0.5 * std::log(rest)) / root;
    return (e > 0 ? std::atan(root) : std::atanh(root)) / root;
}

/// Carlson's R_J(x, y, z, p) = 3/2 int_0^inf dt / ((t + p) sqrt((t + x)(t + y)(t + z))), p > 0; at
/// most one of x, y, z is 0. R_D(x, y, z) = R_J(x, y, z, z). Method as `carlson_rf`; DLMF 19.36.2.
inline double carlson_rj(double x, double y, double z, double p) {
    double mean = (x + y + z + 2 * p) / 5, shrunk = 1, sum = 0;
    const double dx = mean - x, dy = mean - y, dz = mean - z;
    const double spread = std::max({std::abs(dx), std::abs(dy), std::abs(dz), std::abs(mean - p)});
    double delta = (p - x) * (p - y) * (p - z);
    while (shrunk * spread > carlson_spread * mean) {
        const double a = std::sqrt(x), b = std::sqrt(y), c = std::sqrt(z), q = std::sqrt(p);
        const double lambda = a * b + c * (a + b), d = (q + a) * (q + b) * (q + c);
        // (q + a)(q + b)(q + c) + (q - a)(q - b)(q - c) = 2 q (p + lambda)
        sum += shrunk / d * arctangent_ratio(delta / d / d, 2 * q / d * (p + lambda));
        for (double* each : {&x, &y, &z, &p, &mean}) *each = 0.25 * (*each + lambda);
        shrunk *= 0.25, delta *= 1.0 / 64;
    }
    const double X = dx * shrunk / mean, Y = dy * shrunk / mean, Z = dz * shrunk / mean,
                 P = -0.5 * (X + Y + Z);
    const double xyz = X * Y * Z, e2 = X * Y + Z * (X + Y) - 3 * P * P,
                 e3 = xyz + 2 * P * (e2 + 2 * P * P);
    const double e4 = (2 * xyz + P * (e2 + 3 * P * P)) * P, e5 = xyz * P * P;
    return 6 * sum + shrunk / (mean * std::sqrt(mean)) *
                         (1 + e2 * (9 * e2 / 88 - 3.0 / 14 - 9 * e3 / 52) + e3 / 6 - 3 * e4 / 22 +
                          3 * e5 / 26);
}

/// An amplitude as a number of half turns and an angle between -pi/2 and pi/2.
struct Amplitude {
    double sine, cosine, delta, half_turns;

    Amplitude(double angle, const EllipticModulus& modulus)
        : half_turns(std::nearbyint(angle / std::numbers::pi)) {
        // Two words, because the cosine is a difference near an odd number of quarter turns. Beyond
        // 2^60 half turns the rest is below the last digit of the amplitude.
        DoubleDouble within(0);
        if (std::abs(half_turns) < 0x1p60)
            within =
                DoubleDouble(angle) - DoubleDouble(half_turns) * std::numbers::pi_v<DoubleDouble>;
        const double s = std::sin(within.high()), c = std::cos(within.high());
        sine = s + within.low() * c, cosine = c - within.low() * s;
        delta = std::hypot(cosine, modulus.complementary_modulus() * sine);
        keep_within();
    }
    /// Near a quarter turn the sign of cn is right, but the rounded amplitude may have the wrong
    /// one.
    explicit Amplitude(const JacobiValues& f)
        : delta(f.dn), half_turns(std::nearbyint(f.amplitude / std::numbers::pi)) {
        const bool odd = std::fmod(half_turns, 2.0) != 0;
        sine = odd ? -f.sn : f.sn, cosine = odd ? -f.cn : f.cn;
        keep_within();
    }

   private:
    void keep_within() {
        if (cosine >= 0) return;
        half_turns += sine > 0 ? 1 : -1;
        sine = -sine, cosine = -cosine;
    }
};

}  // namespace detail

/// Legendre's integrals up to an amplitude: F, E and D = (F - E) / kappa^2. DLMF 19.2.4-6, 19.25.
struct IncompleteIntegrals {
    double F, E, D;
};

/// The three integrals. Accuracy: 2e-15 relative for the amplitude as given. Cost: 0.5
/// microseconds. For kappa = 1, F and D are infinite at a quarter turn and beyond. Throws
/// InvalidArgument unless the amplitude is finite.
inline IncompleteIntegrals incomplete_integrals(double amplitude, const EllipticModulus& modulus) {
    detail::require_finite("analytic::incomplete_integrals", "amplitude", amplitude);
    const detail::Amplitude a(amplitude, modulus);
    const double k2 = modulus.modulus() * modulus.modulus();
    const double c2 = modulus.complementary_modulus() * modulus.complementary_modulus();
    const double s = a.sine, x = a.cosine * a.cosine, y = a.delta * a.delta;
    IncompleteIntegrals result{s * detail::carlson_rf(x, y, 1), 0,
                               s * s * s * detail::carlson_rj(x, y, 1, 1) / 3};
    // not F - kappa^2 D, which is a difference of nearly equal numbers
    result.E = c2 * (result.F + k2 * s * s * s * detail::carlson_rj(x, 1, y, y) / 3) +
               k2 * s * a.cosine / a.delta;
    if (a.half_turns != 0) {
        const CompleteIntegrals whole = complete_integrals(modulus);
        const double quarters = 2 * a.half_turns;
        result.F += quarters * whole.K, result.E += quarters * whole.E,
            result.D += quarters * whole.D;
    }
    return result;
}

namespace detail {

inline void check_characteristic(std::string_view place, double n) {
    if (!(n < 1)) throw_invalid(place, "the characteristic must be less than 1", n);
}

inline double pi_of(double n, const Amplitude& a, const EllipticModulus& modulus) {
    const double s = a.sine, x = a.cosine * a.cosine, y = a.delta * a.delta,
                 F = s * carlson_rf(x, y, 1);
    const double c = modulus.complementary_modulus();
    const auto of_positive = [&](double characteristic, double rest) {
        return F + characteristic / 3 * (s * s * s) * carlson_rj(x, y, 1, x + rest * s * s);
    };
    double within;  // a quarter turn
    if (n >= 0) {
        within = of_positive(n, 1 - n);
    } else {  // DLMF 19.7.9: a characteristic between kappa^2 and 1, and no differences
        const double k2 = modulus.modulus() * modulus.modulus(), c2 = c * c;
        const double g = -n, share = g / (k2 + g), ratio = (k2 + g) / (1 + g);
        const double tangent = std::sqrt(g) * std::sqrt(ratio) * s * a.cosine / a.delta;
        within = share * c2 / (1 + g) * of_positive(ratio, c2 / (1 + g)) + k2 / (k2 + g) * F +
                 std::sqrt(share / (1 + g)) * std::atan(tangent);
    }
    return a.half_turns == 0 || c == 0
               ? within
               : within + 2 * a.half_turns * complete_integral(c, 1 - n, 1, 1);
}

}  // namespace detail

/// Pi(n, kappa) = int d phi / ((1 - n sin^2) Delta) over a quarter turn, n < 1 with the sign of
/// DLMF 19.2.7. Accuracy: 1.5e-15 relative for n as given. Infinite for kappa = 1.
inline double complete_pi(double n, const EllipticModulus& modulus) {
    detail::check_characteristic("analytic::complete_pi", n);
    const double c = modulus.complementary_modulus();
    return c == 0 ? std::numeric_limits<double>::infinity()
                  : detail::complete_integral(c, 1 - n, 1, 1);
}

/// The integral of the third kind up to an amplitude, or up to the amplitude of an argument u.
/// Accuracy: 3e-15 relative. Cost: 0.7 microseconds.
inline double incomplete_pi(double n, double amplitude, const EllipticModulus& modulus) {
    detail::check_characteristic("analytic::incomplete_pi", n);
    detail::require_finite("analytic::incomplete_pi", "amplitude", amplitude);
    return detail::pi_of(n, detail::Amplitude(amplitude, modulus), modulus);
}
inline double incomplete_pi(double n, const JacobiValues& u, const EllipticModulus& modulus) {
    detail::check_characteristic("analytic::incomplete_pi", n);
    return detail::pi_of(n, detail::Amplitude(u), modulus);
}

}  // namespace revchain::analytic
