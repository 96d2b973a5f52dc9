// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <functional>

#include "revchain/finite/branch/branch.hpp"
#include "revchain/finite/branch/diagram_proof.hpp"
#include "revchain/finite/shapes/list.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain {

/// All branches found above one conical height.
struct Branches {
    std::vector<Branch> branches;  ///< those of the modes, slowest first, then isolated ones by where they are born
    double conical_height = 0;     ///< down to which
    bool consistent =
        false;  ///< at every height looked at: as many crossings as the proved list has shapes, each one of it
    bool complete = false;          ///< consistent, and proved: no branch is missing, not even between those heights
    std::vector<double> looked_at;  ///< conical heights of those lists, descending
    std::string remark;             ///< what may be missing
};

struct BranchesOptions {
    BranchOptions branch{};
    int lists = 16;                 ///< proved lists of all shapes, at so many heights evenly spread in their logarithm
    long budget = 3'000'000;        ///< of each list, see SteadyShapesOptions
    long proof_budget = 1'000'000;  ///< links to look at to prove that no branch is missing, 1 to 3 microseconds each
};

namespace finite {

/// The states of a branch at one height, in the order of the arc. Between the vertical and the next point the law of
/// the onset leads to it: the height hardly changes there.
inline std::vector<SteadyShape> states_at(const Branch& branch, Corrector& corrector, double conical_height) {
    std::vector<SteadyShape> found;
    if (branch.size() == 0) return found;
    const auto& chain = *branch.links;
    const Wide<double> height = ldexp(Wide<double>(conical_height), -chain.units.length_exponent);
    const HeightMeasure measure{std::log(static_cast<double>(height))};
    const GivenHeight<Wide<double>> condition(height);
    const auto off = [&](std::size_t i) { return (branch.conical_height[i] - conical_height) / conical_height; };
    const auto take = [&](const BranchState& near) {
        if (auto shape = shape_at(chain, near, condition)) found.push_back(std::move(*shape));
    };
    const bool from_vertical = branch.onset && largest_rise(branch.points[0].state) == 0;
    if (from_vertical && !(off(0) > 0) && branch.size() < 2) return found;
    const double there = from_vertical && off(0) > 0 ? std::min(1e-9, 0.01 * off(0)) : 1e-9;
    const std::size_t last = branch.size() - 1;
    for (std::size_t i = from_vertical ? 1 : 0; i <= last; ++i) {
        const double a = off(i);
        if (i == 1 && from_vertical && off(0) > 0 && a <= -there)
            if (const auto point = near_vertical(chain, *branch.onset, height)) take(point->state);
        if (std::abs(a) < there) {  // the point itself: an end, or a crossing
            if (i == 0 || i == last || (off(i - 1) > 0) != (off(i + 1) > 0)) take(branch.points[i].state);
        } else if (i < last && std::abs(off(i + 1)) >= there && (a > 0) != (off(i + 1) > 0)) {
            const auto walk = BranchWalk::between(corrector, branch.points[i], branch.points[i + 1]);
            const auto crossing = crossings_of(walk, measure);
            if (!crossing.empty()) take(crossing.front().point.state);
        }
    }
    return found;
}

/// The branch through a state, followed from there on the side of `across`, a direction it does not lie across, until
/// it comes back or down to `log_end`.
inline Branch branch_from(const Chain<double>& chain, const BranchState& at, const BranchState& across, int half_waves,
                          double log_end, const BranchOptions& options) {
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
    walk.longest = options.longest_step;
    result.end = follow(result, walk, log_end, options.most_points);
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
            result_.branches.push_back(branch(chain_, mode, result_.conical_height, options_.branch));
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
            Branch loop = branch_from(chain_, at, up, list.shapes[j].half_waves, log_end_, options_.branch);
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

    /// That no loop is missing between the heights looked at; loops met on the way are added.
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
        Branch found = branch_from(chain_, state, across, 1, log_end_, options_.branch);
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

/// The whole diagram of branches from the first critical speed to that of `conical_height`: those that leave the
/// vertical, and isolated ones that are born in a fold.
///
/// Method: `branch` from every mode; then proved lists of all shapes (`steady_shapes`) at `lists` heights from the end
/// up, each shape matched with a crossing; one that no branch meets is on an isolated branch, which is followed from it
/// both ways. `consistent` where all lists are proved complete and every shape in them is met once. Then
/// finite::DiagramProver, which shows that no loop opens and closes between two of the heights, or finds it:
/// `complete`. It leaves it false where its budget ends, and where links could hang at several inclinations; `remark`
/// says between which heights. The proof is about where branches are; that a branch as followed is one of them is
/// checked (see finite::BranchWalk).
/// Cost: that of the lists, 10 ms for three plummets, and of the proof: down to 1/200 of the length 5 to 50 ms for
/// three links, 0.05 to 0.3 s for five, 0.2 to 0.7 s for six (8,000 to 40,000 rectangles of five and six).
/// Throws InvalidArgument for a height not positive and finite and for `lists` below 1.
inline Branches branches(const Chain<double>& chain, double conical_height, const BranchesOptions& options = {}) {
    detail::require_positive("branches", "conical height", conical_height);
    if (options.lists < 1) detail::throw_invalid("branches", "lists must be at least 1", options.lists);
    return finite::Diagram(chain, conical_height, options).run();
}

/// Throws InvalidArgument: branches of a rig cannot be followed yet.
[[noreturn]] inline Branches branches(const Rig&, double, const BranchesOptions& = {}) {
    detail::throw_invalid("branches", "branches of a Rig cannot be followed yet; ask steady_shapes(rig) at each speed");
}
[[noreturn]] inline Branch branch(const Rig&, Index, double, const BranchOptions& = {}) {
    detail::throw_invalid("branch", "branches of a Rig cannot be followed yet; ask steady_shapes(rig) at each speed");
}

}  // namespace revchain
