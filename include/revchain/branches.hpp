// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "revchain/finite/branch/state.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/steady_shapes.hpp"

/// Branches of steady shapes: how shapes change with the speed (the bifurcation diagram).
///
///     const auto chain = revchain::Chain<double>::uniform_plummets(3, 3.0);
///     const auto second = revchain::branch(chain, {.mode = 2, .max_angular_speed = 15.0});
///     second.end == revchain::BranchEnd::height;   // true: it was followed to that speed
///     second.tip_radius[second.size() - 1];        // 0.524717 m there, from the axis
///     const auto all = revchain::branches(chain, {.max_angular_speed = 15.0}, revchain::thorough);
///     all.branches.size();                         // 4: of three modes, and an isolated one
///     all.complete;                                // true: proved, there are no others
///     const auto shape = revchain::steady_shape(chain, {.mode = 1, .tip_radius = 2.0});
///     shape.angular_speed();                       // 2.34160 rad/s: the free end at 2 m
///
/// The branch of a mode leaves the vertical at the mode's critical speed. It may turn back at folds
/// and pass one speed several times. An isolated branch does not reach the vertical.
namespace revchain::inline REVCHAIN_BUILD {

template <class System>
class Held;
class Cord;

/// Why a branch ends.
enum class BranchEnd {
    height,    ///< at the conical height given
    vertical,  ///< back at the straight chain
    closed,    ///< at its first point
    budget,    ///< after `max_points` points
    stuck,     ///< no step passes every check
    slow,      ///< on the way to rest, at a tenth of the critical speed or below
    slack,     ///< flywheels make the effective tension of a link 0: it becomes horizontal
    loose,     ///< the spring at the support cannot hold the rig: it is stretched to 1000 lengths
};
[[nodiscard]] inline std::string_view to_string(BranchEnd end) noexcept {
    constexpr std::string_view names[]{"height", "vertical", "closed", "budget",
                                       "stuck",  "slow",     "slack",  "loose"};
    return names[static_cast<std::size_t>(end)];
}

/// How a branch begins.
enum class BranchBirth {
    vertical,  ///< it leaves the straight chain at the critical speed of a mode
    rest,      ///< at rest: the support is off the axis, and the rig starts to turn
    fold,      ///< isolated: closed, or from a fold or, on a spring, from far off the axis
};
[[nodiscard]] inline std::string_view to_string(BranchBirth birth) noexcept {
    constexpr std::string_view names[]{"vertical", "rest", "fold"};
    return names[static_cast<std::size_t>(birth)];
}

/// A branch of steady shapes, point by point along its arc, in the units of the chain. Its arc has
/// no unit: ds^2 = (mean of dtau^2 over the links) + (d log(conical height))^2, where
/// tan(inclination) = sinh(tau).
struct Branch {
    Index mode = 0;  ///< at which it leaves the vertical; 1 also from rest; 0 if isolated
    BranchBirth birth = BranchBirth::vertical;
    /// For each point. `tip_inclination` is that of the lowest link, rad, `tip_radius` the offset
    /// of the free end, `top_tension` the tension at the topmost pin. Others are as in
    /// SteadyShape.
    std::vector<double> arc, conical_height, tip_inclination, tip_radius, top_tension,
        moment_of_inertia, effective_energy;
    std::vector<int> half_waves;     ///< number of sign changes of the offsets, plus 1
    std::vector<std::size_t> folds;  ///< points where the conical height has a local extreme
    BranchEnd end = BranchEnd::budget;

    std::size_t size() const noexcept { return arc.size(); }
    double angular_speed(std::size_t point,
                         double gravity = conical_pendulum::standard_gravity) const {
        return conical_pendulum::angular_speed(conical_height[point], gravity);
    }
    /// The shape at a point, balanced in double-double. Its bound is proved; at a fold it is an
    /// estimate. Throws InvalidArgument for a point past the end, and for the straight chain (point
    /// 0 on the branch of a mode).
    [[nodiscard]] SteadyShape shape(std::size_t point) const;
    /// The shapes of this part of the branch at a conical height, in the order of the arc.
    /// Accuracy: as `steady_shape`. Cost: a test of every point, and O(N) a shape. Throws
    /// InvalidArgument for a height that is not positive and finite.
    [[nodiscard]] std::vector<SteadyShape> shapes_at(double conical_height) const;

