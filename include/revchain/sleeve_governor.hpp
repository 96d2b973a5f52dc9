// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/status.hpp"

/// A centrifugal governor: balls on a turning shaft lift a sleeve (Watt, Porter, Hartnell).
///
///     const revchain::SleeveGovernor watt({.ball_mass = 4, .arm = 1.4, .lower_arm = 1.4,
///                                          .sleeve_mass = 3, .gravity = 12});  // kg, m
///     const auto at = watt.equilibria(5.0).back();  // open, at 5 rad/s
///     std::cos(at.inclination);                      // 0.6
///     at.period;                                     // 2.19911 s = 0.7 pi s, the shaft's speed held
///     watt.speed(0.9);                               // 4.91232 rad/s: arms at 0.9 rad
namespace revchain::inline REVCHAIN_BUILD {

/// The data of a governor. Lengths are measured in the plane of shaft and arms.
struct GovernorData {
    double ball_mass = 0;  ///< of each ball
    int balls = 2;
    double arm = 0;            ///< from the pivot to the ball
    double pivot_offset = 0;   ///< of the arms' pivots from the axis; negative if arms cross
    double lower_arm = 0;      ///< of the links that carry the sleeve; 0 without them
    double joint = 0;          ///< from the pivot to the joint of the lower link; 0: at the ball
    double sleeve_offset = 0;  ///< of the lower links' pivots on the sleeve from the axis
    /// Hartnell: levers with a ball on one arm and the sleeve at the other, of this length, at
    /// right angles; inclination 0 is the ball's arm upright. Instead of lower links.
    double sleeve_arm = 0;
    double sleeve_mass = 0;
    double spring_stiffness = 0;  ///< presses the sleeve down
    double spring_force = 0;      ///< at inclination 0
    double friction = 0;          ///< force that the sleeve resists with, either way
    double shaft_inertia = std::numeric_limits<double>::infinity();  ///< finite: it turns freely
    double gravity = conical_pendulum::standard_gravity;
};

/// The governor at one inclination of its arms.
struct GovernorPoint {
    double inclination = 0;  ///< of the arms, outwards
    double speed = 0;        ///< of equilibrium, rad/s; NaN or infinite if none
    /// With friction the sleeve stays between these speeds; 0: also at rest; NaN if at none.
    double low_speed = 0, high_speed = 0;
    double ball_radius = 0;
    double height = 0;    ///< of the cone: from the ball to where its arm meets the axis
    double lift = 0;      ///< of the sleeve, from inclination 0
    bool stable = false;  ///< whether the arms return when disturbed at constant speed
    double period = 0;    ///< of small oscillations, also of a free shaft; NaN if there are none
};

/// How a governor answers a change of speed.
struct GovernorEffort {
    double effort = 0;  ///< mean force at the sleeve while it is lifted
    double lift = 0;    ///< to the next stable equilibrium outwards at that speed; NaN if none
    double power = 0;   ///< effort times lift
};

/// A governor. With V the potential energy of balls, sleeve and spring, and J the moment of inertia
/// of the balls, both functions of the inclination, the speed of equilibrium is n^2 = 2 V' / J'. At
/// constant speed it is stable if V'' > n^2 J''/2, and oscillates with the frequency sqrt((V'' -
/// n^2 J''/2) / A), where A is twice the kinetic energy over the square of the arms' rate; n^2 J'^2
/// / (I + J) is added to the numerator if the shaft has the moment of inertia I and turns freely.
///
/// Accuracy measured: squares of speeds 1e-12 (tests/cpp/sleeve_governor.cpp), periods 1e-14
/// (tests/python/test_governor.py). Cost: 50 ns a point, 0.1 ms for all equilibria.
class SleeveGovernor {
   public:
    /// Throws InvalidArgument for numbers out of range, lower links too short for the sleeve at
    /// inclination 0, lower links together with sleeve arms, and sleeve mass, spring or friction
    /// without either.
    explicit SleeveGovernor(const GovernorData& data);

    const GovernorData& data() const noexcept { return data_; }
    /// The point at an inclination. Throws InvalidArgument unless |inclination| < pi/2 and the
    /// links reach there.
    [[nodiscard]] GovernorPoint at(double inclination) const { return at(inclination, {}); }
    /// The speed of equilibrium, NaN or infinite if there is none.
    [[nodiscard]] double speed(double inclination) const { return at(inclination).speed; }
    /// All equilibria at a speed with the arms at most horizontal and the balls on their own side
    /// of the axis, by inclination; stops are ignored. `complete` is true if intervals prove that
    /// there are no others. Throws InvalidArgument unless 0 <= speed <= 1e100.
    [[nodiscard]] std::vector<GovernorPoint> equilibria(double speed,
                                                        bool* complete = nullptr) const;
    /// The answer to a speed that rises by the fraction `change` from the equilibrium at an
    /// inclination. Throws InvalidArgument as `at`, without a sleeve, for a change that is not
    /// positive, and unless there is an equilibrium at a speed above 0.
    [[nodiscard]] GovernorEffort effort(double inclination, double change = 0.01) const;

   private:
    struct Motion;
    [[nodiscard]] GovernorPoint at(double inclination, std::optional<double> turned) const;
    GovernorData data_;
};

}  // namespace revchain

#include "revchain/paper/sleeve_governor.hpp"
