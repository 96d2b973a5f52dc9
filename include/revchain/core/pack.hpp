// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>

/// A function that is compiled for several kinds of processor, the best of which is taken when the program starts: a
/// portable build then runs within 1.2 of one for the machine (without: 3 to 4 times slower). GCC alone has this for
/// templates; elsewhere, and where the build is for AVX2 already, nothing changes.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) && !defined(__AVX2__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define REVCHAIN_SIMD [[gnu::flatten, gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]]
#else
#define REVCHAIN_SIMD
#endif

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // what concerns packs handed to functions: they never are, see below

namespace revchain {

/// How many numbers a pack holds, on every machine: four doubles fill one register of AVX2, two of SSE2.
inline constexpr std::size_t pack_size = 4;

namespace detail {
template <class T>
struct VectorOf {
    typedef T type __attribute__((vector_size(pack_size * sizeof(T))));
};
}  // namespace detail

/// Numbers that + - * / act on one by one, in SIMD registers (a vector type of GCC and clang).
///
/// How a function takes or returns one depends on the processor compiled for: every function that does so by value is
/// always_inline, so that none is called across that border.
template <std::floating_point T>
struct alignas(pack_size * sizeof(T)) Pack {
    using Vector = typename detail::VectorOf<T>::type;
    Vector v{};

    [[gnu::always_inline]] Pack() = default;
    [[gnu::always_inline]] Pack(const Vector& x) : v(x) {}              // NOLINT(google-explicit-constructor)
    [[gnu::always_inline]] Pack(const T& x) : v(Vector{x, x, x, x}) {}  // NOLINT(google-explicit-constructor)
    [[gnu::always_inline]] Pack(const T& a, const T& b, const T& c, const T& d) : v(Vector{a, b, c, d}) {}

    [[gnu::always_inline]] T operator[](std::size_t lane) const { return v[lane]; }
    [[gnu::always_inline]] void set(std::size_t lane, const T& x) { v[lane] = x; }

    [[gnu::always_inline]] friend Pack operator+(const Pack& x, const Pack& y) { return x.v + y.v; }
    [[gnu::always_inline]] friend Pack operator-(const Pack& x, const Pack& y) { return x.v - y.v; }
    [[gnu::always_inline]] friend Pack operator*(const Pack& x, const Pack& y) { return x.v * y.v; }
    [[gnu::always_inline]] friend Pack operator/(const Pack& x, const Pack& y) { return x.v / y.v; }
    [[gnu::always_inline]] friend Pack operator-(const Pack& x) { return -x.v; }
    [[gnu::always_inline]] Pack& operator+=(const Pack& x) { return *this = *this + x; }
    [[gnu::always_inline]] Pack& operator-=(const Pack& x) { return *this = *this - x; }

    /// if_less(x, y, a, b): a where x < y, else b (where one is NaN, too), lane by lane.
    [[gnu::always_inline]] friend Pack if_less(const Pack& x, const Pack& y, const Pack& a, const Pack& b) {
        return x.v < y.v ? a.v : b.v;
    }
    [[gnu::always_inline]] friend Pack if_equal(const Pack& x, const Pack& y, const Pack& a, const Pack& b) {
        return x.v == y.v ? a.v : b.v;
    }
    [[gnu::always_inline]] friend Pack abs(const Pack& x) { return x.v < Vector{} ? -x.v : x.v; }
    [[gnu::always_inline]] friend Pack max(const Pack& x, const Pack& y) { return y.v < x.v ? x.v : y.v; }
    /// Its leading bits, towards 0: half of them.
    [[gnu::always_inline]] friend Pack upper_half(const Pack& x) {
        using Bits = decltype(x.v < x.v);
        Bits keep;
        for (std::size_t i = 0; i < pack_size; ++i) keep[i] = ~0LL << ((std::numeric_limits<T>::digits + 1) / 2);
        return (Vector)((Bits)x.v & keep);  // the same bits, another type
    }
};

namespace detail {
template <class V>
struct LaneOf {
    using type = V;
};
template <class T>
struct LaneOf<Pack<T>> {
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

}  // namespace revchain

#pragma GCC diagnostic pop
