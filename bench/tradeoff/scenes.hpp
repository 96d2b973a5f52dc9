// SPDX-License-Identifier: MPL-2.0
// The chains on which bench_tradeoff compares models.
#pragma once

#include "support/chains.hpp"

namespace bench {

/// Chains that models find easy, and those that they do not. Lengths are of the order of 1.
inline std::vector<support::Family> tradeoff_families() {
    using revchain::Chain;
    using revchain::Index;
    using support::chain_of;
    using support::graded;
    const auto unlike = [](bool rods) {
        return [rods](Index n) {
            support::Random random(rods ? 12 : 11);
            return chain_of(n, [&](Index) {
                const double weight = random.between(0.5, 2), length = random.between(0.5, 2);
                return rods ? revchain::uniform_rod(weight, length) : revchain::plummet(weight, length);
            });
        };
    };
    return {
        {"equal plummets", [](Index n) { return Chain<double>::uniform_plummets(n); }},
        {"equal rods", [](Index n) { return Chain<double>::uniform_rods(n); }},
        {"random plummets", unlike(false)},
        {"random rods", unlike(true)},
        {"light tip",
         [](Index n) { return chain_of(n, [n](Index m) { return revchain::plummet(graded(m, n, 1e12), 1.0); }); }},
        {"heavy tip",
         [](Index n) {
             return chain_of(n, [n](Index m) { return revchain::uniform_rod(graded(n - 1 - m, n, 1e12), 1.0); });
         }},
        {"tapered rods", [](Index n) { return Chain<double>::tapered(n, 1.0, 1.0); }},
    };
}

}  // namespace bench
