// SPDX-License-Identifier: GPL-3.0-or-later
// Random calls of chains and cords held at both ends.
#include "revchain/held.hpp"
#include "fuzz.hpp"
#include "revchain/cord.hpp"
#include "revchain/stability.hpp"

void fuzz::held(Random& random) {
    const std::uint64_t kind = random.below(5);
    const double height = random.number(), tension = random.number();
    const int waves = 1 + static_cast<int>(random.below(3));
    if (kind == 0) {
        const revchain::Cord cord(1.0 + random.number(), {.weight = random.number()});
        (void)revchain::steady_shapes(revchain::Held(cord, {.span = random.number()}),
                                      {.conical_height = height, .max_half_waves = waves});
    } else if (kind == 1) {
        const revchain::Cord cord(random.number(), {.weight = random.number()});
        (void)revchain::steady_shapes(revchain::Held(cord, {.tension = tension, .weightless = random.one_in(2)}),
                                      {.angular_speed = height, .max_half_waves = waves});
    } else if (kind == 2) {
        const revchain::Cord cord(random.number(), {.tip_weight = random.one_in(2) ? 0 : random.number()});
        (void)revchain::modes(cord, {.count = random.count(5)});
        (void)revchain::finite::critical_heights(revchain::finite::ContinuousChain(cord), random.count(5));
        (void)revchain::count_modes(cord, {.conical_height = std::max(height, 0.03 * cord.length())});
        (void)revchain::steady_shapes(cord, {.conical_height = std::max(height, 0.03 * cord.length())});
    } else {
        const Chain<double> hung = random.chain(8);
        if (kind == 3) (void)revchain::modes(revchain::Held(hung, {.tension = tension})).shapes();
        const double span = hung.total_length() * random.between(0.01, 1.01);
        const revchain::HeldBy by =
            random.one_in(2) ? revchain::HeldBy{.span = span} : revchain::HeldBy{.tension = tension};
        const auto found = revchain::steady_shapes(revchain::Held(hung, by),
                                                   {.conical_height = height, .max_half_waves = waves, .budget = 3000});
        for (const revchain::HeldShape& shape : found.shapes) {
            fuzz::expect_number(shape.inclination.sum());
            fuzz::expect_number(shape.error_bound);
            (void)revchain::stability(hung, shape, revchain::thorough);
        }
    }
}
