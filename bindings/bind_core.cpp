// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "revchain/core/conical_pendulum.hpp"
#include "revchain/core/progress.hpp"

void bind_core(py::module_& module) {
    namespace pendulum = revchain::conical_pendulum;

    py::register_exception<revchain::Cancelled>(module, "Cancelled", PyExc_RuntimeError);

    py::class_<revchain::Progress>(module, "Progress", "How far modes() is, readable from another thread.")
        .def(py::init<>())
        .def_property_readonly("fraction", &revchain::Progress::fraction, "From 0 to 1.")
        .def("cancel", &revchain::Progress::cancel, "Make the running modes() raise Cancelled.");

    module.def("conical_pendulum_angular_speed",
               py::vectorize([](double height, double gravity) { return pendulum::angular_speed(height, gravity); }),
               "height"_a, "gravity"_a);
    module.def("conical_pendulum_height",
               py::vectorize([](double speed, double gravity) { return pendulum::height(speed, gravity); }),
               "angular_speed"_a, "gravity"_a);
    module.def("conical_pendulum_period",
               py::vectorize([](double height, double gravity) { return pendulum::period(height, gravity); }),
               "height"_a, "gravity"_a);
    module.def("conical_pendulum_height_from_period", py::vectorize([](double period, double gravity) {
                   return pendulum::height_from_period(period, gravity);
               }),
               "period"_a, "gravity"_a);
    module.def("conical_pendulum_revolutions_per_second", py::vectorize([](double height, double gravity) {
                   return pendulum::revolutions_per_second(height, gravity);
               }),
               "height"_a, "gravity"_a);
    module.def("conical_pendulum_gravity",
               py::vectorize([](double length, double period) { return pendulum::gravity(length, period); }),
               "length"_a, "period"_a);
    module.def("conical_pendulum_gravity_from_seconds_pendulum",
               py::vectorize([](double length) { return pendulum::gravity_from_seconds_pendulum(length); }),
               "length"_a);
    module.def("conical_pendulum_height_from_seconds_pendulum",
               py::vectorize([](double seconds_pendulum, double period) {
                   return pendulum::height_from_seconds_pendulum(seconds_pendulum, period);
               }),
               "seconds_pendulum"_a, "period"_a);
}
