// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "revchain/explain.hpp"
#include "revchain/finite/cord/continuous_chain.hpp"
#include "revchain/modes.hpp"
#include "revchain/swing.hpp"
#include "revchain/system/cord.hpp"
#include "revchain/tune.hpp"

/// A perfectly flexible cord hung from one end: the continuous limit of a chain. It needs GSL.
///
///     const revchain::Cord cord(0.36);                           // m; uniform
///     const auto m = revchain::modes(cord, {.count = 3});
///     m.angular_speed()[0];                                      // 6.27571 rad/s
///     m.offset(1, 0.18);                                         // -0.401734: second mode, 0.18 m from the free end
///     m.nodes(2)[0];                                             // 0.0278012 m from the free end: the lower node
///     m.vertical_points(2)[0];                                   // 0.0705798 m: the lower point that is vertical
///     const auto shapes = revchain::steady_shapes(cord, {.angular_speed = 20.0});
///     shapes.shapes.size();                                      // 2 shapes at finite amplitude: all there are
///     const revchain::Cord line(2.0, {.weight = 0.5, .density = 1.0, .tip_weight = 3.0});   // thicker towards the top
///
/// Arc lengths are measured from the free end. `CordOptions` (system/cord.hpp) has the weight, the density (a power of
/// the arc length, or a function of it) and a tip weight. `steady_shapes` and what it returns are in
/// finite/cord/continuous_chain.hpp, which needs no GSL. For a cord held at both ends see `Held` (held.hpp).
/// The closed forms: special/heavy_chain.hpp, special/tapered_chain.hpp, special/tip_mass.hpp.
/// Greenhill (1908) section 4.
namespace revchain {

/// Whirl modes of a cord, slowest first. The k-th slowest mode is at index k - first.
struct CordModes {
    Cord cord;
    Index first = 1;                  ///< number of the slowest mode here
    Vector<double> conical_height{};  ///< (k,) lambda, descending, in the unit of the length
    Vector<double> error_bound{};     ///< (k,) relative; measured to hold (see `modes`)
    std::string method{};             ///< that found the heights
    Status status = Status::success;  ///< whether `rtol` is met

    Index size() const { return conical_height.size(); }
    ModeRange range() const { return {first, size()}; }
    /// Offset of the mode at index j at arc length s, divided by that of the free end. Throws InvalidArgument for s not
    /// in 0 ... length. Cost: 1 to 15 microseconds, 100 with a density function; for a vector of s much less per place.
    double offset(Index j, double s) const;
    Vector<double> offset(Index j, const Vector<double>& s) const;
    /// d offset / ds, -1 / lambda at the free end. Throws and costs as `offset`.
    double slope(Index j, double s) const;
    Vector<double> slope(Index j, const Vector<double>& s) const;
    /// Arc lengths at which the mode at index j crosses the axis, ascending, without the support.
    Vector<double> nodes(Index j) const;
    /// Arc lengths at which it is vertical, one above each node, ascending: what hangs below has its centre of gravity
    /// on the axis.
    Vector<double> vertical_points(Index j) const;
    /// n = sqrt(g / lambda), rad/s.
    Vector<double> angular_speed(double gravity = conical_pendulum::standard_gravity) const;
    /// Seconds for one revolution.
    Vector<double> period(double gravity = conical_pendulum::standard_gravity) const;
};

/// The modes chosen by `options`: by `first` and `count` (absent: ten) or by a window of heights or speeds that holds
/// finitely many.
///
/// Methods and accuracy: a uniform cord has lambda_k = 4 L / j_{0,k}^2, to 3 ulp; one whose density goes like s^p has
/// 4 (p + 1) L / j_{p,k}^2, to 3 ulp; a uniform cord with a tip weight has the zeros of a cross product of Bessel
/// functions, to 2 ulp. All others are solved by power series, to 4e-15 (tests/cpp/cord.cpp). `error_bound` says the
/// same; it was measured, for exponents from -0.99 to 100. Offsets are within 1e-15 times the mode number, with series
/// within 1e-14, of the largest one; slopes likewise.
/// Cost: a closed form takes 0.01 to 15 microseconds a mode. Power series take 1 ms for each mode up to the last one
/// wanted.
/// Throws InvalidArgument as `modes` of a chain does, for `all_modes` (there are infinitely many), for `certify`, for
/// modes above number 1e5 with series, and for a density too rough or a tip too heavy for the series. `method` and
/// `other` of the options have no effect.
CordModes modes(const Cord& cord, const ModesOptions<double>& options = {});

/// The number of modes slower than a speed. Heights within `CordModes::error_bound` of the one given may be counted on
/// either side. Cost: that of some 40 modes, with series one path.
/// Throws InvalidArgument unless exactly one of height and speed is given, positive and finite, for more than 1e15
/// modes, and with series for a length above 1e6 heights.
Index count_modes(const Cord& cord, const CountOptions<double>& options);

/// Throw InvalidArgument: these questions about a cord have no answer yet. The message says what to ask instead.
Swing swing(const Cord& cord, const SwingOptions& options);
Tuned tune(const Cord& cord, const TuneOptions& options);
Explanation explain(const Cord& cord, const ModesOptions<double>& options = {});

}  // namespace revchain

#include "revchain/analytic/cord.hpp"
