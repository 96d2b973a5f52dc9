// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/rig.hpp"

/// The steady shape of a chain that an arm carries round through still air.
///
///     const revchain::Chain<double> chain({revchain::plummet(9.81, 2.0)});  // N, m
///     const revchain::Rig rig(chain, {.support = revchain::carried_round(1.5)});
///     const revchain::Drag air{.coefficient = {0.5}, .area = {0.05}};  // a ball of 1 kg
///     const auto shape = revchain::drag_shape(rig, air, {.angular_speed = 2.0, .gravity = 9.81});
///     shape.azimuth[0];  // -0.0954557 rad: the thread trails behind the plane of the arm
///     shape.torque;      // 1.75025 N m to keep the arm turning
namespace revchain::inline REVCHAIN_BUILD {

/// Quadratic air drag on links. Each list has one number for each link, lowest first, or one for
/// all, or is empty (0). With weights in newtons, lengths are in m and the density in kg/m^3.
struct Drag {
    std::vector<double> coefficient{};  ///< C of the link as a cylinder, and of the body at it
    /// d: the link is a cylinder. Drag per length is density/2 C d |v| v, with v the part of its
    /// velocity across the link.
    std::vector<double> diameter{};
    /// A: a body at the link's centre of gravity. Its drag is density/2 C A |v| v, v its velocity.
    std::vector<double> area{};
    std::vector<double> body_coefficient{};  ///< C of the bodies; empty: `coefficient`
    double density = 1.225;                  ///< of the air
};

struct DragShapeOptions {
    double angular_speed = 0;  ///< rad/s, negative: backward
    /// Number of half waves of a shape without drag, from which the drag then grows. If left out,
    /// the chain starts at rest, and its speed grows in the air.
    std::optional<int> half_waves{};
    double gravity = conical_pendulum::standard_gravity;
};

enum class DragStatus {
    success,
    fold,     ///< the way there turns back at the factor reached, and is not found to lead on
    stalled,  ///< the continuation could not go on, or took 3000 steps, and met no fold
};

inline std::string_view to_string(DragStatus status) {
    return status == DragStatus::success ? "success"
           : status == DragStatus::fold  ? "fold"
                                         : "stalled";
}

/// A rigid figure that turns about the vertical through air at rest. Coordinates are in the turning
/// frame: x outward through the support (through a spring's rest position, if it has one), y in the
/// sense of the motion, z up from the support.
struct DragShape {
    Table<double> position;      ///< (N + 1, 3) of the pins, free end first, support last
    Vector<double> inclination;  ///< (N) of each link to the downward vertical, 0 to pi, rad
    /// (N) direction in which each link leads away from its upper pin, from outward (x) towards the
    /// sense of motion, in (-pi, pi], rad; negative: the link trails
    Vector<double> azimuth;
    Vector<double> tension;  ///< (N) magnitude of the reaction at each link's upper pin
    double torque = 0;       ///< about the axis, in the sense of motion; weight times length
    double power = 0;        ///< torque times speed
    /// 1 if `status` is success. Else the shape is that with this share of the drag; from rest,
    /// with this share of the squared speed.
    double factor = 0;
    double residual = 0;        ///< largest unbalanced moment over (weight times length)
    double error_estimate = 0;  ///< of the direction of each link, rad
    DragStatus status = DragStatus::stalled;
    int folds = 0;  ///< where the way turned, back or forth; a shape that follows it would jump
    int steps = 0;  ///< of the continuation
};

/// The steady shape of a rig whose support is carried round, with drag of still air on its links.
/// The force on the support balances the moment of the drag about the axis, so the support must be
/// off the axis.
///
/// Method: continuation along the arc. From rest, the square of the speed grows from 0, and the
/// drag with it. With `half_waves`, the shape of `steady_shapes` whose free end is farthest out is
/// followed while a factor of the drag grows from 0 to 1. Newton's method for the directions of the
/// links has the exact derivative. Drag is integrated along each link by Gauss's rule. Folds on the
/// way are followed round. If the way then leads no further, the status is `fold` and the shape
/// that at the first fold; without a fold it is `stalled`. Other shapes may exist. `error_estimate`
/// is the change by a rule of more points, and rounding. Accuracy measured
/// (tests/python/test_drag.py): one link within 2e-15 rad of 40 digits; of 10,000 random chains 99
/// % within 1e-14 rad, all within 3e-13 rad, by a step of Newton's method in other coordinates.
/// Drag of the arm is not included. Source of the drag across a cylinder: Hoerner, Fluid-Dynamic
/// Drag (1965), 3-11 (cross-flow principle). Cost: O(N) for each step of the continuation
/// (`DragShape::steps`). Throws InvalidArgument for a speed of 0, a support on the axis, a fluid
/// that turns, springs at pins, linear drag (`Rigging::drag`), a dashpot at the support, a trolley
/// that rolls freely, lists of another length, numbers out of range and weights more than 1e123
/// apart; with `half_waves` also if there is no such shape, and as `steady_shapes`.
REVCHAIN_DECLARE
[[nodiscard]] DragShape drag_shape(const Rig& rig, const Drag& drag,
                                   const DragShapeOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/drag.hpp"
#endif
