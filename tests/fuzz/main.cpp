// SPDX-License-Identifier: GPL-3.0-or-later
// Runs cases of random numbers, one after the other.
#include <chrono>
#include <cstdlib>
#include <iostream>

#include "fuzz.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

}  // namespace

/// fuzz SECONDS [FIRST_SEED [COUNT]]: one case for each seed; a failure tells the seed, which repeats it with COUNT 1.
int main(int count, char** words) {
    const double seconds = count > 1 ? std::atof(words[1]) : 10;
    const std::uint64_t first = count > 2 ? std::strtoull(words[2], nullptr, 10) : 1;
    const std::uint64_t most = count > 3 ? std::strtoull(words[3], nullptr, 10) : ~std::uint64_t(0);
    const bool one = most == 1;
    const Clock::time_point begin = Clock::now();
    std::uint64_t seed = first, refused = 0;
    int failures = 0;
    for (; seed - first < most && seconds_since(begin) < seconds; ++seed) {
        const Clock::time_point started = Clock::now();
        std::cout << seed << '\r' << std::flush;  // sanitizers end the program: the last seed is the one
        try {
            const std::string message = fuzz::run(seed, fuzz::Random(fuzz::Bits(seed)));
            refused += !message.empty();
            if (one) std::cout << "case " << seed % 12 << ' ' << message << '\n';
        } catch (const std::exception& error) {
            std::cout << "seed " << seed << ": " << error.what() << std::endl;
            ++failures;
        }
        if (seconds_since(started) > fuzz::longest_call / 4)
            std::cout << "seed " << seed << " took " << seconds_since(started) << " s" << std::endl;
    }
    std::cout << seed - first << " cases, " << refused << " refused, " << failures << " failures\n";
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
