// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/shapes/all_shapes.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/steady_shapes.hpp"

namespace revchain::inline REVCHAIN_BUILD {

namespace finite {  // declared again: a file that includes all_shapes.hpp first defines them after this
template <class Means>
SteadyShapes all_shapes(const Chain<double>& chain, const SteadyShapesOptions& options, Means means);
template <class Means>
SteadyShapes all_shapes(const Rig& rig, const RigShapesOptions& options, Means means);
}  // namespace finite

REVCHAIN_DEFINE
SteadyShapes steady_shapes(const Chain<double>& chain, const SteadyShapesOptions& options) {
    return finite::all_shapes(chain, options, detail::Means{});
}
REVCHAIN_DEFINE
SteadyShapes steady_shapes(const Rig& rig, const RigShapesOptions& options) {
    return finite::all_shapes(rig, options, detail::Means{});
}
REVCHAIN_DEFINE
SteadyShapes steady_shapes(const Chain<double>& chain, const SteadyShapesOptions& options, Thorough) {
    return finite::all_shapes(chain, options, thorough);
}
REVCHAIN_DEFINE
SteadyShapes steady_shapes(const Rig& rig, const RigShapesOptions& options, Thorough) {
    return finite::all_shapes(rig, options, thorough);
}

}  // namespace revchain
