// SPDX-License-Identifier: GPL-3.0-or-later
#include <gsl/gsl_errno.h>

#include "bindings.hpp"

PYBIND11_MODULE(_core, module, py::mod_gil_not_used()) {
    module.doc() = "Compiled core of revchain; use the package, not this module.";
    // Where GSL is linked statically, as in our wheels, this handler is the module's own copy; the headers never reach
    // one in either case.
    gsl_set_error_handler_off();
    bind_core(module);
    bind_chain(module);
    bind_rig(module);
    bind_sensitivity(module);
    bind_linear(module);
    bind_rig_modes(module);
    bind_finite(module);
    bind_branches(module);
    bind_continuous(module);
    bind_held(module);
    bind_two_links(module);
    bind_diagrams(module);
    bind_batch(module);
    bind_analytic(module);
    bind_elliptic(module);
    bind_response(module);
    bind_models(module);
}
