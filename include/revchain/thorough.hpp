// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include "revchain/numeric/compiler.hpp"

/// The last argument `thorough` asks a question with all that the library can do. Without it
/// programs compile in less than half the time.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
///     const auto found = revchain::steady_shapes(chain, {.angular_speed = 9.0, .hanging_only = false},
///                                                revchain::thorough);
///     found.shapes.size();                     // 3, one of them with both links hanging
///
/// `steady_shapes` and `branches` then also take links that stand or may hang at several
/// inclinations, `branches` proves that no branch is missing, and `stability` computes with twice
/// the digits where a double does not decide. In programs that link `revchain::compiled` all
/// questions are thorough. The headers of these questions include this one.
namespace revchain::inline REVCHAIN_BUILD {

/// The type of `thorough`.
struct Thorough {
    explicit constexpr Thorough() = default;
};
/// Given as the last argument, it asks for all means.
inline constexpr Thorough thorough{};

namespace detail {
/// The means of a question that was not given `thorough`.
#if defined(REVCHAIN_COMPILED)
using UsualMeans = Thorough;
#else
struct UsualMeans {};
#endif
template <class Means>
inline constexpr bool is_thorough = std::is_same_v<Means, Thorough>;
}  // namespace detail

}  // namespace revchain
