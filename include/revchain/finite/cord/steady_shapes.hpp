// SPDX-License-Identifier: MPL-2.0
// Defines what cord.hpp declares of steady shapes.
#pragma once

#include "revchain/finite/cord/continuous_chain.hpp"
#include "revchain/numeric/compiled.hpp"

namespace revchain::inline REVCHAIN_BUILD {

REVCHAIN_DEFINE
CordShapes steady_shapes(const Cord& cord, const CordShapesOptions& options) {
    constexpr std::string_view place = "steady_shapes";
    cord.require_no_bob(place);
    const double height = detail::height_given(place, options);
    finite::length_in_heights(place, cord.length(), height);
    if (options.scanned < 1)
        detail::throw_invalid(place, "scanned must be at least 1", options.scanned);
    return finite::continuous_shapes(finite::ContinuousChain(cord), height, options.scanned);
}

REVCHAIN_INLINE CordPlace CordShape::operator()(double arc) const {
    if (!(arc >= 0 && arc <= length))
        detail::throw_invalid("CordShape", "arc length must lie between 0 and the length", arc);
    const double scaled = std::min(arc / conical_height, support_arc);
    CordPlace place = finite::place_of(*this, finite::state_at(kind, steps, tip_offset, scaled));
    place.arc_length = arc;
    if (arc == length) place.offset = 0;
    return place;
}

}  // namespace revchain
