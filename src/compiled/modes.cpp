// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/modes.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Modes<float> modes(const Chain<float>&, const ModesOptions<float>&);
template Modes<double> modes(const Chain<double>&, const ModesOptions<double>&);
}  // namespace revchain
