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
namespace revchain {

/// One steady shape of a whirling chain, links lowest first, pins free end first, in the units of the chain.
struct SteadyShape {
    Vector<double> inclination;           ///< (N) of each link to the downward vertical, rad, within (-pi, pi]
    Vector<double> offset;                ///< (N + 1) of each pin from the axis; the support's 0 last
    Vector<double> height;                ///< (N + 1) of each pin above the support: negative where it hangs
    Vector<double> tension;               ///< (N) size of the reaction at each link's upper pin
    Vector<double> reaction_inclination;  ///< (N) of that reaction to the vertical, rad: phi of §8 (5)
    int half_waves = 1;                   ///< sign changes of the offsets, and one
    double conical_height = 0;            ///< of the speed
    double residual = 0;                  ///< largest moment left over, over total weight and total length
    double error_bound = 0;               ///< of every inclination, rad: proved (at a fold an estimate)
    /// Largest change of an inclination, rad, where each force changes by its own size, times it, whatever the signs
    /// (in a list with links that stand or have several inclinations: each moment about a link's upper pin). On a
    /// branch, where something else than the height is given, the largest of a few patterns of signs, and of what is
    /// given changed.
    double condition = 0;
    double moment_of_inertia = 0;  ///< about the axis, weight times length squared (over g: a moment of inertia)
    double effective_energy = 0;   ///< U = -sum of weight times depth - moment_of_inertia/(2 lambda)

    double angular_speed(double gravity = conical_pendulum::standard_gravity) const {
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
    std::optional<double> angular_speed{};   ///< rad/s; of a rig negative for the other direction
    long budget = 3'000'000;   ///< links to look at, 0.5 microseconds each, 2 where l < a, more in double-double
    bool hanging_only = true;  ///< only shapes with every link within a right angle of the downward vertical; of a rig
                               ///< with each link in the rig's posture
    int direction = 1;         ///< of rotation, 1 or -1, where `conical_height` is given: it matters to flywheels
    double gravity = conical_pendulum::standard_gravity;  ///< with `angular_speed`, and for rigs with flywheels
};

/// The shapes found, and whether there are more.
struct SteadyShapes {
    std::vector<SteadyShape> shapes;          ///< by half waves, then inclination of the lowest link
    std::vector<InclinationRange> undecided;  ///< where there may be others; empty if the list is complete
    bool complete = false;                    ///< proved: no shape is missing
    long cells = 0;                           ///< looked at
};

/// All steady shapes (relative equilibria) of a chain that whirls at a given speed: those in which every link is within
/// a right angle of the downward vertical, or all in any posture. Straight shapes are left out; of two mirror images
/// the one with the free end at a positive offset is listed (if that is on the axis, the lowest link that is inclined).
///
/// Method: the offset of the support as a function of the lowest link's tangent, Greenhill (1908) §8 (4), (12), in
/// interval arithmetic with first and second derivatives, 0 ... the farthest tangent split until every part holds no
/// zero or one; Newton's method and then Krawczyk's test on all pins in double-double. Links that stand, or hang at
/// several inclinations under one load (l > a and lambda <= W h (l - a)/(W h + a S)), are followed along each; there a
/// part ends in a box about the tangents of all links that is proved to hold no zero or one (Krawczyk).
/// Accuracy: every inclination within `error_bound`, proved: mostly 2.3e-16 (4.4e-16 of links that stand), and 2 ulp of
/// itself (measured). `complete` is proved too. Where it is false, `undecided` says where shapes may be missing: at
/// exactly a critical speed or a fold, where the budget ends, as it does for chains of 20 links and more at heights of
/// some 1/300 of their length; those that a scan finds there all the same are in the list (where links hang at one
/// inclination).
/// At heights below 2^-50 (9e-16) of the longest length (rounded up to a power of 2) nothing is listed and `complete`
/// is false: a sideways pull is an offset over the height, and double-double holds offsets to 2^-104 of that length.
/// Below that, tensions would lose their digits.
/// Cost: 10 to 500 cells for a shape: 84 shapes of eight plummets take 15 ms, 6466 of twelve 1.3 s, the first of 1000
/// plummets 0.02 s. In any posture, heights down to 1e-3 of the length: all shapes of three links 1 to 5 ms, of four
/// (64 of equal plummets) 4 to 70 ms, 868 of six plummets 0.6 s, 11008 of eight 11 s.
/// No shape in any posture exists above the first critical height: with E = +-1 for the postures and D = lambda
/// diag(kappa |sec d|) > G, E D s = G s would give |E w| = |D^-1/2 G D^-1/2 w| < |w|.
/// An angular speed n gives the height g/n^2, formed in double-double.
/// Throws InvalidArgument unless exactly one of height and speed is given, positive and finite.
SteadyShapes steady_shapes(const Chain<double>& chain, const SteadyShapesOptions& options);

/// All steady shapes of a rig that whirls at a given speed, in its posture or in any: as of a chain, with a support
/// that yields or is carried round, flywheels, links in a fluid.
///
/// A support on the axis: straight shapes are left out, and of two mirror images that whose free end is at a negative
/// offset. A support carried round (a swing carousel) at radius b: every shape, outwards positive.
/// Method: that of chains; the sweep ends in  y - b - (H + W y)/(lambda E), y and H/lambda offset and pull of the
/// topmost pin, W the carriage, E the spring; with b > 0 for tangents of either sign. Pull is tension and n times
/// momentum over length. Where that is negative (a wheel against the rotation, a float) a link leans against its load:
/// it is followed along each inclination, as those links are that may have several.
/// Accuracy, cost, and `complete`: as of chains (measured: tests/cpp/finite/shapes/rigs.cpp); about twice the cost with
/// b > 0.
/// Also not complete: where one of more than some 160 links is such; and where lambda E is all the weight that moves,
/// to rounding, and a pin may be any distance away: only shapes within a million times the chain's reach or so are
/// looked for.
/// Throws InvalidArgument unless exactly one of height and speed is given, for a height or gravity not positive and
/// finite, a direction not 1 or -1, an effective tension that vanishes, and weights that move so that the lowest link
/// balances about its pin.
SteadyShapes steady_shapes(const Rig& rig, const SteadyShapesOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/shapes/steady_shapes.hpp"
#endif
