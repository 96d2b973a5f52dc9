// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <functional>

#include "revchain/branches.hpp"
#include "revchain/finite/branch/diagram_proof.hpp"
#include "revchain/finite/branch/shape_on_branch.hpp"
#include "revchain/finite/branch/trace.hpp"
#include "revchain/finite/shapes/list.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain {

namespace finite {

/// The conical height down to which to follow branches, given as it is or as a speed.
template <class Options>
double lowest_height(std::string_view place, const Options& options) {
    if (options.min_conical_height.has_value() == options.max_angular_speed.has_value())
        revchain::detail::throw_invalid(place, "give either min_conical_height or max_angular_speed");
    const double height = options.min_conical_height
                              ? *options.min_conical_height
                              : conical_pendulum::height(*options.max_angular_speed, options.gravity);
    revchain::detail::require_positive(
        place, options.min_conical_height ? "min_conical_height" : "gravity / max_angular_speed^2", height);
    return height;
}

}  // namespace finite

REVCHAIN_INLINE SteadyShape Branch::shape(std::size_t point) const {
    if (point >= size())
        detail::throw_invalid("Branch::shape", "there are so many points: " + std::to_string(size()), point);
    if (finite::largest_rise(points[point].state) == 0)
        detail::throw_invalid("Branch::shape", "this point is the straight chain", point);
    const auto found = finite::shape_at(*links, points[point].state, finite::GivenPlace<Wide<double>>(points[point]));
    if (!found)
        detail::throw_invalid("Branch::shape", "the shape at this point did not balance in double-double", point);
    return *found;
}

REVCHAIN_INLINE std::vector<SteadyShape> Branch::shapes_at(double height) const {
    detail::require_positive("Branch::shapes_at", "conical height", height);
    if (size() == 0) return {};
    finite::Corrector corrector(finite::rounded<double>(links->links));
    return finite::states_at(*this, corrector, height);
}

REVCHAIN_INLINE Branch branch(const Chain<double>& chain, const BranchOptions& options) {
    const double conical_height = finite::lowest_height("branch", options);
    const Index mode = options.mode;
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
    if (result.size() >= options.max_points) return result;
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
        walk.longest = options.max_step;
        attempt.end = finite::follow(attempt, walk, log_end, options.max_points);
        const bool kept = attempt.end != BranchEnd::stuck;
        if (kept || attempt.size() > result.size()) result = std::move(attempt);
        if (kept) return result;
    }
    result.end = BranchEnd::stuck;
    return result;
}

namespace finite {

/// The branch through a state, followed from there on the side of `across`, a direction it does not lie across, until
/// it comes back or down to `log_end`.
inline Branch branch_from(const Chain<double>& chain, const BranchState& at, const BranchState& across, int half_waves,
                          double log_end, const BranchesOptions& options) {
    Branch result;
    result.links = std::make_shared<const Links<Wide<double>>>(links_of(chain));
    Corrector corrector(rounded<double>(result.links->links));
    auto start = corrector.corrected(at, across, 0.1);
    if (!start) {
        result.end = BranchEnd::stuck;
        return result;
    }
    if (start->half_waves == 0) start->half_waves = half_waves;
    append(result, *start);
    BranchWalk walk(corrector, *start, 0.02);
    walk.longest = options.max_step;
    result.end = follow(result, walk, log_end, options.max_points);
    return result;
}

/// Branches and proved lists of shapes brought together.
class Diagram {
   public:
    Diagram(const Chain<double>& chain, double lowest, const BranchesOptions& options)
        : chain_(chain),
          options_(options),
          links_(links_of(chain)),
          unit_(std::ldexp(1.0, -links_.units.length_exponent)),
          log_end_(std::log(lowest * unit_)),
          corrector_(rounded<double>(links_.links)) {
        result_.conical_height = lowest;
        result_.consistent = true;
    }

    Branches run() {
        Index count = count_modes(chain_, {.conical_height = result_.conical_height});
        result_.complete = count == 0;  // see steady_shapes
        // at the very height of a mode, as rounded, its branch is not there yet
        while (count > 0 && !(result_.conical_height < height_of(count))) --count;
        if (count == 0) {
            result_.remark = "no shape leaves the vertical at this height or above";
            return std::move(result_);
        }
        const double first = height_of(1);
        for (Index mode = 1; mode <= count; ++mode) {
            result_.branches.push_back(branch(chain_, {.mode = mode,
                                                       .min_conical_height = result_.conical_height,
                                                       .max_points = options_.max_points,
                                                       .max_step = options_.max_step}));
            settle(result_.branches.back().end);
        }
        // from the end upwards: an isolated branch is met first where most of it is to be seen
        for (int i = 0; i < options_.lists; ++i)
            look(result_.conical_height * std::pow(first / result_.conical_height, double(i) / options_.lists));
        prove(first);
        std::sort(result_.looked_at.begin(), result_.looked_at.end(), std::greater<>());
        std::stable_sort(result_.branches.begin() + count, result_.branches.end(),
                         [](const auto& x, const auto& y) { return highest(x) > highest(y); });
        return std::move(result_);
    }

