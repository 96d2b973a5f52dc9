// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <optional>

#include "revchain/finite/held/sweep.hpp"
#include "revchain/rig.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The supports of both ends, and the height at which springs are taken; without it that of the
/// shape.
struct HeldSupports {
    Support lower{}, upper{};
    std::optional<Fine> height{};

    bool plain() const { return lower == Support{} && upper == Support{}; }
};

/// The supports at a height, in units of a chain, with radii and compliances times `part`. The
/// third number is the height, or with `by_part` the part.
template <class T>
HeldEnds<T> held_ends(const HeldSupports& supports, const ChainUnits& units, const T& height, double part = 1,
                      bool by_part = false) {
    HeldEnds<T> result;
    if (supports.plain()) return result;
    if (by_part) result.height_change = T(0);
    for (const bool above : {false, true}) {
        const Support& support = above ? supports.upper : supports.lower;
        Held<T>& end = above ? result.upper : result.lower;
        const T radius(std::ldexp(support.radius, -units.length_exponent));
        end.radius = radius * T(part), end.symmetric = part == 0 || support.radius == 0;
        if (by_part) result.radius_change[above] = radius;
        if (support.is_firm() || (part == 0 && !by_part)) continue;
        const T at = supports.height ? static_cast<T>(*supports.height) : height;
        const T stiffness =
            at * static_cast<T>(ldexp(support.stiffness, units.length_exponent - units.weight_exponent));
        end.firm = false, end.stiffness = stiffness / T(part > 0 ? part : 1), end.compliance = T(part) / stiffness;
        end.carriage = T(std::ldexp(support.carriage_weight, -units.weight_exponent));
        if (by_part)
            result.compliance_change[above] = T(1) / stiffness;
        else if (!supports.height)
            result.compliance_change[above] = -(end.compliance / height);
    }
    return result;
}

}  // namespace revchain::finite
