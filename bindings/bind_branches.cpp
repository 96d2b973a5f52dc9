// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/branches.hpp"
#include "revchain/stability_windows.hpp"

namespace {

using Chain = revchain::Chain<double>;
using revchain::Branch;
using revchain::Branches;
using revchain::Index;

py::array numbers(const std::vector<double>& values) {
    return frozen(py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data()));
}

template <class Whole>
py::array whole_numbers(const std::vector<Whole>& values) {
    py::array_t<std::int64_t> result(static_cast<py::ssize_t>(values.size()));
    std::transform(values.begin(), values.end(), result.mutable_data(),
                   [](Whole x) { return static_cast<std::int64_t>(x); });
    return frozen(std::move(result));
}

revchain::OnBranchOptions given(Index mode, const std::string& name, double value, double gravity, int direction,
                                std::optional<double> lowest) {
    revchain::OnBranchOptions result{
        .mode = mode, .gravity = gravity, .direction = rotation(direction), .min_conical_height = lowest};
    if (name == "conical_height") result.conical_height = value;
    if (name == "angular_speed") result.angular_speed = value;
    if (name == "tip_inclination") result.tip_inclination = value;
    if (name == "tip_radius") result.tip_radius = value;
    if (name == "top_tension") result.top_tension = value;
    return result;
}

const Chain& chain_of(const Chain& chain) { return chain; }
const Chain& chain_of(const revchain::Rig& rig) { return rig.chain(); }

/// The questions about branches of one kind of system.
template <class System>
void def_branches(py::module_& module) {
    module.def(
        "branch",
        [](const System& system, Index mode, double height, std::size_t max_points, double max_step, double gravity,
           int direction) {
            const py::gil_scoped_release release;
            return revchain::branch(system, {.mode = mode,
                                             .min_conical_height = height,
                                             .max_points = max_points,
                                             .max_step = max_step,
                                             .gravity = gravity,
                                             .direction = rotation(direction)});
        },
        "system"_a, "mode"_a, "height"_a, "max_points"_a, "max_step"_a, "gravity"_a, "direction"_a);
    module.def(
        "branches",
        [](const System& system, double height, int lists, long budget, long proof_budget, double gravity,
           int direction) {
            const py::gil_scoped_release release;
            return revchain::branches(system, {.min_conical_height = height,
                                               .lists = lists,
                                               .budget = budget,
                                               .proof_budget = proof_budget,
                                               .gravity = gravity,
                                               .direction = rotation(direction)});
        },
        "system"_a, "height"_a, "lists"_a, "budget"_a, "proof_budget"_a, "gravity"_a, "direction"_a);
    module.def(
        "shapes_on_branch",
        [](const System& system, Index mode, const std::string& name, double value, double gravity, int direction,
           std::optional<double> min_conical_height) {
            const py::gil_scoped_release release;
            const auto options = given(mode, name, value, gravity, direction, min_conical_height);
            return revchain::shapes_on_branch(system, options).shapes;
        },
        "system"_a, "mode"_a, "name"_a, "value"_a, "gravity"_a, "direction"_a, "min_conical_height"_a);
    module.def(
        "steady_shape",
        [](const System& system, Index mode, const std::string& name, double value, double gravity, int direction,
           std::optional<double> min_conical_height) {
            const py::gil_scoped_release release;
            const auto options = given(mode, name, value, gravity, direction, min_conical_height);
            return revchain::steady_shape(system, options);
        },
        "system"_a, "mode"_a, "name"_a, "value"_a, "gravity"_a, "direction"_a, "min_conical_height"_a);
    module.def(
        "stability_windows",
        [](const System& system, const Branch& branch, bool driven, double tolerance, int samples) {
            using revchain::StabilityFrame;
            const revchain::StabilityWindowsOptions options{driven ? StabilityFrame::driven : StabilityFrame::free,
                                                            tolerance, samples};
            const auto found = aside(chain_of(system), nullptr, [system, branch, options](const Chain&) {
                return revchain::stability_windows(system, branch, options);
            });
            std::vector<std::tuple<double, double, double, double, std::string>> result;
            for (const auto& w : found)
                result.emplace_back(w.arc_from, w.arc_to, w.height_from, w.height_to,
                                    std::string(to_string(w.verdict)));
            return result;
        },
        "system"_a, "branch"_a, "driven"_a, "tolerance"_a, "samples"_a);
}

}  // namespace

void bind_branches(py::module_& module) {
    const auto column = [](std::vector<double> Branch::*member) {
        return [member](const Branch& branch) { return numbers(branch.*member); };
    };
    py::class_<Branch>(module, "Branch", "A branch of steady shapes, point by point.")
        .def_readonly("mode", &Branch::mode)
        .def_property_readonly("birth", [](const Branch& b) { return std::string(to_string(b.birth)); })
        .def_property_readonly("arc", column(&Branch::arc))
        .def_property_readonly("conical_height", column(&Branch::conical_height))
        .def_property_readonly("tip_inclination", column(&Branch::tip_inclination))
        .def_property_readonly("tip_radius", column(&Branch::tip_radius))
        .def_property_readonly("top_tension", column(&Branch::top_tension))
        .def_property_readonly("moment_of_inertia", column(&Branch::moment_of_inertia))
        .def_property_readonly("effective_energy", column(&Branch::effective_energy))
        .def_property_readonly("half_waves", [](const Branch& b) { return whole_numbers(b.half_waves); })
        .def_property_readonly("folds", [](const Branch& b) { return whole_numbers(b.folds); })
        .def_property_readonly("end", [](const Branch& b) { return std::string(to_string(b.end)); })
        .def("shape", &Branch::shape, "point"_a)
        .def("states_at", &Branch::shapes_at, "height"_a);
    py::class_<Branches>(module, "Branches", "All branches found above one conical height.")
        .def_readonly("branches", &Branches::branches)
        .def_readonly("consistent", &Branches::consistent)
        .def_readonly("complete", &Branches::complete)
        .def_property_readonly("looked_at", [](const Branches& b) { return numbers(b.looked_at); })
        .def_readonly("remark", &Branches::remark);
    def_branches<Chain>(module);
    def_branches<revchain::Rig>(module);
}
