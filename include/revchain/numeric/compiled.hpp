// SPDX-License-Identifier: MPL-2.0
#pragma once

/// Public functions are declared in public headers, which include their definitions at the end.
/// With REVCHAIN_COMPILED (set by the CMake target revchain::compiled) that include is omitted: the
/// functions are ordinary functions, defined in the library. Without it they are templates, so that
/// a program compiles only the functions that it calls. REVCHAIN_DECLARE is written before
/// declarations, REVCHAIN_DEFINE before definitions. REVCHAIN_LAZY makes templates of internal
/// functions in both cases. REVCHAIN_INLINE is written before definitions of members.
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

/// Functions that need GSL have macros of their own, because they are in another library,
/// revchain::compiled_analytic.
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
