// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <string>

#include "revchain/count.hpp"

/// Which modes the options of a question mean.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// Modes found where no count is given and there are as many.
inline constexpr Index default_count = 10;

template <class Options>
void check(const Options& options) {
    if (!options.rtol) return;
    const auto rtol = *options.rtol;
    if (!(rtol >= decltype(rtol)(0)))
        throw_invalid("modes", "rtol must not be negative or NaN", rtol);
}

/// The modes whose numbers are asked for, of `all` there are.
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

/// The numbers of the modes asked for, of `all` there are. For a window, `above(height)` counts the
/// modes above a height and `below(speed)` those slower than a speed.
template <class Options, class Above, class Below>
ModeRange chosen(Index all, const Options& options, const Above& above, const Below& below) {
    const bool numbered = options.first != 1 || options.count.has_value();
    if (numbered + options.conical_height.has_value() + options.angular_speed.has_value() > 1)
        throw_invalid("modes",
                      "give one of mode numbers (first, count), conical_height and "
                      "angular_speed, not several");
    if (options.conical_height) return modes_within(*options.conical_height, all, above);
    if (!options.angular_speed) return numbered_range(all, options);
    require_positive("modes", "gravity", options.gravity);
    return modes_within(*options.angular_speed, all, below);
}

}  // namespace revchain::detail
