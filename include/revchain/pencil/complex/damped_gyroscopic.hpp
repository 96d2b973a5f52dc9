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
    Matrix<S> T = Matrix<S>::Zero(2 * all, 2 * all);
    T.topRightCorner(all, all).setIdentity();
    T.bottomLeftCorner(all, all) = -reduced(root, stiffness, root);
    T.bottomRightCorner(all, all) = -reduced(root, rate, root);
    const Eigen::EigenSolver<Matrix<S>> solver(T);
    DampedGyroscopicModes<S> modes{solver.eigenvalues(), {}, {}};
    const ComplexColumns<S> state = eigenvectors(solver);  // with its rates below
    const Matrix<S> real = root.matrixU().solve(Matrix<S>(state.real.topRows(all))),
                    imag = root.matrixU().solve(Matrix<S>(state.imag.topRows(all)));
    modes.x = {real.topRows(n), imag.topRows(n)};
    modes.y = {real.bottomRows(k), imag.bottomRows(k)};
    return modes;
}

}  // namespace revchain::pencil
