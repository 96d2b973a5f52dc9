// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/linalg/spectrum_pins.hpp"

namespace revchain::linalg::spectrum {

/// A polynomial on [-1, 1] by its Chebyshev coefficients.
class Chebyshev {
   public:
    /// From values at node(i), whose number is a multiple of `width`.
    explicit Chebyshev(const std::vector<double>& values) : coefficient_(values.size()) {
        const std::size_t n = values.size();
        std::vector<Pack> twice(n / width), now(n / width), before(n / width);  // value times T_k, T_{k-1}
        for (std::size_t i = 0; i < n; ++i) {
            const double x = node(i, n);
            twice[i / width][i % width] = 2 * x;
            now[i / width][i % width] = values[i];
            before[i / width][i % width] = x * values[i];
        }
        for (std::size_t k = 0; k < n; ++k) {
            Pack sum{};
            for (std::size_t p = 0; p < n / width; ++p) {
                sum += now[p];
                const Pack next = twice[p] * now[p] - before[p];
                before[p] = now[p], now[p] = next;
            }
            double total = 0;
            for (std::size_t i = 0; i < width; ++i) total += sum[i];
            coefficient_[k] = total * (k == 0 ? 1.0 : 2.0) / static_cast<double>(n);
        }
    }
    static double node(std::size_t i, std::size_t n) {
        return std::cos((static_cast<double>(i) + 0.5) * M_PI / static_cast<double>(n));
    }
    /// Value and derivative (Clenshaw).
    void at(Pack x, Pack& value, Pack& slope) const {
        const Pack twice = x + x;
        Pack b1{}, b2{}, d1{}, d2{};
        for (std::size_t k = coefficient_.size(); k-- > 1;) {
            const Pack d = twice * d1 - d2 + 2.0 * b1;
            d2 = d1, d1 = d;
            const Pack b = twice * b1 - b2 + coefficient_[k];
            b2 = b1, b1 = b;
        }
        value = x * b1 - b2 + coefficient_[0];
        slope = b1 + x * d1 - d2;
    }
    Pack at(Pack x) const {
        const Pack twice = x + x;
        Pack b1{}, b2{};
        for (std::size_t k = coefficient_.size(); k-- > 1;) {
            const Pack b = twice * b1 - b2 + coefficient_[k];
            b2 = b1, b1 = b;
        }
        return x * b1 - b2 + coefficient_[0];
    }

    const std::vector<double>& coefficients() const { return coefficient_; }

   private:
    std::vector<double> coefficient_;
};

/// Zeros between `low` and `high`, where `p` has different signs: Newton's steps, halves where they leave the bracket.
inline std::vector<double> refined(const Chebyshev& p, const std::vector<double>& low,
                                   const std::vector<double>& high) {
    std::vector<double> root(low.size());
    for (std::size_t begin = 0; begin < low.size(); begin += width) {
        Pack a{}, b{}, value, slope;
        for (std::size_t j = 0; j < width; ++j) {
            const std::size_t i = std::min(begin + j, low.size() - 1);
            a[j] = low[i], b[j] = high[i];
        }
        const Pack left = p.at(a), right = p.at(b);
        Pack at = a + (b - a) * (left / (left - right));
        for (int step = 0; step < 60; ++step) {
            p.at(at, value, slope);
            const Mask same = ~((value < 0.0) ^ (left < 0.0));
            a = same ? at : a;
            b = same ? b : at;
            const Pack newton = at - value / slope;
            const Pack next = (newton >= a) & (newton <= b) ? newton : 0.5 * (a + b);
            const Pack change = magnitude(next - at);
            at = next;
            if (!any(change > 1e-9)) break;  // the next would be its square
        }
        for (std::size_t j = 0; j < width && begin + j < low.size(); ++j) root[begin + j] = at[j];
    }
    return root;
}

/// The zeros of `p` besides `known` in (a, b), where |q|, q = p/product of (x - known), has a least value: a pair.
inline void find_pair(const Chebyshev& p, double a, double b, std::vector<double>& known) {
    const std::size_t count = known.size();
    struct Point {
        bool negative;
        double slope;  // q'/q
    };
    const auto at = [&](double x) {
        Pack value, derivative;
        p.at(filled(x), value, derivative);
        bool negative = value[0] < 0;
        double slope = derivative[0] / value[0];
        for (std::size_t i = 0; i < count; ++i) negative ^= x < known[i], slope -= 1 / (x - known[i]);
        return Point{negative, slope};
    };
    const Point left = at(a), right = at(b);
    if (left.negative != right.negative || !(left.slope < 0) || !(right.slope > 0)) return;
    double low = a, high = b;
    for (int step = 0; step < 50; ++step) {
        const double middle = low + (high - low) / 2;
        const Point q = at(middle);
        if (q.negative == left.negative) {
            (q.slope < 0 ? low : high) = middle;
            continue;
        }
        for (const double end : {a, b}) {
            double same = end, other = middle, x = (end + middle) / 2;
            for (int newton = 0; newton < 60; ++newton) {
                const Point here = at(x);
                (here.negative == left.negative ? same : other) = x;
                double next = x - 1 / here.slope;
                if (!(next > std::min(same, other) && next < std::max(same, other))) next = (same + other) / 2;
                const double change = std::abs(next - x);
                x = next;
                if (change < 1e-13) break;
            }
            known.push_back(x);
        }
        return;
    }
}

/// All zeros of the polynomial on [-1, 1] if there are `count` of them, ascending; else what was found.
inline std::vector<double> zeros(const Chebyshev& p, Index count) {
    const std::size_t points = (static_cast<std::size_t>(8 * count + 8) + width - 1) / width * width;
    std::vector<double> x(points), f(points), low, high;
    for (std::size_t i = 0; i < points; i += width) {
        Pack at{};
        for (std::size_t j = 0; j < width; ++j)
            at[j] = x[i + j] = -std::cos(static_cast<double>(i + j) * M_PI / static_cast<double>(points - 1));
        const Pack value = p.at(at);
        for (std::size_t j = 0; j < width; ++j) f[i + j] = value[j];
    }
    for (std::size_t i = 1; i < points; ++i)
        if ((f[i - 1] < 0) != (f[i] < 0)) low.push_back(x[i - 1]), high.push_back(x[i]);
    std::vector<double> root = refined(p, low, high);
    for (std::size_t before = points; before != root.size() && static_cast<Index>(root.size()) < count;) {
        before = root.size();
        for (std::size_t i = 0; i < points; i += width) {  // the logarithmic slope, without the zeros known
            Pack at, value, slope;
            for (std::size_t j = 0; j < width; ++j) at[j] = x[i + j];
            p.at(at, value, slope);
            slope = slope / value;
            for (const double known : root) slope -= 1.0 / (at - known);
            for (std::size_t j = 0; j < width; ++j) f[i + j] = slope[j];
        }
        for (std::size_t i = 1; i < points && static_cast<Index>(root.size()) < count; ++i)
            if (f[i - 1] < 0 && f[i] > 0) find_pair(p, x[i - 1], x[i], root);
    }
    std::sort(root.begin(), root.end());
    return root;
}

}  // namespace revchain::linalg::spectrum
