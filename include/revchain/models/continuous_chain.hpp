// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <numbers>

#include "revchain/models/model.hpp"
#include "revchain/models/straight_links.hpp"
#include "revchain/numeric/zero_of_j0.hpp"

namespace revchain::inline REVCHAIN_BUILD::models {

using revchain::detail::zero_of_j0;

/// Heights in the limit of many equal links: lambda = 4 L/j^2, j = j_{0,k}. Greenhill (1908) §4
/// (9), (10). The error bound follows from the limit of N links, with J = J_1(j). For plummets it
/// is (1/2)/N and the terms of order 1/N^2. For rods (q (1/24 J^2 - 1/12) - 1/24)/N^2, q = j^2/4,
/// is subtracted, and a bound of order log N/N^4 remains (straight_links.hpp). Measured:
/// tests/cpp/models/models.cpp, tapered.cpp. Cost: 12 ns a mode, 30 ns for rods.
struct ContinuousChain {
    static constexpr std::string_view name = "continuous chain";

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (!kind.plummets && !kind.rods) return Fit::no("neither equal plummets nor equal rods");
        if (2 * question.last() > kind.size) return Fit::no("more than half of the modes");
        return {};
    }
    double error_bound(const ChainKind& kind, const Question& question) const {
        const double bound = answer(kind, question.last()).error_bound;
        return kind.rods && question.first == 1 ? std::max(bound, answer(kind, 1).error_bound)
                                                : bound;
    }
    double cost(const ChainKind& kind, const Question& question) const {
        return kind.rods ? 1.5e-7 + 2.8e-8 * detail::real(question.count)
                         : 1.2e-7 + 1.2e-8 * detail::real(question.count);
    }
    Answer solve(const Chain<double>&, const ChainKind& kind, const Question& question) const {
        return answer_of_each(question, [&](Index k) { return answer(kind, k); });
    }

   private:
    static BoundedHeight answer(const ChainKind& kind, Index k) {
        const double n = detail::real(kind.size), j = zero_of_j0(k), half = j / 2;
        const double cord = kind.length / (half * half), rounding = 4 * epsilon<double>();
        if (kind.plummets) {
            const double share = j / n;  // the wave's phase from link to link at the support
            return {cord, 0.5 / n +
                              (share * share + 12 / (n * n)) / 48 * (1 + 0.25 * share * share) +
                              rounding};
        }
        const double q = half * half,
                     lost = (q * (inverse_square(k, j) / 24 - 1.0 / 12) - 1.0 / 24) / (n * n);
        return detail::enclosed(cord, lost, detail::next_order(0, k, q / n), rounding);
    }
    /// 1/J_1(j)^2 at j = j_{0,k}, to 1e-12: pi j/2 and DLMF 10.18.17 far out.
    static double inverse_square(Index k, double j) {
        constexpr std::array<double, 8> first{
            3.7103806857094818, 8.6370599676731407, 13.571034317451809, 18.505642293256415,
            23.440377479990542, 28.375150769745824, 33.309938538741463, 38.24473275582541};
        if (k <= static_cast<Index>(first.size())) return first[static_cast<std::size_t>(k) - 1];
        const double e = 1 / (j * j);
        return std::numbers::pi / 2 * j *
               (1 -
                e * (1.0 / 8 - e * (27.0 / 128 - e * (1125.0 / 1024 - e * (385875.0 / 32768)))));
    }
};

}  // namespace revchain::models
