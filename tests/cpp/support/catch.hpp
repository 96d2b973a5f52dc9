// SPDX-License-Identifier: MPL-2.0
// One include for Catch2 2 and 3. Use what both have: TEST_CASE, TEMPLATE_TEST_CASE, GENERATE, REQUIRE_THROWS_AS, Approx,
// and from Catch::Matchers WithinAbs, WithinRel, WithinULP, StartsWith, ContainsSubstring.
#pragma once

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;  // as in version 2
#else
#include <catch2/catch.hpp>
namespace Catch::Matchers {
inline auto ContainsSubstring(const std::string& text) { return Contains(text); }  // the name in version 3
}  // namespace Catch::Matchers
#endif

namespace support {
inline const int digits_shown = Catch::StringMaker<double>::precision = 20;  // 1e-13 must not read as 0.0
}
