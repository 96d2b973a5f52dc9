// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/special/bessel_zero.hpp"
#include "revchain/special/chain_arguments.hpp"

/// The uniform flexible chain hung from one end, at small amplitude: the limit of many links. Greenhill (1908) §4. x is
/// the distance from the FREE end. Functions throw InvalidArgument for a mode or count below 1, a length or amplitude
/// that is not positive and finite, and x outside [0, length]. With a particle at the free end: special/tip_mass.hpp;
/// of varying density: below.
namespace revchain::analytic::heavy_chain {

namespace detail {
inline void check(std::string_view place, std::string_view name, Index number, double length) {
    analytic::detail::check_number_and_length("analytic::heavy_chain::" + std::string(place), name, number, length);
}

inline void check_place(std::string_view place, double x, double length) {
    analytic::detail::check_place("analytic::heavy_chain::" + std::string(place), x, length);
}
}  // namespace detail

/// Conical heights lambda_k = 4 length / j_{0,k}^2 of the `count` slowest modes, descending. §4 (9)-(10).
/// Accuracy: 3 ulp (measured 2, k up to 1e6). Cost: 10 ns each.
inline Vector<double> conical_heights(Index count, double length) {
    detail::check("conical_heights", "count", count, length);
    Vector<double> heights(count);
    for (Index k = 1; k <= count; ++k) {
        revchain::detail::look();
        const double half = 0.5 * zero_of_j0(k);
        heights[k - 1] = length / (half * half);
    }
    return heights;
}

/// Offset J_0(2 sqrt(x / lambda_k)) at x, 1 at the free end. §4 (9).
/// Accuracy: absolute error 4e-16 (1 + j_{0,k}), the rounding of the argument.
inline double shape(double x, Index mode, double length) {
    detail::check("shape", "mode", mode, length);
    detail::check_place("shape", x, length);
    return analytic::detail::gsl_value(gsl_sf_bessel_J0_e, zero_of_j0(mode) * std::sqrt(x / length));
}

/// dy/dx = -J_1(z) / sqrt(x lambda_k), z = 2 sqrt(x/lambda_k), of that shape: -1/lambda_k at the free end. §4 (9).
/// Accuracy: absolute error 4e-16 (1 + j_{0,k}) / lambda_k.
inline double slope(double x, Index mode, double length) {
    detail::check("slope", "mode", mode, length);
    detail::check_place("slope", x, length);
    const double half_end = 0.5 * zero_of_j0(mode), half = half_end * std::sqrt(x / length);
    const double part = half > 0 ? analytic::detail::gsl_value(gsl_sf_bessel_J1_e, 2 * half) / half : 1.0;
    return -part / (length / (half_end * half_end));
}

/// Tension at x, to first order in the offsets: the length of chain that hangs below. §4 (1).
inline double tension(double x, double length) {
    detail::check("tension", "mode", 1, length);
    detail::check_place("tension", x, length);
    return x;
}

/// Energies of the steady whirl of the chain of any length whose free end is `amplitude` off the axis, to the second
/// order in it, over the chain's weight per length: kinetic (1/(2 lambda)) int y^2 dx and potential (1/2) int x y'^2
/// dx, both amplitude^2 (j J_1(j))^2 / 8, j = j_{0,mode}. (The chain's angular momentum times the angular speed is 2 of
/// either.) Accuracy: 4e-16 (1 + j/4) relative. Derived from §4 (4), (9): neither is in the paper.
inline double kinetic_energy(Index mode, double amplitude) {
    detail::check("kinetic_energy", "mode", mode, 1.0);
    revchain::detail::require_positive("analytic::heavy_chain::kinetic_energy", "amplitude", amplitude);
    const double j = zero_of_j0(mode), part = amplitude * (j * analytic::detail::gsl_value(gsl_sf_bessel_J1_e, j));
    return 0.125 * part * part;
}

/// The same number.
inline double potential_energy(Index mode, double amplitude) { return kinetic_energy(mode, amplitude); }

/// Where mode `mode` crosses the axis, the support left out: length (j_{0,i} / j_{0,mode})^2, i < mode. §4 (12).
/// Accuracy: 5 ulp.
inline Vector<double> nodes(Index mode, double length) {
    detail::check("nodes", "mode", mode, length);
    const double end = zero_of_j0(mode);
    Vector<double> points(mode - 1);
    for (Index i = 1; i < mode; ++i) {
        revchain::detail::look();
        const double ratio = zero_of_j0(i) / end;
        points[i - 1] = length * (ratio * ratio);
    }
    return points;
}

/// Where mode `mode` runs vertical, so that the chain below has its centre of gravity on the axis, the free end left
/// out: length (j_{1,i} / j_{0,mode})^2, i < mode. §4 (13)-(14). Accuracy: 5 ulp.
inline Vector<double> vertical_points(Index mode, double length) {
    detail::check("vertical_points", "mode", mode, length);
    const double end = zero_of_j0(mode);
    Vector<double> points(mode - 1);
    for (Index i = 1; i < mode; ++i) {
        revchain::detail::look();
        const double ratio = zero_of_j1(i) / end;
        points[i - 1] = length * (ratio * ratio);
    }
    return points;
}

/// R = N z / 2 revolutions per second for the `count` slowest modes, ascending: N is the speed of the conical pendulum
/// of the chain's own length, z the zeros of J_0. §4 (11). Accuracy: 4 ulp.
inline Vector<double> revolutions_per_second(Index count, double length,
                                             double gravity = conical_pendulum::standard_gravity) {
    detail::check("revolutions_per_second", "count", count, length);
    const double pendulum = conical_pendulum::revolutions_per_second(length, gravity);
    Vector<double> revolutions(count);
    for (Index k = 1; k <= count; ++k) revolutions[k - 1] = 0.5 * pendulum * zero_of_j0(k);
    return revolutions;
}

}  // namespace revchain::analytic::heavy_chain

