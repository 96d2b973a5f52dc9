// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/element.hpp"
#include "revchain/simd/pack.hpp"

/// This header has one pencil's stiffnesses at several x, and residual forces in twice the digits.
namespace revchain::inline REVCHAIN_BUILD::pencil {

/// Returns true if all elements are point masses at their lower pins.
template <class S, bool Spins>
bool is_lumped(const ElementPencil<S, Spins>& pencil) {
    for (const auto& e : pencil.elements)
        if (!(e.upper == S(0)) || !(e.cross == S(0)) || !(e.turning == S(0))) return false;
    return true;
}

namespace detail {

/// An unevaluated sum high + low, for sums and products whose low parts need only T's own digits.
template <class V>
struct Pair {
    V high{}, low{};
};

template <bool fused, class V, class T>
[[gnu::always_inline]] inline Pair<V> times(const DoubleWord<T>& x, const V& y) {
    const DoubleWord<V> p = two_product<fused>(V(x.high), y);
    return {p.high, p.low + V(x.low) * y};
}

template <bool fused, class V>
[[gnu::always_inline]] inline Pair<V> times(const Pair<V>& x, const DoubleWord<V>& y) {
    const DoubleWord<V> p = two_product<fused>(x.high, y.high);
    return {p.high, p.low + (x.high * y.low + x.low * y.high)};
}

template <class V>
[[gnu::always_inline]] inline Pair<V> operator+(const Pair<V>& x, const Pair<V>& y) {
    const DoubleWord<V> s = two_sum(x.high, y.high);
    return {s.high, s.low + (x.low + y.low)};
}

/// `lumped`: every element is a point mass at its lower pin. Loops are compiled for each case.
template <bool Lumped>
struct Terms {
    static constexpr bool lumped = Lumped;
};

/// Returns an element rounded to T, for loops in lanes.
template <bool Spins, class T>
[[gnu::always_inline]] inline Element<T, Spins> high_part(const Element<DoubleWord<T>, Spins>& e) {
    Element<T, Spins> high{e.stiffness.high, e.lower.high,   e.upper.high,
                           e.cross.high,     e.turning.high, e.weight};
    if constexpr (Spins) high.spin = e.spin.high;
    return high;
}

/// Computes residual forces L(x) y - M y at all pins but the held one, from the free end up.
/// `take(m, force, size, offset, stretch)` receives, for pin m, the force and the pin's offset.
/// `size` is the sum of the sizes of the force's terms, if `sized`. `stretch` is the offset minus
/// the next one.
template <bool fused, bool sized, class V, class Terms, bool Spins, class T, class Offset,
          class Take>
[[gnu::always_inline]] inline void forces_left(Terms,
                                               const ElementPencil<DoubleWord<T>, Spins>& pencil,
                                               const Factors<Pair<V>>& at, const Offset& offset,
                                               const Take& take) {
    const std::size_t n = pencil.elements.size();
    const auto product = [](const Pair<V>& x, const DoubleWord<T>& y) REVCHAIN_INLINED {
        return times<fused>(x, revchain::detail::in_all_lanes<V>(y));
    };
    Pair<V> from_below{};
    V size{}, lower = offset(0);
    for (std::size_t m = 0; m < n; ++m) {
        const auto& e = pencil.elements[m];
        const V upper = m + 1 < n ? offset(m + 1) : V{};
        Pair<V> k = product(at.stiffness, e.stiffness);
        V k_size = abs(k.high);
        if constexpr (Spins) {
            const Pair<V> spin = product(at.spin, e.spin);
            k = k + spin;
            k_size += abs(spin.high);
        }
        const DoubleWord<V> stretch = two_sum(lower, -upper);
        const Pair<V> spring = times<fused>(k, stretch);
        Pair<V> near = times<fused>(e.lower, -lower), far{};
        V near_size = abs(near.high), far_size{};
        if constexpr (!Terms::lumped) {
            const Pair<V> by_upper = times<fused>(e.cross, -upper),
                          by_lower = times<fused>(e.cross, -lower);
            far = times<fused>(e.upper, -upper);
            if constexpr (sized)
                near_size += abs(by_upper.high), far_size = abs(far.high) + abs(by_lower.high);
            near = near + by_upper;
            far = far + by_lower;
        }
        const Pair<V> left = (from_below + spring) + near;
        V spring_size{};
        if constexpr (sized) spring_size = k_size * (abs(lower) + abs(upper));
        take(m, left.high + left.low, size + (spring_size + near_size), lower, stretch.high);
        from_below = {-spring.high, -spring.low};
        if constexpr (!Terms::lumped) from_below = from_below + far;
        if constexpr (sized) size = spring_size + far_size;
        lower = upper;
    }
}

/// Returns the factors as pairs: x and 0, or x^2 and x.
template <bool fused, bool Spins, class V>
[[gnu::always_inline]] inline Factors<Pair<V>> factors_in_pairs(const V& x, const V& low) {
    if constexpr (Spins) {
        const DoubleWord<V> p = two_product<fused>(x, x),
                            square = fast_two_sum(p.high, p.low + V(Lane<V>(2)) * x * low);
        return {{square.high, square.low}, {x, low}};
    } else {
        return {{x, low}, {}};
    }
}

}  // namespace detail
}  // namespace revchain::pencil
