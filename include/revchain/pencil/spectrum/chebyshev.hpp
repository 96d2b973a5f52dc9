// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "revchain/numeric/scalar.hpp"
#include "revchain/simd/pack.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil::spectrum {

/// A polynomial on [-1, 1] by its Chebyshev coefficients.
struct Chebyshev {
    std::vector<double> coefficient;

    static double node(std::size_t i, std::size_t n) {
        return std::cos((static_cast<double>(i) + 0.5) * M_PI / static_cast<double>(n));
    }
    /// Computes value and derivative at x (Clenshaw).
    template <class V>
    [[gnu::always_inline]] void at(const V& x, V& value, V& slope) const {
        const V twice = x + x;
        V b1, b2, d1, d2;
        for (std::size_t k = coefficient.size(); k-- > 1;) {
            const V d = twice * d1 + ((b1 + b1) - d2);
            d2 = d1, d1 = d;
            const V b = twice * b1 + (coefficient[k] - b2);
            b2 = b1, b1 = b;
        }
        value = x * b1 + (coefficient[0] - b2);
        slope = b1 + (x * d1 - d2);
    }
    template <class V>
    [[gnu::always_inline]] V at(const V& x) const {
        const V twice = x + x;
        V b1, b2;
        for (std::size_t k = coefficient.size(); k-- > 1;) {
            const V b = twice * b1 + (coefficient[k] - b2);
            b2 = b1, b1 = b;
        }
        return x * b1 + (coefficient[0] - b2);
    }
};

/// Returns `V::size` of the numbers x from `begin` on, padded with the last number.
template <class V>
[[gnu::always_inline]] inline V part(const std::vector<double>& x, std::size_t begin) {
    if (begin + V::size <= x.size()) return V::load(&x[begin]);
    alignas(V) double numbers[V::size];
    for (std::size_t i = 0; i < V::size; ++i) numbers[i] = x[std::min(begin + i, x.size() - 1)];
    return V::load(numbers);
}

/// Returns the polynomial of degree n - 1 with these n values at node(i, n).
template <class V>
[[gnu::always_inline]] inline Chebyshev interpolant(const std::vector<double>& values) {
    const std::size_t n = values.size(), padded = (n + V::size - 1) / V::size * V::size;
    std::vector<double> twice(padded), now(padded), before(padded);  // value times T_k, T_{k-1}
    for (std::size_t i = 0; i < n; ++i) {
        const double x = Chebyshev::node(i, n);
        twice[i] = 2 * x;
        now[i] = values[i];
        before[i] = x * values[i];
    }
    Chebyshev p;
    for (std::size_t k = 0; k < n; ++k) {
        V sum;
        for (std::size_t i = 0; i < padded; i += V::size) {
            const V t = V::load(&now[i]);
            sum += t;
            (V::load(&twice[i]) * t - V::load(&before[i])).store(&now[i]);
            t.store(&before[i]);
        }
        double total = 0;
        for (std::size_t i = 0; i < V::size; ++i) total += sum[i];
        p.coefficient.push_back(total * (k == 0 ? 1.0 : 2.0) / static_cast<double>(n));
    }
    return p;
}

/// Computes the value and q'/q of q = p/product of (x - known), the value up to a positive factor.
template <class V>
[[gnu::always_inline]] inline void deflated(const Chebyshev& p, const std::vector<double>& known,
                                            const V& x, V& value, V& slope) {
    p.at(x, value, slope);
    slope = slope / value;
    for (const double zero : known) {
        const V distance = x - zero;
        slope -= 1.0 / distance;
        value = if_less(distance, V(0.0), -value, value);
    }
}

/// Returns the zeros of p besides `known` between `low` and `high`, where p/product of (x - known)
/// has different signs. Newton's steps or halves continue until a step is below `precision`.
template <class V>
[[gnu::always_inline]] inline std::vector<double> refined(const Chebyshev& p,
                                                          const std::vector<double>& known,
                                                          const std::vector<double>& low,
                                                          const std::vector<double>& high,
                                                          double precision) {
    std::vector<double> root(low.size());
    for (std::size_t begin = 0; begin < low.size(); begin += V::size) {
        V a = part<V>(low, begin), b = part<V>(high, begin), left, value, slope;
        deflated(p, known, a, left, slope);
        V x = 0.5 * (a + b);
        if (known.empty()) x = a + (b - a) * (left / (left - p.at(b)));
        for (int step = 0; step < 60; ++step) {
            deflated(p, known, x, value, slope);
            const auto same = differ_in_sign(value, left) == typename V::Mask(0);
            a = select(same, x, a);
            b = select(same, b, x);
            const V newton = x - 1.0 / slope;
            const V next =
                select((newton < a) | (newton > b) | ~equal(newton, newton), 0.5 * (a + b), newton);
            const V change = abs(next - x);
            x = next;
            if (!any(change > precision)) break;
        }
        for (std::size_t j = 0; j < V::size && begin + j < low.size(); ++j) root[begin + j] = x[j];
    }
    return root;
}

