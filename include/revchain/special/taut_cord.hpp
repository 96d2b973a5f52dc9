// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/special/tip_mass.hpp"

/// The uniform cord between two points of a vertical axis, pulled straight, at small amplitude. `lower` is the tension
/// at its lower end, as the length of cord that weighs as much. x is the distance from the lower end.
///
/// With z = 2 sqrt((lower + x)/lambda), z_0 at the lower end and z_L at the upper, the offset is a cylinder function of
/// order 0 of z, and the heights solve J_0(z_0) Y_0(z_L) = Y_0(z_0) J_0(z_L). With theta the phase of J_0 + iY_0 this
/// is
///     theta(z_L) - theta(z_0) = mode pi.
/// At a fixed z_0/z_L the left side rises from 0 to infinity, because M(z_L) < M(z_0) in z theta' = 2/(pi M^2). So
/// every mode has exactly one height. Far out it is that of a string under the mean tension.
/// Functions throw InvalidArgument for a mode or count below 1, a length that is not positive and finite, a tension
/// below 1e-20 lengths or above 1e250, and x outside [0, length].
namespace revchain::inline REVCHAIN_BUILD::analytic::taut_cord {

namespace detail {

using tip_mass::detail::Ends;
using tip_mass::detail::OrderZero;
using tip_mass::detail::phase_zero;
using tip_mass::detail::series;
using tip_mass::detail::ValueAndRate;
using namespace analytic::detail;

/// The lower end: J_0 and Y_0 at z_0.
struct LowerEnd {
    double z, rate;
    bool is_far;
    TwoDoubles J, Y;

    explicit LowerEnd(const TwoDoubles& place) : z(place.high), rate(0), is_far(z >= 30) {
        if (is_far) {
            rate = 1 / series(0).density(z);
        } else {
            const OrderZero at(place);
            J = at.J, Y = at.Y, rate = at.rate;
        }
    }
};

/// theta - theta(z_0) - i pi at z_0 + apart, and theta' there.
inline ValueAndRate excess(const LowerEnd& end, const TwoDoubles& place, const TwoDoubles& apart, Index i) {
    const double z = place.high, turns = static_cast<double>(i), pi = std::numbers::pi;
    if (end.is_far)
        return {(apart - two_word_pi * turns).high + (series(0).lag(end.z) - series(0).lag(z)),
                1 / series(0).density(z)};
    const OrderZero at(place);
    const TwoDoubles sine = end.J * at.Y - end.Y * at.J, cosine = end.J * at.J + end.Y * at.Y;
    const double value = std::atan(sine.high / cosine.high);
    const double rough = OrderZero::rough(z) - OrderZero::rough(end.z);
    return {value + pi * std::round((rough - value) / pi - turns), at.rate};
}

/// z_L - z_0 of a mode: below mode pi, as theta' > 1.
inline TwoDoubles apart(const Ends& ends, Index mode) {
    const double r = ends.ratio.high, g = ends.gap.high, high = static_cast<double>(mode) * std::numbers::pi;
    return phase_zero(0, high, high - 0.125 * std::min(1.0, g / r), [&](double at) {
        const TwoDoubles place = TwoDoubles(at) / ends.gap;
        const LowerEnd end(place * ends.ratio);
        const ValueAndRate e = excess(end, place, TwoDoubles(at), mode);
        if (!end.is_far) return ValueAndRate{e.value, (e.rate - r * end.rate) / g};
        // without cancellation
        const double upper = series(0).density_above_one(place.high), lower = series(0).density_above_one(end.z);
        return ValueAndRate{e.value, (lower - upper) / ((1 + upper) * (1 + lower)) / g + 1 / (1 + lower)};
    });
}

inline void check(std::string_view where, std::string_view name, Index number, double length, const TwoDoubles& lower) {
    analytic::detail::check(where, name, number, length);
    if (!(lower.high >= 1e-20 * length && lower.high / length <= 1e250))
        revchain::detail::throw_invalid(where, "lower must lie between 1e-20 and 1e250 lengths", lower.high);
}

}  // namespace detail

/// The conical height of a mode. Accuracy: 2 ulp (measured 1). Cost: 0.15 microseconds where z_0 > 30, 10 to 20 where
/// z_L < 45, else 5.
inline double conical_height(Index mode, double length, const detail::TwoDoubles& lower) {
    detail::check("analytic::taut_cord::conical_height", "mode", mode, length, lower);
    const detail::Ends ends(length, lower);
    return ends.height(detail::apart(ends, mode), length);
}

/// One mode of the cord. Cost: that of its height, and seven slopes.
class Mode {
   public:
    Mode(Index mode, double length, const detail::TwoDoubles& lower)
        : mode_((detail::check("analytic::taut_cord::Mode", "mode", mode, length, lower), mode)),
          length_(length),
          lower_(lower.high),
          ends_(length, lower),
          apart_(detail::apart(ends_, mode)),
          height_(ends_.height(apart_, length)),
          place_(apart_ / ends_.gap * ends_.ratio),
          end_(place_) {
        const double node = mode > 1 ? place_of(node_apart(1)) : length;
        largest_ = shape(vertical_points(Vector<double>::Zero(1), node)[0]);
    }

