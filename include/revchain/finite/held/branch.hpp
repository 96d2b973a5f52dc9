// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/held/held.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// Why a branch ends: `speed`, it is back at the greatest speed; `slack`, a link is slack or turns
/// over; `rest`, a chain with ends off the axis hangs as at rest; `folded`, a cord hangs folded
/// along the axis; `budget`, it has 3000 steps.
enum class HeldBranchEnd { speed, slack, rest, folded, budget };
[[nodiscard]] inline std::string_view to_string(HeldBranchEnd end) noexcept {
    constexpr std::array<std::string_view, 5> names{"speed", "slack", "rest", "folded", "budget"};
    return names[static_cast<std::size_t>(end)];
}

/// Shapes of a chain or cord held at a span, along the branch of the shape that is nearly straight
/// without gravity. They go from the greatest speed to slower ones and, past a fold, back to it.
template <class Shape>
struct HeldBranchOf {
    int mode = 1;               ///< number of the mode, see `branches`
    int half_waves = 1;         ///< of the first shape
    std::vector<Shape> shapes;  ///< to double accuracy; each `error_bound` is an estimate
    std::vector<Index> folds;   ///< indices of shapes at which the speed is extreme
    HeldBranchEnd end = HeldBranchEnd::budget;
};
using HeldBranch = HeldBranchOf<HeldShape>;

namespace finite {

/// Returns the state between two states of a branch at which the height is extreme, if any.
template <class System>
std::optional<HeldState> fold_between(System& held, const HeldState& from, const HeldState& to) {
    const auto turning = [&](const HeldState& x) {
        const HeldEnd<double> end = held(x.forces, true);
        return end.offset_change[0] * end.rise_change[1] -
               end.offset_change[1] * end.rise_change[0];
    };
    const double at_low = turning(from), at_high = turning(to);
    if (!(at_low * at_high < 0)) return {};
    const auto at = [&](double share) { return held.curve().across_chord(from, to, share); };
    return detail::state_between(at_low, at_high, at, turning);
}

/// Returns the branch from a state up in height. `describe(state, is_fold)` returns a shape.
template <class System, class Describe>
auto branch_from(System& held, const HeldState& first, double max_step, const Describe& describe) {
    const double height = first.forces.height;
    std::vector<HeldState> states{first};
    std::vector<std::decay_t<decltype(held.kept())>> ways(1, held.kept());
    HeldBranchOf<std::decay_t<decltype(describe(first, false))>> branch;
    branch.end = HeldBranchEnd::slack;
    held.curve().along_heights(first, max_step, [&](const HeldState& state) {
        if (state.forces.height < height) {
            const auto there = held.kept();
            HeldState last = state;
            last.forces.height = height;
            if (const auto end = held.curve().corrected(last)) {
                states.push_back(*end), ways.push_back(held.kept());
                branch.end = HeldBranchEnd::speed;
            }
            held.keep(there);
            return false;
        }
        const HeldForces<double>&last = states.back().forces, &next = state.forces;
        const double size = std::abs(last.across) + std::abs(last.along);
        // steps shrink without limit where a link becomes slack
        if (std::abs(next.across - last.across) + std::abs(next.along - last.along) < 1e-6 * size &&
            std::abs(next.height - last.height) < 1e-6 * next.height)
            return false;
        states.push_back(state), ways.push_back(held.kept());
        if (state.forces.height < HeldCurve<System>::at_rest * as_double(held.length()))
            return true;
        branch.end = HeldBranchEnd::rest;
        return false;
    });
    if (states.size() >= static_cast<std::size_t>(HeldCurve<System>::max_steps))
        branch.end = HeldBranchEnd::budget;
    for (std::size_t i = 0; i < states.size(); ++i) {
        held.keep(ways[i]);
        branch.shapes.push_back(describe(states[i], false));
        if (i == 0 || i + 1 >= states.size()) continue;
        const auto height_of = [&](std::size_t k) { return states[k].forces.height; };
        if (!((height_of(i) - height_of(i - 1)) * (height_of(i + 1) - height_of(i)) < 0)) continue;
        if (const auto fold = fold_between(held, states[i - 1], states[i + 1])) {
            branch.folds.push_back(static_cast<Index>(branch.shapes.size()) - 1);
            branch.shapes.back() = describe(*fold, true);
        }
    }
    return branch;
}

/// The start of a branch: half waves on the axis, and side. Without mirror images each number of
/// half waves has two branches; in the first one the lowest link leads outwards.
struct HeldStart {
    int half_waves;
    bool outwards = true;

    static HeldStart of_mode(int mode, bool symmetric) {
        return symmetric ? HeldStart{mode} : HeldStart{(mode + 1) / 2, mode % 2 == 1};
    }
};

/// Returns the branch of a mode at a span, for heights from `least` up; none if it does not exist.
REVCHAIN_LAZY
std::optional<HeldBranch> held_branch(const Chain<double>& chain, const HeldSupports& supports,
                                      double span, double least, int mode, double max_step) {
    HeldChain held(chain, supports);
    const int exponent = held.links().units.length_exponent;
    const double apart = std::ldexp(span, -exponent), height = std::ldexp(least, -exponent);
    const HeldStart start = HeldStart::of_mode(mode, held.is_symmetric());
    held.springs_at(Fine(height));
    const auto first = held.at_height(start.half_waves, Fine(apart), height, start.outwards);
    held.springs_at({});
    if (!first) return {};
    HeldBranch branch =
        branch_from(held, *first, max_step, [&](const HeldState& state, bool is_fold) {
            if (!is_fold)
                if (auto shape =
                        held.finished(state, Fine(apart), Fine(state.forces.height), false))
                    return *shape;
            const HeldForces<Fine> forces{Fine(state.forces.across), Fine(state.forces.along),
                                          Fine(state.forces.height)};
            std::vector<Direction<Fine>> ways_there;
            for (const Direction<double>& d : held.kept())
                ways_there.push_back({Fine(d.sine), Fine(d.cosine)});
            return described(held.links(), held.ends(forces.height), forces, Fine(apart),
                             ways_there);
        });
    branch.mode = mode;
    branch.half_waves = branch.shapes.empty() ? start.half_waves : branch.shapes.front().half_waves;
    return branch;
}

/// Returns the fastest shape with a given upper tension on the branch of a mode, with firm ends.
REVCHAIN_LAZY
std::optional<HeldShape> held_shape_of_tension(const Chain<double>& chain,
                                               const HeldSupports& supports, double span,
                                               double tension, int mode) {
    HeldChain held(chain, supports);
    const HeldStart start = HeldStart::of_mode(mode, held.is_symmetric());
    const ChainUnits units = held.links().units;
    const double apart = std::ldexp(span, -units.length_exponent),
                 wanted = std::ldexp(tension, -units.weight_exponent);
    const auto first = held.at_height(start.half_waves, Fine(apart), 0, start.outwards);
    if (!first) return {};
    const auto found = held.curve().first_where(*first, [&](const HeldState& x) {
        return held.top_pull(x.forces) - x.forces.height * wanted;
    });
    if (!found) return {};
    return held.finished(*found, Fine(apart), Fine(found->forces.height), true);
}

}  // namespace finite
}  // namespace revchain
