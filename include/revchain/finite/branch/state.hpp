// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>
#include <vector>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A point of a branch or a direction: tau of each link, with tan(inclination) = sinh tau, and log
/// lambda. tau is a small inclination or the logarithm of a large tangent; branches end straight.
struct BranchState {
    std::vector<double> rise;  ///< tau, lowest link first
    double log_height = 0;
};

/// A point with the direction of the branch.
struct BranchPoint {
    BranchState state, tangent;  ///< tangent: of length 1 along the arc
    double arc = 0;
    int half_waves = 0;  ///< sign changes of the offsets plus 1; 0 if rounding leaves one undecided
};

struct BranchSystem;
struct BranchOnset;

/// How a branch was followed; read by accessors of `Branch`.
struct BranchTrace {
    std::shared_ptr<const BranchSystem> system;
    std::vector<BranchPoint> points;
    std::shared_ptr<const BranchOnset> onset;  ///< of the mode; null for other branches
};

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
