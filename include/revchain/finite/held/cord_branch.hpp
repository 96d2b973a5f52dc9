// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/held/branch.hpp"
#include "revchain/finite/held/cord.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD {

using HeldCordBranch = HeldBranchOf<HeldCordShape>;

namespace finite {

/// Returns the branch of a number of half waves at a span, for heights from `least` up, if any.
REVCHAIN_LAZY
std::optional<HeldCordBranch> held_branch(const Cord& cord, double span, double least,
                                          int half_waves, double max_step) {
    HeldCord held;
    const double length = cord.length();
    const auto first = held.at_height(half_waves, span / length, least / length);
    if (!first) return {};
    HeldCordBranch branch = branch_from(held, *first, max_step, [&](const HeldState& state, bool) {
        return described(state, span, length, cord.weight());
    });
    branch.mode = branch.half_waves = half_waves;
    if (branch.end == HeldBranchEnd::slack) branch.end = HeldBranchEnd::folded;
    while (branch.shapes.size() > 1 && !(branch.shapes.back().error_bound < folded))
        branch.shapes.pop_back();
    return branch;
}

/// Returns the shape of a number of half waves at a span and height, if the branch reaches it.
REVCHAIN_LAZY
std::optional<HeldCordShape> held_cord_shape(const Cord& cord, double span, double height,
                                             int half_waves) {
    const double length = cord.length();
    const auto state = HeldCord().at_height(half_waves, span / length, height / length);
    if (!state) return {};
    HeldCordShape shape = described(*state, span, length, cord.weight());
    if (!(shape.error_bound < folded)) return {};
    return shape;
}

/// Returns the fastest shape with a given upper tension on the branch of a number of half waves.
REVCHAIN_LAZY
std::optional<HeldCordShape> held_shape_of_tension(const Cord& cord, double span, double tension,
                                                   int half_waves) {
    HeldCord held;
    const double length = cord.length(), wanted = tension / cord.weight();
    // The tension decreases by the depth times weight/length; both ends bear the weight.
    if (2 * wanted <= 1 + span / length) return {};
    const auto first = held.at_height(half_waves, span / length, 0);
    if (!first) return {};
    const auto found = held.curve().first_where(*first, [&](const HeldState& x) {
        return held.top_pull(x.forces) - x.forces.height * wanted;
    });
    if (!found) return {};
    return described(*found, span, length, cord.weight());
}

}  // namespace finite
}  // namespace revchain
