// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "revchain/response.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

namespace support {

using revchain::Chain;
using revchain::Index;
using revchain::Response;

/// The truth: height K - M assembled in quadruple precision, the last pin given, solved by Gaussian elimination with
/// partial pivoting, from the chain's own numbers and by none of the library's formulas.
struct QuadResponse {
    std::vector<Quad> offset;
    Quad force = 0;  ///< the pull on what carries the last pin, times height over radius
};

struct QuadSystem {
    std::vector<Quad> diagonal, off;  ///< pins 0 ... n, off-diagonal m between m and m + 1

    explicit QuadSystem(std::size_t links) : diagonal(links + 1, 0), off(links, 0) {}
    void add(std::size_t m, Quad stiffness, Quad lower, Quad cross, Quad upper) {
        diagonal[m] += stiffness - lower, diagonal[m + 1] += stiffness - upper;
        off[m] -= stiffness + cross;
    }
    QuadResponse solve() const {
        const std::size_t n = off.size();
        // Row i: columns i ... i + 2 after interchange, and the right-hand side.
        struct Row {
            Quad a[3] = {0, 0, 0};
            Quad right = 0;
        };
        std::vector<Row> rows(n);
        const auto fresh = [&](std::size_t i) {  // before elimination: its first entry in column i - 1
            Row row;
            row.a[0] = i == 0 ? Quad(0) : off[i - 1];
            row.a[1] = diagonal[i];
            row.a[2] = i + 1 < n ? off[i] : Quad(0);
            row.right = i + 1 < n ? Quad(0) : -off[i];
            Quad size = 0;  // rows of light links count as much as those of heavy ones
            for (const Quad& x : row.a) size = fmaxq(size, fabsq(x));
            for (Quad& x : row.a) x /= size;
            row.right /= size;
            return row;
        };
        Row current = fresh(0);
        current.a[0] = current.a[1], current.a[1] = current.a[2], current.a[2] = 0;
        for (std::size_t i = 0; i + 1 < n; ++i) {
            Row below = fresh(i + 1);
            if (fabsq(below.a[0]) > fabsq(current.a[0])) std::swap(current, below);
            const Quad factor = below.a[0] / current.a[0];
            rows[i] = current;
            Row next;
            next.a[0] = below.a[1] - factor * current.a[1];
            next.a[1] = below.a[2] - factor * current.a[2];
            next.right = below.right - factor * current.right;
            current = next;
        }
        rows[n - 1] = current;
        QuadResponse result{std::vector<Quad>(n + 1), 0};
        auto& y = result.offset;
        y[n] = 1;
        for (std::size_t i = n; i-- > 0;) {
            Quad right = rows[i].right;
            if (i + 1 < n) right -= rows[i].a[1] * y[i + 1];
            if (i + 2 < n) right -= rows[i].a[2] * y[i + 2];
            y[i] = right / rows[i].a[0];
        }
        result.force = -(diagonal[n] * y[n] + off[n - 1] * y[n - 1]);
        return result;
    }
};

inline QuadResponse truth(const Chain<double>& chain, Quad height) {
    QuadSystem system(static_cast<std::size_t>(chain.size()));
    Quad below = 0;
    for (Index m = 0; m < chain.size(); ++m) {
        const auto link = chain.link(m);
        const Quad W = link.weight, a = link.length, h = link.centroid, turn = support::quad(link.gyration_ratio);
        const Quad p = h / a, q = (a - h) / a;
        system.add(static_cast<std::size_t>(m), height * (W * h + a * below) / (a * a), W * (p * p + turn),
                   W * (p * q - turn), W * (q * q + turn));
        below += W;
    }
    return system.solve();
}

/// Largest error of row `row`, over the largest offset and the bound.
inline double error_over_bound(const Response& found, Index row, const QuadResponse& exact, double radius = 1) {
    Quad largest = 0, worst = 0;
    for (const Quad& y : exact.offset) largest = fmaxq(largest, fabsq(y));
    for (std::size_t i = 0; i < found.pins.size(); ++i) {
        const Quad y = exact.offset[static_cast<std::size_t>(found.pins[i])] * Quad(radius);
        worst = fmaxq(worst, fabsq(Quad(found.offset(row, static_cast<Index>(i))) - y));
    }
    return static_cast<double>(worst / (largest * Quad(radius)) / Quad(found.error_bound[row]));
}

}  // namespace support
