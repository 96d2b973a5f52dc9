// SPDX-License-Identifier: MPL-2.0
#pragma once

// Numbers in messages without streams, whose locales would be a tenth of the page.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "revchain/numeric/status.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

template <>
inline std::string in_digits(const double& value) {
    char text[32];
    for (int digits = 6; digits <= 17; ++digits) {
        std::snprintf(text, sizeof text, "%.*g", digits, value);
        if (std::strtod(text, nullptr) == value) break;
    }
    return text;
}
template <>
inline std::string in_digits(const int& value) {
    return std::to_string(value);
}
template <>
inline std::string in_digits(const Index& value) {
    return std::to_string(value);
}
template <>
inline std::string in_digits(const std::size_t& value) {
    return std::to_string(value);
}

}  // namespace revchain::detail
