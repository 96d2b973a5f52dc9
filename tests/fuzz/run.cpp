// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a case, with a limit of its time, and says what it got and from which number it can be made again.
#include <ctime>

#include "fuzz.hpp"
#include "revchain/numeric/progress.hpp"

namespace {

std::clock_t started;  // processor time: other programs on the machine do not count

void end_hung_calls() {
    if (double(std::clock() - started) > fuzz::longest_call * CLOCKS_PER_SEC)
        throw std::runtime_error("the call took too long");
}

}  // namespace

std::string fuzz::run(std::uint64_t number, Random random) {
    constexpr void (*cases[])(Random&) = {linear, rigs, shapes, branches, held, analytic};
    random.wild = number / std::size(cases) % 2 == 0;
    started = std::clock();
    revchain::detail::interrupt = &end_hung_calls;
    try {
        cases[number % std::size(cases)](random);
    } catch (const revchain::InvalidArgument& error) {
        return error.what();
    }
    return {};
}
