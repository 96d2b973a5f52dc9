// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "revchain/pencil/damped/exponents.hpp"

/// Motion in time of a rig with dashpots under loads that are polynomials in time.
namespace revchain::inline REVCHAIN_BUILD::pencil {

/// The coefficients of 1, u, u^2 on a piece of time.
template <class T>
using Polynomial = std::array<T, 3>;

/// Returns exp(z) and the three functions phi_k(z) = integral of exp((1-u) z) u^(k-1) / (k-1)! over
/// 0 < u < 1: phi_k = (phi_(k-1) - 1/(k-1)!) / z, or their series where that would cancel.
inline std::array<Complex, 4> phi_functions(const Complex& z, const Complex& exponential) {
    std::array<Complex, 4> phi{exponential};
    if (std::abs(z) >= 1) {
        constexpr double reciprocal[] = {1, 1, 0.5};
        for (std::size_t k = 1; k < 4; ++k) phi[k] = (phi[k - 1] - reciprocal[k - 1]) / z;
        return phi;
    }
    Complex sum = 0;
    for (int j = 20; j >= 0; --j) sum = (1.0 + z * sum) / double(j + 3);
    phi[3] = sum / 2.0;
    phi[2] = 0.5 + z * phi[3], phi[1] = 1.0 + z * phi[2];
    return phi;
}

/// Returns a(h) of a' = s a + p(u), a(0) = a. `exponential` is exp(s h).
inline Complex driven_amplitude(const Complex& a, const Complex& s, double h,
                                const Complex& exponential, const Polynomial<Complex>& p) {
    const std::array<Complex, 4> phi = phi_functions(s * h, exponential);
    return phi[0] * a + h * (phi[1] * p[0] + h * (phi[2] * p[1] + h * (phi[3] * (2.0 * p[2]))));
}

/// The first-order form q'' = -M^-1 (K q + (C - i G) q' - load), with the load's time in three more
/// unknowns, for steps of any size.
template <class T>
class SteppedMotion {
   public:
    /// `load` has the loads that the polynomials multiply, as columns.
    SteppedMotion(const DampedMatrices& of, const Matrix<T>& load)
        : n_(of.K.rows()), columns_(load.cols()) {
        const Eigen::LLT<Matrix<double>> mass(of.M);
        const auto solved = [&](const Matrix<T>& right) {
            if constexpr (std::is_same_v<T, double>) {
                return Matrix<T>(mass.solve(right));
            } else {
                Matrix<T> result(right.rows(), right.cols());
                result.real() = mass.solve(Matrix<double>(right.real()));
                result.imag() = mass.solve(Matrix<double>(right.imag()));
                return result;
            }
        };
        Matrix<T> C = of.C.template cast<T>();
        if constexpr (!std::is_same_v<T, double>)
            C -= Complex(0, 1) * of.G.template cast<Complex>();
        const Index size = 2 * n_ + 3 * columns_;
        A_.setZero(size, size);
        A_.block(0, n_, n_, n_).setIdentity();
        A_.block(n_, 0, n_, n_) = -solved(of.K.template cast<T>());
        A_.block(n_, n_, n_, n_) = -solved(C);
        A_.block(n_, 2 * n_, n_, columns_) = solved(load);
        for (Index k = 0; k < 2; ++k)  // w_0' = w_1, w_1' = w_2: w is the load and its derivatives
            A_.block(2 * n_ + k * columns_, 2 * n_ + (k + 1) * columns_, columns_, columns_)
                .setIdentity();
    }
    /// Returns (q, q') after a step h under the load sum of columns times polynomials.
    Vector<T> after(const Vector<T>& state, double h, const std::vector<Polynomial<double>>& p) {
        if (h != step_) exponential_ = Matrix<T>(A_ * T(h)).exp(), step_ = h;
        Vector<T> all = Vector<T>::Zero(A_.rows());
        all.head(2 * n_) = state;
        for (Index c = 0; c < columns_; ++c) {
            const Polynomial<double>& each = p[static_cast<std::size_t>(c)];
            all[2 * n_ + c] = each[0], all[2 * n_ + columns_ + c] = each[1];
            all[2 * n_ + 2 * columns_ + c] = 2 * each[2];
        }
        return (exponential_ * all).head(2 * n_);
    }

    /// Returns an estimate of the relative error of a step.
    double rounding(double h) const {
        return epsilon<double>() * h *
               A_.topLeftCorner(2 * n_, 2 * n_).cwiseAbs().colwise().sum().maxCoeff();
    }

   private:
    Index n_, columns_;
    Matrix<T> A_, exponential_;
    double step_ = -1;
};

}  // namespace revchain::pencil
