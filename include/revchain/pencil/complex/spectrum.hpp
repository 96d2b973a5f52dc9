// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Eigenvalues>  // seconds of compile time: only who solves densely includes this header
#include <algorithm>
#include <functional>

#include "revchain/pencil/complex/complex_word.hpp"
#include "revchain/pencil/signed.hpp"

/// All x with det Q(x) = 0, real or not, of a family whose numbers have any sign: what counts cannot number.
namespace revchain::pencil {

/// An x, how far (in the plane) the exact one may be from it, and whether that is proved.
struct EnclosedRoot {
    ComplexWord x{};                                          ///< to some 30 digits where roots are apart
    std::complex<double> value{};                             ///< rounded; real where x is to 1e-22
    double radius = std::numeric_limits<double>::infinity();  ///< about `value`; finite: an exact root lies within
    bool is_real = false;
};

/// Roots by size, largest first. `proved`: each disc holds exactly one root, all others of det Q are 0.
struct ComplexSpectrum {
    std::vector<EnclosedRoot> roots;
    bool proved = false;
};

namespace detail {

/// P'/P - zeros/x of P(x) = det Q(x): the sum of p'/p over the pivots. V: ComplexWord, or Disc with the entries'
/// errors.
template <class V, class Number>
V log_derivative(const SignedPencil<Wide<double>>& pencil, const V& x, Index zeros, const Number& number) {
    using S = Wide<double>;
    const Factors<V> f = pencil.factors(x), g = pencil.slopes(x);
    V below = S(0.0), slope_below = S(0.0), sum = S(0.0);
    for (const SignedElement<S>& e : pencil.elements) {
        const ElementError<double>& off = e.error;
        const V k = number(e.stiffness, off.stiffness), s = number(e.spin, off.spin);
        const V L = f.stiffness * k + f.spin * s, slope = g.stiffness * k + g.spin * s;
        const V p = below + (L - number(e.lower, off.lower)), q = (L + number(e.cross, off.cross)) / p;
        const V p_slope = slope_below + slope;
        sum = sum + p_slope / p;
        below = (L - number(e.upper, off.upper)) - (L + number(e.cross, off.cross)) * q;
        slope_below = slope - (q + q) * slope + q * q * p_slope;
    }
    return zeros == 0 ? sum : sum - V(S(static_cast<double>(zeros))) / x;
}

/// Elements without stiffness: det K is the product of all stiffnesses, and each that is 0 takes 1 from the degree of
/// det Q.
inline Index without_stiffness(const SignedPencil<Wide<double>>& pencil) {
    Index count = 0;
    for (const auto& e : pencil.elements) count += e.stiffness == Wide<double>(0.0) && e.error.stiffness == 0;
    return count;
}

/// First values in double: the eigenvalues of K^-1 M, or of the companion of x^2 + x K^-1 G - K^-1 M, less the `zeros`
/// smallest and, of elements without stiffness, the largest. K^-1 from the flexibilities, which add without
/// cancellation where all are positive.
inline std::vector<std::complex<double>> first_roots(const SignedPencil<Wide<double>>& pencil, Index zeros) {
    const Index n = pencil.size();
    Matrix<double> M = Matrix<double>::Zero(n + 1, n + 1), G = M, F = Matrix<double>::Zero(n, n);
    double largest = 0;
    for (const auto& e : pencil.elements) largest = std::max(largest, std::abs(static_cast<double>(e.stiffness)));
    if (largest == 0) largest = 1;
    for (Index m = 0; m < n; ++m) {
        const auto& e = pencil.elements[static_cast<std::size_t>(m)];
        M(m, m) += static_cast<double>(e.lower), M(m + 1, m + 1) += static_cast<double>(e.upper);
        M(m, m + 1) += static_cast<double>(e.cross), M(m + 1, m) += static_cast<double>(e.cross);
        const double s = static_cast<double>(e.spin), k = static_cast<double>(e.stiffness);
        G(m, m) += s, G(m + 1, m + 1) += s, G(m, m + 1) -= s, G(m + 1, m) -= s;
        const double flexibility = 1 / (k == 0 ? 1e-16 * largest : k);
        F.topLeftCorner(m + 1, m + 1).array() += flexibility;
    }
    const Matrix<double> mass = F * M.topLeftCorner(n, n);
    Matrix<double> system = mass;
    double pace = 1;  // unit of x in which the two halves of the companion are alike
    if (pencil.quadratic) {
        pace = std::sqrt(std::max(mass.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min()));
        system = Matrix<double>::Zero(2 * n, 2 * n);
        system.topRightCorner(n, n).setIdentity();
        system.bottomLeftCorner(n, n) = mass / (pace * pace);
        system.bottomRightCorner(n, n) = F * G.topLeftCorner(n, n) / -pace;
    }
    const Eigen::EigenSolver<Matrix<double>> solver(system, false);
    std::vector<std::complex<double>> roots;
    for (Index i = 0; i < system.rows(); ++i) {
        const std::complex<double> root = solver.eigenvalues()[i] * pace;
        roots.push_back(std::isfinite(std::abs(root)) ? root : pace);  // a start is all that is wanted
    }
    std::sort(roots.begin(), roots.end(), [](const auto& x, const auto& y) { return std::abs(x) > std::abs(y); });
    roots.erase(roots.begin(), roots.begin() + without_stiffness(pencil));
    roots.resize(roots.size() - std::min(static_cast<std::size_t>(zeros), roots.size()));
    for (std::size_t i = 0; i < roots.size(); ++i) {  // Aberth's method cannot part what is equal
        if (std::abs(roots[i]) == 0) roots[i] = std::numeric_limits<double>::min();
        if (i > 0 && roots[i] == roots[i - 1])
            roots[i] *= std::complex<double>(1 + 1e-10 * static_cast<double>(i), 1e-10);
    }
    return roots;
}

/// All roots at once by Newton's method with the others divided out (Ehrlich, Aberth), each until it stands still.
inline void refine(const SignedPencil<Wide<double>>& pencil, Index zeros, std::vector<ComplexWord>& roots,
                   const std::function<void(double)>& advance) {
    using S = Wide<double>;
    constexpr int sweeps = 60;
    std::vector<double> last(roots.size(), std::numeric_limits<double>::infinity());
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        bool moved = false;
        for (std::size_t i = 0; i < roots.size(); ++i) {
            if (last[i] == 0) continue;
            ComplexWord rate =
                log_derivative(pencil, roots[i], zeros, [](const S& x, double) { return ComplexWord(x); });
            for (std::size_t j = 0; j < roots.size(); ++j) {
                if (j == i) continue;
                const ComplexWord apart = roots[i] - roots[j];
                if (size_of(apart) > 0) rate = rate - ComplexWord(S(1.0)) / apart;
            }
            const ComplexWord step = ComplexWord(S(1.0)) / rate;
            const double share = size_of(step) / size_of(roots[i]);
            const bool finite = std::isfinite(share);
            if (finite) roots[i] = roots[i] - step;
            // At the last digits steps no longer shrink.
            const bool stands = !finite || share < 1e-29 || (share < 1e-20 && share > last[i] / 4);
            last[i] = stands ? 0 : share;
            moved = moved || !stands;
        }
        advance(static_cast<double>(sweep + 1) / sweeps);
        if (!moved) break;
    }
}

/// Discs that hold exactly one root each, by two facts about a polynomial of degree d with P'(c)/P(c) = w: some root
/// lies within d/|w| of c, so that d discs that are apart hold one each, whatever less than d the degree were; and with
/// all the others in discs of their own (c_j, r_j), the last is within 1/(|w| - sum 1/(|c - c_j| - r_j)). Returns
/// whether the discs are apart.
inline bool enclose(const SignedPencil<Wide<double>>& pencil, Index zeros, Index degree,
                    std::vector<EnclosedRoot>& roots) {
    using S = Wide<double>;
    std::vector<double> least(roots.size()),
        beside(roots.size(), 0.0);  // |P'/P| is at least that, so far from the value
    for (std::size_t i = 0; i < roots.size(); ++i) {
        roots[i].radius = std::numeric_limits<double>::infinity();
        for (const double share :
             {0.0, 0x1p-64, 0x1p-56}) {  // at the very root, or where a pivot vanishes, P'/P is none
            const ComplexWord at(roots[i].value), aside = at + at * ComplexWord(S(share));
            const Disc rate = log_derivative(pencil, Disc(aside), zeros,
                                             [](const S& x, double off) { return Disc(ComplexWord(x), off); });
            least[i] = size_of(rate.centre) * (1 - 8 * epsilon<double>()) - rate.radius;
            beside[i] = 1.01 * share * std::abs(roots[i].value);
            const double radius = static_cast<double>(degree) / least[i] * (1 + 8 * epsilon<double>()) + beside[i];
            if (!(least[i] > 0 && std::isfinite(radius))) continue;
            roots[i].radius = radius;
            break;
        }
    }
    const auto apart = [&](std::size_t i, std::size_t j) {
        return std::abs(roots[i].value - roots[j].value) * (1 - 8 * epsilon<double>());
    };
    bool disjoint = static_cast<Index>(roots.size()) == degree;
    for (std::size_t i = 0; i < roots.size(); ++i) {
        disjoint = disjoint && roots[i].radius < std::abs(roots[i].value);
        if (!roots[i].is_real) disjoint = disjoint && roots[i].radius < std::abs(roots[i].value.imag());
        for (std::size_t j = 0; j < i; ++j) disjoint = disjoint && apart(i, j) > roots[i].radius + roots[j].radius;
    }
    if (!disjoint) return false;
    std::vector<double> sharper(roots.size());
    for (std::size_t i = 0; i < roots.size(); ++i) {
        double others = 0;
        for (std::size_t j = 0; j < roots.size(); ++j)
            if (j != i) others += 1 / (apart(i, j) - roots[j].radius - beside[i]);
        const double rest = least[i] - others * (1 + 2 * static_cast<double>(roots.size()) * epsilon<double>());
        const double sharp = 1 / rest * (1 + 8 * epsilon<double>()) + beside[i];
        sharper[i] = rest > 0 ? std::min(roots[i].radius, sharp) : roots[i].radius;
    }
    for (std::size_t i = 0; i < roots.size(); ++i) roots[i].radius = sharper[i];
    return true;
}

}  // namespace detail

