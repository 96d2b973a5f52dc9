// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "revchain/analytic/incomplete_elliptic.hpp"
#include "revchain/core/conical_pendulum.hpp"

/// The rope that whirls without gravity and winds round its axis, its ends off the axis: the third elliptic integral.
/// Greenhill (1908) §5, text after (6).
///
/// With R the square of the distance from the axis, R1 <= R <= R2, c^2 = lambda h and  r = sqrt(R1 R2 + 4 c^4),
///     R3 = R1 + R2 + 2 r,   d = sqrt(R3 - R1),   kappa^2 = (R2 - R1)/(R3 - R1),   u = d x / (2 c^2):
///     R = R1 cn^2 u + R2 sn^2 u,   arc = d E(am u) - (r/d) u,   theta = sqrt(R2 R3/R1)/d Pi(1 - R2/R1; am u).
namespace revchain::analytic {

/// What is given; positive, but for the least radius, which may be 0 (the plane rope) and at most the greatest (equal: a
/// helix).
struct TortuousGiven {
    double least_radius, greatest_radius;
    double angular_speed;                                 ///< n
    double tension;                                       ///< h: what pulls along the axis, as a length of rope
    double gravity = conical_pendulum::standard_gravity;  ///< relates n to lambda, nothing else
};

/// What there is at one place of the rope.
struct TortuousPoint {
    double x, arc;         ///< along the axis and along the rope, from where the rope is nearest to the axis
    double radius;         ///< distance from the axis
    double angle;          ///< round the axis, rad; of the plane rope -pi/2 and pi/2 on either side of x = 0
    double radius_slope;   ///< d radius / dx
    double angle_slope;    ///< d angle / dx
    double tension_ratio;  ///< of the tension to its part along the axis
};

/// Accuracy: 1e-14 relative each, of the angle 1e-14 (1 + |angle|). Cost: 2 microseconds, a point 1.
class TortuousRope {
   public:
    /// Throws InvalidArgument for numbers that are not as said above, or beyond what double holds.
    explicit TortuousRope(const TortuousGiven& given);

    double least_radius() const { return first_; }
    double greatest_radius() const { return second_; }
    double conical_height() const { return height_; }
    double height_times_tension() const { return strength2_; }
    EllipticModulus modulus() const { return functions_.modulus(); }

    /// From one place nearest to the axis to the next: along the axis, along the rope, how much longer that is, and the
    /// angle round the axis (pi for the plane rope, which crosses it).
    double half_wave() const { return 2 * functions_.complete().K * scale_; }
    double half_wave_slack() const;
    double half_wave_length() const { return half_wave() + half_wave_slack(); }
    double half_wave_angle() const;

    /// At any x, of either sign.
    TortuousPoint at(double x) const;

   private:
    /// Least and greatest radius so far apart that the angle is that of the plane rope to the last digit.
    bool is_plane() const { return first_ <= 1e-20 * second_; }

    double first_, second_, third_;  // square roots of R1, R2, R3
    double height_, strength2_;      // lambda, c^2
    double root_, d_, scale_;        // r; d; x = scale u
    JacobiFunctions functions_{EllipticModulus::of(0)};
};

inline TortuousRope::TortuousRope(const TortuousGiven& given)
    : first_(given.least_radius), second_(given.greatest_radius) {
    constexpr std::string_view place = "analytic::TortuousRope";
    if (!(first_ >= 0)) revchain::detail::refuse(place, "least radius must not be negative", first_);
    revchain::detail::require_positive(place, "greatest radius", second_);
    if (!(first_ <= second_)) revchain::detail::refuse(place, "least radius must not exceed the greatest", first_);
    revchain::detail::require_positive(place, "tension", given.tension);
    revchain::detail::require_positive(place, "angular speed", given.angular_speed);
    revchain::detail::require_positive(place, "gravity", given.gravity);
    height_ = conical_pendulum::height(given.angular_speed, given.gravity);
    strength2_ = height_ * given.tension;
    if (!(strength2_ >= std::numeric_limits<double>::min()))
        revchain::detail::refuse(place, "tension times gravity / angular speed^2 must be at least 2^-1022", strength2_);
    revchain::detail::require_positive(place, "tension times gravity / angular speed^2", strength2_);
    root_ = std::hypot(first_ * second_, 2 * strength2_);
    const double beyond = std::sqrt(2 * root_);
    d_ = std::hypot(second_, beyond);
    third_ = std::hypot(d_, first_);
    revchain::detail::require_positive(place, "greatest radius squared", d_ * d_);
    if (!std::isfinite(d_ * d_ / strength2_))  // tension_ratio and the slopes are at most that
        revchain::detail::refuse(
            place,
            "greatest radius must be so small that radius^2 angular speed^2 / (tension gravity) does not overflow",
            second_);
    functions_ = JacobiFunctions(EllipticModulus::of_ratio(std::sqrt(second_ - first_) * std::sqrt(second_ + first_),
                                                           std::hypot(first_, beyond)));
    scale_ = 2 * (strength2_ / d_);
}

inline double TortuousRope::half_wave_slack() const {
    const CompleteIntegrals& c = functions_.complete();
    const double mixed = first_ * second_ / (root_ + 2 * strength2_) * (first_ * second_);
    return 2 * (second_ / d_ * second_ * c.B + first_ / d_ * first_ * c.D + mixed / d_ * c.K);
}

inline double TortuousRope::half_wave_angle() const {
    if (is_plane()) return std::numbers::pi;
    const double ratio = second_ / first_;
    return 2 * ratio * (third_ / d_) * complete_pi((1 - ratio) * (1 + ratio), modulus());
}

inline TortuousPoint TortuousRope::at(double x) const {
    if (!std::isfinite(x / scale_))
        revchain::detail::refuse("analytic::TortuousRope::at",
                                 "x must be finite, and so small that the number of half waves does not overflow", x);
    const JacobiValues f = functions_(x / scale_);
    TortuousPoint point{
        x, d_ * f.epsilon - root_ / d_ * (x / scale_), std::hypot(first_ * f.cn, second_ * f.sn), 0, 0, 0, 0};
    const double bend = f.dn / scale_;
    if (is_plane()) {  // through the axis, or so near that it turns there and nowhere else: half a turn
        const double half_turns = std::nearbyint(f.amplitude / std::numbers::pi);
        const double sign = std::fmod(half_turns, 2.0) == 0 ? 1 : -1;
        point.angle = half_turns * std::numbers::pi + std::atan2(sign * second_ * f.sn, sign * first_ * f.cn);
    } else {
        const double ratio = second_ / first_;
        point.angle = ratio * (third_ / d_) * incomplete_pi((1 - ratio) * (1 + ratio), f, modulus());
    }
    if (first_ == 0) {
        point.radius_slope = std::copysign(second_ * f.cn * bend, f.sn * f.cn * bend);
    } else {
        point.radius_slope = (second_ - first_) * ((second_ + first_) * f.sn / point.radius) * f.cn * bend;
        point.angle_slope = first_ / point.radius * (second_ / point.radius) * (third_ / (2 * strength2_));
    }
    if (!std::isfinite(point.arc))
        revchain::detail::refuse("analytic::TortuousRope::at",
                                 "x must be so small that the rope up to it does not overflow", x);
    // (R1 + R2 + r - R) / 2 c^2
    point.tension_ratio = (std::pow(std::hypot(first_ * f.sn, second_ * f.cn), 2) + root_) / (2 * strength2_);
    return point;
}

}  // namespace revchain::analytic
