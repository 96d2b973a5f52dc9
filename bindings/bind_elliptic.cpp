// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms that need GSL: the motion of a governor, ropes, elliptic functions.
#include "bindings.hpp"
#include "revchain/governor.hpp"
#include "revchain/rope.hpp"
#include "revchain/special/jacobi.hpp"

namespace {
namespace analytic = revchain::analytic;
using analytic::EllipticModulus;

/// A modulus and its complement, as two numbers that say which of them is exact.
EllipticModulus modulus_of(double modulus, double complementary) {
    return std::isnan(modulus) ? EllipticModulus::of_complement(complementary) : EllipticModulus::of(modulus);
}

void bind_functions(py::module_& module) {
    module.def(
        "elliptic_jacobi",
        [](const Array& u, double modulus, double complementary_modulus) {
            const analytic::JacobiFunctions functions(modulus_of(modulus, complementary_modulus));
            return columns<5>(
                [&](double at) {
                    const analytic::JacobiValues f = functions(at);
                    return std::array<double, 5>{f.amplitude, f.sn, f.cn, f.dn, f.epsilon};
                },
                u);
        },
        "u"_a, "modulus"_a, "complementary_modulus"_a);
}

void bind_governor(py::module_& module) {
    using analytic::GovernorMotion;
    py::class_<GovernorMotion>(module, "GovernorMotion", "Motion of a link hinged on a turning axis.")
        .def(py::init([](double angular_speed, double pendulum_length, double gravity, double angle, double angle_rate,
                         double axial_inertia) {
                 return GovernorMotion({angular_speed, pendulum_length, gravity, angle, angle_rate, axial_inertia});
             }),
             "angular_speed"_a, "pendulum_length"_a, "gravity"_a, "angle"_a, "angle_rate"_a, "axial_inertia"_a)
        .def_property_readonly("regime", [](const GovernorMotion& m) { return std::string(to_string(m.regime())); })
        .def_property_readonly("period", &GovernorMotion::period)
        .def_property_readonly("least_angle", &GovernorMotion::least_angle)
        .def_property_readonly("greatest_angle", &GovernorMotion::greatest_angle)
        .def_property_readonly("modulus", [](const GovernorMotion& m) { return m.modulus().modulus(); })
        .def_property_readonly("complementary_modulus",
                               [](const GovernorMotion& m) { return m.modulus().complementary_modulus(); })
        .def(
            "state",
            [](const GovernorMotion& m, const Array& time) {
                return columns<2>(
                    [&](double t) {
                        const analytic::GovernorState s = m(t);
                        return std::array<double, 2>{s.angle, s.angle_rate};
                    },
                    time);
            },
            "time"_a, "Angle and its rate.");
}

template <class Point>
std::array<double, 5> row(const Point& p) {
    return {p.x, p.arc, p.offset, p.slope, p.tension_ratio};
}

void bind_ropes(py::module_& module) {
    using analytic::SkippingRope;
    using Known = std::optional<double>;
    py::class_<SkippingRope>(module, "SkippingRope",
                             "A rope that whirls between two points of the axis without gravity.")
        .def(py::init([](const Known& span, const Known& length, const Known& slack, const Known& sag,
                         const Known& angular_speed, const Known& tension, revchain::Index half_waves, double gravity) {
                 return SkippingRope({span, length, slack, sag, angular_speed, tension, half_waves, gravity});
             }),
             "span"_a, "length"_a, "slack"_a, "sag"_a, "angular_speed"_a, "tension"_a, "half_waves"_a, "gravity"_a)
        .def_property_readonly("half_waves", &SkippingRope::half_waves)
        .def_property_readonly("modulus", [](const SkippingRope& r) { return r.modulus().modulus(); })
        .def_property_readonly("complementary_modulus",
                               [](const SkippingRope& r) { return r.modulus().complementary_modulus(); })
        .def_property_readonly("span", &SkippingRope::span)
        .def_property_readonly("length", &SkippingRope::length)
        .def_property_readonly("slack", &SkippingRope::slack)
        .def_property_readonly("sag", &SkippingRope::sag)
        .def_property_readonly("slope_at_ends", &SkippingRope::slope_at_ends)
        .def_property_readonly("tension_ratio_at_ends", &SkippingRope::tension_ratio_at_ends)
        .def_property_readonly("height_times_tension", &SkippingRope::height_times_tension)
        .def_property_readonly("moment_of_inertia", &SkippingRope::moment_of_inertia)
        .def_property_readonly("has_speed", &SkippingRope::has_speed)
        .def_property_readonly("conical_height", &SkippingRope::conical_height)
        .def_property_readonly("angular_speed", &SkippingRope::angular_speed)
        .def_property_readonly("tension_in_the_middle", &SkippingRope::tension_in_the_middle)
        .def_property_readonly("tension_at_ends", &SkippingRope::tension_at_ends)
        .def(
            "at",
            [](const SkippingRope& r, const Array& x) {
                return columns<5>([&](double at) { return row(r.at(at)); }, x);
            },
            "x"_a, "Points of the rope at x.")
        .def(
            "at_arc",
            [](const SkippingRope& r, const Array& arc) {
                return columns<5>([&](double at) { return row(r.at_arc(at)); }, arc);
            },
            "arc"_a, "Points of the rope by arc length.");

    using analytic::TortuousRope;
    py::class_<TortuousRope>(module, "TortuousRope",
                             "A rope that whirls round the axis without gravity, its ends off the axis.")
        .def(py::init(
                 [](double least_radius, double greatest_radius, double angular_speed, double tension, double gravity) {
                     return TortuousRope({least_radius, greatest_radius, angular_speed, tension, gravity});
                 }),
             "least_radius"_a, "greatest_radius"_a, "angular_speed"_a, "tension"_a, "gravity"_a)
        .def_property_readonly("least_radius", &TortuousRope::least_radius)
        .def_property_readonly("greatest_radius", &TortuousRope::greatest_radius)
        .def_property_readonly("conical_height", &TortuousRope::conical_height)
        .def_property_readonly("height_times_tension", &TortuousRope::height_times_tension)
        .def_property_readonly("modulus", [](const TortuousRope& r) { return r.modulus().modulus(); })
        .def_property_readonly("complementary_modulus",
                               [](const TortuousRope& r) { return r.modulus().complementary_modulus(); })
        .def_property_readonly("half_wave", &TortuousRope::half_wave)
        .def_property_readonly("half_wave_length", &TortuousRope::half_wave_length)
        .def_property_readonly("half_wave_slack", &TortuousRope::half_wave_slack)
        .def_property_readonly("half_wave_angle", &TortuousRope::half_wave_angle)
        .def(
            "at",
            [](const TortuousRope& r, const Array& x) {
                return columns<7>(
                    [&](double at) {
                        const analytic::TortuousPoint p = r.at(at);
                        return std::array<double, 7>{p.x,           p.arc,          p.radius, p.angle, p.radius_slope,
                                                     p.angle_slope, p.tension_ratio};
                    },
                    x);
            },
            "x"_a, "Points of the rope at x.");
}
}  // namespace

void bind_elliptic(py::module_& module) {
    bind_functions(module);
    bind_governor(module);
    bind_ropes(module);
}
