// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include "revchain/finite/shapes/isolation.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::finite {

/// Where a proof of completeness did not reach, shapes that are there all the same: one at least between tangents of
/// the lowest link at which the offset of the support, `sign(tangent)`, has opposite signs for certain. Looks at the
/// ends of the `ranges`, ascending, and at those of `points` tangents up to `last` that lie within them: a third each
/// even in the inclination, in the tangent, and in its logarithm down to 1e-12 of the last.
template <Real T, class Sign>
std::vector<Bracket<T>> scanned(const std::vector<Bracket<T>>& ranges, double last, long points, const Sign& sign) {
    std::vector<double> tangents;
    const double steepest = std::atan(last), third = static_cast<double>(points / 3);
    for (double i = 0.5; i < third; ++i) {
        tangents.push_back(std::tan(steepest * i / third));
        tangents.push_back(last * i / third);
        tangents.push_back(last * std::pow(10.0, -12 * i / third));
    }
    std::sort(tangents.begin(), tangents.end());
    std::vector<Bracket<T>> found;
    auto next = tangents.begin();
    for (const Bracket<T>& range : ranges) {
        next = std::upper_bound(next, tangents.end(), static_cast<double>(range.low));
        T seen_at{};
        int seen = 0;
        const auto note = [&](const T& t) {
            revchain::detail::look();
            const int here = t > T(0) ? sign(t) : 0;
            if (here == 0) return;
            if (here == -seen) found.push_back({seen_at, t});
            seen = here, seen_at = t;
        };
        note(range.low);
        for (; next != tangents.end() && T(*next) < range.high; ++next) note(T(*next));
        note(range.high);
    }
    return found;
}

}  // namespace revchain::finite
