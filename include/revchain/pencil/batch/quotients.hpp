// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/batch/block.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

namespace detail {

/// Rayleigh quotient stiffness / inertia of a shape; `imbalance` is its squared residual, relative to the quotient.
template <class V>
struct LaneQuotient {
    V stiffness, inertia, imbalance;
};

/// The quotient of a shape that is out of balance by `force` at one pin, which bears `mass`.
template <class V>
[[gnu::always_inline]] inline LaneQuotient<V> quotient_of(const V& stiffness, const V& inertia, const V& force,
                                                          const V& mass) {
    return {stiffness, inertia, force * force * inertia / (mass * (stiffness * stiffness))};
}

/// The quotient of the shape carried from the free end to the topmost pin below the support.
template <class V, class Links>
[[gnu::always_inline]] inline LaneQuotient<V> quotient(const Links& links, const V& x) {
    LaneShape<V> s(1.0, 0.0);
    const std::ptrdiff_t top = links.size() - 1;
    for (std::ptrdiff_t m = 0; m < top; ++m) {
        links.rise(m, x, s);
        tidy(m, s);
    }
    const V k = links.stiffness(top), mass = links.lower_mass(top);
    return quotient_of(((k * s.offset) * s.offset + s.stiffness) + s.earlier_stiffness,
                       ((mass * s.offset) * s.offset + s.inertia) + s.earlier_inertia,
                       s.force - x * (mass * s.offset) + k * s.offset, mass);
}

/// The quotient of the shape carried from both ends to the pin where they meet best. It is for modes that live low in
/// the chain, which would grow upwards from rounding alone. `work`: 4 * size * block_lanes numbers.
template <class V, class Links>
[[gnu::always_inline]] inline LaneQuotient<V> twisted_quotient(const Links& links, const V& x, double* work) {
    LaneShape<V> s(1.0, 0.0);
    for (std::ptrdiff_t m = 0; m < links.size(); ++m) {
        double* const here = work + 4 * m * block_lanes;
        s.offset.store(here);
        s.force.store(here + block_lanes);
        (s.inertia + s.earlier_inertia).store(here + 2 * block_lanes);
        (s.stiffness + s.earlier_stiffness).store(here + 3 * block_lanes);
        links.rise(m, x, s);
        tidy(m, s);
    }
    LaneShape<V> t(0.0, 1.0);
    LaneQuotient<V> best{V(0.0), V(0.0), V(std::numeric_limits<double>::infinity())};
    for (std::ptrdiff_t m = links.size(); m-- > 0;) {
        links.descend(m, x, t);
        tidy(m, t);
        const double* const here = work + 4 * m * block_lanes;
        const V up = V(1.0) / V::load(here), down = V(1.0) / t.offset;
        const V mass = m == 0 ? links.lower_mass(m) : links.lower_mass(m) + links.upper_mass(m - 1);
        const LaneQuotient<V> q =
            quotient_of(V::load(here + 3 * block_lanes) * up * up + (t.stiffness + t.earlier_stiffness) * down * down,
                        V::load(here + 2 * block_lanes) * up * up + (t.inertia + t.earlier_inertia) * down * down,
                        V::load(here + block_lanes) * up + t.force * down, mass);
        const auto better = q.imbalance < best.imbalance;
        best.stiffness = select(better, q.stiffness, best.stiffness);
        best.inertia = select(better, q.inertia, best.inertia);
        best.imbalance = select(better, q.imbalance, best.imbalance);
    }
    return best;
}

}  // namespace detail

}  // namespace revchain::pencil
