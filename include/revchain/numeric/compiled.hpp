// SPDX-License-Identifier: MPL-2.0
#pragma once

/// A public function is declared in its public header and defined in a folder, which the public header includes at its
/// end. With REVCHAIN_COMPILED, which the CMake target revchain::compiled sets, it does not: the definitions are in
/// that library. REVCHAIN_INLINE marks the definitions of functions that are no templates.
#if defined(REVCHAIN_COMPILED)
#define REVCHAIN_INLINE
#else
#define REVCHAIN_INLINE inline
#endif
