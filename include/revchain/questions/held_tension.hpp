// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include "revchain/chain.hpp"
#include "revchain/system/cord.hpp"

namespace revchain::inline REVCHAIN_BUILD {

template <class System>
class Held;

namespace detail {

/// A tension, and a bound on its absolute error.
struct LowerTension {
    Wide<double> tension;
    double error;
};

/// The tension at the lower end of a straight chain or cord, in the unit of the weights. Without
/// gravity it is the tension at the upper end, and weights are masses times `gravity`. The tension
/// given is exact if its second word is 0; else it may be a quotient that was rounded once.
template <class System>
LowerTension lower_tension(std::string_view place, const Held<System>& held, double gravity) {
    if (held.by().span)
        throw_invalid(
            place,
            "a chain or cord whose ends are a span apart is bent, and has no modes of a straight "
            "one; use steady_shapes for its shapes and stability for small motions about one; span",
            *held.by().span);
    constexpr double rounding = operation_error<Wide<double>>();
    const Wide<double> upper = *held.by().tension;
    if (held.by().weightless) {
        require_positive(place, "gravity", gravity);
        const Wide<double> tension = upper / Wide<double>(gravity);
        return {tension, 2 * rounding * tension.high};
    }
    CompensatedSum<Wide<double>> lower;
    lower.add(upper);
    double weight, sums = 3;  // numbers that are added
    if constexpr (std::is_same_v<System, Cord>) {
        lower.add(-(weight = held.system().weight()));
    } else {
        const auto& weights = held.system().weight();
        for (Index m = 0; m < held.system().size(); ++m) lower.add(-weights[m]);
        weight = held.system().total_weight(), sums += static_cast<double>(held.system().size());
    }
    const Wide<double> tension = lower.value();
    const double parts = sums * epsilon<double>();
    const double given = upper.low == 0 ? 0 : rounding * upper.high;
    const double error = given + parts * parts * parts * upper.high + 2 * rounding * tension.high;
    if (tension.high > error) return {tension, error};
    throw_invalid(place,
                  "tension at the upper end must exceed the weight " + in_digits(weight) +
                      ", or the lower part is slack",
                  upper.high);
}

}  // namespace detail
}  // namespace revchain
