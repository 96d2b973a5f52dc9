// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/modes.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Modes<DoubleDouble> modes(const Chain<DoubleDouble>&, const ModesOptions<DoubleDouble>&);
}  // namespace revchain
