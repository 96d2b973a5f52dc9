// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "revchain/numeric/compiler.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // on vectors handed to functions: always inlined, they never are

namespace revchain::detail {

/// Whole numbers as large as T.
template <class T>
using IntegerLike = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;

// What a pack consists of: `width` numbers that the operators act on one by one, and what those do not offer.
#if !defined(REVCHAIN_NO_VECTOR_EXTENSIONS)

/// One register of `Width` numbers: a vector type of GCC and Clang.
template <class T, std::size_t Width>
struct RegisterOf {
    static constexpr std::size_t width = Width;
    // NOLINTBEGIN(modernize-use-using)
    // GCC 12 aligns those of template parameters to 16 bytes unless told, and then takes them for aligned to their
    // size.
    typedef T Numbers __attribute__((vector_size(Width * sizeof(T)), aligned(Width * sizeof(T))));
    typedef T InMemory __attribute__((vector_size(Width * sizeof(T)), aligned(sizeof(T)), may_alias));
    using Integer = IntegerLike<T>;
    using Natural = std::make_unsigned_t<Integer>;
    typedef Integer Integers __attribute__((vector_size(Width * sizeof(T)), aligned(Width * sizeof(T))));
    typedef Natural Naturals __attribute__((vector_size(Width * sizeof(T)), aligned(Width * sizeof(T))));
    // NOLINTEND(modernize-use-using)

    [[gnu::always_inline]] static Numbers everywhere(const T& x) {
#if defined(__clang__)
        return x - Numbers{};
#else
        return __builtin_shuffle(Numbers{x}, Integers{});  // one instruction; of anything else GCC 12 makes eight
#endif
    }
    [[gnu::always_inline]] static T get(const Numbers& x, std::size_t i) { return x[i]; }
    [[gnu::always_inline]] static Integer get(const Integers& x, std::size_t i) { return x[i]; }
    [[gnu::always_inline]] static void set(Numbers& to, std::size_t i, const T& x) { to[i] = x; }
    /// What a comparison returns: all bits set (yes) or none.
    [[gnu::always_inline]] static Integers answer(const Integers& yes) { return yes; }
    [[gnu::always_inline]] static Naturals bits(const Numbers& x) { return reinterpret_cast<Naturals>(x); }
    [[gnu::always_inline]] static Numbers of_bits(const Naturals& x) { return reinterpret_cast<Numbers>(x); }
};

#else

/// One number in place of a register, whatever `Width` is.
template <class T, std::size_t Width>
struct RegisterOf {
    static constexpr std::size_t width = 1;
    using Numbers = T;
    using InMemory = T;
    using Integers = IntegerLike<T>;
    using Naturals = std::make_unsigned_t<Integers>;

    static T everywhere(T x) { return x; }
    static T get(T x, std::size_t) { return x; }
    static Integers get(Integers x, std::size_t) { return x; }
    static void set(T& to, std::size_t, T x) { to = x; }
    static Integers answer(bool yes) { return -Integers(yes); }
    static Naturals bits(T x) { return std::bit_cast<Naturals>(x); }
    static T of_bits(Naturals x) { return std::bit_cast<T>(x); }
};

#endif

}  // namespace revchain::detail

#pragma GCC diagnostic pop
