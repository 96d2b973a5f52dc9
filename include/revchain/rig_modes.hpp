// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "revchain/modes.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/rig.hpp"

/// Whirl modes of a rig without dashpots (small amplitude): yielding supports, springs at pins,
/// standing links, flywheels, a fluid.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     const revchain::Rig rig(chain, {.support = revchain::horizontal_spring(50.0)});
///     const auto m = revchain::modes(rig, {.count = 2});
///     m.forward.angular_speed[0];      // 3.72206 rad/s, the slowest mode
///     m.forward.speed_error_bound[0];  // its relative error is at most 2.3e-16: proved
///     m.forward.shape(0)[1];           // offset of the second pin, free end first
namespace revchain::inline REVCHAIN_BUILD {

/// Selects modes of a rig, as `ModesOptions` does. With momentum they apply to each direction of
/// rotation, a window of speeds to |n|. Mode numbers beyond those available give no modes.
struct RigModesOptions {
    Index first = 1;
    std::optional<Index> count{};
    std::optional<HeightWindow<double>> conical_height{};
    std::optional<SpeedWindow<double>> angular_speed{};
    std::optional<double> rtol{};  ///< larger bounds give `Status::tolerance_not_met`
    bool certify = false;          ///< also return `WhirlModes::certificate`
    double gravity = conical_pendulum::standard_gravity;  ///< for all speeds
    bool other = true;                                    ///< also find `RigModes::other`
    Index threads = 1;                                    ///< 0: all processors
    Progress* progress = nullptr;  ///< read and cancelled from another thread
};

/// Whirl modes of a rig in one direction of rotation, slowest first. Mode k is at index k - first.
/// Shapes, residual and nodes are as in `Modes`, but a support that yields has an offset.
struct WhirlModes {
    Index first = 1;
    Index available = 0;                 ///< number of modes in this direction, found or not
    Vector<double> conical_height{};     ///< (k,) g/n^2, descending, in the chain's unit of length
    Vector<double> error_bound{};        ///< (k,) of `conical_height`, relative to the exact one
    Vector<double> angular_speed{};      ///< (k,) |n|, rad/s
    Vector<double> speed_error_bound{};  ///< (k,) of `angular_speed`, relative
    Certificate<double> certificate{};  ///< of the heights, counted in this direction; if asked for

    Index size() const noexcept { return conical_height.size(); }
    const Table<double>& shapes(Progress* progress = nullptr) const {
        return lazy_shapes_.offsets(size(), progress);
    }
    const Vector<double>& residual() const { return details().residual; }
    const std::vector<Vector<double>>& nodes() const { return details().nodes; }
    /// (N+1) offsets of the mode at index j, computed alone unless `shapes` has been called.
    [[nodiscard]] Vector<double> shape(Index j) const { return lazy_shapes_.one(size(), j); }

