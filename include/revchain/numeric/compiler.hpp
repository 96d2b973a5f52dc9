// SPDX-License-Identifier: MPL-2.0
#pragma once

#if defined(__cplusplus) && __cplusplus < 202002L && !(defined(_MSVC_LANG) && _MSVC_LANG >= 202002L)
#error "revchain needs C++20: compile with -std=c++20"
#include "no C++20"  // an error that ends the compilation, before thousands of others
#endif

// Compiler extensions. (Compilers ignore unknown pragmas and attributes with a namespace.)

/// Define REVCHAIN_NO_VECTOR_EXTENSIONS for a whole program to use arrays instead of the vector
/// types of GCC and Clang (simd/registers.hpp). Compilers without those types use arrays anyway.
#if !defined(__GNUC__) && !defined(REVCHAIN_NO_VECTOR_EXTENSIONS)
#define REVCHAIN_NO_VECTOR_EXTENSIONS
#endif

/// Write this before the body of a lambda that is always inlined; C++20 has no attribute for that.
#if defined(__GNUC__)
#define REVCHAIN_INLINED __attribute__((always_inline))
#else
#define REVCHAIN_INLINED
#endif

// Defined if the instruction set is chosen at run time and the flags do not name the largest one.
#if defined(REVCHAIN_DISPATCH) && defined(__x86_64__) && \
    !defined(REVCHAIN_NO_VECTOR_EXTENSIONS) &&           \
    !(defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__))
#define REVCHAIN_SEVERAL_TARGETS
#endif

// REVCHAIN_BUILD is the inline namespace of the whole library. It names the flags of the compiler,
// such as for_avx2_fma or for_sse2_and_above. A linker merges inline functions of one name. Code
// with other flags has other names, so it does not link with a library compiled differently. Flags
// without a macro, such as -ffp-contract, have no effect on the name.
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define REVCHAIN_BUILD_SET avx512
#elif defined(__AVX512F__)
#define REVCHAIN_BUILD_SET avx512f
#elif defined(__AVX2__)
#define REVCHAIN_BUILD_SET avx2
#elif defined(__AVX__)
#define REVCHAIN_BUILD_SET avx
#elif defined(__SSE4_1__)
#define REVCHAIN_BUILD_SET sse4
#elif defined(__x86_64__)
#define REVCHAIN_BUILD_SET sse2
#else
#define REVCHAIN_BUILD_SET any_processor
#endif
#if defined(__FP_FAST_FMA) || defined(__FMA__)
#define REVCHAIN_BUILD_FMA _fma
#else
#define REVCHAIN_BUILD_FMA
#endif
#if defined(REVCHAIN_SEVERAL_TARGETS)
#define REVCHAIN_BUILD_KIND _and_above
#elif defined(REVCHAIN_NO_VECTOR_EXTENSIONS)
#define REVCHAIN_BUILD_KIND _no_vectors
#else
#define REVCHAIN_BUILD_KIND
#endif
// Functions of the library may have more methods than those of the headers.
#if defined(REVCHAIN_COMPILED)
#define REVCHAIN_BUILD_LIBRARY _compiled
#else
#define REVCHAIN_BUILD_LIBRARY
#endif
#define REVCHAIN_JOINED(set, fma, kind, library) for_##set##fma##kind##library
#define REVCHAIN_JOIN(set, fma, kind, library) REVCHAIN_JOINED(set, fma, kind, library)
#define REVCHAIN_BUILD                                                         \
    REVCHAIN_JOIN(REVCHAIN_BUILD_SET, REVCHAIN_BUILD_FMA, REVCHAIN_BUILD_KIND, \
                  REVCHAIN_BUILD_LIBRARY)

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Returns x, which the compiler must not fuse with the operation that computed it: error-free
/// transformations need this. GCC fuses a product with every sum that uses it, also across
/// functions that it inlines. Clang fuses within one expression and, under -ffp-contract=fast, only
/// a product that is used once; the transformations use each argument more often. Other compilers
/// must not fuse across statements: MSVC does so only under /fp:contract or /fp:fast.
template <class T>
[[gnu::always_inline]] constexpr T unfused(const T& x) {
#if defined(__clang__) || !defined(__GNUC__)
    return x;
#elif __has_builtin(__builtin_assoc_barrier)
    return __builtin_assoc_barrier(x);
#else
#error "revchain needs GCC 12 or Clang 14, or later versions"
#endif
}

}  // namespace revchain::detail
