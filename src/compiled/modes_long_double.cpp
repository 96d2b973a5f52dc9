// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/modes.hpp"

namespace revchain {
template Modes<long double> modes(const Chain<long double>&, const ModesOptions<long double>&);
}  // namespace revchain
