// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/cord.hpp"
#include "revchain/held.hpp"
#include "shapes.hpp"

namespace {

using HeldChain = revchain::Held<revchain::Chain<double>>;
using HeldCord = revchain::Held<revchain::Cord>;
using revchain::HeldCordShape;
using revchain::HeldShape;
using revchain::Index;

/// Binds what the shapes of held links and of held cords share.
template <class Shape>
py::class_<Shape> bind_held_shape(py::module_& module, const char* name, const char* what) {
    auto shape = bind_shape<Shape>(module, name, what);
    def_column(shape, "tension", &Shape::height_times_tension);
    shape.def_readwrite("lower_pull", &Shape::lower_pull)
        .def_readwrite("upper_pull", &Shape::upper_pull)
        .def_readwrite("span", &Shape::span)
        .def_readwrite("moment_of_inertia", &Shape::moment_of_inertia);
    return shape;
}

template <class Shape>
struct BranchesOf {
    std::vector<revchain::HeldBranchOf<Shape>> branches;
};

template <class System>
auto branches_of(const System& held, double height, double max_step) {
    return revchain::branches(held, {.min_conical_height = height, .max_step = max_step});
}

/// The branch of a mode among those at the greatest speed.
template <class System>
auto branch_of(const System& held, Index mode, double height, double max_step) {
    auto found = branches_of(held, height, max_step);
    std::string modes;
    for (auto& each : found) {
        if (each.mode == mode) return std::move(each);
        modes += (modes.empty() ? "" : ", ") + std::to_string(each.mode);
    }
    const auto& by = held.by();
    const std::string which =
        by.lower.radius == 0 && by.upper.radius == 0
            ? "from 1 to " + std::to_string(found.size()) + ", the branches at the greatest speed"
            : "that of a branch at the greatest speed, here one of " + (modes.empty() ? "none" : modes);
    revchain::detail::throw_invalid("branch", "mode must be " + which, mode);
}

template <class System, class Shape>
void def_held_branches(py::module_& module, const char* branch, const char* list) {
    using Found = revchain::HeldBranchOf<Shape>;
    py::class_<Found>(module, branch, "A branch of steady shapes of a system held at a span.")
        .def_readonly("mode", &Found::mode)
        .def_readonly("shapes", &Found::shapes)
        .def_readonly("folds", &Found::folds)
        .def_property_readonly("end", [](const Found& b) { return std::string(to_string(b.end)); });
    py::class_<BranchesOf<Shape>>(module, list, "The branches of a system held at a span.")
        .def_readonly("branches", &BranchesOf<Shape>::branches);
    module.def(
        "branch",
        [](const System& held, Index mode, double height, std::size_t, double max_step, double, int) {
            const py::gil_scoped_release release;
            return branch_of(held, mode, height, max_step);
        },
        "system"_a, "mode"_a, "height"_a, "max_points"_a, "max_step"_a, "gravity"_a, "direction"_a);
    module.def(
        "branches",
        [](const System& held, double height, int, long, long, double, int) {
            const py::gil_scoped_release release;
            return BranchesOf<Shape>{branches_of(held, height, 0.1)};
        },
        "system"_a, "height"_a, "lists"_a, "budget"_a, "proof_budget"_a, "gravity"_a, "direction"_a);
    def_on_branch<System>(module, "steady_shape",
                          [](const System& held, Index mode, const std::string& name, double value, double gravity, int,
                             std::optional<double>) {
                              const revchain::HeldOnBranchOptions options{.mode = static_cast<int>(mode),
                                                                          .gravity = gravity};
                              return revchain::steady_shape(held, selected(options, name, value));
                          });
}

}  // namespace

