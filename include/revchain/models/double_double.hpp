// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/modes.hpp"
#include "revchain/models/model.hpp"
#include "revchain/modes.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/system/converted.hpp"

namespace revchain::models {

/// Bisection in two doubles, for tolerances below what one can hold: `Answer::conical_height_low` is what the heights
/// rounded to double leave. Bounds are proved, 1e-28 and more: they grow with N.
struct TwoWords {
    static constexpr std::string_view name = "double-double";

    Fit applies(const ChainKind&, const Question& question) const {
        if (question.inclination > 0) return Fit::no("for small inclinations");
        if (!(question.rtol > 0 && question.rtol < 3 * std::numeric_limits<double>::epsilon()))
            return Fit::no("double holds that tolerance");
        return {};
    }
    /// Foreseen, as it was measured (N = 1 to 3000, ten kinds of chain); the answer's own is proved.
    double error_bound(const ChainKind& kind, const Question&) const {
        const double n = static_cast<double>(kind.size);
        return 1e-29 * (30 + n) * (10 + n);
    }
    double cost(const ChainKind& kind, const Question& question) const {
        return 2e-5 + static_cast<double>(kind.size) * (2e-6 + 1.2e-5 * static_cast<double>(question.count));
    }
    Answer solve(const Chain<double>& chain, const ChainKind&, const Question& question) const {
        ModesOptions<DoubleDouble> options{.first = question.first, .count = question.count};
        options.shapes = false;
        const Modes<DoubleDouble> found = modes(converted<DoubleDouble>(chain), options);
        Answer answer{Vector<double>(question.count), Vector<double>(question.count)};
        answer.conical_height_low.resize(question.count);
        for (Index j = 0; j < question.count; ++j) {
            const auto word = found.conical_height[j].word();
            answer.conical_height[j] = word.high, answer.conical_height_low[j] = word.low;
            answer.error_bound[j] = static_cast<double>(found.error_bound[j]) * (1 + 1e-15);
        }
        return answer;
    }
};

}  // namespace revchain::models
