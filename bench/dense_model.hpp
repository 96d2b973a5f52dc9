// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/pencils.hpp"
#include "revchain/models/heights.hpp"
#include "revchain/pencil/certificate.hpp"
#include "revchain/pencil/dense.hpp"

namespace revchain::inline REVCHAIN_BUILD::models {

/// The textbook method, for comparison: both matrices assembled, Cholesky and the symmetric QR algorithm for all modes.
/// Assembling adds neighbouring stiffnesses, which loses the slowest modes of long or unlike chains; counts on the
/// chain's elements prove how much. It is never the cheapest. Cost: about 1.4 ns N^3.
struct Dense {
    static constexpr std::string_view name = "dense";
    static constexpr Index most_links = 300;

    Fit applies(const ChainKind& kind, const Question&) const {
        if (kind.size > most_links) return Fit::no("more than 300 links");
        if (kind.mode_count < kind.size) return Fit::no("a link without inertia");
        return {};
    }
    /// Predicted for like links, whose stiffness has a condition of about N^2; no bound for others.
    double error_bound(const ChainKind& kind, const Question&) const {
        const double n = detail::real(kind.size);
        return 2e-16 * (6 + n) * (6 + n);
    }
    double cost(const ChainKind& kind, const Question& question) const {
        const double n = detail::real(kind.size);
        return 6e-7 + n * (1.5e-7 + 6e-7 * detail::real(question.count) + n * (3e-8 + n * 1.4e-9));
    }
    Answer solve(const Chain<double>& chain, const ChainKind& kind, const Question& question) const {
        const revchain::detail::Pencils<double> pencils(chain);
        const auto matrices = pencil::assembled(pencils.rounded());
        const Vector<double> heights = pencil::solve_symmetric_definite(matrices.K, matrices.M).values;
        Answer answer{Vector<double>(question.count), Vector<double>(question.count)};
        for (Index i = 0; i < question.count; ++i) {
            const Index j = question.first - 1 + i;
            double margin = 2 * std::numeric_limits<double>::epsilon();
            if (!(heights[j] > 0)) return Answer::none();
            for (; margin < 0.5; margin = std::max(16 * margin, error_bound(kind, question)))
                if (pencil::lies_within(pencils.wide(), j, heights[j], margin)) break;
            if (!(margin < 0.5)) return Answer::none();
            answer.conical_height[i] = std::ldexp(heights[j], pencils.length_exponent());
            answer.error_bound[i] = pencil::bound_of_margin<Wide<double>>(margin);
        }
        return answer;
    }
};

inline constexpr auto height_models_with_dense = std::tuple_cat(height_models, std::tuple<Dense>{});

}  // namespace revchain::models
