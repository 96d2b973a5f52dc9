// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <chrono>
#include <functional>
#include <future>
#include <optional>

#include "bindings.hpp"
#include "revchain/linear/count.hpp"
#include "revchain/linear/modes.hpp"
#include "revchain/linear/reference.hpp"

namespace {

using revchain::Index;
using Chain = revchain::Chain<double>;
using Modes = revchain::Modes<double>;
using Options = revchain::ModesOptions<double>;

using Method = std::pair<std::string_view, Modes (*)(const Chain&, const Options&)>;
constexpr std::array<Method, 4> methods{{{"auto", &revchain::modes<double>},
                                         {"bisection", &revchain::modes<double>},
                                         {"dense", &revchain::modes_dense<double>},
                                         {"recurrence", &revchain::modes_recurrence<double>}}};

auto find_method(const std::string& method) {
    for (const auto& [name, solve] : methods)
        if (name == method) return solve;
    std::string known;
    for (const auto& [name, solve] : methods) known += (known.empty() ? "" : ", ") + std::string(name);
    revchain::detail::refuse("modes", "method must be one of " + known, method);
}

/// Runs with the GIL released. What may take more than a moment runs in a thread of its own while this one looks for
/// Ctrl-C: Python notes the signal, but hears it only when asked.
Modes modes(const Chain& chain, std::optional<Index> count, std::optional<double> rtol, const std::string& method,
            bool shapes, revchain::Progress* progress) {
    const auto solve = find_method(method);
    constexpr double a_moment = 2e5;  // links times modes: about 0.1 s
    const double work = static_cast<double>(chain.size()) * static_cast<double>(count.value_or(chain.mode_count()));
    if (work < a_moment) return solve(chain, {count, rtol, shapes, progress});

    revchain::Progress own;
    revchain::Progress* watched = progress != nullptr ? progress : &own;
    auto result = std::async(std::launch::async, [&] { return solve(chain, {count, rtol, shapes, watched}); });
    while (result.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
        const py::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() == 0) continue;
        watched->cancel();
        {
            const py::gil_scoped_release release;
            result.wait();
        }
        throw py::error_already_set();
    }
    return result.get();
}

/// One count for each place of an array shaped like `like`, the GIL released.
py::array_t<std::int64_t> counts(const Chain& chain, const Array& like,
                                 const std::function<Index(const revchain::ModeCounter<double>&, py::ssize_t)>& count) {
    py::array_t<std::int64_t> result(std::vector<py::ssize_t>(like.shape(), like.shape() + like.ndim()));
    std::int64_t* out = result.mutable_data();
    const py::ssize_t size = like.size();
    const py::gil_scoped_release release;
    const revchain::ModeCounter<double> counter(chain);
    for (py::ssize_t i = 0; i < size; ++i) out[i] = count(counter, i);
    return result;
}

}  // namespace

void bind_linear(py::module_& module) {
    py::tuple names(methods.size());
    for (std::size_t i = 0; i < methods.size(); ++i) names[i] = py::str(std::string(methods[i].first));
    module.attr("METHODS") = names;

    py::class_<Modes>(module, "Modes")
        .def_property_readonly("conical_height", [](const Modes& m) { return to_numpy(m.conical_height); })
        .def_property_readonly("error_bound", [](const Modes& m) { return to_numpy(m.error_bound); })
        .def_property_readonly("shape",
                               [](const Modes& m) -> std::optional<py::array> {
                                   if (m.shape.size() == 0) return std::nullopt;
                                   return to_numpy(m.shape);
                               })
        .def_property_readonly("residual",
                               [](const Modes& m) -> std::optional<py::array> {
                                   if (m.residual.size() == 0) return std::nullopt;
                                   return to_numpy(m.residual);
                               })
        .def_property_readonly("nodes",
                               [](const Modes& m) -> std::optional<py::list> {
                                   if (m.residual.size() == 0) return std::nullopt;
                                   py::list lists;
                                   for (const auto& nodes : m.nodes) lists.append(to_numpy(nodes));
                                   return lists;
                               })
        .def_property_readonly("method", [](const Modes& m) { return m.method; })
        .def_property_readonly("status", [](const Modes& m) { return std::string(to_string(m.status)); });

    module.def("modes", &modes, "chain"_a, "count"_a = py::none(), "rtol"_a = py::none(), "method"_a = "auto",
               "shapes"_a = true, "progress"_a = py::none(), py::call_guard<py::gil_scoped_release>());

    module.def(
        "count_modes",
        [](const Chain& chain, const Array& height) {
            const double* h = height.data();
            return counts(chain, height,
                          [h](const auto& counter, py::ssize_t i) { return counter.above_height(h[i]); });
        },
        "chain"_a, "conical_height"_a);
    module.def(
        "count_modes_at_speed",
        [](const Chain& chain, const Array& speed, const Array& gravity) {
            const double *n = speed.data(), *g = gravity.data();
            if (speed.size() != gravity.size())
                revchain::detail::refuse("count_modes", "angular_speed and gravity must have one shape");
            return counts(chain, speed,
                          [n, g](const auto& counter, py::ssize_t i) { return counter.below_speed(n[i], g[i]); });
        },
        "chain"_a, "angular_speed"_a, "gravity"_a);
    module.def(
        "recurrence_matrices",
        [](const Chain& chain) {
            const auto pencil = revchain::recurrence_matrices(chain);
            return py::make_tuple(to_numpy(pencil.A), to_numpy(pencil.B));
        },
        "chain"_a);
}
