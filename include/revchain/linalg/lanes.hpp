// SPDX-License-Identifier: MPL-2.0
#pragma once

#if !defined(__GNUC__)
#error "revchain: lanes are compiler vectors of GCC and Clang"
#endif

#include <cstddef>
#include <cstdint>

namespace revchain::linalg {

/// `Count` registers of `Bytes` bytes that hold one double of each of `width` independent problems. What happens in one
/// lane is the same whatever the other lanes hold: arithmetic is element by element, and choices are masks.
///
/// Compiler vectors, no intrinsics. Everything is inlined, and so becomes instructions of whatever processor the caller
/// is compiled for (see lane_spectrum.hpp). No memcpy: GCC 12 copies by 16 bytes whatever the registers, and the store
/// forwarding that then fails costs a factor of four.
template <int Bytes, int Count>
struct Lanes {
    // NOLINTBEGIN(modernize-use-using)
    typedef double Register __attribute__((vector_size(Bytes)));
    typedef std::int64_t Integers __attribute__((vector_size(Bytes)));
    typedef std::uint64_t Naturals __attribute__((vector_size(Bytes)));
    typedef double InMemory __attribute__((vector_size(Bytes), aligned(8), may_alias));
    // NOLINTEND(modernize-use-using)
    static constexpr int count = Count;
    static constexpr int width = Bytes / 8 * Count;

    /// In each lane all bits set (true) or none (false); also a count of them.
    struct Mask {
        using Of = Lanes;
        Integers part[Count];
    };

    Register part[Count];

