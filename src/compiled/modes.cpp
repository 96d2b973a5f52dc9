// SPDX-License-Identifier: MPL-2.0
#include "revchain/methods.hpp"

namespace revchain::inline REVCHAIN_BUILD {

Modes<double> detail::modes_by_all_methods(const Chain<double>& chain, const ModesOptions<double>& options) {
    return modes(chain, options, methods::all);
}
template Modes<double> modes(const Chain<double>&, const ModesOptions<double>&);

}  // namespace revchain
