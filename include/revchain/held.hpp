// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "revchain/count.hpp"
#include "revchain/finite/held/branch.hpp"
#include "revchain/finite/held/cord_branch.hpp"
#include "revchain/finite/held/held.hpp"
#include "revchain/modes.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/system/cord.hpp"

/// A chain or cord held at both ends: troposkien (turbine blade), skipping rope, string of weights.
///
///     const auto rods = revchain::Chain<double>::uniform_rods(40, 1.0);
///     const revchain::Held held(rods, {.span = 0.5});
///     const auto shapes = revchain::steady_shapes(held, {.angular_speed = 10.0});
///     shapes.shapes[0].offset.maxCoeff();   // 0.391553 m: the largest distance from the axis
///     shapes.shapes[0].error_bound;         // of every inclination, rad: proved
///     const auto m = revchain::modes(revchain::Held(rods, {.tension = 11.0}), {.count = 2});
///     m.angular_speed()[0];                 // 31.8773 rad/s: the straight chain begins to whirl
///
/// Links and arrays begin at the lower end. `modes` and `count_modes` are for a straight chain,
/// `steady_shapes` and `branches` for shapes at finite amplitude, and `stability` (stability.hpp)
/// for the stability of shapes. `Held<Cord>` needs cord.hpp.
namespace revchain::inline REVCHAIN_BUILD {

/// How the two ends are held. Give either `span` or `tension`.
struct HeldBy {
    std::optional<double> span{};  ///< distance of the ends along the axis, less than the length
    /// at the upper end, in the unit of the weights; without gravity, newtons
    std::optional<Wide<double>> tension{};
    /// no gravity: weights are masses; shapes at a span between firm ends do not depend on speed
    bool weightless = false;
    Support lower{};  ///< support of a chain's lower end; a negative radius is on the opposite side
    Support upper{};  ///< support of a chain's upper end

    bool on_axis() const noexcept { return lower.radius == 0 && upper.radius == 0; }
    /// True if no torque about the axis can bend a chain out of a plane: radius 0 passes none.
    bool planar() const noexcept { return lower.radius == 0 || upper.radius == 0; }
    bool firm() const noexcept { return lower.is_firm() && upper.is_firm(); }
};

/// A `Chain<double>` or a `Cord` held at both ends, checked once by its constructor. By default the
/// ends are firm points on the axis. `lower` and `upper` put an end of a chain on a spring, equally
/// stiff in all directions across the axis, or carry it round the axis at a radius. Both ends lie
/// in one plane with the axis.
///
/// Throws InvalidArgument unless exactly one of span and tension is given, for a span not less than
/// the length, a carriage weight without a spring, a dashpot at an end, a radius together with a
/// tension, springs or radii for a cord, a cord that is not uniform or has a tip weight, and
/// numbers out of range.
template <class System>
class Held {
    static_assert(std::is_same_v<System, Chain<double>> || std::is_same_v<System, Cord>);

   public:
    Held(System system, const HeldBy& by) : system_(std::move(system)), held_by_(by) { check(); }

    const System& system() const noexcept { return system_; }
    const HeldBy& by() const noexcept { return held_by_; }
    double length() const {
        if constexpr (std::is_same_v<System, Cord>)
            return system_.length();
        else
            return system_.total_length();
    }

   private:
    void check() const;
    void check_end(const std::string& name, const Support& end) const;

    System system_;
    HeldBy held_by_;
};

/// The speed, and the largest number of half waves. With gravity give either `conical_height` or
/// `angular_speed`. Without gravity give `angular_speed` if there is a tension or a spring; at a
/// span between firm ends it is optional.
struct HeldShapesOptions {
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};                ///< rad/s
    double gravity = conical_pendulum::standard_gravity;  ///< along the axis, with `angular_speed`
    int max_half_waves = 1;                               ///< largest number of half waves
    bool prove = true;      ///< of a chain: whether error bounds and completeness are proved
    long budget = 300'000;  ///< link evaluations of these proofs
};

