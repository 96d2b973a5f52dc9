// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "bindings.hpp"
#include "forces.hpp"
#include "interrupt.hpp"
#include "revchain/cord.hpp"
#include "revchain/held.hpp"
#include "revchain/stability.hpp"

namespace {

using Chain = revchain::Chain<double>;
using revchain::Held;
using revchain::HeldCordShape;
using revchain::HeldShape;

/// Shapes of a chain or a cord; without holding the GIL.
template <class System>
auto shapes(const System& system, std::optional<double> span, const Tension& pull, bool weightless, const End& lower,
            const End& upper, std::optional<double> conical_height, std::optional<double> angular_speed, double gravity,
            int max_half_waves, bool prove, long budget) {
    const py::gil_scoped_release release;
    const Held held(system, {.span = span,
                             .tension = tension(pull),
                             .weightless = weightless,
                             .lower = support(lower),
                             .upper = support(upper)});
    if constexpr (std::is_same_v<System, revchain::Cord>)
        return revchain::steady_shapes(held, {.conical_height = conical_height,
                                              .angular_speed = angular_speed,
                                              .gravity = gravity,
                                              .max_half_waves = max_half_waves});
    else
        return revchain::steady_shapes(held, {.conical_height = conical_height,
                                              .angular_speed = angular_speed,
                                              .gravity = gravity,
                                              .max_half_waves = max_half_waves,
                                              .prove = prove,
                                              .budget = budget});
}

template <class System>
void def_shapes(py::module_& module) {
    module.def("held_shapes", &shapes<System>, "system"_a, "span"_a, "tension"_a, "weightless"_a, "lower"_a, "upper"_a,
               "conical_height"_a, "angular_speed"_a, "gravity"_a, "max_half_waves"_a, "prove"_a, "budget"_a);
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
        .def_readonly("moment_of_inertia", &Shape::moment_of_inertia)
        .def_readonly("condition", &Shape::condition);
}

template <class Shapes>
py::class_<Shapes> bind_shapes(py::module_& module, const char* name) {
    return py::class_<Shapes>(module, name, "The steady shapes of a system held at both ends.")
        .def_readonly("shapes", &Shapes::shapes)
        .def_readonly("missing", &Shapes::missing)
        .def_readonly("complete", &Shapes::complete);
}

template <class Shape>
void def_branches(py::module_& module, const char* name) {
    using Found = revchain::HeldBranchOf<Shape>;
    py::class_<Found>(module, name, "A branch of steady shapes of a system held at a span.")
        .def_readonly("mode", &Found::mode)
        .def_readonly("shapes", &Found::shapes)
        .def_readonly("folds", &Found::folds)
        .def_property_readonly("end", [](const Found& b) { return std::string(to_string(b.end)); });
}

template <class System>
void def_on_branches(py::module_& module) {
    module.def(
        "held_branches",
        [](const System& system, double span, const End& lower, const End& upper, double height, double max_step) {
            const py::gil_scoped_release release;
            return revchain::branches(Held(system, {.span = span, .lower = support(lower), .upper = support(upper)}),
                                      {.min_conical_height = height, .max_step = max_step});
        },
        "system"_a, "span"_a, "lower"_a, "upper"_a, "height"_a, "max_step"_a);
    module.def(
        "held_shape",
        [](const System& system, double span, const End& lower, const End& upper, int mode, const std::string& name,
           double value, double gravity) {
            const py::gil_scoped_release release;
            revchain::HeldOnBranchOptions options{.mode = mode, .gravity = gravity};
            (name == "conical_height"  ? options.conical_height
             : name == "angular_speed" ? options.angular_speed
                                       : options.top_tension) = value;
            return revchain::steady_shape(
                Held(system, {.span = span, .lower = support(lower), .upper = support(upper)}), options);
        },
        "system"_a, "span"_a, "lower"_a, "upper"_a, "mode"_a, "name"_a, "value"_a, "gravity"_a);
}

}  // namespace

void bind_held(py::module_& module) {
    bind_shape<HeldShape>(module, "HeldShape", "A steady shape of a chain held at both ends.")
        .def_property_readonly("force_inclination", column(&HeldShape::force_inclination))
        .def_readonly("proved", &HeldShape::proved)
        .def_readonly("height_times_energy", &HeldShape::height_times_energy);
    bind_shapes<revchain::HeldShapes>(module, "HeldShapes")
        .def_property_readonly("undecided",
                               [](const revchain::HeldShapes& found) {
                                   revchain::Table<double> table(static_cast<revchain::Index>(found.undecided.size()),
                                                                 2);
                                   for (revchain::Index i = 0; i < table.rows(); ++i) {
                                       const auto& range = found.undecided[static_cast<std::size_t>(i)];
                                       table(i, 0) = range.low, table(i, 1) = range.high;
                                   }
                                   return to_numpy(table);
                               })
        .def_readonly("cells", &revchain::HeldShapes::cells);
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
    def_branches<HeldShape>(module, "HeldBranch");
    def_branches<HeldCordShape>(module, "HeldCordBranch");
    def_on_branches<Chain>(module);
    def_on_branches<revchain::Cord>(module);
    def_shapes<Chain>(module);
    def_shapes<revchain::Cord>(module);
    module.def(
        "held_stability",
        [](const revchain::Cord& cord, const HeldCordShape& shape, bool driven) {
            const auto frame = driven ? revchain::StabilityFrame::driven : revchain::StabilityFrame::free;
            return aside(nullptr, [=] { return revchain::stability(cord, shape, frame); });
        },
        "cord"_a, "shape"_a, "driven"_a);
    module.def(
        "held_stability",
        [](const Chain& chain, const HeldShape& shape, bool driven) {
            const auto frame = driven ? revchain::StabilityFrame::driven : revchain::StabilityFrame::free;
            return aside(chain, nullptr, [=](const Chain& own) { return revchain::stability(own, shape, frame); });
        },
        "chain"_a, "shape"_a, "driven"_a);
}
