// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "bindings.hpp"
#include "revchain/cord.hpp"

namespace {

using revchain::Cord;
using revchain::CordBranch;
using revchain::CordBranches;
using revchain::Index;

template <class To, class From>
py::array array_of(const std::vector<From>& values) {
    py::array_t<To> result(static_cast<py::ssize_t>(values.size()));
    std::transform(values.begin(), values.end(), result.mutable_data(), [](From x) { return static_cast<To>(x); });
    return frozen(std::move(result));
}

std::vector<revchain::CordShape> on_branch(const Cord& cord, Index mode, const std::string& name, double value,
                                           double gravity, std::optional<double> lowest, bool all) {
    const py::gil_scoped_release release;
    revchain::OnBranchOptions options{.mode = mode, .gravity = gravity, .min_conical_height = lowest};
    if (name == "conical_height") options.conical_height = value;
    if (name == "angular_speed") options.angular_speed = value;
    if (name == "tip_inclination") options.tip_inclination = value;
    if (name == "tip_radius") options.tip_radius = value;
    if (name == "top_tension") options.top_tension = value;
    if (all) return revchain::shapes_on_branch(cord, options).shapes;
    return {revchain::steady_shape(cord, options)};
}

}  // namespace

void bind_cord_branches(py::module_& module) {
    const auto column = [](std::vector<double> CordBranch::*member) {
        return [member](const CordBranch& branch) { return array_of<double>(branch.*member); };
    };
    py::class_<CordBranch>(module, "CordBranch", "A branch of steady shapes of a cord, point by point.")
        .def_readonly("mode", &CordBranch::mode)
        .def_property_readonly("arc", column(&CordBranch::arc))
        .def_property_readonly("conical_height", column(&CordBranch::conical_height))
        .def_property_readonly("tip_inclination", column(&CordBranch::tip_inclination))
        .def_property_readonly("tip_radius", column(&CordBranch::tip_radius))
        .def_property_readonly("top_tension", column(&CordBranch::top_tension))
        .def_property_readonly("moment_of_inertia", column(&CordBranch::moment_of_inertia))
        .def_property_readonly("effective_energy", column(&CordBranch::effective_energy))
        .def_property_readonly("half_waves", [](const CordBranch& b) { return array_of<std::int64_t>(b.half_waves); })
        .def_property_readonly("folds", [](const CordBranch& b) { return array_of<std::int64_t>(b.folds); })
        .def_property_readonly("end", [](const CordBranch& b) { return std::string(to_string(b.end)); })
        .def("shape", &CordBranch::shape, "point"_a)
        .def("shapes_at", &CordBranch::shapes_at, "height"_a);
    py::class_<CordBranches>(module, "CordBranches", "All branches of a cord found above one conical height.")
        .def_readonly("branches", &CordBranches::branches)
        .def_readonly("consistent", &CordBranches::consistent)
        .def_readonly("complete", &CordBranches::complete)
        .def_property_readonly("looked_at", [](const CordBranches& b) { return array_of<double>(b.looked_at); })
        .def_readonly("remark", &CordBranches::remark);
    module.def(
        "cord_branch",
        [](const Cord& cord, Index mode, double height, std::size_t max_points, double max_step) {
            const py::gil_scoped_release release;
            return revchain::branch(
                cord, {.mode = mode, .min_conical_height = height, .max_points = max_points, .max_step = max_step});
        },
        "cord"_a, "mode"_a, "height"_a, "max_points"_a, "max_step"_a);
    module.def(
        "cord_branches",
        [](const Cord& cord, double height, int lists) {
            const py::gil_scoped_release release;
            return revchain::branches(cord, {.min_conical_height = height, .lists = lists});
        },
        "cord"_a, "height"_a, "lists"_a);
    module.def("cord_shapes_on_branch", &on_branch, "cord"_a, "mode"_a, "name"_a, "value"_a, "gravity"_a,
               "min_conical_height"_a, "all"_a);
    module.def(
        "cord_shape_near",
        [](const Cord& cord, double height, int half_waves, double tip_offset, bool at_fold) {
            const py::gil_scoped_release release;
            return revchain::finite::shape_near(cord, height, half_waves, tip_offset, at_fold);
        },
        "cord"_a, "height"_a, "half_waves"_a, "tip_offset"_a, "at_fold"_a);
}
