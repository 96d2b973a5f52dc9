// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/conical_pendulum.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Returns the conical height at which branches end, given directly or as a speed.
template <class Options>
double lowest_height(std::string_view place, const Options& options) {
    if (options.min_conical_height.has_value() == options.max_angular_speed.has_value())
        detail::throw_invalid(place, "give either min_conical_height or max_angular_speed");
    const double height =
        options.min_conical_height
            ? *options.min_conical_height
            : conical_pendulum::height(*options.max_angular_speed, options.gravity);
    detail::require_positive(
        place, options.min_conical_height ? "min_conical_height" : "gravity / max_angular_speed^2",
        height);
    return height;
}

}  // namespace revchain::finite
