// SPDX-License-Identifier: MPL-2.0
// Ask for an accuracy, get the cheapest model that has it: who answers for 100,000 rods, and why.
#include <revchain/explain.hpp>
#include <revchain/models/heights.hpp>

#include <cstdio>

int main() {
    const auto rods = revchain::Chain<double>::uniform_rods(100'000, 0.36);
    for (const double rtol : {1e-2, 1e-12}) {
        const revchain::Question question{.first = 1, .count = 3, .rtol = rtol};
        std::printf("rtol %g\n%s", rtol, revchain::explain(select(rods, question)).c_str());
        const revchain::Solution found = solve(rods, question);
        std::printf("=  %.17g, error below %.1e, by %.*s\n\n", found.answer.conical_height[0],
                    found.answer.worst_bound(), static_cast<int>(found.model.size()), found.model.data());
        if (found.status != revchain::Status::success || !(found.answer.worst_bound() <= rtol)) return 1;
    }
}
