// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
#include <vector>

#include "revchain/damped_modes.hpp"
#include "revchain/linear/rig_pencil.hpp"
#include "revchain/numeric/complex_words.hpp"
#include "revchain/pencil/jointed.hpp"

/// Finds damped modes: starts from Eigen, refined one by one, proved together.
namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

using DampedPencil = pencil::SignedPencil<Wide<double>>;
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

/// Returns the factors of K + s (C - i G) + s^2 M; `slope`: of its derivative.
template <class F>
pencil::JointFactors<F> damped_factors(const F& s, const F& i, bool slope = false) {
    const F one(Wide<double>(1.0)), none(Wide<double>(0.0));
    if (slope) return {none, -i, one, s + s};
    return {one, none - i * s, s, s * s};
}

/// An exponent in units of `RigPencil::pace`, and its vector of rotations.
struct DampedRoot {
    ComplexWord s{};
    std::vector<ComplexWord> q{};  ///< y^T Q'(s) y = 1
    std::vector<Complex> off{};    ///< Q(s) q
    double correction = 1;         ///< of s at last, relative
    bool real = false;
};

/// Returns a matrix of the family that takes these factors.
REVCHAIN_LAZY
Matrix<double> dense(const DampedPencil& pencil, const pencil::JointFactors<double>& x) {
    struct Number {  // a double made of a double word
        double value = 0;
        Number(double y) : value(y) {}  // NOLINT(google-explicit-constructor)
        explicit Number(const Wide<double>& y) : value(static_cast<double>(y)) {}
        Number operator+(const Number& y) const { return value + y.value; }
        Number operator-(const Number& y) const { return value - y.value; }
        Number operator*(const Number& y) const { return value * y.value; }
    };
    const Index n = pencil.size();
    Matrix<double> result(n, n);
    std::vector<Number> unit(static_cast<std::size_t>(n), Number(0.0));
    const pencil::JointFactors<Number> factors{x.stiffness, x.spin, x.damping, x.mass};
    for (Index j = 0; j < n; ++j) {
        unit[static_cast<std::size_t>(j)] = 1.0;
        const auto column = pencil::applied(pencil, factors, unit);
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

/// Sets the exponent from the vector by the symmetric Rayleigh quotient, q^T Q(s) q = 0, in two
/// words.
REVCHAIN_LAZY
void set_exponent(const DampedPencil& pencil, DampedRoot& root) {
    using W = Wide<double>;
    const ComplexWord unit(W(0.0), W(1.0));
    for (int round = 0; round < 2; ++round) {
        const auto off = pencil::applied(pencil, damped_factors(root.s, unit), root.q);
        const auto slope = pencil::applied(pencil, damped_factors(root.s, unit, true), root.q);
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
    root.off.clear();
    for (const ComplexWord& each : pencil::applied(pencil, damped_factors(root.s, unit), root.q))
        root.off.emplace_back(each);
}

/// Returns the refined exponent next to `start`, with its vector from inverse iteration.
REVCHAIN_LAZY
DampedRoot refined(const DampedPencil& pencil, const Complex& start) {
    const auto n = static_cast<std::size_t>(pencil.size());
    const Rough i(0, 1), none(0, 0);
    Rough s = start;
    std::vector<Rough> q(n), load(n);
    for (std::size_t m = 0; m < n; ++m) load[m] = Complex(1.0 / double(1 + (m * 7) % 11) - 0.3);
    for (int round = 0; round < 4; ++round) {
        pencil::JointSolver<Rough> solver(pencil, damped_factors(s, i));
        for (std::size_t m = 0; m < n; ++m)
            if (!(std::abs(solver.pivot(m)) > 1e-290)) solver.pivot(m) = Complex(1e-290);
        q = load;
        solver.solve(q, none);
        double largest = 0;
        for (const Rough& each : q) largest = std::max(largest, std::abs(each));
        if (!std::isfinite(largest) || largest == 0) break;
        for (Rough& each : q) each = Complex(each) / largest;
        load = pencil::applied(pencil, damped_factors(s, i, true), q);
        const Rough slope = dot(q, load);
        const Rough step = dot(q, pencil::applied(pencil, damped_factors(s, i), q)) / slope;
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
    std::vector<ComplexWord> q =
        pencil::applied(pencil, damped_factors(root.s, unit, true), root.q);
    const pencil::JointSolver<ComplexWord> solver(pencil, damped_factors(root.s, unit));
    for (int round = 0; round < 2; ++round) {
        if (round > 0) q = pencil::applied(pencil, damped_factors(root.s, unit, true), q);
        solver.solve(q, ComplexWord());
        double largest = 0;
        for (const ComplexWord& each : q) largest = std::max(largest, size_of(each));
        if (!std::isfinite(largest) || largest == 0) return;
        for (ComplexWord& each : q) each = each / ComplexWord(Wide<double>(largest));
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
        const auto number = [](const Wide<double>& y, const auto&) { return Dual(y); };
        pencil::eliminate<Dual>(pencil, damped_factors(Dual(s, one), Dual(i, none)), number,
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

/// Returns the sizes of the terms of (factors) q, O(N).
REVCHAIN_LAZY
double sizes_norm(const DampedPencil& pencil, const pencil::JointFactors<double>& x,
                  const std::vector<Complex>& q) {
    struct Size {
        double value = 0;
        Size(double y) : value(y) {}  // NOLINT(google-explicit-constructor)
        explicit Size(const Wide<double>& y) : value(static_cast<double>(y)) {}
        Size operator+(const Size& y) const { return value + y.value; }
        Size operator-(const Size& y) const { return value - y.value; }
        Size operator*(const Size& y) const { return value * y.value; }
    };
    std::vector<Size> sizes;
    for (const Complex& each : q) sizes.emplace_back(std::abs(each));
    const pencil::JointFactors<Size> factors{x.stiffness, x.spin, x.damping, x.mass};
    double sum = 0;
    for (const Size& each : pencil::applied<true>(pencil, factors, sizes))
        sum += each.value * each.value;
    return std::sqrt(sum) * 1.01;
}

/// Products of all vectors: of Y B X - 1 the absolute values, with a bound of their errors.
struct VectorProducts {
    Matrix<double> deviation, error;
};

/// Returns them in double (Z is Rough) or in two words.
template <class Z>
VectorProducts vector_products(const DampedPencil& pencil, const std::vector<DampedRoot>& roots) {
    constexpr bool wide = std::is_same_v<Z, ComplexWord>;
    const auto m = static_cast<Index>(roots.size()), n = pencil.size();
    const double u = (wide ? 16 * operation_error<Wide<double>>() : epsilon<double>()),
                 rounding = double(2 * n + 40) * u;
    const auto made = [](const ComplexWord& z) {
        if constexpr (wide)
            return z;
        else
            return Rough(static_cast<Complex>(z));
    };
    const Z i = made(ComplexWord(Wide<double>(0.0), Wide<double>(1.0))),
            one = made(ComplexWord(Wide<double>(1.0))), none = made(ComplexWord());
    std::vector<std::vector<Z>> x, damped, moved;
    Vector<double> size(m), of_damped(m), of_moved(m), applied_error(m);
    const auto norm = [](const std::vector<Z>& column) {
        double sum = 0;
        for (const Z& each : column) sum += std::norm(Complex(each));
        return std::sqrt(sum) * 1.001;
    };
    for (Index j = 0; j < m; ++j) {
        const DampedRoot& root = roots[static_cast<std::size_t>(j)];
        std::vector<Z> q;
        std::vector<Complex> rough;
        for (const ComplexWord& each : root.q) q.push_back(made(each)), rough.emplace_back(each);
        damped.push_back(pencil::applied(pencil, {none, none - i, one, none}, q));
        moved.push_back(pencil::applied(pencil, {none, none, none, one}, q));
        x.push_back(std::move(q));
        size[j] = norm(x.back()), of_damped[j] = norm(damped.back());
        of_moved[j] = norm(moved.back());
        applied_error[j] = rounding * sizes_norm(pencil, {0, 1, 1, 2 * size_of(root.s)}, rough);
    }
    VectorProducts result{Matrix<double>(m, m), Matrix<double>(m, m)};
    const auto s = [&](Index k) { return made(roots[static_cast<std::size_t>(k)].s); };
    const auto put = [&](Index k, Index j, const Z& by_damping, const Z& by_mass) {
        Z off = by_damping + (s(k) + s(j)) * by_mass;
        if (k == j) off = off - one;
        result.deviation(k, j) = std::abs(Complex(off));
        const double speeds = std::abs(Complex(s(k))) + std::abs(Complex(s(j)));
        result.error(k, j) =
            size[k] * (applied_error[j] + rounding * (of_damped[j] + 2 * speeds * of_moved[j]));
    };
    if constexpr (wide) {
        for (Index k = 0; k < m; ++k) {
            check_interrupt();
            for (Index j = 0; j < m; ++j) {
                const auto& q = x[static_cast<std::size_t>(k)];
                put(k, j, dot(q, damped[static_cast<std::size_t>(j)]),
                    dot(q, moved[static_cast<std::size_t>(j)]));
            }
        }
    } else {
        const auto matrix = [&](const std::vector<std::vector<Z>>& columns) {
            Eigen::MatrixXcd all(n, m);
            for (Index j = 0; j < m; ++j)
                for (Index k = 0; k < n; ++k)
                    all(k, j) = columns[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)];
            return all;
        };
        const Eigen::MatrixXcd rows = matrix(x).transpose();
        const Eigen::MatrixXcd by_damping = rows * matrix(damped), by_mass = rows * matrix(moved);
        for (Index k = 0; k < m; ++k)
            for (Index j = 0; j < m; ++j) put(k, j, Z(by_damping(k, j)), Z(by_mass(k, j)));
    }
    return result;
}

/// Returns for each root a proved bound of its distance from an exact exponent, one to one;
/// infinite where there is no proof. `roots` are all finite exponents, as many as the first-order
/// form has.
REVCHAIN_LAZY
std::vector<double> disc_radii(const DampedPencil& pencil, const std::vector<DampedRoot>& roots,
                               bool in_two_words) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double u = epsilon<double>();
    const auto m = static_cast<Index>(roots.size()), n = pencil.size();
    std::vector<double> radius(roots.size(), infinity);
    const VectorProducts products = in_two_words ? vector_products<ComplexWord>(pencil, roots)
                                                 : vector_products<Rough>(pencil, roots);
    const double deviation =
        (products.deviation + products.error).rowwise().sum().maxCoeff() * 1.01;
    if (!(deviation < 0.25)) return radius;
    Eigen::MatrixXcd X(n, m), off(n, m);
    Vector<double> off_error(m);
    for (Index j = 0; j < m; ++j) {
        const DampedRoot& root = roots[static_cast<std::size_t>(j)];
        std::vector<Complex> rough;
        for (const ComplexWord& each : root.q) rough.emplace_back(each);
        for (Index k = 0; k < n; ++k)
            X(k, j) = rough[static_cast<std::size_t>(k)],
                 off(k, j) = root.off[static_cast<std::size_t>(k)];
        const double a = size_of(root.s);
        off_error[j] = 0x1p-96 * sizes_norm(pencil, {1, a, a, a * a}, rough);
    }
    const Eigen::MatrixXcd error = X.transpose() * off;
    const double spread = deviation / (1 - deviation), rounding = double(2 * n + 40) * u;
    Matrix<double> H(m, m);
    for (Index j = 0; j < m; ++j) {
        const double blur = off_error[j] + rounding * off.col(j).norm();
        double largest = 0;
        for (Index k = 0; k < m; ++k) {
            H(k, j) = std::abs(error(k, j)) + X.col(k).norm() * blur;
            largest = std::max(largest, H(k, j));
        }
        for (Index k = 0; k < m; ++k) H(k, j) = (H(k, j) + spread * largest) * 1.01;
    }
    // Gershgorin after scaling one coordinate: its own disc shrinks as the others' grow.
    const Vector<double> rows = H.rowwise().sum();
    for (Index k = 0; k < m; ++k) {
        const ComplexWord& own = roots[static_cast<std::size_t>(k)].s;
        double grow = 0;
        Vector<double> apart(m);
        for (Index j = 0; j < m; ++j) {
            if (j == k) continue;
            apart[j] = size_of(roots[static_cast<std::size_t>(j)].s - own) * (1 - 8 * u);
            const double room = apart[j] / 2 - rows[j];
            if (!(room > 0)) {
                grow = infinity;
                break;
            }
            grow = std::max(grow, H(j, k) / room);
        }
        const double found = (H(k, k) + grow * (rows[k] - H(k, k))) * 1.01;
        bool alone = std::isfinite(found) && grow < 1;
        for (Index j = 0; j < m && alone; ++j) alone = j == k || found < apart[j] / 2 * (1 - 8 * u);
        if (alone) radius[static_cast<std::size_t>(k)] = found;
    }
    return radius;
}

}  // namespace detail

REVCHAIN_DEFINE
DampedModes damped_modes(const Rig& rig, const DampedModesOptions& options) {
    using namespace detail;
    require_positive("damped_modes", "gravity", options.gravity);
    if (options.first < 1) throw_invalid("damped_modes", "first must be at least 1", options.first);
    if (options.count && *options.count < 1)
        throw_invalid("damped_modes", "count must be at least 1", *options.count);
    constexpr Index most_links = 1000;
    if (rig.size() > most_links)
        throw_invalid("damped_modes", "a rig with dashpots may have at most 1000 links, not",
                      rig.size());
    if (rig.fluid() == Fluid::turning && rig.is_damped())
        throw_invalid("damped_modes",
                      "dashpots and a fluid that turns are not solved together; links", rig.size());
    const RigPencil system = rig_pencil(rig, options.gravity, {}, true);
    const DampedPencil& pencil = system.pencil;
    DampedModes result;
    result.first = options.first, result.has_momentum = rig.has_momentum();
    // A trolley with a dashpot rests anywhere: one exponent is 0. Without it the momentum is
    // constant, and its offset follows from the links'.
    const bool free = rig.support().is_free();
    const bool drifts = free && rig.support().damping == Wide<double>(0.0);
    result.rigid = free ? 1 : 0;
    DampedMatrices matrices(pencil);
    if (drifts) matrices.leave_out_trolley();
    const FirstExponents first =
        result.has_momentum
            ? first_exponents<Complex>(
                  matrices.K.cast<Complex>(),
                  matrices.C.cast<Complex>() - Complex(0, 1) * matrices.G.cast<Complex>(),
                  matrices.M)
            : first_exponents<double>(matrices.K, matrices.C, matrices.M);
    advance(options.progress, 0.3);
    std::vector<DampedRoot> roots;
    std::vector<Complex> starts = first.s;
    if (free && !drifts && !starts.empty())  // the exponent that is 0
        starts.erase(std::min_element(
            starts.begin(), starts.end(),
            [](const Complex& x, const Complex& y) { return std::abs(x) < std::abs(y); }));
    const Index freedoms = pencil.size() - (drifts ? 1 : 0), zeros = free && !drifts ? 1 : 0;
    std::vector<Complex> known;  // with conjugates
    const auto take = [&](const Complex& start) {
        check_interrupt();
        DampedRoot root = refined(pencil, start);
        const auto s = static_cast<Complex>(root.s);
        const bool pair = !result.has_momentum && !root.real;
        const bool again = std::any_of(known.begin(), known.end(),
                                       [&](const Complex& other) {
                                           return std::abs(other - s) <= 1e-9 * std::abs(s);
                                       }) ||
                           !(root.correction < 1e-3) || (pair && !(s.imag() > 0));
        if (again) return;
        known.push_back(s);
        if (pair) known.push_back(std::conj(s));
        roots.push_back(std::move(root));
    };
    for (const Complex& s : starts)
        if (result.has_momentum || s.imag() >= 0) take(s);
    const auto missing = [&] { return 2 * freedoms - zeros - static_cast<Index>(known.size()); };
    for (int attempt = 0; first.inertia && attempt < 12 && missing() > 0; ++attempt) {
        double least = std::numeric_limits<double>::infinity();
        for (const Complex& s : known) least = std::min(least, std::abs(s));
        if (!std::isfinite(least)) least = 1;
        const Complex beside(-1, attempt % 2 == 0 && missing() > 1 ? 0.7 : 0);
        Complex s = further_exponent(pencil, known, drifts ? 2 : zeros,
                                     beside * least * std::pow(10.0, -2.0 * (attempt / 2)));
        if (!result.has_momentum && std::abs(s.imag()) < 1e-6 * std::abs(s)) s = s.real();
        if (!result.has_momentum && s.imag() < 0) s = std::conj(s);
        take(s);
    }
    std::sort(roots.begin(), roots.end(),
              [](const DampedRoot& x, const DampedRoot& y) { return size_of(x.s) < size_of(y.s); });
    advance(options.progress, 0.6);
    std::vector<std::size_t> at;  // of each root among all
    const auto radii = [&](bool in_two_words) {
        std::vector<DampedRoot> all;
        at.clear();
        for (const DampedRoot& root : roots) {
            at.push_back(all.size());
            all.push_back(root);
            if (result.has_momentum || root.real) continue;
            DampedRoot& other = all.emplace_back(root);
            other.s.imag = -other.s.imag;
            for (ComplexWord& each : other.q) each.imag = -each.imag;
            for (Complex& each : other.off) each = std::conj(each);
        }
        if (free && !drifts) {  // the motion of the whole, s = 0
            DampedRoot& rest = all.emplace_back();
            rest.q.resize(static_cast<std::size_t>(pencil.size()));
            rest.off.resize(rest.q.size());
            rest.q.back() = ComplexWord(Wide<double>(1.0) / sqrt(pencil.joints.back().damping));
        }
        if (!first.inertia || static_cast<Index>(all.size()) != 2 * freedoms)
            return std::vector<double>(all.size(), std::numeric_limits<double>::infinity());
        return disc_radii(pencil, all, in_two_words);
    };
    const auto sharp = [&](const std::vector<double>& radius) {
        for (std::size_t k = 0; k < roots.size(); ++k)
            if (!(radius[at[k]] <= 0x1p-60 * size_of(roots[k].s))) return false;
        return true;
    };
    std::vector<double> radius = radii(false);
    if (first.inertia && !sharp(radius)) {
        for (DampedRoot& root : roots) sharpen(pencil, root);
        radius = radii(true);
    }
    result.available = static_cast<Index>(roots.size());
    const Index count = std::clamp<Index>(result.available - options.first + 1, 0,
                                          options.count.value_or(result.available));
    result.exponent.resize(count), result.error_bound.resize(count);
    result.error_estimate.resize(count), result.shapes.resize(count, rig.size() + 1);
    result.complete = true;
    for (std::size_t k = 0; k < roots.size(); ++k)
        result.complete = result.complete && radius[at[k]] < 0.4 * size_of(roots[k].s);
    if (!result.complete) result.status = Status::tolerance_not_met;
    const double ulp = epsilon<double>(), pace = static_cast<double>(system.pace);
    for (Index j = 0; j < count; ++j) {
        const auto k = static_cast<std::size_t>(options.first - 1 + j);
        const DampedRoot& root = roots[k];
        const ComplexWord s = root.s * ComplexWord(system.pace);
        result.exponent[j] = static_cast<Complex>(s);
        const double size = size_of(root.s);
        const double rounded = size_of(s - ComplexWord(result.exponent[j])) / (pace * size);
        const double bound = (radius[at[k]] / size + rounded + 0x1p-95) * (1 + 8 * ulp);
        const bool proved = bound < 0.5;
        result.error_bound[j] = proved ? bound : std::numeric_limits<double>::infinity();
        result.error_estimate[j] = proved ? bound : rounded + root.correction;
        std::vector<Complex> offset(static_cast<std::size_t>(pencil.size()) + 1, 0.0);
        const bool yields = !rig.support().is_firm();
        const auto links = static_cast<std::size_t>(pencil.size()) - (yields ? 1 : 0);
        if (yields) offset[links] = static_cast<Complex>(root.q[links]);
        for (std::size_t m = links; m-- > 0;)
            offset[m] = offset[m + 1] + static_cast<double>(pencil.joints[m].lever) *
                                            static_cast<Complex>(root.q[m]);
        Complex largest = offset[0];
        for (const Complex& y : offset)
            if (std::abs(y) > std::abs(largest) * (1 + 8 * ulp)) largest = y;
        const auto idle = static_cast<std::size_t>(system.idle);
        for (std::size_t m = 0; m <= static_cast<std::size_t>(rig.size()); ++m)
            result.shapes(j, static_cast<Index>(m)) = offset[m < idle ? 0 : m - idle] / largest;
    }
    advance(options.progress, 1);
    return result;
}

}  // namespace revchain
