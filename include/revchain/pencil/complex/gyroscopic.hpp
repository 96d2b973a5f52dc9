// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Eigenvalues>
#include <complex>
#include <optional>

#include "revchain/numeric/called_words.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/numeric/scalar.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// These return A B and A^T B, with ^T for the transpose. Eigen compiles each kind of expression
/// anew: seconds for two words.
template <class S>
Matrix<S> product(const Matrix<S>& A, const Matrix<S>& B) {
    return A * B;
}
template <class S>
Matrix<S> transposed_product(const Matrix<S>& A, const Matrix<S>& B) {
    return product<S>(A.transpose(), B);
}

/// A gyroscopic system with mirror symmetry. If (x, y) exp(s t) is a motion, (x, -y) exp(-s t) is
/// one, too. With primes for derivatives by the time t it is
///     A x'' - 2 B y' + K x = 0,    M y'' + 2 B^T x' + C y = 0.
/// A and M are symmetric and positive definite, K and C symmetric. Units make B about as large as A
/// and M.
template <class S>
struct GyroscopicPencil {
    Matrix<S> A, B, M, K, C;
};

/// Complex columns with separate real and imaginary parts.
template <class S>
struct ComplexColumns {
    Matrix<S> real, imag;
};

/// Returns the eigenvectors of a real matrix.
template <class S>
ComplexColumns<S> eigenvectors(const Eigen::EigenSolver<Matrix<S>>& solver) {
    const Matrix<S> parts = solver.pseudoEigenvectors();  // of a pair: real, imaginary
    ComplexColumns<S> columns{parts, Matrix<S>::Zero(parts.rows(), parts.cols())};
    for (Index j = 0; j < parts.cols(); ++j) {
        const S imag = solver.eigenvalues()[j].imag();
        if (imag < S(0)) columns.real.col(j) = parts.col(j - 1);
        if (imag > S(0)) columns.imag.col(j) = parts.col(j + 1);
        if (imag < S(0)) columns.imag.col(j) = -parts.col(j);
    }
    return columns;
}

/// Returns L^-1 middle R^-T for roots L and R.
template <class S>
Matrix<S> reduced(const Eigen::LLT<Matrix<S>>& left, const Matrix<S>& middle,
                  const Eigen::LLT<Matrix<S>>& right) {
    Matrix<S> half = left.matrixL().solve(middle);
    half.transposeInPlace();
    return Matrix<S>(Matrix<S>(right.matrixL().solve(half)).transpose());
}

/// Squares of the exponents s, estimates of their rounding errors, and columns x and s y.
template <class S>
struct GyroscopicModes {
    Vector<std::complex<S>> square;
    Vector<double> error;
    ComplexColumns<S> x, y;
    bool is_symmetric = false;  ///< true if the matrix is symmetric: all squares are then real
};

