// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Eigenvalues>
#include <complex>

#include "revchain/numeric/scalar.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// A gyroscopic system that motion in a mirror leaves alone,
///     A x'' - 2 B y' + K x = 0,    M y'' + 2 B' x' + C y = 0,
/// A and M symmetric and positive definite, K and C symmetric. With x, y exp(s t) so is x, -y exp(-s t).
struct MirroredPencil {
    Matrix<double> A, B, M, K, C;
};

/// Its modes: the squares of the exponents s, and as columns x and s y.
struct MirroredModes {
    Vector<std::complex<double>> square;
    Matrix<std::complex<double>> x, y;
};

/// In canonical coordinates p = x', r = y' + 2 B' x (A = M = 1) the state falls into two halves u = (x, r), v = (p,
/// -y):
///     u' = diag(1, C) v,    v' = -S u,    S = [K + 4 B B', -2 B; -2 B', 1],
/// so that s^2 are the eigenvalues of -diag(1, C) S, half as large as the whole. Where C is positive definite they are
/// those of a symmetric matrix: real, and no motion grows in oscillations.
/// Dense, backward stable; a defective s^2 spreads by the square root of rounding, and so does an s next to 0. Cost
/// some 30 n^3, symmetric 10 n^3, n the number of unknowns x and y.
inline MirroredModes mirrored_modes(const MirroredPencil& pencil) {
    const Index n = pencil.K.rows(), k = pencil.C.rows();
    const Eigen::LLT<Matrix<double>> root(pencil.A), other(pencil.M);
    const auto reduced = [](const auto& left, const Matrix<double>& middle, const auto& right) {
        const Matrix<double> half = left.matrixL().solve(middle);
        return Matrix<double>(right.matrixL().solve(half.transpose()).transpose());
    };
    Matrix<double> K = reduced(root, pencil.K, root), B = reduced(root, pencil.B, other);
    Matrix<double> C = reduced(other, pencil.C, other);
    // Units of time in which stiffness is about 1, so that the two halves of the state are alike.
    const auto size = [](const Matrix<double>& X) { return X.size() ? X.cwiseAbs().rowwise().sum().maxCoeff() : 0.0; };
    const double pace = std::sqrt(std::max({size(K), size(C), std::numeric_limits<double>::min()}));
    K /= pace * pace, C /= pace * pace, B /= pace;
    Matrix<double> S(n + k, n + k);
    S << K + 4 * B * B.transpose(), -2 * B, -2 * B.transpose(), Matrix<double>::Identity(k, k);
    MirroredModes modes;
    Matrix<std::complex<double>> u;
    if (const Eigen::LLT<Matrix<double>> factor(C); factor.info() == Eigen::Success) {
        Matrix<double> F = Matrix<double>::Identity(n + k, n + k);
        F.bottomRightCorner(k, k) = factor.matrixL();
        const Eigen::SelfAdjointEigenSolver<Matrix<double>> solver(F.transpose() * S * F);
        modes.square = -solver.eigenvalues(), u = F * solver.eigenvectors();
    } else {
        Matrix<double> T = -S;
        T.bottomRows(k) = C * T.bottomRows(k);
        const Eigen::EigenSolver<Matrix<double>> solver(T);
        modes.square = solver.eigenvalues(), u = solver.eigenvectors();
    }
    modes.square *= pace * pace;
    const auto back = [](const auto& factor, const Matrix<std::complex<double>>& of) {
        Matrix<std::complex<double>> result(of.rows(), of.cols());
        result.real() = factor.matrixU().solve(of.real()), result.imag() = factor.matrixU().solve(of.imag());
        return result;
    };
    modes.x = back(root, u.topRows(n)), modes.y = back(other, pace * (S.bottomRows(k) * u));
    return modes;
}

/// How many eigenvalues of a symmetric matrix are negative, and the least of all.
struct Inertia {
    Index negative = 0;
    double least = std::numeric_limits<double>::infinity();
};
inline Inertia inertia(const Matrix<double>& A) {
    if (A.size() == 0) return {};
    const Eigen::SelfAdjointEigenSolver<Matrix<double>> solver(A, Eigen::EigenvaluesOnly);
    return {(solver.eigenvalues().array() < 0).count(), solver.eigenvalues().minCoeff()};
}

}  // namespace revchain::pencil
