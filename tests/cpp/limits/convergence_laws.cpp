// SPDX-License-Identifier: MPL-2.0
// Chains of many links against the uncut chain: not only the order of convergence but its coefficient.
#include <Eigen/LU>
#include <cmath>
#include <map>
#include <tuple>

#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/cuttings.hpp"

namespace {

using revchain::Index;
using revchain::Matrix;
using revchain::Vector;
using support::BesselZero;
using support::Cutting;

/// Relative difference of the conical heights from the uncut chain's, and the bound on what rounding adds to it.
template <class T>
struct Differences {
    Vector<T> value, bound;
};

template <class T>
Differences<T> differences(const Cutting<T>& cutting, Index size, Index count) {
    const auto m = revchain::modes(cutting.make(size), {.count = count});
    Differences<T> result{Vector<T>(count), Vector<T>(count)};
    for (Index k = 0; k < count; ++k) {
        const T uncut =
            (T(size) + cutting.excess) * support::uncut_height(support::bessel_zeros<T>[static_cast<std::size_t>(k)]);
        result.value[k] = (m.conical_height[k] - uncut) / uncut;
        result.bound[k] = m.error_bound[k] + T(4) * revchain::epsilon<T>();  // and of `uncut` itself
    }
    return result;
}

/// A term M^-power (log M)^logs of an expansion.
struct Term {
    int power, logs;
};

/// What the difference times M^order tends to as M grows, and the term in 1/M: the terms are fitted exactly through as
/// many sizes.
template <class T>
Vector<T> limit(const std::vector<Term>& terms, const std::vector<T>& M, const std::vector<T>& scaled) {
    const Index n = static_cast<Index>(terms.size());
    Matrix<T> A(n, n);
    Vector<T> b(n);
    const T unit = M[M.size() - terms.size()];  // keeps the columns comparable
    for (Index i = 0; i < n; ++i) {
        const std::size_t s = M.size() - terms.size() + static_cast<std::size_t>(i);
        const T x = M[s] / unit;
        for (Index l = 0; l < n; ++l) {
            const auto [power, logs] = terms[static_cast<std::size_t>(l)];
            A(i, l) = std::pow(x, -T(power)) * std::pow(std::log(x), T(logs));
        }
        b[i] = scaled[s];
    }
    Vector<T> c = A.partialPivLu().solve(b);
    for (Index l = 0; l < n; ++l) c[l] *= std::pow(unit, T(terms[static_cast<std::size_t>(l)].power));  // logs: 0 only
    return c;
}

/// Which powers follow the leading one. Rigid links of pendulum length other than 3a/4 feel the singular free end,
/// which brings logarithms: extrapolation in powers alone stalls at seven digits there.
const std::vector<Term> powers = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}};
const std::vector<Term> even_powers = {{0, 0}, {2, 0}, {2, 1}, {3, 0}, {4, 0}, {4, 1}, {4, 2}, {5, 0}};
const std::vector<Term> all_terms = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {3, 0}, {3, 1}, {4, 0}, {4, 1}};

const std::vector<Index> sizes = {40, 60, 80, 120, 160, 240, 320, 480, 640};

}  // namespace

TEST_CASE("the laws of convergence to the uncut chain: coefficients of modes 1 to 3", "[sweep][convergence]") {
    using T = long double;  // in double the differences lose 2 ulp M^2: six digits of the coefficient
    // Relative error of the extrapolated coefficient, modes 1, 2, 3: between once and twice the measured one.
    const std::map<std::string, std::array<double, 3>> tolerance = {
        {"lower pins", {2e-15, 1e-14, 2e-13}},   {"upper pins", {4e-15, 2e-14, 2e-13}},
        {"cell centres", {1e-11, 6e-13, 5e-13}}, {"cell centres, half thread", {7e-12, 9e-13, 8e-13}},
        {"l = a", {1e-12, 2e-11, 5e-9}},         {"l = 5a/6", {4e-12, 2e-12, 2e-10}},
        {"l = 3a/4", {5e-12, 2e-12, 3e-10}},     {"rods", {1e-12, 3e-12, 1e-10}},
        {"l = a/2", {1e-12, 1e-11, 4e-9}},       {"shifted ends", {2e-8, 2e-8, 8e-8}},
    };
    for (const Cutting<T>& cutting : support::cuttings<T>()) {
        std::array<std::vector<T>, 3> scaled;
        std::vector<T> M;
        for (const Index size : sizes) {
            M.push_back(T(size) + cutting.excess);
            const Differences<T> d = differences(cutting, size, 3);
            for (Index k = 0; k < 3; ++k)
                scaled[static_cast<std::size_t>(k)].push_back(d.value[k] * std::pow(M.back(), T(cutting.order)));
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const BesselZero<T>& zero = support::bessel_zeros<T>[k];
            const std::vector<Term>& terms = cutting.order == 1 ? powers : cutting.order == 2 ? even_powers : all_terms;
            const Vector<T> fit = limit(terms, M, scaled[k]);
            const T law = cutting.law(zero.j, zero.J);
            const double error = static_cast<double>(std::abs((fit[0] - law) / law));
            INFO(cutting.name << ", mode " << zero.mode << ": law " << law << ", measured " << fit[0]
                              << ", relative error " << error);
            CHECK(error <= tolerance.at(cutting.name)[k]);
            if (cutting.order > 1) continue;
            // Second order of the weights at either pin: (2 - j^2)/48, the same for both.
            const T second = (T(2) - zero.j * zero.j) / T(48);
            const double second_error = static_cast<double>(std::abs((fit[1] - second) / second));
            INFO("second order: law " << second << ", measured " << fit[1] << ", relative error " << second_error);
            CHECK(second_error <= std::array{2e-11, 3e-11, 1.5e-10}[k]);
        }
    }
}

TEMPLATE_TEST_CASE("the laws hold within rounding for many links", "[sweep][convergence]", double, long double) {
    // What is left beside the law is of the next order, but for what the proved bound allows. In double the bound is the
    // larger of the two from ten thousand links on where the order is 2.
    using T = TestType;
    for (const Cutting<T>& cutting : support::cuttings<T>()) {
        for (const Index size : {Index{1000}, Index{20000}}) {
            const Differences<T> d = differences(cutting, size, 3);
            const T M = T(size) + cutting.excess;
            for (Index k = 0; k < 3; ++k) {
                const BesselZero<T>& zero = support::bessel_zeros<T>[static_cast<std::size_t>(k)];
                const T law = cutting.law(zero.j, zero.J) * std::pow(M, -T(cutting.order));
                const T next = std::abs(law) *
                               (cutting.order == 2 ? std::pow(zero.j / M, T(2)) * std::log(M) : zero.j * zero.j / M);
                INFO(cutting.name << ", N = " << size << ", mode " << zero.mode << ": law " << law << ", difference "
                                  << d.value[k] << ", next order " << next << ", rounding " << d.bound[k]);
                CHECK(std::abs(d.value[k] - law) <= next + d.bound[k]);
            }
        }
    }
}
