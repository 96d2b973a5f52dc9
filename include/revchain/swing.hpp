// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "revchain/chain.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/rig.hpp"

/// Small oscillations of a hanging chain in a plane, after it is released: a multiple pendulum.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     revchain::Vector<double> start(3);
///     start << 0.02, 0.0, 0.0;         // the free end is drawn 2 cm aside, and released at rest
///     const auto s = revchain::swing(chain, {.offset = start, .time = {0.0, 0.5, 1.0}});
///     s.offset(2, 0);                          // where the free end is after one second, m
///     s.angular_frequency[0];                  // 3.80868 rad/s, as of `modes`
namespace revchain::inline REVCHAIN_BUILD {

/// The start of the chain, and the times of the results.
struct SwingOptions {
    Vector<double> offset{};     ///< (N) or (N + 1) of the pins at time 0, free end first; empty: 0
    Vector<double> velocity{};   ///< likewise; empty: at rest
    std::vector<double> time{};  ///< of either sign, in any order
    std::optional<Index> count{};  ///< of the slowest modes; absent: all
    double gravity = conical_pendulum::standard_gravity;
    Progress* progress = nullptr;  ///< read and cancelled from another thread
};

/// A hanging chain swinging in a plane with small amplitude: the sum of its modes.
struct Swing {
    Table<double> offset;              ///< (times, N+1) free end first, the support last
    Table<double> velocity;            ///< (times, N+1)
    Vector<double> angular_frequency;  ///< (k,) w = sqrt(g / lambda), ascending
    Vector<double> energy;             ///< (k,) of each mode, weight times length; constant
    Table<double> shape;               ///< (k, N+1) as those of `modes`
    Vector<double> cosine, sine;       ///< (k,) offset = sum of shape (cosine cos wt + sine sin wt)
    Vector<double> start;              ///< (N+1) offsets at time 0
    bool projected = false;            ///< whether `start` differs from the given offsets
    double energy_left_out = 0;        ///< bound of the energy in other modes, weight times length
    Vector<double> truncation_error;   ///< (N+1) bound of the part of each offset in other modes
    Vector<double> error_bound;        ///< (times,) of every offset, without `truncation_error`
};

/// Small oscillations of a hanging chain in a plane, superposed from its modes.
///
/// A pin without inertia (between massless threads) has no start of its own. `Swing::start` has the
/// offsets of least potential energy with the same momenta; `projected` is true if they differ from
/// the given ones.
///
/// `truncation_error` and `error_bound` hold for every offset at every time, both proved
/// (docs/theory/motion.md). Accuracy measured (tests/cpp/swing.cpp): 2e-16 of the sum of the modes'
/// amplitudes. Cost: 0.5 microseconds for each link and mode, and 3 ns for each link, mode and
/// time. Throws InvalidArgument for starts of another length, a support that moves, numbers out of
/// range, and weights more than 1e123 apart.
REVCHAIN_DECLARE
[[nodiscard]] Swing swing(const Chain<double>& chain, const SwingOptions& options);

/// The swing of a rig that is stable at rest. If the support yields, its offset and velocity may be
/// given, last in each start. Axial moments of wheels have no effect. Also throws InvalidArgument
/// if a flywheel has momentum (use `whirl_swing`), for a support that is carried round (use
/// `response`), for a fluid that turns, and for springs at pins, dashpots, linear drag and a
/// trolley that rolls freely (use `transient`), and unless the straight rig is stable.
REVCHAIN_DECLARE
[[nodiscard]] Swing swing(const Rig& rig, const SwingOptions& options);

/// How a rig with flywheels starts. Offsets are x + i y, in the two level directions.
struct WhirlSwingOptions {
    Vector<std::complex<double>> offset{};  ///< (N) or (N + 1) at time 0, free end first; empty: 0
    Vector<std::complex<double>> velocity{};  ///< likewise; empty: at rest
    std::vector<double> time{};               ///< of either sign, in any order
    std::optional<Index> count{};  ///< of the slowest whirls in both directions; absent: all
    double gravity = conical_pendulum::standard_gravity;
    Progress* progress = nullptr;
};

/// A swing of a rig whose flywheels turn its plane: the sum of whirls, which are rigid shapes.
struct WhirlSwing {
    Table<std::complex<double>> offset;      ///< (times, N+1) free end first, support last
    Table<std::complex<double>> velocity;    ///< (times, N+1)
    Vector<double> angular_speed;            ///< (k,) n, rad/s, of either sign, slowest first
    Vector<std::complex<double>> amplitude;  ///< (k,) offset = sum of amplitude shape exp(i n t)
    Vector<double> energy;            ///< (k,) of each whirl, weight times length; of either sign
    Table<double> shape;              ///< (k, N+1)
    double energy_left_out = 0;       ///< bound of the energy in all others, weight times length
    Vector<double> truncation_error;  ///< (N+1) bound of the part of each offset in the others
    Vector<double> error_bound;       ///< (times,) of every offset, without `truncation_error`
};

/// Small oscillations of a rig with flywheels: (1/g) M u'' - i G u' + K u = 0, u = x + i y, where G
/// has their momenta on the links. Whirls u = y exp(i n t) have the speeds and shapes of `modes`,
/// in both directions. Axial moments have no effect. The coefficient of whirl j in a start (u, u')
/// is
///     c_j = y_j^T [(n_j M/g - G) u - i M/g u'] / y_j^T (2 n_j M/g - G) y_j.
///
/// Bounds are those of `swing`, proved if every link hangs in tension at rest. If only the momenta
/// keep standing links from falling, the bounds are infinite. Accuracy measured
/// (tests/cpp/whirl_swing.cpp): 2e-16 of the sum of the amplitudes. Cost: 0.5 microseconds for each
/// link and whirl, and 5 ns for each link, whirl and time.
/// Throws InvalidArgument as `swing` of a rig, unless a flywheel has momentum, and for pins without
/// inertia.
REVCHAIN_DECLARE
[[nodiscard]] WhirlSwing whirl_swing(const Rig& rig, const WhirlSwingOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/rig_swing.hpp"
#include "revchain/questions/swing.hpp"
#endif
