// SPDX-License-Identifier: GPL-3.0-or-later
#include <gsl/gsl_errno.h>

#include "bindings.hpp"

// Each in bind_<name>.cpp.
void bind_cord_modes(py::module_& module);
void bind_cord_branches(py::module_& module);
void bind_elliptic(py::module_& module);

/// Binds everything that needs GSL. A module without GSL is built from without_analytic.cpp and not from this file.
void bind_analytic(py::module_& module) {
    // Where GSL is linked statically, as in our wheels, this handler is the module's own copy; the headers never reach
    // one in either case.
    gsl_set_error_handler_off();
    bind_cord_modes(module);
    bind_cord_branches(module);
    bind_elliptic(module);
}
