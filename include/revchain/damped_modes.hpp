// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>
#include <limits>
#include <optional>

#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/numeric/status.hpp"
#include "revchain/rig.hpp"

/// Modes of a rig with dashpots (small amplitude): motions that decay, or grow, as exp(s t).
///
///     const revchain::Chain<double> chain({revchain::plummet(9.81, 1.0)});
///     const revchain::Rig rig(chain, {.pins = {{.damping = 0.2}}});  // N m s/rad
///     const auto m = revchain::damped_modes(rig, {.gravity = 9.81});
///     m.exponent[0].real();     // -0.1: it decays to 1/e in 10 s
///     m.exponent[0].imag();     // 3.1305 rad/s: it swings at this speed
///     m.damping_ratio(0);       // 0.0319275
namespace revchain::inline REVCHAIN_BUILD {

struct DampedModesOptions {
    Index first = 1;               ///< by |exponent|, ascending; a conjugate pair counts as one
    std::optional<Index> count{};  ///< absent: all
    double gravity = conical_pendulum::standard_gravity;
    Progress* progress = nullptr;  ///< read and cancelled from another thread
};

/// Damped modes. Mode k is at index k - first.
struct DampedModes {
    Index first = 1;
    Index available = 0;        ///< number of modes found, listed or not; all if `complete`
    Index rigid = 0;            ///< 1 if a free trolley can move as a whole; no mode of the list
    bool has_momentum = false;  ///< the motions of one sense are then no conjugates of the other's
    /// (k,) s, 1/s: offsets move as the real part of shape exp(s t), or with momentum as
    /// x + i y = shape exp(s t). Without momentum the imaginary part is not negative.
    Vector<std::complex<double>> exponent{};
    Vector<double> error_bound{};          ///< (k,) of the exponent, relative to its size; proved
    Vector<double> error_estimate{};       ///< (k,) likewise, if the bound is infinite: not proved
    Table<std::complex<double>> shapes{};  ///< (k, N+1) offsets, free end first, largest 1
    bool complete = false;                 ///< whether it is proved that there are no other modes
    Status status = Status::success;       ///< `tolerance_not_met`: a bound is not proved

    Index size() const noexcept { return exponent.size(); }
    /// These return the speed of the oscillation, -Re s / |s|, and the time in which it decays by
    /// the factor e (negative: it grows).
    double damped_frequency(Index j) const { return std::abs(exponent[j].imag()); }
    double damping_ratio(Index j) const { return -exponent[j].real() / std::abs(exponent[j]); }
    double decay_time(Index j) const { return -1 / exponent[j].real(); }
};

/// Modes of small motion of a rig with dashpots: M s^2/g + (C - i G) s + K, with K from weights and
/// springs, C from dashpots and G from momenta. Dashpots at pins act on the rates of the angles
/// between links, that of the support on its velocity, linear drag on the velocity of each link.
///
/// Method: Eigen's eigenvalues of the first-order form are starts. Each is refined with a symmetric
/// Rayleigh quotient in two words, O(N). The vectors together give discs that hold one exponent
/// each (Gershgorin): proved bounds. Without inertia at a pin (or with less than 1e-12 of what
/// moves with it), and for exponents that cannot be told apart (critical damping), the bound is
/// infinite and `error_estimate` takes its place. Accuracy: every exponent is within `error_bound`,
/// which is usually below 1e-15 (tests/cpp/damped_modes.cpp).
/// Cost O(N^3).
/// Throws InvalidArgument for numbers out of range, more than 1000 links, dashpots in a fluid that
/// turns, and weights more than 1e123 apart.
REVCHAIN_DECLARE
[[nodiscard]] DampedModes damped_modes(const Rig& rig, const DampedModesOptions& options = {});

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/damped_modes.hpp"
#endif
