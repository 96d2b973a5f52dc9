// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/chain.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// A link in the units of its chain's pencil. `below` is S, the weight hung below it.
template <class N>
struct ScaledLink {
    N weight, length, centroid, radius, below;
    N pull() const { return weight * centroid / length + below; }  ///< sigma = (W h + a S)/a
};

template <Real T>
std::vector<ScaledLink<Wide<T>>> scaled_links(const Chain<T>& chain) {
    using std::ldexp, std::sqrt;
    using S = Wide<T>;
    const ChainUnits units = chain.units();
    std::vector<ScaledLink<S>> links;
    links.reserve(static_cast<std::size_t>(chain.size()));
    S below(T(0));
    for (Index m = 0; m < chain.size(); ++m) {
        if (m % segment_size == 0) below = ldexp(chain.weight_below(m), -units.weight_exponent);
        const Link<T> it = chain.link(m);
        const S weight(ldexp(it.weight, -units.weight_exponent));
        const S length(ldexp(it.length, -units.length_exponent));
        const S centroid(ldexp(it.centroid, -units.length_exponent));
        links.push_back({weight, length, centroid, sqrt(it.gyration_ratio) * length, below});
        below = below + weight;
    }
    return links;
}

}  // namespace revchain::detail
