// SPDX-License-Identifier: MPL-2.0
#pragma once

// What libc++ 13, that of emscripten 3.1.6, lacks of C++20. The build includes it before everything else.
#include <bit>

#if !defined(__cpp_lib_bit_cast)
namespace std {
template <class To, class From>
[[gnu::always_inline]] constexpr To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From));
    return __builtin_bit_cast(To, from);
}
}  // namespace std
#endif
