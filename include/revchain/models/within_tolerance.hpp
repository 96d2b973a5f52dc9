// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <tuple>

#include "revchain/models/closed_forms.hpp"
#include "revchain/models/coarse_chain.hpp"
#include "revchain/models/continuous_chain.hpp"
#include "revchain/models/equal_plummets.hpp"
#include "revchain/models/select.hpp"
#include "revchain/models/tapered_chain.hpp"

namespace revchain::inline REVCHAIN_BUILD::methods {

/// Methods that are cheaper where a tolerance is given: closed forms, zeros of Bessel functions, coarse chains.
inline constexpr std::tuple<models::ClosedForms, models::EqualPlummets, models::ContinuousChain, models::TaperedChain,
                            models::CoarseChain>
    within_tolerance{};

}  // namespace revchain::methods

#if defined(REVCHAIN_COMPILED)
namespace revchain::inline REVCHAIN_BUILD::models::detail {
extern template Answer answer_by(const CoarseChain&, const Chain<double>&, const ChainKind&, const Question&);
}  // namespace revchain::models::detail
#endif
