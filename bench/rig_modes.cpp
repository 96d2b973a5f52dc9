// SPDX-License-Identifier: MPL-2.0
// What the whirl speeds of a chain of gyrostats cost, beside those of the chain alone, as CSV: N, modes asked of each
// sense, CPU microseconds per link and mode with shapes and without, the same of the chain's `modes`, the worst bound of a
// speed in ulp. Medians of 5 rounds; half a minute.
#include <cstdio>

#include "revchain/rig_modes.hpp"
#include "support/chains.hpp"
#include "timing.hpp"

int main() {
    using revchain::Index;
    std::printf("links,modes,rig_us,rig_values_us,chain_us,worst_bound_ulp\n");
    for (const Index n : {10, 100, 1000, 10'000}) {
        support::Random random(91);
        const auto chain = support::families()[3].make(n);
        revchain::Rigging with;
        for (Index m = 0; m < n; ++m) with.flywheels.push_back({random.between(-1, 1), 0});
        const revchain::Rig rig(chain, with);
        const Index count = std::min<Index>(n, 20);
        std::vector<double> shapes, values, plain;
        double worst = 0;
        for (int round = 0; round < 5; ++round) {
            const double start = bench::cpu_seconds();
            const auto m = revchain::modes(rig, {.count = count});
            const double middle = bench::cpu_seconds();
            const auto v = revchain::modes(rig, {.count = count});
            const double end = bench::cpu_seconds();
            const auto c = revchain::modes(chain, {.count = count, .method = revchain::ModesMethod::bisection});
            const double last = bench::cpu_seconds();
            const double each = 1e6 / static_cast<double>(n * count);
            shapes.push_back((middle - start) * each / 2), values.push_back((end - middle) * each / 2);
            plain.push_back((last - end) * each);
            for (const auto* sense : {&m.forward, &v.backward})
                worst = std::max(worst, sense->speed_error_bound.maxCoeff() / revchain::epsilon<double>());
            if (c.size() != count) return 1;
        }
        std::printf("%ld,%ld,%.3f,%.3f,%.3f,%.2f\n", static_cast<long>(n), static_cast<long>(count),
                    bench::median(shapes), bench::median(values), bench::median(plain), worst);
    }
}
