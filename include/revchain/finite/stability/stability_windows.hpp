// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/branch/onset.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/stability_windows.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace finite {

struct JudgedPlace {
    double arc, height;
    Verdict verdict;
};

REVCHAIN_LAZY
Verdict verdict_on(const Chain<double>& chain, const Branch&, const SteadyShape& shape,
                   StabilityFrame frame) {
    return stability(chain, shape, frame).verdict;
}
REVCHAIN_LAZY
Verdict verdict_on(const Rig& rig, const Branch& branch, const SteadyShape& shape,
                   StabilityFrame frame) {
    const BranchSystem& system = *trace_of(branch).system;
    const RigStabilityOptions options{
        .frame = frame, .direction = system.direction, .gravity = system.gravity};
    return stability(rig, shape, options).verdict;
}

/// Returns the verdict at an arc after point `index`, at most that of the next point.
template <class System>
JudgedPlace judged_at(const System& system, const Branch& branch, Corrector& corrector,
                      std::size_t index, double arc, StabilityFrame frame) {
    detail::check_interrupt();
    const BranchTrace& trace = trace_of(branch);
    const BranchPoint& from = trace.points[index];
    std::optional<BranchPoint> point;
    if (arc > from.arc)
        point =
            corrector.corrected(moved(from.state, arc - from.arc, from.tangent), from.tangent, 1.0);
    const BranchPoint& here = point ? *point : from;
    if (const auto shape = shape_at(*trace.system, here.state, GivenPlace(here)))
        return {arc, shape->conical_height, verdict_on(system, branch, *shape, frame)};
    const double height =
        std::ldexp(std::exp(here.state.log_height), trace.system->units.length_exponent);
    return {arc, height, Verdict::undecided};
}

template <class System>
std::vector<StabilityWindow> windows_of(const System& system, const Branch& branch,
                                        const StabilityWindowsOptions& options) {
    constexpr std::string_view place = "stability_windows";
    detail::require_positive(place, "tolerance", options.tolerance);
    if (options.samples < 1)
        detail::throw_invalid(place, "samples must be at least 1", options.samples);
    constexpr bool is_rig = std::is_same_v<System, Rig>;
    const BranchTrace& trace = trace_of(branch);
    if (trace.system && (trace.system->rig.has_value() != is_rig ||
                         trace.system->links.bodies() != static_cast<std::size_t>(system.size())))
        detail::throw_invalid(place,
                              is_rig ? "the branch is not of this rig; its links number"
                                     : "the branch is not of this chain; its links number",
                              trace.system->links.bodies());
    std::vector<StabilityWindow> windows;
    std::size_t first = 0;
    while (trace.onset && first < branch.size() && largest_tau(trace.points[first].state) == 0)
        ++first;
    if (first >= branch.size()) return windows;
    using Judged = JudgedPlace;
    Corrector corrector(rounded(trace.system->links));
    const auto judge = [&](std::size_t index, double arc) {
        return judged_at(system, branch, corrector, index, arc, options.frame);
    };
    Judged last = judge(first, branch.arc[first]);
    windows.push_back({last.arc, last.arc, last.height, last.height, last.verdict});
    // extends the windows to a judged point, by bisection until a part is short or has one verdict
    const auto extend = [&](std::size_t index, const Judged& to) {
        std::vector<Judged> ahead{to};
        while (!ahead.empty()) {
            const Judged next = ahead.back();
            if (next.verdict != last.verdict) {
                const bool near =
                    next.arc - last.arc <= options.tolerance &&
                    std::abs(next.height - last.height) <= options.tolerance * last.height;
                const double middle = last.arc + (next.arc - last.arc) / 2;
                if (!near && last.arc < middle && middle < next.arc) {
                    ahead.push_back(judge(index, middle));
                    continue;
                }
                const double arc = middle, height = last.height + (next.height - last.height) / 2;
                windows.back().arc_to = arc, windows.back().height_to = height;
                windows.push_back({arc, next.arc, height, next.height, next.verdict});
            } else {
                windows.back().arc_to = next.arc, windows.back().height_to = next.height;
            }
            last = next;
            ahead.pop_back();
        }
    };
    for (std::size_t i = first; i + 1 < branch.size(); ++i) {
        const double step = branch.arc[i + 1] - branch.arc[i];
        for (int k = 1; k < options.samples; ++k)
            extend(i, judge(i, branch.arc[i] + step * k / options.samples));
        // from point to point: bisection stays within one step
        extend(i, judge(i + 1, branch.arc[i + 1]));
    }
    // a short undecided window between two verdicts is the change itself
    for (std::size_t i = 1; i + 1 < windows.size(); ++i) {
        StabilityWindow &before = windows[i - 1], &after = windows[i + 1];
        const StabilityWindow& change = windows[i];
        if (change.verdict != Verdict::undecided || before.verdict == after.verdict ||
            change.arc_to - change.arc_from > options.tolerance ||
            std::abs(change.height_to - change.height_from) > options.tolerance * change.height_to)
            continue;
        before.arc_to = after.arc_from = change.arc_from + (change.arc_to - change.arc_from) / 2;
        before.height_to = after.height_from =
            change.height_from + (change.height_to - change.height_from) / 2;
        windows.erase(windows.begin() + static_cast<std::ptrdiff_t>(i--));
    }
    return windows;
}

}  // namespace finite

REVCHAIN_DEFINE
std::vector<StabilityWindow> stability_windows(const Chain<double>& chain, const Branch& branch,
                                               const StabilityWindowsOptions& options) {
    return finite::windows_of(chain, branch, options);
}
REVCHAIN_DEFINE
std::vector<StabilityWindow> stability_windows(const Rig& rig, const Branch& branch,
                                               const StabilityWindowsOptions& options) {
    const auto& trace = finite::trace_of(branch);
    if (trace.system && !trace.system->rig && rig.is_plain_chain())  // followed as its chain
        return finite::windows_of(rig.chain(), branch, options);
    return finite::windows_of(rig, branch, options);
}

}  // namespace revchain
