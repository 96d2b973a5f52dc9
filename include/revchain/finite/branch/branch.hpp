// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>

#include "revchain/finite/branch/continuation.hpp"
#include "revchain/finite/branch/crossing.hpp"
#include "revchain/finite/branch/onset.hpp"
#include "revchain/finite/shapes/verification.hpp"
#include "revchain/linear/one_mode.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain {

/// Why a branch was not followed further.
enum class BranchEnd {
    height,    ///< at the conical height asked for
    vertical,  ///< back at the straight chain
    closed,    ///< at the point it started from
    budget,    ///< after so many points
    stuck,     ///< no step could be taken that passes every check
};
inline std::string_view to_string(BranchEnd end) {
    constexpr std::string_view names[]{"height", "vertical", "closed", "budget", "stuck"};
    return names[static_cast<std::size_t>(end)];
}

/// A branch of steady shapes, point by point along its arc, in the units of the chain.
///
/// Arc is measured by the root of the mean square of dtau over the links, tan(inclination) = sinh tau, and of
/// d log(conical height).
struct Branch {
    Index mode = 0;  ///< the mode at which it leaves the vertical; 0: an isolated one
    std::vector<double> arc, conical_height, tip_inclination, tip_radius, top_tension, moment_of_inertia,
        effective_energy;
    std::vector<int> half_waves;     ///< sign changes of the offsets, and one
    std::vector<std::size_t> folds;  ///< points at which the conical height turns, each located by itself
    BranchEnd end = BranchEnd::budget;

    std::size_t size() const { return arc.size(); }
    double angular_speed(std::size_t point, double gravity = conical_pendulum::standard_gravity) const {
        return conical_pendulum::angular_speed(conical_height[point], gravity);
    }
    /// The shape at a point, balanced in double-double. Throws InvalidArgument for the straight chain and past the end.
    SteadyShape shape(std::size_t point) const;

    std::shared_ptr<const finite::Links<Wide<double>>> links;
    std::vector<finite::BranchPoint> points;
    std::shared_ptr<const finite::BranchOnset> onset;  ///< of the mode; null for an isolated branch
};

namespace finite {

/// The shape next to a point of a branch at which one condition holds: at a given height with what `verified` proves.
/// Where the height is found from something else that is proved of the shape at that height, and the bound adds what
/// Newton's method left of the balance, times the condition; where nothing is proved, as at a fold, it is that alone.
inline std::optional<SteadyShape> shape_at(const Links<Wide<double>>& chain, const BranchState& near,
                                           const Condition<Wide<double>>& condition) {
    auto found = polished(chain.links, near, condition);
    if (!found.shape.converged) return std::nullopt;
    const bool given = condition.gives_height();
    const auto height =
        given ? enclosed<DoubleDouble>(found.height) : Interval<DoubleDouble>(DoubleDouble(found.height));
    SteadyShape shape =
        verified_shape(chain, enclosed<DoubleDouble>(chain.links), found.height, height, std::move(found.shape), given);
    const bool proved = shape.error_bound < 1;
    if (given && proved) return shape;
    shape.condition = found.condition;
    shape.error_bound = (proved ? shape.error_bound : 0x1p-52) + found.condition * (found.residual + 1e-30);
    return shape;
}

/// Appends a point, with what is told of it, to a branch.
inline void append(Branch& branch, const BranchPoint& point) {
    const auto& chain = *branch.links;
    const auto length = [&](double x) { return std::ldexp(x, chain.units.length_exponent); };
    const auto weight = [&](double x) { return std::ldexp(x, chain.units.weight_exponent); };
    const double height = std::exp(point.state.log_height);
    double y = 0, sideways = 0, weights = 0, inertia = 0, energy = 0;
    for (std::size_t m = chain.links.size(); m-- > 0;) {
        const auto& link = chain.links[m];
        const double a = static_cast<double>(link.length), moment = static_cast<double>(link.moment),
                     rest = static_cast<double>(link.rest), d = a * std::tanh(point.state.rise[m]);
        const double upper = y;
        y += d;
        sideways += moment * y + rest * upper, weights += moment + rest;
        inertia += moment * y * y + rest * upper * upper - static_cast<double>(link.cross) * d * d;
        energy -= static_cast<double>(link.pull) * a / std::cosh(point.state.rise[m]);
    }
    branch.arc.push_back(point.arc), branch.conical_height.push_back(length(height));
    branch.tip_inclination.push_back(std::atan(std::sinh(point.state.rise[0])));
    branch.tip_radius.push_back(length(y)), branch.half_waves.push_back(point.half_waves);
    branch.top_tension.push_back(weight(std::hypot(weights, sideways / height)));
    branch.moment_of_inertia.push_back(weight(std::ldexp(inertia, 2 * chain.units.length_exponent)));
    branch.effective_energy.push_back(weight(length(energy - inertia / (2 * height))));
    branch.points.push_back(point);
}

/// The mode a branch starts from, and its links.
struct BranchRoot {
    Links<Wide<double>> chain;
    Corrector corrector;
    BranchOnset onset;
    double height;  ///< of the mode, in the chain's unit

