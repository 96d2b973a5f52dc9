// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/count.hpp"
#include "revchain/linear/aberth_heights.hpp"
#include "revchain/linear/counted_roots.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/floating_point_state.hpp"
#include "revchain/pencil/proved_roots.hpp"

/// The part of `rig_modes` that finds several roots side by side.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// The relative error before rounding up to which a root counts as proved.
inline constexpr double worst_unrounded_root = 0.49 * std::numeric_limits<double>::epsilon();

/// The heights of a chain under a support that yields, all found together; nothing for other rigs,
/// for a few of many modes, and where one is not proved. `elements` is the rig's pencil.
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
    for (const auto& root : *roots) found.push_back({root.root.high, root.bound(), root.root});
    return found;
}

/// The roots of a range of numbers, from 1, eight at a time, to an ulp of the rounded result;
/// nothing where not proved. K > 0, no mass is negative. `elements` is the pencil of `roots`.
template <bool Spins>
std::optional<std::vector<FoundRoot>> roots_in_lanes(
    const pencil::ElementPencil<RigWord, Spins>& elements, const CountedRoots& roots,
    const ModeRange& range, Index available, double guess,
    const std::function<void(Index)>& finished) {
    return roots_in_lanes(
        elements, pencil::rounded<double>(elements),
        [&](double x) { return roots.certified(RigWord(x)); }, range, available, guess,
        worst_unrounded_root, finished,
        [&](Index j, const pencil::Bracket<double>& bracket) { return roots.refined(j, bracket); });
}

}  // namespace revchain::detail
