// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/rig.hpp"

/// Steady shapes of a whirling chain at any inclination: relative equilibria in the frame that turns with it.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     const auto found = revchain::steady_shapes(chain, {.angular_speed = 6.0});
///     found.complete;                          // true: proved, there are no others
///     found.shapes[0].inclination;             // rad, lowest link first
///     found.shapes[0].error_bound;             // of every inclination, rad: proved
namespace revchain::inline REVCHAIN_BUILD {

/// One steady shape of a whirling chain, links lowest first, pins free end first, in the units of the chain.
struct SteadyShape {
    Vector<double> inclination;           ///< (N) of each link to the downward vertical, rad, within (-pi, pi]
    Vector<double> offset;                ///< (N + 1) of each pin from the axis; the support last (0 for a chain)
    Vector<double> height;                ///< (N + 1) of each pin above the support, negative below it
    Vector<double> tension;               ///< (N) size of the reaction at each link's upper pin
    Vector<double> reaction_inclination;  ///< (N) of that reaction to the vertical, rad: phi of §8 (5)
    int half_waves = 1;                   ///< number of sign changes of the offsets, plus 1
    double conical_height = 0;            ///< g/n^2 of the speed n
    double residual = 0;                  ///< largest unbalanced moment over (total weight times total length)
    double error_bound = 0;               ///< of every inclination, rad: proved (at a fold an estimate)
    /// Condition number, rad: if each force changes by a fraction e of itself, with any signs, no inclination changes
    /// by more than e times this. (If links stand or have several inclinations, the moments about the upper pins change
    /// instead.) On a branch, if another number than the height is given, it is an estimate: the largest change for a
    /// few patterns of signs, and for a change of the given number by a fraction e.
    double condition = 0;
    double moment_of_inertia = 0;  ///< about the axis, weight times length squared (over g: a moment of inertia)
    double effective_energy = 0;   ///< U = -sum of weight times depth - moment_of_inertia/(2 lambda)

    [[nodiscard]] double angular_speed(double gravity = conical_pendulum::standard_gravity) const {
        return conical_pendulum::angular_speed(conical_height, gravity);
    }
    double angular_momentum(double gravity = conical_pendulum::standard_gravity) const {
        return moment_of_inertia / gravity * angular_speed(gravity);
    }
};

/// A range of inclinations of the lowest link, rad.
struct InclinationRange {
    double low, high;
};

/// The speed, as one of two numbers, and which shapes are wanted.
struct SteadyShapesOptions {
    std::optional<double> conical_height{};  ///< of the speed
    std::optional<double> angular_speed{};   ///< rad/s
    long budget = 3'000'000;   ///< limit of link evaluations, 0.5 microseconds each; 2 for links whose pendulum length
                               ///< is below their length; more in double-double
    bool hanging_only = true;  ///< only shapes with every link within a right angle of the downward vertical
    double gravity = conical_pendulum::standard_gravity;  ///< with `angular_speed`
    Index threads = 1;                                    ///< 0: all processors
};

/// Which shapes of a rig are wanted: as `SteadyShapesOptions`. `direction` goes with `conical_height`
/// and is not read with `angular_speed`, whose sign is the direction.
struct RigShapesOptions {
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};  ///< rad/s, negative for the backward direction
    long budget = 3'000'000;
    bool hanging_only = true;  ///< only shapes with each link in the rig's posture
    Rotation direction = Rotation::forward;
    double gravity = conical_pendulum::standard_gravity;  ///< with `angular_speed`, and for flywheels
    Index threads = 1;
};

/// The shapes found, and whether there are more.
struct SteadyShapes {
    std::vector<SteadyShape> shapes;          ///< by half waves, then inclination of the lowest link
    std::vector<InclinationRange> undecided;  ///< where there may be others; empty if the list is complete
    bool complete = false;                    ///< proved: no shape is missing
    long cells = 0;                           ///< number of parts of the range that were examined
};

