// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>

#include "revchain/core/scalar.hpp"

namespace py = pybind11;
using namespace pybind11::literals;

/// Numbers in any order and of any type, as contiguous doubles.
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// numpy arrays that Python can read and not change.
inline py::array frozen(py::array array) {
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

inline py::array to_numpy(const revchain::Vector<double>& values) {
    return frozen(py::array_t<double>(values.size(), values.data()));
}

inline py::array to_numpy(const revchain::Table<double>& values) {
    return frozen(py::array_t<double>({values.rows(), values.cols()}, values.data()));
}

inline py::array to_numpy(const revchain::Matrix<double>& values) { return to_numpy(revchain::Table<double>(values)); }

// One function per folder of include/revchain, each in bind_<folder>.cpp.
void bind_core(py::module_& module);
void bind_chain(py::module_& module);
void bind_linear(py::module_& module);
void bind_batch(py::module_& module);
void bind_analytic(py::module_& module);
