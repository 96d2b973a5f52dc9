// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/stability.hpp"
#include "revchain/steady_shapes.hpp"

#include <pybind11/complex.h>

namespace {

using Chain = revchain::Chain<double>;
using revchain::Index;
using revchain::SteadyShape;
using revchain::SteadyShapes;

py::array ranges(const SteadyShapes& found) {
    revchain::Table<double> table(static_cast<revchain::Index>(found.undecided.size()), 2);
    for (revchain::Index i = 0; i < table.rows(); ++i) {
        const auto& range = found.undecided[static_cast<std::size_t>(i)];
        table.row(i) << range.low, range.high;
    }
    return to_numpy(table);
}

}  // namespace

void bind_finite(py::module_& module) {
    const auto column = [](revchain::Vector<double> SteadyShape::*member) {
        return [member](const SteadyShape& shape) { return to_numpy(shape.*member); };
    };
    py::class_<SteadyShape>(module, "SteadyShape", "A steady shape of a whirling chain.")
        .def(py::init([](const Array& inclination, const Array& offset, const Array& height, const Array& tension,
                         const Array& reaction_inclination, int half_waves, double conical_height, double residual,
                         double error_bound, double condition, double moment_of_inertia, double effective_energy) {
                 const auto vector = [](const Array& x) {
                     return revchain::Vector<double>(Eigen::Map<const revchain::Vector<double>>(x.data(), x.size()));
                 };
                 SteadyShape shape{};
                 shape.inclination = vector(inclination), shape.offset = vector(offset);
                 shape.height = vector(height), shape.tension = vector(tension);
                 shape.reaction_inclination = vector(reaction_inclination), shape.half_waves = half_waves;
                 shape.conical_height = conical_height, shape.residual = residual, shape.error_bound = error_bound;
                 shape.condition = condition, shape.moment_of_inertia = moment_of_inertia;
                 shape.effective_energy = effective_energy;
                 return shape;
             }),
             "inclination"_a, "offset"_a, "height"_a, "tension"_a, "reaction_inclination"_a, "half_waves"_a,
             "conical_height"_a, "residual"_a, "error_bound"_a, "condition"_a, "moment_of_inertia"_a,
             "effective_energy"_a)
        .def_property_readonly("inclination", column(&SteadyShape::inclination))
        .def_property_readonly("offset", column(&SteadyShape::offset))
        .def_property_readonly("height", column(&SteadyShape::height))
        .def_property_readonly("tension", column(&SteadyShape::tension))
        .def_property_readonly("reaction_inclination", column(&SteadyShape::reaction_inclination))
        .def_readonly("half_waves", &SteadyShape::half_waves)
        .def_readonly("conical_height", &SteadyShape::conical_height)
        .def_readonly("residual", &SteadyShape::residual)
        .def_readonly("error_bound", &SteadyShape::error_bound)
        .def_readonly("condition", &SteadyShape::condition)
        .def_readonly("moment_of_inertia", &SteadyShape::moment_of_inertia)
        .def_readonly("effective_energy", &SteadyShape::effective_energy);
    py::class_<SteadyShapes>(module, "SteadyShapes", "The steady shapes at one speed.")
        .def_readonly("shapes", &SteadyShapes::shapes)
        .def_readonly("complete", &SteadyShapes::complete)
        .def_readonly("cells", &SteadyShapes::cells)
        .def_property_readonly("undecided", ranges);
    using revchain::Stability;
    const auto each = []<class T>(std::vector<T> Stability::*member) {
        return [member](const Stability& s) {
            const auto& of = s.*member;
            return frozen(py::array_t<T>(static_cast<py::ssize_t>(of.size()), of.data()));
        };
    };
    py::class_<Stability>(module, "Stability", "Linear stability of a steady shape.")
        .def_property_readonly("verdict", [](const Stability& s) { return std::string(to_string(s.verdict)); })
        .def_property_readonly("exponents", each(&Stability::exponents))
        .def_property_readonly("exponent_error", each(&Stability::exponent_error))
        .def_property_readonly("internal_damping", each(&Stability::internal_damping))
        .def_property_readonly("external_damping", each(&Stability::external_damping))
        .def_readonly("growth_rate", &Stability::growth_rate)
        .def_readonly("margin", &Stability::margin)
        .def_readonly("negative_directions", &Stability::negative_directions);
    module.def(
        "stability",
        [](const Chain& chain, const SteadyShape& shape, bool driven) {
            const auto frame = driven ? revchain::StabilityFrame::driven : revchain::StabilityFrame::free;
            return aside(chain, nullptr, [=](const Chain& own) { return revchain::stability(own, shape, frame); });
        },
        "chain"_a, "shape"_a, "driven"_a);
    module.def(
        "steady_shapes",
        [](const Chain& chain, double height, long budget, bool hanging_only, Index threads) {
            const py::gil_scoped_release release;
            return revchain::steady_shapes(
                chain, {.conical_height = height, .budget = budget, .hanging_only = hanging_only, .threads = threads});
        },
        "chain"_a, "height"_a, "budget"_a, "hanging_only"_a, "threads"_a = 1);
    module.def(
        "steady_shapes_at_speed",
        [](const Chain& chain, double angular_speed, double gravity, long budget, bool hanging_only, Index threads) {
            const py::gil_scoped_release release;
            return revchain::steady_shapes(chain, {.angular_speed = angular_speed,
                                                   .budget = budget,
                                                   .hanging_only = hanging_only,
                                                   .gravity = gravity,
                                                   .threads = threads});
        },
        "chain"_a, "angular_speed"_a, "gravity"_a, "budget"_a, "hanging_only"_a, "threads"_a = 1);
    using revchain::Rig;
    module.def(
        "stability_of_rig",
        [](const Rig& rig, const SteadyShape& shape, bool driven, int sense, double gravity) {
            const auto frame = driven ? revchain::StabilityFrame::driven : revchain::StabilityFrame::free;
            const revchain::RigStabilityOptions options{.frame = frame, .direction = rotation(sense), .gravity = gravity};
            return aside(rig.chain(), nullptr, [=](const Chain&) { return revchain::stability(rig, shape, options); });
        },
        "rig"_a, "shape"_a, "driven"_a, "sense"_a, "gravity"_a);
    module.def(
        "steady_shapes_of_rig",
        [](const Rig& rig, double height, long budget, bool hanging_only, int sense, double gravity, Index threads) {
            const py::gil_scoped_release release;
            return revchain::steady_shapes(rig, {.conical_height = height,
                                                 .budget = budget,
                                                 .hanging_only = hanging_only,
                                                 .direction = rotation(sense),
                                                 .gravity = gravity,
                                                 .threads = threads});
        },
        "rig"_a, "height"_a, "budget"_a, "hanging_only"_a, "sense"_a, "gravity"_a, "threads"_a = 1);
    module.def(
        "steady_shapes_of_rig_at_speed",
        [](const Rig& rig, double angular_speed, long budget, bool hanging_only, double gravity, Index threads) {
            const py::gil_scoped_release release;
            return revchain::steady_shapes(rig, {.angular_speed = angular_speed,
                                                 .budget = budget,
                                                 .hanging_only = hanging_only,
                                                 .gravity = gravity,
                                                 .threads = threads});
        },
        "rig"_a, "angular_speed"_a, "budget"_a, "hanging_only"_a, "gravity"_a, "threads"_a = 1);
}
