// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "revchain/count.hpp"
#include "revchain/finite/held/branch.hpp"
#include "revchain/finite/held/cord_branch.hpp"
#include "revchain/finite/held/held.hpp"
#include "revchain/modes.hpp"
#include "revchain/system/cord.hpp"

/// A chain or a cord whose two ends are held on the axis: the blade of a wind turbine (troposkien),
/// a skipping rope, a string of weights.
///
///     const auto rods = revchain::Chain<double>::uniform_rods(40, 1.0);
///     const auto shapes = revchain::steady_shapes(revchain::Held(rods, {.span = 0.5}), {.angular_speed = 10.0});
///     shapes.shapes[0].offset.maxCoeff();   // 0.391553 m: the largest distance from the axis
///     shapes.shapes[0].error_bound;         // of every inclination, rad: proved
///     const auto m = revchain::modes(revchain::Held(rods, {.tension = 11.0}), {.count = 2});
///     m.angular_speed()[0];                 // 31.8773 rad/s: here the straight chain begins to whirl
///
/// Links and arrays begin at the lower end, which would be free if the chain or cord hung. Speeds
/// of a chain held straight are questions of `modes`, shapes at finite amplitude of
/// `steady_shapes`, and their stability of `stability`.
namespace revchain::inline REVCHAIN_BUILD {

/// How the two ends are held: give either `span` or `tension`.
struct HeldBy {
    std::optional<double> span{};     ///< distance of the two ends along the axis, less than the length
    /// at the upper end, in the unit of the weights; without gravity, newtons
    std::optional<Wide<double>> tension{};
    /// no gravity: weights are masses; at a span between firm ends shapes do not depend on speed
    bool weightless = false;
    Support lower{};          ///< of a chain: support of its lower end; a negative radius is on the other side
    Support upper{};          ///< of a chain: support of its upper end

    bool on_axis() const noexcept { return lower.radius == 0 && upper.radius == 0; }
    /// Whether every steady shape lies in a plane: no torque about the axis acts at an end whose
    /// radius is 0.
    bool planar() const noexcept { return lower.radius == 0 || upper.radius == 0; }
    bool firm() const noexcept { return lower.is_firm() && upper.is_firm(); }
};

/// A `Chain<double>` or a `Cord` held at both ends. It is checked once, here. The ends are firm
/// points on the axis by default. `lower` and `upper` put an end of a chain on a spring, equal in
/// all directions across the axis, or carry it round the axis at a radius, as two arms of a jib do.
/// Both ends and the axis lie in one plane.
///
/// Throws InvalidArgument unless exactly one of span and tension is given, positive and finite; for
/// a span that is not less than the length, firm ends as far apart as the length, a stiffness not
/// positive, a carriage weight that is negative or has no spring, numbers not finite, a radius with
/// a tension, springs or radii for a cord, and a cord that is not uniform or has a tip weight.
template <class System>
class Held {
    static_assert(std::is_same_v<System, Chain<double>> || std::is_same_v<System, Cord>);

   public:
    Held(System system, const HeldBy& by) : system_(std::move(system)), by_(by) {
        if (by.span.has_value() == by.tension.has_value())
            detail::throw_invalid("Held", std::string("give either span or tension, got ") +
                                              (by.span ? "both: span " + detail::in_digits(*by.span) + ", tension " +
                                                             detail::in_digits(by.tension->high)
                                                       : "neither"));
        if (by.tension) detail::require_positive("Held", "tension", by.tension->high);
        if (by.span) detail::require_positive("Held", "span", *by.span);
        if (by.span && !(*by.span < length()))
            detail::throw_invalid("Held", "span must be less than the length " + detail::in_digits(length()), *by.span);
        check("lower", by.lower), check("upper", by.upper);
        const double apart = by.span ? std::hypot(*by.span, by.upper.radius - by.lower.radius) : 0;
        if (by.firm() && by.span && !(apart < length()))
            detail::throw_invalid(
                "Held", "the ends must be nearer to each other than the length " + detail::in_digits(length()), apart);
        if constexpr (std::is_same_v<System, Cord>)
            if (!system_.is_uniform() || system_.tip_weight() != 0)
                detail::throw_invalid("Held",
                                      "a held cord must be uniform and without tip weight; for others cut it "
                                      "into links, as Chain::tapered does");
    }

