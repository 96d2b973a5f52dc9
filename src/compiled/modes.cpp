// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/modes.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Modes<double> modes(const Chain<double>&, const ModesOptions<double>&);
}  // namespace revchain
