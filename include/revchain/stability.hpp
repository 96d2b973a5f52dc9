// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>
#include <string_view>
#include <vector>

#include "revchain/chain.hpp"

namespace revchain {

struct SteadyShape;  // revchain/steady_shapes.hpp
struct HeldShape;    // revchain/held.hpp

/// In what a chain is free to move when it is disturbed.
enum class StabilityFrame {
    free,    ///< ball joints, no torque about the axis: in and out of the plane of the shape
    driven,  ///< axles at right angles to a plane that is made to turn: in that plane alone
};

/// What becomes of a small disturbance of a steady shape.
enum class Verdict {
    minimum,  ///< of the energy seen from the turning frame (free: at constant angular momentum): it stays small
    spectrally_stable,  ///< it swings and does not grow, to first order, by gyroscopic forces
    unstable,           ///< it grows
    undecided,          ///< within the error of the exponents
};
inline std::string_view to_string(Verdict verdict) {
    constexpr std::string_view names[]{"minimum", "spectrally stable", "unstable", "undecided"};
    return names[static_cast<std::size_t>(verdict)];
}

/// Times in units of 1/n, the turning speed.
struct Stability {
    StabilityFrame frame = StabilityFrame::free;
    Verdict verdict = Verdict::undecided;
    std::vector<std::complex<double>>
        exponents;                  ///< s of exp(s n t), by imaginary part; free: without rotation's own 0, 0
    double growth_rate = 0;         ///< largest real part
    double margin = 0;              ///< what of the growth rate rounding may explain
    Index negative_directions = 0;  ///< of the Hessian; free: of the amended one, rotation left out
};

/// Returns what becomes of a small disturbance of a steady shape of `chain`.
///
/// Rotation about the axis costs nothing; in the free frame it is taken out by the angular momentum's constancy, which
/// adds 4 b b' / (y0'M y0), b = B y0, y0 the shape, to the stiffness in the plane, so that no double zero blurs the
/// exponents. Links are rods without inertia about their own axes: 4 N - 2 exponents of N links if free, 2 N if driven;
/// fewer where links have no weight, as two that meet in a pin without mass stay in line.
/// Accuracy: exponents to about 1e-13 of the largest where they are simple. Cost (4 N)^3: 1 ms for 10 links, a second
/// for 100. N = 1: omega = n sqrt(1 + 3 cos^2 d) free, n sin d driven (section 7 (6)).
/// Throws InvalidArgument for a shape of another chain.
Stability stability(const Chain<double>& chain, const SteadyShape& shape, StabilityFrame frame = StabilityFrame::free);

/// Returns what becomes of a small disturbance of a shape with both ends held. Both ends stay where they are. N links
/// have 4 N - 8 exponents if free, 2 N - 4 if driven, in units of n, with and without gravity.
/// Accuracy: exponents to 1e-13 of the largest where simple (tests/cpp/finite/stability/held.cpp). Cost (4 N)^3.
/// Throws InvalidArgument for a shape of another chain, and for a pin between links without mass.
Stability stability(const Chain<double>& chain, const HeldShape& shape, StabilityFrame frame = StabilityFrame::free);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/stability/stability.hpp"
#endif
