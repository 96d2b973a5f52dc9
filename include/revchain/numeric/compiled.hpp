// SPDX-License-Identifier: MPL-2.0
#pragma once

/// A public function is declared in its public header and defined in a folder, which the public header includes at its
/// end. With REVCHAIN_COMPILED, which the CMake target revchain::compiled sets, the public header does not include it:
/// that library holds the definitions. REVCHAIN_INLINE marks the definitions of functions that are not templates.
#if defined(REVCHAIN_COMPILED)
#define REVCHAIN_INLINE
#else
#define REVCHAIN_INLINE inline
#endif

/// REVCHAIN_COMPILED_ANALYTIC does the same for functions that need GSL. Only the Python module and the tests define
/// it: no library with these functions is installed.
#if defined(REVCHAIN_COMPILED_ANALYTIC)
#define REVCHAIN_INLINE_ANALYTIC
#else
#define REVCHAIN_INLINE_ANALYTIC inline
#endif
