// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "revchain/conical_pendulum.hpp"
#include "revchain/special/jacobi.hpp"

/// Ropes that whirl without gravity: the skipping rope, and the rope that winds round its axis.
///
///     namespace analytic = revchain::analytic;
///     const analytic::SkippingRope rope({.span = 2.0, .length = 3.0, .angular_speed = 10.0});
///     rope.sag();                    // 1.03141 m
///     rope.tension_in_the_middle();  // 5.13717 m of rope weigh as much
///     rope.at(0.5).offset;           // 0.766851 m, at 0.5 m from an end
///
/// Greenhill (1908) §5. Units: any consistent set, angles in rad. lambda = g/n^2 is the conical
/// height, and a tension is given as the length h of rope of this weight. Shapes depend on lambda
/// and h by their product only.
namespace revchain::inline REVCHAIN_BUILD::analytic {

/// The data of a skipping rope. Give exactly two of: span, length, slack, sag, and the pair of
/// tension and angular speed. With two of the first four, tension or angular speed may be added.
/// Give slack if span and length nearly agree.
struct RopeGiven {
    std::optional<double> span{}, length{}, slack{};  ///< of the whole rope; slack = length - span
    std::optional<double> sag{};                      ///< the largest offset
    std::optional<double> angular_speed{};            ///< n
    std::optional<double> tension{};                  ///< h in the middle of a half wave
    Index half_waves = 1;
    double gravity = conical_pendulum::standard_gravity;  ///< relates n to lambda only
};

/// A point of a skipping rope.
struct RopePoint {
    double x, arc;         ///< distance from an end along the axis, and along the rope
    double offset;         ///< y
    double slope;          ///< dy/dx
    double tension_ratio;  ///< tension over that in the middle of a half wave
};

/// The rope y = b sn(K x/a) with neighbouring nodes 2a apart and sag b. §5 (1). Accuracy: 1e-14
/// relative in everything that the data determine well. Cost: 1.5 microseconds to construct, 30 ns
/// for a point, 0.4 microseconds for a point given by its arc.
class SkippingRope {
   public:
    /// Throws InvalidArgument for numbers that are not positive and finite, for too few or too
    /// many, and if no such rope exists, as with a length not above the span.
    explicit SkippingRope(const RopeGiven& given);

    Index half_waves() const noexcept { return half_waves_; }
    EllipticModulus modulus() const { return functions_.modulus(); }
    // These functions return a given number unchanged.
    double span() const noexcept { return span_; }
    double slack() const noexcept { return slack_; }
    double length() const noexcept { return length_; }
    double sag() const noexcept { return sag_; }
    double slope_at_ends() const { return 2 * (kappa() / complement()) / complement(); }
    double tension_ratio_at_ends() const { return 1 + kappa() * slope_at_ends(); }
    double height_times_tension() const { return strength() * strength(); }  ///< lambda h
    /// Moment of inertia about the axis over the mass per length: a length cubed.
    [[nodiscard]] double moment_of_inertia() const;

    /// Whether angular speed or tension was given; else the next four throw InvalidArgument.
    bool has_speed() const { return conical_height_.has_value(); }
    [[nodiscard]] double conical_height() const;
    double angular_speed() const {
        return conical_pendulum::angular_speed(conical_height(), gravity_);
    }
    double tension_in_the_middle() const { return strength() / conical_height() * strength(); }
    double tension_at_ends() const { return tension_in_the_middle() * tension_ratio_at_ends(); }

    /// The point at the distance x from an end, 0 <= x <= span. Throws InvalidArgument outside.
    [[nodiscard]] RopePoint at(double x) const;
    /// The point at the arc length `arc`, 0 <= arc <= length. Throws InvalidArgument outside.
    [[nodiscard]] RopePoint at_arc(double arc) const;

    /// The rope with its ends moved to another span, with the same length and angular momentum.
    [[nodiscard]] SkippingRope drawn_to(double span) const;

   private:
    double waves() const { return static_cast<double>(half_waves_); }
    double kappa() const { return modulus().modulus(); }
    double complement() const { return modulus().complementary_modulus(); }
    /// sqrt(lambda h)
    double strength() const { return quarter_ / (complement() * functions_.complete().K); }
    RopePoint at_argument(double u) const;

    double span_ = 0, slack_ = 0, length_ = 0, sag_ = 0, quarter_ = 0, gravity_ = 0;  // quarter: a
    std::optional<double> conical_height_;
    Index half_waves_ = 1;
    JacobiFunctions functions_{EllipticModulus::of(0)};
};

/// The data of a rope that winds round its axis, all positive; the least radius may be 0 (a plane
/// rope).
struct TortuousGiven {
    double least_radius, greatest_radius;
    double angular_speed;                                 ///< n
    double tension;                                       ///< h along the axis
    double gravity = conical_pendulum::standard_gravity;  ///< relates n to lambda only
};

/// A point of a tortuous rope.
struct TortuousPoint {
    double x, arc;         ///< along the axis and along the rope, from a point nearest to the axis
    double radius;         ///< distance from the axis
    double angle;          ///< round the axis; a plane rope: pi/2 past x = 0, pi more per crossing
    double radius_slope;   ///< d radius / dx
    double angle_slope;    ///< d angle / dx
    double tension_ratio;  ///< tension over its component along the axis
};

/// The rope that winds round its axis, with its ends off the axis. §5, text after (6)
///
/// R is the squared distance from the axis, R1 <= R <= R2, c^2 = lambda h, r = sqrt(R1 R2 + 4 c^4):
///     R3 = R1 + R2 + 2 r,   d = sqrt(R3 - R1),   kappa^2 = (R2 - R1)/(R3 - R1),  u = d x/(2 c^2),
///     R = R1 cn^2 u + R2 sn^2 u,   arc = d E(am u) - (r/d) u,
///     theta = sqrt(R2 R3/R1)/d Pi(1 - R2/R1; am u).
/// Accuracy in what data and x determine well: 1e-14 relative, of the angle 1e-14 (1 + |angle|).
/// Cost: 0.2 microseconds to construct, 0.3 microseconds a point.
class TortuousRope {
   public:
    /// Throws InvalidArgument for numbers out of range.
    explicit TortuousRope(const TortuousGiven& given);

    double least_radius() const noexcept { return first_; }
    double greatest_radius() const noexcept { return second_; }
    double conical_height() const noexcept { return height_; }
    double height_times_tension() const noexcept { return strength2_; }
    EllipticModulus modulus() const { return functions_.modulus(); }

    // A half wave runs from one point nearest to the axis to the next: its length along the axis,
    // slack, length of rope, and angle round the axis.
    double half_wave() const { return 2 * functions_.complete().K * scale_; }
    [[nodiscard]] double half_wave_slack() const;
    [[nodiscard]] double half_wave_length() const { return half_wave() + half_wave_slack(); }
    [[nodiscard]] double half_wave_angle() const;

    /// The point at x, of either sign. Throws InvalidArgument unless x and the results are finite.
    [[nodiscard]] TortuousPoint at(double x) const;

   private:
    /// Whether the radii are so far apart that a half wave turns by pi, to the last bit.
    bool is_plane() const { return first_ <= 1e-20 * second_; }

    double first_, second_, third_;  // square roots of R1, R2, R3
    double height_, strength2_;      // lambda, c^2
    double root_, d_, scale_;        // r; d; x = scale u
    JacobiFunctions functions_{EllipticModulus::of(0)};
};

}  // namespace revchain::analytic

#include "revchain/special/rope.hpp"
