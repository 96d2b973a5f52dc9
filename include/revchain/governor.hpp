// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "revchain/special/jacobi.hpp"

/// The ball of a governor: a link hinged on a turning axis, swinging in a plane that turns with it.
///
///     const revchain::analytic::GovernorMotion motion(
///         {.angular_speed = 6.0, .pendulum_length = 0.5, .gravity = 9.80665, .angle = 1.2});
///     motion.period();          // 1.28554 s
///     motion.least_angle();     // 0.75646 rad; the greatest angle is 1.2 rad
///     motion(0.3).angle;        // 0.984514 rad at 0.3 s
///
/// Greenhill (1908) §7. Angles in rad from the downward vertical, consistent units.
namespace revchain::inline REVCHAIN_BUILD::analytic {

/// The data of the motion.
struct Governor {
    double angular_speed;    ///< n of the axis; 0 for a plain pendulum
    double pendulum_length;  ///< l > 0, about the hinge
    double gravity;          ///< g; negative if the axis is upside down
    double angle;            ///< theta at time 0
    double angle_rate = 0;   ///< theta' at time 0
    /// 0 ... 1: moment of inertia about the link's own line over that about the hinge
    double axial_inertia = 0.0;
};

/// Kinds of motion, §7 (4)-(13), with the functions that describe them.
enum class GovernorRegime {
    rest,         ///< an equilibrium, also the relative equilibrium at cos theta = lambda / l
    aside,        ///< between two angles on one side: dn
    asymptotic,   ///< towards an equilibrium that is never reached: sech, sinh, exp
    through,      ///< to and fro through the lowest point (highest if gravity is negative): cn
    revolutions,  ///< round and round: tn
};

[[nodiscard]] inline std::string_view to_string(GovernorRegime regime) noexcept {
    constexpr std::string_view names[]{"rest", "aside", "asymptotic", "through", "revolutions"};
    return names[static_cast<std::size_t>(regime)];
}

/// Angle and its rate at one time.
struct GovernorState {
    double angle, angle_rate;
};

/// The motion theta'' = n^2 (1 - `axial_inertia`) sin theta cos theta - (g/l) sin theta, as a
/// function of time.
///
/// Method: with tau = tan(theta/2), 4 tau'^2 = e + 2 b tau^2 + f tau^4, where e and f are the
/// squares of theta' at the bottom and at the top. Accuracy: 1e-13 of the greatest |theta| and of t
/// times the greatest |theta'|; theta' likewise. It is less if e or f is lost in rounding: the
/// start gives them to 1e-16 (theta'^2 + n^2 + |g/l|). Cost: 0.4 microseconds to construct, 60 ns a
/// time.
class GovernorMotion {
   public:
    /// Throws InvalidArgument for numbers out of range, and data so far apart that a modulus is
    /// lost.
    explicit GovernorMotion(const Governor& given);

    GovernorRegime regime() const noexcept { return regime_; }
    /// Period of the motion, or of one revolution; infinite if asymptotic, 0 at rest.
    double period() const noexcept { return period_; }
    /// The range of angles, whole turns included; -infinity and infinity for revolutions.
    double least_angle() const noexcept { return least_; }
    double greatest_angle() const noexcept { return greatest_; }
    /// theta'^2 at the bottom and at the top by the energy; negative if that point is not reached.
    double energy_at_bottom() const noexcept { return bottom_; }
    double energy_at_top() const noexcept { return top_; }
    EllipticModulus modulus() const { return functions_.modulus(); }

    /// The state at a time of either sign. Throws InvalidArgument unless time and angle are finite.
    [[nodiscard]] GovernorState operator()(double time) const;

   private:
    enum class Form { constant, growing, cn, dn, tn };

    /// opposite : adjacent = tan(angle/2) after `turns` whole turns. `rate` is (opposite' adjacent
    /// - opposite adjacent') over the product of their scales.
    struct Half {
        double opposite, adjacent, turns, rate;
    };
    struct Quartic;
    void choose_form(const Quartic& q, double pace, double angle_rate);
    void set_range(double minus);
    void set_phase(double sn, double cn);
    Half half_at(double u) const;
    double unfolded(const Half& half) const;

    GovernorRegime regime_ = GovernorRegime::rest;
    Form form_ = Form::constant;
    bool upside_down_ = false;            // angles from the top: gravity is positive
    double turns_ = 0;                    // whole turns from the angle computed to the one given
    double angle_ = 0;                    // given
    double rate_ = 0, phase_ = 0;         // u = phase + rate t
    double opposite_ = 0, adjacent_ = 1;  // tan(theta/2): their ratio times cn, dn or tn
    double period_ = 0, least_ = 0, greatest_ = 0, bottom_ = 0, top_ = 0;
    JacobiFunctions functions_{EllipticModulus::of(0)};
};

}  // namespace revchain::analytic

#include "revchain/special/governor.hpp"
