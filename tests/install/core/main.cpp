// SPDX-License-Identifier: MPL-2.0
// The quick start, as a user would type it.
#include <cstdio>
#include <revchain/revchain.hpp>
#include <string>
#include <vector>

double slowest_height_of_rods(int count);  // the second translation unit

int main() {
    std::vector<revchain::Link<double>> links = {
        // lowest first
        revchain::plummet<double>(1.0, 0.5), revchain::uniform_rod<double>(2.0, 0.3),
        revchain::compound_pendulum<double>(
            {.weight = 3.0, .length = 1.0, .centroid = -0.05, .radius_of_gyration = 0.4})};
    revchain::Chain<double> chain(links);
    auto m = revchain::modes(chain, {.count = 3});
    std::printf("height %.15g, error below %.1g, speed %.15g, tip %.15g; rods %.15g\n", m.conical_height[0],
                m.error_bound[0], m.angular_speed(9.80665)[0], m.shape(0)[0], slowest_height_of_rods(10));
#if !defined(REVCHAIN_COMPILED)
    bool refused = false;  // what modes.hpp alone does not have
    try {
        (void)revchain::modes(chain, {.method = revchain::ModesMethod::aberth});
    } catch (const revchain::InvalidArgument& error) {
        refused = std::string(error.what()).find("#include <revchain/methods.hpp>") != std::string::npos;
    }
    if (m.method != "bisection" || !refused) return 2;
#endif
    const auto s = revchain::steady_shapes(chain, {.angular_speed = 6.0});
    if (!s.complete || s.shapes.empty()) return 3;
    // The exact value for many rods is 4 / j01^2 = 0.6917; ten rods are 1 % from it.
    return m.conical_height[0] > m.conical_height[1] && slowest_height_of_rods(10) > 0.68 ? 0 : 1;
}
