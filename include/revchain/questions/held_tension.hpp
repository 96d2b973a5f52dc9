// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include "revchain/chain.hpp"
#include "revchain/system/cord.hpp"

namespace revchain::inline REVCHAIN_BUILD {

template <class System>
class Held;

namespace detail {

/// The tension at the lower end of a straight chain or cord, in the unit of the weights. Without gravity it is that of
/// the upper end, and weights are masses times `gravity`.
template <class System>
Wide<double> lower_tension(std::string_view place, const Held<System>& held, double gravity) {
    if (held.by().span)
        throw_invalid(place,
                      "a chain or cord whose ends are a span apart is bent, and has no modes of a straight one; use "
                      "steady_shapes for its shapes and stability for small motions about one; span",
                      *held.by().span);
    const Wide<double> upper = *held.by().tension;
    if (held.by().weightless) {
        require_positive(place, "gravity", gravity);
        return upper / Wide<double>(gravity);
    }
    Wide<double> weight;
    if constexpr (std::is_same_v<System, Cord>)
        weight = Wide<double>(held.system().weight());
    else
        weight = held.system().weight_below(held.system().size());
    const Wide<double> lower = upper - weight;
    if (!(lower > Wide<double>(0)))
        throw_invalid(place,
                      "tension at the upper end must exceed the weight " + in_digits(static_cast<double>(weight)) +
                          ", or the lower part is slack",
                      upper.high);
    return lower;
}

}  // namespace detail
}  // namespace revchain
