// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <limits>

#include "revchain/numeric/compensated_sum.hpp"
#include "revchain/simd/pack.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// The number of chains in one block. Each processor uses registers of its own width.
inline constexpr std::ptrdiff_t block_lanes = 16;

/// Pointers to numbers of `block_lanes` chains of `size` links, lowest first [m * block_lanes +
/// lane].
struct LaneBlock {
    std::ptrdiff_t size = 0;
    const double* weight = nullptr;
    const double* length = nullptr;
    const double* centroid = nullptr;  ///< null for plummets, which have the mass at the lower pin
    const double* turning = nullptr;   ///< radius of gyration or pendulum length
    bool turning_is_radius = false;
};

/// A shape of given mu, carried from one end of the chain. It has the offset of the current pin,
/// the force in the next link, and the sums y^T M y and y^T K y over the links passed.
template <class V>
struct LaneShape {
    V offset, force, inertia{}, stiffness{};
    V earlier_inertia{}, earlier_stiffness{};  // sums of sums: fewer roundings
};

/// A polynomial's Taylor coefficients at x: p(x), p'(x), p''(x)/2.
template <class V>
struct LaneTaylor {
    V value, slope, curvature;
};

namespace detail {

/// Powers of two that scale total weight and largest length to about 1. `ordinary`: no overflow.
template <class V>
struct LaneUnits {
    V per_weight, per_length;
    typename V::Mask ordinary;

    [[gnu::always_inline]] LaneUnits(const LaneBlock& block, std::ptrdiff_t lane) {
        const V infinity(std::numeric_limits<double>::infinity());
        V total(0.0), lightest = infinity, longest(0.0), shortest = infinity;
        for (std::ptrdiff_t m = 0; m < block.size; ++m) {
            const std::ptrdiff_t at = m * block_lanes + lane;
            const V weight = V::load(block.weight + at), length = V::load(block.length + at);
            total = total + weight;
            lightest = select(weight < lightest, weight, lightest);
            shortest = select(length < shortest, length, shortest);
            longest = select(longest < length, length, longest);
            if (block.centroid == nullptr) continue;
            const V centroid = V::load(block.centroid + at), turning = V::load(block.turning + at);
            shortest = select(centroid < shortest, centroid, shortest);
            longest = select(longest < centroid, centroid, longest);
            longest = select(longest < turning, turning, longest);
        }
        per_weight = inverse_power(total);
        per_length = inverse_power(longest);
        ordinary = (V(0x1p-100) < lightest * per_weight) & (V(0x1p-50) < shortest * per_length);
    }
};

/// The base of link classes: `Stored` numbers for each link of a register's chains, units near 1.
template <class V, std::ptrdiff_t Stored>
class LaneNumbers {
   public:
    static constexpr std::ptrdiff_t stored = Stored, max_polynomial = 16;

    std::ptrdiff_t size() const { return size_; }
    [[gnu::always_inline]] V per_length() const { return units_.per_length; }
    [[gnu::always_inline]] typename V::Mask ordinary() const { return units_.ordinary; }

   protected:
    /// Handles lanes lane, lane + 1, ...; `work` has size * stored * block_lanes numbers.
    [[gnu::always_inline]] LaneNumbers(const LaneBlock& block, std::ptrdiff_t lane, double* work)
        : size_(block.size), work_(work + lane), units_(block, lane) {}

    [[gnu::always_inline]] const LaneUnits<V>& units() const { return units_; }
    [[gnu::always_inline]] V get(std::ptrdiff_t m, std::ptrdiff_t which) const {
        return V::load(work_ + (m * stored + which) * block_lanes);
    }
    [[gnu::always_inline]] void put(std::ptrdiff_t m, std::ptrdiff_t which, const V& x) {
        x.store(work_ + (m * stored + which) * block_lanes);
    }

   private:
    std::ptrdiff_t size_;
    double* work_;
    LaneUnits<V> units_;
};

/// The number of links after which recurrences are scaled to about 1, so that they cannot overflow.
inline constexpr std::ptrdiff_t rescaled_every = 8;

[[gnu::always_inline]] inline bool rescaled_after(std::ptrdiff_t m) {
    return m % rescaled_every == rescaled_every - 1;
}

template <class V>
[[gnu::always_inline]] inline V rescaling(const V& offset, const V& force) {
    return inverse_power(abs(offset) + abs(force));
}

template <class V>
[[gnu::always_inline]] inline void rescale(V& offset, V& force) {
    const V scale = rescaling(offset, force);
    offset = offset * scale;
    force = force * scale;
}

template <class V>
[[gnu::always_inline]] inline void rescale(LaneShape<V>& s) {
    const V scale = rescaling(s.offset, s.force);
    s.offset = s.offset * scale;
    s.force = s.force * scale;
    s.earlier_inertia = s.earlier_inertia * (scale * scale);
    s.earlier_stiffness = s.earlier_stiffness * (scale * scale);
}

/// After every fourth link m: adds up the sums of four links. After every eighth link: rescales.
template <class V>
[[gnu::always_inline]] inline void tidy(std::ptrdiff_t m, LaneShape<V>& s) {
    if (m % 4 != 3) return;
    s.earlier_inertia = s.earlier_inertia + s.inertia;
    s.earlier_stiffness = s.earlier_stiffness + s.stiffness;
    s.inertia = s.stiffness = V(0.0);
    if (rescaled_after(m)) rescale(s);
}

template <class V>
[[gnu::always_inline]] inline void rescale(LaneTaylor<V>& y, LaneTaylor<V>& f) {
    const V scale = rescaling(y.value, f.value);
    y = {y.value * scale, y.slope * scale, y.curvature * scale};
    f = {f.value * scale, f.slope * scale, f.curvature * scale};
}

}  // namespace detail

}  // namespace revchain::pencil
