// SPDX-License-Identifier: MPL-2.0
#pragma once

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

}  // namespace revchain::finite
