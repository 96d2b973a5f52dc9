// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/branches.hpp"
#include "revchain/finite/branch/diagram.hpp"
#include "revchain/finite/branch/shape_on_branch.hpp"
#include "revchain/finite/branch/trace.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD {

// If a program includes diagram.hpp first, this file is read before the definitions there.
namespace finite {
template <class Means>
class ChainQuestions;
template <class Means>
class RigQuestions;
template <class Questions, class System, class Options, class Means>
Branches diagram_of(const System& system, const Options& options, Means means);
template <class Means>
Branches diagram_of(const Chain<double>& chain, const DiagramOptions& options, Means means) {
    return diagram_of<ChainQuestions<Means>>(chain, options, means);
}
/// The proof for rigs does not cover massless threads; that for chains does.
template <class Means>
Branches diagram_of(const Rig& rig, const RigDiagramOptions& options, Means means) {
    if (!rig.is_plain_chain() || rig.support().radius != 0)
        return diagram_of<RigQuestions<Means>>(rig, options, means);
    return diagram_of(rig.chain(),
                      DiagramOptions{.min_conical_height = options.min_conical_height,
                                     .max_angular_speed = options.max_angular_speed,
                                     .max_points = options.max_points,
                                     .max_step = options.max_step,
                                     .lists = options.lists,
                                     .budget = options.budget,
                                     .proof_budget = options.proof_budget,
                                     .gravity = options.gravity},
                      means);
}
}  // namespace finite

REVCHAIN_INLINE SteadyShape Branch::shape(std::size_t point) const {
    const auto reject = [&](std::string_view what) {
        detail::throw_invalid("Branch::shape", what, point);
    };
    if (point >= size())
        reject("point must be below " + std::to_string(size()) + ", the number of points");
    const finite::BranchPoint& at = trace_.points[point];
    if (trace_.onset && finite::largest_tau(at.state) == 0)
        reject("this point is the straight chain");
    const auto found = finite::shape_at(*trace_.system, at.state, finite::GivenPlace(at));
    if (!found) reject("the shape at this point did not balance in double-double");
    return *found;
}

REVCHAIN_INLINE std::vector<SteadyShape> Branch::shapes_at(double height) const {
    detail::require_positive("Branch::shapes_at", "conical height", height);
    if (size() == 0) return {};
    finite::Corrector corrector(finite::rounded(trace_.system->links));
    return finite::states_at(*this, corrector, height);
}

namespace finite {

/// Follows the branch from rest: from a tenth of the first critical or of a slower given speed.
template <class Options>
Branch from_rest(BranchRoot root, double conical_height, const Options& options) {
    Branch result;
    result.mode = 1, result.birth = BranchBirth::rest, result.end = BranchEnd::stuck;
    trace_of(result).system = root.system;
    const double unit = std::ldexp(1.0, -root.system->units.length_exponent);
    const auto start = root.at_rest(std::log(100 * std::max(conical_height, root.height) * unit));
    if (!start) return result;
    append(result, *start);
    BranchWalk walk(root.corrector, *start, options.max_step, options.max_step);
    const double log_end = std::log(conical_height * unit), log_top = start->state.log_height + 1;
    result.end = follow(result, walk, log_end, options.max_points, log_top);
    return result;
}

template <class Options>
Branch from_vertical(BranchRoot root, double conical_height, const Options& options) {
    Branch result;
    result.mode = options.mode;
    trace_of(result).system = root.system;
    const double unit = std::ldexp(1.0, -root.system->units.length_exponent);
    const double log_end = std::log(conical_height * unit);
    trace_of(result).onset = std::make_shared<const BranchOnset>(std::move(*root.onset));
    const BranchOnset& onset = *trace_of(result).onset;
    BranchPoint vertical = onset.point(root.corrector.links(), 1e-7 / onset.steepest);
    vertical.state = {std::vector<double>(root.corrector.size(), 0.0), std::log(onset.height)};
    vertical.tangent.log_height = 0, vertical.arc = 0;
    append(result, vertical);
    result.conical_height.front() = root.height;  // without the rounding of the logarithm
    if (result.size() >= options.max_points) return result;
    const double steepness =
        onset.rises() ? 0.4 : onset.amplitude_at(conical_height * unit) * onset.steepest;
    if (steepness < 1e-3) {
        const auto only =
            near_vertical(*trace_of(result).system, onset, Fine(conical_height * unit));
        result.end = only ? BranchEnd::height : BranchEnd::stuck;
        if (only) append(result, *only), result.conical_height.back() = conical_height;
        return result;
    }
    const double log_top = std::log(100 * std::max(conical_height, root.height) * unit);
    // if modes almost coincide the first step may miss the branch: start closer to the vertical
    const Branch only_vertical = result;
    for (double from = std::min(0.1, 0.25 * steepness); from > 1e-6; from /= 16) {
        const auto start = onset.start(root.corrector, from);
        if (!start) break;
        Branch attempt = only_vertical;
        append(attempt, *start);
        BranchWalk walk(root.corrector, *start, start->arc, options.max_step);
        attempt.end = follow(attempt, walk, log_end, options.max_points, log_top);
        const bool followed = attempt.end != BranchEnd::stuck;
        if (followed || attempt.size() > result.size()) result = std::move(attempt);
        if (followed) return result;
    }
    result.end = BranchEnd::stuck;
    return result;
}

template <class System, class Options>
Branch followed(const System& system, const Options& options) {
    const double conical_height = lowest_height("branch", options);
    BranchRoot root = BranchRoot::of("branch", system, options);
    if (!root.onset) return from_rest(std::move(root), conical_height, options);
    if (!(conical_height < root.height))
        detail::throw_invalid(
            "branch",
            "mode " + std::to_string(options.mode) + " leaves the vertical at the conical height " +
                detail::in_digits(root.height) + ": the height to follow it to must be less",
            conical_height);
    return from_vertical(std::move(root), conical_height, options);
}

}  // namespace finite

