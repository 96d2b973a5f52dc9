// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/rig.hpp"
#include "revchain/stability.hpp"

/// Campbell diagram of a turning system: frequencies of small motion about a steady shape against
/// the speed, and the speeds at which they meet multiples of it.
///
///     const revchain::Chain<double> chair({revchain::plummet(80.0, 4.0)});  // kg, m
///     const revchain::Rig carousel(chair, {.support = revchain::carried_round(3.0)});
///     const auto found = revchain::campbell(carousel, {.angular_speed = {0.5, 1.0, 1.5}});
///     found.frequency(0, 0);              // 1.07012 rad/s: the lower frequency at 0.5 rad/s
///     found.crossings[0].angular_speed;   // 0.806850 rad/s: it meets once per turn
namespace revchain::inline REVCHAIN_BUILD {

struct CampbellOptions {
    std::vector<double> angular_speed{};  ///< rad/s, ascending; at least two
    std::vector<Index> orders{1, 2};      ///< multiples of the speed whose crossings are listed
    Index half_waves = 1;                 ///< of the shape
    StabilityFrame frame = StabilityFrame::free;
    double gravity = conical_pendulum::standard_gravity;
};

/// A speed at which a frequency meets a multiple of the speed.
struct CampbellCrossing {
    Index order;           ///< the multiple
    Index motion;          ///< number of the frequency, from 1 for the lowest
    double angular_speed;  ///< rad/s
};

/// A Campbell diagram.
struct Campbell {
    std::vector<double> angular_speed;  ///< rad/s, as given
    /// (speeds, motions) frequencies in the turning frame, rad/s, ascending; NaN where a motion
    /// does not oscillate or there is no such shape
    Table<double> frequency;
    std::vector<bool> stable;  ///< there is a shape, and its verdict is not `unstable`
    std::vector<CampbellCrossing> crossings;  ///< by order, pair of speeds, motion
};

/// The frequencies of small motion about the steady shape with `half_waves` at each speed. If
/// several shapes have this number, it is the one whose free end is farthest out. A load that is
/// constant in space, such as wind, is in resonance with a frequency that equals the speed (order
/// 1).
///
/// Method: `steady_shapes` and `stability` at each speed (with `thorough` only in programs that
/// link revchain::compiled). A crossing is found where frequency - order x speed changes sign
/// between two speeds. Two crossings of one motion between neighbouring speeds are not seen.
/// Accuracy: that of the exponents, 1e-13 of the largest; crossings 1e-12
/// (tests/cpp/campbell.cpp). Cost: a list of shapes and a stability at each speed, and at several
/// speeds for each crossing. Throws InvalidArgument unless there are two speeds or more, positive
/// and ascending, and a shape at one of them, and as `steady_shapes` and `stability`. Source: W.
/// Campbell, Trans. ASME 46 (1924).
REVCHAIN_DECLARE
[[nodiscard]] Campbell campbell(const Chain<double>& chain, const CampbellOptions& options);

/// The diagram of a rig that turns forward.
REVCHAIN_DECLARE
[[nodiscard]] Campbell campbell(const Rig& rig, const CampbellOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/campbell.hpp"
#endif
