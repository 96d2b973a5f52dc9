// SPDX-License-Identifier: MPL-2.0
// Forced response: nanoseconds for each link and speed, all pins or the free end alone, the largest bound, how many
// speeds were resonances, and the largest error of some speeds against quadruple precision (upward recurrence).
#include <quadmath.h>

#include <cstdio>
#include <string>

#include "revchain/response.hpp"
#include "support/chains.hpp"
#include "timing.hpp"

namespace {

using revchain::Chain;
using revchain::Index;

/// Offset of the free end over that of the support, Greenhill (1908) section 8 (21) from below: moments about each pin.
__float128 free_end(const Chain<double>& chain, __float128 height) {
    __float128 y = 1, pull = 0, below = 0;  // pull: weights times offsets
    for (Index m = 0; m < chain.size(); ++m) {
        const auto link = chain.link(m);
        const __float128 W = link.weight, a = link.length, h = link.centroid;
        const __float128 p = h / a, turn = __float128(link.gyration_ratio.high) + link.gyration_ratio.low;
        const __float128 stiffness = height * (W * p + below) / a, cross = W * (p * (1 - p) - turn);
        const __float128 lower = W * (p * p + turn);
        const __float128 above = (pull * -1 + (stiffness - lower) * y) / (stiffness + cross);
        pull += W * (p * y + (1 - p) * above);
        y = above, below += W;
    }
    return 1 / y;
}

void report(const std::string& name, const Chain<double>& chain, Index speeds, bool all) {
    std::vector<double> heights;
    support::Random random(3);
    for (Index i = 0; i < speeds; ++i) heights.push_back(random.log_between(1e-3, 1.0) * chain.total_length());
    revchain::ResponseOptions options{.conical_height = heights};
    if (!all) options.pins = std::vector<Index>{0};
    std::vector<double> times;
    revchain::Response found;
    for (int i = 0; i < 3; ++i) {
        const double start = bench::cpu_seconds();
        found = revchain::response(chain, options);
        times.push_back(bench::cpu_seconds() - start);
    }
    double bound = 0, error = 0;
    Index resonances = 0;
    for (Index i = 0; i < speeds; ++i) {
        if (found.resonant[static_cast<std::size_t>(i)] != 0) {
            ++resonances;
            continue;
        }
        bound = std::max(bound, found.error_bound[i]);
        if (i % 10 != 0) continue;
        const __float128 exact = free_end(chain, heights[static_cast<std::size_t>(i)]);
        error = std::max(error, static_cast<double>(fabsq(found.offset(i, 0) / exact - 1)));
    }
    const double seconds = bench::median(times);
    std::printf("%s,%td,%td,%s,%.3f,%.2f,%.3g,%.3g,%td\n", name.c_str(), chain.size(), speeds, all ? "all" : "free end",
                seconds, 1e9 * seconds / static_cast<double>(chain.size()) / static_cast<double>(speeds), bound, error,
                resonances);
}

}  // namespace

int main() {
    std::printf(
        "chain,links,speeds,pins,seconds,ns per link and speed,largest bound,error of the free end,resonances\n");
    for (const bool all : {true, false}) {
        for (const auto& [size, speeds] : {std::pair<Index, Index>{10, 100000}, {1000, 1000}, {10000, 1000}}) {
            report("plummets", Chain<double>::uniform_plummets(size), speeds, all);
            report("rods", Chain<double>::uniform_rods(size), speeds, all);
        }
        report("random weights and lengths", support::families()[6].make(1000), 1000, all);
    }
}
