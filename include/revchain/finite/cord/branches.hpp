// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/branches.hpp"
#include "revchain/finite/cord/branch_line.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// A branch of steady shapes of a cord, point by point along its arc s, in the units of the cord.
/// ds^2 = dtau^2 + d(log conical height)^2, where tan(inclination of the free end) = sinh(tau).
struct CordBranch {
    Index mode = 0;  ///< mode at which the branch leaves the vertical; 0 if isolated
    /// Numbers of each point: `tip_inclination` of the free end (rad), `tip_radius` its offset,
    /// `top_tension` at the support; the others as in `Branch`.
    std::vector<double> arc, conical_height, tip_inclination, tip_radius, top_tension,
        moment_of_inertia, effective_energy;
    std::vector<int> half_waves;     ///< constant along a branch
    std::vector<std::size_t> folds;  ///< indices of points with a local extreme of conical height
    BranchEnd end = BranchEnd::budget;

    std::size_t size() const { return arc.size(); }
    double angular_speed(std::size_t point,
                         double gravity = conical_pendulum::standard_gravity) const {
        return conical_pendulum::angular_speed(conical_height[point], gravity);
    }
    /// Returns the shape at a point. Throws InvalidArgument for the straight cord (point 0 on the
    /// branch of a mode), an index past the end, and a shape that could not be followed.
    CordShape shape(std::size_t point) const;
    /// Returns the shapes of the branch at a conical height, in the order of the arc. Throws
    /// InvalidArgument for a height that is not positive and finite.
    std::vector<CordShape> shapes_at(double conical_height) const;

    // Data of `shape` and `shapes_at`.
    std::shared_ptr<const finite::BranchLine> line;
    std::vector<finite::BranchLine::Point> points;
};

namespace finite {
/// Returns the shape of a cord at a conical height whose free end is near an offset, at a fold or
/// not. Throws InvalidArgument if it could not be followed.
CordShape shape_near(const Cord& cord, double conical_height, int half_waves, double tip_offset,
                     bool at_fold);
}  // namespace finite

/// All branches found above a conical height. `complete` is true if a theorem counts the shapes
/// (see `steady_shapes` of a cord). Otherwise `consistent` is true if each scanned shape at each
/// height in `looked_at` is on one branch.
struct CordBranches {
    std::vector<CordBranch>
        branches;               ///< of the modes, slowest first, then isolated ones, highest first
    double conical_height = 0;  ///< lowest conical height of the diagram
    bool consistent = false, complete = false;
    std::vector<double> looked_at;  ///< conical heights of scanned lists, descending
    std::string remark;             ///< what may be missing
};

namespace finite {

/// Returns the shape at a point of a line; none if no path could be followed that far. At a fold
/// the error bound is that of the fold's position.
REVCHAIN_LAZY
std::optional<CordShape> shape_at(const BranchLine& line, const BranchLine::Point& point,
                                  bool at_fold = false) {
    constexpr double of_fold = 1e-7;
    const double height = std::exp(point.at.log_height);
    if (at_fold) {
        const PathKind kind = line.kind(point.at.log_height);
        ShapeSamples samples(kind, std::sinh(point.at.bend));
        const Path path(kind, std::sinh(point.at.bend), {.crossings = line.crossing()}, samples);
        if (static_cast<int>(path.crossings().size()) < line.crossing()) return std::nullopt;
        CordShape shape = samples.finish(path, line.crossing(), line.chain().length, height, true);
        shape.error_bound = of_fold, shape.density = line.chain().density;
        return shape;
    }
    auto shape = finished(line.kind(point.at.log_height), std::sinh(point.at.bend), line.crossing(),
                          line.chain().length, height);
    if (shape) shape->density = line.chain().density;
    return shape;
}

/// Adds the straight cord, with which the branch of a mode begins.
REVCHAIN_LAZY
void append_vertical(CordBranch& branch, double height) {
    const ContinuousChain& chain = branch.line->chain();
    const PathKind kind = kind_of(chain, height, 0);
    PathEnergies energies(kind, 0);
    const Path path(kind, 1, {.crossings = branch.line->crossing(), .with_change = false},
                    energies);
    branch.arc.push_back(0), branch.conical_height.push_back(height),
        branch.tip_inclination.push_back(0);
    branch.tip_radius.push_back(0), branch.moment_of_inertia.push_back(0);
    branch.top_tension.push_back(chain.line_weight * height *
                                 kind.weight_below(chain.length / height));
    branch.effective_energy.push_back(chain.line_weight * height * height * energies.potential());
    branch.half_waves.push_back(branch.line->crossing());
    branch.points.push_back({{0, std::log(height)}, {1, 0}});
}

/// Adds a point of the line. Returns false if its path could not be followed.
REVCHAIN_LAZY
bool append(CordBranch& branch, const BranchLine::Point& point) {
    const BranchLine& line = *branch.line;
    const double height = std::exp(point.at.log_height), tip = std::sinh(point.at.bend);
    const PathKind kind = line.kind(point.at.log_height);
    PathEnergies energies(kind, tip);
    PathSeries last;
    const auto visit = [&](const auto& series, double duration) {
        energies(series, duration);
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(series)>, PathSeries>)
            last = series;
    };
    const Path path(kind, tip, {.crossings = line.crossing(), .with_change = false}, visit);
    if (static_cast<int>(path.crossings().size()) < line.crossing()) return false;
    const PathState support = last.state(path.crossings().back().time);
    const double force = line.chain().line_weight * height, inertia = energies.inertia();
    const bool first = branch.points.empty();
    branch.arc.push_back(first ? 0 : branch.arc.back() + size(point.at - branch.points.back().at));
    branch.conical_height.push_back(height), branch.tip_inclination.push_back(std::atan(tip));
    branch.tip_radius.push_back(tip * height);
    branch.top_tension.push_back(force * std::hypot(support.pull, kind.weight_below(support.arc)));
    branch.moment_of_inertia.push_back(force * height * height * inertia);
    branch.effective_energy.push_back(force * height * (energies.potential() - inertia / 2));
    branch.half_waves.push_back(line.crossing());
    branch.points.push_back(point);
    return true;
}

