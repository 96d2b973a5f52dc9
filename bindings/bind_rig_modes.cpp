// SPDX-License-Identifier: GPL-3.0-or-later
#include <complex>
#include <optional>

#include "bindings.hpp"
#include "revchain/rig_modes.hpp"

namespace {

using revchain::Index;
using revchain::Rig;
using revchain::RigModes;

py::tuple sense(const revchain::WhirlModes& modes, bool shapes) {
    py::array_t<std::int64_t> number(modes.size());
    for (Index j = 0; j < modes.size(); ++j) number.mutable_data()[j] = modes.first + j;
    py::object shape = py::none(), residual = py::none();
    if (shapes) shape = to_numpy(modes.shapes().offset), residual = to_numpy(modes.shapes().residual);
    return py::make_tuple(frozen(number), modes.available, to_numpy(modes.conical_height), to_numpy(modes.error_bound),
                          to_numpy(modes.angular_speed), to_numpy(modes.speed_error_bound), shape, residual);
}

/// One number of each of a list's items, as an array.
template <class Value, class Items, class Number>
py::array column(const Items& items, const Number& number) {
    py::array_t<Value> array(static_cast<py::ssize_t>(items.size()));
    for (std::size_t i = 0; i < items.size(); ++i) array.mutable_data()[i] = number(items[i]);
    return frozen(array);
}

py::tuple modes_of_rig(const Rig& rig, Index first, std::optional<Index> count, double gravity, bool shapes,
                       revchain::Progress* progress) {
    const RigModes m = without_lock([&] {
        const RigModes found = revchain::modes(
            rig,
            {.first = first, .count = count.value_or(revchain::all_modes), .gravity = gravity, .progress = progress});
        if (shapes) found.forward.shapes(progress), found.backward.shapes(progress);
        return found;
    });
    using Other = revchain::OtherMode;
    using Slack = revchain::SlackLink;
    const py::tuple other =
        py::make_tuple(column<std::complex<double>>(m.other, [](const Other& x) { return x.conical_height; }),
                       column<std::complex<double>>(m.other, [](const Other& x) { return x.angular_speed; }),
                       column<double>(m.other, [](const Other& x) { return x.growth_rate; }),
                       column<double>(m.other, [](const Other& x) { return x.error_bound; }));
    return py::make_tuple(m.has_momentum, sense(m.forward, shapes), sense(m.backward, shapes), other,
                          column<std::int64_t>(m.slack, [](const Slack& x) { return x.link; }),
                          column<double>(m.slack, [](const Slack& x) { return x.angular_speed; }), m.complete, m.method,
                          std::string(revchain::to_string(m.status)));
}

}  // namespace

void bind_rig_modes(py::module_& module) {
    module.def("rig_modes", &modes_of_rig, "rig"_a, "first"_a, "count"_a, "gravity"_a, "shapes"_a,
               "progress"_a = nullptr);
}
