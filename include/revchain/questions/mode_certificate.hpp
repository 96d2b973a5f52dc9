// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/modes.hpp"
#include "revchain/pencil/sturm.hpp"

/// Certificates of modes, for the option `certify`. `count(lower, upper)` returns the certified
/// counts of heights above `lower` and above `upper`.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// Stores proved counts at a number of T below and one above the height at index j, which belongs
/// to mode number `before` + 1 of `mode_count`. Their distance from the height is its error bound,
/// doubled at most seven times while rounding to T leaves a count unproved.
template <Real T, class Count>
void certify(Certificate<T>& certificate, Index j, const T& height, const T& bound, Index before,
             Index mode_count, const Count& count) {
    using std::isfinite;
    certificate.lower[j] = T(0), certificate.above_lower[j] = mode_count;
    certificate.upper[j] = std::numeric_limits<T>::infinity(), certificate.above_upper[j] = 0;
    if (!(bound < T(1))) return;
    bool below = false, above = false;
    T reach = height * std::max(bound, epsilon<T>() / T(2));
    for (int attempt = 0; attempt < 8 && !(below && above); ++attempt, reach = reach + reach) {
        const T lower = height - reach, upper = height + reach;
        if (!(lower > T(0)) || !isfinite(upper)) return;
        const std::array<pencil::CertifiedCount, 2> ends = count(lower, upper);
        if (!below && ends[0].proved && ends[0].above > before) {
            certificate.lower[j] = lower, certificate.above_lower[j] = ends[0].above;
            below = true;
        }
        if (!above && ends[1].proved && ends[1].above <= before) {
            certificate.upper[j] = upper, certificate.above_upper[j] = ends[1].above;
            above = true;
        }
    }
}

/// Certifies every mode in `modes`. The system has `mode_count` modes in all.
template <class Found, class Count>
void certify(Found& modes, Index mode_count, const Count& count) {
    const Index size = modes.size();
    const auto& height = modes.conical_height;
    modes.certificate = {height, height, Vector<Index>(size), Vector<Index>(size)};
    parallel_for(size, 1, [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j) {
            check_interrupt();
            certify(modes.certificate, j, height[j], modes.error_bound[j], modes.first - 1 + j,
                    mode_count, count);
        }
    });
}

}  // namespace revchain::detail
