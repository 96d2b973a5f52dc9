// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include "revchain/core/scalar.hpp"

namespace revchain::detail {

/// A product or quotient of numbers that are not negative, held as a fraction times a power of two: no intermediate
/// result overflows or underflows. Accuracy: half an ulp for each factor after the first.
template <Real T>
struct Product {
    T fraction = T(1);
    int exponent = 0;

    Product times(const T& x) const {
        using std::frexp;
        int power = 0;
        const T digits = frexp(x, &power);
        return {fraction * digits, exponent + power};
    }
    Product over(const T& x) const {
        using std::frexp;
        int power = 0;
        const T digits = frexp(x, &power);
        return {fraction / digits, exponent - power};
    }
    T value() const {
        using std::ldexp;
        return ldexp(fraction, exponent);
    }
    /// Its square root.
    T root() const {
        using std::ldexp;
        using std::sqrt;
        const int odd = exponent & 1;
        return ldexp(sqrt(ldexp(fraction, odd)), (exponent - odd) / 2);
    }
};

}  // namespace revchain::detail
