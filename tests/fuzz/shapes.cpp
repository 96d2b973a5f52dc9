// SPDX-License-Identifier: GPL-3.0-or-later
// Random calls of closed forms and of steady shapes of chains.
#include "fuzz.hpp"
#include "revchain/stability.hpp"
#include "revchain/statics.hpp"
#include "revchain/steady_shapes.hpp"
#include "revchain/two_links.hpp"

void fuzz::shapes(Random& random) {
    if (random.one_in(6)) {
        const revchain::CompoundLink<double> link{random.number(), random.number()};
        (void)revchain::two_plummets(random.number(), random.number(), random.number(), random.number());
        (void)revchain::two_plummets_shapes(random.number(), random.number(), random.number(), random.number(),
                                            random.number());
        (void)revchain::link_on_thread(random.number(), link), (void)revchain::standing_link(random.number(), link);
        return;
    }
    const Chain<double> hung = random.chain(4);
    const double height = random.number() * hung.total_length();
    const revchain::SteadyShapesOptions options{
        .conical_height = height, .budget = 5000, .hanging_only = random.one_in(2)};
    const auto found = revchain::steady_shapes(hung, options, revchain::thorough);
    for (const revchain::SteadyShape& shape : found.shapes) {
        expect_number(shape.inclination.sum());
        expect_number(shape.error_bound);
        if (random.one_in(3)) (void)revchain::stability(hung, shape, revchain::thorough);
        if (random.one_in(3)) (void)revchain::force_diagram(hung, shape);
    }
}
