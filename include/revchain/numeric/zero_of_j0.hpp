// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "revchain/numeric/scalar.hpp"
#include "revchain/numeric/status.hpp"

namespace revchain {

/// j_{0,k}, the k-th positive zero of the Bessel function J_0, k >= 1: the speeds of a chain of infinitely many links.
/// Greenhill (1908) §4 (10). The first 19 from a table, the others by McMahon's expansion, DLMF 10.21.19, four
/// corrections.
/// Accuracy: 1 ulp, measured against 40 digits for k up to 1e6 (tests/cpp/special/bessel_zero.cpp). Cost: 3 ns.
/// Throws InvalidArgument for k < 1.
inline double zero_of_j0(Index k) {
    constexpr std::array<double, 19> first{
        2.404825557695773,  5.520078110286311,  8.653727912911013,  11.791534439014281, 14.930917708487787,
        18.071063967910924, 21.21163662987926,  24.352471530749302, 27.493479132040253, 30.634606468431976,
        33.77582021357357,  36.917098353664045, 40.05842576462824,  43.19979171317673,  46.341188371661815,
        49.482609897397815, 52.624051841115,    55.76551075501998,  58.90698392608094,
    };
    if (k < 1) detail::throw_invalid("zero_of_j0", "the zeros are numbered from 1", k);
    if (k <= static_cast<Index>(first.size())) return first[static_cast<std::size_t>(k) - 1];
    // beta = (k - 1/4) pi with pi in two words: the product alone would cost half an ulp more
    constexpr double pi_low = 1.2246467991473532e-16;
    const double turns = static_cast<double>(k) - 0.25, beta = turns * std::numbers::pi;
    const double low = std::fma(turns, std::numbers::pi, -beta) + turns * pi_low;
    const double e = 1 / (8 * beta), e2 = e * e;
    return beta + (low + e * (1 - e2 * (124.0 / 3 - e2 * (120928.0 / 15 - e2 * (401743168.0 / 105)))));
}

}  // namespace revchain
