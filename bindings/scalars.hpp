// SPDX-License-Identifier: GPL-3.0-or-later
// One chain and its results in the four scalars that Python may ask for.
#pragma once

#include <cmath>
#include <vector>

#include "bindings.hpp"
#include "revchain/chain/chain.hpp"
#include "revchain/core/double_double.hpp"

/// Two doubles as another scalar: rounded, or exact where there is room.
template <class T>
T from_words(const revchain::DoubleWord<double>& x) {
    if constexpr (std::is_same_v<T, revchain::DoubleDouble>) {
        return T(x);
    } else if constexpr (std::is_same_v<T, revchain::DoubleWord<long double>>) {
        return revchain::two_sum(static_cast<long double>(x.high), static_cast<long double>(x.low));
    } else {
        return static_cast<T>(x.high);
    }
}

template <class To, class From, class Convert>
revchain::Column<To> converted(const revchain::Column<From>& column, Convert convert) {
    if (column.is_scalar()) return revchain::Column<To>(convert(column[0]));
    std::vector<To> values(column.stored());
    for (std::size_t m = 0; m < values.size(); ++m) values[m] = convert(column.data()[m]);
    return values;
}

/// The chain whose numbers are those of `chain` in T: rounded where T is narrower, else the same.
template <class T>
revchain::Chain<T> converted(const revchain::Chain<double>& chain) {
    const auto number = [](double x) { return static_cast<T>(x); };
    return revchain::Chain<T>(chain.size(), converted<T>(chain.weight(), number), converted<T>(chain.length(), number),
                              converted<T>(chain.centroid(), number),
                              converted<revchain::Wide<T>>(chain.gyration_ratio(), &from_words<revchain::Wide<T>>));
}

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
