// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/special/tip_mass.hpp"

/// The uniform cord between two points of a vertical axis, pulled straight, at small amplitude.
/// `lower` is the tension at its lower end, as the length of cord that weighs as much. x is the
/// distance from the lower end.
///
/// With z = 2 sqrt((lower + x)/lambda) as in special/tip_mass.hpp, the heights solve
/// J_0(z_0) Y_0(z_L) = Y_0(z_0) J_0(z_L), or with theta the phase of J_0 + iY_0
///     theta(z_L) - theta(z_0) = mode pi.
/// Every mode has one height, because M(z_L) < M(z_0) in z theta' = 2/(pi M^2). For large z it is
/// nearly the height of a string under the mean tension. Functions throw as in
/// special/heavy_chain.hpp, and for a tension below 1e-20 lengths or above 1e250.
namespace revchain::inline REVCHAIN_BUILD::analytic::taut_cord {
namespace detail {

using namespace tip_mass::detail;

inline Index check(std::string_view where, Index mode, double length, const TwoDoubles& lower) {
    analytic::detail::check(where, "mode", mode, length);
    if (lower.high >= 1e-20 * length && lower.high / length <= 1e250) return mode;
    revchain::detail::throw_invalid(where, "lower must lie between 1e-20 and 1e250 lengths",
                                    lower.high);
}

}  // namespace detail

/// The conical height of a mode. Accuracy: 2 ulp (measured 1). Cost: 0.15 microseconds where
/// z_0 > 30, 10 to 20 where z_L < 45, else 5.
inline double conical_height(Index mode, double length, const detail::TwoDoubles& lower) {
    detail::check("analytic::taut_cord::conical_height", mode, length, lower);
    const detail::Ends ends(length, lower);
    return ends.height(ends.apart(0, mode), length);
}

/// One mode of the cord. Cost: that of its height, and seven slopes.
class Mode : private detail::EitherMode {
   public:
    Mode(Index mode, double length, const detail::TwoDoubles& lower)
        : EitherMode(0, detail::check("analytic::taut_cord::Mode", mode, length, lower), length,
                     lower) {
        const double node = mode > 1 ? place_of(node_apart(1)) : length;
        largest_ = shape(vertical_points(Vector<double>::Zero(1), node)[0]);
    }

    double conical_height() const { return height_; }

    /// Offset at x: the largest, at the lowest vertical point, is 1.
    /// Accuracy: absolute error 6e-16 (1 + z_L - z_0). Cost: 0.1 microseconds (z_0 > 30), else 2.
    double shape(double x) const {
        const double w = apart_at(x, "analytic::taut_cord::Mode::shape"), z = end_.z + w;
        if (end_.is_far())
            return far_out(0, z) * std::sin(w - (lag(0, z) - lag(0, end_.z))) / largest_;
        const detail::OrderZero at(place_ + w);
        return (end_.J * at.Y - end_.Y * at.J).high * (z < 45 ? 1 : far_out(0, z)) / largest_;
    }

    /// dy/dx, positive at the lower end. Accuracy: as `shape`, times the largest slope.
    double slope(double x) const {
        const double w = apart_at(x, "analytic::taut_cord::Mode::slope"), z = end_.z + w;
        const double per = 2 / (z * height_) / largest_;
        if (end_.is_far()) return per * far_out(1, z) * std::cos(w - (lag(1, z) - lag(0, end_.z)));
        if (z >= 45) {
            const double phase = ((place_ + w) - detail::two_word_pi * 0.75 - lag(1, z)).high;
            const double c = std::cos(phase), s = std::sin(phase);
            return per * far_out(1, z) * (end_.Y.high * c - end_.J.high * s);
        }
        const detail::Cylinders f(place_ + w);
        return per * (end_.Y * f.J1 - end_.J * f.Y1).high;
    }

    /// (mode - 1) distances x where the cord crosses the axis between its ends, ascending.
    /// Accuracy: 1e-15 length. Cost: 0.2 to 20 microseconds each.
    Vector<double> nodes() const {
        return detail::for_numbers(mode_ - 1, [&](Index i) { return place_of(node_apart(i)); });
    }

    /// Distances x at which the cord is vertical, one below each node and one below the upper end.
    /// Accuracy: 1e-15 length. Cost: seven slopes each.
    Vector<double> vertical_points() const {
        Vector<double> from(mode_);
        from << 0.0, nodes();
        return vertical_points(from, length_);
    }

   private:
    /// The modulus far out.
    double far_out(int order, double z) const {
        return std::sqrt(2 * density(order, z) / (std::numbers::pi * z));
    }
    /// z - z_0 at node i.
    double node_apart(Index i) const {
        const double high = static_cast<double>(i) * std::numbers::pi;
        const double start = high - 0.125 * std::min(1.0, ends_.gap.high / ends_.ratio.high);
        return node_apart_from(i, high, start);
    }
    Vector<double> vertical_points(const Vector<double>& from, double end) const {
        return revchain::detail::zeros_between(from, end, [&](double x) {
            const double steep = -slope(x);
            return std::pair(steep, (shape(x) / height_ - steep) / (lower_ + x));
        });
    }

    double largest_ = 1;
};

}  // namespace revchain::analytic::taut_cord
