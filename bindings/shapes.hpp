// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "bindings.hpp"
#include "revchain/stability.hpp"

// Binds the members that shapes and branches share in all systems. Python makes a shape from its numbers:
// `blank_shape(system)`, then each number is set. Forces have the same names for all systems; those of held systems are
// times the conical height.

template <class Shape>
void def_column(py::class_<Shape>& shapes, const char* name, revchain::Vector<double> Shape::*member) {
    shapes.def_property(
        name, [member](const Shape& shape) { return to_numpy(shape.*member); },
        [member](Shape& shape, const Array& values) {
            shape.*member = Eigen::Map<const revchain::Vector<double>>(values.data(), values.size());
        });
}

template <class Shape>
py::class_<Shape> bind_shape(py::module_& module, const char* name, const char* what) {
    py::class_<Shape> shapes(module, name, what);
    def_column(shapes, "inclination", &Shape::inclination);
    def_column(shapes, "offset", &Shape::offset);
    def_column(shapes, "height", &Shape::height);
    return shapes.def_readwrite("half_waves", &Shape::half_waves)
        .def_readwrite("conical_height", &Shape::conical_height)
        .def_readwrite("residual", &Shape::residual)
        .def_readwrite("error_bound", &Shape::error_bound)
        .def_readwrite("condition", &Shape::condition);
}

/// Shapes at one speed; of every system they have the same names.
template <class Shapes>
py::class_<Shapes> bind_shapes(py::module_& module, const char* name) {
    py::class_<Shapes> list(module, name, "The steady shapes of a system at one speed.");
    list.def_readonly("shapes", &Shapes::shapes)
        .def_readonly("complete", &Shapes::complete)
        .def_property_readonly("missing",
                               [](const Shapes& found) {
                                   if constexpr (requires { found.missing; }) return found.missing;
                                   return std::vector<int>();
                               })
        .def_property_readonly("cells",
                               [](const Shapes& found) {
                                   if constexpr (requires { found.cells; }) return static_cast<long>(found.cells);
                                   return 0L;
                               })
        .def_property_readonly("undecided", [](const Shapes& found) {
            if constexpr (requires { found.undecided; }) {
                revchain::Table<double> table(static_cast<revchain::Index>(found.undecided.size()), 2);
                for (revchain::Index i = 0; i < table.rows(); ++i) {
                    const auto& range = found.undecided[static_cast<std::size_t>(i)];
                    table(i, 0) = range.low, table(i, 1) = range.high;
                }
                return to_numpy(table);
            } else {
                return to_numpy(revchain::Table<double>(0, 2));
            }
        });
    return list;
}

/// The arguments of `shapes` at one speed; each system reads those that it has.
struct AtSpeed {
    std::optional<double> conical_height, angular_speed;
    double gravity;
    int direction;
    bool hanging_only;
    int max_half_waves;
    bool prove;
    long budget;
    revchain::Index threads;
};

template <class System, class Find>
void def_steady_shapes(py::module_& module, Find find) {
    module.def(
        "steady_shapes",
        [find](const System& system, std::optional<double> conical_height, std::optional<double> angular_speed,
               double gravity, int direction, bool hanging_only, int max_half_waves, bool prove, long budget,
               revchain::Index threads) {
            const py::gil_scoped_release release;
            return find(system, AtSpeed{conical_height, angular_speed, gravity, direction, hanging_only, max_half_waves,
                                        prove, budget, threads});
        },
        "system"_a, "conical_height"_a, "angular_speed"_a, "gravity"_a, "direction"_a, "hanging_only"_a,
        "max_half_waves"_a, "prove"_a, "budget"_a, "threads"_a);
}

inline revchain::StabilityFrame frame(bool driven) {
    return driven ? revchain::StabilityFrame::driven : revchain::StabilityFrame::free;
}

/// `judge(system, shape, frame, direction, gravity)`.
template <class System, class Shape, class Judge>
void def_stability(py::module_& module, Judge judge) {
    module.def(
        "stability",
        [judge](const System& system, const Shape& shape, bool driven, int direction, double gravity) {
            return judge(system, shape, frame(driven), direction, gravity);
        },
        "system"_a, "shape"_a, "driven"_a, "direction"_a, "gravity"_a);
}

