// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/modes.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/questions/superposed.hpp"
#include "revchain/swing.hpp"

namespace revchain::inline REVCHAIN_BUILD {

REVCHAIN_INLINE Swing swing(const Chain<double>& chain, const SwingOptions& options) {
    constexpr std::string_view place = "swing";
    const Vector<double> from = detail::checked_start(place, chain.size(), false, "offset", options.offset);
    const Vector<double> speed = detail::checked_start(place, chain.size(), false, "velocity", options.velocity);
    const Index all = chain.mode_count();
    detail::check_times(place, options.time, options.gravity);
    const Index count = detail::checked_count(place, options.count, all);
    return detail::superposed<Swing>(
        detail::OscillatingChain(chain), options, from, speed, count, all, [&](Index first, Index number) {
            if (number == 0) return Modes<double>{};
            return modes(chain, {.first = first, .count = number, .progress = options.progress});
        });
}

}  // namespace revchain
