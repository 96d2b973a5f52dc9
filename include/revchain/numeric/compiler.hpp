// SPDX-License-Identifier: MPL-2.0
#pragma once

// Compiler extensions that the library uses, and replacements for compilers without them. (Unknown pragmas and
// attributes with a namespace, such as [[gnu::always_inline]], are standard: compilers ignore them.)

/// Define REVCHAIN_NO_VECTOR_EXTENSIONS, for a whole program, to make packs of plain arrays instead of the vector types
/// of GCC and Clang (simd/registers.hpp). Compilers without those types get arrays anyway.
#if !defined(__GNUC__) && !defined(REVCHAIN_NO_VECTOR_EXTENSIONS)
#define REVCHAIN_NO_VECTOR_EXTENSIONS
#endif

/// Stands before the body of a lambda that is always inlined. C++20 has no place for an attribute there.
#if defined(__GNUC__)
#define REVCHAIN_INLINED __attribute__((always_inline))
#else
#define REVCHAIN_INLINED
#endif

namespace revchain::detail {

/// x itself. The compiler must not fuse the operation that computed x with the one that uses it. Error-free
/// transformations need this: GCC fuses a product with every sum that uses it, also across functions that it inlines
/// into one compiled for a processor with fused operations. Clang fuses within one expression, and under
/// -ffp-contract=fast only a product that is used once; the transformations use each argument more than once. Other
/// compilers must not fuse across statements: MSVC does so only under /fp:contract or /fp:fast.
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
