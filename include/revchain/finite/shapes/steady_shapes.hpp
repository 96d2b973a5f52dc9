// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/shapes/shapes_by.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD {

// If a program includes shapes_by.hpp first, this file is read before the definitions there.
namespace finite {
template <class Means>
SteadyShapes shapes_by(const Chain<double>& chain, const SteadyShapesOptions& options, Means means);
template <class Means>
SteadyShapes shapes_by(const Rig& rig, const RigShapesOptions& options, Means means);
}  // namespace finite

REVCHAIN_DEFINE
SteadyShapes steady_shapes(const Chain<double>& chain, const SteadyShapesOptions& options) {
    return finite::shapes_by(chain, options, detail::UsualMeans{});
}
REVCHAIN_DEFINE
SteadyShapes steady_shapes(const Rig& rig, const RigShapesOptions& options) {
    return finite::shapes_by(rig, options, detail::UsualMeans{});
}
REVCHAIN_DEFINE
SteadyShapes steady_shapes(const Chain<double>& chain, const SteadyShapesOptions& options,
                           Thorough) {
    return finite::shapes_by(chain, options, thorough);
}
REVCHAIN_DEFINE
SteadyShapes steady_shapes(const Rig& rig, const RigShapesOptions& options, Thorough) {
    return finite::shapes_by(rig, options, thorough);
}

}  // namespace revchain
