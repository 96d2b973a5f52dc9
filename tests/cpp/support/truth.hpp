// SPDX-License-Identifier: MPL-2.0
// The truth that heights are measured against: quadruple precision (113 bits) and a formulation that shares nothing
// with the library's: the pencil assembled into two tridiagonal matrices, textbook LDL^T pivots. Assembly costs that
// formulation up to the ratio of the largest height to the one asked, which leaves 1e-20 or better for the chains of the
// tests; for chains at the limits of a scalar take a closed form instead.
#pragma once

#include <quadmath.h>

#include <vector>

#include "revchain/chain.hpp"

namespace support {

using Quad = __float128;

template <std::floating_point T>
Quad quad(const T& x) {
    return x;
}
template <std::floating_point T>
Quad quad(const revchain::DoubleWord<T>& x) {
    return Quad(x.high) + Quad(x.low);
}

/// K and M of a chain in quadruple precision, tridiagonal: diagonal [0], upper diagonal [1].
class Truth {
   public:
    template <class T>
    explicit Truth(const revchain::Chain<T>& chain) {
        const std::size_t n = static_cast<std::size_t>(chain.size());
        for (auto* v : {&k0_, &k1_, &m0_, &m1_}) v->assign(n, 0);
        Quad below = 0;
        for (std::size_t m = 0; m < n; ++m) {
            const revchain::Link<T> link = chain.link(static_cast<revchain::Index>(m));
            const Quad W = quad(link.weight), a = quad(link.length), h = quad(link.centroid);
            const Quad turn = quad(link.gyration_ratio);
            const Quad k = (W * h + a * below) / (a * a);
            const Quad y_lower = h / a, y_upper = (a - h) / a;
            below += W;
            k0_[m] += k;
            m0_[m] += W * (y_lower * y_lower + turn);
            if (m + 1 == n) break;
            k1_[m] -= k;
            m1_[m] += W * (y_lower * y_upper - turn);
            k0_[m + 1] += k;
            m0_[m + 1] += W * (y_upper * y_upper + turn);
        }
    }

    /// How many conical heights exceed `height`.
    revchain::Index above(Quad height) const {
        revchain::Index negative = 0;
        Quad pivot = 0;
        for (std::size_t m = 0; m < k0_.size(); ++m) {
            const Quad off = m == 0 ? Quad(0) : height * k1_[m - 1] - m1_[m - 1];
            const Quad before = pivot == 0 ? Quad(1e-300) : pivot;
            pivot = height * k0_[m] - m0_[m] - (m == 0 ? Quad(0) : off * off / before);
            if (pivot < 0) ++negative;
        }
        return negative;
    }

    /// Height number j (from 0, descending), bisected between two heights that enclose it.
    Quad height(revchain::Index j, Quad lower, Quad upper, Quad relative_width = 1e-22) const {
        while (upper - lower > relative_width * lower) {
            const Quad middle = lower + (upper - lower) / 2;
            (above(middle) > j ? lower : upper) = middle;
        }
        return lower + (upper - lower) / 2;
    }

    /// Residual max |(lambda K - M) y| relative to max (|lambda K| |y| + |M| |y|), all in quadruple precision.
    template <class Offsets>
    double residual(Quad height, const Offsets& y) const {
        const std::size_t n = k0_.size();
        Quad worst = 0, largest = 0;
        for (std::size_t m = 0; m < n; ++m) {
            Quad sum = 0, size = 0;
            const auto add = [&](Quad k, Quad mass, std::size_t i) {
                const Quad offset = Quad(y[static_cast<revchain::Index>(i)]);
                sum += (height * k - mass) * offset;
                size += (fabsq(height * k) + fabsq(mass)) * fabsq(offset);
            };
            if (m > 0) add(k1_[m - 1], m1_[m - 1], m - 1);
            add(k0_[m], m0_[m], m);
            if (m + 1 < n) add(k1_[m], m1_[m], m + 1);
            worst = fmaxq(worst, fabsq(sum));
            largest = fmaxq(largest, size);
        }
        return static_cast<double>(worst / largest);
    }

    /// Eigenvector at a height known in quadruple precision, largest |offset| = 1, free end positive: ratios from both
    /// ends joined where the mode is largest.
    std::vector<Quad> shape(Quad height) const {
        const std::size_t n = k0_.size();
        std::vector<Quad> up(n), down(n);
        const auto diagonal = [&](std::size_t m) { return height * k0_[m] - m0_[m]; };
        const auto off = [&](std::size_t m) { return height * k1_[m] - m1_[m]; };
        up[0] = diagonal(0);
        for (std::size_t m = 1; m < n; ++m) up[m] = diagonal(m) - off(m - 1) * off(m - 1) / up[m - 1];
        down[n - 1] = diagonal(n - 1);
        for (std::size_t m = n - 1; m-- > 0;) down[m] = diagonal(m) - off(m) * off(m) / down[m + 1];
        std::size_t twist = 0;
        Quad least = -1;
        for (std::size_t m = 0; m < n; ++m) {
            const Quad balance = fabsq(up[m] + down[m] - diagonal(m));
            if (least < 0 || balance < least) least = balance, twist = m;
        }
        std::vector<Quad> y(n + 1, 0);
        y[twist] = 1;
        for (std::size_t m = twist; m-- > 0;) y[m] = -off(m) * y[m + 1] / up[m];
        for (std::size_t m = twist + 1; m < n; ++m) y[m] = -off(m - 1) * y[m - 1] / down[m];
        Quad largest = 0;
        for (const Quad& v : y) largest = fmaxq(largest, fabsq(v));
        if (y[0] < 0) largest = -largest;
        for (Quad& v : y) v /= largest;
        return y;
    }

   private:
    std::vector<Quad> k0_, k1_, m0_, m1_;
};

}  // namespace support
