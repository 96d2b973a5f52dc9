// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/count.hpp"
#include "revchain/linear/aberth_heights.hpp"
#include "revchain/linear/counted_roots.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/floating_point_state.hpp"
#include "revchain/pencil/proved_roots.hpp"

/// This header has the part of `rig_modes` that finds several roots side by side.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// The largest relative error before rounding for which a root counts as proved.
inline constexpr double worst_unrounded_root = 0.49 * std::numeric_limits<double>::epsilon();

/// Returns the heights of a chain under a support that yields, found together. The result is empty
/// for other rigs, for a few of many modes, and if a proof fails. `elements` is the rig's pencil.
REVCHAIN_LAZY
std::optional<std::vector<FoundRoot>> roots_under_a_spring(
    const Rig& rig, const pencil::ElementPencil<RigWord>& elements, const ModeRange& range,
    Index available) {
    const Chain<double>& chain = rig.chain();
    const Rigging& with = rig.rigging();
    if (with.support.is_firm() || !with.posture.empty() || !with.flywheels.empty() ||
        !with.displaced.empty() || chain.mode_count() != chain.size() ||
        !chain.has_one_weight_unit() ||
        chain.size() >= static_cast<Index>(pencil::aberth::most_links) ||
        4 * range.count < available)
        return std::nullopt;
    const FloatingPointStateGuard quiet;
    const auto& spring = elements.elements.back();
    pencil::aberth::LumpedLinks links;
    if (!lump(links, chain, SpringOnTop{spring.stiffness.high, spring.lower.high}))
        return std::nullopt;
    pencil::AberthSpectrum all;
    if (static_cast<Index>(links.size) != available ||
        !pencil::aberth_spectrum(links, 0x1p-40, all))
        return std::nullopt;
    const auto roots = refined(elements, range, available, all, worst_unrounded_root);
    if (!roots) return std::nullopt;
    std::vector<FoundRoot> found;
    for (const auto& root : *roots) found.push_back({root.root, root.bound()});
    return found;
}

/// Returns the roots of a range of numbers, from 1, eight at a time, to an ulp of the rounded
/// result, or nothing if a proof fails. Preconditions: K > 0, masses >= 0. `elements` is the pencil
/// of `roots`.
template <bool Spins>
std::optional<std::vector<FoundRoot>> roots_in_lanes(
    const pencil::ElementPencil<RigWord, Spins>& elements, const CountedRoots& roots,
    const ModeRange& range, Index available, double guess,
    const std::function<void(Index)>& finished) {
    if (elements.size() > most_in_lanes) return std::nullopt;
    const FloatingPointStateGuard quiet;
    const auto counter = pencil::rounded<double>(elements);
    const auto certified = [&](double x) { return roots.certified(RigWord(x)); };
    const auto proved =
        pencil::proved_range(elements, counter, certified, range.first - 1, range.count, available,
                             guess, worst_unrounded_root, finished);
    if (!proved) return std::nullopt;
    std::vector<FoundRoot> found;
    found.reserve(proved->size());
    for (const auto& root : *proved) {
        const Index j = range.first - 1 + static_cast<Index>(found.size());
        if (std::isfinite(root.off)) {
            found.push_back({root.root, root.bound()});
            continue;
        }
        const auto bracket = pencil::bisect(counter, j, 1, 2 * epsilon<double>(), guess).front();
        found.push_back(roots.refined(j, bracket));
    }
    return found;
}

}  // namespace revchain::detail
