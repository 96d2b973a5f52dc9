// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/finite/stability/disturbed.hpp"
#include "revchain/pencil/complex/gyroscopic.hpp"
#include "revchain/stability.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// The signs of the energy's second variation, in the plane and out of it, by matrices of so many links whose units are
/// alike: negative directions, whether every direction is positive, and whether no sign is within rounding.
struct EnergySigns {
    Index negative;
    bool is_minimum, is_certain;
};
inline EnergySigns energy_signs(const Matrix<double>& in_plane, const Matrix<double>& across, Index links) {
    const pencil::Inertia inside = pencil::inertia(in_plane), outside = pencil::inertia(across);
    const double stiffness =
        std::max(in_plane.cwiseAbs().maxCoeff(), across.size() ? across.cwiseAbs().maxCoeff() : 0.0);
    const double rounding = 1e-14 * static_cast<double>(links) * stiffness,
                 least = std::min(inside.least, outside.least);
    return {inside.negative + outside.negative, least > rounding, least < -rounding};
}

/// p'A q of complex vectors, given by their parts, without a conjugate.
template <class S>
std::complex<S> bilinear(const pencil::ComplexColumns<S>& p, const Matrix<S>& A, const pencil::ComplexColumns<S>& q,
                         Index j) {
    const Vector<S> real = A * q.real.col(j), imag = A * q.imag.col(j);
    const auto re = p.real.col(j), im = p.imag.col(j);
    return {re.dot(real) - im.dot(imag), re.dot(imag) + im.dot(real)};
}
template <class S>
double hermitian(const pencil::ComplexColumns<S>& q, const Matrix<S>& A, Index j) {
    return std::abs(static_cast<double>(q.real.col(j).dot(A * q.real.col(j)) + q.imag.col(j).dot(A * q.imag.col(j))));
}
template <class S>
std::complex<double> rounded(const std::complex<S>& x) {
    return {static_cast<double>(x.real()), static_cast<double>(x.imag())};
}

/// A verdict, and whether an exponent has lost digits: by estimate more than 5e-11 of the largest, or 5e-9 where it is
/// about 1; more in proportion where there are more than 16 unknowns, as rounding in the eigenvalue solver grows.
/// Estimates are mostly some thousand times what is lost; where two motions are nearly alike, as those of a light link
/// in the plane and out of it, up to forty times more is lost (tests/python/test_light_links.py).
struct Judgement {
    Stability stability;
    bool is_spoilt = false;
};

/// The error of s where that of s^2 is known.
inline double error_of_root(double square, double error) {
    return error / (std::sqrt(square) + std::sqrt(std::max(square - error, error)));
}

/// The verdict by squares of exponents and their errors. One grows if its distance from the negative numbers exceeds
/// its error. One whose square is negative and farther than the errors from every other stays imaginary, as squares
/// leave the real numbers in pairs; those of a symmetric matrix do not leave them.
inline Verdict verdict_by(const std::vector<std::complex<double>>& square, const std::vector<double>& error,
                          bool is_symmetric) {
    bool still = true;
    for (std::size_t j = 0; j < square.size(); ++j) {
        const double off = square[j].real() > 0 ? std::abs(square[j]) : std::abs(square[j].imag());
        if (off > error[j]) return Verdict::unstable;
        still = still && square[j].imag() == 0 && square[j].real() < -error[j];
        for (std::size_t k = 0; k < j && !is_symmetric; ++k)
            still = still && std::abs(square[j] - square[k]) > error[j] + error[k];
    }
    return still ? Verdict::spectrally_stable : Verdict::undecided;
}