REVCHAIN_DEFINE
Branch branch(const Chain<double>& chain, const BranchOptions& options) {
    return finite::followed(chain, options);
}
REVCHAIN_DEFINE
Branch branch(const Rig& rig, const RigBranchOptions& options) {
    return finite::followed(rig, options);
}

namespace finite {

template <class System, class Options>
SteadyShape first_on_branch(const System& system, const Options& options) {
    ShapesOnBranch found = search_branch<ShapesOnBranch>(system, options, 1);
    if (found.shapes.empty())
        detail::throw_invalid(
            "steady_shape",
            "what is given is not met on the branch " +
                (found.from_rest ? std::string("from rest")
                                 : "of mode " + std::to_string(options.mode)) +
                "; looked down to the conical height " + detail::in_digits(found.searched_to) +
                (found.end == BranchEnd::loose
                     ? "; there the spring at the support no longer holds the whole"
                 : found.end != BranchEnd::height ? "; it could not be followed farther"
                 : options.conical_height || options.angular_speed
                     ? "; the state there did not pass every check"
                     : "; to look farther give a smaller min_conical_height"));
    return std::move(found.shapes.front());
}

}  // namespace finite

REVCHAIN_DEFINE
ShapesOnBranch shapes_on_branch(const Chain<double>& chain, const OnBranchOptions& options,
                                std::size_t max_shapes) {
    return finite::search_branch<ShapesOnBranch>(chain, options, max_shapes);
}
REVCHAIN_DEFINE
ShapesOnBranch shapes_on_branch(const Rig& rig, const RigOnBranchOptions& options,
                                std::size_t max_shapes) {
    return finite::search_branch<ShapesOnBranch>(rig, options, max_shapes);
}
REVCHAIN_DEFINE
SteadyShape steady_shape(const Chain<double>& chain, const OnBranchOptions& options) {
    return finite::first_on_branch(chain, options);
}
REVCHAIN_DEFINE
SteadyShape steady_shape(const Rig& rig, const RigOnBranchOptions& options) {
    return finite::first_on_branch(rig, options);
}
REVCHAIN_DEFINE
Branches branches(const Chain<double>& chain, const DiagramOptions& options) {
    return finite::diagram_of(chain, options, detail::UsualMeans{});
}
REVCHAIN_DEFINE
Branches branches(const Rig& rig, const RigDiagramOptions& options) {
    return finite::diagram_of(rig, options, detail::UsualMeans{});
}
REVCHAIN_DEFINE
Branches branches(const Chain<double>& chain, const DiagramOptions& options, Thorough) {
    return finite::diagram_of(chain, options, thorough);
}
REVCHAIN_DEFINE
Branches branches(const Rig& rig, const RigDiagramOptions& options, Thorough) {
    return finite::diagram_of(rig, options, thorough);
}

}  // namespace revchain
