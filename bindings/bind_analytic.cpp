// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "revchain/special/heavy_chain.hpp"
#include "revchain/special/tapered_chain.hpp"
#include "revchain/special/tip_mass.hpp"

namespace {
namespace analytic = revchain::analytic;
namespace heavy_chain = analytic::heavy_chain;
using revchain::Index;

/// (...,) lengths, and what else there is -> (..., count): one row of `row(length, ...)` for each length.
template <class Row, class... Arrays>
py::array_t<double> rows(Index count, Row row, const Array& length, const Arrays&... rest) {
    std::vector<py::ssize_t> shape(length.shape(), length.shape() + length.ndim());
    if (count < 1) revchain::detail::throw_invalid("heavy_chain", "count must be at least 1", count);
    shape.push_back(count);
    py::array_t<double> result(shape);
    for (py::ssize_t i = 0; i < length.size(); ++i) {
        const revchain::Vector<double> values = row(length.data()[i], rest.data()[i]...);
        std::copy(values.begin(), values.end(), result.mutable_data() + i * count);
    }
    return result;
}

/// Offsets or slopes of chains told apart by one number beside their length: a mode is computed where it changes.
template <class Mode, double (Mode::*value)(double) const>
py::object along(const Array& x, const Array& mode, const Array& length, const Array& other) {
    std::optional<Mode> known;
    std::array<double, 3> of{};
    return columns<1>(
        [&](double at, double number, double l, double o) {
            if (const std::array<double, 3> asked{number, l, o}; !known || of != asked) {
                known.emplace(static_cast<Index>(number), l, o);
                of = asked;
            }
            return std::array<double, 1>{((*known).*value)(at)};
        },
        x, mode, length, other)[0];
}

void bind_tip_mass(py::module_& module) {
    namespace tip_mass = analytic::tip_mass;
    module.def(
        "tip_mass_conical_heights",
        [](Index count, const Array& length, const Array& tip) {
            return rows(
                count, [=](double l, double t) { return tip_mass::conical_heights(count, l, t); }, length, tip);
        },
        "count"_a, "length"_a, "tip"_a);
    using tip_mass::Mode;
    module.def("tip_mass_shape", along<Mode, &Mode::shape>, "x"_a, "mode"_a, "length"_a, "tip"_a);
    module.def("tip_mass_slope", along<Mode, &Mode::slope>, "x"_a, "mode"_a, "length"_a, "tip"_a);
    module.def(
        "tip_mass_nodes",
        [](Index mode, double length, double tip) { return to_numpy(Mode(mode, length, tip).nodes()); }, "mode"_a,
        "length"_a, "tip"_a);
}

void bind_tapered_chain(py::module_& module) {
    namespace tapered_chain = analytic::tapered_chain;
    module.def(
        "tapered_chain_conical_heights",
        [](Index count, const Array& length, const Array& exponent) {
            return rows(
                count, [=](double l, double p) { return tapered_chain::conical_heights(count, l, p); }, length,
                exponent);
        },
        "count"_a, "length"_a, "exponent"_a);
    using tapered_chain::Mode;
    module.def("tapered_chain_shape", along<Mode, &Mode::shape>, "x"_a, "mode"_a, "length"_a, "exponent"_a);
    module.def("tapered_chain_slope", along<Mode, &Mode::slope>, "x"_a, "mode"_a, "length"_a, "exponent"_a);
    module.def(
        "tapered_chain_nodes",
        [](Index mode, double length, double exponent) { return to_numpy(Mode(mode, length, exponent).nodes()); },
        "mode"_a, "length"_a, "exponent"_a);
}
}  // namespace

void bind_analytic(py::module_& module) {
    module.def(
        "heavy_chain_conical_heights",
        [](Index count, const Array& length) {
            return rows(
                count, [=](double l) { return heavy_chain::conical_heights(count, l); }, length);
        },
        "count"_a, "length"_a);
    module.def("heavy_chain_shape",
               vectorized([](double x, Index mode, double length) { return heavy_chain::shape(x, mode, length); }),
               "x"_a, "mode"_a, "length"_a);
    module.def(
        "heavy_chain_nodes", [](Index mode, double length) { return to_numpy(heavy_chain::nodes(mode, length)); },
        "mode"_a, "length"_a);
    module.def(
        "heavy_chain_vertical_points",
        [](Index mode, double length) { return to_numpy(heavy_chain::vertical_points(mode, length)); }, "mode"_a,
        "length"_a);
    module.def("heavy_chain_slope",
               vectorized([](double x, Index mode, double length) { return heavy_chain::slope(x, mode, length); }),
               "x"_a, "mode"_a, "length"_a);
    module.def("heavy_chain_energy", vectorized(heavy_chain::kinetic_energy), "mode"_a, "amplitude"_a);
    bind_tip_mass(module);
    bind_tapered_chain(module);
}
