// SPDX-License-Identifier: MPL-2.0
// Wall time of one thread over that of several, medians of interleaved runs, as CSV. Arguments: number of threads (2;
// 0 for all processors), repetitions (9). Run it on an idle machine.
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "revchain/batch.hpp"
#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "revchain/response.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/chains.hpp"
#include "timing.hpp"

namespace {

using revchain::Chain;
using revchain::Index;

template <class F>
double wall_seconds(const F& call) {
    const auto start = std::chrono::steady_clock::now();
    call();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// `solve(threads)` answers one question.
template <class Solve>
void report(const char* question, Index threads, int repetitions, const Solve& solve) {
    std::vector<double> one, several;
    for (int i = 0; i < repetitions; ++i) {
        one.push_back(wall_seconds([&] { solve(1); }));
        several.push_back(wall_seconds([&] { solve(threads); }));
    }
    const double alone = bench::median(one), shared = bench::median(several);
    std::printf("%s,%.4g,%.4g,%.2f\n", question, 1e3 * alone, 1e3 * shared, alone / shared);
}

}  // namespace

int main(int argc, char** argv) {
    const Index threads = argc > 1 ? std::atol(argv[1]) : 2;
    const int repetitions = argc > 2 ? std::atoi(argv[2]) : 9;
    support::Random random(1);
    const auto numbers = [&](std::size_t count) {
        std::vector<double> result(count);
        for (double& x : result) x = random.log_between(0.5, 2);
        return result;
    };
    const auto plummets = [&](Index size) {
        std::vector<revchain::Link<double>> links;
        for (const double weight : numbers(static_cast<std::size_t>(size)))
            links.push_back(revchain::plummet(weight, 1.0));
        return Chain<double>(links);
    };
    std::printf("question,ms by one thread,ms by %td,ratio\n", threads);

    const auto many = plummets(3000);
    report("all heights of 3000 plummets", threads, repetitions, [&](Index t) {
        (void)revchain::modes(many, {.count = revchain::all_modes, .threads = t}, revchain::methods::all);
    });
    report("100 heights of 3000 plummets by bisection", threads, repetitions, [&](Index t) {
        (void)revchain::modes(many, {.count = 100, .threads = t, .method = revchain::ModesMethod::bisection});
    });
    const auto modes_of_many = [&](Index t) {
        return revchain::modes(many, {.count = 100, .threads = t}, revchain::methods::all);
    };
    const revchain::Modes<double> found[]{modes_of_many(1), modes_of_many(threads)};
    report("shapes of 100 modes of 3000 plummets", threads, repetitions,
           [&](Index t) { revchain::detail::ShapesBehind::of(found[t == 1 ? 0 : 1]).some(0, 100, false, nullptr); });
    const auto weights = numbers(1'000'000), lengths = numbers(1'000'000);
    const revchain::ChainBatch<double> batch{
        .chains = 100'000, .size = 10, .weight = {weights.data(), 10, 1}, .length = {lengths.data(), 10, 1}};
    report("all heights of 100000 chains of 10 plummets", threads, repetitions,
           [&](Index t) { (void)revchain::conical_heights(batch, {.threads = t}); });
    const auto hundred = plummets(100);
    std::vector<double> heights(10'000);
    for (double& x : heights) x = random.log_between(0.1, 100);
    report("response of 100 plummets at 10000 speeds", threads, repetitions,
           [&](Index t) { (void)revchain::response(hundred, {.conical_height = heights, .threads = t}); });
    const auto ten = Chain<double>::uniform_plummets(10, 10.0);
    report("steady shapes of 10 plummets at a/lambda = 50", threads, repetitions,
           [&](Index t) { (void)revchain::steady_shapes(ten, {.conical_height = 0.02, .threads = t}); });
}
