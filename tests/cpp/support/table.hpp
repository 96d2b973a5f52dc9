// SPDX-License-Identifier: MPL-2.0
// Tables of expected values: text up to the next comma, the first line names the columns.
#pragma once

#include <quadmath.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace support {

inline std::vector<std::vector<std::string>> table(const std::string& path) {
    std::ifstream file(path);
    std::vector<std::vector<std::string>> rows;
    std::string line, field;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::istringstream fields(line);
        rows.emplace_back();
        while (std::getline(fields, field, ',')) rows.back().push_back(field);
    }
    return rows;
}

inline __float128 quad_of(const std::string& text) { return strtoflt128(text.c_str(), nullptr); }

}  // namespace support
