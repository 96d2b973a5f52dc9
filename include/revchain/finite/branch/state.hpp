// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <memory>
#include <vector>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A point of a branch or a direction: tau of each link, with tan(inclination) = sinh tau, and log
/// lambda. A small tau is the inclination, a large one the logarithm of the tangent. In these
/// coordinates the ends of branches are straight.
struct BranchState {
    std::vector<double> tau;  ///< of each link, lowest first
    double log_height = 0;
};

/// A point with the direction of the branch.
struct BranchPoint {
    BranchState state, tangent;  ///< tangent: direction of length 1 along the arc
    double arc = 0;
    int half_waves = 0;  ///< sign changes of the offsets plus 1; 0 if rounding leaves one undecided
};

struct BranchSystem;
struct BranchOnset;

/// The record of how a branch was followed. Accessors of `Branch` read it.
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
