// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/numeric/compiled.hpp"
#include "revchain/rig.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// How a rig is driven: its support moves, the far end of its support's spring moves, or a force acts
/// on its support.
enum class Moved { support, far_end_of_spring, by_force };

REVCHAIN_LAZY
Moved moved_part(const Rig& rig, bool by_force) {
    if (by_force) return Moved::by_force;
    const bool has_spring = !rig.support().is_firm() && !rig.support().is_free();
    return has_spring ? Moved::far_end_of_spring : Moved::support;
}

/// Returns the rig that moves relative to a prescribed motion. A support that is moved itself is
/// firm.
REVCHAIN_LAZY
Rig relative_rig(const Rig& rig, Moved moved) {
    Rigging with = rig.rigging();
    with.support.radius = 0;
    if (moved == Moved::support) with.support = Support{};
    return {rig.chain(), std::move(with)};
}

/// Returns the rig for a motion in time: its links do not turn about their own axes.
REVCHAIN_LAZY
Rig without_axial_moments(const Rig& rig) {
    Rigging with = rig.rigging();
    for (Flywheel& wheel : with.flywheels) wheel.axial_moment = 0.0;
    return {rig.chain(), std::move(with)};
}

}  // namespace revchain::detail
