// SPDX-License-Identifier: MPL-2.0
// Three unlike links: their whirl speeds, each with its error bound.
#include <revchain/revchain.hpp>

#include <cstdio>
#include <vector>

int main() {
    const std::vector<revchain::Link<double>> links = {
        // lowest first
        revchain::plummet<double>(1.0, 0.5),  // weight, length
        revchain::uniform_rod<double>(2.0, 0.3),
        revchain::compound_pendulum<double>(
            {.weight = 3.0, .length = 1.0, .centroid = -0.05, .radius_of_gyration = 0.4})};
    const revchain::Chain<double> chain(links);
    const auto modes = revchain::modes(chain, {.count = 3});
    const auto speed = modes.angular_speed(9.80665);
    for (revchain::Index k = 0; k < modes.size(); ++k)
        std::printf("mode %td: %.15g rad/s, conical height %.15g within %.1e, %td nodes\n", k + 1, speed[k],
                    modes.conical_height[k], modes.error_bound[k], modes.nodes()[static_cast<std::size_t>(k)].size());
    return modes.status == revchain::Status::success ? 0 : 1;
}
