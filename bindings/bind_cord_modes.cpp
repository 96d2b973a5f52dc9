// SPDX-License-Identifier: GPL-3.0-or-later
// Modes, counts and swings of cords.
#include <optional>

#include "bindings.hpp"
#include "forces.hpp"
#include "revchain/cord.hpp"

#include <pybind11/functional.h>

namespace {

using revchain::Cord;
using revchain::CordModes;
using revchain::Index;
using revchain::Vector;
using HeldCord = revchain::Held<Cord>;
using Pair = std::pair<double, double>;
using CordFunction = std::function<double(double)>;

template <class System>
CordModes modes(const System& cord, Index first, std::optional<Index> count, std::optional<Pair> conical_height,
                std::optional<std::tuple<double, double, double>> angular_speed, std::optional<double> rtol,
                MaybeProgress progress, double gravity) {
    const py::gil_scoped_release release;
    revchain::CordModesOptions options{.first = first, .count = count, .gravity = gravity};
    if (conical_height) options.conical_height = {conical_height->first, conical_height->second};
    if (angular_speed) {
        options.angular_speed = {std::get<0>(*angular_speed), std::get<1>(*angular_speed)};
        options.gravity = std::get<2>(*angular_speed);
    }
    options.rtol = rtol;
    options.progress = progress.value_or(nullptr);
    return revchain::modes(cord, options);
}

/// Modes whose heights are known, slowest first.
CordModes of_heights(const Cord& cord, Index first, const Array& height) {
    return {
        .cord = cord, .first = first, .conical_height = Eigen::Map<const Vector<double>>(height.data(), height.size())};
}

/// Offsets or slopes of every mode at places, shape (k, places).
template <Vector<double> (CordModes::*value)(Index, const Vector<double>&) const>
py::array along(const CordModes& found, const Array& arc) {
    const auto at = Eigen::Map<const Vector<double>>(arc.data(), arc.size());
    revchain::Table<double> table(found.size(), arc.size());
    {
        const py::gil_scoped_release release;
        for (Index j = 0; j < found.size(); ++j) {
            revchain::detail::check_interrupt();
            table.row(j) = (found.*value)(j, Vector<double>(at)).transpose();
        }
    }
    return to_numpy(table);
}

/// Places of every mode, a tuple of arrays.
template <Vector<double> (CordModes::*places)(Index) const>
py::tuple of_modes(const CordModes& found) {
    py::tuple lists(static_cast<std::size_t>(found.size()));
    for (Index j = 0; j < found.size(); ++j)
        lists[static_cast<std::size_t>(j)] = to_numpy(without_lock([&] { return (found.*places)(j); }));
    return lists;
}

revchain::CordStart start_of(const py::object& given) {
    if (given.is_none()) return {};
    if (PyCallable_Check(given.ptr()) != 0) return given.cast<CordFunction>();
    const auto array = given.cast<Array>();
    return revchain::Vector<double>(Eigen::Map<const revchain::Vector<double>>(array.data(), array.size()));
}

py::tuple swing(const Cord& cord, const py::object& offset, const py::object& velocity, const Array& time,
                const Array& arc, Index count, double gravity) {
    const revchain::CordSwingOptions options{
        .offset = start_of(offset),
        .velocity = start_of(velocity),
        .time = {time.data(), time.data() + time.size()},
        .arc_length = Eigen::Map<const revchain::Vector<double>>(arc.data(), arc.size()),
        .count = count,
        .gravity = gravity};
    const auto found = without_lock([&] { return revchain::swing(cord, options); });
    return py::make_tuple(to_numpy(found.offset), to_numpy(found.velocity), to_numpy(found.angular_frequency),
                          to_numpy(found.energy), to_numpy(found.shape), to_numpy(found.cosine), to_numpy(found.sine),
                          found.energy_left_out, to_numpy(found.error_estimate));
}

}  // namespace

void bind_cord_modes(py::module_& module) {
    py::class_<CordModes>(module, "CordModes", "Modes of a cord.")
        .def(py::init(&of_heights), "cord"_a, "first"_a, "conical_height"_a)
        .def(py::init([](const HeldCord& held, Index first, const Array& height) {
                 CordModes modes = of_heights(held.system(), first, height);
                 modes.held = held.by();
                 return modes;
             }),
             "held"_a, "first"_a, "conical_height"_a)
        .def_readonly("first", &CordModes::first)
        .def_property_readonly("conical_height", [](const CordModes& m) { return to_numpy(m.conical_height); })
        .def_property_readonly("error_bound", [](const CordModes& m) { return to_numpy(m.error_bound); })
        .def_readonly("method", &CordModes::method)
        .def_property_readonly("status", [](const CordModes& m) { return std::string(to_string(m.status)); })
        .def("offset", &along<&CordModes::offset>, "arc_length"_a)
        .def("slope", &along<&CordModes::slope>, "arc_length"_a)
        .def_property_readonly("bob_slope",
                               [](const CordModes& m) {
                                   Vector<double> slope(m.size());
                                   for (Index j = 0; j < m.size(); ++j) slope[j] = m.bob_slope(j);
                                   return to_numpy(slope);
                               })
        .def_property_readonly("nodes", &of_modes<&CordModes::nodes>)
        .def_property_readonly("vertical_points", &of_modes<&CordModes::vertical_points>);
    module.def("cord_modes", &modes<Cord>, "cord"_a, "first"_a, "count"_a, "conical_height"_a, "angular_speed"_a,
               "rtol"_a, "progress"_a = py::none(), "gravity"_a = revchain::conical_pendulum::standard_gravity);
    module.def("held_modes", &modes<HeldCord>, "held"_a, "first"_a, "count"_a, "conical_height"_a, "angular_speed"_a,
               "rtol"_a, "progress"_a, "gravity"_a);
    module.def(
        "cord_sensitivity",
        [](const CordModes& found) {
            const auto s = without_lock([&] { return revchain::sensitivity(found); });
            return py::make_tuple(to_numpy(s.length), to_numpy(s.weight), to_numpy(s.tip_weight), to_numpy(s.exponent),
                                  to_numpy(s.tension), to_numpy(s.weights));
        },
        "modes"_a);
    module.def("count_cord_modes", &counts_above<Cord>, "cord"_a, "conical_height"_a,
               "gravity"_a = revchain::conical_pendulum::standard_gravity);
    module.def("count_held_modes", &counts_above<HeldCord>, "held"_a, "conical_height"_a, "gravity"_a);
    module.def("cord_swing", &swing, "cord"_a, "offset"_a, "velocity"_a, "time"_a, "arc_length"_a, "count"_a,
               "gravity"_a);
}
