// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/chain.hpp"

/// The general recurring relation of the paper as a dense pencil of matrices.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::plummet(1.0, 0.5)});
///     const auto pencil = revchain::recurrence_matrices(chain);
///     pencil.A(1, 0);  // 1: the weight below the upper pin
///
/// Greenhill (1908) §8 (21) with sec delta = 1. `modes` does not use it: it is an independent
/// check.
namespace revchain::inline REVCHAIN_BUILD {

/// A y = lambda B y in the offsets y_0 ... y_{N-1} of the pins, free end first.
template <Real T>
struct RecurrencePencil {
    Matrix<T> A;  ///< (N, N), weights
    Matrix<T> B;  ///< (N, N), weight / length
};

/// The pencil of a chain. Row m - 1 is the moment about pin m of everything below it. It differs
/// from the printed relation in two points: h_{m-2}/a_{m-1} is corrected to h_{m-2}/a_{m-2}, and
/// y_0 is an unknown in place of 1 + h_1/(lambda - l_1), which makes the relation linear in lambda.
/// Accuracy: a few roundings an entry. Cost and memory O(N^2).
template <Real T>
[[nodiscard]] RecurrencePencil<T> recurrence_matrices(const Chain<T>& chain) {
    const Index n = chain.size();
    RecurrencePencil<T> pencil{Matrix<T>::Zero(n, n), Matrix<T>::Zero(n, n)};
    Vector<T> below(n);  // W_r (1 - h_r/a_r) + W_{r+1} h_{r+1}/a_{r+1}: of y_r in rows above r + 1
    Wide<T> sum(T(0));   // W_1 + ... + W_{m-1}
    T upper_share(0);    // W_{m-1} (1 - h_{m-1}/a_{m-1})
    for (Index row = 0; row < n; ++row) {
        const Link<T> link = chain.link(row);
        const T W = link.weight, a = link.length, h = link.centroid;
        const Wide<T> p = detail::in_lengths<T>(h, a);
        const T hl = static_cast<T>(p * p + link.gyration_ratio);  // over a^2
        for (Index column = 0; column < row; ++column) pencil.A(row, column) = below[column];
        pencil.A(row, row) = upper_share + W * hl;
        const T stiffness = static_cast<T>(sum) / a + W * (h / a) / a;
        pencil.B(row, row) = stiffness;
        if (row + 1 < n) {
            pencil.A(row, row + 1) = W * (h / a) - W * hl;
            pencil.B(row, row + 1) = -stiffness;
        }
        below[row] = upper_share + W * (h / a);
        upper_share = W * ((a - h) / a);
        sum = sum + Wide<T>(W);
    }
    return pencil;
}

}  // namespace revchain
