// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/held.hpp"
#include "revchain/stability.hpp"

namespace {

using Chain = revchain::Chain<double>;
using revchain::Held;
using revchain::HeldBy;
using revchain::HeldCordShape;
using revchain::HeldShape;
using revchain::HeldShapesOptions;

/// Shapes at a conical height, where 0 stands for no gravity; without holding the GIL.
template <class System>
auto shapes_at_height(const System& system, HeldBy by, double height, HeldShapesOptions options) {
    const py::gil_scoped_release release;
    by.weightless = height == 0;
    if (height != 0) options.conical_height = height;
    return revchain::steady_shapes(Held(system, by), options);
}

/// The same for a tension at the upper end times the height; without gravity, tension at 1 rad/s.
template <class System>
auto shapes_under_tension(const System& system, double height_times_tension, double height, HeldShapesOptions options) {
    if (height == 0) options.angular_speed = 1;
    return shapes_at_height(system, {.tension = height_times_tension / (height == 0 ? 1 : height)}, height, options);
}

/// Whirl speeds of a chain held straight.
struct TautModes {
    double tension;  // at the lower end, in the unit of the weights
    revchain::Vector<double> conical_height, error_bound;
    revchain::Table<double> shape;
};

TautModes taut_modes(const Chain& chain, double tension, revchain::Index count) {
    revchain::detail::require_positive("taut_modes", "tension", tension);
    if (count < 1) revchain::detail::throw_invalid("taut_modes", "count must be at least 1", count);
    // the lower tension as it is: from that at the upper end its last digits would be lost beside the weight
    const revchain::finite::TautChain taut(chain, revchain::Wide<double>(tension));
    const revchain::Index found = std::min(count, taut.mode_count());
    TautModes modes{tension, revchain::Vector<double>(found),
                    revchain::Vector<double>::Constant(found, revchain::epsilon<double>()),
                    revchain::Table<double>(found, chain.size() + 1)};
    for (revchain::Index k = 0; k < found; ++k) {
        modes.conical_height[k] = taut.height(k);
        modes.shape.row(k) = taut.shape(modes.conical_height[k]).transpose();
    }
    return modes;
}

template <class Shape>
auto column(revchain::Vector<double> Shape::*member) {
    return [member](const Shape& shape) { return to_numpy(shape.*member); };
}

/// What shapes of links and of cords have in common.
template <class Shape>
py::class_<Shape> bind_shape(py::module_& module, const char* name, const char* what) {
    return py::class_<Shape>(module, name, what)
        .def_property_readonly("inclination", column(&Shape::inclination))
        .def_property_readonly("offset", column(&Shape::offset))
        .def_property_readonly("height", column(&Shape::height))
        .def_property_readonly("height_times_tension", column(&Shape::height_times_tension))
        .def_readonly("lower_pull", &Shape::lower_pull)
        .def_readonly("upper_pull", &Shape::upper_pull)
        .def_readonly("half_waves", &Shape::half_waves)
        .def_readonly("span", &Shape::span)
        .def_readonly("conical_height", &Shape::conical_height)
        .def_readonly("residual", &Shape::residual)
        .def_readonly("error_bound", &Shape::error_bound)
        .def_readonly("condition", &Shape::condition);
}

template <class Shapes>
void bind_shapes(py::module_& module, const char* name) {
    py::class_<Shapes>(module, name, "Steady shapes between two points of the axis.")
        .def_readonly("shapes", &Shapes::shapes)
        .def_readonly("missing", &Shapes::missing)
        .def_readonly("complete", &Shapes::complete);
}

}  // namespace

void bind_held(py::module_& module) {
    bind_shape<HeldShape>(module, "HeldShape", "A steady shape of a chain held at both ends.")
        .def_property_readonly("force_inclination", column(&HeldShape::force_inclination))
        .def_readonly("proved", &HeldShape::proved)
        .def_readonly("moment_of_inertia", &HeldShape::moment_of_inertia)
        .def_readonly("height_times_energy", &HeldShape::height_times_energy);
    bind_shapes<revchain::HeldShapes>(module, "HeldShapes");
    bind_shape<HeldCordShape>(module, "HeldCordShape", "A steady shape of a cord held at both ends.")
        .def_property_readonly("arc_length", column(&HeldCordShape::arc_length))
        .def_readonly("length", &HeldCordShape::length)
        .def(
            "at_arc",
            [](const HeldCordShape& shape, const Array& arc) {
                return columns<4>(
                    [&](double s) {
                        const revchain::HeldCordPlace p = shape(s);
                        return std::array{p.offset, p.height, p.inclination, p.height_times_tension};
                    },
                    arc);
            },
            "arc"_a);
    bind_shapes<revchain::HeldCordShapes>(module, "HeldCordShapes");
    module.def(
        "held_shapes",
        [](const Chain& chain, double span, double height, int most, bool prove) {
            return shapes_at_height(chain, {.span = span}, height, {.max_half_waves = most, .prove = prove});
        },
        "chain"_a, "span"_a, "height"_a, "most_half_waves"_a, "prove"_a);
    module.def(
        "held_shapes_at_speed",
        [](const Chain& chain, double span, double speed, double gravity, int most, bool prove) {
            const py::gil_scoped_release release;
            return revchain::steady_shapes(
                Held(chain, {.span = span, .weightless = gravity == 0}),
                {.angular_speed = speed, .gravity = gravity, .max_half_waves = most, .prove = prove});
        },
        "chain"_a, "span"_a, "angular_speed"_a, "gravity"_a, "most_half_waves"_a, "prove"_a);
    module.def(
        "held_shapes_under_tension",
        [](const Chain& chain, double tension, double height, int most, bool prove) {
            return shapes_under_tension(chain, tension, height, {.max_half_waves = most, .prove = prove});
        },
        "chain"_a, "height_times_tension"_a, "height"_a, "most_half_waves"_a, "prove"_a);
    module.def(
        "held_cord_shapes",
        [](double length, double span, double height, double weight, int most) {
            return shapes_at_height(revchain::Cord(length, {.weight = weight}), {.span = span}, height,
                                    {.max_half_waves = most});
        },
        "length"_a, "span"_a, "height"_a, "weight"_a, "most_half_waves"_a);
    module.def(
        "held_cord_shapes_under_tension",
        [](double length, double tension, double height, double weight, int most) {
            return shapes_under_tension(revchain::Cord(length, {.weight = weight}), tension, height,
                                        {.max_half_waves = most});
        },
        "length"_a, "height_times_tension"_a, "height"_a, "weight"_a, "most_half_waves"_a);
    module.def(
        "held_stability",
        [](const Chain& chain, const HeldShape& shape, bool driven) {
            const auto frame = driven ? revchain::StabilityFrame::driven : revchain::StabilityFrame::free;
            return aside(chain, nullptr, [=](const Chain& own) { return revchain::stability(own, shape, frame); });
        },
        "chain"_a, "shape"_a, "driven"_a);
    py::class_<TautModes>(module, "TautModes", "Whirl speeds of a chain held straight.")
        .def_readonly("tension", &TautModes::tension)
        .def_property_readonly("conical_height", column(&TautModes::conical_height))
        .def_property_readonly("error_bound", column(&TautModes::error_bound))
        .def_property_readonly("shape", [](const TautModes& modes) { return to_numpy(modes.shape); });
    module.def("taut_modes", &taut_modes, "chain"_a, "tension"_a, "count"_a);
}
