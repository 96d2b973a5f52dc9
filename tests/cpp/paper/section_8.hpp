// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §8, its moments and relations coded by hand from the corrected text, in quadruple precision. Links and
// pins are numbered as in the paper: link m joins P_m (upper) and P_{m-1}. lambda and sec delta_m occur in them as
// lambda sec delta_m alone: one set of functions serves small and finite inclinations.
#pragma once

#include "paper.hpp"

namespace paper::section_8 {

using Letterses = std::vector<Letters>;  // [1] the lowest link
using Offsets = std::vector<Quad>;       // [0] the free end

/// lambda sec delta_m of every link, [1] the lowest; of one number: lambda, all links being nearly vertical.
class Slants {
   public:
    Slants(Quad lambda) : same_(lambda) {}  // NOLINT(google-explicit-constructor)
    explicit Slants(std::vector<Quad> own) : own_(std::move(own)) {}
    Quad operator[](std::size_t m) const { return own_.empty() ? same_ : own_[m]; }

   private:
    Quad same_ = 0;
    std::vector<Quad> own_;
};

/// A sum that remembers the size of its terms, and of its coefficients.
struct Balance {
    Quad sum = 0, size = 0, coefficients = 0;
    void add(Quad coefficient, Quad offset) {
        sum += coefficient * offset;
        size += fabsq(coefficient * offset);
        coefficients += fabsq(coefficient);
    }
};

inline std::size_t at(Index m) { return static_cast<std::size_t>(m); }

// (7): moment about P_m of link m's own centrifugal force and weight.
inline Quad own_moment(const Letterses& link, Index m, const Slants& slant, const Offsets& y) {
    const auto [W, a, h, l, rho2] = link[at(m)];
    return W * h / slant[at(m)] * (y[at(m)] - (slant[at(m)] - l) / a * (y[at(m - 1)] - y[at(m)]));
}

// (8) for link r, (9) for r = 1: moment about P_m of a link below, acting at P_{m-1}.
inline Quad moment_below(const Letterses& link, Index m, Index r, const Slants& slant, const Offsets& y) {
    const auto [W, a, h, l, rho2] = link[at(r)];
    const Quad lever = link[at(m)].a, drop = y[at(m - 1)] - y[at(m)];
    if (r == 1) return W * lever / slant[at(m)] * (1 + h / (slant[1] - l)) * y[1] - W * drop;
    return W * lever / slant[at(m)] * (y[at(r)] + h / a * (y[at(r - 1)] - y[at(r)])) - W * drop;
}

// (10): nothing hangs below the lowest link.
inline Balance relation_10(const Letterses& link, const Slants& slant, const Offsets& y) {
    const auto [W, a, h, l, rho2] = link[1];
    Balance b;
    b.add(W * h / a * (1 + (slant[1] - l) / a), y[1]);
    b.add(-W * h / a * (slant[1] - l) / a, y[0]);
    return b;
}

inline Balance relation_12(const Letterses& link, const Slants& slant, const Offsets& y) {
    const auto [W1, a1, h1, l1, rho1] = link[1];
    const auto [W2, a2, h2, l2, rho2] = link[2];
    Balance b;
    b.add(W1 * slant[2] / a2 + W2 * h2 / a2 * (1 + (slant[2] - l2) / a2), y[2]);
    b.add(W1 * (1 + h1 / (slant[1] - l1)) - W1 * slant[2] / a2 - W2 * h2 / a2 * (slant[2] - l2) / a2, y[1]);
    return b;
}

inline Balance relation_19(const Letterses& link, const Slants& slant, const Offsets& y) {
    const auto [W1, a1, h1, l1, rho1] = link[1];
    const auto [W2, a2, h2, l2, rho2] = link[2];
    const auto [W3, a3, h3, l3, rho3] = link[3];
    Balance b;
    b.add((W1 + W2) * slant[3] / a3 + W3 * h3 / a3 * (1 + (slant[3] - l3) / a3), y[3]);
    b.add(W2 * (1 - h2 / a2) - (W1 + W2) * slant[3] / a3 - W3 * h3 / a3 * (slant[3] - l3) / a3, y[2]);
    b.add(W1 * (1 + h1 / (slant[1] - l1)) + W2 * h2 / a2, y[1]);
    return b;
}

enum class Form {
    corrected,
    printed,   // with h_{m-2}/a_{m-1} where h_{m-2}/a_{m-2} belongs
    with_y_0,  // corrected, with (y_0 - y_1)/a_1 for y_1/(lambda sec delta_1 - l_1): of no use where that is 0
};

// (21) for m >= 3.
inline Balance relation_21(const Letterses& link, Index m, const Slants& slant, const Offsets& y,
                           Form form = Form::corrected) {
    const auto ratio = [&](Index r) { return link[at(r)].h / link[at(r)].a; };
    const auto [W, a, h, l, rho2] = link[at(m)];
    Quad below = 0;
    for (Index r = 1; r < m; ++r) below += link[at(r)].W;
    Balance b;
    b.add(below * slant[at(m)] / a + W * h / a * (1 + (slant[at(m)] - l) / a), y[at(m)]);
    b.add(link[at(m - 1)].W * (1 - ratio(m - 1)) - below * slant[at(m)] / a - W * h / a * (slant[at(m)] - l) / a,
          y[at(m - 1)]);
    for (Index r = m - 2; r >= 2; --r) {
        const Quad lower = form == Form::printed && r == m - 2 ? link[at(r)].h / link[at(m - 1)].a : ratio(r);
        b.add(link[at(r)].W * (1 - lower) + link[at(r + 1)].W * ratio(r + 1), y[at(r)]);
    }
    if (form == Form::with_y_0) {
        b.add(link[1].W * (1 - ratio(1)) + link[2].W * ratio(2), y[1]);
        b.add(link[1].W * ratio(1), y[0]);
    } else {
        b.add(link[1].W * (1 + link[1].h / (slant[1] - link[1].l)) + link[2].W * ratio(2), y[1]);
    }
    return b;
}

inline Balance relation(const Letterses& link, Index m, const Slants& slant, const Offsets& y) {
    return m == 1   ? relation_10(link, slant, y)
           : m == 2 ? relation_12(link, slant, y)
           : m == 3 ? relation_19(link, slant, y)
                    : relation_21(link, m, slant, y);
}

/// Polynomials in lambda, lowest power first.
using Polynomial = std::vector<Quad>;

inline Polynomial operator*(const Polynomial& p, const Polynomial& q) {
    Polynomial r(p.size() + q.size() - 1, 0);
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = 0; j < q.size(); ++j) r[i + j] += p[i] * q[j];
    return r;
}

