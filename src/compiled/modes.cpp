// SPDX-License-Identifier: MPL-2.0
#include "modes_by_all_methods.hpp"

namespace revchain::inline REVCHAIN_BUILD {
template Modes<double> modes(const Chain<double>&, const ModesOptions<double>&);
}  // namespace revchain
