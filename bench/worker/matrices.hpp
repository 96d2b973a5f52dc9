// SPDX-License-Identifier: MPL-2.0
// The matrices that peers start from, from the raw weights; lengths are 1. Weights hung below a link are summed in
// long double: what a peer gets wrong is then its own doing, or assembly's.
#pragma once

#include <cmath>

#include "worker/raw_chain.hpp"

namespace bench {

/// Stiffness of every link: plummets k = S (own weight included), rods k = W/2 + S (below).
inline std::vector<double> stiffness(const RawChain& chain) {
    std::vector<double> k(chain.size());
    long double below = 0;
    for (std::size_t m = 0; m < chain.size(); ++m) {
        const long double w = chain.weight[m];
        k[m] = static_cast<double>(below + (chain.rods ? w / 2 : w));
        below += w;
    }
    return k;
}

/// Diagonal and off-diagonal.
struct Tridiagonal {
    std::vector<double> diagonal, off;
};

/// Plummets: T = M^-1/2 K M^-1/2, whose eigenvalues are 1/lambda.
inline Tridiagonal standard_form(const RawChain& chain) {
    const std::vector<double> k = stiffness(chain);
    const std::size_t n = chain.size();
    Tridiagonal t{std::vector<double>(n), std::vector<double>(n)};  // one spare off-diagonal: LAPACK wants it
    for (std::size_t m = 0; m < n; ++m) {
        t.diagonal[m] = (k[m] + (m > 0 ? k[m - 1] : 0)) / chain.weight[m];
        if (m + 1 < n) t.off[m] = -k[m] / std::sqrt(chain.weight[m] * chain.weight[m + 1]);
    }
    return t;
}

/// Plummets: the exact Cholesky factor of T. K is the sum of k (e_m - e_{m+1})(e_m - e_{m+1})^T (a Stieltjes string),
/// so T = B B^T with B bidiagonal: sqrt(k_m / W_m) on the diagonal and -sqrt(k_m / W_{m+1}) below it; no entry is a
/// difference. Singular values are 1/sqrt(lambda).
inline Tridiagonal cholesky_factor(const RawChain& chain) {
    const std::vector<double> k = stiffness(chain);
    const std::size_t n = chain.size();
    Tridiagonal b{std::vector<double>(n), std::vector<double>(n)};
    for (std::size_t m = 0; m < n; ++m) {
        b.diagonal[m] = std::sqrt(k[m] / chain.weight[m]);
        if (m + 1 < n) b.off[m] = -std::sqrt(k[m] / chain.weight[m + 1]);
    }
    return b;
}

/// Any of the chains: K and M assembled, both tridiagonal.
struct Pencil {
    Tridiagonal stiffness, mass;
};

inline Pencil assembled(const RawChain& chain) {
    const std::vector<double> k = stiffness(chain);
    const std::size_t n = chain.size();
    Pencil p{{std::vector<double>(n), std::vector<double>(n)}, {std::vector<double>(n), std::vector<double>(n)}};
    const double lower = chain.rods ? 1.0 / 3 : 1, upper = chain.rods ? 1.0 / 3 : 0, cross = chain.rods ? 1.0 / 6 : 0;
    for (std::size_t m = 0; m < n; ++m) {
        p.stiffness.diagonal[m] = k[m] + (m > 0 ? k[m - 1] : 0);
        p.stiffness.off[m] = -k[m];
        p.mass.diagonal[m] = lower * chain.weight[m] + (m > 0 ? upper * chain.weight[m - 1] : 0);
        p.mass.off[m] = cross * chain.weight[m];
    }
    return p;
}

}  // namespace bench