    static BranchRoot of(std::string_view place, const Chain<double>& chain, Index mode) {
        if (mode < 1 || mode > chain.mode_count())
            revchain::detail::throw_invalid(
                place, "mode must be from 1 to the number of modes, " + std::to_string(chain.mode_count()), mode);
        const auto found = revchain::detail::one_mode(chain, mode);
        auto links = links_of(chain);
        const double height = found.conical_height, unit = std::ldexp(1.0, -links.units.length_exponent);
        auto narrow = rounded<double>(links.links);
        BranchOnset onset(narrow, found.shape, height * unit);
        return {std::move(links), Corrector(std::move(narrow)), std::move(onset), height};
    }
};

/// Whether a step passes the point where a loop began, going the same way.
inline bool returned(const BranchPoint& here, const BranchPoint& before, const BranchPoint& start) {
    const double reach = here.arc - before.arc;
    if (!(before.arc > start.arc) || inner(here.tangent, start.tangent) < 0.5) return false;
    const BranchState from_before = moved(start.state, -1, before.state),
                      from_here = moved(start.state, -1, here.state);
    return inner(from_before, from_before) < 2 * reach * reach && inner(from_before, before.tangent) >= 0 &&
           inner(from_here, here.tangent) < 0;
}

/// Whether a step goes through the straight chain to the mirror image.
inline bool mirrored(const BranchPoint& before, const BranchPoint& here) {
    double sum = 0;
    for (std::size_t m = 0; m < here.state.rise.size(); ++m) sum += before.state.rise[m] * here.state.rise[m];
    return sum < 0;
}

/// Goes on with a branch until it first comes down to `log_end`; folds are put in where they lie.
inline BranchEnd follow(Branch& branch, BranchWalk& walk, double log_end, std::size_t most_points) {
    const HeightMeasure to_end{log_end};
    const BranchPoint start = walk.here();
    while (branch.size() < most_points) {
        if (!walk.advance()) return BranchEnd::stuck;
        const BranchPoint &before = walk.before(), &here = walk.here();
        if (mirrored(before, here)) return BranchEnd::vertical;
        auto crossings = crossings_of(walk, to_end);
        std::erase_if(crossings, [](const WithinStep& each) { return each.point.tangent.log_height > 0; });
        const double until = crossings.empty() ? 1.0 : crossings.front().share;
        if (before.tangent.log_height * here.tangent.log_height < 0)
            if (const auto fold = turning_of(walk, to_end); fold && fold->share < until) {
                append(branch, fold->point);
                branch.folds.push_back(branch.size() - 1);
                if (branch.size() >= most_points) return BranchEnd::budget;
            }
        if (!crossings.empty()) {
            append(branch, crossings.front().point);
            return BranchEnd::height;
        }
        if (here.state.log_height < log_end) return BranchEnd::stuck;  // passed the end unseen
        if (returned(here, before, start)) {
            append(branch, start);
            return BranchEnd::closed;
        }
        append(branch, here);
    }
    return BranchEnd::budget;
}

}  // namespace finite

