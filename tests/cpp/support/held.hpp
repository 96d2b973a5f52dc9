// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/held.hpp"

namespace support {

template <class System>
using HeldOptions = std::conditional_t<std::is_same_v<System, revchain::Cord>, revchain::HeldCordShapesOptions,
                                       revchain::HeldShapesOptions>;

/// Shapes of a chain or cord held `span` apart; height 0: without gravity.
template <class System>
auto held_shapes(const System& system, double span, double height, HeldOptions<System> options = {}) {
    if (height != 0) options.conical_height = height;
    return revchain::steady_shapes(revchain::Held(system, {.span = span, .weightless = height == 0}), options);
}

}  // namespace support
