// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/branch/branch.hpp"

namespace revchain {

/// What is asked of a shape on a branch: exactly one of these.
struct ShapeGiven {
    std::optional<double> conical_height{};
    std::optional<double> angular_speed{};    ///< rad/s, with `gravity`
    std::optional<double> tip_inclination{};  ///< of the lowest link, rad, above 0 and below a right angle
    std::optional<double> tip_radius{};       ///< of the free end from the axis
    std::optional<double> top_tension{};      ///< size of the reaction at the support
    double gravity = conical_pendulum::standard_gravity;
    /// How far down in conical height to look; absent: 1e-6 of that of the mode, and for all states at one height its
    /// half.
    std::optional<double> down_to{};
    bool all = false;  ///< else the first state from the vertical along the arc
};

/// States of one branch, in the order of its arc.
struct ShapesOnBranch {
    std::vector<SteadyShape> shapes;
    BranchEnd end = BranchEnd::height;  ///< why the search ended there
    double searched_to = 0;             ///< the conical height at which it did
};

namespace finite {

/// Looks along a branch for a number measured there.
template <class Measure>
class BranchSearch {
   public:
    using S = Wide<double>;
    BranchSearch(BranchRoot& root, const Measure& measure, const Condition<S>& condition, double amplitude)
        : root_(root), measure_(measure), condition_(condition), amplitude_(amplitude) {}

    /// Down to a log of conical height; the first state, or all.
    ShapesOnBranch run(double log_end, bool all) {
        ShapesOnBranch result;
        result.searched_to = root_.height;
        const BranchOnset& onset = root_.onset;
        constexpr double small = 0.02;
        double from = 0.1;
        if (amplitude_ * onset.steepest < small) {  // so near the vertical that the onset is known to 1e-3
            const BranchState near = onset.state(root_.corrector.links(), amplitude_);
            if (auto shape = close(near, amplitude_ * onset.steepest)) {
                result.shapes.push_back(std::move(*shape));
                result.searched_to = result.shapes.back().conical_height;
                if (!all) return result;
            }
            // past the state; farther out where double tells the branch from the vertical, what is wanted growing all
            // along
            from = result.shapes.empty() ? 0.1 * amplitude_ * onset.steepest
                                         : std::max(1e-5, 4 * amplitude_ * onset.steepest);
        } else {
            from = std::min(from, 0.25 * amplitude_ * onset.steepest);
        }
        // from nearer to the vertical where nothing is met before no step passes: see `branch`
        for (;; from /= 16) {
            const auto start = onset.start(root_.corrector, from);
            if (!start) {
                result.end = BranchEnd::stuck;
                return result;
            }
            ShapesOnBranch walked = walked_from(*start, result, log_end, all);
            if (walked.end != BranchEnd::stuck || walked.shapes.size() > result.shapes.size() || !(from > 1e-6))
                return walked;
        }
    }

   private:
    static constexpr int max_steps = 100'000;

    ShapesOnBranch walked_from(const BranchPoint& start, ShapesOnBranch result, double log_end, bool all) {
        BranchWalk walk(root_.corrector, start, start.arc);
        const HeightMeasure to_end{log_end};
        for (int step = 0; step < max_steps; ++step) {
            if (!walk.advance()) return stopped(result, walk, BranchEnd::stuck);
            const auto last = crossings_of(walk, to_end);
            for (const WithinStep& each : crossings_of(walk, measure_)) {
                if (!last.empty() && each.share > last.front().share + 1e-9) break;
                const double reach = walk.here().arc - walk.before().arc;
                if (auto shape = close(each.point.state, std::min(0.1, reach))) {
                    result.shapes.push_back(std::move(*shape));
                    if (!all) return stopped(result, walk, BranchEnd::height);
                }
            }
            if (!last.empty()) return stopped(result, walk, BranchEnd::height);
        }
        return stopped(result, walk, BranchEnd::budget);
    }

