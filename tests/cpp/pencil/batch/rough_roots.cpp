// SPDX-License-Identifier: MPL-2.0
// Square roots of packs by guess and Newton's steps, beside the built-in ones: where their error is a wave of the number,
// and at both ends of the range.
#include <cmath>

#include "revchain/pencil/batch/zeros.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

TEST_CASE("rough roots: the guess to 4 per cent, the root to 1e-10", "[linalg]") {
    using V = revchain::Pack<double>;
    support::Random random(11);
    double guess = 0, root = 0;
    const auto look = [&](double x) {
        const double exact = std::sqrt(x);
        guess = std::max(guess, std::abs(rough_inverse_root(V(x))[0] * exact - 1));
        root = std::max(root, std::abs(revchain::pencil::detail::rough_sqrt(V(x))[0] / exact - 1));
    };
    for (int step = 0; step < 30000; ++step) look(1 + step / 1e4);  // a period: 1 to 4
    for (int round = 0; round < 100000; ++round) look(std::exp2(random.between(-1022, 1023.999)));
    for (const double x : {std::numeric_limits<double>::min(), std::numeric_limits<double>::max()}) look(x);
    CAPTURE(guess, root);
    CHECK(guess <= 0.04);
    CHECK(root <= 1e-10);
    CHECK(revchain::pencil::detail::rough_sqrt(V(0.0))[0] == 0);
}
