// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/rig.hpp"

/// Forced motion of a chain whose support moves on a circle or to and fro (base excitation).
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     const auto r =
///         revchain::response(chain, {.angular_speed = {2.0, 5.0}, .support_radius = 0.01});
///     r.offset(0, 0);       // 0.0145272 m: the free end at 2 rad/s, on the side of the support
///     r.reversed[1];        // 1: at 5 rad/s it is opposite to the support
///     r.modes_below[1];     // 1 mode is slower than 5 rad/s
namespace revchain::inline REVCHAIN_BUILD {

/// The motion of the support, and the requested pins. Give either `conical_height` or
/// `angular_speed`.
struct ResponseOptions {
    std::vector<double> conical_height{};      ///< of the speeds
    std::vector<double> angular_speed{};       ///< rad/s; with a flywheel of either sign
    double support_radius = 1;                 ///< of the circle, or the amplitude to and fro
    std::optional<std::vector<Index>> pins{};  ///< in any order, 0 the free end; absent: all
    double gravity = conical_pendulum::standard_gravity;  ///< for speeds and flywheels
    Index threads = 1;                                    ///< 0: all processors
    Progress* progress = nullptr;  ///< read and cancelled from another thread
};

/// Steady forced motion of small amplitude, one row for each speed. For motion to and fro they are
/// amplitudes of cos(n t).
struct Response {
    std::vector<Index> pins;
    /// (speeds, pins) positive on the side of the support; at resonance NaN, but not of the support
    Table<double> offset;
    Vector<double> error_bound;    ///< of every offset, over the largest; infinite at resonance
    Vector<Index> modes_below;     ///< slower modes, proved; without a resonant one
    std::vector<char> reversed;    ///< whether the free end is opposite to the support
    std::vector<char> resonant;    ///< whether the speed cannot be told from a resonance
    Vector<double> support_force;  ///< horizontal pull on the support (a moved spring: on its
                                   ///< far end), outwards
    Vector<double> support_force_error;  ///< bound, in the unit of the weights
};

/// Forced motion of a chain whose support is carried round a circle of radius b, after free motions
/// have died away: K y = M y / lambda with y = b at the support. For one plummet the offset is b
/// lambda / (lambda - l), Greenhill (1908) §1 (9).
///
/// Method: the dynamic stiffness of the part below a pin is carried up in double-double, with a
/// bound of its error. Speeds in doubt are computed again in interval arithmetic. Accuracy: half an
/// ulp of each offset, up to about 1e-12 from a resonance (1000 links: 1e-11); `error_bound`, which
/// is wider there, and `modes_below` are proved.
/// Results are bitwise the same for any number of threads. Cost: 20 ns for each link and speed.
/// Throws InvalidArgument if both heights and speeds are given, for a speed of 0, negative without
/// a flywheel, for numbers out of range, and for pins that do not exist. Heights (given or g/n^2)
/// must be between 2^-250 and 2^250 times the longest link's length (rounded up to a power of 2).
REVCHAIN_DECLARE
[[nodiscard]] Response response(const Chain<double>& chain, const ResponseOptions& options);

/// Returns the response of a rig. `support_radius` replaces the radius of the rig's own support. If
/// that is a spring, its rest position is carried round. Also throws InvalidArgument for springs at
/// pins, dashpots, linear drag and a trolley that rolls freely (use `forced_motion`).
REVCHAIN_DECLARE
[[nodiscard]] Response response(const Rig& rig, const ResponseOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/response.hpp"
#endif