    ShapesOnBranch stopped(ShapesOnBranch& result, const BranchWalk& walk, BranchEnd end) const {
        result.end = end;
        result.searched_to = std::ldexp(std::exp(walk.here().state.log_height), root_.chain.units.length_exponent);
        return std::move(result);
    }
    /// The state of the condition next to one of the branch: no link farther from it than `farthest`, rad.
    std::optional<SteadyShape> close(const BranchState& near, double farthest) const {
        auto shape = shape_at(root_.chain, near, condition_);
        // next to the vertical the height is rounded to that of the mode, itself rounded
        if (!shape || !(shape->conical_height <= root_.height * (1 + 0x1p-50))) return std::nullopt;
        if (root_.corrector.half_waves_are_kept() && shape->half_waves != root_.onset.half_waves) return std::nullopt;
        double same = 0, mirrored = 0;  // the shape is given with its free end at a positive offset
        for (std::size_t m = 0; m < near.rise.size(); ++m) {
            const double here = shape->inclination[static_cast<Index>(m)], there = std::atan(std::sinh(near.rise[m]));
            same = std::max(same, std::abs(here - there)), mirrored = std::max(mirrored, std::abs(here + there));
        }
        if (!(std::min(same, mirrored) <= 0.3 * farthest)) return std::nullopt;
        return shape;
    }

