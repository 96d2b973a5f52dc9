// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstdlib>
#include <string_view>

namespace support {

/// How many cases a test tries: few in the quick tier, `./test`, which sets REVCHAIN_TIER, and all of them otherwise.
inline int by_tier(int few, int many) {
    const char* tier = std::getenv("REVCHAIN_TIER");
    return tier != nullptr && std::string_view(tier) == "quick" ? few : many;
}

}  // namespace support