    Lanes() = default;
    [[gnu::always_inline]] Lanes(double x);  // NOLINT(google-explicit-constructor)
};

namespace detail {
/// f(0), f(1), ...: a loop over registers that is none, also where compilers leave loops alone (GCC at -O2).
template <int Count, class F>
[[gnu::always_inline]] inline void each(const F& f) {
    static_assert(Count == 1 || Count == 2 || Count == 4);
    f(0);
    if constexpr (Count > 1) f(1);
    if constexpr (Count > 2) {
        f(2);
        f(3);
    }
}
}  // namespace detail

template <int B, int C>
inline Lanes<B, C>::Lanes(double x) {
    detail::each<C>([&](int i) __attribute__((always_inline)) { part[i] = Register{} + x; });
}

template <int B, int C>
[[gnu::always_inline]] inline Lanes<B, C> operator+(const Lanes<B, C>& x, const Lanes<B, C>& y) {
    Lanes<B, C> r;
    detail::each<C>([&](int i) __attribute__((always_inline)) { r.part[i] = x.part[i] + y.part[i]; });
    return r;
}

template <int B, int C>
[[gnu::always_inline]] inline Lanes<B, C> operator-(const Lanes<B, C>& x, const Lanes<B, C>& y) {
    Lanes<B, C> r;
    detail::each<C>([&](int i) __attribute__((always_inline)) { r.part[i] = x.part[i] - y.part[i]; });
    return r;
}

template <int B, int C>
[[gnu::always_inline]] inline Lanes<B, C> operator*(const Lanes<B, C>& x, const Lanes<B, C>& y) {
    Lanes<B, C> r;
    detail::each<C>([&](int i) __attribute__((always_inline)) { r.part[i] = x.part[i] * y.part[i]; });
    return r;
}

template <int B, int C>
[[gnu::always_inline]] inline Lanes<B, C> operator/(const Lanes<B, C>& x, const Lanes<B, C>& y) {
    Lanes<B, C> r;
    detail::each<C>([&](int i) __attribute__((always_inline)) { r.part[i] = x.part[i] / y.part[i]; });
    return r;
}

template <int B, int C>
[[gnu::always_inline]] inline Lanes<B, C> operator-(const Lanes<B, C>& x) {
    Lanes<B, C> r;
    detail::each<C>([&](int i) __attribute__((always_inline)) { r.part[i] = -x.part[i]; });
    return r;
}

template <int B, int C>
[[gnu::always_inline]] inline typename Lanes<B, C>::Mask operator<(const Lanes<B, C>& x, const Lanes<B, C>& y) {
    typename Lanes<B, C>::Mask r;
    detail::each<C>([&](int i) __attribute__((always_inline)) { r.part[i] = x.part[i] < y.part[i]; });
    return r;
}

/// x where the mask says so, else y.
template <int B, int C>
[[gnu::always_inline]] inline Lanes<B, C> select(const typename Lanes<B, C>::Mask& mask, const Lanes<B, C>& x,
                                                 const Lanes<B, C>& y) {
    using V = Lanes<B, C>;
    V r;
    detail::each<C>([&](int i) __attribute__((always_inline)) {
        const auto chosen = (mask.part[i] & reinterpret_cast<typename V::Integers>(x.part[i])) |
                            (~mask.part[i] & reinterpret_cast<typename V::Integers>(y.part[i]));
        r.part[i] = reinterpret_cast<typename V::Register>(chosen);
    });
    return r;
}

template <class Mask>
[[gnu::always_inline]] inline Mask both(const Mask& x, const Mask& y) {
    Mask r;
    detail::each<Mask::Of::count>([&](int i) __attribute__((always_inline)) { r.part[i] = x.part[i] & y.part[i]; });
    return r;
}

template <class Mask>
[[gnu::always_inline]] inline bool any(const Mask& mask) {
    auto together = mask.part[0];
    detail::each<Mask::Of::count>([&](int i) __attribute__((always_inline)) { together |= mask.part[i]; });
    std::int64_t found = 0;
    for (std::size_t i = 0; i < sizeof(together) / sizeof(found); ++i) found |= together[i];
    return found != 0;
}

template <int B, int C>
[[gnu::always_inline]] inline Lanes<B, C> abs(const Lanes<B, C>& x) {
    using V = Lanes<B, C>;
    V r;
    detail::each<C>([&](int i) __attribute__((always_inline)) {
        const auto magnitude = reinterpret_cast<typename V::Integers>(x.part[i]) & 0x7fffffffffffffffLL;
        r.part[i] = reinterpret_cast<typename V::Register>(magnitude);
    });
    return r;
}

/// Adds 1 to the count where x and y differ in sign.
template <int B, int C>
[[gnu::always_inline]] inline void count_change(typename Lanes<B, C>::Mask& count, const Lanes<B, C>& x,
                                                const Lanes<B, C>& y) {
    using V = Lanes<B, C>;
    detail::each<C>([&](int i) __attribute__((always_inline)) {
        const auto differ =
            reinterpret_cast<typename V::Naturals>(x.part[i]) ^ reinterpret_cast<typename V::Naturals>(y.part[i]);
        count.part[i] += reinterpret_cast<typename V::Integers>(differ >> 63);
    });
}

/// Where the count is `number`.
template <class Mask>
[[gnu::always_inline]] inline Mask equals(const Mask& count, std::int64_t number) {
    Mask r;
    detail::each<Mask::Of::count>([&](int i) __attribute__((always_inline)) { r.part[i] = count.part[i] == number; });
    return r;
}

/// Where the count is above `number`.
template <class Mask>
[[gnu::always_inline]] inline Mask above(const Mask& count, std::int64_t number) {
    Mask r;
    detail::each<Mask::Of::count>([&](int i) __attribute__((always_inline)) { r.part[i] = count.part[i] > number; });
    return r;
}

/// 2^-e for x = f 2^e, 1 <= f < 2: exact, to bring numbers near 1. Preconditions: x positive and normal.
template <int B, int C>
[[gnu::always_inline]] inline Lanes<B, C> reciprocal_power_of_two(const Lanes<B, C>& x) {
    using V = Lanes<B, C>;
    V power;
    detail::each<C>([&](int i) __attribute__((always_inline)) {
        const auto exponent = reinterpret_cast<typename V::Integers>(x.part[i]) & 0x7ff0000000000000LL;
        power.part[i] = reinterpret_cast<typename V::Register>(exponent);
    });
    return V(1.0) / power;
}

/// Square root to a relative 1e-10: a first guess from the exponent, three Newton steps for 1/sqrt. The built-in one is
/// not vectorised where it has to set errno. Precondition: x >= 0.
template <int B, int C>
[[gnu::always_inline]] inline Lanes<B, C> rough_sqrt(const Lanes<B, C>& x) {
    using V = Lanes<B, C>;
    V r;
    detail::each<C>([&](int i) __attribute__((always_inline)) {
        const auto halved = reinterpret_cast<typename V::Naturals>(x.part[i]) >> 1;
        r.part[i] = reinterpret_cast<typename V::Register>(0x5fe6eb50c7b537a9ULL - halved);
    });
    const V half = x * V(0.5);
    r = r * (V(1.5) - half * r * r);
    r = r * (V(1.5) - half * r * r);
    r = r * (V(1.5) - half * r * r);
    return x * r;
}

template <class V>
[[gnu::always_inline]] inline V load(const double* from) {
    V r;
    detail::each<V::count>([&](int i) __attribute__((always_inline)) {
        r.part[i] = reinterpret_cast<const typename V::InMemory*>(from)[i];
    });
    return r;
}

template <int B, int C>
[[gnu::always_inline]] inline void store(double* to, const Lanes<B, C>& x) {
    detail::each<C>([&](int i) __attribute__((always_inline)) {
        reinterpret_cast<typename Lanes<B, C>::InMemory*>(to)[i] = x.part[i];
    });
}

/// One number a lane, 0 where the mask is false.
template <class Mask>
[[gnu::always_inline]] inline void store_mask(std::int64_t* to, const Mask& mask) {
    for (int i = 0; i < Mask::Of::width; ++i)
        to[i] = mask.part[i / (Mask::Of::width / Mask::Of::count)][i % (Mask::Of::width / Mask::Of::count)];
}

}  // namespace revchain::linalg
