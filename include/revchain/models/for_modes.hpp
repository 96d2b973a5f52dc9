// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/models/closed_forms.hpp"
#include "revchain/models/coarse_chain.hpp"
#include "revchain/models/continuous_chain.hpp"
#include "revchain/models/equal_plummets.hpp"
#include "revchain/models/numerical.hpp"
#include "revchain/models/select.hpp"
#include "revchain/models/tapered_chain.hpp"

namespace revchain::inline REVCHAIN_BUILD::models {

/// The models among which `modes` chooses; where no tolerance is given, among those whose bounds are proved. The last
/// always answers.
inline constexpr std::tuple<ClosedForms, EqualPlummets, ContinuousChain, TaperedChain, CoarseChain, Aberth,
                            Interpolated, Condensed, Bisection>
    for_modes{};

/// The question about a range of modes. Without a tolerance bounds have to be proved.
inline Question question_of(const ModeRange& range, const std::optional<double>& tolerance,
                            Progress* progress = nullptr) {
    const double rtol = tolerance.value_or(0.0);
    return {range.first, range.count, rtol, 0, progress, !(rtol > 0)};
}

}  // namespace revchain::models

#if defined(REVCHAIN_COMPILED)
namespace revchain::inline REVCHAIN_BUILD::models::detail {
extern template Answer answer_by(const CoarseChain&, const Chain<double>&, const ChainKind&, const Question&);
extern template Answer answer_by(const Aberth&, const Chain<double>&, const ChainKind&, const Question&);
extern template Answer answer_by(const Interpolated&, const Chain<double>&, const ChainKind&, const Question&);
extern template Answer answer_by(const Condensed&, const Chain<double>&, const ChainKind&, const Question&);
extern template Answer answer_by(const Bisection&, const Chain<double>&, const ChainKind&, const Question&);
}  // namespace revchain::models::detail
#endif
