// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <revchain/analytic.hpp>
#include <revchain/revchain.hpp>

int main() {
    const auto heights = revchain::analytic::heavy_chain::conical_heights(3, 1.0);
    std::printf("continuous chain of length 1: height %.15g\n", heights[0]);
    const double first_zero = 2.404825557695773;  // of J0
#if defined(REVCHAIN_COMPILED_ANALYTIC)
    const revchain::Cord cord(1.0);
    const auto modes = revchain::modes(cord, {.count = 3});
    const auto shapes = revchain::steady_shapes(cord, {.conical_height = 0.5});
    if (std::abs(modes.conical_height[0] / heights[0] - 1) > 1e-15 || shapes.shapes.size() != 1) return 2;
#endif
    return std::abs(heights[0] * first_zero * first_zero / 4 - 1) < 1e-15 ? 0 : 1;
}
