// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Eigenvalues>
#include <complex>
#include <vector>

#include "revchain/numeric/scalar.hpp"

namespace revchain::pencil {

/// Exponents s of  M x'' + G x' + K x = 0,  M symmetric and positive definite, G skew, K symmetric: x = x0 exp(s t).
/// They come in fours, s, -s and their conjugates. Dense: Cholesky's factor of M, then the eigenvalues of the matrix of
/// the first-order system; backward stable, a defective one spreads by the square root of rounding. Cost 200 (2n)^3.
inline std::vector<std::complex<double>> gyroscopic_exponents(const Matrix<double>& M, const Matrix<double>& G,
                                                              const Matrix<double>& K) {
    const Index n = M.rows();
    const Eigen::LLT<Matrix<double>> factor(M);
    const auto reduced = [&](const Matrix<double>& A) {
        const Matrix<double> half = factor.matrixL().solve(A);
        return Matrix<double>(factor.matrixL().solve(half.transpose()).transpose());
    };
    const Matrix<double> stiffness = reduced(K);
    // Units of time in which stiffness is about 1, so that the two halves of the state are alike.
    const double pace =
        std::sqrt(std::max(stiffness.cwiseAbs().rowwise().sum().maxCoeff(), std::numeric_limits<double>::min()));
    Matrix<double> system = Matrix<double>::Zero(2 * n, 2 * n);
    system.topRightCorner(n, n).setIdentity();
    system.bottomLeftCorner(n, n) = -stiffness / (pace * pace);
    system.bottomRightCorner(n, n) = -reduced(G) / pace;
    const Eigen::EigenSolver<Matrix<double>> solver(system, false);
    std::vector<std::complex<double>> exponents;
    for (Index i = 0; i < 2 * n; ++i) exponents.push_back(solver.eigenvalues()[i] * pace);
    return exponents;
}

/// How many eigenvalues of a symmetric matrix are negative, and the least of all.
struct Inertia {
    Index negative;
    double least;
};
inline Inertia inertia(const Matrix<double>& A) {
    const Eigen::SelfAdjointEigenSolver<Matrix<double>> solver(A, Eigen::EigenvaluesOnly);
    return {(solver.eigenvalues().array() < 0).count(), solver.eigenvalues().minCoeff()};
}

}  // namespace revchain::pencil