    const System& system() const noexcept { return system_; }
    const HeldBy& by() const noexcept { return by_; }
    double length() const {
        if constexpr (std::is_same_v<System, Cord>)
            return system_.length();
        else
            return system_.total_length();
    }

   private:
    void check(const std::string& name, const Support& end) const {
        if (!(end.stiffness.high > 0))
            detail::throw_invalid("Held", name + " stiffness must be positive", end.stiffness.high);
        detail::require_not_negative("Held", name + " carriage weight", end.carriage_weight);
        detail::require_finite("Held", name + " radius", end.radius);
        detail::require_yielding("Held", name + " end", end);
        if (by_.tension && end.radius != 0)
            detail::throw_invalid(
                "Held", "under a tension both ends must be on the axis; give the span instead; " + name + " radius",
                end.radius);
        if (std::is_same_v<System, Cord> && !(end == Support{}))
            detail::throw_invalid(
                "Held", "the ends of a cord are firm points on the axis; cut it into links; " + name + " stiffness",
                end.stiffness.high);
    }

    System system_;
    HeldBy by_;
};

/// The speed, and the numbers of half waves to look for. With gravity give either `conical_height`
/// or `angular_speed`. Without gravity give `angular_speed` with a tension or with springs; with a
/// span between firm ends it is optional.
struct HeldShapesOptions {
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};                ///< rad/s
    double gravity = conical_pendulum::standard_gravity;  ///< along the axis, with `angular_speed`
    int max_half_waves = 1;                               ///< largest number of half waves to look for
    bool prove = true;      ///< whether error bounds and completeness are proved
    long budget = 300'000;  ///< of the proof of completeness: links looked at, 1 to 2 microseconds each
};

/// At which speed shapes of a held cord are wanted, and how many half waves they may have. They are
/// not proved.
struct HeldCordShapesOptions {
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};  ///< rad/s
    double gravity = conical_pendulum::standard_gravity;
    int max_half_waves = 1;
};

