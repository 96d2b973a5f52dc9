// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/batch/block.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

namespace detail {

/// The relative step at which Laguerre's iteration ends. The remaining error is about its cube.
inline constexpr double last_step = 2e-4;

/// Returns the square root to a relative 1e-10: a first guess from the exponent, three Newton steps
/// for 1/sqrt. The built-in function is not vectorised if it must set errno. Precondition: x
/// normal, or 0.
template <class V>
[[gnu::always_inline]] inline V rough_sqrt(const V& x) {
    V r = rough_inverse_root(x);
    const V half = x * V(0.5);
    r = r * (V(1.5) - half * r * r);
    r = r * (V(1.5) - half * r * r);
    r = r * (V(1.5) - half * r * r);
    return x * r;
}

/// Returns y at the support with its derivatives, times a power of two.
template <class V, class Links>
[[gnu::always_inline]] inline LaneTaylor<V> taylor(const Links& links, const V& x) {
    LaneTaylor<V> y{V(1.0), V(0.0), V(0.0)}, f{V(0.0), V(0.0), V(0.0)};
    for (std::ptrdiff_t m = 0; m < links.size(); ++m) {
        links.rise(m, x, y, f);
        if (rescaled_after(m)) rescale(y, f);
    }
    return y;
}

/// Returns the number of modes below x (Sturm): changes of sign of y from pin to pin.
template <class V, class Links>
[[gnu::always_inline]] inline typename V::Mask modes_below(const Links& links, const V& x) {
    V y(1.0), f(0.0);
    typename V::Mask changes{};
    for (std::ptrdiff_t m = 0; m < links.size(); ++m) {
        const V below = y;
        links.rise(m, x, y, f);
        changes += differ_in_sign(below, y);
        if (rescaled_after(m)) rescale(y, f);
    }
    return changes;
}

/// Returns Laguerre's step to the next of `left` zeros. From below all, it never passes the first.
template <class V>
[[gnu::always_inline]] inline V laguerre_step(const V& value, const V& slope, const V& square,
                                              std::ptrdiff_t left) {
    const V n(static_cast<double>(left)), rest(static_cast<double>(left - 1));
    V under = rest * square;
    under = select(under < V(0.0), V(0.0), under);
    const V root = rough_sqrt(under);
    const V step = n * value / (slope + select(slope < V(0.0), -root, root));
    return select(abs(step) < V(0x1p1000), step, V(0.0));  // 0 where x is the zero
}

/// Returns c[0] + ... + c[degree] x^degree's zero above `from`, to about 1e-10. Divides it out.
template <class V>
[[gnu::always_inline]] inline V next_zero(V* c, std::ptrdiff_t degree, const V& from) {
    V x = from;
    typename V::Mask active(-1);
    for (int round = 0; round < 12 && any(active); ++round) {
        V value = c[degree], slope(0.0), curvature(0.0);
        for (std::ptrdiff_t j = degree; j-- > 0;) {
            curvature = curvature * x + slope;
            slope = slope * x + value;
            value = value * x + c[j];
        }
        const V n(static_cast<double>(degree)), rest(static_cast<double>(degree - 1));
        const V step = laguerre_step(
            value, slope, rest * (slope * slope) - (n + n) * (value * curvature), degree);
        x = select(active, x - step, x);
        active = active & (V(last_step) * abs(x) < abs(step));  // the error is about its cube
    }
    V carried = c[degree];
    for (std::ptrdiff_t j = degree; j-- > 0;) {
        const V old = c[j];
        c[j] = carried;
        carried = carried * x + old;
    }
    return x;
}

/// Returns a point above the last known zero, far enough to divide it out, but by count below the
/// next.
template <class V, class Links>
[[gnu::always_inline]] inline V between_zeros(const Links& links, const double* known,
                                              std::ptrdiff_t count) {
    if (count == 0) return V(0.0);
    const V last = V::load(known + (count - 1) * block_lanes);
    V ahead = last * V(0x1p-3);
    if (count > 1) {
        const V gap = last - V::load(known + (count - 2) * block_lanes);
        ahead = select(ahead < gap, gap, ahead);
    }
    typename V::Mask active(-1);
    V x = last;
    for (int round = 0; round < 4 && any(active); ++round) {
        ahead = ahead * V(0x1p-7);
        x = select(active, last + ahead, x);
        active = active & (modes_below(links, x) > typename V::Mask(count));
    }
    return x;
}

/// Returns the next zero by the recurrence, with the `count` zeros in `known` divided out.
template <class V, class Links>
[[gnu::always_inline]] inline V next_zero(const Links& links, const double* known,
                                          std::ptrdiff_t count) {
    const std::ptrdiff_t left = links.size() - count;
    V x = between_zeros<V>(links, known, count);
    typename V::Mask active(-1);
    for (int round = 0; round < 40 && any(active); ++round) {
        const LaneTaylor<V> p = taylor(links, x);
        const V over = V(1.0) / p.value;
        V slope = p.slope * over;
        V square = slope * slope - V(2.0) * (p.curvature * over);
        for (std::ptrdiff_t j = 0; j < count; ++j) {
            const V pole = V(1.0) / (x - V::load(known + j * block_lanes));
            slope = slope - pole;
            square = square - pole * pole;
        }
        const V n(static_cast<double>(left));
        const V step = laguerre_step(V(1.0), slope, n * square - slope * slope, left);
        x = select(active, x - step, x);
        active = active & (V(1e-6) * abs(x) < abs(step));
    }
    return x;
}

}  // namespace detail

}  // namespace revchain::pencil
