// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/modes.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Modes<float> modes(const Chain<float>&, const ModesOptions<float>&);
}  // namespace revchain
