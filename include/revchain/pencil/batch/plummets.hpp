// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/batch/block.hpp"

namespace revchain::pencil {

/// Plummets: force F above and offset y of each pin for a free end at offset 1, with mu = 1/lambda,
///
///     F <- F - mu W y,      y <- y + F / k,      k = (weight hung above the pin's thread) / a.
///
/// y at the support is a polynomial in mu whose zeros are the modes. All functions inlined, all sums of one sign but in
/// y.
template <class V>
class PlummetLanes : public detail::LaneNumbers<V, 3> {
    using Numbers = detail::LaneNumbers<V, 3>;
    using Numbers::get, Numbers::put, Numbers::units;

   public:
    using Numbers::size;

    [[gnu::always_inline]] PlummetLanes(const LaneBlock& block, std::ptrdiff_t lane, double* work)
        : Numbers(block, lane, work) {
        CompensatedSum<V> hung;
        for (std::ptrdiff_t m = 0; m < size(); ++m) {
            const V weight = V::load(block.weight + m * block_lanes + lane) * units().per_weight;
            const V length = V::load(block.length + m * block_lanes + lane) * units().per_length;
            hung.add(weight);
            put(m, 0, weight);
            put(m, 1, hung.value() / length);
            put(m, 2, length / hung.value());
        }
    }

    /// Coefficients of y at the support, size() + 1 of them, lowest first. Cost N^2.
    [[gnu::always_inline]] void polynomial(V* y) const {
        V f[max_polynomial];  // F / (-mu)
        y[0] = V(1.0);
        for (std::ptrdiff_t m = 0; m < size(); ++m) {
            const V weight = get(m, 0), flexibility = get(m, 2);
            for (std::ptrdiff_t j = 0; j < m; ++j) f[j] = f[j] + weight * y[j];
            f[m] = weight * y[m];
            for (std::ptrdiff_t j = 1; j <= m; ++j) y[j] = y[j] + flexibility * f[j - 1];
            y[m + 1] = flexibility * f[m];
        }
        for (std::ptrdiff_t j = 1; j <= size(); j += 2) y[j] = -y[j];
    }

    /// Offset y and force F, up one link, with derivatives.
    [[gnu::always_inline]] void rise(std::ptrdiff_t m, const V& x, LaneTaylor<V>& y, LaneTaylor<V>& f) const {
        const V weight = get(m, 0), flexibility = get(m, 2);
        f.curvature = f.curvature - weight * (x * y.curvature + y.slope);
        f.slope = f.slope - weight * (x * y.slope + y.value);
        f.value = f.value - x * (weight * y.value);
        y.curvature = y.curvature + flexibility * f.curvature;
        y.slope = y.slope + flexibility * f.slope;
        y.value = y.value + flexibility * f.value;
    }

    /// The value alone.
    [[gnu::always_inline]] void rise(std::ptrdiff_t m, const V& x, V& y, V& f) const {
        f = f - (x * get(m, 0)) * y;
        y = y + get(m, 2) * f;
    }

    /// The shape, up one link.
    [[gnu::always_inline]] void rise(std::ptrdiff_t m, const V& x, LaneShape<V>& s) const {
        const V push = get(m, 0) * s.offset;
        s.inertia = s.inertia + push * s.offset;
        s.force = s.force - x * push;
        stretch(m, s);
    }

    /// The shape, down one link; its force has the other sign.
    [[gnu::always_inline]] void descend(std::ptrdiff_t m, const V& x, LaneShape<V>& s) const {
        stretch(m, s);
        const V push = get(m, 0) * s.offset;
        s.inertia = s.inertia + push * s.offset;
        s.force = s.force - x * push;
    }

    /// Mass of link m felt at its lower pin, its stiffness, and mass of link m felt at its upper pin.
    [[gnu::always_inline]] V lower_mass(std::ptrdiff_t m) const { return get(m, 0); }
    [[gnu::always_inline]] V stiffness(std::ptrdiff_t m) const { return get(m, 1); }
    [[gnu::always_inline]] V upper_mass(std::ptrdiff_t) const { return V(0.0); }

    static constexpr std::ptrdiff_t max_polynomial = 16;

   private:
    [[gnu::always_inline]] void stretch(std::ptrdiff_t m, LaneShape<V>& s) const {
        const V next = s.offset + get(m, 2) * s.force;
        const V stretched = next - s.offset;  // as rounded: the quotient's error is then the square of the offsets'
        s.stiffness = s.stiffness + (get(m, 1) * stretched) * stretched;
        s.offset = next;
    }
};

}  // namespace revchain::pencil