/// Follows a line from a point until it ends or `stop(last, now)` returns a reason. Returns the
/// reason. Folds become points of the branch.
template <class Stop>
BranchEnd follow(CordBranch& branch, const BranchLine::Point& start, double longest,
                 std::size_t most, const Stop& stop) {
    const BranchLine& line = *branch.line;
    BranchLineWalk walk(line, start, longest);
    while (branch.size() < most) {
        const BranchLine::Point last = walk.at();
        if (!walk.advance())
            return last.at.bend < 1e-3 && last.direction.bend < 0 ? BranchEnd::vertical
                                                                  : BranchEnd::stuck;
        BranchLine::Point now = walk.at();
        if (last.rate * now.rate < 0) {  // at the vertical the rate is 0
            const auto fold = line.between(last, now, [](const auto& point) { return point.rate; });
            if (fold) {
                BranchLine::Point turn = *fold;
                if (const auto end = stop(last, turn))
                    return append(branch, turn) ? *end : BranchEnd::stuck;
                if (append(branch, turn)) branch.folds.push_back(branch.size() - 1);
                if (const auto end = stop(*fold, now))
                    return append(branch, now) ? *end : BranchEnd::stuck;
                if (!append(branch, now)) return BranchEnd::stuck;
                continue;
            }
        }
        const auto end = stop(last, now);
        if (!append(branch, now)) return BranchEnd::stuck;
        if (end) return *end;
    }
    return BranchEnd::budget;
}

/// Returns a `stop` for `follow`, which ends where a line first comes down to a height.
REVCHAIN_LAZY
auto down_to(const BranchLine& line, double log_end) {
    return [&line, log_end](const BranchLine::Point& last,
                            BranchLine::Point& now) -> std::optional<BranchEnd> {
        if (!(now.at.log_height <= log_end)) return std::nullopt;
        const auto end = line.between(
            last, now, [&](const auto& point) { return point.at.log_height - log_end; });
        if (!end) return BranchEnd::stuck;
        now = *end, now.at.log_height = log_end;
        return BranchEnd::height;
    };
}

/// Returns the branch of a mode of height `critical`, down to another height.
REVCHAIN_LAZY
CordBranch branch_of_mode(const Cord& cord, double critical, double height,
                          const BranchOptions& options) {
    CordBranch result;
    result.mode = options.mode;
    auto line = std::make_shared<const BranchLine>(cord, static_cast<int>(options.mode));
    result.line = line;
    append_vertical(result, critical);
    const auto down = down_to(*line, std::log(height));
    result.end = follow(result, result.points.front(), options.max_step, options.max_points, down);
    if (result.end == BranchEnd::height) result.conical_height.back() = height;
    return result;
}

/// Adds the point, if any, between two neighbouring points at which `value` of a point is 0.
template <class F>
void add_passing(std::vector<BranchLine::Point>& to, const BranchLine& line,
                 const BranchLine::Point& last, const BranchLine::Point& now, const F& value) {
    const double before = value(last), after = value(now);
    if (after == 0) {
        to.push_back(now);
    } else if (before * after < 0) {
        if (const auto point = line.between(last, now, value)) to.push_back(*point);
    }
}

}  // namespace finite

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/cord/branch_shapes.hpp"
#endif
