// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/chain.hpp"
#include "revchain/pencil/element.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// Does `assemble` in double alone, for loose tolerances, at a twentieth of its cost: 5 ns a link.
/// Every entry is within `entry_error`, 3e-14 (less for fewer than 256 links), of exact functions
/// of the data. The result is empty if weights need several units, a centroid is above its pin, or
/// units are extreme.
template <std::same_as<double> T>
std::optional<pencil::ElementPencil<T>> plain_pencil(const Chain<T>& chain) {
    const ChainUnits units = chain.units();
    if (!chain.has_one_weight_unit() || !chain.centroids_below()) return std::nullopt;
    if (std::abs(units.weight_exponent) > 1000 || std::abs(units.length_exponent) > 1000)
        return std::nullopt;
    const T per_weight = std::ldexp(T(1), -units.weight_exponent);
    const T per_length = std::ldexp(T(1), -units.length_exponent);
    pencil::ElementPencil<T> pencil;
    pencil.elements.resize(static_cast<std::size_t>(chain.size()));
    T shortest(1);
    T below(0);
    for (Index m = 0; m < chain.size(); ++m) {
        if (m % detail::segment_size == 0)
            below = static_cast<T>(chain.weight_below(m)) * per_weight;
        const T weight = chain.weight()[m] * per_weight, length = chain.length()[m] * per_length;
        const T centroid = chain.centroid()[m] * per_length,
                turning = static_cast<T>(chain.gyration_ratio()[m]);
        const T per = T(1) / length, p = centroid * per, q = (length - centroid) * per;
        pencil.elements[static_cast<std::size_t>(m)] = {
            (weight * p + below) * per, weight * (p * p + turning), weight * (q * q + turning),
            weight * (p * q - turning), weight * turning,           weight};
        below += weight;
        shortest = std::min(shortest, length);
    }
    // Entries have sums of up to a segment of weights, and at most eight other operations.
    const Index sums = std::min(chain.size(), detail::segment_size);
    pencil.entry_error = epsilon<T>() / T(2) * T(1.01) * T(sums + 10);
    pencil.stiffness_underflow = std::numeric_limits<T>::min() * epsilon<T>() * T(4) / shortest;
    return pencil;
}

}  // namespace revchain
