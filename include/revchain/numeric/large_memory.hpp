// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Tells the system that new memory will all be written. From 4 MB on Linux then uses pages of 2
/// MB, if it can. Pages of 4 kB for a million numbers take longer than copying the numbers.
inline void will_be_filled([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::uintptr_t page = 4096;
    if (bytes < 4'000'000) return;
    const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
    const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // a hint that may fail
#endif
}

}  // namespace revchain::detail