/// All steady shapes (relative equilibria) of a chain that whirls at a given speed: with `hanging_only` those in which
/// every link is within a right angle of the downward vertical, else those in any posture. Straight shapes are left
/// out. Of two mirror images the one with the free end at a positive offset is listed (or, if that end is on the axis,
/// the one whose lowest inclined link has a positive inclination).
///
/// Method: the offset of the support is a function of t, the tangent of the lowest link's inclination: Greenhill (1908)
/// §8 (4), (12). In interval arithmetic with first and second derivatives, the range of t is split until each part has
/// exactly one zero or none. Newton's method, then Krawczyk's test, treat all pins in double-double. Links that stand,
/// or hang at several inclinations under one load (pendulum length l > a and lambda <= W h (l - a)/(W h + a S)), are
/// followed along each inclination. Krawczyk's test then decides boxes of the tangents of all links.
/// Accuracy: every inclination is within `error_bound`, proved, mostly 2.3e-16 (4.4e-16 if links stand); measured
/// errors are at most 2 ulp of the inclination. `complete` is proved too. If it is false, `undecided` says where shapes
/// may be missing: at exactly a critical speed or a fold, or where the budget runs out, as for chains of 20 plummets
/// and more at heights of some 1/1000 of their length. If each link has one inclination for its load, a scan searches
/// there too, and the shapes it finds are in the list.
/// At heights below 2^-50 (9e-16) of the longest length (rounded up to a power of 2) nothing is listed and `complete`
/// is false. Double-double holds offsets to 2^-104 of that length, and a sideways pull is an offset over the height, so
/// tensions would lose their digits.
/// Cost: 10 to 500 cells for a shape: 84 shapes of eight plummets take 12 ms, 6466 of twelve 1 s, the first of 1000
/// plummets 0.02 s, the 14 of 1000 plummets at 1/500 of their length 4 s. In any posture, heights down to 1e-3 of the
/// length: all shapes of three links 1 to 5 ms, of four (64 of equal plummets) 4 to 70 ms, 868 of six plummets 0.6 s,
/// 11008 of eight 11 s.
/// Threads share the shapes found, not the search for them, about half of the cost. Results are bitwise the same
/// whatever their number.
/// No shape in any posture exists above the first critical height. Proof: let s be the sines of the inclinations d, G
/// their mass matrix, kappa = W h + a S, D = lambda diag(kappa |sec d|) > G, and E = diag(+-1) the postures. Then
/// E D s = G s gives, with w = D^1/2 s, |E w| = |D^-1/2 G D^-1/2 w| < |w|: only w = 0 is possible.
/// An angular speed n gives the height g/n^2, formed in double-double.
/// Throws InvalidArgument unless exactly one of height and speed is given, positive and finite.
[[nodiscard]] SteadyShapes steady_shapes(const Chain<double>& chain,
                                         const SteadyShapesOptions& options);

/// All steady shapes of a rig that whirls at a given speed, in its posture or in any posture: as of a chain, with a
/// support that yields or is carried round, flywheels, links in a fluid.
///
/// For a support on the axis straight shapes are left out, and of two mirror images the one whose free end is at a
/// negative offset. For a support carried round at radius b (a swing carousel) every shape is listed, outwards
/// positive.
/// Method: that of chains. The sweep ends in  y - b - (H + W y)/(lambda E), which must be 0: y is the offset of the
/// topmost pin, H/lambda its sideways pull, W the carriage's weight, E the spring's stiffness. With b > 0 tangents of
/// both signs are searched. The pull of a link is tension + n momentum/length. Where it is negative (a wheel against
/// the rotation, a float), the link leans against its load. It is then followed along each inclination, as a link with
/// several inclinations is.
/// Accuracy, cost, and `complete`: as of chains (measured: tests/cpp/finite/shapes/rigs.cpp); about twice the cost with
/// b > 0.
/// `complete` is also false if the rig has more than some 160 links and one of them leans against its load, or if
/// lambda E equals the total moving weight, to rounding. Pins may then be at any distance: the search covers only about
/// a million times the chain's reach.
/// Throws InvalidArgument unless exactly one of height and speed is given, for a height or gravity not positive and
/// finite, an effective tension that vanishes, and a lowest link whose moving weights balance
/// about its pin.
[[nodiscard]] SteadyShapes steady_shapes(const Rig& rig, const RigShapesOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/shapes/steady_shapes.hpp"
#endif
