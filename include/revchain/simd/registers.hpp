// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "revchain/numeric/compiler.hpp"

namespace revchain::detail {

/// Whole numbers as large as T.
template <class T>
using IntegerLike = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;

// What a pack consists of: `width` numbers that the operators act on one by one, and what those do not offer. No
// function returns a vector: GCC warns that how it does so depends on the processor.
#if !defined(REVCHAIN_NO_VECTOR_EXTENSIONS)

/// x with the same bits, as another type of the same size.
#define REVCHAIN_BITS_AS(type, x) reinterpret_cast<type>(x)

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

    [[gnu::always_inline]] static void fill(Numbers& to, const T& x) {
#if defined(__clang__)
        to = x - Numbers{};
#else
        to = __builtin_shuffle(Numbers{x}, Integers{});  // one instruction; of anything else GCC 12 makes eight
#endif
    }
    /// `detail::unfused`
    [[gnu::always_inline]] static void copy_unfused(Numbers& to, const Numbers& from) {
#if defined(__clang__)
        to = from;
#else
        to = __builtin_assoc_barrier(from);
#endif
    }
    [[gnu::always_inline]] static T get(const Numbers& x, std::size_t i) { return x[i]; }
    [[gnu::always_inline]] static Integer get(const Integers& x, std::size_t i) { return x[i]; }
    [[gnu::always_inline]] static void set(Numbers& to, std::size_t i, const T& x) { to[i] = x; }
    /// What a comparison returns as a mask: all bits set (yes) or none.
    [[gnu::always_inline]] static void answer(Integers& to, const Integers& yes) { to = yes; }
};

#else

#define REVCHAIN_BITS_AS(type, x) std::bit_cast<type>(x)

/// One number in place of a register, whatever `Width` is.
template <class T, std::size_t Width>
struct RegisterOf {
    static constexpr std::size_t width = 1;
    using Numbers = T;
    using InMemory = T;
    using Integers = IntegerLike<T>;
    using Naturals = std::make_unsigned_t<Integers>;

    static void fill(T& to, T x) { to = x; }
    static void copy_unfused(T& to, T from) { to = unfused(from); }
    static T get(T x, std::size_t) { return x; }
    static Integers get(Integers x, std::size_t) { return x; }
    static void set(T& to, std::size_t, T x) { to = x; }
    static void answer(Integers& to, bool yes) { to = -Integers(yes); }
};

#endif

}  // namespace revchain::detail
