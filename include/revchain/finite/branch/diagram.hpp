// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <functional>

#include "revchain/branches.hpp"
#include "revchain/finite/branch/diagram_proof.hpp"
#include "revchain/finite/branch/trace.hpp"
#include "revchain/finite/shapes/shapes_by.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Computes the data of a chain that a diagram needs: lists of shapes, modes, limits of the proof.
template <class Means>
class ChainQuestions {
   public:
    ChainQuestions(const Chain<double>& chain, const DiagramOptions& options)
        : system(std::make_shared<const BranchSystem>(chain)), chain_(chain), options_(options) {}

    std::shared_ptr<const BranchSystem> system;

    Branch followed(Index mode, double height) const {
        return branch(chain_, {.mode = mode,
                               .min_conical_height = height,
                               .max_points = options_.max_points,
                               .max_step = options_.max_step,
                               .gravity = options_.gravity});
    }
    SteadyShapes list(double height) const {
        return shapes_by(chain_, {.conical_height = height, .budget = options_.budget}, Means{});
    }
    const Links<Fine>& links_at(double) const { return system->chain; }
    /// Returns the heights of the modes above a height, the slowest mode first.
    std::vector<double> modes_above(double height) const {
        std::vector<double> found;
        const Index count = count_modes(chain_, {.conical_height = height});
        for (Index mode = 1; mode <= count; ++mode) {
            const double each = detail::one_mode(chain_, mode, false).conical_height;
            if (each > height) found.push_back(each);  // a mode at `height` has no branch
        }
        return found;
    }
    bool is_known_at(double height) const {
        return count_modes(chain_, {.conical_height = height}) == 0;
    }
    /// Returns the height of the first mode; above it there is no shape (see steady_shapes).
    std::optional<double> known_above() const {
        return detail::one_mode(chain_, 1, false).conical_height;
    }
    std::string not_provable(double lowest) const {
        const bool single =
            single_valued(enclosed<double>(system->chain.links), Interval<double>(lowest));
        return single ? "" : "links hang at several inclinations";
    }

   private:
    const Chain<double>& chain_;
    const DiagramOptions& options_;
};

template <class Means>
class RigQuestions {
   public:
    RigQuestions(const Rig& rig, const RigDiagramOptions& options)
        : system(std::make_shared<const BranchSystem>(rig, options.gravity, options.direction)),
          rig_(rig),
          options_(options),
          modes_("branches", rig, options.gravity, options.direction),
          found_(modes_.found(1, modes_.count())) {}

    std::shared_ptr<const BranchSystem> system;

    Branch followed(Index mode, double height) const {
        return branch(rig_, {.mode = mode,
                             .min_conical_height = height,
                             .max_points = options_.max_points,
                             .max_step = options_.max_step,
                             .gravity = options_.gravity,
                             .direction = options_.direction});
    }
    SteadyShapes list(double height) const {
        const RigShapesOptions options{.conical_height = height,
                                       .budget = options_.budget,
                                       .direction = options_.direction,
                                       .gravity = options_.gravity};
        return shapes_by(rig_, options, Means{});
    }
    RiggedLinks links_at(double height) const { return system->rigged_at(Fine(height)); }
    std::vector<double> modes_above(double height) const {
        std::vector<double> found;
        for (const auto& mode : found_)
            if (mode.conical_height > height) found.push_back(mode.conical_height);
        return found;
    }
    /// Returns the height of the first mode if it is proved that slower speeds have one shape, or
    /// none with the support on the axis. The proof requires that all links hang in tension. In the
    /// sines s of the inclinations the energy in the turning frame, times lambda, has the second
    /// derivative lambda diag(pull a sec^3) - M (plus the spring's). It is at least that of the
    /// straight chain, positive definite at rest and regular below the first critical speed.
    std::optional<double> known_above() const {
        if (!modes_.complete() || found_.empty()) return std::nullopt;
        const double first = found_[0].conical_height;
        if (!hangs_in_tension(std::ldexp(first, -system->units.length_exponent)))
            return std::nullopt;
        return first * (1 + found_[0].error_bound);
    }
    bool is_known_at(double height) const { return known_above().value_or(height) < height; }
    /// Returns why the proof of a diagram down to a height does not cover the rig; else empty.
    std::string not_provable(double lowest) const {
        if (!known_above()) return "the proof is for rigs whose links all hang in tension";
        if (!hangs_in_tension(lowest)) return "flywheels take the tension from links";
        if (!single_valued(system->rigged_at(Fine(lowest)).links_for_sweep<double>(),
                           Interval<double>(lowest)))
            return "links hang at several inclinations";
        return "";
    }

   private:
    /// Returns true if all links hang in tension up to a height's speed: pulls are linear in speed.
    bool hangs_in_tension(double height) const {
        const Fine fastest = system->links.speed_at(Fine(height));
        for (std::size_t m = 0; m < system->links.bodies(); ++m) {
            if (rig_.stands(static_cast<Index>(m)) ||
                !enclosed<Far>(system->links.links[m].moment).positive())
                return false;
            for (const Fine& n : {Fine(0.0), fastest})
                if (!(system->links.pull(m, n) > system->bearing * Fine(1e-20))) return false;
        }
        return true;
    }