/// The verdict on a disturbed shape of so many links. To first order damping c (F, H) changes an exponent by
///     ds = - c (s^2 q'F q - Y'H Y) / (2 (s^2 q'A q - Y'N Y - 2 q'B Y)),    Y = s b,
/// since (q, -b) is the mode on the left; drag in space has -2 q'X'E Y above besides, X'E the `drag_coupling`.
/// In the same way changes of the matrices move s^2. What is left of q'(...) - b'(...) of a mode, and the rounding of
/// its terms, give an error of s^2 besides that of the eigenvalue solver; relative changes of masses and pulls give
/// that by the shape as given. Nothing where rounding leaves a mass matrix indefinite.
template <class S>
std::optional<Judgement> judged_in(StabilityFrame frame, const DisturbedIn<S>& d, const ChainUnits& units) {
    using std::sqrt;
    const bool free = frame == StabilityFrame::free, rotates = free && d.turns_freely;
    const Index n = d.in_plane.rows();
    Matrix<S> in_plane = d.in_plane, others = Matrix<S>::Identity(d.offset.size(), free ? d.offset.size() : 0);
    Vector<S> b = Vector<S>::Zero(n);
    S turning(1);
    Matrix<S> beside_shape = others;
    if (rotates) {
        const Vector<S> momentum = d.mass * d.offset;
        others = beside(Matrix<S>(momentum));  // angles at right angles to the rotation, in the masses
        beside_shape = beside(Matrix<S>(d.offset));
        turning = sqrt(S(d.offset.dot(momentum)));
        b = d.coupling * d.offset / turning;
        in_plane += S(4) * b * b.transpose();
    } else if (!free) {
        in_plane -= d.turned;
    }
    const pencil::MirroredPencil<S> forms{d.inertia, d.coupling * others, others.transpose() * d.mass * others,
                                          in_plane, others.transpose() * d.out_of_plane * others};
    const auto found = pencil::mirrored_modes(forms);
    if (!found) return std::nullopt;
    const pencil::MirroredModes<S>& modes = *found;
    const pencil::ComplexColumns<S>&q = modes.x, &others_of_y = modes.y;

    Judgement judgement;
    Stability& result = judgement.stability;
    result.frame = frame;
    const double pins = std::ldexp(1.0, -units.weight_exponent - 2 * units.length_exponent),
                 air = std::ldexp(1.0, units.length_exponent - units.weight_exponent);
    pencil::ComplexColumns<S> Y{others * others_of_y.real, others * others_of_y.imag};
    if (rotates) {
        const Vector<S> along = d.offset / turning;
        Y.real -= S(2) * along * (b.transpose() * q.real), Y.imag -= S(2) * along * (b.transpose() * q.imag);
    }
    const auto size = [](const Matrix<S>& A) { return static_cast<double>(A.norm()); };
    const double in_A = size(forms.A), in_B = size(forms.B), in_M = size(forms.M), in_K = size(forms.K),
                 in_C = size(forms.C);
    std::vector<std::complex<double>> square;
    std::vector<double> error;
    struct Mode {
        std::complex<double> exponent;
        double internal, external, error;
    };
    std::vector<Mode> list;
    for (Index j = 0; j < modes.square.size(); ++j) {
        const std::complex<S> of = modes.square[j];
        const auto form = [&](const Matrix<S>& A, const Matrix<S>& M) {
            return of * bilinear(q, A, q, j) - bilinear(Y, M, Y, j);
        };
        const std::complex<S> two(S(2));
        const std::complex<double> norm =
            rounded(two * (form(d.inertia, d.mass) - two * bilinear(q, d.coupling, Y, j)));
        const std::complex<double> inner = rounded(form(d.bending, d.swivelling)) / norm;
        const std::complex<double> outer =
            rounded(form(d.drag_in_plane, d.drag_across) - two * bilinear(q, d.drag_coupling, Y, j)) / norm;

        const std::complex<double> s2 = rounded(of);
        const double far = std::abs(s2);
        const auto sizes = [&](double A, double B, double M, double K, double C, double x, double y) {
            return far * A * x + K * x + 4 * B * std::sqrt(x * y) + M * y + (far > 0 ? C * y / far : 0.0);
        };
        const std::complex<S> left = of * bilinear(q, forms.A, q, j) + bilinear(q, forms.K, q, j) -
                                     two * two * bilinear(q, forms.B, others_of_y, j) -
                                     bilinear(others_of_y, forms.M, others_of_y, j) -
                                     bilinear(others_of_y, forms.C, others_of_y, j) / of;
        const auto rounding = static_cast<double>(std::numeric_limits<S>::epsilon());
        const double x = static_cast<double>(q.real.col(j).squaredNorm() + q.imag.col(j).squaredNorm());
        const double y =
            static_cast<double>(others_of_y.real.col(j).squaredNorm() + others_of_y.imag.col(j).squaredNorm());
        const double to_square = 2 * far / std::abs(norm);
        const double alpha = hermitian(q, forms.A, j), mu = hermitian(others_of_y, forms.M, j),
                     kappa = d.doubt * x + alpha, gamma = d.doubt * y + mu;
        const double missing = far > 0 ? std::abs(rounded(left)) : 0.0;
        square.push_back(s2);
        const double given = far * alpha + kappa + 4 * std::sqrt(alpha * mu) + mu + (far > 0 ? gamma / far : 0.0);
        constexpr double safety = 100;
        error.push_back(safety * (modes.error[j] + to_square * (missing + 4 * 0x1p-52 * given +
                                                                rounding * sizes(in_A, in_B, in_M, in_K, in_C, x, y))));
        const std::complex<double> s = std::sqrt(s2);
        const double off = error_of_root(far, error.back());
        list.push_back({s, -pins * inner.real(), -air * outer.real(), off});
        list.push_back({0.0 - s, -pins * inner.real(), -air * outer.real(), off});
        result.growth_rate = std::max(result.growth_rate, std::abs(s.real()));
        result.margin = std::max(result.margin, off);
    }
    double largest = 0;
    for (std::size_t j = 0; j < square.size(); ++j) {
        largest = std::max(largest, std::sqrt(std::abs(square[j])));
        for (std::size_t k = 0; k < square.size(); ++k)  // two that cannot be told from one another have no mode each
            if (k != j && std::abs(square[j] - square[k]) <=
                              1e-10 * std::abs(square[j]) + 10 * (error[j] + error[k]))
                for (const std::size_t i : {2 * j, 2 * j + 1})
                    list[i].internal = list[i].external = std::numeric_limits<double>::quiet_NaN();
    }
    const double lost = 5e-11 * std::max(1.0, static_cast<double>(square.size()) / 16);
    for (std::size_t j = 0; j < square.size(); ++j) {
        const double far = std::abs(square[j]), near = std::min(largest, 100 * std::max(1.0, std::sqrt(far)));
        judgement.is_spoilt |= error_of_root(far, error[j]) > lost * near;
    }
    std::sort(list.begin(), list.end(), [](const Mode& x, const Mode& z) {
        const auto &s = x.exponent, &t = z.exponent;
        return s.imag() != t.imag() ? s.imag() < t.imag() : s.real() < t.real();
    });
    for (const Mode& mode : list) {
        result.exponents.push_back(mode.exponent), result.exponent_error.push_back(mode.error);
        result.internal_damping.push_back(mode.internal), result.external_damping.push_back(mode.external);
    }
    const auto narrow = [](const Matrix<S>& A) { return Matrix<double>(A.template cast<double>()); };
    const Matrix<double> inside = narrow(in_plane),
                         across = narrow(beside_shape.transpose() * d.out_of_plane * beside_shape);
    const Verdict by_squares = verdict_by(square, error, modes.is_symmetric);
    const EnergySigns signs = energy_signs(inside, across, d.ends.rows());
    result.negative_directions = signs.negative;
    if (signs.is_minimum)
        result.verdict = Verdict::minimum;
    else if (by_squares == Verdict::unstable || signs.is_certain)
        result.verdict = by_squares;
    return judgement;
}

}  // namespace revchain::finite
