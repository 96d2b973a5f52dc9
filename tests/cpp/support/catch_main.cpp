// SPDX-License-Identifier: MPL-2.0
// main() of the test programs where the library of Catch2 does not fit: from the single header of Catch2 2.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
