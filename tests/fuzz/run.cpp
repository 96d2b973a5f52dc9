// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>

#include "fuzz.hpp"
#include "revchain/numeric/progress.hpp"

namespace {

using Clock = std::chrono::steady_clock;
Clock::time_point latest;

void end_hung_calls() {
    if (Clock::now() > latest) throw std::runtime_error("the call took too long");
}

}  // namespace

std::string fuzz::run(std::uint64_t number, Random random) {
    constexpr void (*cases[])(Random&) = {linear, rigs, shapes, branches, held, analytic};
    random.wild = number / std::size(cases) % 2 == 0;
    latest = Clock::now() + std::chrono::seconds(longest_call);
    revchain::detail::interrupt = &end_hung_calls;
    try {
        cases[number % std::size(cases)](random);
    } catch (const revchain::InvalidArgument& error) {
        return error.what();
    }
    return {};
}
