// SPDX-License-Identifier: GPL-3.0-or-later
// Random calls of modes and what is computed from them, for chains.
#include "fuzz.hpp"
#include "revchain/batch.hpp"
#include "revchain/buffer.hpp"
#include "revchain/count.hpp"
#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "revchain/response.hpp"
#include "revchain/sensitivity.hpp"
#include "revchain/swing.hpp"
#include "revchain/tune.hpp"

namespace {

void modes(fuzz::Random& random, const revchain::Chain<double>& chain) {
    revchain::ModesOptions<double> options;
    if (chain.size() > 100 || random.one_in(2)) options.first = random.count(3), options.count = random.count(4);
    if (chain.size() <= 100 && random.one_in(4)) options = {.conical_height = {{random.number(), random.number()}}};
    if (random.one_in(4)) options.rtol = random.power(12) * 1e-8;
    options.certify = random.one_in(3);
    using revchain::ModesMethod;
    options.method = random.pick({ModesMethod::automatic, ModesMethod::bisection, ModesMethod::condensed,
                                  ModesMethod::aberth, ModesMethod::interpolated});
    const auto found = revchain::modes(chain, options, revchain::methods::all);
    for (revchain::Index j = 0; j < found.size(); ++j)
        fuzz::expect_number(found.conical_height[j] + found.error_bound[j]);
    if (random.one_in(3)) (void)revchain::sensitivity(chain, found);
}

}  // namespace

void fuzz::linear(Random& random) {
    const std::uint64_t kind = random.below(6);
    if (kind == 0) {
        const revchain::BufferImpact impact(
            {random.number(), random.number(), random.number(), random.number(), random.number()});
        (void)impact(random.number());
        return;
    }
    const Chain<double> hung = random.chain(random.one_in(10) ? 3000 : 12);
    if (kind == 1) {
        const revchain::ModeCounter<double> counter(hung);
        (void)counter.above_height(random.number()), (void)counter.below_speed(random.number(), random.number());
    } else if (kind == 2) {
        (void)revchain::response(hung, {.conical_height = random.numbers(5), .support_radius = random.number()});
    } else if (kind == 3) {
        const auto datum = static_cast<revchain::Datum>(random.below(revchain::datum_names.size()));
        (void)revchain::tune(hung, {.mode = random.count(3),
                                    .link = random.count(hung.size()),
                                    .datum = datum,
                                    .conical_height = random.number()});
    } else if (kind == 4 && hung.size() < 20) {
        const auto column = [&] {
            const std::vector<double> x = random.numbers(std::size_t(hung.size()));
            return revchain::Vector<double>(Eigen::Map<const revchain::Vector<double>>(x.data(), hung.size()));
        };
        (void)revchain::swing(hung, {.offset = column(), .velocity = column(), .time = random.numbers(3)});
    } else {
        modes(random, hung);
    }
}