void bind_held(py::module_& module) {
    auto links = bind_held_shape<HeldShape>(module, "HeldShape", "A steady shape of a chain held at both ends.");
    def_column(links, "reaction_inclination", &HeldShape::force_inclination);
    links.def_readwrite("proved", &HeldShape::proved)
        .def_readwrite("effective_energy", &HeldShape::height_times_energy)
        .def_property(
            "ends",
            [](const HeldShape& shape) {
                revchain::Table<double> table(2, 3);
                for (Index i = 0; i < 2; ++i) {
                    const revchain::Support& end = shape.ends[static_cast<std::size_t>(i)];
                    table.row(i) << end.stiffness.high, end.carriage_weight, end.radius;
                }
                return to_numpy(table);
            },
            [](HeldShape& shape, const Array& table) {
                for (std::size_t i = 0; i < 2; ++i) {
                    const double* end = table.data() + 3 * i;
                    shape.ends[i] = {end[0], end[1], end[2]};
                }
            });
    auto cords = bind_held_shape<HeldCordShape>(module, "HeldCordShape", "A steady shape of a cord held at both ends.");
    def_column(cords, "arc_length", &HeldCordShape::arc_length);
    cords
        .def_property(
            "path",
            [](const HeldCordShape& shape) {
                revchain::Table<double> table(static_cast<Index>(shape.steps.size()), 5);
                Index i = 0;
                for (const auto& x : shape.steps) table.row(i++) << x.arc, x.offset, x.rise, x.across, x.along;
                return to_numpy(table);
            },
            [](HeldCordShape& shape, const Array& table) {
                shape.steps.clear();
                for (const double* x = table.data(); x != table.data() + table.size(); x += 5)
                    shape.steps.push_back({x[0], x[1], x[2], x[3], x[4]});
            })
        .def(
            "along",
            [](const HeldCordShape& shape, const Array& arc) {
                return columns<4>(
                    [&](double s) {
                        const revchain::HeldCordPlace p = shape(s);
                        return std::array{p.offset, p.height, p.inclination, p.height_times_tension};
                    },
                    arc);
            },
            "arc"_a);
    module.def(
        "blank_shape", [](const HeldChain&) { return HeldShape{}; }, "system"_a);
    module.def(
        "blank_shape",
        [](const HeldCord& held) {
            HeldCordShape shape;
            shape.length = held.length(), shape.weight = held.system().weight();
            return shape;
        },
        "system"_a);
    bind_shapes<revchain::HeldShapes>(module, "HeldShapes");
    bind_shapes<revchain::HeldCordShapes>(module, "HeldCordShapes");
    def_held_branches<HeldChain, HeldShape>(module, "HeldBranch", "HeldBranches");
    def_held_branches<HeldCord, HeldCordShape>(module, "HeldCordBranch", "HeldCordBranches");
    def_steady_shapes<HeldChain>(module, [](const HeldChain& held, const AtSpeed& at) {
        return revchain::steady_shapes(held, {.conical_height = at.conical_height,
                                              .angular_speed = at.angular_speed,
                                              .gravity = at.gravity,
                                              .max_half_waves = at.max_half_waves,
                                              .prove = at.prove,
                                              .budget = at.budget});
    });
    def_steady_shapes<HeldCord>(module, [](const HeldCord& held, const AtSpeed& at) {
        return revchain::steady_shapes(held, {.conical_height = at.conical_height,
                                              .angular_speed = at.angular_speed,
                                              .gravity = at.gravity,
                                              .max_half_waves = at.max_half_waves});
    });
    def_stability<HeldChain, HeldShape>(
        module, [](const HeldChain& held, const HeldShape& shape, revchain::StabilityFrame in, int, double) {
            using Chain = revchain::Chain<double>;
            return aside(held.system(), nullptr, [=](const Chain& own) { return revchain::stability(own, shape, in); });
        });
    def_stability<HeldCord, HeldCordShape>(
        module, [](const HeldCord& held, const HeldCordShape& shape, revchain::StabilityFrame in, int, double) {
            return aside(nullptr, [=] { return revchain::stability(held.system(), shape, in); });
        });
}
