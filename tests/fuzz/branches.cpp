// SPDX-License-Identifier: GPL-3.0-or-later
// Random calls of branches, diagrams and their windows.
#include "revchain/branches.hpp"
#include "fuzz.hpp"
#include "revchain/stability_windows.hpp"

void fuzz::branches(Random& random) {
    const Chain<double> hung = random.chain(5);
    const Index mode = random.count(hung.mode_count());
    const double height = random.number() * (random.one_in(2) ? 0.1 : 1) * hung.total_length();
    const std::uint64_t kind = random.below(3);
    if (kind == 0) {
        const revchain::DiagramOptions options{
            .min_conical_height = height, .lists = 2, .budget = 3000, .proof_budget = 3000};
        (void)revchain::branches(hung, options, revchain::thorough);
    } else if (kind == 1) {
        const auto found = revchain::branch(hung, {.mode = mode, .min_conical_height = height, .max_points = 40});
        for (const auto& window : revchain::stability_windows(hung, found, {.tolerance = 1e-3, .samples = 1}))
            fuzz::expect_number(window.height_from + window.height_to);
    } else {
        revchain::OnBranchOptions given{.mode = mode};
        std::optional<double> revchain::OnBranchOptions::*const what =
            random.pick({&revchain::OnBranchOptions::conical_height, &revchain::OnBranchOptions::tip_inclination,
                         &revchain::OnBranchOptions::tip_radius, &revchain::OnBranchOptions::top_tension});
        given.*what = random.number();
        (void)revchain::steady_shape(hung, given);
    }
}