/// Steady shapes at finite amplitude (troposkien) of 1 to `max_half_waves` half waves, sorted by
/// half waves. Half waves are counted about the line between the places of rest of the two ends;
/// ends on springs count as pins do. The first shape of each number is reached from the nearly
/// straight chain without gravity: the ends are drawn together, then brought to their radii and
/// springs, then gravity grows. For a tension there follow all other shapes on that branch with
/// this tension at the upper end. For a chain there follows every other shape found. Every link is
/// in tension. `missing` lists the numbers of half waves for which no shape was found. `complete`
/// true: it is proved that no other shape has one of these numbers of half waves. Otherwise
/// `undecided` gives the ranges of the lowest link's inclination (rad) of possible other shapes in
/// the plane of the axis and the ends. For a cord `complete` is true only at a span without
/// gravity. If both radii differ from 0, the arms can twist the chain, and shapes that leave that
/// plane may exist. They are not looked for, and `complete` is false. `HeldBy::planar` is true for
/// all other ends: every shape then lies in a plane.
///
/// `HeldShape` (finite/held/shape.hpp) and `HeldCordShape` (finite/held/cord.hpp) give forces times
/// the conical height. Divide by `conical_height` for the unit of the weights; without gravity
/// multiply by the square of the speed for newtons. A branch has a narrow range of tensions: those
/// of the skipping rope lie between 1/(pi k)^2 and 1/(8 k^2) of mass times length times the speed
/// squared, for k half waves. With gravity the tension has a maximum along the branch, so that two
/// spans have the same tension. Method for chains: the two forces at the lower end are the unknowns
/// of the upward sweep of Greenhill (1908) section 8 (21), with exact derivatives. A curve is
/// followed by its arc in double, Newton's method takes over in double-double, and Krawczyk's test
/// in intervals of double-double proves the bound. The list is proved complete by splitting all
/// pulls along the lowest link, and all its inclinations, until each part has one shape for certain
/// or none (finite/held/search.hpp). Lists proved complete (tests/cpp/held.cpp): 99 of 108 for 3, 6
/// and 9 links with l <= a and one half wave; none for chains with l > a or with massless links
/// between others; few for two half waves or more. Where several links are slack at once, as beads
/// can be without gravity, a range of some 1e-7 is left. On arms and springs nothing is left
/// undecided in all of 36 for 3 links and two half waves, and in 25 of 36 for 4 links and three;
/// above the resonance of a carriage on its spring in 8 of 24 for 3 links and three
/// (tests/python/test_held_ends.py has part of them). Method for cords: power series of degree 24;
/// without gravity the shape is that of section 5, y = b sn(K x/a). Accuracy: inclinations of
/// chains are correctly rounded up to an error of 1e-20, and their bound is mostly proved
/// (tests/cpp/held.cpp). Places of cords are within 1e-13 of the length, and their bound is an
/// estimate. The tension agrees with the one given to 1e-15, relative. Cost: about 100 sweeps of
/// 0.1 microseconds a link, or 100 paths of 20 microseconds for a cord; for a tension the whole
/// branch, some thousand sweeps. The proof of completeness takes 10 to 500 ms; `budget` 0 leaves it
/// out. Throws InvalidArgument where the speed is not given as above or is not positive and finite,
/// where g/n^2 leaves the range of double, for `max_half_waves` below 1, and for weights more than
/// 1e123 apart.
[[nodiscard]] HeldShapes steady_shapes(const Held<Chain<double>>& held,
                                       const HeldShapesOptions& options = {});
[[nodiscard]] HeldCordShapes steady_shapes(const Held<Cord>& held,
                                           const HeldCordShapesOptions& options = {});

/// Which modes of a chain held straight under a tension: as in `ModesOptions`. There is one method.
struct HeldModesOptions {
    Index first = 1;
    std::optional<Index> count{};
    std::optional<HeightWindow<double>> conical_height{};
    std::optional<SpeedWindow<double>> angular_speed{};
    std::optional<double> rtol{};  ///< bounds above it are `Status::tolerance_not_met`
    double gravity = conical_pendulum::standard_gravity;  ///< for windows of speed, and without weight
    bool certify = false;
    Index threads = 1;  ///< 0: all processors
    Progress* progress = nullptr;
};

/// Whirl modes of small amplitude of the straight chain under a tension, slowest first; `first`,
/// `count` and windows choose them as they do for a hanging chain. Ends on springs move with the
/// chain. In `shapes` firm ends are 0, the largest offset is 1, and that of the lowest pin that
/// moves is positive; nodes are distances from the lower end. Shapes of finite amplitude begin at
/// these heights, where the span is nearly the length. Without gravity a height is `gravity` over
/// the square of the speed, with the gravity of the options. Modes of a held cord: cord.hpp.
///
/// Method: the chain is made of elements as a hanging one is, and stands on the lowest link or
/// spring. Counts in double, then for each mode a shape and its quotient in
/// double-double, and two proved counts. Accuracy: `error_bound` is proved, 1 ulp; wider
/// for a few modes of links 1e9 times lighter than their neighbours (docs/accuracy.md). The exact
/// height is that of the numbers given: a tension and a stiffness whose second word is not 0 are
/// taken as quotients that were rounded once. Cost: 2 microseconds a link and mode, 0.5 for each
/// shape.
/// Throws InvalidArgument for a span (small motion about a bent shape is a question of stability),
/// for a tension that does not exceed the weight (the chain would not be straight) or is beyond its
/// range, for wrong numbers and windows as `modes` of a chain does, and where rounding leaves in
/// doubt how many modes lie in a window. N links have N - 1 modes, one more for each end on a
/// spring, less one for each pin that moves without mass.
[[nodiscard]] Modes<double> modes(const Held<Chain<double>>& held,
                                  const HeldModesOptions& options = {});

