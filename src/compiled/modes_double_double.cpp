// SPDX-License-Identifier: MPL-2.0
#include "modes_by_all_methods.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Modes<DoubleDouble> modes(const Chain<DoubleDouble>&, const ModesOptions<DoubleDouble>&);
}  // namespace revchain
