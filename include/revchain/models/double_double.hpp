// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/heights.hpp"
#include "revchain/models/model.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/system/converted.hpp"

namespace revchain::inline REVCHAIN_BUILD::models {

/// Bisection in double-double, for tolerances below the precision of double.
/// `Answer::conical_height_low` is the low word of each height. Bounds are proved. The smallest is
/// 3e-27; they grow with N.
struct DoubleDoubleBisection {
    static constexpr std::string_view name = "double-double";

    Fit applies(const ChainKind&, const Question& question) const {
        if (question.inclination > 0) return Fit::no("for small inclinations");
        if (!(question.rtol > 0 && question.rtol < 3 * std::numeric_limits<double>::epsilon()))
            return Fit::no("double holds that tolerance");
        return {};
    }
    /// Returns a prediction from measurements (N = 1 to 3000, ten kinds of chain). The bound of the
    /// answer is proved.
    double error_bound(const ChainKind& kind, const Question&) const {
        const double n = detail::real(kind.size);
        return 1e-29 * (30 + n) * (10 + n);
    }
    double cost(const ChainKind& kind, const Question& question) const {
        return 2e-5 + detail::real(kind.size) * (2e-6 + 1.2e-5 * detail::real(question.count));
    }
    Answer solve(const Chain<double>& chain, const ChainKind&, const Question& question) const {
        const auto wide = revchain::detail::converted<DoubleDouble>(chain);
        revchain::detail::LazyCounter<DoubleDouble> assembled(wide);
        const auto found = revchain::detail::heights_by_bisection(
            wide, assembled, {question.first, question.count}, {.progress = question.progress});
        const int exponent = chain.units().length_exponent;
        Answer answer{Vector<double>(question.count), Vector<double>(question.count)};
        answer.conical_height_low.resize(question.count);
        for (Index j = 0; j < question.count; ++j) {
            const auto& height = found[static_cast<std::size_t>(j)];
            const auto word = height.eigenvalue.word();
            answer.conical_height[j] = std::ldexp(word.high, exponent);
            answer.conical_height_low[j] = std::ldexp(word.low, exponent);
            answer.error_bound[j] = static_cast<double>(height.error_bound) * (1 + 1e-15);
        }
        return answer;
    }
};

}  // namespace revchain::models
