// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "revchain/conical_pendulum.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/numeric/scalar.hpp"

namespace py = pybind11;
using namespace pybind11::literals;

/// Numbers in any order and of any type, as contiguous doubles.
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The progress that a question reports to; None for no reports.
using MaybeProgress = std::optional<revchain::Progress*>;

/// Python's direction of rotation: 1 or -1.
inline revchain::Rotation rotation(int direction) {
    return direction > 0 ? revchain::Rotation::forward : revchain::Rotation::backward;
}

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

template <class Numbers>
py::array complex_numbers(const Numbers& values, std::vector<py::ssize_t> shape) {
    py::array_t<std::complex<double>> array(std::move(shape));
    std::copy_n(values.data(), values.size(), array.mutable_data());
    return frozen(std::move(array));
}

/// The numbers where they are, not copied: the array keeps their owner.
inline py::array in_place(const revchain::Table<double>& values, std::shared_ptr<const void> owner) {
    auto* kept = new std::shared_ptr<const void>(std::move(owner));
    const py::capsule base(kept, [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
    return frozen(py::array_t<double>({values.rows(), values.cols()}, values.data(), base));
}

inline py::array to_numpy(const revchain::Matrix<double>& values) { return to_numpy(revchain::Table<double>(values)); }

/// Arrays of one shape in, or single numbers after the first, `count` arrays of that shape out: `function(numbers...)`
/// returns a std::array<double, count>.
template <std::size_t count, class Function, class... Arrays>
py::tuple columns(const Function& function, const Array& first, const Arrays&... rest) {
    const std::vector<py::ssize_t> shape(first.shape(), first.shape() + first.ndim());
    std::array<py::array_t<double>, count> out;
    std::array<double*, count> to{};
    for (std::size_t j = 0; j < count; ++j) out[j] = py::array_t<double>(shape), to[j] = out[j].mutable_data();
    for (py::ssize_t i = 0; i < first.size(); ++i) {
        if (i % 64 == 0) revchain::detail::check_interrupt();
        const std::array<double, count> row = function(first.data()[i], rest.data()[rest.ndim() == 0 ? 0 : i]...);
        for (std::size_t j = 0; j < count; ++j) to[j][i] = row[j];
    }
    py::tuple result(count);
    for (std::size_t j = 0; j < count; ++j) result[j] = std::move(out[j]);
    return result;
}

/// Function pointers for py::vectorize whose calls look for Ctrl-C now and then.
template <class Function>
auto vectorized(Function function) {
    return [&]<class Result, class... Numbers>(Result (*call)(Numbers...)) {
        return py::vectorize([call](Numbers... numbers) -> Result {
            static thread_local unsigned calls = 0;
            if (++calls % 64 == 0) revchain::detail::check_interrupt();
            return call(numbers...);
        });
    }(static_cast<py::detail::function_signature_t<Function>*>(function));
}

/// solve() while other threads of Python may run.
template <class Solve>
auto without_lock(Solve&& solve) {
    const py::gil_scoped_release release;
    return solve();
}

// Each in bind_<name>.cpp.
void bind_core(py::module_& module);
void bind_chain(py::module_& module);
void bind_rig(py::module_& module);
void bind_sensitivity(py::module_& module);
void bind_linear(py::module_& module);
void bind_rig_modes(py::module_& module);
void bind_finite(py::module_& module);
void bind_branches(py::module_& module);
void bind_analytic(py::module_& module);
void bind_cord(py::module_& module);
void bind_held(py::module_& module);
void bind_two_links(py::module_& module);
void bind_diagrams(py::module_& module);
void bind_drag(py::module_& module);
void bind_batch(py::module_& module);
void bind_response(py::module_& module);
void bind_models(py::module_& module);

/// How many modes are above each conical height, shape of the argument; the GIL released.
template <class System>
py::array_t<std::int64_t> counts_above(const System& system, const Array& height, double gravity) {
    py::array_t<std::int64_t> result(std::vector<py::ssize_t>(height.shape(), height.shape() + height.ndim()));
    std::int64_t* out = result.mutable_data();
    const py::gil_scoped_release release;
    std::transform(height.data(), height.data() + height.size(), out, [&](double h) {
        revchain::detail::check_interrupt();
        return count_modes(system, {.conical_height = h, .gravity = gravity});
    });
    return result;
}
