// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/cord/branches.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Combines branches of a cord with scanned lists of its shapes.
template <class Options>
class CordDiagram {
   public:
    /// `critical` holds the heights of the modes above `lowest`, descending.
    CordDiagram(const Cord& cord, const Vector<double>& critical, double lowest,
                const Options& options)
        : cord_(cord), critical_(critical), log_end_(std::log(lowest)), options_(options) {
        result_.conical_height = lowest;
    }

    CordBranches run() {
        const double lowest = result_.conical_height;
        bool ended = true;
        for (Index j = 0; j < critical_.size(); ++j) {
            const BranchOptions of_mode{
                .mode = j + 1, .max_points = options_.max_points, .max_step = options_.max_step};
            result_.branches.push_back(branch_of_mode(cord_, critical_[j], lowest, of_mode));
            ended = ended && result_.branches.back().end == BranchEnd::height;
        }
        result_.consistent = ended;
        const bool theorem = critical_.size() <= 1 || ContinuousChain(cord_).is_counted;
        result_.complete = theorem && ended;
        for (int i = 0; i < options_.lists && !theorem; ++i) {
            const double share = static_cast<double>(i) / options_.lists;
            compare(lowest * std::pow(critical_[0] / lowest, share));
        }
        std::reverse(result_.looked_at.begin(), result_.looked_at.end());
        const auto isolated = result_.branches.begin() + critical_.size();
        const auto born = [](const CordBranch& branch) {
            return *std::max_element(branch.conical_height.begin(), branch.conical_height.end());
        };
        const auto before = [&](const CordBranch& x, const CordBranch& y) {
            return born(x) > born(y);
        };
        std::stable_sort(isolated, result_.branches.end(), before);
        result_.remark =
            critical_.size() == 0 ? "no shape leaves the vertical at this height or above"
            : result_.complete    ? "a theorem counts the shapes: there are no others"
            : !ended              ? "a branch could not be followed to the end"
            : result_.consistent
                ? "no theorem counts the shapes: loops between the speeds looked at may be missing"
                : "at a speed looked at, a shape is not met once by a branch";
        return std::move(result_);
    }

   private:
    static constexpr double alike = 1e-6;  // relative difference of tip offsets of one shape

    void compare(double height) {
        result_.looked_at.push_back(height);
        const CordShapes list = continuous_shapes(ContinuousChain(cord_), height, 200);
        std::vector<int> met(list.shapes.size(), 0);
        for (const CordBranch& branch : result_.branches) count_met(list, branch, height, met);
        for (std::size_t i = 0; i < met.size(); ++i) {
            if (met[i] == 0) {
                CordBranch loop = through(list.shapes[i]);
                if (loop.end != BranchEnd::height && loop.end != BranchEnd::closed)
                    result_.consistent = false;
                count_met(list, loop, height, met);
                if (loop.size() > 1) result_.branches.push_back(std::move(loop));
            }
            if (met[i] != 1) result_.consistent = false;
        }
    }
    /// Counts in `met` how often a branch meets each listed shape, without shapes not in the list.
    void count_met(const CordShapes& list, const CordBranch& branch, double height,
                   std::vector<int>& met) const {
        for (const CordShape& shape : branch.shapes_at(height))
            for (std::size_t i = 0; i < met.size(); ++i)
                if (list.shapes[i].half_waves == shape.half_waves &&
                    std::abs(list.shapes[i].tip_offset / shape.tip_offset - 1) < alike)
                    ++met[i];
    }

    /// Returns the isolated branch through a shape: closed, or from the lowest height to its end.
    CordBranch through(const CordShape& shape) const {
        CordBranch result;
        auto line = std::make_shared<const BranchLine>(cord_, shape.half_waves);
        result.line = line, result.end = BranchEnd::stuck;
        const BranchPlace at{std::asinh(shape.tip_offset), std::log(shape.conical_height)};
        auto start = line->next_to(at, {1, 0}, 0.1);
        if (!start) return result;
        const auto down = down_to(*line, log_end_);
        CordBranch away;
        away.line = line;
        const bool at_end = start->at.log_height <= log_end_ + 1e-12;
        if (at_end) start->at.log_height = log_end_;
        // a branch that starts at the lowest height goes up
        if (at_end && start->direction.log_height < 0) start->direction = -1.0 * start->direction;
        if (!at_end && append(away, *start)) {
            away.end = follow(away, *start, options_.max_step, options_.max_points,
                              [&](const auto& last, auto& now) {
                                  const BranchPlace chord = now.at - last.at,
                                                    to_start = start->at - last.at;
                                  const double share = dot(to_start, chord) / dot(chord, chord);
                                  if (away.size() > 2 && share > 0 && share <= 1 &&
                                      size(to_start - share * chord) < 0.1 * size(chord)) {
                                      now = *start;
                                      return std::optional(BranchEnd::closed);
                                  }
                                  return down(last, now);
                              });
            if (away.end != BranchEnd::height) return away;
            *start = away.points.back();
            start->direction = -1.0 * (away.points.back().at - away.points[away.size() - 2].at);
            start = line->next_to(start->at, (1 / size(start->direction)) * start->direction, 0.1);
            if (!start) return away;
        }
        if (append(result, *start))
            result.end = follow(result, *start, options_.max_step, options_.max_points, down);
        return result;
    }

    const Cord& cord_;
    Vector<double> critical_;
    double log_end_;
    const Options& options_;
    CordBranches result_;
};

}  // namespace revchain::finite
