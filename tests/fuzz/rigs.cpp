// SPDX-License-Identifier: GPL-3.0-or-later
// Random calls of modes, shapes and motions of rigs.
#include "fuzz.hpp"
#include "revchain/response.hpp"
#include "revchain/rig_modes.hpp"
#include "revchain/sensitivity.hpp"
#include "revchain/steady_shapes.hpp"

void fuzz::rigs(Random& random) {
    const std::uint64_t kind = random.below(3);
    const revchain::Rig rig = random.rig(kind == 2 ? 3 : 8);
    if (kind == 0) {
        const auto found = revchain::modes(rig, {.count = revchain::all_modes});
        (void)found;
    } else if (kind == 1) {
        (void)revchain::response(rig, {.conical_height = random.numbers(4)});
        const auto numbers = random.numbers(std::size_t(rig.size()) + 1);
        const Eigen::Map<const revchain::Vector<double>> offset(numbers.data(), rig.size() + 1);
        (void)revchain::sensitivity(rig, random.number(), offset, random.number());
    } else {
        const auto sense = random.one_in(2) ? revchain::Rotation::forward : revchain::Rotation::backward;
        const revchain::RigShapesOptions options{.conical_height = random.number() * rig.chain().total_length(),
                                                 .budget = 3000,
                                                 .hanging_only = random.one_in(2),
                                                 .direction = sense};
        (void)revchain::steady_shapes(rig, options, revchain::thorough);
    }
}
