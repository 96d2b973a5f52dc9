// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Eigenvalues>  // seconds of compile time
#include <algorithm>
#include <numeric>

#include "revchain/pencil/element.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// The square matrices K and M without the held pin. The slowest modes lose accuracy in this form.
template <Real T>
struct AssembledPencil {
    Matrix<T> K, M;
};

template <Real T>
AssembledPencil<T> assembled(const ElementPencil<T>& pencil) {
    const Index n = pencil.size();
    AssembledPencil<T> result{Matrix<T>::Zero(n + 1, n + 1), Matrix<T>::Zero(n + 1, n + 1)};
    using std::ldexp;
    for (Index m = 0; m < n; ++m) {
        Element<T> e = pencil.elements[static_cast<std::size_t>(m)];
        if (!pencil.units.empty())
            for (T* entry : {&e.stiffness, &e.lower, &e.upper, &e.cross})
                *entry = ldexp(*entry, pencil.units[static_cast<std::size_t>(m)]);
        Eigen::Matrix<T, 2, 2> stiffness, mass;
        stiffness << e.stiffness, -e.stiffness, -e.stiffness, e.stiffness;
        mass << e.lower, e.cross, e.cross, e.upper;
        result.K.template block<2, 2>(m, m) += stiffness;
        result.M.template block<2, 2>(m, m) += mass;
    }
    result.K.conservativeResize(n, n);
    result.M.conservativeResize(n, n);
    return result;
}

/// Eigenvalues, descending, and their vectors as columns in the same order.
template <Real T>
struct Eigensystem {
    Vector<T> values;
    Matrix<T> vectors;
};

namespace detail {
template <Real T>
Eigensystem<T> sorted(const Vector<T>& values, const Matrix<T>& vectors) {
    std::vector<Index> order(static_cast<std::size_t>(values.size()));
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(), [&](Index i, Index j) { return values[i] > values[j]; });
    Eigensystem<T> result{Vector<T>(values.size()), Matrix<T>(vectors.rows(), vectors.cols())};
    for (Index j = 0; j < values.size(); ++j) {
        result.values[j] = values[order[static_cast<std::size_t>(j)]];
        result.vectors.col(j) = vectors.col(order[static_cast<std::size_t>(j)]);
    }
    return result;
}
}  // namespace detail

/// Solves M y = lambda K y, with K positive definite, by Cholesky and the symmetric QR algorithm,
/// O(N^3). The absolute error is at most eps times the largest eigenvalue times cond(K).
template <Real T>
Eigensystem<T> solve_symmetric_definite(const Matrix<T>& K, const Matrix<T>& M) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix<T>> solver(M, K);
    return detail::sorted<T>(solver.eigenvalues(), solver.eigenvectors());
}

/// Returns real parts of finite eigenvalues of A y = lambda B y, A and B square; QZ, O(N^3).
template <Real T>
Eigensystem<T> solve_general(const Matrix<T>& A, const Matrix<T>& B) {
    const Eigen::GeneralizedEigenSolver<Matrix<T>> solver(A, B);
    Vector<T> values(A.rows());
    for (Index j = 0; j < A.rows(); ++j)
        values[j] =
            solver.betas()[j] == T(0) ? T(0) : solver.alphas()[j].real() / solver.betas()[j];
    return detail::sorted<T>(values, solver.eigenvectors().real());
}

}  // namespace revchain::pencil