    const Rig& rig_;
    const RigDiagramOptions& options_;
    detail::ModesOfOneSense modes_;
    std::vector<detail::ModesOfOneSense::Mode> found_;
};

/// Combines branches with proved lists of shapes.
template <class Questions, class Options, class Means>
class Diagram {
   public:
    template <class System>
    Diagram(const System& system, double lowest, const Options& options)
        : options_(options),
          ask_(system, options),
          unit_(std::ldexp(1.0, -ask_.system->units.length_exponent)),
          log_end_(std::log(lowest * unit_)),
          corrector_(rounded(ask_.system->links)) {
        result_.conical_height = lowest;
        result_.consistent = true;
    }

    Branches run() {
        const double lowest = result_.conical_height;
        if constexpr (!detail::is_thorough<Means>) {
            const double scaled = lowest * unit_;
            if (!hangs_at_one_inclination(ask_.links_at(scaled), Interval<double>(scaled)))
                throw_not_thorough("branches", lowest);
        }
        const bool from_rest = !ask_.system->links.is_symmetric();
        const auto known = ask_.known_above();
        std::vector<double> heights;
        if (!from_rest) heights = ask_.modes_above(lowest);
        const double top = known.value_or(of_length());
        log_top_ = std::log(100 * std::max(lowest, top) * unit_);
        if (!from_rest && known && heights.empty()) {
            result_.complete = ask_.is_known_at(lowest);
            result_.remark = "no shape leaves the vertical at this height or above";
            return std::move(result_);
        }
        const auto roots = static_cast<Index>(from_rest ? 1 : heights.size());
        for (Index mode = 1; mode <= roots; ++mode) {
            result_.branches.push_back(ask_.followed(mode, lowest));
            check_end(result_.branches.back().end);
        }
        // go from the lowest height up: isolated branches are found where they are largest
        const double first = std::max(lowest, heights.empty() ? top : std::max(top, heights[0]));
        const int lists = first > lowest ? options_.lists : 1;
        for (int i = 0; i < lists; ++i)
            check_list(lowest * std::pow(first / lowest, double(i) / lists));
        prove(known);
        std::sort(result_.looked_at.begin(), result_.looked_at.end(), std::greater<>());
        const auto before = [](const Branch& x, const Branch& y) {
            return highest(x) > highest(y);
        };
        std::stable_sort(result_.branches.begin() + roots, result_.branches.end(), before);
        return std::move(result_);
    }

   private:
    double of_length() const {
        double reach = 0;
        for (std::size_t m = 0; m < ask_.system->links.bodies(); ++m)
            reach += as_double(ask_.system->links.links[m].length);
        return reach / unit_;
    }
    static double highest(const Branch& branch) {
        return *std::max_element(branch.conical_height.begin(), branch.conical_height.end());
    }
    void check_end(BranchEnd end) {
        using enum BranchEnd;
        result_.consistent &= end == height || end == closed || end == slow || end == loose;
    }
    /// Returns the branch through a state, followed on the side of `across` (not orthogonal to it).
    Branch from_here(const BranchState& at, const BranchState& across, int half_waves) {
        Branch result;
        trace_of(result).system = ask_.system, result.birth = BranchBirth::fold;
        auto start = corrector_.corrected(at, across, 0.1);
        if (!start) {
            result.end = BranchEnd::stuck;
            return result;
        }
        if (start->half_waves == 0) start->half_waves = half_waves;
        append(result, *start);
        BranchWalk walk(corrector_, *start, 0.02, options_.max_step);
        result.end = follow(result, walk, log_end_, options_.max_points, log_top_);
        return result;
    }
    BranchState state_of(const SteadyShape& shape, double height) const {
        const auto& links = ask_.system->links;
        BranchState at;
        for (Index m = 0; m < shape.inclination.size(); ++m) {
            const double tangent = std::tan(shape.inclination[m]);
            at.tau.push_back(std::asinh(ask_.system->stands(at.tau.size()) ? -tangent : tangent));
        }
        if (links.spring) {
            const double end = shape.offset[shape.offset.size() - 1] * unit_;
            at.tau.push_back(links.tau_of_reach(at.tau.size(), end - as_double(links.radius)));
        }
        at.log_height = std::log(height * unit_);
        return at;
    }
    /// Checks that every shape at a height is on one branch. Follows the branches of the others.
    void check_list(double height) {
        const auto list = ask_.list(height);
        result_.looked_at.push_back(height);
        result_.consistent &= list.undecided.empty();
        std::vector<int> met(list.shapes.size(), 0);
        std::size_t crossings = 0;
        const auto meet = [&](const Branch& branch) {
            for (const SteadyShape& state : states_at(branch, corrector_, height)) {
                ++crossings;
                for (std::size_t j = 0; j < met.size(); ++j)
                    met[j] +=
                        (list.shapes[j].inclination - state.inclination).cwiseAbs().maxCoeff() <
                        1e-9;
            }
        };
        for (const Branch& branch : result_.branches) meet(branch);
        for (std::size_t j = 0; j < met.size(); ++j) {
            if (met[j] > 0) continue;
            BranchState up;
            up.tau.assign(corrector_.size(), 0.0), up.log_height = 1;
            Branch loop =
                from_here(state_of(list.shapes[j], height), up, list.shapes[j].half_waves);
            if (loop.size() < 2) {
                result_.consistent = false;
                continue;
            }
            check_end(loop.end);
            meet(loop);
            result_.branches.push_back(std::move(loop));
        }
        const bool each_once = std::count(met.begin(), met.end(), 1) == std::ssize(met);
        result_.consistent &= crossings == list.shapes.size() && each_once;
    }

