// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>

#include "revchain/numeric/dispatch.hpp"
#include "revchain/numeric/word.hpp"
#include "revchain/simd/registers.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // packs are never passed to functions: see below

namespace revchain::inline REVCHAIN_BUILD {

/// The default number of lanes of a pack: four doubles fill one register of AVX2, or two of SSE2.
inline constexpr std::size_t pack_size = 4;

/// Numbers on which + - * / act one by one, in `Count` SIMD registers of `Width` numbers, or in an
/// array if the compiler has no vector types. No lane depends on others: choices are masks. The
/// compiled processor determines how packs are passed by value. So every function that does so is
/// always_inline, and none is called between different processors. There is no memcpy: GCC 12
/// copies by 16 bytes whatever the registers, and failed store forwarding costs a factor of four.
template <std::floating_point T, std::size_t Width = pack_size, std::size_t Count = 1>
struct Pack {
    using Integer = detail::IntegerLike<T>;
    using Natural = std::make_unsigned_t<Integer>;
    using RegisterOf = detail::RegisterOf<T, Width>;
    using Register = typename RegisterOf::Numbers;
    using Integers = typename RegisterOf::Integers;
    using Naturals = typename RegisterOf::Naturals;
    static constexpr std::size_t size = Width * Count;
    static constexpr std::size_t width = RegisterOf::width, count = size / width;
    static_assert(alignof(Register) == width * sizeof(T) && alignof(Integers) == alignof(Register));

    Register part[count]{};

    /// An integer for each number of a pack. As a truth value it has all bits set (true) or none.
    struct Mask {
        Integers part[count]{};

        [[gnu::always_inline]] Mask() = default;
        [[gnu::always_inline]] Mask(Integer x) {  // NOLINT(google-explicit-constructor)
            *this = each<Mask>([&](auto& r, std::size_t) { r = Integers{} + x; });
        }
        [[gnu::always_inline]] Integer operator[](std::size_t lane) const {
            return RegisterOf::get(part[lane / width], lane % width);
        }
        [[gnu::always_inline]] Mask& operator+=(const Mask& x) { return *this = *this + x; }
    };

    [[gnu::always_inline]] Pack() = default;
    [[gnu::always_inline]] Pack(const T& x) {  // NOLINT(google-explicit-constructor)
        *this = each([&](auto& r, std::size_t) { RegisterOf::fill(r, x); });
    }
    [[gnu::always_inline]] Pack(const T& a, const T& b, const T& c,
                                const T& d) requires(size == 4 && Count == 1) {
        if constexpr (count == 1)
            part[0] = Register{a, b, c, d};
        else
            set(0, a), set(1, b), set(2, c), set(3, d);
    }

