// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "revchain/cord.hpp"
#include "shapes.hpp"

namespace {

using revchain::Cord;
using revchain::CordBranch;
using revchain::Index;
using Point = revchain::finite::BranchLine::Point;

revchain::OnBranchOptions on_branch(Index mode, const std::string& name, double value, double gravity, int,
                                    std::optional<double> lowest) {
    return selected(revchain::OnBranchOptions{.mode = mode, .gravity = gravity, .min_conical_height = lowest}, name,
                    value);
}

/// Place and direction, each as bend and log of the height, and the two other numbers of each point.
py::array line_points(const CordBranch& branch) {
    revchain::Table<double> table(static_cast<Index>(branch.points.size()), 6);
    double* to = table.data();
    for (const Point& p : branch.points)
        for (const double x : {p.at.bend, p.at.log_height, p.direction.bend, p.direction.log_height, p.rate, p.off})
            *to++ = x;
    return to_numpy(table);
}

/// The branch of a file, with which further shapes are computed.
CordBranch cord_branch_from(const Cord& cord, Index mode, const std::string&, const Array& arc, const Array& height,
                            const Array& half_waves, const Array& folds, const Array& points, double, int) {
    CordBranch branch;
    set_columns(branch, arc, height, half_waves, folds);
    branch.mode = mode;
    if (points.ndim() != 2 || points.shape(1) != 6 || points.shape(0) != arc.size() || arc.size() == 0)
        revchain::detail::throw_invalid("Branch", "this is not the state of a branch");
    branch.line = std::make_shared<const revchain::finite::BranchLine>(cord, branch.half_waves.front());
    for (const double* p = points.data(); p != points.data() + points.size(); p += 6)
        branch.points.push_back({{p[0], p[1]}, {p[2], p[3]}, p[4], p[5]});
    return branch;
}

}  // namespace

void bind_cord_branches(py::module_& module) {
    bind_branch<CordBranch>(module, "CordBranch")
        .def_property_readonly("birth", [](const CordBranch& b) { return b.mode == 0 ? "fold" : "vertical"; })
        .def_property_readonly("points", &line_points);
    bind_diagram<revchain::CordBranches>(module, "CordBranches");
    module.def(
        "branch",
        [](const Cord& cord, Index mode, double height, std::size_t max_points, double max_step, double, int) {
            const py::gil_scoped_release release;
            return revchain::branch(
                cord, {.mode = mode, .min_conical_height = height, .max_points = max_points, .max_step = max_step});
        },
        "system"_a, "mode"_a, "height"_a, "max_points"_a, "max_step"_a, "gravity"_a, "direction"_a);
    module.def(
        "branches",
        [](const Cord& cord, double height, int lists, long, long, double, int) {
            const py::gil_scoped_release release;
            return revchain::branches(cord, {.min_conical_height = height, .lists = lists});
        },
        "system"_a, "height"_a, "lists"_a, "budget"_a, "proof_budget"_a, "gravity"_a, "direction"_a);
    def_on_branch<Cord>(module, "shapes_on_branch", [](const Cord& cord, auto... wanted) {
        return revchain::shapes_on_branch(cord, on_branch(wanted...)).shapes;
    });
    def_on_branch<Cord>(module, "steady_shape", [](const Cord& cord, auto... wanted) {
        return revchain::steady_shape(cord, on_branch(wanted...));
    });
    module.def("branch_from", &cord_branch_from, "system"_a, "mode"_a, "birth"_a, "arc"_a, "conical_height"_a,
               "half_waves"_a, "folds"_a, "points"_a, "gravity"_a, "direction"_a);
}
