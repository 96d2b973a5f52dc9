// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <string>

#include "revchain/count.hpp"

/// The range of modes that the options of a question select.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// The number of modes found if no count is given; fewer if the chain has fewer.
inline constexpr Index default_count = 10;

template <class Options>
void check(const Options& options) {
    if (!options.rtol) return;
    const auto rtol = *options.rtol;
    if (!(rtol >= decltype(rtol)(0)))
        throw_invalid("modes", "rtol must not be negative or NaN", rtol);
}

/// Returns the modes that the options request by number; `all` is the number of modes.
template <class Options>
ModeRange numbered_range(Index all, const Options& options) {
    const std::string of = std::to_string(all) + " modes of this chain";
    if (options.first < 1) throw_invalid("modes", "first must be at least 1", options.first);
    if (options.first > all)
        throw_invalid("modes", "first must not exceed the " + of, options.first);
    const Index left = all - options.first + 1;
    const Index wanted = options.count.value_or(std::min(left, default_count));
    const Index count = wanted == all_modes ? left : wanted;
    if (count < 1) throw_invalid("modes", "count must be at least 1", count);
    std::string most = of;
    if (left < all)
        most = std::to_string(left) + " from number " + std::to_string(options.first) +
               " on of the " + of;
    if (count > left) throw_invalid("modes", "count must not exceed the " + most, count);
    return {options.first, count};
}

/// Returns the mode numbers that the options request; `all` is the number of modes. For a window,
/// `above(height)` counts the modes above a height and `below(speed)` those slower than a speed.
template <class Options, class Above, class Below>
ModeRange chosen(Index all, const Options& options, const Above& above, const Below& below) {
    const bool numbered = options.first != 1 || options.count.has_value();
    if (numbered + options.conical_height.has_value() + options.angular_speed.has_value() > 1)
        throw_invalid("modes",
                      "give one of mode numbers (first, count), conical_height and angular_speed, "
                      "not several");
    if (options.conical_height) return modes_within(*options.conical_height, all, above);
    if (!options.angular_speed) return numbered_range(all, options);
    require_positive("modes", "gravity", options.gravity);
    return modes_within(*options.angular_speed, all, below);
}

}  // namespace revchain::detail
