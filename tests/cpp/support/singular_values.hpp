// SPDX-License-Identifier: MPL-2.0
// Conical heights of small chains by a road that shares nothing with the library's: the angles of the links as
// coordinates, in which the stiffness is diagonal and the inertia is F^T F, F dense with one row for each square of the
// kinetic energy; heights are the squared singular values of F K^(-1/2), to the full relative accuracy of quadruple
// precision times the condition of F once the weights are taken out of its rows and the lengths out of its columns.
// Householder QR with complete pivoting, then one-sided Jacobi on R^T: Drmac, Veselic (2008), doi:10.1137/050639193;
// Demmel et al. (1999), doi:10.1016/S0024-3795(99)00134-2.
#pragma once

#include <algorithm>
#include <vector>

#include "support/truth.hpp"

namespace support {

namespace detail {

using Rows = std::vector<std::vector<Quad>>;

/// Upper triangle of QR with complete pivoting; rows beyond it are left as they are.
inline void triangulate(Rows& rows) {
    const std::size_t n = rows[0].size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t best = k;
        Quad largest = -1;
        for (std::size_t j = k; j < n; ++j) {
            Quad norm = 0;
            for (std::size_t i = k; i < rows.size(); ++i) norm = fmaxq(norm, fabsq(rows[i][j]));
            if (norm > largest) largest = norm, best = j;
        }
        if (!(largest > 0)) return;
        for (auto& row : rows) std::swap(row[k], row[best]);
        std::size_t pivot = k;
        for (std::size_t i = k; i < rows.size(); ++i)
            if (fabsq(rows[i][k]) > fabsq(rows[pivot][k])) pivot = i;
        std::swap(rows[k], rows[pivot]);
        Quad norm2 = 0;  // relative to the pivot
        for (std::size_t i = k; i < rows.size(); ++i) norm2 += (rows[i][k] / rows[k][k]) * (rows[i][k] / rows[k][k]);
        const Quad norm = sqrtq(norm2);
        std::vector<Quad> v(rows.size(), 0);  // reflector, v[k] = 1 + norm in units of the pivot
        for (std::size_t i = k; i < rows.size(); ++i) v[i] = rows[i][k] / rows[k][k];
        v[k] += norm;
        const Quad half = norm * v[k];  // v^T v / 2
        for (std::size_t j = k; j < n; ++j) {
            Quad dot = 0;
            for (std::size_t i = k; i < rows.size(); ++i) dot += v[i] * rows[i][j];
            for (std::size_t i = k; i < rows.size(); ++i) rows[i][j] -= v[i] * (dot / half);
        }
        for (std::size_t i = k + 1; i < rows.size(); ++i) rows[i][k] = 0;
    }
}

/// Squared singular values, descending, of a matrix given by its rows, by rotations among them.
inline std::vector<Quad> squared_singular_values(Rows rows) {
    const auto dot = [](const std::vector<Quad>& x, const std::vector<Quad>& y) {
        Quad sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
        return sum;
    };
    for (int sweep = 0; sweep < 60; ++sweep) {
        bool turned = false;
        for (std::size_t p = 0; p < rows.size(); ++p)
            for (std::size_t q = p + 1; q < rows.size(); ++q) {
                const Quad a = dot(rows[p], rows[p]), b = dot(rows[q], rows[q]), c = dot(rows[p], rows[q]);
                if (fabsq(c) <= Quad(1e-33) * sqrtq(a) * sqrtq(b)) continue;
                turned = true;
                const Quad zeta = (b - a) / (2 * c);
                const Quad t = (zeta < 0 ? Quad(-1) : Quad(1)) / (fabsq(zeta) + hypotq(1, zeta));
                const Quad cosine = 1 / hypotq(1, t), sine = cosine * t;
                for (std::size_t i = 0; i < rows[p].size(); ++i) {
                    const Quad x = rows[p][i], y = rows[q][i];
                    rows[p][i] = cosine * x - sine * y;
                    rows[q][i] = sine * x + cosine * y;
                }
            }
        if (!turned) break;
    }
    std::vector<Quad> values;
    for (const auto& row : rows) values.push_back(dot(row, row));
    std::sort(values.begin(), values.end(), [](Quad x, Quad y) { return x > y; });
    return values;
}

}  // namespace detail

/// All conical heights, descending; coordinates without inertia give 0 or what rounding makes of it.
template <class T>
std::vector<Quad> heights_by_singular_values(const revchain::Chain<T>& chain) {
    const std::size_t n = static_cast<std::size_t>(chain.size());
    detail::Rows rows(2 * n, std::vector<Quad>(n, 0));
    std::vector<Quad> root(n);  // of kappa = W h + a S, the stiffness of an angle
    Quad below = 0;
    for (std::size_t m = 0; m < n; ++m) {
        const auto link = chain.link(static_cast<revchain::Index>(m));
        const Quad W = quad(link.weight), a = quad(link.length), h = quad(link.centroid);
        root[m] = sqrtq(W * h + a * below);
        below += W;
        rows[2 * m][m] = sqrtq(W) * h;
        rows[2 * m + 1][m] = sqrtq(W) * sqrtq(quad(link.gyration_ratio)) * a;
        for (std::size_t above = m + 1; above < n; ++above)
            rows[2 * m][above] = sqrtq(W) * quad(chain.link(static_cast<revchain::Index>(above)).length);
    }
    for (auto& row : rows)
        for (std::size_t m = 0; m < n; ++m) row[m] /= root[m];
    detail::triangulate(rows);
    rows.resize(n);
    return detail::squared_singular_values(std::move(rows));
}

}  // namespace support
