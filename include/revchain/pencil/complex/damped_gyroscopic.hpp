// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/complex/gyroscopic.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// Exponents s and columns x and y.
template <class S>
struct DampedGyroscopicModes {
    Vector<std::complex<S>> s;
    ComplexColumns<S> x, y;
};

/// Returns the modes (x, y) exp(s t) of a gyroscopic system with damping,
///     A x'' + F x' - 2 B y' + K x = 0,    M y'' + H y' + 2 B^T x' + C y = 0.
/// The method is dense. Cost: about 200 n^3 for n of x and y together. The result is empty if
/// rounding makes A or M indefinite.
template <class S>
std::optional<DampedGyroscopicModes<S>> damped_gyroscopic_modes(const GyroscopicPencil<S>& pencil,
                                                                const Matrix<S>& F,
                                                                const Matrix<S>& H) {
    const Index n = pencil.K.rows(), k = pencil.C.rows(), all = n + k;
    Matrix<S> mass = Matrix<S>::Zero(all, all), rate = mass, stiffness = mass;
    mass.topLeftCorner(n, n) = pencil.A, mass.bottomRightCorner(k, k) = pencil.M;
    stiffness.topLeftCorner(n, n) = pencil.K, stiffness.bottomRightCorner(k, k) = pencil.C;
    rate.topLeftCorner(n, n) = F, rate.bottomRightCorner(k, k) = H;
    rate.topRightCorner(n, k) = S(-2) * pencil.B;
    rate.bottomLeftCorner(k, n) = S(2) * pencil.B.transpose();
    const Eigen::LLT<Matrix<S>> root(mass);
    if (root.info() != Eigen::Success) return std::nullopt;
    const auto reduced = [&](const Matrix<S>& middle) {
        Matrix<S> half = root.matrixL().solve(middle);
        half.transposeInPlace();
        return Matrix<S>(Matrix<S>(root.matrixL().solve(half)).transpose());
    };
    Matrix<S> T = Matrix<S>::Zero(2 * all, 2 * all);
    T.topRightCorner(all, all).setIdentity();
    T.bottomLeftCorner(all, all) = -reduced(stiffness);
    T.bottomRightCorner(all, all) = -reduced(rate);
    const Eigen::EigenSolver<Matrix<S>> solver(T);
    const Matrix<S> parts = solver.pseudoEigenvectors();  // of a pair: real, imaginary
    DampedGyroscopicModes<S> modes{solver.eigenvalues(), {}, {}};
    Matrix<S> real(all, 2 * all), imag = Matrix<S>::Zero(all, 2 * all);
    for (Index j = 0; j < 2 * all; ++j) {
        const bool first = modes.s[j].imag() > S(0), second = modes.s[j].imag() < S(0);
        real.col(j) = parts.col(second ? j - 1 : j).head(all);
        if (first) imag.col(j) = parts.col(j + 1).head(all);
        if (second) imag.col(j) = -parts.col(j).head(all);
    }
    real = Matrix<S>(root.matrixU().solve(real)), imag = Matrix<S>(root.matrixU().solve(imag));
    modes.x = {real.topRows(n), imag.topRows(n)};
    modes.y = {real.bottomRows(k), imag.bottomRows(k)};
    return modes;
}

}  // namespace revchain::pencil
