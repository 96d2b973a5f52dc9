// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cstddef>

#include "revchain/numeric/compiler.hpp"

/// Unrolls short loops for GCC (twice as fast); without optimisation GCC warns about the pragma.
#if defined(__OPTIMIZE__)
#define REVCHAIN_UNROLL _Pragma("GCC unroll 8")
#else
#define REVCHAIN_UNROLL
#endif

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// The transfer of (offset y, force q/mu) across a run of links, from its lower to its upper pin,
/// as polynomials in z = -mu = -1/lambda:
///
///     y' = A y + B q,   q' = C y + D q,
///     A = 1 + a1 z + ...,  B = b1 z + ...,  C = c0 + c1 z + ...,  D = 1 + d1 z + ...,
///
/// with A D - B C = 1. A mass w at a pin adds w y to q. A spring of flexibility f adds z f q to y.
/// No coefficient is negative, so building and merging never cancel. V is a number or a pack.
template <class V, std::size_t Degree>
struct Transfer {
    static constexpr std::size_t degree = Degree;
    std::array<V, Degree> a{};      ///< a1 ... aD
    std::array<V, Degree + 1> b{};  ///< b1 ... b(D+1)
    std::array<V, Degree> c{};      ///< c0 ... c(D-1)
    std::array<V, Degree> d{};      ///< d1 ... dD
};

/// Adds a mass at the upper pin.
template <class V, std::size_t Degree>
inline void append_mass(Transfer<V, Degree>& run, const V& mass) {
    run.c[0] += mass;
    for (std::size_t i = 1; i < Degree; ++i) run.c[i] += mass * run.a[i - 1];
    for (std::size_t i = 0; i < Degree; ++i) run.d[i] += mass * run.b[i];
}

template <class V, std::size_t Degree>
inline void append_spring(Transfer<V, Degree>& run, const V& flexibility) {
    for (std::size_t i = 0; i < Degree; ++i) run.a[i] += flexibility * run.c[i];
    run.b[0] += flexibility;
    for (std::size_t i = 1; i <= Degree; ++i) run.b[i] += flexibility * run.d[i - 1];
}

/// Adds the spring of a link with inertia: flexibility f / (1 + mu cross), `cross` = X f >= 0.
template <class V, std::size_t Degree>
inline void append_spring(Transfer<V, Degree>& run, const V& flexibility, const V& cross) {
    V to_a = flexibility * run.c[0], to_b = flexibility;
    run.a[0] += to_a;
    run.b[0] += to_b;
    for (std::size_t i = 1; i < Degree; ++i) {
        to_a = flexibility * run.c[i] + cross * to_a;
        run.a[i] += to_a;
    }
    for (std::size_t i = 1; i <= Degree; ++i) {
        to_b = flexibility * run.d[i - 1] + cross * to_b;
        run.b[i] += to_b;
    }
}

/// Returns the transfer of `lower` followed by `upper`: the product of the two matrices, truncated
/// at the degree of `lower`. Missing coefficients of `upper` count as 0.
template <class V, std::size_t Degree, std::size_t Upper>
inline Transfer<V, Degree> merged(const Transfer<V, Degree>& lower,
                                  const Transfer<V, Upper>& upper) {
    static_assert(Upper <= Degree);
    Transfer<V, Degree> run = lower;
    REVCHAIN_UNROLL
    for (std::size_t i = 0; i < Degree; ++i) {  // a(i+1), c(i), d(i+1)
        V& a = run.a[i];
        V& c = run.c[i];
        V& d = run.d[i];
        if (i < Upper) {
            a += upper.a[i];
            c += upper.c[i];
            d += upper.d[i];
        }
        REVCHAIN_UNROLL
        for (std::size_t j = 0; j < i && j < Upper; ++j) {
            a += upper.a[j] * lower.a[i - 1 - j];
            c += upper.c[j] * lower.a[i - 1 - j];
            c += upper.d[j] * lower.c[i - 1 - j];
            d += upper.d[j] * lower.d[i - 1 - j];
        }
        REVCHAIN_UNROLL
        for (std::size_t j = 0; j <= i && j <= Upper; ++j) a += upper.b[j] * lower.c[i - j];
        REVCHAIN_UNROLL
        for (std::size_t j = 0; j <= i && j < Upper; ++j) d += upper.c[j] * lower.b[i - j];
    }
    REVCHAIN_UNROLL
    for (std::size_t i = 0; i <= Degree; ++i) {  // b(i+1)
        V& b = run.b[i];
        if (i <= Upper) b += upper.b[i];
        REVCHAIN_UNROLL
        for (std::size_t j = 0; j < i && j <= Upper; ++j) b += upper.b[j] * lower.d[i - 1 - j];
        REVCHAIN_UNROLL
        for (std::size_t j = 0; j < i && j < Upper; ++j) b += upper.a[j] * lower.b[i - 1 - j];
    }
    return run;
}

template <std::size_t To, class V, std::size_t From>
inline Transfer<V, To> extended(const Transfer<V, From>& run) {
    static_assert(From <= To);
    Transfer<V, To> result;
    for (std::size_t i = 0; i < From; ++i) {
        result.a[i] = run.a[i];
        result.c[i] = run.c[i];
        result.d[i] = run.d[i];
    }
    for (std::size_t i = 0; i <= From; ++i) result.b[i] = run.b[i];
    return result;
}

}  // namespace revchain::pencil

#undef REVCHAIN_UNROLL
