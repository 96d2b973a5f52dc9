// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/chain.hpp"
#include "revchain/pencil/element.hpp"

namespace revchain {

/// The small-amplitude pencil of a chain in `Wide<T>`, weights in units of 2^units.weight_exponent (and of the pencil's
/// own units) and heights in units of 2^units.length_exponent.
template <Real T>
struct AssembledChain {
    pencil::ElementPencil<Wide<T>> pencil;
    ChainUnits units;
};

/// Chain -> link elements, Greenhill (1908) §8 with sec delta = 1: with p = h/a, q = (a - h)/a and r = rho^2/a^2, the
/// stiffness k = (W p + S)/a and the mass of a rigid body about its two pins, A = W (p^2 + r), B = W (q^2 + r),
/// X = W (p q - r), c = W r. Every entry is within `entry_error` (relative) of the exact function of the chain's stored
/// numbers: 3e-29 in double, less for fewer than 256 links, more only where a centroid above the pin makes W h + a S
/// cancel. Where weights span more than one unit can serve, an element's is that of the weight at its upper pin, to a
/// factor of 2^(max_exponent/8).
/// Cost O(N).
template <Real T>
AssembledChain<T> assemble(const Chain<T>& chain) {
    using std::abs;
    using std::frexp;
    using std::ldexp;
    using S = Wide<T>;
    using E = Narrow<S>;
    constexpr int stride = std::numeric_limits<T>::max_exponent / 8;
    const bool one_unit = chain.has_one_weight_unit();
    AssembledChain<T> result;
    result.units = chain.units();
    result.pencil.elements.reserve(static_cast<std::size_t>(chain.size()));
    const int to_length = -result.units.length_exponent;
    S below(T(0));   // S_m, in the unit of the chain
    E shortest(1);   // length, in the unit of the chain
    E cancelled(1);  // worst (|W h| + a S) / (W h + a S)
    for (Index m = 0; m < chain.size(); ++m) {
        if (m % segment_size == 0) below = chain.weight_below(m);
        const Link<T> link = chain.link(m);
        const S above = below + S(link.weight);
        int unit = result.units.weight_exponent;
        if (!one_unit) {
            int exponent = 0;
            frexp(static_cast<T>(above), &exponent);
            const int lower = (unit - exponent) / stride * stride;
            unit -= lower;
            result.pencil.units.push_back(-lower);
        }
        const E weight(ldexp(link.weight, -unit));
        const S hung = ldexp(below, -unit);
        const S a(ldexp(link.length, to_length));
        const S h(ldexp(link.centroid, to_length));
        const S p = h / a, q = (a - h) / a;
        const S& r = link.gyration_ratio;
        const S moment = p * S(weight);
        const S carried = moment + hung;
        result.pencil.elements.push_back({carried / a, (p * p + r) * S(weight), (q * q + r) * S(weight),
                                          (p * q - r) * S(weight), r * S(weight), weight});
        shortest = std::min(shortest, static_cast<E>(a));
        const E amplification = (abs(static_cast<E>(moment)) + static_cast<E>(hung)) / static_cast<E>(carried);
        if (amplification > cancelled) cancelled = amplification;
        below = above;
    }
    // S_m is a partial weight and up to a segment more; every other entry takes at most six operations.
    const Index segments = (chain.size() - 1) / segment_size;
    const Index sums = segments == 0 ? chain.size() : segment_size + segments + 20;
    result.pencil.entry_error = operation_error<S>() * (E(sums + 4) * cancelled * E(1.01) + E(7));
    result.pencil.stiffness_underflow =
        std::numeric_limits<E>::min() * std::numeric_limits<E>::epsilon() * E(4) / shortest;
    return result;
}

}  // namespace revchain
