// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/branch/crossing.hpp"
#include "revchain/finite/branch/lowest_height.hpp"
#include "revchain/finite/branch/onset.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Appends a point and the numbers of `described` to a branch.
template <class Branch>
void append(Branch& branch, const BranchPoint& point) {
    const BranchSystem& system = *trace_of(branch).system;
    const auto& links = system.links;
    const auto length = [&](double x) { return std::ldexp(x, system.units.length_exponent); };
    const auto weight = [&](double x) { return std::ldexp(x, system.units.weight_exponent); };
    const double height = std::exp(point.state.log_height);
    const Fine speed = links.speed_at(Fine(height));
    double y = as_double(links.radius), sideways = 0, inertia = system.axial, energy = 0;
    for (std::size_t m = links.size(); m-- > 0;) {
        const auto& link = links.links[m];
        const Inclined at = links.inclined(m, point.state.tau[m]);
        const double a = as_double(link.length), moment = as_double(link.moment),
                     rest = as_double(link.rest), pull = as_double(links.pull(m, speed)),
                     d = a * at.sine, upper = y;
        y += d;
        inertia += moment * y * y + rest * upper * upper - as_double(link.cross) * d * d;
        if (!links.is_spring(m)) sideways += moment * y + rest * upper;
        energy += links.is_spring(m) ? pull * a * at.sine * at.sine / 2 : -pull * a / at.secant;
    }
    branch.arc.push_back(point.arc), branch.conical_height.push_back(length(height));
    const double inclination = std::atan(std::sinh(point.state.tau[0]));
    branch.tip_inclination.push_back(system.stands(0) ? beyond(-inclination, inclination < 0)
                                                      : inclination);
    branch.tip_radius.push_back(length(y)), branch.half_waves.push_back(point.half_waves);
    branch.top_tension.push_back(weight(std::hypot(as_double(system.bearing), sideways / height)));
    branch.moment_of_inertia.push_back(
        weight(std::ldexp(inertia, 2 * system.units.length_exponent)));
    branch.effective_energy.push_back(weight(length(energy - inertia / (2 * height))));
    trace_of(branch).points.push_back(point);
}

/// Returns true if a point lies beyond a neighbouring one in the direction of the branch.
REVCHAIN_LAZY
bool is_past(const BranchPoint& here, const BranchPoint& there) {
    return inner(moved(here.state, -1, there.state), here.tangent) > 0;
}

/// Returns true if a step passes the start of a loop in the same direction.
REVCHAIN_LAZY
bool returned(const BranchPoint& here, const BranchPoint& before, const BranchPoint& start) {
    const double reach = here.arc - before.arc;
    if (!(before.arc > start.arc) || inner(here.tangent, start.tangent) < 0.5) return false;
    const BranchState from_before = moved(start.state, -1, before.state);
    return inner(from_before, from_before) < 2 * reach * reach && !is_past(before, start) &&
           is_past(here, start);
}

/// Returns true if a step goes through the straight chain to the mirror image.
REVCHAIN_LAZY
bool crosses_vertical(const BranchPoint& before, const BranchPoint& here) {
    double sum = 0;
    for (std::size_t m = 0; m < here.state.tau.size(); ++m)
        sum += before.state.tau[m] * here.state.tau[m];
    return sum < 0;
}

/// Returns true if flywheels cancel all but a part `left` of the tension of a link.
REVCHAIN_LAZY
bool is_slack(const BranchLinks<double>& links, double log_height, double left) {
    const double speed = links.speed_at(std::exp(log_height));
    for (std::size_t m = 0; m < links.bodies(); ++m)
        if (std::abs(links.pull(m, speed)) < left * std::abs(links.links[m].pull)) return true;
    return false;
}

/// Returns true if the spring at the support is stretched by more than a thousand lengths.
template <class S>
bool is_loose(const BranchLinks<S>& links, const BranchState& at) {
    return links.spring && std::abs(at.tau.back()) > 7.6;  // arsinh 1000
}

