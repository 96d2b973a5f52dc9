// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/batch.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Table<double> conical_heights(const ChainBatch<double>&, const BatchOptions&);
}  // namespace revchain
