// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>
#include <vector>

#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/rig.hpp"

/// Motion of small amplitude in time of a rig whose support may be moved: a crane that brakes, a
/// ship that rolls.
///
///     using revchain::SupportMotion;
///     const revchain::Chain<double> chain({revchain::plummet(9.81, 2.0)});
///     const revchain::Rig rig(chain, {.pins = {{.damping = 0.2}}});  // N m s/rad
///     const SupportMotion braking{SupportMotion::Given::velocity, {0.0, 1.5}, {0.8, 0.0}};  // s, m/s
///     const auto t = revchain::transient(
///         rig, {.time = {0.0, 1.5, 3.0}, .motion = braking, .gravity = 9.81});
///     t.offset(1, 1).real();  // 0.6 m: the trolley stops here
///     t.sway[0];              // 0.21261 m: by so much the load swings about this place
namespace revchain::inline REVCHAIN_BUILD {

/// A prescribed motion of the support, or a force on it, in time. Times ascend; between two of them
/// velocities, accelerations and forces are straight lines, offsets a cubic spline. Two equal times
/// are a jump of accelerations or forces. A support on a spring is moved at the far end of the
/// spring.
struct SupportMotion {
    enum class Given { acceleration, velocity, offset, force };
    Given given = Given::acceleration;
    std::vector<double> time{};   ///< >= 0; before the first and after the last no acceleration
    std::vector<double> value{};  ///< for each time. The first offset is 0 unless offsets are given
    /// For offsets: true if the support rests before the first time and after the last. If false,
    /// it goes on with the velocities at the ends.
    bool rests = true;
};

struct TransientOptions {
    Vector<std::complex<double>> offset{};    ///< (N) or (N + 1) at time 0; empty: as the support
    Vector<std::complex<double>> velocity{};  ///< likewise
    std::vector<double> time{};               ///< >= 0, ascending
    SupportMotion motion{};                   ///< none if without times
    double gravity = conical_pendulum::standard_gravity;
    Progress* progress = nullptr;
};

/// Motion in time. Offsets from the axis are x + i y with momentum, else real.
struct Transient {
    Table<std::complex<double>> offset;    ///< (times, N+1) free end first, support last
    Table<std::complex<double>> velocity;  ///< (times, N+1)
    Vector<double> error_estimate;         ///< (times,) of every offset; not proved
    double end = 0;  ///< the time at which the prescribed motion is over, or 0
    /// (N+1) since then, the largest distance of each pin from below the support, and of the
    /// support from its resting place, seen at 400 instants, to 1 %. Motions with a damping ratio
    /// below 0.05 count with their whole amplitudes. Infinite if the motion grows
    Vector<double> sway{};
    Vector<std::complex<double>> exponent{};  ///< (k,) of the motions, see `damped_modes`
    Table<std::complex<double>> shape{};      ///< (k, N+1)
    /// (k,) Since the end offsets from the resting place are the sum of amplitude shape
    /// exp(exponent (t - end)), without momentum its real part. NaN unless `in_modes`
    Vector<std::complex<double>> amplitude{};
    Vector<std::complex<double>> start{};  ///< (N+1) offsets at time 0
    bool projected = false;  ///< whether `start` differs: pins without inertia go where they must
    bool in_modes = true;    ///< false: motions cannot be told apart, as at critical damping
};

/// Motion in time: Q(d/dt) q = load with the matrices of `damped_modes`, as the sum of all damped
/// motions q_j, each driven by q_j^T load: exact for loads that are polynomials between two times.
///
/// If damping is critical, so that two motions become one, the matrix exponential of the
/// first-order form goes from time to time instead. Accuracy measured (tests/cpp/transient.cpp):
/// 1e-11 of the largest offset; by exponentials, or with masses 1e16 apart, mostly within
/// `error_estimate`. Cost: `damped_modes` once, and 15 ns for each link, motion and time.
/// Throws InvalidArgument for starts of another length, a start of a support that is moved, times
/// that are negative or do not ascend, a motion with fewer than two times, a force on a firm
/// support, a support that is carried round, a fluid that turns, more than 1000 links, and complex
/// starts without momentum.
REVCHAIN_DECLARE
[[nodiscard]] Transient transient(const Rig& rig, const TransientOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/transient.hpp"
#endif
