// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "revchain/numeric/dispatch.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // vectors never leave a translation unit

namespace revchain::inline REVCHAIN_BUILD::detail {

template <class T>
using IntegerLike = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;

// Registers of `width` numbers, and the operations that vector types do not offer. No function
// returns a vector: GCC warns that the way of returning depends on the processor.
#if !defined(REVCHAIN_NO_VECTOR_EXTENSIONS)

// GCC 12 compiles a comparison of 64 bytes, and a fused operation, to one instruction for each
// number. The built-in functions below are one instruction for the whole register. With several
// targets they need optimisation, which inlines them into functions for their target.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#if defined(REVCHAIN_SEVERAL_TARGETS) && defined(__OPTIMIZE__)
#define REVCHAIN_INLINED_INTO_TARGETS
#endif
#if defined(REVCHAIN_INLINED_INTO_TARGETS) || defined(__FMA__)
#define REVCHAIN_FUSED_INSTRUCTIONS
#endif
#if defined(REVCHAIN_INLINED_INTO_TARGETS) || (defined(__AVX512F__) && defined(__AVX512DQ__))
#define REVCHAIN_MASK_INSTRUCTIONS
#endif
#endif

/// Returns x with the same bits, as another type of the same size.
#define REVCHAIN_BITS_AS(type, x) reinterpret_cast<type>(x)

/// One register of `Width` numbers: a vector type of GCC and Clang.
template <class T, std::size_t Width>
struct RegisterOf {
    static constexpr std::size_t width = Width;
    // NOLINTBEGIN(modernize-use-using)
    // GCC 12 aligns vector types of template parameters to 16 bytes unless an attribute says
    // otherwise, and then assumes their natural alignment.
    typedef T Numbers __attribute__((vector_size(Width * sizeof(T)), aligned(Width * sizeof(T))));
    typedef T InMemory
        __attribute__((vector_size(Width * sizeof(T)), aligned(sizeof(T)), may_alias));
    using Integer = IntegerLike<T>;
    using Natural = std::make_unsigned_t<Integer>;
    typedef Integer Integers
        __attribute__((vector_size(Width * sizeof(T)), aligned(Width * sizeof(T))));
    typedef Natural Naturals
        __attribute__((vector_size(Width * sizeof(T)), aligned(Width * sizeof(T))));
    // NOLINTEND(modernize-use-using)