   private:
    friend finite::TraceBehind;
    finite::BranchTrace trace_;
};

/// Selects a branch, and how far to follow it. Give either `min_conical_height` or
/// `max_angular_speed`.
struct BranchOptions {
    Index mode = 1;  ///< of the critical speed: 1 is the slowest, as in `modes`
    std::optional<double> min_conical_height{};
    std::optional<double> max_angular_speed{};  ///< rad/s
    std::size_t max_points = 10'000;
    double max_step = 0.1;                                ///< along the arc
    double gravity = conical_pendulum::standard_gravity;  ///< with `max_angular_speed`
};

/// Selects a branch of a rig, and how far to follow it. Members are as in `BranchOptions`.
struct RigBranchOptions {
    Index mode = 1;  ///< among those in the direction of rotation; off the axis 1
    std::optional<double> min_conical_height{};
    std::optional<double> max_angular_speed{};  ///< rad/s
    std::size_t max_points = 10'000;
    double max_step = 0.1;
    double gravity = conical_pendulum::standard_gravity;  ///< for speeds and flywheels
    Rotation direction = Rotation::forward;
};

/// The branch of steady shapes that leaves the vertical at a mode, followed through folds to the
/// conical height or speed given, or to another `BranchEnd`.
///
/// Method: pseudo-arclength continuation of the pins, in double. Each step is checked: see
/// finite::BranchWalk. Accuracy: points about 1e-12 (measured:
/// tests/cpp/finite/branch/shape_on_branch.cpp), `shape` in double-double; folds are located to
/// 1e-6 of the arc, their heights to 1e-13, mostly an ulp. Cost: 0.4 microseconds a link and point;
/// 2 N numbers a point. Throws InvalidArgument for a mode number outside 1 ...
/// `chain.mode_count()`, unless exactly one of height and speed is given, for a height not below
/// that of the mode, and weights more than 1e123 apart.
REVCHAIN_DECLARE
[[nodiscard]] Branch branch(const Chain<double>& chain, const BranchOptions& options);

/// The branch of a mode of a rig, or the branch from rest if its support is off the axis.
///
/// On the axis, modes are numbered as by `modes` in the direction of rotation. Off the axis the
/// branch from rest, `mode` 1, begins at a tenth of the first critical speed (of the rig with its
/// support on the axis), or of the given speed if that is slower. If links stand or lean against
/// their load, a branch may begin towards slower speeds; it is followed down to a tenth of the
/// speed of its mode. In the arc, the stretch of a spring over the length of the chain is sinh(tau)
/// of one more link.
/// Accuracy and cost: as for chains (tests/cpp/finite/branch/rigs.cpp). Throws InvalidArgument as
/// for chains, off the axis for a `mode` other than 1, and for springs at pins, linear drag, a
/// dashpot at the support and a trolley that rolls freely.
REVCHAIN_DECLARE
[[nodiscard]] Branch branch(const Rig& rig, const RigBranchOptions& options);

/// Sets how far to follow branches, and limits of proofs. Give either `min_conical_height` or
/// `max_angular_speed`.
struct DiagramOptions {
    std::optional<double> min_conical_height{};
    std::optional<double> max_angular_speed{};  ///< rad/s
    std::size_t max_points = 10'000;            ///< of each branch
    double max_step = 0.1;                      ///< along the arc
    int lists = 16;  ///< number of heights, evenly spaced in their logarithm, at which all shapes
                     ///< are listed, with proofs as `budget` allows
    long budget = 3'000'000;        ///< of each list, see SteadyShapesOptions
    long proof_budget = 1'000'000;  ///< link evaluations in the proof; with `thorough`
    double gravity = conical_pendulum::standard_gravity;  ///< with `max_angular_speed`
};

/// Sets how far to follow branches of a rig, in one direction of rotation. See `DiagramOptions`.
struct RigDiagramOptions {
    std::optional<double> min_conical_height{};
    std::optional<double> max_angular_speed{};  ///< rad/s
    std::size_t max_points = 10'000;
    double max_step = 0.1;
    int lists = 16;
    long budget = 3'000'000;
    long proof_budget = 1'000'000;
    double gravity = conical_pendulum::standard_gravity;  ///< for speeds and flywheels
    Rotation direction = Rotation::forward;
};

/// All branches found above one conical height.
struct Branches {
    /// First the branches of the modes, slowest first, or the branch from rest; then isolated
    /// branches, by their largest conical height, descending.
    std::vector<Branch> branches;
    double conical_height = 0;  ///< lowest conical height of the diagram
    /// true if every branch ends as `height`, `closed`, `slow` or `loose`, and at every height of
    /// `looked_at` the branches pass each shape of the proved list once, and no other shape
    bool consistent = false;
    bool complete = false;          ///< consistent, and proved: none is missing above that height
    std::vector<double> looked_at;  ///< conical heights of those lists, descending
    std::string remark;             ///< what is proved, or may be missing
};

/// The diagram of branches to the conical height or speed given: those of the modes, and isolated
/// ones.
///
/// Method: `branch` from every mode, then lists of shapes (`steady_shapes`) at `lists` heights. A
/// shape that no branch passes lies on an isolated branch, which is followed from it to its end.
/// With `thorough` as the last argument, or revchain::compiled, finite::DiagramProver then tries to
/// prove that no loop opens and closes between two of the heights. If `complete` is false, `remark`
/// says why. The proof shows where branches are; the computed points are checked, not proved (see
/// finite::BranchWalk). Accuracy: as `branch`. Cost with `thorough`: down to 1/200 of the length, 5
/// ms for three equal plummets and 50 ms for six.
/// Throws InvalidArgument unless one of height and speed is given and `lists` >= 1; without
/// `thorough` also for links that stand or may hang at several inclinations.
REVCHAIN_DECLARE
[[nodiscard]] Branches branches(const Chain<double>& chain, const DiagramOptions& options);
REVCHAIN_DECLARE
[[nodiscard]] Branches branches(const Chain<double>& chain, const DiagramOptions& options,
                                Thorough);

/// The diagram of a rig in its own posture: the branches of its modes, or the one from rest if its
/// support is off the axis, and isolated ones. Method and proof are those of chains.
///
/// For the proof all links must hang in tension, each at one inclination for its load, at every
/// speed up to the given one. Heights are not proved at which the stiffness of a spring times the
/// conical height is less than the weight that moves.
/// Throws InvalidArgument as for chains, for a rig that `branch` refuses, and if an effective
/// tension is 0 at the height of a list.
REVCHAIN_DECLARE
[[nodiscard]] Branches branches(const Rig& rig, const RigDiagramOptions& options);
REVCHAIN_DECLARE
[[nodiscard]] Branches branches(const Rig& rig, const RigDiagramOptions& options, Thorough);

/// Selects a shape on a branch of a chain or a cord. Give exactly one of the five numbers from
/// `conical_height` to `top_tension`.
struct OnBranchOptions {
    Index mode = 1;  ///< of the branch, as in `BranchOptions`
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};    ///< rad/s
    std::optional<double> tip_inclination{};  ///< of the lowest link, rad, above 0 and below pi/2
    std::optional<double> tip_radius{};       ///< of the free end from the axis
    std::optional<double> top_tension{};      ///< magnitude of the reaction at the support
    double gravity = conical_pendulum::standard_gravity;  ///< with `angular_speed`
    /// Lowest conical height searched. Absent: 1e-6 of the mode's, or half of the
    /// height given (or g/n^2).
    std::optional<double> min_conical_height{};
};

