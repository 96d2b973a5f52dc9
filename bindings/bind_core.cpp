// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>

#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/conical_pendulum.hpp"
#include "revchain/hoop.hpp"

namespace {

/// The identifier of the only thread in which Python handles signals.
unsigned long main_thread = 0;

/// Every 50 ms in the main thread: raises KeyboardInterrupt if Ctrl-C was pressed.
void interrupt() {
    if (PyThread_get_thread_ident() != main_thread) return;
    using Clock = std::chrono::steady_clock;
    static Clock::time_point last;
    const Clock::time_point now = Clock::now();
    if (now - last < std::chrono::milliseconds(50)) return;
    last = now;
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// The message of a wrong call, its function named as in Python: "revchain::analytic::SkippingRope: ..." is
/// "revchain.SkippingRope: ...".
std::string in_python(std::string message) {
    for (std::size_t at = 0; (at = message.find("::", at)) < message.find(": "); ++at) message.replace(at, 2, ".");
    constexpr std::string_view formulas = "revchain.analytic.";
    if (message.starts_with(formulas)) message.erase(0, formulas.size()).insert(0, "revchain.");
    return message;
}

}  // namespace

void bind_core(py::module_& module) {
    main_thread = py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>();
    revchain::detail::interrupt = &interrupt;

    namespace pendulum = revchain::conical_pendulum;

    py::register_exception<revchain::Cancelled>(module, "Cancelled", PyExc_RuntimeError);

    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const revchain::InvalidArgument& error) {
            PyErr_SetString(PyExc_ValueError, in_python(error.what()).c_str());
        }
    });

    py::class_<revchain::Progress>(module, "Progress", "Progress of modes(), readable from another thread.")
        .def(py::init<>())
        .def_property_readonly("fraction", &revchain::Progress::fraction, "Finished part, 0 to 1.")
        .def_property_readonly("cancelled", &revchain::Progress::cancelled, "Whether cancel() was called.")
        .def("cancel", &revchain::Progress::cancel, "Make the running modes() raise Cancelled.");

    module.def("conical_pendulum_angular_speed",
               vectorized([](double height, double gravity) { return pendulum::angular_speed(height, gravity); }),
               "height"_a, "gravity"_a);
    module.def("conical_pendulum_height",
               vectorized([](double speed, double gravity) { return pendulum::height(speed, gravity); }),
               "angular_speed"_a, "gravity"_a);
    module.def("conical_pendulum_period",
               vectorized([](double height, double gravity) { return pendulum::period(height, gravity); }), "height"_a,
               "gravity"_a);
    module.def("conical_pendulum_height_from_period",
               vectorized([](double period, double gravity) { return pendulum::height_from_period(period, gravity); }),
               "period"_a, "gravity"_a);
    module.def("conical_pendulum_revolutions_per_second", vectorized([](double height, double gravity) {
                   return pendulum::revolutions_per_second(height, gravity);
               }),
               "height"_a, "gravity"_a);
    module.def("conical_pendulum_gravity",
               vectorized([](double length, double period) { return pendulum::gravity(length, period); }), "length"_a,
               "period"_a);
    module.def("conical_pendulum_height_from_seconds_pendulum", vectorized([](double seconds_pendulum, double period) {
                   return pendulum::height_from_seconds_pendulum(seconds_pendulum, period);
               }),
               "seconds_pendulum"_a, "period"_a);

    module.def(
        "inclined_pendulum",
        [](const Array& length, const Array& height) {
            return columns<4>(
                [](double l, double lambda) {
                    const auto p = revchain::inclined_pendulum(l, lambda);
                    return std::array<double, 4>{p.inclination, p.radius, p.depth, p.tension};
                },
                length, height);
        },
        "length"_a, "height"_a);
    module.def(
        "held_plummet",
        [](const Array& upper_thread, const Array& lower_thread, const Array& distance, const Array& height) {
            return columns<4>(
                [](double upper, double lower, double apart, double lambda) {
                    const auto p = revchain::held_plummet(upper, lower, apart, lambda);
                    return std::array<double, 4>{p.radius, p.depth, p.upper_tension, p.lower_tension};
                },
                upper_thread, lower_thread, distance, height);
        },
        "upper_thread"_a, "lower_thread"_a, "distance"_a, "height"_a);
    module.def("air_resistance",
               vectorized([](double arm, double height) { return revchain::air_resistance(arm, height); }), "arm"_a,
               "height"_a);
    module.def("whirling_thread", vectorized([](double arm, double height, double radius) {
                   return revchain::whirling_thread(arm, height, radius);
               }),
               "arm"_a, "height"_a, "radius"_a);
    module.def("carried_response",
               vectorized([](double length, double height) { return revchain::carried_response(length, height); }),
               "length"_a, "height"_a);
    module.def(
        "carried_inclinations",
        [](const Array& length, const Array& height, const Array& radius) {
            return columns<3>(
                [](double l, double lambda, double b) {
                    auto roots = revchain::carried_inclinations(l, lambda, b);
                    for (int j = roots.count; j < 3; ++j)
                        roots.inclination[static_cast<std::size_t>(j)] = std::numeric_limits<double>::quiet_NaN();
                    return roots.inclination;
                },
                length, height, radius);
        },
        "length"_a, "height"_a, "radius"_a);

    namespace hoop = revchain::hoop;
    module.def("hoop_tension", vectorized([](double speed, double gravity) { return hoop::tension(speed, gravity); }),
               "speed"_a, "gravity"_a);
    module.def("hoop_speed", vectorized([](double tension, double gravity) { return hoop::speed(tension, gravity); }),
               "tension"_a, "gravity"_a);
    module.def(
        "hoop_wave_speeds",
        [](const Array& speed) {
            return columns<2>(
                [](double v) {
                    const auto waves = hoop::wave_speeds(v);
                    return std::array<double, 2>{waves.standing, waves.running};
                },
                speed);
        },
        "speed"_a);
    module.def("hoop_string_revolutions_per_second", vectorized([](double span, double tension, double gravity) {
                   return hoop::string_revolutions_per_second(span, tension, gravity);
               }),
               "span"_a, "tension"_a, "gravity"_a);
}