    [[gnu::always_inline]] static void fill(Numbers& to, const T& x) {
#if defined(REVCHAIN_MASK_INSTRUCTIONS)
        if constexpr (has_masks) {
            to = __builtin_ia32_broadcastsd512(Two{x, T(0)}, Numbers{}, all_lanes);
            return;
        }
#endif
#if defined(__clang__)
        to = x - Numbers{};
#else
        to = __builtin_shuffle(Numbers{x}, Integers{});  // one instruction in GCC 12
#endif
    }
    /// Copies as `detail::unfused` does.
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
    [[gnu::always_inline]] static void multiply_subtract(Numbers& to, const Numbers& x,
                                                         const Numbers& y, const Numbers& p) {
#if defined(REVCHAIN_FUSED_INSTRUCTIONS)
        if constexpr (is_double && bytes == 64)
            to = __builtin_ia32_vfmaddpd512_mask(x, y, -p, all_lanes, as_it_is);
        else if constexpr (is_double && bytes == 32)
            to = __builtin_ia32_vfmaddpd256(x, y, -p);
        else
#endif
            for (std::size_t i = 0; i < width; ++i) to[i] = std::fma(x[i], y[i], -p[i]);
    }
    [[gnu::always_inline]] static void root(Numbers& to, const Numbers& x) {
#if defined(REVCHAIN_MASK_INSTRUCTIONS)
        if constexpr (has_masks) {
            to = __builtin_ia32_sqrtpd512_mask(x, Numbers{}, all_lanes, as_it_is);
            return;
        }
#endif
        for (std::size_t i = 0; i < width; ++i) to[i] = std::sqrt(x[i]);
    }
    // Results are truth values: all bits set (true) or none.
    [[gnu::always_inline]] static void less(Integers& to, const Numbers& x, const Numbers& y) {
#if defined(REVCHAIN_MASK_INSTRUCTIONS)
        if constexpr (has_masks)
            from_mask(to, mask_less(x, y));
        else
#endif
            to = x < y;
    }
    [[gnu::always_inline]] static void equal(Integers& to, const Numbers& x, const Numbers& y) {
#if defined(REVCHAIN_MASK_INSTRUCTIONS)
        if constexpr (has_masks)
            from_mask(to, __builtin_ia32_cmppd512_mask(x, y, 0, all_lanes, as_it_is));
        else
#endif
            to = x == y;
    }
    [[gnu::always_inline]] static void equal(Integers& to, const Integers& x, const Integers& y) {
#if defined(REVCHAIN_MASK_INSTRUCTIONS)
        if constexpr (has_masks)
            from_mask(to, __builtin_ia32_pcmpeqq512_mask(REVCHAIN_BITS_AS(Longs, x),
                                                         REVCHAIN_BITS_AS(Longs, y), all_lanes));
        else
#endif
            to = x == y;
    }
    [[gnu::always_inline]] static void greater(Integers& to, const Integers& x, const Integers& y) {
#if defined(REVCHAIN_MASK_INSTRUCTIONS)
        if constexpr (has_masks)
            from_mask(to, __builtin_ia32_pcmpgtq512_mask(REVCHAIN_BITS_AS(Longs, x),
                                                         REVCHAIN_BITS_AS(Longs, y), all_lanes));
        else
#endif
            to = x > y;
    }
    [[gnu::always_inline]] static void if_less(Numbers& to, const Numbers& x, const Numbers& y,
                                               const Numbers& a, const Numbers& b) {
#if defined(REVCHAIN_MASK_INSTRUCTIONS)
        if constexpr (has_masks)
            to = __builtin_ia32_blendmpd_512_mask(b, a, mask_less(x, y));
        else
#endif
            to = x < y ? a : b;
    }

   private:
    static constexpr std::size_t bytes = Width * sizeof(T);
    static constexpr bool is_double = std::is_same_v<T, double>,
                          has_masks = is_double && bytes == 64;
    static constexpr int all_lanes = -1, as_it_is = 4;  // rounding mode
#if defined(REVCHAIN_MASK_INSTRUCTIONS)
    // NOLINTBEGIN(modernize-use-using)
    typedef long long Longs __attribute__((vector_size(64), aligned(64)));
    typedef double Two __attribute__((vector_size(16), aligned(16)));
    // NOLINTEND(modernize-use-using)

    [[gnu::always_inline]] static void from_mask(Integers& to, unsigned char mask) {
        to = REVCHAIN_BITS_AS(Integers, __builtin_ia32_cvtmask2q512(mask));
    }
    [[gnu::always_inline]] static unsigned char mask_less(const Numbers& x, const Numbers& y) {
        constexpr int less_ordered = 1;
        return __builtin_ia32_cmppd512_mask(x, y, less_ordered, all_lanes, as_it_is);
    }
#endif
};

#else

#define REVCHAIN_BITS_AS(type, x) std::bit_cast<type>(x)

/// One number instead of a register, whatever `Width` is.
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
    static void multiply_subtract(T& to, T x, T y, T p) { to = std::fma(x, y, -p); }
    static void root(T& to, T x) { to = std::sqrt(x); }
    static void less(Integers& to, T x, T y) { to = -Integers(x < y); }
    template <class N>
    static void equal(Integers& to, N x, N y) {
        to = -Integers(x == y);
    }
    static void greater(Integers& to, Integers x, Integers y) { to = -Integers(x > y); }
    static void if_less(T& to, T x, T y, T a, T b) { to = x < y ? a : b; }
};

#endif

}  // namespace revchain::detail

#undef REVCHAIN_FUSED_INSTRUCTIONS
#undef REVCHAIN_INLINED_INTO_TARGETS
#pragma GCC diagnostic pop
