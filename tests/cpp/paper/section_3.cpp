// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §3: any number of plummets. No numbered equation; the construction is one.
#include "paper.hpp"

using paper::Index;
using paper::Quad;

TEST_CASE("§3: the thread above P_m is parallel to GK, G the centre of gravity of P_m and all below",
          "[paper][section_3]") {
    paper::Random random(300);
    double worst = 0;
    for (Index size = 1; size <= 12; ++size) {
        std::vector<revchain::Link<double>> links;
        for (Index m = 0; m < size; ++m) {
            const double weight = random.log_between(0.1, 10.0);
            links.push_back(revchain::plummet<double>(weight, random.log_between(0.3, 3.0)));
        }
        const revchain::Chain<double> chain(links);
        const auto modes = revchain::modes(chain, {.count = revchain::all_modes});
        REQUIRE(modes.size() == size);
        for (Index k = 0; k < size; ++k) {
            const auto y = paper::offsets(modes, k);
            Quad weight = 0, moment = 0;  // W_1 + ... + W_m, sum W_r y
            for (Index m = 1; m <= size; ++m) {
                const auto link = chain.link(m - 1);
                const std::size_t pin = static_cast<std::size_t>(m);
                weight += link.weight;
                moment += link.weight * y[pin - 1];
                const Quad pull = modes.conical_height[k] * weight / link.length;
                const Quad left = pull * (y[pin - 1] - y[pin]) - moment;
                const Quad coefficients = 2 * pull + weight;
                worst = std::max(worst, static_cast<double>(fabsq(left) / coefficients) / revchain::epsilon<double>());
            }
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 0.25);  // ulp of the largest offset; measured 0.19
}
