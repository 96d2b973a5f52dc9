// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linear/heights.hpp"

/// This header computes one mode of a chain by counts alone. It compiles in a third of the time of
/// `modes`, which has every method, and costs the same for a chain of a few hundred links.
namespace revchain::inline REVCHAIN_BUILD::detail {

/// Conical height and offsets of the pins, as `modes` returns them.
template <Real T>
struct OneMode {
    T conical_height;
    Vector<T> shape;  ///< (N + 1), free end first; empty unless requested
};

/// Returns mode number `mode` of the chain. Precondition: 1 <= mode <= chain.mode_count().
template <Real T>
OneMode<T> one_mode(const Chain<T>& chain, Index mode, bool with_shape = true) {
    using std::ldexp;
    LazyCounter<T> assembled(chain);
    const auto height =
        heights_by_bisection(chain, assembled, {mode, 1}, HeightsOptions<T>{}).front();
    OneMode<T> result{ldexp(height.eigenvalue, chain.units().length_exponent), {}};
    if (with_shape)
        result.shape = pencil::eigenvector(assembled.pencils().wide(), height.unrounded)
                           .offset.template cast<T>();
    return result;
}

}  // namespace revchain::detail