/// The chain of Greenhill (1908) §4 with line density proportional to x^exponent, x the distance from the free end, at
/// small amplitude: (x^(p+1) y')' + (p+1) x^p y/lambda = 0, solved by z^-p J_p(z), z = 2 sqrt((p+1) x/lambda). Exponent
/// 0 is the uniform chain, 1 one that thickens upwards; from 0 down to -1 the mass gathers at the free end.
/// Functions throw InvalidArgument for a mode or count below 1, a length that is not positive and finite, an exponent
/// not above -1 or above 1e4, and x outside [0, length]. Accuracies hold for exponents from -0.99 to 100.
namespace revchain::analytic::tapered_chain {

namespace detail {
inline void check(std::string_view place, std::string_view name, Index number, double length, double exponent) {
    const std::string where = "analytic::tapered_chain::" + std::string(place);
    analytic::detail::check_number_and_length(where, name, number, length);
    if (!(exponent > -1 && exponent <= 1e4))
        revchain::detail::throw_invalid(where, "exponent must be above -1 and at most 1e4", exponent);
}

inline double height(double zero, double length, double exponent) {
    return (exponent + 1) * (length / (0.5 * zero) / (0.5 * zero));
}
}  // namespace detail

/// Conical heights 4 (p+1) length / j_{p,k}^2 of the `count` slowest modes, descending.
/// Accuracy: 3 ulp (measured 1.84). Cost: that of `ZerosOfJ`.
inline Vector<double> conical_heights(Index count, double length, double exponent) {
    detail::check("conical_heights", "count", count, length, exponent);
    const ZerosOfJ zeros(exponent);
    Vector<double> heights(count);
    for (Index k = 1; k <= count; ++k) {
        revchain::detail::look();
        heights[k - 1] = detail::height(zeros(k), length, exponent);
    }
    return heights;
}

/// One mode. Cost: that of its zero; of a place 0.1 to 0.7 microseconds.
class Mode {
   public:
    Mode(Index mode, double length, double exponent)
        : mode_((detail::check("Mode", "mode", mode, length, exponent), mode)),
          length_(length),
          exponent_(exponent),
          zeros_(exponent),
          end_(zeros_(mode)),
          offset_(exponent),
          next_(exponent + 1) {}

    double conical_height() const { return detail::height(end_, length_, exponent_); }

    /// Offset Gamma(p+1) (z/2)^-p J_p(z) at x, 1 at the free end.
    /// Accuracy: absolute error 4e-16 (1 + z) of the largest offset, which exceeds 1 for p < -1/2.
    double shape(double x) const { return offset_(place(x, "shape")); }

    /// dy/dx of that: -Gamma(p+2) (z/2)^-(p+1) J_{p+1}(z) / lambda, -1/lambda at the free end. Accuracy: the same.
    double slope(double x) const { return -next_(place(x, "slope")) / conical_height(); }

    /// Where the chain crosses the axis, ascending, the support left out: length (j_{p,i} / j_{p,mode})^2, i < mode.
    /// Accuracy: 3 ulp.
    Vector<double> nodes() const {
        Vector<double> points(mode_ - 1);
        for (Index i = 1; i < mode_; ++i) {
            revchain::detail::look();
            const double ratio = zeros_(i) / end_;
            points[i - 1] = length_ * (ratio * ratio);
        }
        return points;
    }

   private:
    double place(double x, std::string_view name) const {
        analytic::detail::check_place("analytic::tapered_chain::Mode::" + std::string(name), x, length_);
        return end_ * std::sqrt(x / length_);
    }

    Index mode_;
    double length_, exponent_;
    ZerosOfJ zeros_;
    double end_;
    analytic::detail::ScaledBessel offset_, next_;
};

}  // namespace revchain::analytic::tapered_chain

#include "revchain/special/tip_mass.hpp"  // IWYU pragma: export
