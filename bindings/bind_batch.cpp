// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <numeric>
#include <optional>

#include "bindings.hpp"
#include "revchain/batch.hpp"

namespace {

using revchain::BatchOptions;
using revchain::Index;
using Batch = revchain::ChainBatch<double>;
using Column = revchain::BatchColumn<double>;
using Heights = revchain::Table<double>;

/// A table of 1 or `chains` rows and 1 or `size` numbers in each.
Column column(const Array& table, Index chains, Index size, const char* name) {
    const bool fits = table.ndim() == 2 && (table.shape(0) == 1 || table.shape(0) == chains) &&
                      (table.shape(1) == 1 || table.shape(1) == size);
    if (!fits) revchain::detail::throw_invalid("conical_heights", std::string(name) + " does not fit the batch");
    return {table.data(), table.shape(0) == 1 ? 0 : table.shape(1), table.shape(1) == 1 ? 0 : 1};
}

Heights solve(const Batch& batch, const BatchOptions& options) {
    return without_lock([&] { return revchain::conical_heights(batch, options); });
}

/// (*shape, count) heights; `size` is the number of links. The tables as `column` takes them.
py::array conical_heights(const std::vector<Index>& shape, Index size, const Array& weight, const Array& length,
                          const std::optional<Array>& centroid, const std::optional<Array>& pendulum_length,
                          const std::optional<Array>& radius_of_gyration, std::optional<Index> count, Index threads) {
    const Index chains = std::accumulate(shape.begin(), shape.end(), Index(1), std::multiplies<>());
    Batch batch{chains, size, column(weight, chains, size, "weight"), column(length, chains, size, "length")};
    if (centroid) batch.centroid = column(*centroid, chains, size, "centroid");
    if (pendulum_length) batch.pendulum_length = column(*pendulum_length, chains, size, "pendulum_length");
    if (radius_of_gyration) batch.radius_of_gyration = column(*radius_of_gyration, chains, size, "radius_of_gyration");
    batch.shape = shape;

    auto heights = std::make_unique<Heights>(solve(batch, {.count = count, .threads = threads}));
    std::vector<Index> result_shape = shape;
    result_shape.push_back(heights->cols());
    const double* data = heights->data();
    const py::capsule owner(heights.release(), [](void* table) { delete static_cast<Heights*>(table); });
    return py::array_t<double>(result_shape, data, owner);
}

}  // namespace

void bind_batch(py::module_& module) {
    module.def("conical_heights", &conical_heights, "shape"_a, "size"_a, "weight"_a, "length"_a,
               "centroid"_a = py::none(), "pendulum_length"_a = py::none(), "radius_of_gyration"_a = py::none(),
               "count"_a = py::none(), "threads"_a = 1);
}
