// SPDX-License-Identifier: MPL-2.0
#pragma once

// What libc++ 13, that of emscripten 3.1.6, lacks of C++20. The build includes it before everything else.
#include <bit>
#include <cstddef>
#include <memory>
#include <type_traits>

#if !defined(__cpp_lib_bit_cast)
namespace std {
template <class To, class From>
[[gnu::always_inline]] constexpr To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From));
    return __builtin_bit_cast(To, from);
}
}  // namespace std
#endif

#if !defined(__cpp_lib_smart_ptr_for_overwrite)
namespace std {
template <class Array>
requires is_unbounded_array_v<Array> unique_ptr<Array> make_unique_for_overwrite(size_t size) {
    return unique_ptr<Array>(new remove_extent_t<Array>[size]);
}
}  // namespace std
#endif
