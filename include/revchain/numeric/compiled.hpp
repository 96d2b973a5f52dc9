// SPDX-License-Identifier: MPL-2.0
#pragma once

/// A public function is declared in its public header and defined in a folder, which the public
/// header includes at its end. With REVCHAIN_COMPILED, which the CMake target revchain::compiled
/// sets, it does not include that: the library holds the definitions. Without, functions that are
/// not templates would be compiled, with all that they call, in every program that includes their
/// header. REVCHAIN_DECLARE and REVCHAIN_DEFINE therefore make templates of them, which are compiled
/// where they are called; REVCHAIN_LAZY does so for the functions behind them. REVCHAIN_INLINE marks
/// the definitions of members.
#if defined(REVCHAIN_COMPILED)
#define REVCHAIN_DECLARE
#define REVCHAIN_DEFINE
#define REVCHAIN_INLINE
#else
#define REVCHAIN_DECLARE template <int = 0>
#define REVCHAIN_DEFINE \
    template <int>      \
    inline
#define REVCHAIN_INLINE inline
#endif
#define REVCHAIN_LAZY  \
    template <int = 0> \
    inline

/// The same for functions that need GSL, whose library is revchain::compiled_analytic.
#if defined(REVCHAIN_COMPILED_ANALYTIC)
#define REVCHAIN_DECLARE_ANALYTIC
#define REVCHAIN_DEFINE_ANALYTIC
#define REVCHAIN_INLINE_ANALYTIC
#else
#define REVCHAIN_DECLARE_ANALYTIC template <int = 0>
#define REVCHAIN_DEFINE_ANALYTIC \
    template <int>               \
    inline
#define REVCHAIN_INLINE_ANALYTIC inline
#endif