    [[gnu::always_inline]] static Pack load(const T* from) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            r = reinterpret_cast<const typename RegisterOf::InMemory*>(from)[i];
        });
    }
    [[gnu::always_inline]] void store(T* to) const {
        each([&](auto&, std::size_t i) REVCHAIN_INLINED {
            reinterpret_cast<typename RegisterOf::InMemory*>(to)[i] = part[i];
        });
    }

    /// Returns the numbers, not fused with other operations: `detail::rounded`.
    [[gnu::always_inline]] Pack rounded() const {
        return each([&](auto& r, std::size_t i)
                        REVCHAIN_INLINED { RegisterOf::copy_unfused(r, part[i]); });
    }

    [[gnu::always_inline]] T operator[](std::size_t lane) const {
        return RegisterOf::get(part[lane / width], lane % width);
    }
    [[gnu::always_inline]] void set(std::size_t lane, const T& x) {
        RegisterOf::set(part[lane / width], lane % width, x);
    }

    [[gnu::always_inline]] friend Pack operator+(const Pack& x, const Pack& y) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED { r = x.part[i] + y.part[i]; });
    }
    [[gnu::always_inline]] friend Pack operator-(const Pack& x, const Pack& y) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED { r = x.part[i] - y.part[i]; });
    }
    [[gnu::always_inline]] friend Pack operator*(const Pack& x, const Pack& y) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED { r = x.part[i] * y.part[i]; });
    }
    [[gnu::always_inline]] friend Pack operator/(const Pack& x, const Pack& y) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED { r = x.part[i] / y.part[i]; });
    }
    [[gnu::always_inline]] friend Pack operator-(const Pack& x) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED { r = -x.part[i]; });
    }
    [[gnu::always_inline]] Pack& operator+=(const Pack& x) { return *this = *this + x; }
    [[gnu::always_inline]] Pack& operator-=(const Pack& x) { return *this = *this - x; }
    [[gnu::always_inline]] Pack& operator*=(const Pack& x) { return *this = *this * x; }

    [[gnu::always_inline]] friend Mask operator<(const Pack& x, const Pack& y) {
        return each<Mask>([&](auto& r, std::size_t i)
                              REVCHAIN_INLINED { RegisterOf::less(r, x.part[i], y.part[i]); });
    }
    [[gnu::always_inline]] friend Mask equal(const Pack& x, const Pack& y) {
        return each<Mask>([&](auto& r, std::size_t i)
                              REVCHAIN_INLINED { RegisterOf::equal(r, x.part[i], y.part[i]); });
    }
    [[gnu::always_inline]] friend Mask operator>(const Pack& x, const Pack& y) { return y < x; }

    // These operators act on bits as well as integers. They wrap, which signed integers must not
    // do.
    [[gnu::always_inline]] friend Mask operator+(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            r = Integers(Naturals(x.part[i]) + Naturals(y.part[i]));
        });
    }
    [[gnu::always_inline]] friend Mask operator-(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            r = Integers(Naturals(x.part[i]) - Naturals(y.part[i]));
        });
    }
    [[gnu::always_inline]] friend Mask operator&(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i)
                              REVCHAIN_INLINED { r = x.part[i] & y.part[i]; });
    }
    [[gnu::always_inline]] friend Mask operator|(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i)
                              REVCHAIN_INLINED { r = x.part[i] | y.part[i]; });
    }
    [[gnu::always_inline]] friend Mask operator~(const Mask& x) {
        return each<Mask>([&](auto& r, std::size_t i) REVCHAIN_INLINED { r = ~x.part[i]; });
    }
    [[gnu::always_inline]] friend Mask operator==(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i)
                              REVCHAIN_INLINED { RegisterOf::equal(r, x.part[i], y.part[i]); });
    }
    [[gnu::always_inline]] friend Mask operator>(const Mask& x, const Mask& y) {
        return each<Mask>([&](auto& r, std::size_t i)
                              REVCHAIN_INLINED { RegisterOf::greater(r, x.part[i], y.part[i]); });
    }
    /// Returns true if some truth value is true or, for integers, if one is negative.
    [[gnu::always_inline]] friend bool any(const Mask& x) {
        Integers together = x.part[0];
        each<Mask>([&](auto&, std::size_t i) REVCHAIN_INLINED { together |= x.part[i]; });
        Integer found = 0;
        for (std::size_t i = 0; i < width; ++i) found |= RegisterOf::get(together, i);
        return found < 0;
    }

    [[gnu::always_inline]] friend Pack select(const Mask& yes, const Pack& a, const Pack& b) {
        return each([&](auto& r, std::size_t i)
                        REVCHAIN_INLINED { r = yes.part[i] ? a.part[i] : b.part[i]; });
    }
    /// Returns a where x < y, else b (also for a NaN).
    [[gnu::always_inline]] friend Pack if_less(const Pack& x, const Pack& y, const Pack& a,
                                               const Pack& b) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            RegisterOf::if_less(r, x.part[i], y.part[i], a.part[i], b.part[i]);
        });
    }
    [[gnu::always_inline]] friend Pack if_equal(const Pack& x, const Pack& y, const Pack& a,
                                                const Pack& b) {
        return select(equal(x, y), a, b);
    }
    [[gnu::always_inline]] friend Pack max(const Pack& x, const Pack& y) {
        return if_less(y, x, x, y);
    }
    [[gnu::always_inline]] friend Pack min(const Pack& x, const Pack& y) {
        return if_less(x, y, x, y);
    }

    /// Returns x y - p with one rounding; only if the processor supports it.
    [[gnu::always_inline]] friend Pack multiply_subtract(const Pack& x, const Pack& y,
                                                         const Pack& p) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            RegisterOf::multiply_subtract(r, x.part[i], y.part[i], p.part[i]);
        });
    }
    [[gnu::always_inline]] friend Pack root(const Pack& x) {
        return each([&](auto& r, std::size_t i)
                        REVCHAIN_INLINED { RegisterOf::root(r, x.part[i]); });
    }
    [[gnu::always_inline]] friend Pack abs(const Pack& x) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            r = REVCHAIN_BITS_AS(Register, REVCHAIN_BITS_AS(Integers, x.part[i]) &
                                               std::numeric_limits<Integer>::max());
        });
    }
    /// Returns the nearest number with the leading half of the digits; the rest has at most as
    /// many. Adding to the bits carries into the exponent, as rounding up to a power of two needs.
    [[gnu::always_inline]] friend Pack upper_half(const Pack& x) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            constexpr int cut = (std::numeric_limits<T>::digits + 1) / 2;
            const auto half_up =
                REVCHAIN_BITS_AS(Naturals, x.part[i]) + (Naturals{} + (Natural(1) << (cut - 1)));
            r = REVCHAIN_BITS_AS(Register, half_up & (Naturals{} + (~Natural(0) << cut)));
        });
    }
    /// Returns 1 where the signs differ (zeros have signs), else 0.
    [[gnu::always_inline]] friend Mask differ_in_sign(const Pack& x, const Pack& y) {
        return each<Mask>([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            const auto differ =
                REVCHAIN_BITS_AS(Naturals, x.part[i]) ^ REVCHAIN_BITS_AS(Naturals, y.part[i]);
            r = REVCHAIN_BITS_AS(Integers, differ >> (8 * sizeof(T) - 1));
        });
    }
    /// Returns the bits as an integer, which has the same order for positive numbers.
    [[gnu::always_inline]] friend Mask bits(const Pack& x) {
        return each<Mask>([&](auto& r, std::size_t i)
                              REVCHAIN_INLINED { r = REVCHAIN_BITS_AS(Integers, x.part[i]); });
    }
    /// These return e and 2^-e, exact, for 2^e <= x < 2^(e+1). Precondition: x > 0; 2^-e normal.
    [[gnu::always_inline]] friend Mask exponent(const Pack& x) {
        return each<Mask>([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            r = REVCHAIN_BITS_AS(Integers, REVCHAIN_BITS_AS(Naturals, x.part[i]) >> fraction_bits) -
                bias;
        });
    }
    [[gnu::always_inline]] friend Pack inverse_power(const Pack& x) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            const auto power =
                REVCHAIN_BITS_AS(Integers, x.part[i]) & ((2 * bias + 1) << fraction_bits);
            r = REVCHAIN_BITS_AS(Register, ((2 * bias) << fraction_bits) - power);
        });
    }
    /// Returns 1/sqrt(x) within 4 per cent, by halving the exponent. Precondition: x normal, or 0.
    [[gnu::always_inline]] friend Pack rough_inverse_root(const Pack& x) requires(sizeof(T) == 8) {
        return each([&](auto& r, std::size_t i) REVCHAIN_INLINED {
            r = REVCHAIN_BITS_AS(
                Register, 0x5fe6eb50c7b537a9ULL - (REVCHAIN_BITS_AS(Naturals, x.part[i]) >> 1));
        });
    }

   private:
    static constexpr int fraction_bits = std::numeric_limits<T>::digits - 1;
    static constexpr Integer bias = std::numeric_limits<T>::max_exponent - 1;

    /// Calls f for every register of a result, unrolled even if compilers do not (GCC at -O2).
    template <class Result = Pack, class F>
    [[gnu::always_inline]] static Result each(const F& f) {
        Result r;
        if constexpr (count == 1) {
            f(r.part[0], 0);
        } else {
            [&]<std::size_t... i>(std::index_sequence<i...>) REVCHAIN_INLINED {
                (f(r.part[i], i), ...);
            }
            (std::make_index_sequence<count>{});
        }
        return r;
    }
};

namespace detail {
template <class T, std::size_t Width, std::size_t Count>
struct LaneOf<Pack<T, Width, Count>> {
    using type = T;
};
}  // namespace detail

}  // namespace revchain

#pragma GCC diagnostic pop
