// SPDX-License-Identifier: MPL-2.0
#include "revchain/models/for_modes.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {
REVCHAIN_ANSWER_BY(CoarseChain);
REVCHAIN_ANSWER_BY(Aberth);
REVCHAIN_ANSWER_BY(Interpolated);
REVCHAIN_ANSWER_BY(Condensed);
REVCHAIN_ANSWER_BY(Bisection);
}  // namespace revchain::detail
