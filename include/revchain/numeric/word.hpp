// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace detail {
/// Specialised for packs in simd/pack.hpp.
template <class V>
struct LaneOf : std::type_identity<V> {};
}  // namespace detail

/// The number type of a pack; for a number, its own type.
template <class V>
using Lane = typename detail::LaneOf<V>::type;

template <class V>
concept IsPack = !std::same_as<V, Lane<V>>;

/// A number, or a pack of numbers, with rounding as in IEEE 754.
template <class V>
concept Word = std::floating_point<V> || IsPack<V>;

/// Returns the nearest number with the leading half of the digits of x.
template <std::floating_point T>
[[gnu::always_inline]] inline T upper_half(const T& x) {
    constexpr int cut = (std::numeric_limits<T>::digits + 1) / 2;
    if constexpr (sizeof(T) <= 8) {
        using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
        return std::bit_cast<T>((std::bit_cast<Bits>(x) + (Bits(1) << (cut - 1))) &
                                (~Bits(0) << cut));
    } else {  // Veltkamp. Processors with a long double of their own do not fuse its operations.
        const T c = static_cast<T>((1ULL << cut) + 1) * x;
        return c - (c - x);
    }
}

namespace detail {

/// Returns x, which the compiler does not fuse with other operations (`unfused`).
template <Word T>
[[gnu::always_inline]] constexpr T rounded(const T& x) {
    if constexpr (IsPack<T>)
        return x.rounded();
    else
        return unfused(x);
}

}  // namespace detail
}  // namespace revchain
