// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <tuple>

#include "revchain/models/long_chains.hpp"
#include "revchain/models/many_modes.hpp"
#include "revchain/models/within_tolerance.hpp"
#include "revchain/modes.hpp"

/// Faster methods for `modes`: of many modes, of long chains, and where a tolerance is given.
///
///     const auto rods = revchain::Chain<double>::uniform_rods(100'000, 0.36);
///     const auto m = revchain::modes(rods, {.count = 3}, revchain::methods::all);
///     m.method;                      // "condensed": 60 times as fast as bisection
///
/// `modes` without methods finds every mode of every chain, to the same accuracy, by bisection. That takes about as
/// long for up to 30 links. `explain` tells which methods would be faster for a chain, and by how much.
/// Programs that link `revchain::compiled` have all methods in `modes` itself.
namespace revchain::inline REVCHAIN_BUILD {

namespace methods {
/// All methods: `modes` takes the one that is expected to be the cheapest. A program compiles the methods it names.
inline constexpr auto all = std::tuple_cat(within_tolerance, many_modes, long_chains);
}  // namespace methods

/// The modes chosen by `options`, by the cheapest of `methods` and bisection: `methods::many_modes`,
/// `methods::long_chains`, `methods::within_tolerance`, or `methods::all`.
/// Accuracy: each method keeps the bounds of `modes`; its error bound says what was reached. Chains of scalars other
/// than double and float are solved by bisection. Throws InvalidArgument as `modes` does, and for a
/// `ModesOptions::method` that is not among `methods`.
template <Real T, class... Models>
[[nodiscard]] Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options,
                             const std::tuple<Models...>& methods);

}  // namespace revchain

#include "revchain/questions/methods.hpp"
