// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/branches.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/stability.hpp"

/// Where along a branch of steady shapes the shapes are stable.
///
///     const auto chain = revchain::Chain<double>::uniform_plummets(2, 2.0);
///     const auto branch = revchain::branch(chain, {.mode = 2, .max_angular_speed = 15.0});
///     const auto windows = revchain::stability_windows(chain, branch);
///     windows.size();                                               // 2 windows
///     windows[0].verdict == revchain::Verdict::spectrally_stable;   // true, from the vertical on
///     windows[1].verdict == revchain::Verdict::unstable;            // true: faster than that
///     windows[1].height_from;      // 0.135704 m: the conical height of the edge
namespace revchain::inline REVCHAIN_BUILD {

/// A part of a branch in which all sampled shapes have the same verdict.
struct StabilityWindow {
    double arc_from, arc_to;
    double height_from, height_to;  ///< conical heights; `from` is nearer to the first point
    Verdict verdict;
};

struct StabilityWindowsOptions {
    StabilityFrame frame = StabilityFrame::free;
    double tolerance = 1e-6;  ///< of the edges, relative in conical height and absolute in arc
    int samples = 8;  ///< equal parts of the step between two points; verdicts at their ends
};

/// Returns the parts of a branch with one verdict each, in the order of the arc, from the first
/// point off the vertical to the end.
///
/// Method: `stability` at every point of the branch and at `samples - 1` points between two (with
/// `thorough` only in programs that link revchain::compiled). Where the verdict changes, the step
/// is halved until it is as short as `tolerance`. A window shorter than the distance between two
/// samples can be missed, so the result is not proved. Accuracy: edges to `tolerance`. Cost: that
/// of `stability` for each sample. Throws InvalidArgument for a tolerance not above 0, `samples`
/// below 1, and as `stability`.
REVCHAIN_DECLARE
[[nodiscard]] std::vector<StabilityWindow> stability_windows(
    const Chain<double>& chain, const Branch& branch, const StabilityWindowsOptions& options = {});

/// Returns the stability windows of a branch of a rig, in the direction of rotation of the branch.
REVCHAIN_DECLARE
[[nodiscard]] std::vector<StabilityWindow> stability_windows(
    const Rig& rig, const Branch& branch, const StabilityWindowsOptions& options = {});

}  // namespace revchain

#if !defined(REVCHAIN_COMPILED)
#include "revchain/finite/stability/stability_windows.hpp"
#endif
