// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <revchain/analytic.hpp>
#include <revchain/revchain.hpp>

int main() {
    const auto heights = revchain::analytic::heavy_chain::conical_heights(3, 1.0);
    std::printf("continuous chain of length 1: height %.15g\n", heights[0]);
    const double first_zero = 2.404825557695773;  // of J0
    return std::abs(heights[0] * first_zero * first_zero / 4 - 1) < 1e-15 ? 0 : 1;
}
