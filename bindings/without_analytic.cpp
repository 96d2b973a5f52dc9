// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"

/// In place of what needs GSL: every name that the module lacks raises ImportError, which names the reason.
void bind_analytic(py::module_& module) {
    module.def("__getattr__", [](const std::string& name) -> py::object {
        if (name.starts_with("_")) throw py::attribute_error("module 'revchain._core' has no attribute '" + name + "'");
        throw py::import_error(
            "revchain was built without GSL (REVCHAIN_ANALYTIC=OFF): modes and branches of cords, ropes, governors and "
            "elliptic functions need it. Install a wheel of revchain, or install GSL and build without this option");
    });
}
