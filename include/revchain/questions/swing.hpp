// SPDX-License-Identifier: MPL-2.0
// Defines what swing.hpp declares.
#pragma once

#include "revchain/modes.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/questions/superposed.hpp"
#include "revchain/swing.hpp"

namespace revchain::inline REVCHAIN_BUILD {

REVCHAIN_DEFINE
Swing swing(const Chain<double>& chain, const SwingOptions& options) {
    constexpr std::string_view place = "swing";
    const auto [from, speed] = detail::checked_start(place, chain.size(), false, options);
    const Index all = chain.mode_count();
    const auto found = [&](Index first, Index number) {
        if (number == 0) return Modes<double>{};
        return modes(chain, {.first = first, .count = number, .progress = options.progress});
    };
    const detail::OscillatingChain system(chain);
    return detail::superposed<Swing>(place, system, options, from, speed, all, found);
}

}  // namespace revchain
