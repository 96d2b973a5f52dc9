// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Makes one step of a walk along a curve by arc length: of length `step`, at most `longest`.
/// `attempt(step)` predicts along the direction, corrects across it and accepts the point. It
/// returns the factor for the next step, or nothing if the corrector fails or the point may lie on
/// another curve. Then the share `less` of the step is tried. Returns false if no step above 1e-9
/// succeeds.
template <class Attempt>
bool arc_step(double& step, double longest, double less, const Attempt& attempt) {
    check_interrupt();
    for (step = std::min(step, longest); step > 1e-9; step *= less)
        if (const std::optional<double> factor = attempt(step)) {
            step *= *factor;
            return true;
        }
    return false;
}

}  // namespace revchain::detail