/// Returns the modes. In canonical coordinates p = x', r = y' + 2 B^T x (A = M = 1) the state
/// splits into two halves u = (x, r), v = (p, -y):
///     u' = diag(1, C) v,    v' = -Q u,    Q = [K + 4 B B^T, -2 B; -2 B^T, 1],
/// so s^2 are the eigenvalues of -diag(1, C) Q, half as large as the whole. If C is positive
/// definite they are those of a symmetric matrix: they are real, and no oscillation grows. Q u is
/// the left eigenvector, so a change T of the matrix moves s^2 by up to |T| |u| |Q u| / |u^T Q u|.
/// The method is dense and backward stable. A defective s^2 spreads by the square root of rounding,
/// and so does an s near 0. Cost: about 30 n^3, symmetric 10 n^3. The result is empty if rounding
/// makes A or M indefinite.
template <class S>
std::optional<GyroscopicModes<S>> gyroscopic_modes(const GyroscopicPencil<S>& pencil) {
    using std::abs, std::sqrt;
    const Index n = pencil.K.rows(), k = pencil.C.rows();
    const Eigen::LLT<Matrix<S>> root(pencil.A), other(pencil.M);
    if (root.info() != Eigen::Success || other.info() != Eigen::Success) return std::nullopt;
    const Matrix<S> K = reduced(root, pencil.K, root), B = reduced(root, pencil.B, other);
    const Matrix<S> C = reduced(other, pencil.C, other);
    Matrix<S> Q(n + k, n + k);
    const Matrix<S> twice = S(-2) * B;
    Q << K + product<S>(twice, twice.transpose()), twice, twice.transpose(),
        Matrix<S>::Identity(k, k);
    const auto rounding = static_cast<double>(std::numeric_limits<S>::epsilon());
    GyroscopicModes<S> modes;
    modes.error.resize(n + k);
    ComplexColumns<S> u{Matrix<S>(n + k, n + k), Matrix<S>::Zero(n + k, n + k)};
    if (const Eigen::LLT<Matrix<S>> factor(C); factor.info() == Eigen::Success) {
        Matrix<S> F = Matrix<S>::Identity(n + k, n + k);
        F.bottomRightCorner(k, k) = factor.matrixL();
        const Matrix<S> symmetric = transposed_product(F, product(Q, F));
        const Eigen::SelfAdjointEigenSolver<Matrix<S>> solver(symmetric);
        modes.square = Vector<S>(-solver.eigenvalues()).template cast<std::complex<S>>();
        u.real = product(F, solver.eigenvectors());
        modes.is_symmetric = true;
        modes.error.setConstant(rounding * static_cast<double>(symmetric.norm()));
    } else {
        // Each r has a unit that makes it as large as its x: light links have fast motions.
        Vector<S> unit = Vector<S>::Ones(n + k);
        for (Index i = 0; i < k; ++i) unit[n + i] = sqrt(S(1) + abs(C(i, i)));
        Matrix<S> T = -Q;
        T.bottomRows(k) = product<S>(C, T.bottomRows(k));
        for (Index i = 0; i < n + k; ++i) T.col(i) *= unit[i], T.row(i) /= unit[i];
        const Eigen::EigenSolver<Matrix<S>> solver(T);
        modes.square = solver.eigenvalues();
        const ComplexColumns<S> right = eigenvectors(solver);
        ComplexColumns<S> left;
        const auto in_units = [&](Matrix<S> of) {
            for (Index i = 0; i < n + k; ++i) of.row(i) *= unit[i];
            return of;
        };
        u = {in_units(right.real), in_units(right.imag)};
        left = {in_units(product(Q, u.real)), in_units(product(Q, u.imag))};
        const double whole = rounding * static_cast<double>(T.norm());
        for (Index j = 0; j < n + k; ++j) {
            const auto p = right.real.col(j), q = right.imag.col(j);
            const auto l = left.real.col(j), m = left.imag.col(j);
            const S squares =
                (p.squaredNorm() + q.squaredNorm()) * (l.squaredNorm() + m.squaredNorm());
            const double sizes = static_cast<double>(sqrt(squares));
            const double overlap = std::hypot(static_cast<double>(p.dot(l) - q.dot(m)),
                                              static_cast<double>(p.dot(m) + q.dot(l)));
            modes.error[j] = whole * sizes / overlap;
        }
    }
    const auto back = [](const auto& factor, const Matrix<S>& of) {
        return Matrix<S>(factor.matrixU().solve(of));
    };
    const Matrix<S> to_y = Q.bottomRows(k);
    modes.x = {back(root, u.real.topRows(n)), back(root, u.imag.topRows(n))};
    modes.y = {back(other, product(to_y, u.real)), back(other, product(to_y, u.imag))};
    return modes;
}

/// The number of negative eigenvalues of a symmetric matrix, and its least eigenvalue.
struct Inertia {
    Index negative = 0;
    double least = std::numeric_limits<double>::infinity();
};
REVCHAIN_LAZY
Inertia inertia(const Matrix<double>& A) {
    if (A.size() == 0) return {};
    const Eigen::SelfAdjointEigenSolver<Matrix<double>> solver(A, Eigen::EigenvaluesOnly);
    return {(solver.eigenvalues().array() < 0).count(), solver.eigenvalues().minCoeff()};
}

}  // namespace revchain::pencil