/// Selects shapes on a branch of a rig. Members are as in `OnBranchOptions`.
struct RigOnBranchOptions {
    Index mode = 1;  ///< among those in the direction of rotation
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};  ///< rad/s, positive in both directions
    std::optional<double> tip_inclination{};
    std::optional<double> tip_radius{};
    std::optional<double> top_tension{};
    double gravity = conical_pendulum::standard_gravity;  ///< for speeds and flywheels
    Rotation direction = Rotation::forward;
    std::optional<double> min_conical_height{};
};

/// The default of `max_shapes`: no limit.
inline constexpr std::size_t all_shapes = std::numeric_limits<std::size_t>::max();

/// Shapes of one branch, in the order of its arc.
struct ShapesOnBranch {
    std::vector<SteadyShape> shapes;
    /// why the search ended; `height` also after `max_shapes`; `budget`: after 100,000 steps
    BranchEnd end = BranchEnd::height;
    double searched_to = 0;  ///< the conical height at which it ended
    bool from_rest = false;  ///< the branch begins at rest: the support is off the axis
};

/// The first shape along the branch of a mode at which one number has its given value: conical
/// height, speed, tip inclination, tip radius or top tension.
///
/// Method: continuation along the arc (see `branch`), then Newton's method on all pins and the
/// height in double-double, with the given number as a condition. Accuracy: at a given height or
/// speed inclinations to 2.3e-16 and within `error_bound`, which is proved. Tested for 1 to 1000
/// links, modes 1 to 10, from 1e-8 above the critical speed to a conical height of 1e-4 of the
/// length (tests/cpp/finite/branch/shape_on_branch.cpp). It is checked step by step, not proved,
/// that the shape is on this branch. Cost: O(N), for 100,000 rods at twice the first critical speed
/// 0.7 s. Throws InvalidArgument for a mode number outside 1 ... `chain.mode_count()`, unless
/// exactly one number is given, if it is out of its range or is not reached, and for weights more
/// than 1e123 apart.
REVCHAIN_DECLARE
[[nodiscard]] SteadyShape steady_shape(const Chain<double>& chain, const OnBranchOptions& options);

/// The shape of a rig on one branch. Off the axis `mode` must be 1: the branch from rest.
/// `tip_inclination` is the magnitude of the lowest link's inclination, off the axis the
/// inclination outwards; it is between pi/2 and pi if that link stands. Throws InvalidArgument as
/// for chains, and for a rig that `branch` refuses.
REVCHAIN_DECLARE
[[nodiscard]] SteadyShape steady_shape(const Rig& rig, const RigOnBranchOptions& options);

/// The shapes on the branch at which the number has its given value, in the order of the arc, at
/// most `max_shapes`. The list is empty if the number is not reached. Otherwise as `steady_shape`.
REVCHAIN_DECLARE
[[nodiscard]] ShapesOnBranch shapes_on_branch(const Chain<double>& chain,
                                              const OnBranchOptions& options,
                                              std::size_t max_shapes = all_shapes);
REVCHAIN_DECLARE
[[nodiscard]] ShapesOnBranch shapes_on_branch(const Rig& rig, const RigOnBranchOptions& options,
                                              std::size_t max_shapes = all_shapes);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/branch/branches.hpp"
#endif
