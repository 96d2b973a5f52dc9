// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/core/zero_of_j0.hpp"
#include "revchain/scene/model.hpp"

namespace revchain::models {

/// The limit of many equal links: lambda = 4 L/j^2, j = j_{0,k}. Greenhill (1908) §4 (9), (10).
/// Error bound from how chains of N links tend to it, with J = J_1(j): of plummets (1/2)/N and the terms of order 1/N^2, of
/// rods |q (1/24 J^2 - 1/12) - 1/24|/N^2, q = j^2/4. Measured: tests/cpp/scene/models.cpp. Cost: 5 ns a mode.
struct ContinuousChain {
    static constexpr std::string_view name = "continuous chain";

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (!kind.plummets && !kind.rods) return Fit::no("neither equal plummets nor equal rods");
        if (2 * question.last() > kind.size) return Fit::no("more than half of the modes");
        return {};
    }
    double error_bound(const ChainKind& kind, const Question& question) const {
        return bound(kind, zero_of_j0(question.last()));
    }
    double cost(const ChainKind&, const Question& question) const {
        return 8e-8 + 1.2e-8 * static_cast<double>(question.count);
    }
    Answer solve(const Chain<double>&, const ChainKind& kind, const Question& question) const {
        Answer answer{Vector<double>(question.count), Vector<double>(question.count)};
        for (Index i = 0; i < question.count; ++i) {
            const double j = zero_of_j0(question.first + i), half = j / 2;
            answer.conical_height[i] = kind.length / (half * half);
            answer.error_bound[i] = bound(kind, j);
        }
        return answer;
    }

   private:
    static double bound(const ChainKind& kind, double j) {
        const double n = static_cast<double>(kind.size), rounding = 4 * epsilon<double>();
        const double share = j / n;  // the wave's phase from link to link at the support
        if (kind.plummets) return 0.5 / n + (share * share + 12 / (n * n)) / 48 * (1 + 0.25 * share * share) + rounding;
        // 1/J_1(j)^2 < pi j/2 (1 + 3/(8 j^2))
        const double q = j * j / 4, inverse = 1.5707963267948966 * j * (1 + 0.375 / (j * j));
        return (q * inverse / 24 * (1 + share) + 0.05) / (n * n) + rounding;
    }
};

}  // namespace revchain::models
