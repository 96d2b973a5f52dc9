// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <vector>

#include "revchain/numeric/compiled.hpp"
#include "revchain/pencil/complex/word.hpp"
#include "revchain/pencil/damped/form.hpp"

/// Exponents s of K + s (C - i G) + s^2 M: starts from Eigen, refined one by one.

namespace revchain::inline REVCHAIN_BUILD::pencil {

using Complex = std::complex<double>;

/// A complex number of two built-in words that is made of a double word.
struct Rough : Complex {
    using Complex::Complex;
    Rough(const Complex& z) : Complex(z) {}  // NOLINT(google-explicit-constructor)
    explicit Rough(const Wide<double>& x) : Complex(static_cast<double>(x)) {}
    friend Rough operator+(const Rough& x, const Rough& y) { return Complex(x) + Complex(y); }
    friend Rough operator-(const Rough& x, const Rough& y) { return Complex(x) - Complex(y); }
    friend Rough operator*(const Rough& x, const Rough& y) {
        return Complex(x.real() * y.real() - x.imag() * y.imag(),
                       x.real() * y.imag() + x.imag() * y.real());
    }
    friend Rough operator/(const Rough& x, const Rough& y) { return Complex(x) / Complex(y); }
};

/// An exponent in units of `RigPencil::pace`, and its vector of rotations.
struct DampedRoot {
    ComplexWord s{};
    std::vector<ComplexWord> q{};  ///< y^T Q'(s) y = 1
    std::vector<Complex> off{};    ///< Q(s) q
    double correction = 1;         ///< of s at last, relative
    bool real = false;
};

/// Returns numbers of two words, rounded.
REVCHAIN_LAZY
std::vector<Complex> in_double(const std::vector<ComplexWord>& words) {
    std::vector<Complex> rounded;
    for (const ComplexWord& each : words) rounded.emplace_back(each);
    return rounded;
}

/// A double that can be made of a double word, as `applied` needs.
struct Number {
    double value = 0;
    Number(double y) : value(y) {}  // NOLINT(google-explicit-constructor)
    explicit Number(const Wide<double>& y) : value(static_cast<double>(y)) {}
    Number operator+(const Number& y) const { return value + y.value; }
    Number operator-(const Number& y) const { return value - y.value; }
    Number operator*(const Number& y) const { return value * y.value; }
};

/// Returns a matrix of the family that takes these factors.
REVCHAIN_LAZY
Matrix<double> dense(const DampedPencil& pencil, const JointFactors<double>& x) {
    const Index n = pencil.size();
    Matrix<double> result(n, n);
    std::vector<Number> unit(static_cast<std::size_t>(n), Number(0.0));
    const JointFactors<Number> factors{x.stiffness, x.spin, x.damping, x.mass};
    for (Index j = 0; j < n; ++j) {
        unit[static_cast<std::size_t>(j)] = 1.0;
        const auto column = applied(pencil, factors, unit);
        for (Index m = 0; m < n; ++m) result(m, j) = column[static_cast<std::size_t>(m)].value;
        unit[static_cast<std::size_t>(j)] = 0.0;
    }
    return result;
}

/// The matrices of a damped rig in rotations, last the offset of a support that yields.
struct DampedMatrices {
    Matrix<double> K, C, G, M;
    explicit DampedMatrices(const DampedPencil& pencil)
        : K(dense(pencil, {1, 0, 0, 0})),
          C(dense(pencil, {0, 0, 1, 0})),
          G(dense(pencil, {0, 1, 0, 0})),
          M(dense(pencil, {0, 0, 0, 1})) {}
    /// Leaves out the offset of a free trolley without a dashpot: the momentum is 0.
    void leave_out_trolley() {
        const Index n = K.rows() - 1;
        const Vector<double> share = M.col(n).head(n) / M(n, n);
        const Matrix<double> inner = M.topLeftCorner(n, n) - share * M.row(n).head(n);
        M = inner;
        for (Matrix<double>* each : {&K, &C, &G}) *each = Matrix<double>(each->topLeftCorner(n, n));
    }
};

/// Returns the eigenvalues of a real or complex matrix.
template <class T>
Vector<Complex> eigenvalues(const Matrix<T>& A) {
    if constexpr (std::is_same_v<T, double>)
        return Eigen::EigenSolver<Matrix<T>>(A, false).eigenvalues();
    else
        return Eigen::ComplexEigenSolver<Matrix<T>>(A, false).eigenvalues();
}

/// The finite eigenvalues s of K + s C + s^2 M in double, and whether M is certainly regular.
struct FirstExponents {
    std::vector<Complex> s;
    bool inertia = false;
};

/// Returns them from the first-order form with M = 1. If M may be singular, from that of 1/w, s =
/// a + a/w: an infinite s is a w near 0.
template <class T>
FirstExponents first_exponents(const Matrix<T>& K, const Matrix<T>& C, const Matrix<double>& M) {
    const Index n = K.rows();
    FirstExponents result;
    const Eigen::LLT<Matrix<double>> mass(M);
    result.inertia =
        mass.info() == Eigen::Success &&
        (mass.matrixLLT().diagonal().array().square() > 1e-12 * M.diagonal().array()).all();
    Matrix<T> A = Matrix<T>::Zero(2 * n, 2 * n);
    A.topRightCorner(n, n).setIdentity();
    if (result.inertia) {
        const Matrix<T> L = Matrix<double>(mass.matrixL()).template cast<T>();
        const auto reduced = [&](Matrix<T> x) {
            L.template triangularView<Eigen::Lower>().solveInPlace(x);
            x.transposeInPlace();
            L.template triangularView<Eigen::Lower>().solveInPlace(x);
            return x;
        };
        const Matrix<T> stiffness = reduced(K), damping = reduced(C);
        const double unit = std::sqrt(std::max(stiffness.norm() / std::sqrt(double(n)), 1e-300));
        A.bottomLeftCorner(n, n) = -stiffness / T(unit * unit);
        A.bottomRightCorner(n, n) = -damping / T(unit);
        for (const Complex& s : eigenvalues(A)) result.s.push_back(s * unit);
        return result;
    }
    const double shift = std::sqrt(std::abs(K.trace()) / std::max(M.trace(), 1e-300));
    const Matrix<T> mass_part = T(shift * shift) * M.template cast<T>();
    const Eigen::PartialPivLU<Matrix<T>> factor(K + T(shift) * C + mass_part);
    A.bottomLeftCorner(n, n) = -factor.solve(mass_part);
    A.bottomRightCorner(n, n) = -factor.solve(Matrix<T>(T(2) * mass_part + T(shift) * C));
    for (const Complex& w : eigenvalues(A))
        if (std::abs(w) > 1e-11) result.s.push_back(shift + shift / w);
    return result;
}

template <class F>
F dot(const std::vector<F>& x, const std::vector<F>& y) {
    F sum = x[0] * y[0];
    for (std::size_t m = 1; m < x.size(); ++m) sum = sum + x[m] * y[m];
    return sum;
}

/// Returns true if the last unknown is the offset of a free trolley without a dashpot or drag.
REVCHAIN_LAZY
bool keeps_momentum(const DampedPencil& pencil) {
    const Wide<double> none(0.0);
    const Joint<Wide<double>>& end = pencil.joints.back();
    return end.lever == none && pencil.elements.back().stiffness == none &&
           damping_together(pencil) == none;
}

/// Sets the offset of such a trolley so that the momentum is 0. For slow motions its equation of
/// motion, which has the factor s^2, determines it badly.
template <class F>
void set_trolley(const DampedPencil& pencil, std::vector<F>& q) {
    if (!keeps_momentum(pencil)) return;
    const F none(Wide<double>(0.0)), one(Wide<double>(1.0));
    Wide<double> whole(0.0);
    for (const auto& e : pencil.elements) whole = whole + e.weight;
    q.back() = none;
    const JointFactors<F> mass{none, none, none, one};
    q.back() = none - applied(pencil, mass, q).back() / F(whole);
}

/// Sets the exponent from the vector by the symmetric Rayleigh quotient, q^T Q(s) q = 0, in two
/// words.
REVCHAIN_LAZY
void set_exponent(const DampedPencil& pencil, DampedRoot& root) {
    using W = Wide<double>;
    const ComplexWord unit(W(0.0), W(1.0));
    set_trolley(pencil, root.q);
    for (int round = 0; round < 2; ++round) {
        const auto off = applied(pencil, damped_factors(root.s, unit), root.q);
        const auto slope = applied(pencil, damped_factors(root.s, unit, true), root.q);
        const ComplexWord form = dot(root.q, slope);
        ComplexWord step = dot(root.q, off) / form;
        if (root.real) step.imag = W(0.0);
        root.correction = size_of(step) / size_of(root.s);
        if (!(root.correction < 1e-3)) break;
        root.s = root.s - step;
        if (round == 0) continue;
        const ComplexWord scale(std::sqrt(static_cast<Complex>(form)));
        for (ComplexWord& each : root.q) each = each / scale;
    }
    root.off = in_double(applied(pencil, damped_factors(root.s, unit), root.q));
    if (keeps_momentum(pencil)) root.off.back() = 0.0;  // but for the rounding of the offset
}

/// Returns the refined exponent next to `start`, with its vector from inverse iteration.
REVCHAIN_LAZY
DampedRoot refined(const DampedPencil& pencil, const Complex& start) {
    const auto n = static_cast<std::size_t>(pencil.size());
    const Rough i(0, 1);
    Rough s = start;
    std::vector<Rough> q(n), load(n);
    for (std::size_t m = 0; m < n; ++m) load[m] = Complex(1.0 / double(1 + (m * 7) % 11) - 0.3);
    for (int round = 0; round < 4; ++round) {
        JointSolver<Rough> solver(pencil, damped_factors(s, i));
        for (std::size_t m = 0; m < n; ++m)
            if (!(std::abs(solver.pivot(m)) > 1e-290)) solver.pivot(m) = Complex(1e-290);
        q = load;
        solver.solve(q);
        double largest = 0;
        for (const Rough& each : q) largest = std::max(largest, std::abs(each));
        if (!std::isfinite(largest) || largest == 0) break;
        for (Rough& each : q) each = Complex(each) / largest;
        set_trolley(pencil, q);
        load = applied(pencil, damped_factors(s, i, true), q);
        const Rough slope = dot(q, load);
        const Rough step = dot(q, applied(pencil, damped_factors(s, i), q)) / slope;
        if (!(std::abs(step) < 0.5 * std::abs(s) + 1e-12)) continue;
        s = s - step;
        if (round > 0 && std::abs(step) < 1e-12 * std::abs(s)) break;
    }
    DampedRoot root{ComplexWord(Complex(s))};
    root.real = start.imag() == 0;
    for (const Rough& each : q) root.q.emplace_back(Complex(each));
    set_exponent(pencil, root);
    return root;
}

/// Replaces the vector by one of two words. In long chains the elimination in double loses it.
REVCHAIN_LAZY
void sharpen(const DampedPencil& pencil, DampedRoot& root) {
    const ComplexWord unit(Wide<double>(0.0), Wide<double>(1.0));
    std::vector<ComplexWord> q = applied(pencil, damped_factors(root.s, unit, true), root.q);
    const JointSolver<ComplexWord> solver(pencil, damped_factors(root.s, unit));
    for (int round = 0; round < 2; ++round) {
        if (round > 0) q = applied(pencil, damped_factors(root.s, unit, true), q);
        solver.solve(q);
        double largest = 0;
        for (const ComplexWord& each : q) largest = std::max(largest, size_of(each));
        if (!std::isfinite(largest) || largest == 0) return;
        for (ComplexWord& each : q) each = each / ComplexWord(Wide<double>(largest));
        set_trolley(pencil, q);
    }
    root.q = std::move(q);
    set_exponent(pencil, root);
}

/// A complex number and its derivative by s.
struct Dual {
    Rough value{}, slope{};
    Dual() = default;
    Dual(const Rough& x, const Rough& d) : value(x), slope(d) {}
    explicit Dual(const Wide<double>& x) : value(x) {}
    friend Dual operator-(const Dual& x) { return {Complex(-x.value), Complex(-x.slope)}; }
    friend Dual operator+(const Dual& x, const Dual& y) {
        return {x.value + y.value, x.slope + y.slope};
    }
    friend Dual operator-(const Dual& x, const Dual& y) {
        return {x.value - y.value, x.slope - y.slope};
    }
    friend Dual operator*(const Dual& x, const Dual& y) {
        return {x.value * y.value, x.value * y.slope + x.slope * y.value};
    }
    friend Dual operator/(const Dual& x, const Dual& y) {
        const Rough ratio = x.value / y.value;
        return {ratio, (x.slope - ratio * y.slope) / y.value};
    }
};

/// Returns a further exponent by Newton's method on det Q with the known ones divided out (Maehly).
/// `zeros` exponents are 0. In a wide range Eigen loses the smallest ones.
REVCHAIN_LAZY
Complex further_exponent(const DampedPencil& pencil, const std::vector<Complex>& known, Index zeros,
                         Complex s) {
    const Rough i(0, 1), one(1, 0), none(0, 0);
    for (int step = 0; step < 200; ++step) {
        Complex rate = -static_cast<double>(zeros) / s;
        eliminate<Dual>(pencil, damped_factors(Dual(s, one), Dual(i, none)),
                        [&](const Dual& pivot, const Dual&, const Dual&, std::size_t) {
                            rate += pivot.slope / pivot.value;
                        });
        for (const Complex& other : known) rate -= 1.0 / (s - other);
        Complex change = 1.0 / rate;
        if (!std::isfinite(std::abs(change))) break;
        if (std::abs(change) > 2 * std::abs(s)) change *= 2 * std::abs(s) / std::abs(change);
        s -= change;
        if (std::abs(change) < 1e-13 * std::abs(s)) break;
    }
    return s;
}

}  // namespace revchain::pencil
