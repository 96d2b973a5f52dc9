// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include "revchain/simd/dispatch.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // what concerns packs handed to functions: they never are, see below

namespace revchain {

/// How many numbers a pack holds unless told otherwise, on every machine: four doubles fill one register of AVX2, two
/// of SSE2.
inline constexpr std::size_t pack_size = 4;

/// Numbers that + - * / act on one by one, in `Count` SIMD registers of `Width` numbers (vector types of GCC and
/// Clang). What happens to one number is the same whatever the others are: choices are masks.
///
/// How a function takes or returns one depends on the processor compiled for: every function that does so by value is
/// always_inline, so that none is called across that border. No memcpy: GCC 12 copies by 16 bytes whatever the
/// registers, and the store forwarding that then fails costs a factor of four.
template <std::floating_point T, std::size_t Width = pack_size, std::size_t Count = 1>
struct Pack {
    using Integer = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
    // NOLINTBEGIN(modernize-use-using)
    // GCC 12 aligns those of template parameters to 16 bytes unless told, and then takes them for aligned to their
    // size.
    typedef T Register __attribute__((vector_size(Width * sizeof(T)), aligned(Width * sizeof(T))));
    typedef T InMemory __attribute__((vector_size(Width * sizeof(T)), aligned(sizeof(T)), may_alias));
    typedef Integer Integers __attribute__((vector_size(Width * sizeof(T)), aligned(Width * sizeof(T))));
    using Natural = std::make_unsigned_t<Integer>;
    typedef Natural Naturals __attribute__((vector_size(Width * sizeof(T)), aligned(Width * sizeof(T))));
    // NOLINTEND(modernize-use-using)
    static_assert(alignof(Register) == Width * sizeof(T));
    static constexpr std::size_t size = Width * Count;

    Register part[Count]{};

    /// A whole number for each number of a pack. As an answer: all bits set (yes) or none.
    struct Mask {
        static_assert(alignof(Integers) == alignof(Register));
        Integers part[Count]{};

        [[gnu::always_inline]] Mask() = default;
        [[gnu::always_inline]] Mask(Integer x) {  // NOLINT(google-explicit-constructor)
            *this = each<Mask>([&](auto& r, std::size_t) { r = Integers{} + x; });
        }
        [[gnu::always_inline]] Integer operator[](std::size_t lane) const { return part[lane / Width][lane % Width]; }
        [[gnu::always_inline]] Mask& operator+=(const Mask& x) { return *this = *this + x; }
    };

    [[gnu::always_inline]] Pack() = default;
    [[gnu::always_inline]] Pack(const T& x) {  // NOLINT(google-explicit-constructor)
        *this = each([&](auto& r, std::size_t) {
#if defined(__clang__)
            r = x - Register{};
#else
            r = __builtin_shuffle(Register{x}, Integers{});  // one instruction; of anything else GCC 12 makes eight
#endif
        });
    }
    [[gnu::always_inline]] Pack(const T& a, const T& b, const T& c, const T& d) requires(size == 4 && Count == 1)
        : part{Register{a, b, c, d}} {}

    /// From and to `size` numbers in memory.
    [[gnu::always_inline]] static Pack load(const T* from) {
        return each([&](auto& r, std::size_t i)
                        __attribute__((always_inline)) { r = reinterpret_cast<const InMemory*>(from)[i]; });
    }
    [[gnu::always_inline]] void store(T* to) const {
        each([&](auto&, std::size_t i)
                 __attribute__((always_inline)) { reinterpret_cast<InMemory*>(to)[i] = part[i]; });
    }

#if !defined(__clang__)
    /// The numbers themselves, kept from being fused: `detail::rounded`.
    [[gnu::always_inline]] Pack rounded() const {
        return each([&](auto& r, std::size_t i)
                        __attribute__((always_inline)) { r = __builtin_assoc_barrier(part[i]); });
    }
#endif

    [[gnu::always_inline]] T operator[](std::size_t lane) const { return part[lane / Width][lane % Width]; }
    [[gnu::always_inline]] void set(std::size_t lane, const T& x) { part[lane / Width][lane % Width] = x; }