    /// Proves that no loop is missing between the sampled heights. Adds loops that it finds.
    void prove(const std::optional<double>& known) {
        result_.remark =
            "branches and lists of all shapes do not agree, or a list is not proved complete";
        const double lowest = result_.conical_height * unit_;
        const std::string reason = ask_.not_provable(lowest);
        const auto explained = [&] { return reason.empty() ? std::string() : ": " + reason; };
        if (!result_.consistent) {
            result_.remark += explained();
            return;
        }
        result_.remark =
            "every proved list of all shapes is accounted for; isolated loops that lie wholly "
            "between two of the heights looked at are not excluded" +
            explained();
        if (!reason.empty()) return;
        if constexpr (detail::is_thorough<Means>)
            prove_between(lowest, *known * unit_ * (1 + 1e-9));
        else
            result_.remark += "; revchain::thorough as the last argument asks for a proof";
    }
    /// Proves that no loop is missing between two heights, and sets `complete` and `remark`.
    void prove_between(double lowest, double first) {
        DiagramProof proof;
        if (first > lowest) proof = proved_between(lowest, first);
        result_.complete = proof.complete && result_.consistent;
        if (result_.complete)
            result_.remark = "proved complete: no branch is missing";
        else if (!result_.consistent)
            result_.remark = "a loop was found that lists of all shapes do not agree with";
        else
            result_.remark += ", between the heights " + detail::in_digits(proof.open_low / unit_) +
                              " and " + detail::in_digits(proof.open_high / unit_);
    }
    /// Runs the proof; off the axis, for both signs of the lowest link's tangent.
    DiagramProof proved_between(double lowest, double first) {
        DiagramProof whole;
        for (const int side : {1, -1}) {
            const EnclosedDiagram diagram(*ask_.system, side);
            const double tight = std::max(lowest, 1.001 * diagram.loosest_height());
            if (tight > lowest) whole.leave_open(lowest, std::min(tight, first));
            if (!(tight < first)) break;
            DiagramProver prover(diagram, options_.proof_budget);
            const auto is_known = [&](const auto& at, const auto& within) {
                return find_branch(diagram, at, within);
            };
            const auto proof =
                prover.run(tight, first, diagram.last(tight) * (1 + 1e-12), is_known);
            if (!proof.complete) whole.leave_open(proof.open_low, proof.open_high);
            if (diagram.is_symmetric()) break;
        }
        return whole;
    }
    /// Returns true if a branch through the point is known or found, and adds one that is found.
    bool find_branch(const EnclosedDiagram& diagram, const DiagramPoint& at,
                     const Rectangle& within) {
        for (const Branch& each : result_.branches)
            if (goes_through(each, corrector_, at, within, diagram.side())) return true;
        if (stuck_ >= 20) return false;
        const BranchState state = diagram.state_at(at);
        BranchState across;
        across.tau.assign(state.tau.size(), 0.0);
        across.tau[0] = std::sqrt(as_double(state.tau.size()));
        Branch found = from_here(state, across, 1);
        // A branch that reaches the vertical is that of a mode, one that reaches the lowest height
        // is in the list there, and one that reaches slow speeds is the one from rest.
        if (found.end == BranchEnd::vertical || found.end == BranchEnd::height ||
            found.end == BranchEnd::slow)
            return true;
        if (found.end != BranchEnd::closed && found.end != BranchEnd::loose) {
            ++stuck_;
            return false;
        }
        const double top = highest(found);
        const double bottom =
            *std::min_element(found.conical_height.begin(), found.conical_height.end());
        result_.branches.push_back(std::move(found));
        check_list(std::sqrt(top * bottom));  // checks that branches and list agree
        return true;
    }

    const Options& options_;
    Questions ask_;
    double unit_, log_end_, log_top_ = std::numeric_limits<double>::infinity();
    Corrector corrector_;
    int stuck_ = 0;  ///< branches that could not be followed
    Branches result_;
};

template <class Questions, class System, class Options, class Means>
Branches diagram_of(const System& system, const Options& options, Means) {
    const double lowest = lowest_height("branches", options);
    if (options.lists < 1)
        detail::throw_invalid("branches", "lists must be at least 1", options.lists);
    return Diagram<Questions, Options, Means>(system, lowest, options).run();
}

}  // namespace revchain::finite
