// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <tuple>

#include "revchain/models/for_modes.hpp"
#include "revchain/modes.hpp"

/// Methods of `modes` that are faster for many modes, for long chains and for loose tolerances.
///
///     const auto rods = revchain::Chain<double>::uniform_rods(100'000, 0.36);
///     const auto m = revchain::modes(rods, {.count = 3}, revchain::methods::all);
///     m.method;                      // "condensed"
///
/// `modes` without them uses bisection, to the same accuracy. `explain` lists what each method
/// would cost for a chain. `modes` has all of them in programs that link `revchain::compiled`.
namespace revchain::inline REVCHAIN_BUILD {

/// Lists of methods. A program compiles the methods that it names.
namespace methods {
/// Closed forms, zeros of Bessel functions and coarse chains: cheaper where a tolerance is given.
inline constexpr std::tuple<models::ClosedForms, models::EqualPlummets, models::ContinuousChain,
                            models::TaperedChain, models::CoarseChain>
    within_tolerance{};
/// All modes of a small chain at once, and many modes of a long one.
inline constexpr std::tuple<models::Aberth, models::Interpolated> many_modes{};
/// A few of the slowest modes of a chain of 256 links or more.
inline constexpr std::tuple<models::Condensed> long_chains{};
/// All of the above.
inline constexpr auto all = std::tuple_cat(within_tolerance, many_modes, long_chains);
}  // namespace methods

/// Finds the modes chosen by `options`, by the cheapest method, among `methods` and bisection,
/// whose error bound is at most `rtol`. `methods` is a list above, or a tuple of your own models
/// (docs/howto/model.md). Accuracy: as `modes`. Bounds are proved by counts; with `rtol`, some are
/// derived and measured to hold, and `certify` proves them. Cost: all modes of 1000 links take 16
/// ms instead of 54, with AVX-512 7 either way; `explain` predicts it. Scalars other than double
/// and float use bisection. Throws InvalidArgument as `modes`, and in double and float if modes are
/// to be found by an `options.method` that is neither automatic, bisection nor in `methods`.
template <Real T, class... Models>
[[nodiscard]] Modes<T> modes(const Chain<T>& chain, const ModesOptions<T>& options,
                             const std::tuple<Models...>& methods);

}  // namespace revchain

#include "revchain/questions/methods.hpp"