/// Follows a branch until it comes down to `log_end` or, if finite, up to `log_top`. Adds points at
/// folds. Returns why it ended.
template <class Branch>
auto follow(Branch& branch, BranchWalk& walk, double log_end, std::size_t max_points,
            double log_top = std::numeric_limits<double>::infinity()) {
    using End = decltype(Branch::end);
    const HeightMeasure to_end{log_end};
    const BranchPoint start = walk.here();
    const bool passes_vertical = trace_of(branch).system->links.is_symmetric();
    while (branch.size() < max_points) {
        if (!walk.advance())
            return is_slack(walk.links(), walk.here().state.log_height, 1e-5) ? End::slack
                                                                              : End::stuck;
        const BranchPoint &before = walk.before(), &here = walk.here();
        if (passes_vertical && crosses_vertical(before, here)) return End::vertical;
        auto crossings = crossings_of(walk, to_end);
        std::erase_if(crossings,
                      [](const WithinStep& each) { return each.point.tangent.log_height > 0; });
        const double until = crossings.empty() ? 1.0 : crossings.front().share;
        const bool closed = returned(here, before, start);
        if (before.tangent.log_height * here.tangent.log_height < 0)
            if (const auto fold = turning_of(walk, to_end);
                fold && fold->share < until && !(closed && is_past(fold->point, start))) {
                append(branch, fold->point);
                branch.folds.push_back(branch.size() - 1);
                if (branch.size() >= max_points) return End::budget;
            }
        if (!crossings.empty()) {
            append(branch, crossings.front().point);
            return End::height;
        }
        if (here.state.log_height < log_end) return End::stuck;  // passed the end unseen
        if (closed) {
            const BranchState rest = moved(start.state, -1, before.state);
            BranchPoint again = start;
            again.arc = before.arc + std::sqrt(inner(rest, rest));
            append(branch, again);
            return End::closed;
        }
        append(branch, here);
        if (is_slack(walk.links(), here.state.log_height, 1e-9)) return End::slack;
        if (here.state.log_height > log_top) return End::slow;
        if (is_loose(trace_of(branch).system->links, here.state)) return End::loose;
    }
    return End::budget;
}

/// Returns the states of a branch at one height, in the order of the arc. Between the vertical and
/// the next point, where the height hardly changes, they come from the law of the onset.
template <class Branch>
std::vector<SteadyShape> states_at(const Branch& branch, Corrector& corrector,
                                   double conical_height) {
    std::vector<SteadyShape> found;
    if (branch.size() == 0) return found;
    const auto& trace = trace_of(branch);
    const BranchSystem& system = *trace.system;
    const Fine height = ldexp(Fine(conical_height), -system.units.length_exponent);
    const HeightMeasure measure{std::log(as_double(height))};
    const GivenHeight condition(height);
    const auto off = [&](std::size_t i) {
        return (branch.conical_height[i] - conical_height) / conical_height;
    };
    const auto take = [&](const BranchState& near) {
        if (auto shape = shape_at(system, near, condition)) found.push_back(std::move(*shape));
    };
    const bool from_vertical = trace.onset && largest_tau(trace.points[0].state) == 0;
    const double side = from_vertical && trace.onset->rises() ? -1 : 1;  // of the mode's height
    const bool within = from_vertical && side * off(0) > 0;
    if (from_vertical && !within && branch.size() < 2) return found;
    const double there = within ? std::min(1e-9, 0.01 * side * off(0)) : 1e-9;
    const std::size_t last = branch.size() - 1;
    const bool closed = branch.end == decltype(branch.end)::closed && last > 1;
    for (std::size_t i = from_vertical ? 1 : 0; i <= last; ++i) {
        const double a = off(i);
        if (i == 1 && within && side * a <= -there)
            if (const auto point = near_vertical(system, *trace.onset, height)) take(point->state);
        if (std::abs(a) < there) {  // the point itself: an end, or a crossing
            if (closed && i == last) continue;  // the first point again
            const bool is_end = !closed && (i == 0 || i == last);
            if (is_end || (off(i == 0 ? last - 1 : i - 1) > 0) != (off(i + 1) > 0))
                take(trace.points[i].state);
        } else if (i < last && std::abs(off(i + 1)) >= there && (a > 0) != (off(i + 1) > 0)) {
            const auto walk = BranchWalk::between(corrector, trace.points[i], trace.points[i + 1]);
            const auto crossing = crossings_of(walk, measure);
            if (!crossing.empty()) take(crossing.front().point.state);
        }
    }
    return found;
}

}  // namespace revchain::finite
