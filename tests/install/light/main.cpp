// SPDX-License-Identifier: MPL-2.0
// That the headers are found and go together; what they compute is for the quick start, in ../core.
#include <cstdio>
#include <revchain/revchain.hpp>

int main() {
    const revchain::Chain<double> chain({revchain::plummet<double>(1.0, 0.5), revchain::plummet<double>(3.0, 0.5)});
    const auto heights = revchain::two_plummets(1.0, 0.5, 3.0, 0.5);
    std::printf("%lld links, heights %.15g and %.15g\n", static_cast<long long>(chain.size()), heights[0], heights[1]);
    return heights[0] == 0.75 && heights[1] == 0.25 ? 0 : 1;
}
