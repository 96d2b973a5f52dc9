// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <complex>

#include "revchain/numeric/double_double.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// These are products and quotients of complex numbers of two words, also for Eigen. The standard
/// does not specify std::complex's operators for such scalars, and those of libc++ do not compile.
inline std::complex<DoubleDouble> operator*(const std::complex<DoubleDouble>& x,
                                            const std::complex<DoubleDouble>& y) {
    return {x.real() * y.real() - x.imag() * y.imag(), x.real() * y.imag() + x.imag() * y.real()};
}
inline std::complex<DoubleDouble> operator/(const std::complex<DoubleDouble>& x,
                                            const std::complex<DoubleDouble>& y) {
    const DoubleDouble size = y.real() * y.real() + y.imag() * y.imag();
    return {(x.real() * y.real() + x.imag() * y.imag()) / size,
            (x.imag() * y.real() - x.real() * y.imag()) / size};
}

}  // namespace revchain
