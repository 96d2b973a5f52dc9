// SPDX-License-Identifier: GPL-3.0-or-later
#include "revchain/held.hpp"
#include "fuzz.hpp"
#include "revchain/finite/cord/continuous_chain.hpp"
#include "revchain/finite/held/cord.hpp"
#include "revchain/finite/held/taut.hpp"
#include "revchain/stability.hpp"

void fuzz::held(Random& random) {
    const std::uint64_t kind = random.below(5);
    const double height = random.number(), tension = random.number();
    const int waves = 1 + static_cast<int>(random.below(3));
    if (kind == 0) {
        (void)revchain::held_cord_shapes(1.0 + random.number(), random.number(), height, random.number(), {waves});
    } else if (kind == 1) {
        (void)revchain::held_cord_shapes_under_tension(random.number(), tension, height, random.number(), {waves});
    } else if (kind == 2) {
        const revchain::ContinuousChain chain{random.number(), random.one_in(2) ? 0 : random.number(), nullptr};
        (void)revchain::continuous_critical_heights(chain, random.count(5));
        (void)revchain::continuous_shapes(chain, std::max(height, 0.03 * chain.length));
    } else {
        const Chain<double> hung = random.chain(8);
        if (kind == 3) (void)revchain::taut_modes(hung, tension, random.count(4));
        const double span = hung.total_length() * random.between(0.01, 1.01);
        const auto found = random.one_in(2) ? revchain::held_shapes(hung, span, height, {waves})
                                            : revchain::held_shapes_under_tension(hung, tension, height, {waves});
        for (const revchain::HeldShape& shape : found.shapes) {
            fuzz::expect_number(shape.inclination.sum());
            fuzz::expect_number(shape.error_bound);
            (void)revchain::stability(hung, shape);
        }
    }
}
