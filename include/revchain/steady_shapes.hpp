// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/rig.hpp"
#include "revchain/thorough.hpp"

/// Steady shapes of a whirling chain at any inclination: relative equilibria in the turning frame.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     const auto found = revchain::steady_shapes(chain, {.angular_speed = 6.0});
///     found.complete;                          // true: proved, there are no others
///     found.shapes[0].inclination;             // rad, lowest link first
///     found.shapes[0].error_bound;             // of every inclination, rad: proved
namespace revchain::inline REVCHAIN_BUILD {

/// One steady shape, links lowest first, pins free end first, in the units of the chain.
struct SteadyShape {
    Vector<double> inclination;  ///< (N) of each link to the downward vertical, rad, in (-pi, pi]
    Vector<double> offset;       ///< (N + 1) of each pin from the axis; the support is last
    Vector<double> height;       ///< (N + 1) of each pin above the support, negative below it
    Vector<double> tension;      ///< (N) magnitude of the reaction at each link's upper pin
    Vector<double> reaction_inclination;  ///< (N) of that reaction, rad: phi of §8 (5)
    int half_waves = 1;                   ///< number of sign changes of the offsets, plus 1
    double conical_height = 0;            ///< g/n^2 of the speed n
    double residual = 0;     ///< largest unbalanced moment over (weight times length of the chain)
    double error_bound = 0;  ///< of every inclination, rad: proved (not at a fold)
    /// Condition number, rad: about the largest change of an inclination if each force changes by a
    /// small fraction of itself, over that fraction.
    double condition = 0;
    /// about the axis, weight times length squared (over g: a moment of inertia)
    double moment_of_inertia = 0;
    /// U = -sum of weight times depth - moment_of_inertia/(2 lambda); of a rig, with buoyancy, the
    /// momenta of flywheels and the energy of the support's spring
    double effective_energy = 0;

    [[nodiscard]] double angular_speed(double gravity = conical_pendulum::standard_gravity) const {
        return conical_pendulum::angular_speed(conical_height, gravity);
    }
    /// Without the constant momenta of flywheels.
    double angular_momentum(double gravity = conical_pendulum::standard_gravity) const {
        return moment_of_inertia / gravity * angular_speed(gravity);
    }
};

/// A range of inclinations of the lowest link, rad.
struct InclinationRange {
    double low, high;
};

/// Selects steady shapes of a chain. Give either `conical_height` or `angular_speed`.
struct SteadyShapesOptions {
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};  ///< rad/s
    /// Limit of link evaluations. Each takes 0.5 microseconds for plummets, longer for other links
    /// and in double-double.
    long budget = 3'000'000;
    bool hanging_only = true;                             ///< only shapes with every link hanging
    double gravity = conical_pendulum::standard_gravity;  ///< with `angular_speed`
    Index threads = 1;                                    ///< 0: all processors
};

/// Selects shapes of a rig, as `SteadyShapesOptions` does. `direction` goes with `conical_height`
/// and is not read with `angular_speed`, whose sign is the direction.
struct RigShapesOptions {
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};  ///< rad/s, negative for the backward direction
    long budget = 3'000'000;
    bool hanging_only = true;  ///< only shapes with each link in the rig's posture
    Rotation direction = Rotation::forward;
    double gravity =
        conical_pendulum::standard_gravity;  ///< with `angular_speed`, and for flywheels
    Index threads = 1;
};

/// The shapes found, and whether others may exist.
struct SteadyShapes {
    std::vector<SteadyShape> shapes;          ///< by half waves, then lowest inclination
    std::vector<InclinationRange> undecided;  ///< where there may be others, in one plane
    bool complete = false;                    ///< proved: no shape is missing
    long cells = 0;                           ///< number of parts of the range that were examined
};

/// The steady shapes (relative equilibria) of a chain that whirls at a given speed. With
/// `hanging_only` every link of a shape is within a right angle of the downward vertical. Other
/// postures, and links that hang at several inclinations under one load, need `thorough` as the
/// last argument, or revchain::compiled. Straight shapes are omitted. Of two mirror images the one
/// whose free end has a positive offset is listed.
///
/// Method: the offset of the support is a function of the tangent of the lowest link's inclination,
/// Greenhill (1908) §8 (4), (12). Its range is split, in interval arithmetic, until each part has
/// exactly one zero or none. Newton's method and Krawczyk's test then treat all pins in
/// double-double. Links that stand, or hang at several inclinations under one load (lambda <= W h
/// (l - a)/(W h + a S)), are followed along each inclination. Accuracy: every inclination is within
/// `error_bound`, proved, mostly 2.3e-16 (4.4e-16 if links stand); measured errors are at most 2
/// ulp of the inclination, or 1e-27 times `condition`. Without `thorough` bounds are wider if links
/// lie within 1e-5 of the horizontal. `complete` is proved too. If it is false, `undecided` has the
/// ranges where shapes may be missing: at a critical speed or a fold, or if the budget is used up.
/// It is also false if a link between the lowest and topmost could lean to any side under no load,
/// because shapes that lie in no plane with the axis are not searched. At heights below 9e-16 of
/// the longest length nothing is listed and `complete` is false. Cost for equal plummets: the 46
/// shapes of eight at 1/200 of their length take 5 ms, the 14 shapes of 1000 at 1/500 of their
/// length 2 s. In any posture, at 1/1000 of the length, the 18 shapes of three take 2 ms, the 64 of
/// four 12 ms. Results are bitwise the same for any number of threads.
/// Above the first critical height there is no shape in any posture. Proof: let s be the sines of
/// the inclinations d, G their mass matrix, kappa = W h + a S, D = lambda diag(kappa |sec d|) > G,
/// and E = diag(+-1) the postures. Then E D s = G s gives, with w = D^1/2 s, |E w| = |D^-1/2 G
/// D^-1/2 w| < |w|: only w = 0 is possible.
/// Throws InvalidArgument unless exactly one of height and speed is given, for weights more than
/// 1e123 apart and, unless `thorough` is given, for links that stand or may hang at several
/// inclinations.
REVCHAIN_DECLARE
[[nodiscard]] SteadyShapes steady_shapes(const Chain<double>& chain,
                                         const SteadyShapesOptions& options);
REVCHAIN_DECLARE
[[nodiscard]] SteadyShapes steady_shapes(const Chain<double>& chain,
                                         const SteadyShapesOptions& options, Thorough);

/// The steady shapes of a rig that whirls at a given speed, in its posture or in any posture.
/// Accuracy is that of chains (tests/cpp/finite/shapes/rigs.cpp). Cost: that of chains, or several
/// times as much. For a support carried round at radius b > 0 positive is outwards.
///
/// Method: that of chains. The sweep must end in y - b - (H + W y)/(lambda E) = 0: y is the offset
/// of the topmost pin, H/lambda its sideways pull, W the carriage weight, E the spring's stiffness.
/// The pull of a link is tension + n momentum/length. If it is negative (a wheel against the
/// rotation, a float), the link leans against its load and is followed along each inclination.
/// `complete` is also false if the topmost link of a support off the axis or on a spring could lean
/// to any side. Throws InvalidArgument as for chains, and for springs at pins, linear drag, a
/// dashpot at the support and an effective tension that vanishes.
REVCHAIN_DECLARE
[[nodiscard]] SteadyShapes steady_shapes(const Rig& rig, const RigShapesOptions& options);
REVCHAIN_DECLARE
[[nodiscard]] SteadyShapes steady_shapes(const Rig& rig, const RigShapesOptions& options, Thorough);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/shapes/steady_shapes.hpp"
#endif