    [[gnu::always_inline]] friend Pack operator+(const Pack& x, const Pack& y) {
        return each([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = x.part[i] + y.part[i]; });
    }
    [[gnu::always_inline]] friend Pack operator-(const Pack& x, const Pack& y) {
        return each([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = x.part[i] - y.part[i]; });
    }
    [[gnu::always_inline]] friend Pack operator*(const Pack& x, const Pack& y) {
        return each([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = x.part[i] * y.part[i]; });
    }
    [[gnu::always_inline]] friend Pack operator/(const Pack& x, const Pack& y) {
        return each([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = x.part[i] / y.part[i]; });
    }
    [[gnu::always_inline]] friend Pack operator-(const Pack& x) {
        return each([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = -x.part[i]; });
    }
    [[gnu::always_inline]] Pack& operator+=(const Pack& x) { return *this = *this + x; }
    [[gnu::always_inline]] Pack& operator-=(const Pack& x) { return *this = *this - x; }
    [[gnu::always_inline]] Pack& operator*=(const Pack& x) { return *this = *this * x; }

    [[gnu::always_inline]] friend Mask operator<(const Pack& x, const Pack& y) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = x.part[i] < y.part[i]; });
    }
    [[gnu::always_inline]] friend Mask equal(const Pack& x, const Pack& y) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = x.part[i] == y.part[i]; });
    }
    [[gnu::always_inline]] friend Mask operator>(const Pack& x, const Pack& y) { return y < x; }

    // Of bits as well as numbers: they wrap, which whole numbers with a sign must not.
    [[gnu::always_inline]] friend Mask operator+(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) {
            r = Integers(Naturals(x.part[i]) + Naturals(y.part[i]));
        });
    }
    [[gnu::always_inline]] friend Mask operator-(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) {
            r = Integers(Naturals(x.part[i]) - Naturals(y.part[i]));
        });
    }
    [[gnu::always_inline]] friend Mask operator&(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = x.part[i] & y.part[i]; });
    }
    [[gnu::always_inline]] friend Mask operator|(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = x.part[i] | y.part[i]; });
    }
    [[gnu::always_inline]] friend Mask operator~(const Mask& x) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = ~x.part[i]; });
    }
    [[gnu::always_inline]] friend Mask operator==(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = x.part[i] == y.part[i]; });
    }
    [[gnu::always_inline]] friend Mask operator>(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) { r = x.part[i] > y.part[i]; });
    }
    /// Whether some answer is yes; of whole numbers, whether one is negative.
    [[gnu::always_inline]] friend bool any(const Mask& x) {
        Integers together = x.part[0];
        each<Mask>([&](auto&, std::size_t i) __attribute__((always_inline)) { together |= x.part[i]; });
        Integer found = 0;
        for (std::size_t i = 0; i < Width; ++i) found |= together[i];
        return found < 0;
    }

    /// a where the answer is yes, else b.
    [[gnu::always_inline]] friend Pack select(const Mask& yes, const Pack& a, const Pack& b) {
        return each([&](auto& r, std::size_t i)
                        __attribute__((always_inline)) { r = yes.part[i] ? a.part[i] : b.part[i]; });
    }
    /// a where x < y, else b (where one is NaN, too).
    [[gnu::always_inline]] friend Pack if_less(const Pack& x, const Pack& y, const Pack& a, const Pack& b) {
        return select(x < y, a, b);
    }
    [[gnu::always_inline]] friend Pack if_equal(const Pack& x, const Pack& y, const Pack& a, const Pack& b) {
        return select(equal(x, y), a, b);
    }
    [[gnu::always_inline]] friend Pack max(const Pack& x, const Pack& y) { return select(y < x, x, y); }
    [[gnu::always_inline]] friend Pack min(const Pack& x, const Pack& y) { return select(x < y, x, y); }

    [[gnu::always_inline]] friend Pack abs(const Pack& x) {
        return each([&](auto& r, std::size_t i) __attribute__((always_inline)) {
            r = reinterpret_cast<Register>(reinterpret_cast<Integers>(x.part[i]) & std::numeric_limits<Integer>::max());
        });
    }
    /// The nearest number with the leading half of the digits; the rest has no more digits than that. Adding to the
    /// bits carries into the exponent, as rounding up to a power of two needs.
    [[gnu::always_inline]] friend Pack upper_half(const Pack& x) {
        return each([&](auto& r, std::size_t i) __attribute__((always_inline)) {
            constexpr int cut = (std::numeric_limits<T>::digits + 1) / 2;
            const auto half_up = reinterpret_cast<Naturals>(x.part[i]) + (Naturals{} + (Natural(1) << (cut - 1)));
            r = reinterpret_cast<Register>(half_up & (Naturals{} + (~Natural(0) << cut)));
        });
    }
    /// 1 where the signs differ (a zero has one), else 0.
    [[gnu::always_inline]] friend Mask differ_in_sign(const Pack& x, const Pack& y) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) {
            const auto differ = reinterpret_cast<Naturals>(x.part[i]) ^ reinterpret_cast<Naturals>(y.part[i]);
            r = reinterpret_cast<Integers>(differ >> (8 * sizeof(T) - 1));
        });
    }
    /// The bits as a whole number: positive numbers are in the same order. Where an answer is no choice but a number of
    /// its own, whole numbers are the faster way: GCC 12 compares packs of 64 bytes number by number.
    [[gnu::always_inline]] friend Mask bits(const Pack& x) {
        return each<Mask>([&](auto& r, std::size_t i)
                              __attribute__((always_inline)) { r = reinterpret_cast<Integers>(x.part[i]); });
    }
    /// e and 2^-e, both exact, for 2^e <= x < 2^(e+1). Precondition: x is positive and normal, and so is 2^-e.
    [[gnu::always_inline]] friend Mask exponent(const Pack& x) {
        return each<Mask>([&](auto& r, std::size_t i) __attribute__((always_inline)) {
            r = reinterpret_cast<Integers>(reinterpret_cast<Naturals>(x.part[i]) >> fraction_bits) - bias;
        });
    }
    [[gnu::always_inline]] friend Pack inverse_power(const Pack& x) {
        return each([&](auto& r, std::size_t i) __attribute__((always_inline)) {
            const auto power = reinterpret_cast<Integers>(x.part[i]) & ((2 * bias + 1) << fraction_bits);
            r = reinterpret_cast<Register>(((2 * bias) << fraction_bits) - power);
        });
    }
    /// About 1/sqrt(x), within 4 per cent: half the exponent, and the rest as it comes. Precondition: x is normal, or
    /// 0.
    [[gnu::always_inline]] friend Pack rough_inverse_root(const Pack& x) requires(sizeof(T) == 8) {
        return each([&](auto& r, std::size_t i) __attribute__((always_inline)) {
            r = reinterpret_cast<Register>(0x5fe6eb50c7b537a9ULL - (reinterpret_cast<Naturals>(x.part[i]) >> 1));
        });
    }

   private:
    static constexpr int fraction_bits = std::numeric_limits<T>::digits - 1;
    static constexpr Integer bias = std::numeric_limits<T>::max_exponent - 1;

    /// f for every register of a result: a loop that is none, also where compilers leave loops alone (GCC at -O2).
    template <class Result = Pack, class F>
    [[gnu::always_inline]] static Result each(const F& f) {
        Result r;
        if constexpr (Count == 1) {
            f(r.part[0], 0);
        } else {
            [&]<std::size_t... i>(std::index_sequence<i...>) __attribute__((always_inline)) { (f(r.part[i], i), ...); }
            (std::make_index_sequence<Count>{});
        }
        return r;
    }
};

namespace detail {
template <class V>
struct LaneOf {
    using type = V;
};
template <class T, std::size_t Width, std::size_t Count>
struct LaneOf<Pack<T, Width, Count>> {
    using type = T;
};
}  // namespace detail

/// The number a pack consists of; a number itself.
template <class V>
using Lane = typename detail::LaneOf<V>::type;

template <class V>
concept IsPack = !std::same_as<V, Lane<V>>;

/// What rounds as IEEE 754 says: a number, or a pack of such.
template <class V>
concept Word = std::floating_point<V> || IsPack<V>;

/// The nearest number with the leading half of the digits of x.
template <std::floating_point T>
[[gnu::always_inline]] inline T upper_half(const T& x) {
    constexpr int cut = (std::numeric_limits<T>::digits + 1) / 2;
    if constexpr (sizeof(T) <= 8) {
        using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
        return std::bit_cast<T>((std::bit_cast<Bits>(x) + (Bits(1) << (cut - 1))) & (~Bits(0) << cut));
    } else {  // Veltkamp. Processors with a long double of their own do not fuse its operations.
        const T c = static_cast<T>((1ULL << cut) + 1) * x;
        return c - (c - x);
    }
}

}  // namespace revchain

#pragma GCC diagnostic pop
