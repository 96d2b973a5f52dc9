// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/branches.hpp"
#include "revchain/finite/branch/onset.hpp"
#include "revchain/stability_windows.hpp"
#include "shapes.hpp"

namespace {

using Chain = revchain::Chain<double>;
using revchain::Branch;
using revchain::BranchBirth;
using revchain::Index;
using revchain::finite::BranchPoint;
using revchain::finite::BranchRoot;
using revchain::finite::BranchState;
using revchain::finite::BranchSystem;
using revchain::finite::trace_of;

/// The options of a question about a chain, or of the same about a rig, which has a direction of rotation.
template <class System, class OfChain, class OfRig>
using For = std::conditional_t<std::is_same_v<System, Chain>, OfChain, OfRig>;

template <class Options>
Options turning(Options options, int direction) {
    if constexpr (requires { options.direction; }) options.direction = rotation(direction);
    return options;
}

template <class System>
auto given(Index mode, const std::string& name, double value, double gravity, int direction,
           std::optional<double> lowest) {
    using Options = For<System, revchain::OnBranchOptions, revchain::RigOnBranchOptions>;
    return selected(turning(Options{.mode = mode, .gravity = gravity, .min_conical_height = lowest}, direction), name,
                    value);
}

const Chain& chain_of(const Chain& chain) { return chain; }
const Chain& chain_of(const revchain::Rig& rig) { return rig.chain(); }

/// The states and tangents of the points: tau of each link and log of the height, both twice.
py::array points_of(const Branch& branch) {
    const auto& points = trace_of(branch).points;
    const auto size = points.empty() ? 0 : static_cast<Index>(points.front().state.tau.size());
    revchain::Table<double> table(static_cast<Index>(points.size()), 2 * size + 2);
    double* to = table.data();
    for (const BranchPoint& point : points)
        for (const BranchState* of : {&point.state, &point.tangent}) {
            to = std::copy(of->tau.begin(), of->tau.end(), to);
            *to++ = of->log_height;
        }
    return to_numpy(table);
}

/// The branch of a file, with which further shapes are computed.
template <class System>
Branch branch_from(const System& system, Index mode, const std::string& birth, const Array& arc, const Array& height,
                   const Array& half_waves, const Array& folds, const Array& points, double gravity, int direction) {
    Branch branch;
    set_columns(branch, arc, height, half_waves, folds);
    branch.mode = mode;
    for (const BranchBirth each : {BranchBirth::vertical, BranchBirth::rest, BranchBirth::fold})
        if (birth == to_string(each)) branch.birth = each;
    auto& trace = trace_of(branch);
    if (branch.birth == BranchBirth::fold) {
        if constexpr (std::is_same_v<System, Chain>)
            trace.system = std::make_shared<const BranchSystem>(system);
        else
            trace.system = std::make_shared<const BranchSystem>(system, gravity, rotation(direction));
    } else {
        using Options = For<System, revchain::BranchOptions, revchain::RigBranchOptions>;
        BranchRoot root =
            BranchRoot::of("Branch", system, turning(Options{.mode = mode, .gravity = gravity}, direction));
        trace.system = root.system;
        if (root.onset) trace.onset = std::make_shared<const revchain::finite::BranchOnset>(std::move(*root.onset));
    }
    if (points.ndim() != 2 || points.shape(0) != arc.size())
        revchain::detail::throw_invalid("Branch", "this is not the state of a branch");
    const double* from = points.data();
    const py::ssize_t size = points.shape(1) / 2 - 1;
    for (std::size_t i = 0; i < branch.size(); ++i) {
        BranchPoint point;
        for (BranchState* of : {&point.state, &point.tangent}) {
            of->tau.assign(from, from + size);
            of->log_height = from[size], from += size + 1;
        }
        point.arc = branch.arc[i], point.half_waves = branch.half_waves[i];
        trace.points.push_back(std::move(point));
    }
    return branch;
}

/// The questions about branches of one kind of system.
template <class System>
void def_branches(py::module_& module) {
    module.def(
        "branch",
        [](const System& system, Index mode, double height, std::size_t max_points, double max_step, double gravity,
           int direction) {
            const py::gil_scoped_release release;
            using Options = For<System, revchain::BranchOptions, revchain::RigBranchOptions>;
            const Options options{.mode = mode,
                                  .min_conical_height = height,
                                  .max_points = max_points,
                                  .max_step = max_step,
                                  .gravity = gravity};
            return revchain::branch(system, turning(options, direction));
        },
        "system"_a, "mode"_a, "height"_a, "max_points"_a, "max_step"_a, "gravity"_a, "direction"_a);
    module.def(
        "branches",
        [](const System& system, double height, int lists, long budget, long proof_budget, double gravity,
           int direction) {
            const py::gil_scoped_release release;
            using Options = For<System, revchain::DiagramOptions, revchain::RigDiagramOptions>;
            const Options options{.min_conical_height = height,
                                  .lists = lists,
                                  .budget = budget,
                                  .proof_budget = proof_budget,
                                  .gravity = gravity};
            return revchain::branches(system, turning(options, direction));
        },
        "system"_a, "height"_a, "lists"_a, "budget"_a, "proof_budget"_a, "gravity"_a, "direction"_a);
    def_on_branch<System>(module, "shapes_on_branch", [](const System& system, auto... wanted) {
        return revchain::shapes_on_branch(system, given<System>(wanted...)).shapes;
    });
    def_on_branch<System>(module, "steady_shape", [](const System& system, auto... wanted) {
        return revchain::steady_shape(system, given<System>(wanted...));
    });
    module.def("branch_from", &branch_from<System>, "system"_a, "mode"_a, "birth"_a, "arc"_a, "conical_height"_a,
               "half_waves"_a, "folds"_a, "points"_a, "gravity"_a, "direction"_a);
    module.def(
        "stability_windows",
        [](const System& system, const Branch& branch, bool driven, double tolerance, int samples) {
            const revchain::StabilityWindowsOptions options{frame(driven), tolerance, samples};
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
    bind_branch<Branch>(module, "Branch")
        .def_property_readonly("birth", [](const Branch& b) { return std::string(to_string(b.birth)); })
        .def_property_readonly("points", &points_of);
    bind_diagram<revchain::Branches>(module, "Branches");
    def_branches<Chain>(module);
    def_branches<revchain::Rig>(module);
}
