// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>
#include <string_view>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/thorough.hpp"

/// Stability of a steady shape: whether a small disturbance grows.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 1.0)});
///     const auto found = revchain::steady_shapes(chain, {.conical_height = 0.5});
///     const auto s = revchain::stability(chain, found.shapes[0]);
///     s.verdict == revchain::Verdict::minimum;   // true
///     s.exponents.back().imag();                 // 1.32288 times the turning speed
namespace revchain::inline REVCHAIN_BUILD {

struct SteadyShape;  // revchain/steady_shapes.hpp
struct HeldShape;    // revchain/held.hpp
class Rig;           // revchain/rig.hpp

/// How a chain can move when it is disturbed.
enum class StabilityFrame {
    free,    ///< ball joints, no torque about the axis: motion in and out of the shape's plane
    driven,  ///< hinges in a plane that turns at constant speed: motion in that plane only
};

/// Whether a small disturbance of a steady shape grows.
enum class Verdict {
    minimum,            ///< it stays small: the energy is least (free: at fixed angular momentum)
    spectrally_stable,  ///< no minimum, but gyroscopic forces keep it from growing, to first order
    unstable,           ///< it grows
    undecided,          ///< unknown: within the errors of the exponents, or in a fluid that turns
};
[[nodiscard]] inline std::string_view to_string(Verdict verdict) noexcept {
    constexpr std::string_view names[]{"minimum", "spectrally stable", "unstable", "undecided"};
    return names[static_cast<std::size_t>(verdict)];
}

/// Stability of one shape. Exponents, growth rate and margin are in 1/s after multiplication by the
/// turning speed n.
struct Stability {
    StabilityFrame frame = StabilityFrame::free;
    Verdict verdict = Verdict::undecided;
    /// s of exp(s n t), by imaginary part; if free, without the double 0 of a rotation
    std::vector<std::complex<double>> exponents;
    std::vector<double> exponent_error;  ///< of each, estimated with errors of shape and pulls
    double growth_rate = 0;  ///< largest real part of an exponent, at least 0; NaN if unknown
    double margin = 0;       ///< the largest `exponent_error`; of a cord see cord.hpp
    /// negative eigenvalues of the energy's Hessian; if free, amended, without the rotation
    Index negative_directions = 0;
    /// The effect of a small damping c on each exponent, to first order: this number times g c is
    /// added to the real part of s n. NaN if two exponents coincide. Internal: c is the moment at a
    /// pin over the relative angular velocity of its links in the turning frame; 1/(weight
    /// length^2). External: c is drag of still air on a link over its length and velocity;
    /// length/weight.
    std::vector<double> internal_damping, external_damping;
};

/// Returns the stability of a steady shape of `chain`.
///
/// A rotation of the shape about the axis does not change the energy. In the free frame the
/// constant angular momentum removes it, so that no double zero makes the exponents inaccurate. 4 b
/// b' / (y0'M y0) is added to the stiffness in the plane, where b = B y0, y0 are the shape's
/// offsets, M is the mass matrix and B the gyroscopic coupling. Links are rods without inertia
/// about their own axes. N links have 4 N - 2 exponents if free, 2 N if driven; fewer with massless
/// links, because two links that meet in a pin without mass stay in line. N = 1: n sqrt(1 + 3 cos^2
/// d) free, n sin d driven, §7 (6). Exponents and verdict contain no damping. A minimum stays
/// stable with friction at the pins. A shape that is only spectrally stable is held by gyroscopic
/// forces: friction makes the motions of negative energy grow (Kelvin, Tait, Chetaev; Merkin 1997,
/// Kirillov 2013). `internal_damping` and `external_damping` tell which motions grow, to first
/// order; the torque that balances the mean drag has an effect of second order only. Drag in
/// proportion to mass instead of length adds -1/2 of drag over mass to each growth rate, for any
/// shape. Accuracy: simple exponents to about 1e-13 of the largest; `exponent_error` estimates each
/// error, and a verdict within it is `undecided`. If double loses digits, as with masses far apart,
/// shapes of up to 50 links are computed with twice the digits if `thorough` is given, or in
/// programs that link revchain::compiled. With masses 1e16 apart errors are then at most 2e-13 of
/// the largest in the tests, on arms and springs 5e-9, because the shape is given in double
/// (tests/python/test_light_links.py). Cost: O(N^3), 0.4 ms for 20 links and 2 ms for 40; less if
/// every motion out of the plane has positive energy, much more with twice the digits.
/// Throws InvalidArgument if numbers or lengths of links differ (weights are not compared), and if
/// rounding leaves in doubt whether every motion moves mass (with `thorough` less often).
REVCHAIN_DECLARE
[[nodiscard]] Stability stability(const Chain<double>& chain, const SteadyShape& shape,
                                  StabilityFrame frame = StabilityFrame::free);
REVCHAIN_DECLARE
[[nodiscard]] Stability stability(const Chain<double>& chain, const SteadyShape& shape,
                                  StabilityFrame frame, Thorough);

/// Returns the stability of a shape with both ends held. Firm ends are fixed; ends on springs move
/// across the axis. N links have 4 N - 8 exponents if free, 2 N - 4 if driven, with or without
/// gravity; each end on a spring adds 4, or 2; an upper one that moves no mass adds 2. Arms turn
/// at constant speed: if an end is off the axis no rotation is removed, which adds 2 exponents if
/// free. Accuracy: simple exponents to 1e-13 of the largest (tests/cpp/finite/stability/held.cpp).
/// Cost: O(N^3). Throws InvalidArgument as above, and for a massless moving pin below the upper
/// end.
REVCHAIN_DECLARE
[[nodiscard]] Stability stability(const Chain<double>& chain, const HeldShape& shape,
                                  StabilityFrame frame = StabilityFrame::free);
REVCHAIN_DECLARE
[[nodiscard]] Stability stability(const Chain<double>& chain, const HeldShape& shape,
                                  StabilityFrame frame, Thorough);

/// Returns the stability in the free frame, computed with `thorough`.
template <class Shape>
[[nodiscard]] Stability stability(const Chain<double>& chain, const Shape& shape, Thorough) {
    return stability(chain, shape, StabilityFrame::free, thorough);
}

/// The frame of the disturbance, and the direction and gravity with which the shape was found.
struct RigStabilityOptions {
    StabilityFrame frame = StabilityFrame::free;
    Rotation direction = Rotation::forward;               ///< for flywheels
    double gravity = conical_pendulum::standard_gravity;  ///< for flywheels
};

/// The stability of a steady shape of `rig`; exponents, damping, accuracy and cost as for a chain.
///
/// In the free frame a support on the axis, firm or not, passes no torque about it: angular
/// momentum is constant, as for a chain. A support that is carried round has a constant speed, and
/// no rotation is removed. N links have 4 N exponents, and the energy is that in the frame that
/// turns at this speed. A support that yields moves in all directions across the axis (driven: in
/// the plane), which adds 4 exponents (2); if no mass moves there, only motion in the plane adds
/// exponents. In the free frame the angular momentum of each link and its wheel about the link's
/// axis is constant, whether on free bearings or driven, because ball joints pass no torque along a
/// link. In the driven frame links turn with the plane, and wheels on free bearings have constant
/// momentum. Still fluid adds buoyancy and added mass, in every direction of motion. For a fluid
/// that turns, its motion around a disturbed link (inertial waves, which depend on the walls) is
/// not modelled, so there are no exponents. The energy tells whether a shape is a minimum, at
/// constant speed and apart from a rotation. A minimum is stable in any fluid, viscous or not;
/// otherwise the verdict is undecided and the growth rate NaN.
/// With dashpots at pins the exponents are damped, of any strength; `internal_damping` is what a
/// little more adds. Dashpots act on the rates at which links turn against one another: none in the
/// steady motion itself. They let a shape that is no minimum grow: it is unstable or, within the
/// errors, undecided.
/// Throws InvalidArgument as above, for a pin or a motion without mass (unless the fluid turns), a
/// flywheel or dashpots at a massless upper end, springs at pins, linear drag, a dashpot at the
/// support and a trolley that rolls freely. Also throws in the free frame for dashpots together
/// with a driven wheel if the support is on the axis.
REVCHAIN_DECLARE
[[nodiscard]] Stability stability(const Rig& rig, const SteadyShape& shape,
                                  const RigStabilityOptions& options = {});
REVCHAIN_DECLARE
[[nodiscard]] Stability stability(const Rig& rig, const SteadyShape& shape,
                                  const RigStabilityOptions& options, Thorough);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/stability/stability.hpp"
#endif
