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
/// In the free frame the constant angular momentum removes the rotation of the shape about the
/// axis. Links are rods without inertia about their own axes. N links have 4 N - 2 exponents if
/// free, 2 N if driven; fewer with massless links. N = 1: n sqrt(1 + 3 cos^2 d) free, n sin d
/// driven, §7 (6). Exponents and verdict contain no damping. A minimum stays stable with friction
/// at the pins; in a shape that is only spectrally stable friction makes the motions of negative
/// energy grow (Kelvin, Tait, Chetaev; Merkin 1997, Kirillov 2013). `internal_damping` and
/// `external_damping` tell which, to first order. Accuracy: simple exponents to about 1e-13 of the
/// largest; `exponent_error` estimates each error, and a verdict within it is `undecided`. If
/// double loses digits, as with masses far apart, shapes of up to 50 links are computed with twice
/// the digits if `thorough` is given, or in programs that link revchain::compiled. With masses 1e16
/// apart errors are then at most 2e-13 of the largest in the tests, on arms and springs 5e-9
/// (tests/python/test_light_links.py). Cost: O(N^3), 0.4 ms for 20 links and 2 ms for 40; much more
/// with twice the digits.
/// Throws InvalidArgument if numbers or lengths of links differ, and if rounding leaves in doubt
/// whether every motion moves mass.
REVCHAIN_DECLARE
[[nodiscard]] Stability stability(const Chain<double>& chain, const SteadyShape& shape,
                                  StabilityFrame frame = StabilityFrame::free);
REVCHAIN_DECLARE
[[nodiscard]] Stability stability(const Chain<double>& chain, const SteadyShape& shape,
                                  StabilityFrame frame, Thorough);

/// Returns the stability of a shape with both ends held. Firm ends are fixed; ends on springs move
/// across the axis. N links have 4 N - 8 exponents if free, 2 N - 4 if driven; each end on a spring
/// adds 4, or 2. Arms turn at constant speed: if an end is off the axis no rotation is removed,
/// which adds 2 exponents if free. Accuracy: simple exponents to 1e-13 of the largest
/// (tests/cpp/finite/stability/held.cpp). Cost: O(N^3). Throws InvalidArgument as above, and for a
/// massless moving pin below the upper end.
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
/// In the free frame a support on the axis passes no torque about it: angular momentum is constant,
/// as for a chain. A support that is carried round has a constant speed, and no rotation is
/// removed: N links have 4 N exponents. A support that yields moves in all directions across the
/// axis (driven: in the plane), which adds 4 exponents (2). In the free frame the angular momentum
/// of each link and its wheel about the link's axis is constant. In the driven frame links turn
/// with the plane, and wheels on free bearings have constant momentum. Still fluid adds buoyancy
/// and added mass. The motion of a fluid that turns is not modelled: there are no exponents, and
/// the verdict is `minimum` or `undecided`.
/// With dashpots at pins the exponents are damped, of any strength; `internal_damping` is what a
/// little more adds. A shape that is no minimum is then unstable or undecided.
/// Throws InvalidArgument as above, for a pin or a motion without mass, springs at pins, linear
/// drag, a dashpot at the support, a trolley that rolls freely and, with the support on the axis in
/// the free frame, dashpots together with a driven wheel.
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
