// SPDX-License-Identifier: MPL-2.0
// Error of every conical height against quadruple precision, and the bound reported with it, for the chains of the
// tests, as CSV: chain, N, modes computed (N > 3000: the 10 slowest) and measured, worst error and worst bound in ulp
// (2^-52). About a minute and a half. Argument: the largest N.
#include <cstdio>
#include <cstdlib>

#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

namespace {

using revchain::Index;
using support::Quad;

}  // namespace

int main(int argc, char** argv) {
    const Index largest = argc > 1 ? std::atol(argv[1]) : 100'000;
    std::printf("chain,N,modes,measured,worst_error_ulp,worst_bound_ulp\n");
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 10, 100, 1000, 3000, 100'000}) {
            if (n > largest) continue;
            const auto chain = family.make(n);
            const Index count = n > 3000 ? 10 : chain.mode_count();
            const auto m = revchain::modes(chain, {.count = count}, revchain::methods::all);
            const support::Truth truth(chain);
            const Index step = n == 1000 ? 17 : n == 3000 ? 101 : n > 3000 ? 3 : 1;
            double worst = 0;
            Index measured = 0;
            for (Index j = 0; j < m.size(); j += step, ++measured) {
                const Quad h = m.conical_height[j];
                // 1000 times the bound to start from: the truth may well lie outside it
                const Quad reach = 1000 * Quad(m.error_bound[j]);
                const Quad exact = truth.height(j, h * (1 - reach), h * (1 + reach), 1e-19);
                worst = std::max(worst, support::error_in_ulp(m.conical_height[j], exact));
            }
            std::printf("\"%s\",%ld,%ld,%ld,%.3f,%.3f\n", family.name.c_str(), static_cast<long>(n),
                        static_cast<long>(count), static_cast<long>(measured), worst,
                        m.error_bound.maxCoeff() / revchain::epsilon<double>());
            std::fflush(stdout);
        }
    }
}
