// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/balance/links.hpp"
#include "revchain/numeric/compiled.hpp"
#include "revchain/pencil/complex/gyroscopic.hpp"

/// Quadratic forms for stability: the signs of the second variation of the energy, and products of
/// complex vectors with real symmetric matrices.
namespace revchain::inline REVCHAIN_BUILD::finite {

/// Signs of the second variation of the energy, in and out of the plane: the number of negative
/// directions, whether all are positive, and whether one is certainly negative despite rounding.
struct EnergySigns {
    Index negative;
    bool is_minimum, is_certainly_negative;
};
REVCHAIN_LAZY
EnergySigns energy_signs(const Matrix<double>& in_plane, const Matrix<double>& out_of_plane,
                         Index links) {
    const pencil::Inertia inside = pencil::inertia(in_plane),
                          outside = pencil::inertia(out_of_plane);
    const double stiffness =
        std::max(in_plane.cwiseAbs().maxCoeff(),
                 out_of_plane.size() ? out_of_plane.cwiseAbs().maxCoeff() : 0.0);
    const double rounding = 1e-14 * as_double(links) * stiffness,
                 least = std::min(inside.least, outside.least);
    return {inside.negative + outside.negative, least > rounding, least < -rounding};
}

/// Returns p'A q of complex vectors, without conjugation.
template <class S>
std::complex<S> bilinear(const pencil::ComplexColumns<S>& p, const Matrix<S>& A,
                         const pencil::ComplexColumns<S>& q, Index j) {
    const Vector<S> real = A * q.real.col(j), imag = A * q.imag.col(j);
    const auto re = p.real.col(j), im = p.imag.col(j);
    return {re.dot(real) - im.dot(imag), re.dot(imag) + im.dot(real)};
}
/// Returns |q* A q| of column j, for a symmetric A and q* the conjugate transpose.
template <class S>
double hermitian(const pencil::ComplexColumns<S>& q, const Matrix<S>& A, Index j) {
    const S real = q.real.col(j).dot(A * q.real.col(j)),
            imag = q.imag.col(j).dot(A * q.imag.col(j));
    return std::abs(as_double(real + imag));
}
template <class S>
double squared_norm(const pencil::ComplexColumns<S>& q, Index j) {
    return as_double(q.real.col(j).squaredNorm() + q.imag.col(j).squaredNorm());
}
template <class S>
std::complex<double> rounded(const std::complex<S>& x) {
    return {as_double(x.real()), as_double(x.imag())};
}

/// Returns a bound of the error of sqrt(square), where `error` bounds that of `square`.
REVCHAIN_LAZY
double error_of_root(double square, double error) {
    return error / (std::sqrt(square) + std::sqrt(std::max(square - error, error)));
}

}  // namespace revchain::finite
