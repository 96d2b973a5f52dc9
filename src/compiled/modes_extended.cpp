// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/modes.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Modes<long double> modes(const Chain<long double>&, const ModesOptions<long double>&);
}  // namespace revchain