/// Returns a point in (a, b), next to a minimum of |q|, where q = p/product of (x - known) has the
/// other sign than at both ends; NaN if there is none. Cuts intervals into V::size + 1 at a time.
template <class V>
[[gnu::always_inline]] inline double between_pair(const Chebyshev& p,
                                                  const std::vector<double>& known, double a,
                                                  double b) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    V x, value, slope;
    for (std::size_t i = 0; i < V::size; ++i) x.set(i, i == 0 ? a : b);
    deflated(p, known, x, value, slope);
    const bool sign = std::signbit(value[0]);
    if (sign != std::signbit(value[1]) || !(slope[0] < 0) || !(slope[1] > 0)) return none;
    while (b - a > 0x1p-50) {
        const double step = (b - a) / static_cast<double>(V::size + 1);
        for (std::size_t i = 0; i < V::size; ++i) x.set(i, a + step * static_cast<double>(i + 1));
        deflated(p, known, x, value, slope);
        for (std::size_t i = 0; i < V::size; ++i)
            if (std::signbit(value[i]) != sign) return x[i];
        std::size_t i = 0;
        while (i < V::size && slope[i] < 0) ++i;
        if (i > 0) a = x[i - 1];
        if (i < V::size) b = x[i];
    }
    return none;
}

/// Returns, ascending, all zeros of the polynomial on [-1, 1] if there are `count`, else some.
template <class V>
[[gnu::always_inline]] inline std::vector<double> zeros(const Chebyshev& p, Index count) {
    const std::size_t points =
        (static_cast<std::size_t>(8 * count + 8) + V::size - 1) / V::size * V::size;
    std::vector<double> x(points), f(points), low, high;
    for (std::size_t i = 0; i < points; ++i)
        x[i] = -std::cos(static_cast<double>(i) * M_PI / static_cast<double>(points - 1));
    for (std::size_t i = 0; i < points; i += V::size) p.at(V::load(&x[i])).store(&f[i]);
    for (std::size_t i = 1; i < points; ++i)
        if ((f[i - 1] < 0) != (f[i] < 0)) low.push_back(x[i - 1]), high.push_back(x[i]);
    std::vector<double> root = refined<V>(p, {}, low, high, 1e-9);
    for (bool more = true; more && static_cast<Index>(root.size()) < count;) {
        for (std::size_t i = 0; i < points; i += V::size) {  // logarithmic slopes, deflated
            V value, slope;
            deflated(p, root, V::load(&x[i]), value, slope);
            slope.store(&f[i]);
        }
        low.clear(), high.clear();
        for (std::size_t i = 1; i < points && static_cast<Index>(root.size() + low.size()) < count;
             ++i) {
            if (!(f[i - 1] < 0 && f[i] > 0)) continue;
            const double middle = between_pair<V>(p, root, x[i - 1], x[i]);
            if (std::isnan(middle)) continue;
            low.insert(low.end(), {x[i - 1], middle});
            high.insert(high.end(), {middle, x[i]});
        }
        const auto pairs = refined<V>(p, root, low, high, 1e-13);
        root.insert(root.end(), pairs.begin(), pairs.end());
        more = !pairs.empty();
    }
    std::sort(root.begin(), root.end());
    return root;
}

/// Returns true if last coefficients show each root to 1/1000 of its distance to the next.
template <class V>
[[gnu::always_inline]] inline bool certain(const Chebyshev& p, const std::vector<double>& root) {
    double noise = 0;
    for (const double c : p.coefficient) noise = std::max(noise, 1e-14 * std::abs(c));
    for (std::size_t k = p.coefficient.size() - 4; k < p.coefficient.size(); ++k)
        noise = std::max(noise, std::abs(p.coefficient[k]));
    V value, slope;
    for (std::size_t i = 0; i < root.size(); ++i) {
        if (i % V::size == 0) p.at(part<V>(root, i), value, slope);
        const double below = i > 0 ? root[i] - root[i - 1] : 1.0;
        const double above = i + 1 < root.size() ? root[i + 1] - root[i] : 1.0;
        if (!(noise < 1e-3 * std::min(below, above) * std::abs(slope[i % V::size]))) return false;
    }
    return true;
}

}  // namespace revchain::pencil::spectrum