/// Every x with det Q(x) = 0, but for `zeros` that are surely at 0. Preconditions: at least one element.
///
/// Method: dense eigenvalues in double, refined all at once in two words (Aberth), and enclosed in discs of complex
/// double words that take in the entries' errors. A root whose disc meets the real axis alone is real, since the
/// conjugate of one in it would be another. Cost O(N^3) for the first values; then 1 microsecond for each root, link
/// and sweep. `advance(share)` is called after every sweep and may throw.
inline ComplexSpectrum complex_spectrum(const SignedPencil<Wide<double>>& pencil, Index zeros,
                                        const std::function<void(double)>& advance) {
    std::vector<ComplexWord> words;
    for (const std::complex<double>& root : detail::first_roots(pencil, zeros)) words.emplace_back(root);
    detail::refine(pencil, zeros, words, advance);
    ComplexSpectrum result;
    for (const ComplexWord& x : words) {
        EnclosedRoot root{x, std::complex<double>(x)};
        root.is_real = std::abs(root.value.imag()) <= 1e-22 * std::abs(root.value);
        if (root.is_real) root.value = root.value.real(), root.x.imag = Wide<double>(0.0);
        result.roots.push_back(root);
    }
    std::sort(result.roots.begin(), result.roots.end(), [](const EnclosedRoot& x, const EnclosedRoot& y) {
        return std::pair(std::abs(x.value), x.value.imag()) > std::pair(std::abs(y.value), y.value.imag());
    });
    const Index degree = (pencil.quadratic ? 2 : 1) * pencil.size() - zeros - detail::without_stiffness(pencil);
    result.proved = detail::enclose(pencil, zeros, degree, result.roots);
    return result;
}

}  // namespace revchain::pencil
