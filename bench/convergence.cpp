// SPDX-License-Identifier: MPL-2.0
// How fast chains of N links tend to the uncut chain, for ten ways of cutting it, as CSV.
//
//     bench_convergence [LARGEST N]           relative difference of the conical heights, its proved bound, the law
//     bench_convergence shapes [LARGEST N]    largest difference of the pins' offsets at finite amplitude, over the length
//                                             of a chain ten conical heights long, and its observed order; ten seconds
//     python bench/plot_convergence.py FILE   draws the heights
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "revchain/branches.hpp"
#include "revchain/finite/cord/continuous_chain.hpp"
#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "support/cuttings.hpp"

namespace {

using revchain::Index;
using Cutting = support::Cutting<double>;
constexpr double ratio = 10;  // length over conical height, of the shapes

/// Differences are formed in long double, where the uncut height is good to 1e-19: what they lack is the proved bound of the
/// height alone.
void heights(const Cutting& cutting, Index size) {
    if (size < cutting.smallest) return;
    const auto chain = cutting.make(size);
    const Index count = std::min<Index>(10, chain.mode_count());
    const auto m = revchain::modes(chain, {.count = count}, revchain::methods::all);
    for (const auto& zero : support::bessel_zeros<long double>) {
        if (zero.mode > count) continue;
        const long double M = static_cast<long double>(size) + cutting.excess;
        const long double height = m.conical_height[zero.mode - 1] / M;
        std::printf("\"%s\",\"%s\",%d,%d,%td,%.9g,%.3g,%.9g\n", cutting.name.c_str(), cutting.plain.c_str(),
                    cutting.order, static_cast<int>(zero.mode), size,
                    static_cast<double>(height / support::uncut_height(zero) - 1), m.error_bound[zero.mode - 1],
                    static_cast<double>(cutting.law(static_cast<double>(zero.j), static_cast<double>(zero.J))));
    }
}

/// Returns the largest difference of the pins' offsets, over the length of the uncut chain.
double difference(const Cutting& cutting, Index count, const revchain::CordShape& uncut) {
    const auto chain = cutting.make(count);
    const double length = static_cast<double>(count) + cutting.excess;  // a link is 1 long
    const auto shape = revchain::steady_shape(chain, {.mode = uncut.half_waves, .conical_height = length / ratio});
    double worst = 0, below_support = 0;
    for (Index m = chain.size(); m-- > 0;) {
        below_support += chain.link(m).length;
        const double arc = std::max(0.0, 1 - below_support / length);
        worst = std::max(worst, std::abs(shape.offset[m] / length - uncut(arc).offset));
    }
    return worst;
}

void shapes(const Cutting& cutting, Index largest, const revchain::CordShape& uncut) {
    double before = 0;
    for (Index count = 5; count <= largest; count *= 2) {
        const double now = difference(cutting, count, uncut);
        std::printf("\"%s\",%d,%td,%.4e,", cutting.name.c_str(), uncut.half_waves, count, now);
        if (before > 0) std::printf("%.3f", std::log2(before / now));
        std::printf("\n");
        before = now;
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto cuttings = support::cuttings<double>();
    if (argc > 1 && std::strcmp(argv[1], "shapes") == 0) {
        const Index largest = argc > 2 ? std::atol(argv[2]) : 5120;
        const auto uncut = revchain::steady_shapes(revchain::Cord(1), {.conical_height = 1 / ratio});
        std::printf("cutting,half_waves,links,difference,order\n");
        for (const Cutting& cutting : cuttings)
            for (const auto& shape : uncut.shapes) shapes(cutting, largest, shape);
        return 0;
    }
    const Index largest = argc > 1 ? std::atol(argv[1]) : 100'000;
    std::printf("cutting,description,order,mode,links,difference,error_bound,law_coefficient\n");
    for (const Cutting& cutting : cuttings)
        for (Index decade = 1; decade <= largest; decade *= 10)
            for (const Index step : {1, 2, 5})
                if (step * decade <= largest) heights(cutting, step * decade);
}
