// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/special/bessel_zero.hpp"
#include "revchain/special/chain_arguments.hpp"

/// The chain of Greenhill (1908) §4 with line density proportional to x^p, x the distance from the
/// free end, at small amplitude: (x^(p+1) y')' + (p+1) x^p y/lambda = 0, solved by z^-p J_p(z), z =
/// 2 sqrt((p+1) x/lambda). Exponent 0 is the uniform chain, and exponent 1 a chain that thickens
/// upwards. From 0 down to -1 the mass gathers at the free end. Functions throw as in
/// special/heavy_chain.hpp, and for an exponent not above -1 or above 1e4. Accuracies hold for
/// exponents from -0.99 to 100.
namespace revchain::inline REVCHAIN_BUILD::analytic::tapered_chain {
namespace detail {
inline Index check(std::string_view where, std::string_view name, Index number, double length,
                   double exponent) {
    analytic::detail::check(where, name, number, length);
    if (exponent > -1 && exponent <= 1e4) return number;
    revchain::detail::throw_invalid(where, "exponent must be above -1 and at most 1e4", exponent);
}

inline double height(double zero, double length, double exponent) {
    return (exponent + 1) * (length / (0.5 * zero) / (0.5 * zero));
}
}  // namespace detail

/// Conical heights 4 (p+1) length / j_{p,k}^2 of the `count` slowest modes, descending.
/// Accuracy: 3 ulp (measured 1.84). Cost: that of `ZerosOfJ`.
inline Vector<double> conical_heights(Index count, double length, double exponent) {
    detail::check("analytic::tapered_chain::conical_heights", "count", count, length, exponent);
    const ZerosOfJ zeros(exponent);
    const auto height = [&](Index k) { return detail::height(zeros(k), length, exponent); };
    return analytic::detail::for_numbers(count, height);
}

/// One mode. Cost: that of its zero, and 0.1 to 0.7 microseconds for each point.
class Mode {
   public:
    Mode(Index mode, double length, double exponent)
        : mode_(detail::check("analytic::tapered_chain::Mode", "mode", mode, length, exponent)),
          length_(length),
          exponent_(exponent),
          zeros_(exponent),
          end_(zeros_(mode)),
          offset_(exponent),
          next_(exponent + 1) {}

    double conical_height() const { return detail::height(end_, length_, exponent_); }

    /// Offset Gamma(p+1) (z/2)^-p J_p(z) at x, 1 at the free end.
    /// Accuracy: absolute error 4e-16 (1 + z) of the largest offset, not always 1 if p < -1/2.
    double shape(double x) const {
        return offset_(argument(x, "analytic::tapered_chain::Mode::shape"));
    }

    /// dy/dx: -Gamma(p+2) (z/2)^-(p+1) J_{p+1}(z) / lambda, -1/lambda at the free end.
    /// Accuracy: absolute error 4e-16 (1 + z) of the largest slope.
    double slope(double x) const {
        return -next_(argument(x, "analytic::tapered_chain::Mode::slope")) / conical_height();
    }

    /// Distances x at which the chain crosses the axis, ascending, without the support:
    /// length (j_{p,i} / j_{p,mode})^2, i < mode. Accuracy: 3 ulp.
    Vector<double> nodes() const {
        return analytic::detail::places_of_zeros(mode_, length_, end_, zeros_);
    }

    /// Distances x above the free end at which the chain is vertical, ascending:
    /// length (j_{p+1,i} / j_{p,mode})^2, i < mode. Accuracy: 3 ulp.
    Vector<double> vertical_points() const {
        return analytic::detail::places_of_zeros(mode_, length_, end_, ZerosOfJ(exponent_ + 1));
    }

   private:
    double argument(double x, std::string_view where) const {
        analytic::detail::check_place(where, x, length_);
        return end_ * std::sqrt(x / length_);
    }

    Index mode_;
    double length_, exponent_;
    ZerosOfJ zeros_;
    double end_;
    analytic::detail::ScaledBessel offset_, next_;
};

}  // namespace revchain::analytic::tapered_chain
