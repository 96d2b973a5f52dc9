// SPDX-License-Identifier: MPL-2.0
// Ask for an accuracy, get the cheapest method that has it: which one serves 100,000 rods, and why.
#include <revchain/explain.hpp>
#include <revchain/methods.hpp>

#include <cstdio>

int main() {
    const auto rods = revchain::Chain<double>::uniform_rods(100'000, 0.36);
    for (const double rtol : {1e-2, 1e-12}) {
        const revchain::ModesOptions<double> options{.count = 3, .rtol = rtol};
        std::printf("rtol %g\n%s", rtol, revchain::explain(rods, {.count = 3, .rtol = rtol}).text().c_str());
        const auto m = revchain::modes(rods, options, revchain::methods::all);
        std::printf("=  %.17g, error below %.1e, by %s\n\n", m.conical_height[0], m.error_bound.maxCoeff(),
                    m.method.c_str());
        if (m.status != revchain::Status::success || !(m.error_bound.maxCoeff() <= rtol)) return 1;
    }
}