    double conical_height() const { return height_; }

    /// Offset at x: the largest, at the lowest vertical point, is 1.
    /// Accuracy: absolute error 6e-16 (1 + z_L - z_0). Cost: 0.1 microseconds where z_0 > 30, else 2.
    double shape(double x) const {
        const double w = apart_at(x, "analytic::taut_cord::Mode::shape"), z = end_.z + w;
        if (end_.is_far) return far_out(0, z) * std::sin(w - (lag(0, z) - lag(0, end_.z))) / largest_;
        const detail::OrderZero at(place_ + w);
        return (end_.J * at.Y - end_.Y * at.J).high * (z < 45 ? 1 : far_out(0, z)) / largest_;
    }

    /// dy/dx, positive at the lower end. Accuracy: as `shape`, times the largest slope.
    double slope(double x) const {
        const double w = apart_at(x, "analytic::taut_cord::Mode::slope"), z = end_.z + w;
        const double per = 2 / (z * height_) / largest_;
        if (end_.is_far) return per * far_out(1, z) * std::cos(w - (lag(1, z) - lag(0, end_.z)));
        if (z >= 45) {
            const double phase = ((place_ + w) - detail::two_word_pi * 0.75 - lag(1, z)).high;
            return per * far_out(1, z) * (end_.Y.high * std::cos(phase) - end_.J.high * std::sin(phase));
        }
        const detail::Cylinders f(place_ + w);
        return per * (end_.Y * f.J1 - end_.J * f.Y1).high;
    }

    /// (mode - 1) distances x where the cord crosses the axis between its ends, ascending. Accuracy: 1e-15 length.
    /// Cost:
    /// 0.2 to 20 microseconds each.
    Vector<double> nodes() const {
        Vector<double> points(mode_ - 1);
        for (Index i = 1; i < mode_; ++i) {
            revchain::detail::look();
            points[i - 1] = place_of(node_apart(i));
        }
        return points;
    }

    /// Distances x at which the cord is vertical, one below each node and one below the upper end. Accuracy: 1e-15
    /// length. Cost: seven slopes each.
    Vector<double> vertical_points() const {
        Vector<double> from(mode_);
        from << 0.0, nodes();
        return vertical_points(from, length_);
    }

   private:
    static double lag(int order, double z) { return detail::series(order).lag(z); }
    /// The modulus far out.
    double far_out(int order, double z) const {
        return std::sqrt(2 * detail::series(order).density(z) / (std::numbers::pi * z));
    }
    double apart_at(double x, std::string_view where) const {
        analytic::detail::check_place(where, x, length_);
        return apart_.high * ends_.part_apart(x / length_);
    }
    /// z - z_0 at node i.
    double node_apart(Index i) const {
        const double high = static_cast<double>(i) * std::numbers::pi;
        const double start = high - 0.125 * std::min(1.0, ends_.gap.high / ends_.ratio.high);
        const auto off = [&](double at) {
            return detail::excess(end_, place_ + at, detail::TwoDoubles(at), i);
        };
        return detail::phase_zero(0, high, start, off).high;
    }
    double place_of(double apart) const {
        return length_ * (apart / apart_.high) * ((apart + 2 * end_.z) / (apart_.high + 2 * end_.z));
    }
    Vector<double> vertical_points(const Vector<double>& from, double end) const {
        return revchain::detail::zeros_between(from, end, [&](double x) {
            const double steep = -slope(x);
            return std::pair(steep, (shape(x) / height_ - steep) / (lower_ + x));
        });
    }

    Index mode_;
    double length_, lower_;
    detail::Ends ends_;
    detail::TwoDoubles apart_;  // z_L - z_0
    double height_, largest_ = 1;
    detail::TwoDoubles place_;  // z_0
    detail::LowerEnd end_;
};

}  // namespace revchain::analytic::taut_cord
