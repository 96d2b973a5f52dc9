// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>
#include <string_view>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"

/// Stability of a steady shape: whether a small disturbance grows.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 1.0)});
///     const auto found = revchain::steady_shapes(chain, {.conical_height = 0.5});   // steady_shapes.hpp
///     const auto s = revchain::stability(chain, found.shapes[0]);
///     s.verdict == revchain::Verdict::minimum;   // true
///     s.exponents.back().imag();                 // 1.32288: it swings with 1.32288 times the turning speed
namespace revchain {

struct SteadyShape;  // revchain/steady_shapes.hpp
struct HeldShape;    // revchain/held.hpp
class Rig;           // revchain/rig.hpp

/// How a chain can move when it is disturbed.
enum class StabilityFrame {
    free,    ///< ball joints, no torque about the axis: it moves in and out of the plane of the shape
    driven,  ///< hinges in a plane that a motor turns at constant speed: it moves in that plane only
};

/// What becomes of a small disturbance of a steady shape.
enum class Verdict {
    minimum,            ///< the energy in the turning frame (free: at fixed angular momentum) is least: it stays small
    spectrally_stable,  ///< the energy is not least, but gyroscopic forces keep it from growing, to first order
    unstable,           ///< it grows
    undecided,          ///< the errors of the exponents leave it open
};
inline std::string_view to_string(Verdict verdict) {
    constexpr std::string_view names[]{"minimum", "spectrally stable", "unstable", "undecided"};
    return names[static_cast<std::size_t>(verdict)];
}

/// Stability of one shape. Exponents, growth rate and margin are over the turning speed n: times n they are in 1/s.
struct Stability {
    StabilityFrame frame = StabilityFrame::free;
    Verdict verdict = Verdict::undecided;
    std::vector<std::complex<double>>
        exponents;                  ///< s of exp(s n t), by imaginary part; free: without the double 0 of a rotation
    double growth_rate = 0;         ///< largest real part of an exponent; at least 0; NaN: not known
    double margin = 0;              ///< a growth rate up to this may be rounding error
    Index negative_directions = 0;  ///< negative eigenvalues of the energy's Hessian (free: amended, no rotation)
    /// The effect of a small damping c on each exponent, to first order: times g c it is added to the real part of s n.
    /// NaN where two exponents coincide. Internal: c is the moment at every pin over the rate at which its links turn
    /// against one another, seen from the turning chain; in 1/(weight length^2). External: c is the drag of still air
    /// on a link over its length and its velocity in space; in length/weight.
    std::vector<double> internal_damping, external_damping;
};

/// Returns what becomes of a small disturbance of a steady shape of `chain`.
///
/// A rotation of the shape about the axis does not change the energy. In the free frame constant angular momentum
/// removes it: this adds 4 b b' / (y0'M y0) to the stiffness in the plane, with b = B y0, y0 the shape's offsets, M the
/// mass matrix and B the gyroscopic coupling. So no double zero blurs the exponents. Links are rods without inertia
/// about their own axes. N links have 4 N - 2 exponents if free, 2 N if driven; fewer where links have no weight,
/// because two links that meet in a pin without mass stay in line.
/// No damping is modelled in exponents and verdict. What is a minimum stays stable with friction at the pins. What is
/// only spectrally stable is held by gyroscopic forces: friction makes the motions of negative energy grow (Kelvin,
/// Tait, Chetaev; Merkin 1997, Kirillov 2013). `internal_damping` and `external_damping` say what grows, to first
/// order; what balances the mean drag of the air counts in second order only. Drag in proportion to mass, in place of
/// length, would add -1/2 of drag over mass to each growth rate, whatever the shape.
/// Accuracy: exponents to about 1e-13 of the largest where they are simple. Cost (4 N)^3/2: 0.5 ms for 20 links, 4 ms
/// for 40, less where every motion out of the plane has positive energy. N = 1: omega = n sqrt(1 + 3 cos^2 d) free,
/// n sin d driven (section 7 (6)).
/// Throws InvalidArgument if chain and shape differ in the number or the lengths of links; weights are not compared.
Stability stability(const Chain<double>& chain, const SteadyShape& shape, StabilityFrame frame = StabilityFrame::free);

/// Returns what becomes of a small disturbance of a shape with both ends held. Firm ends stay where they are, those on
/// springs move across the axis. N links have 4 N - 8 exponents if free, 2 N - 4 if driven, in units of n, with and
/// without gravity; each end on a spring adds 4, or 2. Arms turn at a constant speed: between ends off the axis no
/// rotation is free, and there are 2 more if free.
/// Accuracy: exponents to 1e-13 of the largest where simple (tests/cpp/finite/stability/held.cpp). Cost (4 N)^3/2.
/// Throws InvalidArgument as above, and for a pin that moves and carries no mass, but for the upper end.
Stability stability(const Chain<double>& chain, const HeldShape& shape, StabilityFrame frame = StabilityFrame::free);

/// How a rig is disturbed, and how the shape of it was found.
struct RigStabilityOptions {
    StabilityFrame frame = StabilityFrame::free;
    int direction = 1;                                    ///< of rotation, 1 or -1: it matters to flywheels
    double gravity = conical_pendulum::standard_gravity;  ///< it matters to flywheels
};

/// Returns what becomes of a small disturbance of a steady shape of `rig`; exponents, damping, accuracy and cost as of
/// a chain.
///
/// A support on the axis, firm or not, passes no torque about it in the free frame: angular momentum is kept, as that
/// of a chain. One that is carried round keeps its speed, and no rotation is left out: N links have 4 N exponents, the
/// energy is that in the frame that turns at this speed. A support that yields is free to move to either side (driven:
/// in the plane), which adds 4 exponents (2); where it and the link below have no mass at that pin, out of the plane it
/// has none.
/// Free, each link keeps the angular momentum about its own axis, its wheel's included, on free bearings or driven:
/// ball joints pass no torque along a link. Driven, the links turn with the plane, and wheels on free bearings keep
/// theirs.
/// Still fluid: buoyancy and added mass, in every direction of motion.
/// Fluid that turns: how it moves around a disturbed link (inertial waves, which depend on its walls) is not modelled,
/// so that there are no exponents. The energy says whether a shape is a minimum, at constant speed and but for a
/// rotation; it is then stable in any fluid, viscous or not. Else the verdict is undecided, and the growth rate NaN.
/// Throws InvalidArgument as above; for a pin or a motion without mass, unless the fluid turns; for a flywheel that
/// acts on a massless upper end.
Stability stability(const Rig& rig, const SteadyShape& shape, const RigStabilityOptions& options = {});

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/stability/stability.hpp"
#endif
