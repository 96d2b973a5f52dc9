// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <variant>
#include <vector>

#include "revchain/finite/cord/continuous_chain.hpp"
#include "revchain/finite/cord/diagram.hpp"
#include "revchain/finite/cord/shape_on_branch.hpp"
#include "revchain/held.hpp"
#include "revchain/modes.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/stability.hpp"
#include "revchain/system/cord.hpp"

/// A perfectly flexible cord hung from one end: the continuous limit of a chain. It needs GSL.
///
///     const revchain::Cord cord(0.36);                           // m; uniform
///     const auto m = revchain::modes(cord, {.count = 3});
///     m.angular_speed()[0];                                      // 6.27571 rad/s
///     m.offset(1, 0.18);                   // -0.401734: second mode, 0.18 m from the free end
///     m.nodes(2)[0];                       // 0.0278012 m from the free end: the lower node
///     m.vertical_points(2)[0];             // 0.0705798 m: the lower point that is vertical
///     const auto shapes = revchain::steady_shapes(cord, {.angular_speed = 20.0});
///     shapes.shapes.size();                // 2 shapes at finite amplitude: all there are
///     const revchain::Cord line(2.0, {.weight = 0.5, .density = 1.0, .tip_weight = 3.0});
///
///     const revchain::Cord clasped(1.8, {.weight = 0.177, .weights = {{1.2173, 2.94}}});
///
/// Arc lengths are measured from the free end. `CordOptions` has the weight, the density, particles
/// on the cord, and a particle or a bob at its end. `steady_shapes` and its results are declared in
/// finite/cord/continuous_chain.hpp, which needs no GSL. For a cord held at both ends see `Held`
/// (held.hpp). Greenhill (1908) §4.
namespace revchain::inline REVCHAIN_BUILD {

/// Whirl modes of a cord, slowest first. Mode k is at index k - first. For a cord held straight at
/// both ends the arc begins at its lower end.
struct CordModes {
    Cord cord;
    Index first = 1;                  ///< number of the slowest mode here
    Vector<double> conical_height{};  ///< (k,) lambda, descending, in the unit of the length
    Vector<double> error_bound{};     ///< (k,) relative; measured to hold (see `modes`)
    std::string method{};             ///< that found the heights
    Status status = Status::success;  ///< whether `rtol` is met
    std::optional<HeldBy> held{};     ///< absent: the cord hangs

