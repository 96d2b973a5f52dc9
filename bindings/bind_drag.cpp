// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "revchain/drag.hpp"

namespace {

using revchain::DragShape;

std::vector<double> numbers(const Array& array) { return {array.data(), array.data() + array.size()}; }

}  // namespace

void bind_drag(py::module_& module) {
    py::class_<DragShape>(module, "DragShape", "The steady shape of a chain that is carried round through still air.")
        .def_property_readonly("position", [](const DragShape& s) { return to_numpy(s.position); })
        .def_property_readonly("inclination", [](const DragShape& s) { return to_numpy(s.inclination); })
        .def_property_readonly("azimuth", [](const DragShape& s) { return to_numpy(s.azimuth); })
        .def_property_readonly("tension", [](const DragShape& s) { return to_numpy(s.tension); })
        .def_property_readonly("status", [](const DragShape& s) { return std::string(to_string(s.status)); })
        .def_readonly("torque", &DragShape::torque)
        .def_readonly("power", &DragShape::power)
        .def_readonly("factor", &DragShape::factor)
        .def_readonly("folds", &DragShape::folds)
        .def_readonly("residual", &DragShape::residual)
        .def_readonly("error_estimate", &DragShape::error_estimate);
    // `force` is the unit of drag over that of the weights.
    module.def(
        "drag_shape",
        [](const revchain::Rig& rig, const Array& coefficient, const Array& diameter, const Array& area,
           const Array& body_coefficient, double density, double angular_speed, std::optional<int> half_waves,
           double gravity, double force) {
            const revchain::Drag drag{numbers(coefficient), numbers(diameter), numbers(area), numbers(body_coefficient),
                                      density / force};
            return without_lock([&] {
                return revchain::drag_shape(
                    rig, drag, {.angular_speed = angular_speed, .half_waves = half_waves, .gravity = gravity});
            });
        },
        "rig"_a, "coefficient"_a, "diameter"_a, "area"_a, "body_coefficient"_a, "density"_a, "angular_speed"_a,
        "half_waves"_a, "gravity"_a, "force"_a);
}