/// The speed of the shapes of a held cord, and their largest number of half waves. Shapes are not
/// proved.
struct HeldCordShapesOptions {
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};  ///< rad/s
    double gravity = conical_pendulum::standard_gravity;
    int max_half_waves = 1;
};

/// Steady shapes at finite amplitude with 1 to `max_half_waves` half waves, sorted by half waves.
/// They are counted about the line between the rest positions of the two ends. The inclination of
/// each link is stable under the loads on it: a thread points along its pull. Other shapes are not
/// searched.
///
/// For each number of half waves the shape that continuation from the nearly straight chain without
/// gravity reaches, if any, comes first. At a given tension the other shapes on that branch with
/// this tension at the upper end follow. Other shapes of a chain come last among those with as many
/// half waves.
///
/// `missing` lists the numbers of half waves with which none was found. `complete` is true if it is
/// proved that there is no other such shape in the plane of the axis and the ends. For a cord this
/// needs a span without gravity. Otherwise, for a chain and with `prove`, `undecided` has the
/// ranges of the lowest link's inclination (rad) in which other shapes may exist in that plane. If
/// both radii differ from 0, the arms can twist the chain out of it, and `complete` is false.
///
/// Forces in `HeldShape` and `HeldCordShape` are multiplied by the conical height. Divide by
/// `conical_height` for the unit of the weights; without gravity multiply by the square of the
/// speed for newtons. A branch has a narrow range of tensions: for a skipping rope with k half
/// waves, 1/(pi k)^2 to 1/(8 k^2) of mass times length times speed squared.
///
/// Method for chains: the unknowns are the two forces at the lower end in the upward sweep of
/// Greenhill (1908) §8 (21). Arc continuation in double is followed by Newton's method in
/// double-double; Krawczyk's test proves the bound. Completeness is proved by splitting the pulls
/// along the lowest link and its inclinations until each part has exactly one shape or none
/// (finite/held/search.hpp). For cords: power series, which without gravity give y = b sn(K x/a),
/// §5. For 3, 6 and 9 links with l <= a and one half wave, 99 of 108 lists are proved complete
/// (tests/cpp/held.cpp), fewer with l > a or more half waves. Accuracy: inclinations of chains are
/// correctly rounded up to an error of 1e-20, with a bound that is mostly proved
/// (tests/cpp/held.cpp). Positions on cords are within 1e-13 of the length, with an estimated
/// bound. A given tension is met to 1e-15 for cords, to 1e-12 (rarely only 1e-10) for chains,
/// relative. Cost: about 100 sweeps of O(N), or 100 paths of a cord; for a tension some thousand.
/// The proof of completeness of 9 rods at half their length takes 0.1 s; `budget` 0 omits it.
/// Throws InvalidArgument for a speed missing or out of range, `max_half_waves` below 1, and
/// weights more than 1e123 apart.
REVCHAIN_DECLARE
[[nodiscard]] HeldShapes steady_shapes(const Held<Chain<double>>& held,
                                       const HeldShapesOptions& options = {});
REVCHAIN_DECLARE
[[nodiscard]] HeldCordShapes steady_shapes(const Held<Cord>& held,
                                           const HeldCordShapesOptions& options = {});

/// Selects modes of a chain held straight under a tension, as `ModesOptions` does.
struct HeldModesOptions {
    Index first = 1;
    std::optional<Index> count{};
    std::optional<HeightWindow<double>> conical_height{};
    std::optional<SpeedWindow<double>> angular_speed{};
    std::optional<double> rtol{};  ///< bounds above it are `Status::tolerance_not_met`
    double gravity =
        conical_pendulum::standard_gravity;  ///< for windows of speed, and without weight
    bool certify = false;
    Index threads = 1;  ///< 0: all processors
    Progress* progress = nullptr;
};

