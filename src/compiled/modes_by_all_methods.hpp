// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/methods.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// `modes` of the library has all methods.
template <Real T>
Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options) {
    return modes(chain, options, methods::all);
}

}  // namespace revchain
