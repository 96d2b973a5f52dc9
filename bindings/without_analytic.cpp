// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "revchain/cord.hpp"
#include "revchain/held.hpp"

namespace {

[[noreturn]] void refuse() {
    throw py::import_error(
        "revchain was built without GSL (REVCHAIN_ANALYTIC=OFF): modes and branches of cords, ropes, motions of "
        "governors and elliptic functions need it. Install a wheel of revchain, or install GSL and build without this "
        "option");
}

/// Makes a function of other systems raise ImportError for this one.
template <class System>
void def_refusal(py::module_& module, const char* name) {
    module.def(name, [](const System&, const py::args&, const py::kwargs&) -> py::object { refuse(); });
}

}  // namespace

/// In place of what needs GSL: every name that the module lacks, and every function that it has for other systems than
/// cords, raises ImportError, which names the reason.
void bind_analytic(py::module_& module) {
    for (const char* name : {"branch", "branches", "branch_from", "shapes_on_branch", "steady_shape"})
        def_refusal<revchain::Cord>(module, name);
    for (const char* name : {"held_modes", "count_held_modes"})
        def_refusal<revchain::Held<revchain::Cord>>(module, name);
    module.def("__getattr__", [](const std::string& name) -> py::object {
        if (name.starts_with("_")) throw py::attribute_error("module 'revchain._core' has no attribute '" + name + "'");
        refuse();
    });
}
