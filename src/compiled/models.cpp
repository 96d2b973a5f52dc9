// SPDX-License-Identifier: MPL-2.0
#include "revchain/methods.hpp"

namespace revchain::inline REVCHAIN_BUILD::models::detail {
template Answer answer_by(const CoarseChain&, const Chain<double>&, const ChainKind&, const Question&);
template Answer answer_by(const Aberth&, const Chain<double>&, const ChainKind&, const Question&);
template Answer answer_by(const Interpolated&, const Chain<double>&, const ChainKind&, const Question&);
template Answer answer_by(const Condensed&, const Chain<double>&, const ChainKind&, const Question&);
template Answer answer_by(const Bisection&, const Chain<double>&, const ChainKind&, const Question&);
}  // namespace revchain::models::detail
