// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "revchain/analytic/heavy_chain.hpp"

namespace {
namespace heavy_chain = revchain::analytic::heavy_chain;
using revchain::Index;

/// (...,) lengths -> (..., count): one row of `row(length)` for each length.
template <class Row>
py::array_t<double> rows(Index count, const Array& length, Row row) {
    std::vector<py::ssize_t> shape(length.shape(), length.shape() + length.ndim());
    if (count < 1) revchain::detail::refuse("heavy_chain", "count must be at least 1", count);
    shape.push_back(count);
    py::array_t<double> result(shape);
    for (py::ssize_t i = 0; i < length.size(); ++i) {
        const revchain::Vector<double> values = row(length.data()[i]);
        std::copy(values.begin(), values.end(), result.mutable_data() + i * count);
    }
    return result;
}
}  // namespace

void bind_analytic(py::module_& module) {
    module.def(
        "heavy_chain_conical_heights",
        [](Index count, const Array& length) {
            return rows(count, length, [=](double l) { return heavy_chain::conical_heights(count, l); });
        },
        "count"_a, "length"_a);
    module.def("heavy_chain_shape",
               py::vectorize([](double x, Index mode, double length) { return heavy_chain::shape(x, mode, length); }),
               "x"_a, "mode"_a, "length"_a);
    module.def(
        "heavy_chain_nodes", [](Index mode, double length) { return to_numpy(heavy_chain::nodes(mode, length)); },
        "mode"_a, "length"_a);
    module.def(
        "heavy_chain_vertical_points",
        [](Index mode, double length) { return to_numpy(heavy_chain::vertical_points(mode, length)); }, "mode"_a,
        "length"_a);
}
