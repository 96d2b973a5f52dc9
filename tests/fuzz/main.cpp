// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>

#include "fuzz.hpp"
#include "revchain/numeric/progress.hpp"

namespace {

using Clock = std::chrono::steady_clock;
Clock::time_point started;
constexpr double longest_call = 60;  // seconds, under sanitizers

double seconds_since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

struct Hung : std::runtime_error {
    using std::runtime_error::runtime_error;
};

void end_hung_calls() {
    if (seconds_since(started) > longest_call) throw Hung("the call took too long");
}

}  // namespace

/// fuzz SECONDS [FIRST_SEED [COUNT]]: one case for each seed; a failure tells the seed, which repeats it with COUNT 1.
int main(int count, char** words) {
    const double seconds = count > 1 ? std::atof(words[1]) : 10;
    const std::uint64_t first = count > 2 ? std::strtoull(words[2], nullptr, 10) : 1;
    const std::uint64_t most = count > 3 ? std::strtoull(words[3], nullptr, 10) : ~std::uint64_t(0);
    const bool one = most == 1;
    revchain::detail::interrupt = &end_hung_calls;
    void (*const cases[])(fuzz::Random&) = {fuzz::linear,   fuzz::rigs, fuzz::shapes,
                                            fuzz::branches, fuzz::held, fuzz::analytic};
    const Clock::time_point begin = Clock::now();
    std::uint64_t seed = first, refused = 0;
    int failures = 0;
    for (; seed - first < most && seconds_since(begin) < seconds; ++seed) {
        fuzz::Random random(seed);
        random.wild = seed % 2 == 0;
        started = Clock::now();
        if (one) std::cout << "case " << seed % std::size(cases) << '\n';
        std::cout << seed << '\r' << std::flush;  // sanitizers end the program: the last seed is the one
        try {
            cases[seed % std::size(cases)](random);
        } catch (const revchain::InvalidArgument& error) {
            ++refused;
            if (one) std::cout << error.what() << '\n';
        } catch (const std::exception& error) {
            std::cout << "seed " << seed << ": " << error.what() << std::endl;
            ++failures;
        }
        if (seconds_since(started) > longest_call / 4)
            std::cout << "seed " << seed << " took " << seconds_since(started) << " s" << std::endl;
    }
    std::cout << seed - first << " cases, " << refused << " refused, " << failures << " failures\n";
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
