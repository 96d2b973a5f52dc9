// SPDX-License-Identifier: MPL-2.0
// What the tests of the paper's sections share. Truths are closed forms in quadruple precision, fed with the very
// numbers the chain stores, so that nothing but the library's own error is measured.
#pragma once

#include <initializer_list>
#include <vector>

#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

namespace paper {

using revchain::Chain;
using revchain::Index;
using revchain::Link;
using support::error_in_ulp;
using support::Quad;
using support::quad;
using support::Random;

/// A link's numbers in the paper's letters.
struct Letters {
    Quad W, a, h, l, rho2;
};

template <class T>
Letters letters(const Link<T>& link) {
    const Quad h = quad(link.centroid), rho2 = quad(link.gyration_ratio) * quad(link.length) * quad(link.length);
    return {quad(link.weight), quad(link.length), h, h == 0 ? Quad(0) : h + rho2 / h, rho2};
}

/// Links of the paper's kind, index 1 the lowest as in the paper.
template <class T>
std::vector<Letters> letters(const Chain<T>& chain) {
    std::vector<Letters> result(1);
    for (Index m = 0; m < chain.size(); ++m) result.push_back(letters(chain.link(m)));
    return result;
}

/// As many heights as true ones, each within its proved bound and, in double and long double, correctly rounded (in
/// float 1 in 250 chains of extreme weight ratio is not: 2.0 ulp, its bound, was reached).
template <class T>
void check_heights(const revchain::Modes<T>& m, const std::vector<Quad>& truth) {
    REQUIRE(m.size() == static_cast<Index>(truth.size()));
    for (Index k = 0; k < m.size(); ++k) {
        const double error = error_in_ulp(m.conical_height[k], truth[static_cast<std::size_t>(k)]);
        const double bound = static_cast<double>(m.error_bound[k] / revchain::epsilon<T>());
        INFO("mode " << k + 1 << ": height " << m.conical_height[k] << ", error " << error << " ulp, bound " << bound);
        CHECK(error <= bound);
        CHECK(error <= (std::is_same_v<T, float> ? 2.0 : 0.5));
    }
}

/// Both roots of lambda^2 - sum lambda + product = 0, the larger first; sqrt(discriminant) is given because only the
/// caller can write it without cancellation.
inline std::vector<Quad> roots(Quad sum, Quad product, Quad discriminant) {
    const Quad larger = (sum + sqrtq(discriminant)) / 2;
    return {larger, product / larger};
}

/// A rigid link as they come: centroid anywhere from the upper pin to beyond the lower one, l on either side of a.
template <class T>
Link<T> random_link(Random& random) {
    const double a = random.between(0.5, 1.5);
    const T weight = static_cast<T>(random.log_between(0.1, 10.0));
    return revchain::compound_pendulum<T>({.weight = weight,
                                           .length = static_cast<T>(a),
                                           .centroid = static_cast<T>(a * random.between(0.1, 1.2)),
                                           .radius_of_gyration = static_cast<T>(a * random.between(0.0, 0.8))});
}

template <class T>
Chain<T> random_chain(Random& random, Index size) {
    std::vector<Link<T>> links;
    for (Index m = 0; m < size; ++m) links.push_back(random_link<T>(random));
    return Chain<T>(links);
}

/// Offsets of mode k (from 0) in quadruple precision, index = pin.
template <class T>
std::vector<Quad> offsets(const revchain::Modes<T>& m, Index k) {
    std::vector<Quad> y;
    for (Index pin = 0; pin < m.shapes().cols(); ++pin) y.push_back(quad(m.shapes()(k, pin)));
    return y;
}

/// A relation between offsets, sum of coefficient x offset = 0: |sum| over the sum of |coefficients|, in ulp of double.
/// Offsets are scaled to at most 1, so this is the error in ulp of the largest offset that would explain what is left.
inline double imbalance(std::initializer_list<std::pair<Quad, Quad>> terms) {
    Quad sum = 0, size = 0;
    for (const auto& [coefficient, offset] : terms) {
        sum += coefficient * offset;
        size += fabsq(coefficient);
    }
    return static_cast<double>(fabsq(sum) / size) / std::numeric_limits<double>::epsilon();
}

}  // namespace paper
