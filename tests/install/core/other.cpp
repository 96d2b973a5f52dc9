// SPDX-License-Identifier: MPL-2.0
#include <revchain/revchain.hpp>
#include <vector>

double slowest_height_of_rods(int count) {
    std::vector<revchain::Link<double>> links(static_cast<std::size_t>(count),
                                              revchain::uniform_rod<double>(1.0 / count, 1.0 / count));
    return revchain::modes(revchain::Chain<double>(links), {.count = 1}).conical_height[0];
}
