// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz.hpp"

/// For libFuzzer: the first byte chooses the case, the others are its random numbers. An exception ends the program.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 0) (void)fuzz::run(data[0], fuzz::Random(fuzz::Bits(std::span(data + 1, size - 1))));
    return 0;
}
