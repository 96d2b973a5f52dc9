// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/damped/exponents.hpp"

/// Discs that hold one exponent each, from all vectors together (docs/theory/damping.md).

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// Returns the sizes of the terms of (factors) q, O(N).
REVCHAIN_LAZY
double sizes_norm(const DampedPencil& pencil, const JointFactors<double>& x,
                  const std::vector<Complex>& q) {
    std::vector<Number> sizes;
    for (const Complex& each : q) sizes.emplace_back(std::abs(each));
    const JointFactors<Number> factors{x.stiffness, x.spin, x.damping, x.mass};
    double sum = 0;
    for (const Number& each : applied<true>(pencil, factors, sizes)) sum += each.value * each.value;
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
        for (const ComplexWord& each : root.q) q.push_back(made(each));
        damped.push_back(applied(pencil, {none, none - i, one, none}, q));
        moved.push_back(applied(pencil, {none, none, none, one}, q));
        x.push_back(std::move(q));
        size[j] = norm(x.back()), of_damped[j] = norm(damped.back());
        of_moved[j] = norm(moved.back());
        applied_error[j] =
            rounding * sizes_norm(pencil, {0, 1, 1, 2 * size_of(root.s)}, in_double(root.q));
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
            revchain::detail::check_interrupt();
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
        const std::vector<Complex> rough = in_double(root.q);
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

}  // namespace revchain::pencil