    BranchRoot& root_;
    const Measure& measure_;
    const Condition<S>& condition_;
    double amplitude_;
};

/// The amplitude at which, to leading order, a number that grows with it in proportion is as wanted.
template <class Measure>
double amplitude_of(const BranchRoot& root, Measure measure, double wanted) {
    const double small = 1e-4 / root.onset.steepest;
    const BranchState state = root.onset.state(root.corrector.links(), small);
    return small * wanted / std::abs(measure({state, state}).value + wanted);
}

}  // namespace finite

/// States on the branch that leaves the vertical at mode `mode` (1 the slowest, as in `modes`) at which one number is
/// as given: conical height, speed, tip inclination, tip radius or top tension; the first along the arc, or all.
///
/// Method: continuation along the arc (see `branch`), then Newton's method on all pins and the height in double-double
/// with what is given as a condition. Next to the vertical the onset of the branch serves as a start.
/// Accuracy: at a given height or speed inclinations to 2.3e-16 and within `error_bound`, which is proved (measured:
/// 0.7 of it; 1 to 1000 links, modes 1 to 10, from 1e-8 above the critical speed to a conical height of 1e-4 of the
/// length: tests/cpp/finite/branch/branch.cpp). That the state is on this branch is checked step by step, not proved.
/// `shapes` is empty where the number is not met.
/// Cost: O(N), for 100,000 rods at twice the first critical speed 0.4 s.
/// Throws InvalidArgument for a mode that is none, for anything but one number given, for one out of its range, for a
/// `down_to` not below the height of the mode, and for a speed at which this branch does not exist yet.
inline ShapesOnBranch shapes_on_branch(const Chain<double>& chain, Index mode, const ShapeGiven& given) {
    constexpr std::string_view place = "steady_shape";
    using S = Wide<double>;
    const int count = given.conical_height.has_value() + given.angular_speed.has_value() +
                      given.tip_inclination.has_value() + given.tip_radius.has_value() + given.top_tension.has_value();
    if (count != 1)
        detail::throw_invalid(place,
                              "give exactly one of conical height, angular speed, tip inclination, tip radius and top "
                              "tension; given were",
                              count);
    if (given.down_to) detail::require_positive(place, "down_to", *given.down_to);
    finite::BranchRoot root = finite::BranchRoot::of(place, chain, mode);
    if (given.down_to && !(*given.down_to < root.height))
        detail::throw_invalid(
            place, "down_to must be less than the conical height of the mode, " + detail::in_digits(root.height),
            *given.down_to);
    const double unit = std::ldexp(1.0, -root.chain.units.length_exponent);
    const double lowest = given.down_to.value_or(1e-6 * root.height) * unit;
    const auto* links = &root.corrector.links();
    if (given.conical_height || given.angular_speed) {
        S height;
        if (given.conical_height) {
            detail::require_positive(place, "conical height", *given.conical_height);
            height = S(*given.conical_height);
        } else {
            detail::require_positive(place, "angular speed", *given.angular_speed);
            detail::require_positive(place, "gravity", given.gravity);
            height = finite::height_at_speed(*given.angular_speed, given.gravity);
            detail::require_positive(place, "gravity / angular speed^2", static_cast<double>(height));
        }
        const double near = static_cast<double>(height);
        if (!(near < root.height))
            detail::throw_invalid(place,
                                  "mode " + std::to_string(mode) + " leaves the vertical at the conical height " +
                                      detail::in_digits(root.height) +
                                      " and has no shape at one that is not less (it turns too slowly)",
                                  near);
        const double log_wanted = std::log(near * unit);
        return finite::BranchSearch(root, finite::HeightMeasure{log_wanted}, finite::GivenHeight<S>(height * S(unit)),
                                    finite::amplitude_at(root.chain, root.onset, height * S(unit)))
            .run(std::min(log_wanted, std::log(given.down_to.value_or(near / 2) * unit)), given.all);
    }
    const double log_end = std::log(lowest);
    if (given.tip_inclination) {
        if (!(*given.tip_inclination > 0 && *given.tip_inclination < 1.5707963267948966))
            detail::throw_invalid(place, "tip inclination must lie between 0 and pi/2", *given.tip_inclination);
        const double rise = std::asinh(std::tan(*given.tip_inclination));
        const finite::TipInclinationMeasure measure{rise};
        return finite::BranchSearch(root, measure, finite::GivenTipInclination<S>(*given.tip_inclination),
                                    finite::amplitude_of(root, measure, rise))
            .run(log_end, given.all);
    }
    if (given.tip_radius) {
        detail::require_positive(place, "tip radius", *given.tip_radius);
        if (!(*given.tip_radius < chain.total_length()))
            detail::throw_invalid(place, "tip radius must be less than the length of the chain", *given.tip_radius);
        const finite::TipRadiusMeasure measure{links, *given.tip_radius * unit};
        return finite::BranchSearch(root, measure, finite::GivenTipRadius<S>(S(*given.tip_radius * unit)),
                                    finite::amplitude_of(root, measure, measure.wanted))
            .run(log_end, given.all);
    }
    const double tension = *given.top_tension;
    const S weight = chain.weight_below(chain.size());
    if (!(S(tension) > weight) || !std::isfinite(tension))
        detail::throw_invalid(place, "top tension must be finite and more than the weight of the chain", tension);
    using std::sqrt;
    const S pull = ldexp(sqrt((S(tension) - weight) * (S(tension) + weight)), -root.chain.units.weight_exponent);
    const double narrow = static_cast<double>(pull);
    const finite::TopPullMeasure measure{links, narrow};
    const double share = std::pow(std::ldexp(tension, -root.chain.units.weight_exponent) / narrow, 2);
    return finite::BranchSearch(root, measure, finite::GivenTopTension<S>(pull, share),
                                finite::amplitude_of(root, measure, narrow))
        .run(log_end, given.all);
}

/// The first of them along the arc. Throws InvalidArgument also where the number is not met.
inline SteadyShape steady_shape(const Chain<double>& chain, Index mode, ShapeGiven given) {
    given.all = false;
    auto found = shapes_on_branch(chain, mode, given);
    if (found.shapes.empty())
        detail::throw_invalid(
            "steady_shape",
            "what is given is not met on the branch of mode " + std::to_string(mode) +
                "; looked down to the conical height, got " + detail::in_digits(found.searched_to) +
                (found.end != BranchEnd::height                ? "; it could not be followed farther"
                 : given.conical_height || given.angular_speed ? "; the state there did not pass every check"
                                                               : "; to look farther give a smaller down_to"));
    return std::move(found.shapes.front());
}

}  // namespace revchain
