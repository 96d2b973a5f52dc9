// SPDX-License-Identifier: MPL-2.0
// How fast the whirling shapes of chains of N links tend to those of the uncut chain, at finite amplitude, for ten ways of
// cutting it: largest difference of the pins' offsets over the chain's length, and its observed order, as CSV. The chain is
// ten conical heights long and has two shapes. Some ten seconds.
//
//     bench_shape_convergence [LARGEST N]  > FILE
//     python bench/plot_shape_convergence.py FILE
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "revchain/branches.hpp"
#include "revchain/finite/cord/continuous_chain.hpp"
#include "support/cuttings.hpp"

namespace {

using revchain::Index;
constexpr double ratio = 10;  // length over conical height

/// Of the pins' offsets, over the length of the uncut chain.
double difference(const support::Cutting<double>& cutting, Index count, const revchain::CordShape& uncut) {
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

}  // namespace

int main(int argc, char** argv) {
    const Index largest = argc > 1 ? std::atol(argv[1]) : 5120;
    const auto uncut = revchain::steady_shapes(revchain::Cord(1), {.conical_height = 1 / ratio});
    std::printf("cutting,half_waves,links,difference,order\n");
    for (const auto& cutting : support::cuttings<double>())
        for (const auto& shape : uncut.shapes) {
            double before = 0;
            for (Index count = 5; count <= largest; count *= 2) {
                const double now = difference(cutting, count, shape);
                std::printf("\"%s\",%d,%ld,%.4e,", cutting.name.c_str(), shape.half_waves, static_cast<long>(count),
                            now);
                if (before > 0) std::printf("%.3f", std::log2(before / now));
                std::printf("\n");
                before = now;
            }
        }
}
