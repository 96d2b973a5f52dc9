// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "revchain/numeric/scalar.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// A product or quotient as a fraction times a power of two, so no intermediate result overflows or
/// underflows. Accuracy: half an ulp for each factor after the first, and for each sum.
template <Real T>
struct Product {
    T fraction = T(1);
    int exponent = 0;

    Product times(const T& x) const { return times(of(x)); }
    Product times(const Product& x) const { return {fraction * x.fraction, exponent + x.exponent}; }
    Product over(const T& x) const { return over(of(x)); }
    Product over(const Product& x) const { return {fraction / x.fraction, exponent - x.exponent}; }
    Product plus(const Product& x) const {
        using std::ldexp;
        if (x.fraction == T(0)) return *this;
        if (fraction == T(0)) return x;
        const int common = std::max(exponent, x.exponent);
        return {ldexp(fraction, exponent - common) + ldexp(x.fraction, x.exponent - common),
                common};
    }
    Product plus(const T& x) const { return plus(of(x)); }
    Product root() const {
        using std::ldexp, std::sqrt;
        const int odd = exponent & 1;
        return {sqrt(ldexp(fraction, odd)), (exponent - odd) / 2};
    }
    T value() const {
        using std::ldexp;
        return ldexp(fraction, exponent);
    }
    static Product of(const T& x) {
        using std::frexp;
        int power = 0;
        const T digits = frexp(x, &power);
        return {digits, power};
    }
};

}  // namespace revchain::detail
