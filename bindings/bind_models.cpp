// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/models/heights.hpp"

namespace {

using Chain = revchain::Chain<double>;
using revchain::Index;

/// (name, reason or None, error bound, cost) of each model, the number chosen, whether it keeps the tolerance.
py::tuple selected(const Chain& chain, Index first, Index count, double rtol, double inclination,
                   std::optional<double> time_budget) {
    const auto choice = revchain::models::select(revchain::models::height_models, chain,
                                                 {first, count, rtol, inclination}, time_budget);
    py::list rows;
    for (const revchain::Estimate& estimate : choice.estimates)
        rows.append(py::make_tuple(estimate.name,
                                   estimate.fit.applies ? py::object(py::none()) : py::str(estimate.fit.reason),
                                   estimate.error_bound, estimate.cost));
    return py::make_tuple(rows, choice.model, choice.meets_tolerance);
}

py::tuple answered(const revchain::models::Solution& found) {
    const py::object low = found.answer.conical_height_low.size() > 0
                               ? py::object(to_numpy(found.answer.conical_height_low))
                               : py::object(py::none());
    return py::make_tuple(to_numpy(found.answer.conical_height), to_numpy(found.answer.error_bound), low, found.model,
                          std::string(to_string(found.status)));
}

py::tuple solved_best(const Chain& chain, Index first, Index count, double rtol, double inclination,
                      std::optional<double> time_budget) {
    return answered(aside(chain, nullptr, [=](const Chain& own) {
        const revchain::models::Question question{first, count, rtol, inclination};
        return revchain::models::solve(revchain::models::height_models, own, question, time_budget);
    }));
}

/// By the model of that name, which need not be the cheapest; the name is known.
py::tuple solved_by(const Chain& chain, Index first, Index count, double rtol, double inclination,
                    const std::string& model) {
    return answered(aside(chain, nullptr, [=](const Chain& own) {
        return revchain::models::solve_by(revchain::models::height_models, model, own,
                                          {first, count, rtol, inclination});
    }));
}

}  // namespace

void bind_models(py::module_& module) {
    py::list names;
    std::apply([&](const auto&... models) { (names.append(py::str(models.name.data(), models.name.size())), ...); },
               revchain::models::height_models);
    module.attr("MODELS") = py::tuple(names);
    module.def("select", &selected, "chain"_a, "first"_a, "count"_a, "rtol"_a, "inclination"_a, "time_budget"_a);
    module.def("solve", &solved_best, "chain"_a, "first"_a, "count"_a, "rtol"_a, "inclination"_a, "time_budget"_a);
    module.def("solve_by", &solved_by, "chain"_a, "first"_a, "count"_a, "rtol"_a, "inclination"_a, "model"_a);
}
