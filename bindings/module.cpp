// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <exception>
#include <new>
#include <stdexcept>

#include "bindings.hpp"

namespace {

/// Makes every class of the module use pickle protocol 2 at least. A class without a pickle then raises TypeError;
/// protocols 0 and 1 would make an instance that pybind11 did not register, and that ends the process.
void refuse_old_pickles(const py::module_& module) {
    const auto reduce = [](const py::object& self, int protocol) {
        return py::module_::import("builtins").attr("object").attr("__reduce_ex__")(self, std::max(protocol, 2));
    };
    for (const auto& [name, value] : py::dict(module.attr("__dict__")))
        if (PyType_Check(value.ptr()) != 0 && PyObject_IsSubclass(value.ptr(), PyExc_BaseException) == 0)
            value.attr("__reduce_ex__") = py::cpp_function(reduce, py::name("__reduce_ex__"), py::is_method(value));
}

/// Turns the memory errors of C++ into a message that says what to reduce.
void tell_of_memory(std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param): pybind11 wants it so
    const char* sentence = "revchain: the results do not fit in the memory; use fewer links or ask for fewer modes";
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const std::length_error&) {
        py::set_error(PyExc_ValueError, sentence);
    } catch (const std::bad_alloc&) {
        py::set_error(PyExc_MemoryError, sentence);
    }
}

}  // namespace

PYBIND11_MODULE(_core, module, py::mod_gil_not_used()) {
    module.doc() = "Compiled core of revchain; use the package, not this module.";
    py::register_local_exception_translator(tell_of_memory);
    bind_core(module);
    bind_chain(module);
    bind_rig(module);
    bind_sensitivity(module);
    bind_linear(module);
    bind_rig_modes(module);
    bind_finite(module);
    bind_branches(module);
    bind_cord(module);
    bind_analytic(module);
    bind_held(module);
    bind_two_links(module);
    bind_diagrams(module);
    bind_drag(module);
    bind_batch(module);
    bind_response(module);
    bind_models(module);
    refuse_old_pickles(module);
}
