// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <revchain/analytic.hpp>
#include <revchain/revchain.hpp>

int main() {
    const auto modes = revchain::modes(revchain::Cord(1.0), {.count = 3});
    std::printf("cord of length 1: height %.15g\n", modes.conical_height[0]);
    const double first_zero = 2.404825557695773;  // of J0
    return std::abs(modes.conical_height[0] * first_zero * first_zero / 4 - 1) < 1e-15 ? 0 : 1;
}