inline Polynomial plus(const Polynomial& p, Quad factor, const Polynomial& q) {
    Polynomial r(std::max(p.size(), q.size()), 0);
    for (std::size_t i = 0; i < p.size(); ++i) r[i] += p[i];
    for (std::size_t j = 0; j < q.size(); ++j) r[j] += factor * q[j];
    return r;
}

/// The root near x.
inline Quad root(const Polynomial& p, Quad x) {
    for (int i = 0; i < 20; ++i) {
        Quad value = 0, derivative = 0;
        for (std::size_t j = p.size(); j-- > 0;) {
            derivative = derivative * x + value;
            value = value * x + p[j];
        }
        x -= value / derivative;
    }
    return x;
}

/// (20), its fractions cleared: for given secants of the three inclinations, index 1 the lowest, a cubic in lambda.
inline Polynomial cubic_20(const Letterses& link, const std::vector<Quad>& secant) {
    const auto [W1, a1, h1, l1, rho1] = link[1];
    const auto [W2, a2, h2, l2, rho2] = link[2];
    const auto [W3, a3, h3, l3, rho3] = link[3];
    const Polynomial u{-l1, secant[1]};                      // lambda sec delta_1 - l_1, by which they are cleared
    const Polynomial first{W1 * (h1 - l1), W1 * secant[1]};  // W_1 (1 + h_1/(lambda sec delta_1 - l_1)), cleared
    // left: -d_2/d_1 from (19); right: -c_2/c_1 from (12)
    const Polynomial d2{W2 * (1 - h2 / a2) + W3 * h3 * l3 / (a3 * a3),
                        -((W1 + W2) / a3 + W3 * h3 / (a3 * a3)) * secant[3]};
    const Polynomial d1 = plus(first, W2 * h2 / a2, u);
    const Polynomial c2{W2 * h2 / a2 * (1 - l2 / a2), (W1 / a2 + W2 * h2 / (a2 * a2)) * secant[2]};
    const Polynomial c1 =
        plus(first, 1, u * Polynomial{W2 * h2 * l2 / (a2 * a2), -(W1 / a2 + W2 * h2 / (a2 * a2)) * secant[2]});
    return plus(d2 * c1, -1, c2 * d1);
}

}  // namespace paper::section_8