    Index size() const noexcept { return conical_height.size(); }
    ModeRange range() const { return {first, size()}; }
    /// Offset of the mode at index j at arc length s, divided by that of the free end, or between
    /// held ends by the largest offset. Throws InvalidArgument for s not in 0 ... length. Cost: 0.1
    /// to 2 microseconds for each of many s.
    [[nodiscard]] double offset(Index j, double s) const;
    [[nodiscard]] Vector<double> offset(Index j, const Vector<double>& s) const;
    /// d offset / ds; at a particle, above it. Throws and costs as `offset`.
    [[nodiscard]] double slope(Index j, double s) const;
    [[nodiscard]] Vector<double> slope(Index j, const Vector<double>& s) const;
    /// d offset / ds along the bob. Throws InvalidArgument for a cord without one.
    [[nodiscard]] double bob_slope(Index j) const;
    /// Arc lengths at which the mode at index j crosses the axis, ascending. Held ends are not
    /// listed.
    [[nodiscard]] Vector<double> nodes(Index j) const;
    /// Arc lengths at which the mode is vertical, or turns back at a particle, ascending. Where a
    /// hanging cord is vertical, the part below has its centre of gravity on the axis.
    [[nodiscard]] Vector<double> vertical_points(Index j) const;
    /// n = sqrt(g / lambda), rad/s.
    Vector<double> angular_speed(double gravity = conical_pendulum::standard_gravity) const;
    /// Seconds for one revolution.
    [[nodiscard]] Vector<double> period(double gravity = conical_pendulum::standard_gravity) const;
};

/// Selects modes of a cord, as `ModesOptions` does.
struct CordModesOptions {
    Index first = 1;
    std::optional<Index> count{};
    std::optional<HeightWindow<double>> conical_height{};
    std::optional<SpeedWindow<double>> angular_speed{};
    std::optional<double> rtol{};  ///< larger bounds give `Status::tolerance_not_met`
    double gravity = conical_pendulum::standard_gravity;  ///< for windows, and if weightless
    Progress* progress = nullptr;
};

/// The modes chosen by `first` and `count` (absent: ten), or by a window that holds finitely many.
///
/// Method and accuracy: closed forms are lambda_k = 4 L / j_{0,k}^2 for a uniform cord and 4 (p +
/// 1) L / j_{p,k}^2 for a density s^p, to 3 ulp, and zeros of a cross product of Bessel functions
/// for a uniform cord with a tip weight, to 2 ulp. Others use power series, to 4e-15
/// (tests/cpp/cord.cpp). `error_bound` has these figures, measured for exponents from -0.99 to 100.
/// It is larger for a density function that jumps; with particles or a bob it is mostly below 1e-14
/// (tests/cpp/cord_particles.cpp). Offsets and slopes are within 2e-15 times the mode number of the
/// largest one, with series within 1e-14 for the first 7 modes, with particles or a bob within
/// 1e-11. Cost: closed forms take 0.04 to 8 microseconds a mode; power series mostly take
/// 0.2 to 2 ms for each mode up to the last one requested. Throws InvalidArgument as `modes` of a
/// chain, for `all_modes`, and with series for modes above number 1e5, a density too rough or a tip
/// too heavy.
REVCHAIN_DECLARE_ANALYTIC
[[nodiscard]] CordModes modes(const Cord& cord, const CordModesOptions& options = {});

/// The number of modes slower than a speed. Heights within `CordModes::error_bound` of the given
/// one may be counted on either side. Cost: that of some modes. Throws InvalidArgument unless
/// exactly one of height and speed is given, for more than 1e15 modes, and with series for a length
/// above 1e6 heights.
REVCHAIN_DECLARE_ANALYTIC
[[nodiscard]] Index count_modes(const Cord& cord, const CountOptions<double>& options);

/// Modes of a uniform cord that a tension holds straight between two points of the axis, and how
/// many are slower than a speed. Without gravity a height is `CordModesOptions::gravity` over the
/// square of the speed: the modes are those of a string, n = k pi sqrt(tension / (mass length)).
///
/// Method: zeros of a cross product of Bessel functions. Accuracy: 2 ulp (tests/cpp/cord.cpp);
/// offsets within 1e-15 times the mode number of the largest one. Cost: as with a tip weight.
/// Throws InvalidArgument for a span, with gravity for a tension that does not exceed the weight,
/// and as for a hanging cord.
REVCHAIN_DECLARE_ANALYTIC
[[nodiscard]] CordModes modes(const Held<Cord>& held, const CordModesOptions& options = {});
REVCHAIN_DECLARE_ANALYTIC
[[nodiscard]] Index count_modes(const Held<Cord>& held, const CountOptions<double>& options);

/// d(conical height)/d(datum) of each mode, (k,), all else constant; dn = -n/(2 lambda) dlambda.
struct CordSensitivity {
    Index first = 1;
    Vector<double> length;      ///< of the whole cord; density and particles stretch with it
    Vector<double> weight;      ///< of the cord without tip and particles; its distribution is
                                ///< constant
    Vector<double> tip_weight;  ///< 0 for a cord held at both ends
    Table<double> weights;      ///< (k, n) of each particle, from the free end
    Vector<double> exponent;    ///< of the density, at constant weight; NaN for a density function,
                                ///< 0 for a cord held at both ends
    Vector<double> tension;     ///< at the upper end; 0 for a cord that hangs
};

/// Derivatives of the heights of the modes with respect to the data of their cord. A change dV of
/// the weight below a point, tip included, changes
///     lambda = integral of y^2 dV / I   by   - integral of dV y' (2 y + lambda y') / I,
/// where I = integral of V y'^2. Accuracy: 1e-12 of the height over the datum; 2e-9 for a power
/// with a tip (tests/python/test_held_cord.py). Cost: that of some hundred offsets and slopes a
/// mode. Throws InvalidArgument for a cord with a bob.
REVCHAIN_DECLARE_ANALYTIC
[[nodiscard]] CordSensitivity sensitivity(const CordModes& modes);

/// The branch of steady shapes that leaves the vertical at a mode, followed through folds to the
/// conical height or speed given.
///
/// Method: arc continuation in the free end's inclination and the conical height. Each step is
/// checked, not proved (finite::BranchLineWalk). Accuracy: points within 1e-12; heights of folds
/// within 1e-9, relative (tests/cpp/cord_branches.cpp). Cost: a few paths a point
/// (`steady_shapes`).
/// Throws InvalidArgument for a bob, a mode number below 1 or above 1e5, a height not below that of
/// the mode, a length above 1e6 heights, and unless exactly one of height and speed is given.
REVCHAIN_DECLARE_ANALYTIC
[[nodiscard]] CordBranch branch(const Cord& cord, const BranchOptions& options);

/// Sets how far to follow branches of a cord. Give either `min_conical_height` or
/// `max_angular_speed`.
struct CordDiagramOptions {
    std::optional<double> min_conical_height{};
    std::optional<double> max_angular_speed{};  ///< rad/s, with `gravity`
    std::size_t max_points = 10'000;            ///< of each branch
    double max_step = 0.1;                      ///< along the arc
    int lists = 16;  ///< number of heights, evenly spaced in the logarithm, with a list of shapes
    double gravity = conical_pendulum::standard_gravity;
};

/// The branches of the modes down to the conical height or speed given, and isolated ones found.
///
/// Method: `branch` from every mode. If no theorem counts the shapes, lists of shapes
/// (`steady_shapes`) at `lists` heights are compared with the branches. A shape that no branch
/// passes lies on an isolated branch, which is followed to its end. `complete` is true if all
/// branches reach the end and a theorem counts the shapes (finite/cord/continuous_chain.hpp).
/// Accuracy: as `branch`. Throws InvalidArgument for a bob, a length above 1e6 heights, `lists`
/// below 1, and unless exactly one of height and speed is given.
REVCHAIN_DECLARE_ANALYTIC
[[nodiscard]] CordBranches branches(const Cord& cord, const CordDiagramOptions& options);

/// The first shape along the branch of a mode at which one number has its given value, as for a
/// chain.
///
/// Accuracy: the shape is within its `error_bound`, an estimate, of the exact one at its conical
/// height. That height is the given one, or within 1e-12 of the one at which the number is reached
/// (tests/cpp/cord_branches.cpp), less accurate where the number hardly changes with the height.
/// Cost: as `branch`. Throws as for a chain, and for a bob.
REVCHAIN_DECLARE_ANALYTIC
[[nodiscard]] CordShape steady_shape(const Cord& cord, const OnBranchOptions& options);

/// The shapes on the branch at which the number has its given value, at most `max_shapes`. The list
/// is empty if the number is not reached. Otherwise as `steady_shape`.
REVCHAIN_DECLARE_ANALYTIC
[[nodiscard]] CordShapesOnBranch shapes_on_branch(const Cord& cord, const OnBranchOptions& options,
                                                  std::size_t max_shapes = all_shapes);

/// The stability of a steady shape of a cord that hangs, or is held at both ends.
///
/// Method: Galerkin's, with polynomials on panels, once with 8 and once with 10 nodes a panel.
/// `exponents` are those of infinitely many that are smaller than the first on which the two
/// results differ by more than 1e-6 of its size. `margin` covers the difference of the two growth
/// rates; near it the verdict is `undecided`. Only finitely many directions have negative energy,
/// so the omitted motions of high frequency do not grow. `internal_damping` is NaN: a cord has no
/// stiffness in bending. `external_damping` is as for a chain. Accuracy: exponents to 1e-8
/// (measured against the modes, 1e-9 below a critical speed; with a tip to 2e-9 against long
/// chains: tests/python/test_cord_branches.py). Cost: that of a chain with 10 links a panel. Throws
/// InvalidArgument if the lengths differ.
REVCHAIN_DECLARE
[[nodiscard]] Stability stability(const Cord& cord, const CordShape& shape,
                                  StabilityFrame frame = StabilityFrame::free);
REVCHAIN_DECLARE
[[nodiscard]] Stability stability(const Cord& cord, const HeldCordShape& shape,
                                  StabilityFrame frame = StabilityFrame::free);

/// The offsets or velocities of a cord at time 0; 0 at the support. They are absent (all 0), values
/// at `CordSwingOptions::arc_length` and linear between them, or a continuous function of the arc
/// length.
using CordStart = std::variant<std::monostate, Vector<double>, std::function<double(double)>>;

/// The start of a swing, and the times and arc lengths of its results.
struct CordSwingOptions {
    CordStart offset{};           ///< at time 0
    CordStart velocity{};         ///< at time 0
    std::vector<double> time{};   ///< of either sign, in any order
    Vector<double> arc_length{};  ///< ascending, 0 (free end) ... length; empty: 101, equal steps
    Index count = 40;             ///< of the slowest modes that are superposed
    double gravity = conical_pendulum::standard_gravity;
    Progress* progress = nullptr;
};

/// A cord swinging in a plane with small amplitude: the sum of its modes.
struct CordSwing {
    Vector<double> arc_length;         ///< (n) of the offsets
    Table<double> offset, velocity;    ///< (times, n) sums of `count` modes
    Vector<double> angular_frequency;  ///< (k,) w = sqrt(g / lambda), ascending
    Vector<double> energy;             ///< (k,) of each mode, weight times length; constant
    Table<double> shape;               ///< (k, n) of each mode, 1 at the free end
    Vector<double> cosine, sine;       ///< (k,) offset = sum of shape (cosine cos wt + sine sin wt)
    double energy_left_out = 0;        ///< of the start, in all other modes
    Vector<double> error_estimate;     ///< (n) of an offset at any time, from modes up to 2 k
};

/// Small oscillations of a cord in a plane after release, superposed from the modes of `modes`.
///
/// `error_estimate` is extrapolated from the contributions of modes up to 2 k. After a kink in a
/// uniform cord without a tip, convergence at the free end is slow, as k^-1/2.
/// Accuracy, measured against long chains (tests/cpp/cord_branches.cpp): coefficients to 1e-13 of
/// the largest, angles to rounding, 1e-15 times the number of swings. Cost: offsets of 2 k modes at
/// several hundred arc lengths.
/// Throws InvalidArgument for a bob, unless starts are continuous, of the length of `arc_length`
/// and 0 at the support, for arc lengths out of order, and a count above 1e4.
REVCHAIN_DECLARE_ANALYTIC
[[nodiscard]] CordSwing swing(const Cord& cord, const CordSwingOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/stability/cord.hpp"
#endif
#if !defined(REVCHAIN_COMPILED_ANALYTIC)
#include "revchain/analytic/cord.hpp"
#include "revchain/analytic/cord_sensitivity.hpp"
#include "revchain/analytic/cord_swing.hpp"
#endif