   private:
    double height_of(Index mode) const { return revchain::detail::one_mode(chain_, mode, false).conical_height; }
    static double highest(const Branch& branch) {
        return *std::max_element(branch.conical_height.begin(), branch.conical_height.end());
    }
    void settle(BranchEnd end) {
        result_.consistent = result_.consistent && (end == BranchEnd::height || end == BranchEnd::closed);
    }
    /// Every shape at one height must be met by a branch; where one is not, its branch is followed both ways.
    void look(double height) {
        const auto list = steady_shapes(chain_, {.conical_height = height, .budget = options_.budget});
        result_.looked_at.push_back(height);
        result_.consistent = result_.consistent && list.complete;
        std::vector<int> met(list.shapes.size(), 0);
        std::size_t crossings = 0;
        const auto meet = [&](const Branch& branch) {
            for (const SteadyShape& state : states_at(branch, corrector_, height)) {
                ++crossings;
                for (std::size_t j = 0; j < met.size(); ++j)
                    met[j] += (list.shapes[j].inclination - state.inclination).cwiseAbs().maxCoeff() < 1e-9;
            }
        };
        for (const Branch& branch : result_.branches) meet(branch);
        for (std::size_t j = 0; j < met.size(); ++j) {
            if (met[j] > 0) continue;
            BranchState at, up;
            for (const double inclination : list.shapes[j].inclination)
                at.rise.push_back(std::asinh(std::tan(inclination)));
            at.log_height = std::log(height * unit_);
            up.rise.assign(at.rise.size(), 0.0), up.log_height = 1;
            Branch loop = branch_from(chain_, at, up, list.shapes[j].half_waves, log_end_, options_);
            if (loop.size() < 2) {
                result_.consistent = false;
                continue;
            }
            settle(loop.end);
            meet(loop);
            result_.branches.push_back(std::move(loop));
        }
        result_.consistent = result_.consistent && crossings == list.shapes.size() &&
                             std::all_of(met.begin(), met.end(), [](int each) { return each == 1; });
    }

    /// Proves that no loop is missing between the heights looked at; loops met on the way are added.
    void prove(double first) {
        result_.remark = "branches and lists of all shapes do not agree, or a list is not proved complete";
        if (!result_.consistent) return;
        result_.remark =
            "every proved list of all shapes is accounted for; isolated loops that lie wholly between two "
            "of the heights looked at are not excluded";
        narrow_ = enclosed<double>(links_.links);
        const double lowest = result_.conical_height * unit_;
        if (!single_valued(narrow_, Interval<double>(lowest))) {
            result_.remark += ": links hang at several inclinations";
            return;
        }
        const double last = lowest * farthest_tangent(narrow_, Interval<double>(lowest)) * (1 + 1e-12);
        DiagramProver prover(narrow_, options_.proof_budget);
        const auto proof =
            prover.run(lowest, first * unit_ * (1 + 1e-9), last,
                       [&](const DiagramPoint& at, const Rectangle& within) { return known(at, within); });
        result_.complete = proof.complete && result_.consistent;
        if (result_.complete)
            result_.remark = "proved complete: no branch is missing";
        else if (!result_.consistent)
            result_.remark = "a loop was found that lists of all shapes do not agree with";
        else
            result_.remark += ", between the heights " + revchain::detail::in_digits(proof.open_low / unit_) + " and " +
                              revchain::detail::in_digits(proof.open_high / unit_);
    }
    bool known(const DiagramPoint& at, const Rectangle& within) {
        if (std::any_of(result_.branches.begin(), result_.branches.end(),
                        [&](const Branch& each) { return goes_through(each, corrector_, at, within); }))
            return true;
        if (stuck_ >= 20) return false;
        std::vector<Interval<double>> tangents;
        detail::support_offset(narrow_, Interval<double>(at.height), Interval<double>(at.x / at.height), OnAxis{},
                               &tangents);
        BranchState state, across;
        for (const auto& t : tangents) state.rise.push_back(std::asinh(t.middle()));
        state.log_height = std::log(at.height);
        across.rise.assign(state.rise.size(), 0.0);
        across.rise[0] = std::sqrt(static_cast<double>(state.rise.size()));
        Branch found = branch_from(chain_, state, across, 1, log_end_, options_);
        // one that comes to the vertical is that of a mode; one that comes to the lowest height is in the list there
        if (found.end == BranchEnd::vertical || found.end == BranchEnd::height) return true;
        if (found.end != BranchEnd::closed) {
            ++stuck_;
            return false;
        }
        const double top = highest(found),
                     bottom = *std::min_element(found.conical_height.begin(), found.conical_height.end());
        result_.branches.push_back(std::move(found));
        look(std::sqrt(top * bottom));  // must agree
        return true;
    }

    const Chain<double>& chain_;
    const BranchesOptions& options_;
    Links<Wide<double>> links_;
    std::vector<Link<Interval<double>>> narrow_;
    double unit_, log_end_;
    Corrector corrector_;
    int stuck_ = 0;  ///< traces that came to nothing
    Branches result_;
};

}  // namespace finite

REVCHAIN_INLINE Branches branches(const Chain<double>& chain, const BranchesOptions& options) {
    const double lowest = finite::lowest_height("branches", options);
    if (options.lists < 1) detail::throw_invalid("branches", "lists must be at least 1", options.lists);
    return finite::Diagram(chain, lowest, options).run();
}

REVCHAIN_INLINE ShapesOnBranch shapes_on_branch(const Chain<double>& chain, const SteadyShapeOptions& options) {
    return finite::search_branch<ShapesOnBranch>(chain, options);
}

REVCHAIN_INLINE SteadyShape steady_shape(const Chain<double>& chain, const SteadyShapeOptions& options) {
    SteadyShapeOptions first = options;
    first.max_shapes = 1;
    ShapesOnBranch found = shapes_on_branch(chain, first);
    if (found.shapes.empty())
        detail::throw_invalid(
            "steady_shape",
            "what is given is not met on the branch of mode " + std::to_string(options.mode) +
                "; looked down to the conical height, got " + detail::in_digits(found.searched_to) +
                (found.end != BranchEnd::height                    ? "; it could not be followed farther"
                 : options.conical_height || options.angular_speed ? "; the state there did not pass every check"
                                                                   : "; to look farther give a smaller "
                                                                     "min_conical_height"));
    return std::move(found.shapes.front());
}

}  // namespace revchain