/// The number of modes of the straight chain under tension that are slower than a speed, proved as
/// for a rig. Cost: 0.5 microseconds a link. Throws InvalidArgument unless exactly one of height
/// and speed is given, positive and finite, and as `modes` does.
[[nodiscard]] Index count_modes(const Held<Chain<double>>& held, const CountOptions<double>& options);

/// How far branches go: give one of the first two.
struct HeldDiagramOptions {
    std::optional<double> min_conical_height{};
    std::optional<double> max_angular_speed{};  ///< rad/s
    double gravity = conical_pendulum::standard_gravity;
    double max_step = 0.1;  ///< between two shapes: relative change of the forces at the end and of the height
};

/// The branches of a chain or cord held at a span, one for each number of half waves from 1 up to
/// the last that has a shape at the greatest speed. Each begins there, with the shape that is
/// reached from the nearly straight one without gravity between firm ends on the axis (radii and
/// the springs' compliances are then brought in). It is followed to slower speeds, through folds,
/// until one of these happens: a link becomes slack or turns over (`slack`), the cord hangs folded
/// along the axis (`folded`), the greatest speed is reached again (`speed`), the conical height is
/// 10,000 lengths (`rest`: off the axis), or 3000 steps are done (`budget`). There is no `branch`
/// of one mode: `HeldBranch::mode` says which branch is which. Between ends off the axis there are
/// two branches for each number: modes 2 k - 1, whose lowest link first leads outwards, and 2 k,
/// inwards. A branch that comes back to the greatest speed where another would begin stands for
/// both.
///
/// Method: by the arc of (force across, force along, height) at constant span; shapes are finished
/// in double-double, at folds in double. Branches that begin elsewhere, or leave the plane of the
/// ends, are not looked for: `steady_shapes` can prove at a speed that there are no other shapes.
/// Accuracy: 1e-15 rad where `condition` is moderate, an estimate. Cost: some hundred shapes of 10
/// sweeps each. Throws InvalidArgument for a tension, without gravity, for a step not positive, and
/// unless exactly one of height and speed is given, positive and finite. A cord folds as it
/// approaches the slowest speed, at which one of its two straight parts, hung from its end, begins
/// to whirl. Its offsets vanish there faster than any power of the difference of speeds, so the
/// last speed found is some percent higher.
[[nodiscard]] std::vector<HeldBranch> branches(const Held<Chain<double>>& held,
                                               const HeldDiagramOptions& options);
[[nodiscard]] std::vector<HeldCordBranch> branches(const Held<Cord>& held,
                                                   const HeldDiagramOptions& options);

/// Which shape of a branch. Give one of `conical_height`, `angular_speed` and `top_tension`.
struct HeldOnBranchOptions {
    int mode = 1;  ///< number of half waves at the start of the branch; off the axis see `branches`
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};  ///< rad/s
    std::optional<double> top_tension{};    ///< at the upper end, in the unit of the weights
    double gravity = conical_pendulum::standard_gravity;
};

/// The shape of a chain or cord held at a span on the branch of `mode`. At a speed it is the one
/// reached from the nearly straight chain. With a tension at the upper end it is the fastest shape
/// with this tension (its speed: `angular_speed()`). Accuracy: inclinations as of `steady_shapes`;
/// the height for a tension to 1e-14. Throws InvalidArgument as `branches` does, for a mode below
/// 1, a tension between springs, and where the branch does not reach what is given.
[[nodiscard]] HeldShape steady_shape(const Held<Chain<double>>& held,
                                     const HeldOnBranchOptions& options);
[[nodiscard]] HeldCordShape steady_shape(const Held<Cord>& held,
                                         const HeldOnBranchOptions& options);

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/questions/held.hpp"
#endif
