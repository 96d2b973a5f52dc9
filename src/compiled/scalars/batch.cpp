// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/batch.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Table<float> conical_heights(const ChainBatch<float>&, const BatchOptions&);
template Table<long double> conical_heights(const ChainBatch<long double>&, const BatchOptions&);
}  // namespace revchain
