// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/models/closed_forms.hpp"
#include "revchain/models/coarse_chain.hpp"
#include "revchain/models/continuous_chain.hpp"
#include "revchain/models/equal_plummets.hpp"
#include "revchain/models/long_chains.hpp"
#include "revchain/models/many_modes.hpp"
#include "revchain/models/select.hpp"
#include "revchain/models/tapered_chain.hpp"

/// The models from which `modes` may choose, and those that the library has compiled.
#if defined(REVCHAIN_COMPILED)
namespace revchain::inline REVCHAIN_BUILD::models::detail {
extern template Answer answer_by(const CoarseChain&, const Chain<double>&, const ChainKind&,
                                 const Question&);
extern template Answer answer_by(const Aberth&, const Chain<double>&, const ChainKind&,
                                 const Question&);
extern template Answer answer_by(const Interpolated&, const Chain<double>&, const ChainKind&,
                                 const Question&);
extern template Answer answer_by(const Condensed&, const Chain<double>&, const ChainKind&,
                                 const Question&);
extern template Answer answer_by(const Bisection&, const Chain<double>&, const ChainKind&,
                                 const Question&);
}  // namespace revchain::models::detail
#endif
