// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/stability/judged.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/stability.hpp"

namespace revchain::inline REVCHAIN_BUILD {

// If a program includes judged.hpp first, this file is read before the definitions there.
namespace finite {
template <class Shape, class Means>
Stability judged(StabilityFrame frame, const Chain<double>& chain, const Shape& shape, Means means);
template <class Means>
Stability judged(const Rig& rig, const SteadyShape& shape, const RigStabilityOptions& options,
                 Means means);
}  // namespace finite

REVCHAIN_DEFINE
Stability stability(const Chain<double>& chain, const SteadyShape& shape, StabilityFrame frame) {
    return finite::judged(frame, chain, shape, detail::UsualMeans{});
}

REVCHAIN_DEFINE
Stability stability(const Chain<double>& chain, const HeldShape& shape, StabilityFrame frame) {
    return finite::judged(frame, chain, shape, detail::UsualMeans{});
}

REVCHAIN_DEFINE
Stability stability(const Chain<double>& chain, const SteadyShape& shape, StabilityFrame frame,
                    Thorough) {
    return finite::judged(frame, chain, shape, thorough);
}

REVCHAIN_DEFINE
Stability stability(const Chain<double>& chain, const HeldShape& shape, StabilityFrame frame,
                    Thorough) {
    return finite::judged(frame, chain, shape, thorough);
}

REVCHAIN_DEFINE
Stability stability(const Rig& rig, const SteadyShape& shape, const RigStabilityOptions& options) {
    return finite::judged(rig, shape, options, detail::UsualMeans{});
}

REVCHAIN_DEFINE
Stability stability(const Rig& rig, const SteadyShape& shape, const RigStabilityOptions& options,
                    Thorough) {
    return finite::judged(rig, shape, options, thorough);
}

}  // namespace revchain
