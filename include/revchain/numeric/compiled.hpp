// SPDX-License-Identifier: MPL-2.0
#pragma once

/// A public header declares a function and, at its end, includes the folder that defines it; with
/// REVCHAIN_COMPILED (set by the CMake target revchain::compiled, whose library has the
/// definitions) it does not. REVCHAIN_INLINE marks definitions of functions that are not templates.
#if defined(REVCHAIN_COMPILED)
#define REVCHAIN_INLINE
#else
#define REVCHAIN_INLINE inline
#endif

/// REVCHAIN_INLINE_ANALYTIC marks definitions of functions that need GSL. Only the Python module and
/// the tests define REVCHAIN_COMPILED_ANALYTIC: no library with these functions is installed.
#if defined(REVCHAIN_COMPILED_ANALYTIC)
#define REVCHAIN_INLINE_ANALYTIC
#else
#define REVCHAIN_INLINE_ANALYTIC inline
#endif
