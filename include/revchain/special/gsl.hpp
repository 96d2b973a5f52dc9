// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_sf_bessel.h>

#include <stdexcept>
#include <string>

namespace revchain::analytic::detail {

/// Value of a GSL function of one argument, by its `_e` form. GSL's default handler ends the process, at domain errors
/// and at underflow and overflow too, and is the program's, not ours: it is never touched here. So callers keep to
/// arguments that GSL serves: Bessel functions of 1e-160 and more.
inline double gsl_value(int (*function)(double, gsl_sf_result*), double x) {
    gsl_sf_result result{};
    const int status = function(x, &result);
    if (status != GSL_SUCCESS && status != GSL_ELOSS)
        throw std::runtime_error(std::string("revchain: GSL: ") + gsl_strerror(status));
    return result.val;
}

}  // namespace revchain::analytic::detail
