// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_sf_bessel.h>

#include <stdexcept>
#include <string>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD::analytic::detail {

/// Value of a GSL function of one argument, by its `_e` form. GSL's error handler belongs to the
/// program and by default ends the process, also at underflow and overflow. So callers must pass
/// arguments that cause no error: 1e-160 and more for Bessel functions.
inline double gsl_value(int (*function)(double, gsl_sf_result*), double x) {
    gsl_sf_result result{};
    const int status = function(x, &result);
    if (status != GSL_SUCCESS && status != GSL_ELOSS)
        throw std::runtime_error(std::string("revchain: GSL: ") + gsl_strerror(status));
    return result.val;
}

}  // namespace revchain::analytic::detail