   private:
    friend detail::ShapesBehind;
    const detail::ModeShapes<double>& details() const {
        return lazy_shapes_.details(size(), nullptr);
    }
    detail::LazyModeShapes<double> lazy_shapes_{};
};

/// A solution that is not a steady motion: its height is negative or complex, or its speed is
/// complex.
struct OtherMode {
    std::complex<double> conical_height;  ///< lambda = g/n^2
    std::complex<double> angular_speed;   ///< n, rad/s; without momentum, the sign that grows
    double growth_rate = 0;               ///< |Im n|, 1/s: small offsets grow as exp(growth_rate t)
    double error_bound = std::numeric_limits<double>::infinity();  ///< relative, proved
};

/// A link whose effective tension, tension + n momentum/length, changes its sign at a speed.
struct SlackLink {
    Index link = 0;            ///< from 0, lowest first
    double angular_speed = 0;  ///< n, negative in the backward direction
};

/// The method that found the modes of a rig.
enum class RigMethod {
    modes,   ///< the rig is a plain chain: `modes` of that chain
    counts,  ///< numbered by counts
    discs,   ///< all at once, proved if discs about them do not meet
};
[[nodiscard]] inline std::string_view to_string(RigMethod method) noexcept {
    constexpr std::string_view names[]{"modes", "counts", "discs"};
    return names[static_cast<std::size_t>(method)];
}

/// Whirl modes of a rig.
struct RigModes {
    bool has_momentum = false;  ///< whether a flywheel has momentum of its own
    WhirlModes forward;         ///< n > 0; without momentum, all modes
    WhirlModes backward;        ///< n < 0; empty without momentum
    Index rigid = 0;  ///< 1 if a free trolley can move as a whole, at speed 0; no mode of the lists
    Index other_available = 0;  ///< number of solutions that are not steady motions, listed or not
    std::vector<OtherMode> other;  ///< filled if `RigModesOptions::other` or `discs`
    std::vector<SlackLink> slack;  ///< slowest first, up to the fastest mode listed there
    bool complete = false;         ///< whether the three numbers available are proved
    RigMethod method = RigMethod::counts;
    Status status = Status::success;  ///< see `modes`
};

/// Whirl speeds of small amplitude of a rig, Greenhill (1908) §8 (21). The radius of a support
/// carried round has no effect. A plain chain is solved as a chain, to `rtol`; other rigs to full
/// accuracy.
///
/// Method without momentum: lambda K y = M y. If K > 0 or M >= 0, counts number the heights
/// (Sylvester): positive ones as modes, negative ones in `other`. Method with momentum: (K + n G -
/// n^2 M/g) y = 0. If K > 0 and M >= 0, counts number the speeds. Otherwise all heights or speeds
/// are found at once (Ehrlich, Aberth) and proved in disjoint discs.
/// Accuracy, measured (tests/cpp/rig_modes.cpp): heights without momentum, speeds with it, within
/// 0.501 ulp of the exact ones of the stored numbers. Their bounds by counts are at most 1 ulp,
/// wider with springs at pins of very light links; shapes are as for chains. Cost: 50 ns per link
/// and mode with shapes if all links hang in tension, pins have no springs and no trolley rolls
/// freely; O(N k) memory. Discs: O(N^2).
/// Throws InvalidArgument for dashpots or linear drag (use `damped_modes`), numbers together with a
/// window, two windows, numbers out of range or too far apart, and for a rig that needs discs and
/// has springs at pins or, with its yielding support, more than 20,000 links. A bound that is not
/// proved is infinite. The status is `tolerance_not_met` for such a bound, for one above `rtol`,
/// and if `complete` is false.
REVCHAIN_DECLARE
[[nodiscard]] RigModes modes(const Rig& rig, const RigModesOptions& options = {});

namespace detail {
class RigRoots;
}

/// Counts the modes of one rig above a conical height or below a speed, proved as by `ModeCounter`.
/// A count is one O(N) pass; for a rig that needs discs (see `modes`) the constructor finds all
/// roots.
class RigModeCounter {
   public:
    /// Throws InvalidArgument for a rig or gravity that `modes` refuses.
    explicit RigModeCounter(const Rig& rig, double gravity = conical_pendulum::standard_gravity);

    /// The number of conical heights above `height`, with momentum in both directions together.
    /// Throws InvalidArgument if rounding leaves the count in doubt.
    [[nodiscard]] Index above_height(double height) const;

    /// The number of whirl speeds between 0 and `angular_speed`, rad/s; with momentum its sign is
    /// the direction. Throws InvalidArgument for 0, and if rounding leaves the count in doubt.
    [[nodiscard]] Index below_speed(double angular_speed) const;

   private:
    double gravity_;
    std::shared_ptr<const ModeCounter<double>> plain_;  ///< of a rig that is a chain; else null
    std::shared_ptr<const detail::RigRoots> roots_;
};

/// The number of modes slower than a speed, proved: see `RigModeCounter`. Greenhill (1908) §8 (21).
///
///     count_modes(rig, {.angular_speed = -5.0});  // backward modes between 0 and 5 rad/s
///
/// Cost: O(N); with discs O(N^2). Throws InvalidArgument unless exactly one of height and
/// speed is given, and as `RigModeCounter`.
REVCHAIN_DECLARE
Index count_modes(const Rig& rig, const CountOptions<double>& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/rig_modes.hpp"
#endif