inline SteadyShape Branch::shape(std::size_t point) const {
    if (point >= size())
        detail::throw_invalid("Branch::shape", "there are so many points: " + std::to_string(size()), point);
    if (finite::largest_rise(points[point].state) == 0)
        detail::throw_invalid("Branch::shape", "this point is the straight chain", point);
    const auto found = finite::shape_at(*links, points[point].state, finite::GivenPlace<Wide<double>>(points[point]));
    if (!found)
        detail::throw_invalid("Branch::shape", "the shape at this point did not balance in double-double", point);
    return *found;
}

struct BranchOptions {
    std::size_t most_points = 10'000;
    double longest_step = 0.1;  ///< along the arc
};

/// The branch of steady shapes that leaves the vertical at mode `mode` (1 the slowest), followed by its arc through
/// every fold until it first comes down to `conical_height`.
///
/// Method: pseudo-arclength continuation from the mode, all pins at once by tridiagonal elements, in double. A step is
/// checked: see finite::BranchWalk. Points are good to about 1e-12 (measured); `shape` gives them in double-double;
/// folds are located to 1e-6 of the arc, their heights to 1e-13, mostly an ulp. Where all of the branch asked for is
/// inclined by less than 1e-3 it is the vertical and its end, from the onset's law and balanced in double-double; where
/// no double can tell that end from the vertical it is the vertical alone, `stuck`. Cost: 4 to 7 O(N) Newton steps a
/// point, some 0.1 microseconds a link each, and 3 N numbers of memory a point.
/// Throws InvalidArgument for a mode that is none, and for a height that is not positive or not below that of the mode.
inline Branch branch(const Chain<double>& chain, Index mode, double conical_height, const BranchOptions& options = {}) {
    detail::require_positive("branch", "conical height", conical_height);
    finite::BranchRoot root = finite::BranchRoot::of("branch", chain, mode);
    if (!(conical_height < root.height))
        detail::throw_invalid("branch",
                              "mode " + std::to_string(mode) + " leaves the vertical at the conical height " +
                                  detail::in_digits(root.height) + ": the height to follow it to must be less",
                              conical_height);
    Branch result;
    result.mode = mode;
    result.links = std::make_shared<const finite::Links<Wide<double>>>(std::move(root.chain));
    const double unit = std::ldexp(1.0, -result.links->units.length_exponent);
    const double log_end = std::log(conical_height * unit);
    result.onset = std::make_shared<const finite::BranchOnset>(std::move(root.onset));
    const finite::BranchOnset& onset = *result.onset;
    finite::BranchPoint vertical{{std::vector<double>(root.corrector.size(), 0.0), std::log(onset.height)}, {}, 0, 0};
    vertical.half_waves = onset.half_waves;
    // the direction there: along the mode
    const double small = 1e-7 / onset.steepest;
    vertical.tangent = onset.point(root.corrector.links(), small).tangent;
    vertical.tangent.log_height = 0;
    finite::append(result, vertical);
    result.conical_height.front() = root.height;  // no logarithm's rounding
    if (result.size() >= options.most_points) return result;
    const double steepness = onset.amplitude_at(conical_height * unit) * onset.steepest;
    if (steepness < 1e-3) {
        const auto only = finite::near_vertical(*result.links, onset, Wide<double>(conical_height * unit));
        result.end = only ? BranchEnd::height : BranchEnd::stuck;
        if (only) finite::append(result, *only), result.conical_height.back() = conical_height;
        return result;
    }
    // where modes all but coincide the first step may miss the branch, which ends it soon: then from nearer to the
    // vertical
    const Branch only_vertical = result;
    for (double from = std::min(0.1, 0.25 * steepness); from > 1e-6; from /= 16) {
        const auto start = onset.start(root.corrector, from);
        if (!start) break;
        Branch attempt = only_vertical;
        finite::append(attempt, *start);
        finite::BranchWalk walk(root.corrector, *start, start->arc);
        walk.longest = options.longest_step;
        attempt.end = finite::follow(attempt, walk, log_end, options.most_points);
        const bool kept = attempt.end != BranchEnd::stuck;
        if (kept || attempt.size() > result.size()) result = std::move(attempt);
        if (kept) return result;
    }
    result.end = BranchEnd::stuck;
    return result;
}

}  // namespace revchain
