// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>
#include <vector>

#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/rig.hpp"

/// Forced motion of small amplitude of a rig, also with dashpots, springs at pins or a trolley.
///
///     const revchain::Chain<double> chain({revchain::plummet(9.81, 1.0)});
///     const revchain::Rig rig(chain, {.pins = {{.damping = 0.2}}});  // N m s/rad
///     const auto r = revchain::forced_motion(
///         rig, {.angular_speed = {3.132}, .radius = 0.01, .gravity = 9.81});
///     std::abs(r.offset(0, 0));     // 0.156928 m: the amplitude of the free end at resonance
///     std::arg(r.offset(0, 0));     // -1.50611 rad: how far it is behind its support
namespace revchain::inline REVCHAIN_BUILD {

/// The amplitude that drives the rig: one of `radius`, `acceleration` and `force`. Without one it
/// is the radius of the rig's own support. The drive goes to and fro as cos(n t), or on a circle
/// with the speed n if the rig has momentum.
struct ForcedMotionOptions {
    std::vector<double> angular_speed{};  ///< n, rad/s, positive; with momentum of either sign
    double radius = 0;  ///< of the support's motion; of a spring's rest position if it has one
    double acceleration = 0;  ///< of the same point: the radius is -acceleration / n^2
    double force = 0;         ///< on a support that yields, in the unit of the weights
    double gravity = conical_pendulum::standard_gravity;
    Index threads = 1;             ///< 0: all processors
    Progress* progress = nullptr;  ///< read and cancelled from another thread
};

/// Steady forced motion, one row for each speed. Offsets and forces are the real parts of these
/// numbers times exp(i n t); with momentum, x + i y is the number times exp(i n t).
struct ForcedMotion {
    Table<std::complex<double>> offset;          ///< (speeds, N+1) free end first; NaN at resonance
    Vector<double> error_estimate;               ///< of every offset, over the largest; not proved
    /// Slower modes of the rig without its dashpots; a support that is moved itself is then firm.
    Vector<Index> modes_below;
    std::vector<char> resonant;                  ///< whether it cannot be told from a resonance
    Vector<std::complex<double>> support_force;  ///< pull on the support, or a spring's moved end
};

/// Forced motion, after free motions have died away: Q(i n) q = load with the matrices of
/// `damped_modes`. The support's own dashpot acts on its velocity over the ground.
///
/// Method: elimination of the links' rotations, one after the other, in complex double words,
/// corrected twice. Accuracy measured for random rigs (tests/cpp/forced_motion.cpp): 1.6e-16 of the
/// largest offset; at most 1 % of the errors exceed ten times `error_estimate`. Cost: 2
/// microseconds for each link and speed.
/// Throws InvalidArgument unless one of radius, acceleration and force is given or the rig's own
/// support has a radius, for speeds of 0, negative speeds without momentum, a force on a firm
/// support, dashpots in a fluid that turns, and numbers out of range.
REVCHAIN_DECLARE
[[nodiscard]] ForcedMotion forced_motion(const Rig& rig, const ForcedMotionOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/forced_motion.hpp"
#endif