/// Whirl modes of small amplitude of the straight chain under a tension, slowest first, chosen as
/// for a hanging chain. N links have N - 1 modes, one more for each end on a spring, less one for
/// each independent motion of the pins that moves no mass. In `shapes` firm ends are 0, the largest
/// in size is 1, and the lowest pin that moves has a positive offset; nodes are distances from the
/// lower end. Without gravity a height is `HeldModesOptions::gravity` over the square of the speed.
///
/// Method: modes are counted in double; each gets a Rayleigh quotient in double-double and two
/// proved counts. Accuracy: `error_bound` is proved, mostly 1 ulp (tests/cpp/held.cpp). Cost: 0.7
/// microseconds a link and mode, also with shapes.
/// Throws InvalidArgument for a span, for a tension that does not exceed the weight, as `modes` of
/// a chain, and if rounding leaves the number of modes in a window in doubt.
REVCHAIN_DECLARE
[[nodiscard]] Modes<double> modes(const Held<Chain<double>>& held,
                                  const HeldModesOptions& options = {});

/// The number of modes slower than a speed, proved. Cost: O(N). Throws InvalidArgument as `modes`,
/// and unless one of height and speed is given.
REVCHAIN_DECLARE
[[nodiscard]] Index count_modes(const Held<Chain<double>>& held,
                                const CountOptions<double>& options);

/// Sets how far to follow branches. Give either `min_conical_height` or `max_angular_speed`.
struct HeldDiagramOptions {
    std::optional<double> min_conical_height{};
    std::optional<double> max_angular_speed{};  ///< rad/s
    double gravity = conical_pendulum::standard_gravity;
    double max_step = 0.1;  ///< relative change of end forces and height between two shapes
};

/// The branches of a chain or cord held at a span, one for each number of half waves from 1 to a
/// gap (off the axis or on springs: four missing modes in a row). A branch begins at the greatest
/// speed and goes to slower speeds, through folds.
/// It ends as in `HeldBranchEnd`. `HeldBranch::mode` numbers the branches. If an end is off the
/// axis each number k has two, mode 2 k - 1 with its lowest link outwards, mode 2 k inwards, as the
/// ends leave the axis. A branch that returns to the greatest speed where another would begin
/// stands for both.
///
/// Method: arc continuation in (force across, force along, height) at constant span; shapes are
/// refined in double-double, at folds in double. Branches that begin elsewhere or leave the plane
/// of the ends are not searched. Accuracy: an estimated 1e-15 rad if `condition` is moderate. A
/// cord folds as it approaches the slowest speed, at which one of its two straight parts begins to
/// whirl; the last speed found is up to 3 percent higher. Cost: some hundred shapes of 10 sweeps
/// each.
/// Throws InvalidArgument for a tension, no gravity, and unless exactly one of height and speed is
/// given.
REVCHAIN_DECLARE
[[nodiscard]] std::vector<HeldBranch> branches(const Held<Chain<double>>& held,
                                               const HeldDiagramOptions& options);
REVCHAIN_DECLARE
[[nodiscard]] std::vector<HeldCordBranch> branches(const Held<Cord>& held,
                                                   const HeldDiagramOptions& options);

/// Selects a shape of a branch. Give one of `conical_height`, `angular_speed` and `top_tension`.
struct HeldOnBranchOptions {
    int mode = 1;  ///< half waves at the start of the branch; off the axis see `branches`
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};  ///< rad/s
    std::optional<double> top_tension{};    ///< at the upper end, in the unit of the weights
    double gravity = conical_pendulum::standard_gravity;
};

/// A shape on the branch `mode` of a chain or cord held at a span. At a given speed, on the axis,
/// it is the first shape with `mode` half waves that `steady_shapes` lists. With a given tension at
/// the upper end it is the fastest one, with the speed `angular_speed()`. Accuracy: inclinations as
/// `steady_shapes`; the height for a tension to 1e-14. Throws InvalidArgument as `branches`, for a
/// mode below 1, for a tension between springs, and if the branch does not reach the number.
REVCHAIN_DECLARE
[[nodiscard]] HeldShape steady_shape(const Held<Chain<double>>& held,
                                     const HeldOnBranchOptions& options);
REVCHAIN_DECLARE
[[nodiscard]] HeldCordShape steady_shape(const Held<Cord>& held,
                                         const HeldOnBranchOptions& options);

}  // namespace revchain

#include "revchain/questions/held_check.hpp"
#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/held.hpp"
#endif
