// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms: two links, governors with a sleeve, the buffer stop.
#include "bindings.hpp"
#include "revchain/buffer.hpp"
#include "revchain/sleeve_governor.hpp"
#include "revchain/two_links.hpp"

namespace {

using Link = revchain::CompoundLink<double>;
using Shape = revchain::PairShape<double>;

py::array pair(const std::array<double, 2>& values) { return frozen(py::array_t<double>(2, values.data())); }

}  // namespace

void bind_two_links(py::module_& module) {
    module.def("pendulum_length", vectorized([](double h, double k) {
                   return Link{h, k}.pendulum_length();
               }),
               "centroid"_a, "radius_of_gyration"_a);
    module.def("share_at_centre_of_oscillation", vectorized([](double h, double k) {
                   return Link{h, k}.share_at_centre_of_oscillation();
               }),
               "centroid"_a, "radius_of_gyration"_a);
    module.def(
        "swung_link",
        [](const Array& centroid, const Array& radius_of_gyration, const Array& height) {
            return columns<4>(
                [](double h, double k, double lambda) {
                    const auto s = revchain::swung_link(Link{h, k}, lambda);
                    return std::array<double, 4>{s.inclination, s.reaction, s.reaction_inclination, s.condition};
                },
                centroid, radius_of_gyration, height);
        },
        "centroid"_a, "radius_of_gyration"_a, "height"_a);
    module.def(
        "two_plummets",
        [](const Array& lower_weight, const Array& lower_thread, const Array& upper_weight, const Array& upper_thread) {
            return columns<2>(
                [](double w1, double l1, double w2, double l2) { return revchain::two_plummets(w1, l1, w2, l2); },
                lower_weight, lower_thread, upper_weight, upper_thread);
        },
        "lower_weight"_a, "lower_thread"_a, "upper_weight"_a, "upper_thread"_a);
    module.def(
        "two_plummets_from_the_middle",
        [](const Array& half_length, const Array& x, const Array& weight_ratio) {
            return columns<2>(
                [](double a, double at, double mu) { return revchain::two_plummets_from_the_middle(a, at, mu); },
                half_length, x, weight_ratio);
        },
        "half_length"_a, "x"_a, "weight_ratio"_a);
    module.def(
        "link_on_thread",
        [](const Array& thread, const Array& centroid, const Array& radius_of_gyration) {
            return columns<2>(
                [](double a, double h, double k) {
                    return revchain::link_on_thread(a, Link{h, k});
                },
                thread, centroid, radius_of_gyration);
        },
        "thread"_a, "centroid"_a, "radius_of_gyration"_a);
    module.def("standing_link", vectorized([](double a, double h, double k) {
                   return revchain::standing_link(a, Link{h, k});
               }),
               "thread"_a, "centroid"_a, "radius_of_gyration"_a);
    module.def("thread_of_standing_link", vectorized([](double lambda, double h, double k) {
                   return revchain::thread_of_standing_link(lambda, Link{h, k});
               }),
               "height"_a, "centroid"_a, "radius_of_gyration"_a);
    module.def("standing_plummet", vectorized([](double w1, double l1, double w2, double l2) {
                   return revchain::standing_plummet(w1, l1, w2, l2);
               }),
               "standing_weight"_a, "rod"_a, "hung_weight"_a, "thread"_a);
    module.def("spring_deflection",
               vectorized([](double weight, double e) { return revchain::spring_deflection(weight, e); }), "weight"_a,
               "stiffness"_a);
    module.def("seconds_lost_per_day", vectorized([](double c, double h, double k) {
                   return revchain::seconds_lost_per_day(c, Link{h, k});
               }),
               "deflection"_a, "centroid"_a, "radius_of_gyration"_a);

    py::class_<Shape>(module, "PairShape", "A steady shape of two links, the lower one first.")
        .def_property_readonly(
            "inclination", [](const Shape& s) { return pair(s.inclination); }, "Inclinations to the vertical, rad.")
        .def_property_readonly(
            "offset", [](const Shape& s) { return pair(s.offset); }, "Distances from the axis.")
        .def_property_readonly(
            "tension", [](const Shape& s) { return pair(s.tension); }, "Tensions divided by the whole weight.")
        .def_property_readonly("half_waves", &Shape::half_waves, "Sign changes of the offsets, plus one.");
    module.def("two_plummets_shapes", &revchain::two_plummets_shapes<double>, "lower_weight"_a, "lower_thread"_a,
               "upper_weight"_a, "upper_thread"_a, "height"_a);
    module.def(
        "link_on_thread_shapes",
        [](double a, double h, double k, double lambda) {
            return revchain::link_on_thread_shapes(a, Link{h, k}, lambda);
        },
        "thread"_a, "centroid"_a, "radius_of_gyration"_a, "height"_a);
    module.def("standing_plummet_shape", &revchain::standing_plummet_shape<double>, "standing_weight"_a, "rod"_a,
               "hung_weight"_a, "thread"_a, "height"_a);
    module.def(
        "standing_link_shape",
        [](double a, double h, double k, double lambda) {
            return revchain::standing_link_shape(a, Link{h, k}, lambda);
        },
        "thread"_a, "centroid"_a, "radius_of_gyration"_a, "height"_a);

    using revchain::GovernorPoint;
    using revchain::SleeveGovernor;
    const auto row = [](const GovernorPoint& p) {
        return std::array<double, 9>{p.inclination, p.speed, p.low_speed,          p.high_speed, p.ball_radius,
                                     p.height,      p.lift,  p.stable ? 1.0 : 0.0, p.period};
    };
    py::class_<SleeveGovernor>(module, "SleeveGovernor", "A centrifugal governor with a sleeve.")
        .def(
            py::init([](double ball_mass, int balls, double arm, double pivot_offset, double lower_arm, double joint,
                        double sleeve_offset, double sleeve_arm, double sleeve_mass, double spring_stiffness,
                        double spring_force, double friction, double shaft_inertia, double gravity) {
                return SleeveGovernor({ball_mass, balls, arm, pivot_offset, lower_arm, joint, sleeve_offset, sleeve_arm,
                                       sleeve_mass, spring_stiffness, spring_force, friction, shaft_inertia, gravity});
            }),
            "ball_mass"_a, "balls"_a, "arm"_a, "pivot_offset"_a, "lower_arm"_a, "joint"_a, "sleeve_offset"_a,
            "sleeve_arm"_a, "sleeve_mass"_a, "spring_stiffness"_a, "spring_force"_a, "friction"_a, "shaft_inertia"_a,
            "gravity"_a)
        .def(
            "at",
            [row](const SleeveGovernor& governor, const Array& inclination) {
                return columns<9>([&](double angle) { return row(governor.at(angle)); }, inclination);
            },
            "inclination"_a, "The governor at inclinations.")
        .def(
            "equilibria",
            [row](const SleeveGovernor& governor, double speed) {
                bool complete = false;
                const auto points = governor.equilibria(speed, &complete);
                revchain::Table<double> table(static_cast<revchain::Index>(points.size()), 9);
                for (revchain::Index i = 0; i < table.rows(); ++i) {
                    const auto values = row(points[static_cast<std::size_t>(i)]);
                    for (revchain::Index k = 0; k < 9; ++k) table(i, k) = values[static_cast<std::size_t>(k)];
                }
                return py::make_tuple(to_numpy(table), complete);
            },
            "speed"_a, "All equilibria at a speed.")
        .def(
            "effort",
            [](const SleeveGovernor& governor, double inclination, double change) {
                const auto answer = governor.effort(inclination, change);
                return py::make_tuple(answer.effort, answer.lift, answer.power);
            },
            "inclination"_a, "change"_a, "Effort, lift and power.");

    using revchain::BufferImpact;
    py::class_<BufferImpact>(module, "BufferImpact", "Two carriages that run against a buffer stop.")
        .def(py::init([](double front_mass, double rear_mass, double buffer_stiffness, double coupling_stiffness,
                         double speed) {
                 return BufferImpact({front_mass, rear_mass, buffer_stiffness, coupling_stiffness, speed});
             }),
             "front_mass"_a, "rear_mass"_a, "buffer_stiffness"_a, "coupling_stiffness"_a, "speed"_a)
        .def_property_readonly(
            "blows",
            [](const BufferImpact& impact) {
                revchain::Table<double> table(static_cast<revchain::Index>(impact.blows().size()), 3);
                for (revchain::Index i = 0; i < table.rows(); ++i) {
                    const revchain::Blow& blow = impact.blows()[static_cast<std::size_t>(i)];
                    table.row(i) << blow.start, blow.end, blow.impulse;
                }
                return to_numpy(table);
            },
            "Start, end and impulse of each blow.")
        .def(
            "state",
            [](const BufferImpact& impact, const Array& time) {
                return columns<5>(
                    [&](double t) {
                        const revchain::CarriageState s = impact(t);
                        return std::array<double, 5>{s.front, s.rear, s.front_speed, s.rear_speed, s.buffer_force};
                    },
                    time);
            },
            "time"_a, "Displacements, speeds and the buffer force.");
}
