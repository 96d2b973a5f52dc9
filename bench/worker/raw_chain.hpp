// SPDX-License-Identifier: MPL-2.0
// What every method starts from: the weights as a plain array. Lengths are 1 and stay one number, so that memory is not
// the limit. Weights fit into a float.
#pragma once

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/chains.hpp"

namespace bench {

struct RawChain {
    bool rods = false;  ///< else plummets
    std::vector<double> weight;

    std::size_t size() const { return weight.size(); }
};

/// A equal plummets, B equal rods, C random plummets, R random rods (weights uniform in [1/2, 2]), D and E plummets of
/// weights graded 1 ... 1e12 upward and downward (E: heavy tip). `seed` tells the random ones apart; of the others the
/// weights are multiplied by 1 + seed/64, which changes no height but makes every call a new chain.
inline RawChain make_raw(char kind, std::size_t size, unsigned seed) {
    RawChain chain{kind == 'B' || kind == 'R', std::vector<double>(size)};
    support::Random random(1000003ULL * seed + size);
    const auto n = static_cast<revchain::Index>(size);
    for (std::size_t m = 0; m < size; ++m) {
        const auto i = static_cast<revchain::Index>(m);
        double w = 1;
        if (kind == 'C' || kind == 'R') {
            w = random.between(0.5, 2);
        } else {
            if (kind == 'D') w = support::graded(i, n, 1e12);
            if (kind == 'E') w = support::graded(n - 1 - i, n, 1e12);
            if (!(kind >= 'A' && kind <= 'E')) throw std::invalid_argument(std::string("no such kind: ") + kind);
            w = static_cast<float>(w) * (1 + (seed % 64) / 64.0);
        }
        chain.weight[m] = static_cast<float>(w);
    }
    return chain;
}

}  // namespace bench
