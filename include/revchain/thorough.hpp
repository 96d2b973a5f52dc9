// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include "revchain/numeric/compiler.hpp"

/// The last argument `thorough` makes a function use all methods of the library. Without it
/// programs that ask for steady shapes, branches or stability compile less.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     const auto found = revchain::steady_shapes(chain, {.angular_speed = 9.0, .hanging_only = false},
///                                                revchain::thorough);
///     found.shapes.size();                     // 3, one of them with both links hanging
///
/// `steady_shapes` and `branches` then also take links that stand or may hang at several
/// inclinations. `branches` tries to prove that no branch is missing, and `stability` computes up
/// to 50 links with twice the digits if double is not enough. In programs that link
/// `revchain::compiled` all functions are thorough.
namespace revchain::inline REVCHAIN_BUILD {

/// The type of `thorough`.
struct Thorough {
    explicit constexpr Thorough() = default;
};
/// The last argument that selects all methods.
inline constexpr Thorough thorough{};

namespace detail {
/// The methods of a function that is called without `thorough`.
#if defined(REVCHAIN_COMPILED)
using UsualMeans = Thorough;
#else
struct UsualMeans {};
#endif
template <class Means>
inline constexpr bool is_thorough = std::is_same_v<Means, Thorough>;
}  // namespace detail

}  // namespace revchain
