// SPDX-License-Identifier: GPL-3.0-or-later
// A chain in the scalar that Python asks for (double, long double or two doubles), and its results as numpy arrays.
#pragma once

#include <cmath>
#include <vector>

#include "bindings.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/system/converted.hpp"

/// numpy's type for the leading part of a T.
template <class T>
using Stored = std::conditional_t<std::is_same_v<T, revchain::DoubleDouble>, double, T>;

/// The leading parts of an Eigen table or vector, as an array that Python can read and not change.
template <class Numbers>
py::array leading(const Numbers& values) {
    using T = typename Numbers::Scalar;
    std::vector<py::ssize_t> shape{values.rows()};
    if (Numbers::ColsAtCompileTime != 1) shape.push_back(values.cols());
    if constexpr (std::is_same_v<T, Stored<T>>) {
        return frozen(py::array_t<T>(shape, values.data()));
    } else {
        py::array_t<Stored<T>> array(shape);
        for (revchain::Index i = 0; i < values.size(); ++i)
            array.mutable_data()[i] = static_cast<Stored<T>>(values.data()[i]);
        return frozen(std::move(array));
    }
}

/// What the leading parts leave: an array for two doubles, None for other scalars.
template <class T>
py::object rest(const revchain::Vector<T>& values) {
    if constexpr (std::is_same_v<T, revchain::DoubleDouble>) {
        py::array_t<double> array(values.size());
        for (revchain::Index i = 0; i < values.size(); ++i) array.mutable_data()[i] = values[i].low();
        return frozen(std::move(array));
    } else {
        return py::none();
    }
}

/// Bounds: rounded up where they are rounded.
template <class T>
py::array bounds(const revchain::Vector<T>& values) {
    if constexpr (std::is_same_v<T, revchain::DoubleDouble>) {
        revchain::Vector<double> up(values.size());
        for (revchain::Index i = 0; i < values.size(); ++i)
            up[i] = values[i].low() > 0 ? std::nextafter(values[i].high(), INFINITY) : values[i].high();
        return leading(up);
    } else {
        return leading(values);
    }
}
