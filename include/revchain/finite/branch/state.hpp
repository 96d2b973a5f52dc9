// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>
#include <vector>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A point of a branch, or a direction along one: of each link tau, tan delta = sinh tau, and log lambda. tau is the
/// inclination where that is small and, as the link nears the horizontal, the logarithm of its tangent: branches are
/// all but straight lines in these at both ends.
struct BranchState {
    std::vector<double> rise;  ///< tau, lowest link first
    double log_height = 0;
};

/// A point with the branch's direction there.
struct BranchPoint {
    BranchState state, tangent;  ///< tangent: of length 1 along the arc
    double arc = 0;
    int half_waves = 0;  ///< sign changes of the offsets, and one; 0 where rounding leaves a sign open
};

struct BranchSystem;
struct BranchOnset;

/// How a branch was followed: its system, its points and the onset it began at. Accessors of `Branch` read it.
struct BranchTrace {
    std::shared_ptr<const BranchSystem> system;
    std::vector<BranchPoint> points;
    std::shared_ptr<const BranchOnset> onset;  ///< of the mode; null for other branches
};

/// Reaches the trace of a branch.
struct TraceBehind {
    template <class Branch>
    static auto& of(Branch& branch) {
        return branch.trace_;
    }
};

template <class Branch>
auto& trace_of(Branch& branch) {
    return TraceBehind::of(branch);
}

}  // namespace revchain::finite
