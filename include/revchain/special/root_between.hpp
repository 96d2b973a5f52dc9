// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <optional>

#include "revchain/numeric/compiler.hpp"

namespace revchain::inline REVCHAIN_BUILD::analytic::detail {

/// A zero of `f` between `low` and `high` to the last digit of the argument, by Brent's method (GSL). Empty where f has
/// the same sign at both ends or is NaN there. f must not throw.
template <class F>
std::optional<double> root_between(const F& f, double low, double high) {
    const double at_low = f(low), at_high = f(high);
    if (at_low == 0) return low;
    if (at_high == 0) return high;
    if (!(at_low < 0 && at_high > 0) && !(at_low > 0 && at_high < 0)) return std::nullopt;
    const auto finite = [](double x, void* context) {  // GSL ends the process otherwise
        const double y = (*static_cast<const F*>(context))(x);
        return std::isnan(y) ? 0.0
                             : std::clamp(y, -std::numeric_limits<double>::max(), std::numeric_limits<double>::max());
    };
    gsl_function function{finite, const_cast<F*>(&f)};
    const std::unique_ptr<gsl_root_fsolver, void (*)(gsl_root_fsolver*)> solver(
        gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
    if (!solver) throw std::bad_alloc();
    gsl_root_fsolver_set(solver.get(), &function, low, high);
    for (int round = 0; round < 200; ++round) {
        if (gsl_root_fsolver_iterate(solver.get()) != GSL_SUCCESS) break;
        const double lower = gsl_root_fsolver_x_lower(solver.get()), upper = gsl_root_fsolver_x_upper(solver.get());
        if (std::abs(upper - lower) <= 4e-16 * std::abs(lower)) break;
    }
    return gsl_root_fsolver_root(solver.get());
}

}  // namespace revchain::analytic::detail