/// The number that selects shapes on a branch, set by its name.
template <class Options>
Options selected(Options options, const std::string& name, double value) {
    if (name == "conical_height") options.conical_height = value;
    if (name == "angular_speed") options.angular_speed = value;
    if (name == "top_tension") options.top_tension = value;
    if constexpr (requires { options.tip_radius; }) {
        if (name == "lowest_inclination") options.tip_inclination = value;
        if (name == "tip_radius") options.tip_radius = value;
    }
    return options;
}

/// `find(system, mode, name, value, gravity, direction, min_conical_height)`, without the GIL.
template <class System, class Find>
void def_on_branch(py::module_& module, const char* question, Find find) {
    module.def(
        question,
        [find](const System& system, revchain::Index mode, const std::string& name, double value, double gravity,
               int direction, std::optional<double> min_conical_height) {
            const py::gil_scoped_release release;
            return find(system, mode, name, value, gravity, direction, min_conical_height);
        },
        "system"_a, "mode"_a, "name"_a, "value"_a, "gravity"_a, "direction"_a, "min_conical_height"_a);
}

/// Binds the members that branches share in all hanging systems.
template <class Branch>
py::class_<Branch> bind_branch(py::module_& module, const char* name) {
    py::class_<Branch> branches(module, name, "A branch of steady shapes, point by point.");
    const auto column = [&branches](const char* what, auto member) {
        branches.def_property_readonly(what, [member](const Branch& branch) {
            const auto& values = branch.*member;
            using Value = typename std::decay_t<decltype(values)>::value_type;
            using Number = std::conditional_t<std::is_integral_v<Value>, std::int64_t, Value>;
            py::array_t<Number> result(static_cast<py::ssize_t>(values.size()));
            std::transform(values.begin(), values.end(), result.mutable_data(),
                           [](Value x) { return static_cast<Number>(x); });
            return frozen(std::move(result));
        });
    };
    column("arc", &Branch::arc), column("conical_height", &Branch::conical_height);
    column("lowest_inclination", &Branch::tip_inclination), column("tip_radius", &Branch::tip_radius);
    column("top_tension", &Branch::top_tension), column("moment_of_inertia", &Branch::moment_of_inertia);
    column("effective_energy", &Branch::effective_energy), column("half_waves", &Branch::half_waves);
    column("folds", &Branch::folds);
    return branches.def_property_readonly("mode", [](const Branch& b) { return b.mode; })
        .def_property_readonly("end", [](const Branch& b) { return std::string(to_string(b.end)); })
        .def("shape", &Branch::shape, "point"_a)
        .def("shapes_at", &Branch::shapes_at, "height"_a);
}

template <class Branches>
void bind_diagram(py::module_& module, const char* name) {
    py::class_<Branches>(module, name, "All branches found above one conical height.")
        .def_readonly("branches", &Branches::branches)
        .def_readonly("consistent", &Branches::consistent)
        .def_readonly("complete", &Branches::complete)
        .def_property_readonly(
            "looked_at",
            [](const Branches& b) {
                return frozen(py::array_t<double>(static_cast<py::ssize_t>(b.looked_at.size()), b.looked_at.data()));
            })
        .def_readonly("remark", &Branches::remark);
}

/// The columns of a branch as a file holds them, without what can be computed from them.
template <class Branch>
void set_columns(Branch& branch, const Array& arc, const Array& height, const Array& half_waves, const Array& folds) {
    const auto copy = [](auto& to, const Array& from) {
        using Value = typename std::decay_t<decltype(to)>::value_type;
        to.resize(static_cast<std::size_t>(from.size()));
        std::transform(from.data(), from.data() + from.size(), to.begin(),
                       [](double x) { return static_cast<Value>(x); });
    };
    copy(branch.arc, arc), copy(branch.conical_height, height);
    copy(branch.half_waves, half_waves), copy(branch.folds, folds);
}
