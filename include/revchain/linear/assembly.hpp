// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/chain/chain.hpp"
#include "revchain/linalg/element_pencil.hpp"

namespace revchain {

/// The small-amplitude pencil of a chain in `Wide<T>`, weights in units of 2^units.weight_exponent and heights in units
/// of 2^units.length_exponent.
template <Real T>
struct AssembledChain {
    linalg::ElementPencil<Wide<T>> pencil;
    ChainUnits units;
};

/// Chain -> link elements, Greenhill (1908) §8 with sec delta = 1: k = (W h + a S)/a^2, and the mass of a rigid body
/// about its two pins, A = W (h^2 + rho^2)/a^2, B = W ((a - h)^2 + rho^2)/a^2, C = W^2 rho^2/a^2.
/// Every entry is within `entry_error` (relative) of the exact function of the chain's stored numbers: 1e-31 (N + 4)
/// in double, more only where a centroid above the pin makes W h + a S cancel. Cost O(N).
template <Real T>
AssembledChain<T> assemble(const Chain<T>& chain) {
    using std::abs;
    using std::ldexp;
    using S = Wide<T>;
    using E = Narrow<S>;
    AssembledChain<T> result;
    result.units = chain.units();
    result.pencil.elements.reserve(static_cast<std::size_t>(chain.size()));
    const int to_weight = -result.units.weight_exponent;
    const int to_length = -result.units.length_exponent;
    S hung(T(0));    // S_m
    E cancelled(1);  // worst (|W h| + a S) / (W h + a S)
    for (Index m = 0; m < chain.size(); ++m) {
        const Link<T> link = chain.link(m);
        const E weight(ldexp(link.weight, to_weight));
        const S a(ldexp(link.length, to_length));
        const S h(ldexp(link.centroid, to_length));
        const S gyration = ldexp(link.gyration_squared, 2 * to_length);
        const S moment = S(weight) * h;
        const S carried = a * hung;
        const S kappa = moment + carried;
        const S square = a * a;
        const S rest = a - h;
        result.pencil.elements.push_back({kappa / square, (h * h + gyration) / square * S(weight),
                                          (rest * rest + gyration) / square * S(weight),
                                          gyration / square * S(weight) * S(weight), weight});
        const E amplification = (abs(static_cast<E>(moment)) + static_cast<E>(carried)) / static_cast<E>(kappa);
        if (amplification > cancelled) cancelled = amplification;
        hung = hung + S(weight);
    }
    // S_m is a sum of up to N terms; every other entry takes at most seven operations.
    result.pencil.entry_error = operation_error<S>() * (E(chain.size() + 4) * cancelled * E(1.01) + E(7));
    return result;
}

}  // namespace revchain
