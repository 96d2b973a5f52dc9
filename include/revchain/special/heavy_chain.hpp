// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/conical_pendulum.hpp"
#include "revchain/special/bessel_zero.hpp"
#include "revchain/special/chain_arguments.hpp"

/// The uniform flexible chain hung from one end, at small amplitude: the limit of many links.
/// Greenhill (1908) §4. x is the distance from the FREE end. Functions throw InvalidArgument for a
/// mode or count below 1, a length or amplitude that is not positive and finite, and x outside
/// [0, length]. With a particle at the free end: tip_mass.hpp; of other density: tapered_chain.hpp.
namespace revchain::inline REVCHAIN_BUILD::analytic::heavy_chain {
namespace detail {
using namespace analytic::detail;

inline void check_place(std::string_view where, double x, Index mode, double length) {
    check(where, "mode", mode, length);
    analytic::detail::check_place(where, x, length);
}

inline double height(Index mode, double length) {
    const double half = 0.5 * zero_of_j0(mode);
    return length / (half * half);
}
}  // namespace detail

/// Conical heights lambda_k = 4 length / j_{0,k}^2 of the `count` slowest modes, descending.
/// §4 (9)-(10). Accuracy: 3 ulp (measured 2, k up to 1e6). Cost: 10 ns each.
inline Vector<double> conical_heights(Index count, double length) {
    detail::check("analytic::heavy_chain::conical_heights", "count", count, length);
    return detail::for_numbers(count, [=](Index mode) { return detail::height(mode, length); });
}

/// Offset J_0(2 sqrt(x / lambda_k)) at x, 1 at the free end. §4 (9).
/// Accuracy: absolute error 4e-16 (1 + j_{0,k}), the rounding of the argument.
inline double shape(double x, Index mode, double length) {
    detail::check_place("analytic::heavy_chain::shape", x, mode, length);
    return detail::gsl_value(gsl_sf_bessel_J0_e, zero_of_j0(mode) * std::sqrt(x / length));
}

/// dy/dx = -J_1(z) / sqrt(x lambda_k), z = 2 sqrt(x/lambda_k): -1/lambda_k at the free end.
/// §4 (9). Accuracy: absolute error 4e-16 (1 + j_{0,k}) / lambda_k.
inline double slope(double x, Index mode, double length) {
    detail::check_place("analytic::heavy_chain::slope", x, mode, length);
    const double half_end = 0.5 * zero_of_j0(mode), half = half_end * std::sqrt(x / length);
    const double part = half > 0 ? detail::gsl_value(gsl_sf_bessel_J1_e, 2 * half) / half : 1.0;
    return -part / (length / (half_end * half_end));
}

/// Tension at x, to first order in the offsets: the length of chain that hangs below. §4 (1).
inline double tension(double x, double length) {
    detail::check_place("analytic::heavy_chain::tension", x, 1, length);
    return x;
}

/// Energy of the steady whirl of a chain whose free end is `amplitude` off the axis, divided by the
/// chain's weight per length. To the second order in the amplitude it is (1/(2 lambda)) int y^2 dx
/// = amplitude^2 (j J_1(j))^2 / 8, j = j_{0,mode}. It does not depend on the chain's length, and is
/// half the angular momentum times the angular speed. Accuracy: 4e-16 (1 + j/4) relative. Derived
/// from §4 (4), (9).
inline double kinetic_energy(Index mode, double amplitude) {
    constexpr std::string_view where = "analytic::heavy_chain::kinetic_energy";
    detail::check(where, "mode", mode, 1.0);
    revchain::detail::require_positive(where, "amplitude", amplitude);
    const double j = zero_of_j0(mode);
    const double part = amplitude * (j * detail::gsl_value(gsl_sf_bessel_J1_e, j));
    return 0.125 * part * part;
}

/// (1/2) int x y'^2 dx in the same unit; equal to the kinetic energy.
inline double potential_energy(Index mode, double amplitude) {
    return kinetic_energy(mode, amplitude);
}

/// Distances x at which mode `mode` crosses the axis, without the support:
/// length (j_{0,i} / j_{0,mode})^2, i < mode. §4 (12). Accuracy: 5 ulp.
inline Vector<double> nodes(Index mode, double length) {
    detail::check("analytic::heavy_chain::nodes", "mode", mode, length);
    return detail::places_of_zeros(mode, length, zero_of_j0(mode), zero_of_j0);
}

/// Distances x at which mode `mode` is vertical, without the free end; the chain below has its
/// centre of gravity on the axis: length (j_{1,i} / j_{0,mode})^2, i < mode. §4 (13)-(14).
/// Accuracy: 5 ulp.
inline Vector<double> vertical_points(Index mode, double length) {
    detail::check("analytic::heavy_chain::vertical_points", "mode", mode, length);
    return detail::places_of_zeros(mode, length, zero_of_j0(mode), zero_of_j1);
}

/// R = N z / 2 revolutions per second for the `count` slowest modes, ascending: N is the speed of
/// the conical pendulum of the chain's length, z the zeros of J_0. §4 (11). Accuracy: 4 ulp.
inline Vector<double> revolutions_per_second(Index count, double length,
                                             double gravity = conical_pendulum::standard_gravity) {
    detail::check("analytic::heavy_chain::revolutions_per_second", "count", count, length);
    const double pendulum = conical_pendulum::revolutions_per_second(length, gravity);
    return detail::for_numbers(count,
                               [&](Index mode) { return 0.5 * pendulum * zero_of_j0(mode); });
}

}  // namespace revchain::analytic::heavy_chain
