// SPDX-License-Identifier: GPL-3.0-or-later
// Sensitivity, uncertainty, tuning, edited chains, and the bell.
#include <optional>

#include "bindings.hpp"
#include "revchain/bell.hpp"
#include "revchain/sensitivity.hpp"
#include "revchain/system/edit.hpp"
#include "revchain/tune.hpp"

namespace {

using revchain::Index;
using Chain = revchain::Chain<double>;

constexpr std::size_t data = revchain::datum_names.size();

template <std::size_t N>
py::tuple words(const std::array<std::string_view, N>& names) {
    py::tuple result(N);
    for (std::size_t i = 0; i < N; ++i) result[i] = py::str(std::string(names[i]));
    return result;
}

revchain::Vector<double> vector(const Array& array) {
    return Eigen::Map<const revchain::Vector<double>>(array.data(), array.size());
}

revchain::Table<double> table(const Array& array, const std::string& name) {
    if (array.ndim() != 2)
        revchain::detail::throw_invalid("uncertainty", name + " must have two dimensions", array.ndim());
    return Eigen::Map<const revchain::Table<double>>(array.data(), array.shape(0), array.shape(1));
}

/// Derivatives and their bounds, each by datum.
py::tuple sensitivity(const Chain& chain, Index first, const Array& heights) {
    revchain::Modes<double> modes;
    modes.first = first;
    modes.conical_height = vector(heights);
    const auto found = [&] {
        const py::gil_scoped_release release;
        return revchain::sensitivity(chain, modes);
    }();
    py::tuple value(data), bound(data);
    for (std::size_t d = 0; d < data; ++d)
        value[d] = to_numpy(found.by_datum[d].value), bound[d] = to_numpy(found.by_datum[d].error_bound);
    return py::make_tuple(value, bound);
}

py::tuple uncertainty(const Array& heights, const std::array<Array, data>& value,
                      const std::array<std::optional<Array>, data>& given) {
    revchain::Sensitivity<double> sensitivity;
    revchain::Deviations<double> deviations;
    for (std::size_t d = 0; d < data; ++d) {
        const std::string name(revchain::datum_names[d]);
        sensitivity.by_datum[d].value = table(value[d], name);
        if (!given[d]) continue;
        if (given[d]->ndim() == 2)
            deviations[d] = {{}, table(*given[d], name)};
        else
            deviations[d] = {vector(*given[d]), {}};
    }
    const auto found = revchain::uncertainty(sensitivity, vector(heights), deviations);
    py::tuple share(data);
    for (std::size_t d = 0; d < data; ++d) share[d] = to_numpy(found.share[d]);
    py::list datum, link;
    for (const auto each : found.datum)
        datum.append(std::string(revchain::datum_names[static_cast<std::size_t>(each)]));
    for (const Index each : found.link) link.append(each);
    return py::make_tuple(to_numpy(found.conical_height), to_numpy(found.relative), share, datum, link);
}

revchain::Datum datum_called(const std::string& name) {
    for (std::size_t d = 0; d < data; ++d)
        if (revchain::datum_names[d] == name) return static_cast<revchain::Datum>(d);
    revchain::detail::throw_invalid("tune", "quantity is none of those known", name);
}

py::tuple tune(const Chain& chain, Index mode, Index link, const std::string& quantity,
               std::optional<double> conical_height, std::optional<double> angular_speed, double gravity,
               std::optional<double> low, std::optional<double> high) {
    const revchain::TuneOptions options{.mode = mode,
                                        .link = link,
                                        .datum = datum_called(quantity),
                                        .conical_height = conical_height,
                                        .angular_speed = angular_speed,
                                        .gravity = gravity,
                                        .low = low,
                                        .high = high};
    const auto found = [&] {
        const py::gil_scoped_release release;
        return revchain::tune(chain, options);
    }();
    const auto values = Eigen::Map<const revchain::Vector<double>>(found.values.data(), Index(found.values.size()));
    return py::make_tuple(std::string(to_string(found.status)), found.present, found.value, found.error_bound,
                          to_numpy(revchain::Vector<double>(values)), found.complete, found.low, found.high,
                          found.lowest_height, found.highest_height, found.chain);
}

py::tuple bell_and_clapper(const Chain& chain, std::optional<double> joint, const std::array<bool, 2>& inverted) {
    const auto found = revchain::bell_and_clapper(chain, joint, inverted);
    return py::make_tuple(found.conical_height, found.inclination_ratio, found.silent_height, found.mismatch,
                          found.present, found.derivative);
}

py::tuple first_strike(const revchain::ByBellDatum<double>& present, const std::array<bool, 2>& inverted,
                       double clearance, std::optional<double> amplitude, std::optional<double> clapper_angle,
                       double gravity) {
    revchain::BellAndClapper<double> bell{};
    bell.present = present, bell.inverted = inverted;
    const auto found = revchain::first_strike(
        bell, {.clearance = clearance, .amplitude = amplitude, .clapper_angle = clapper_angle, .gravity = gravity});
    return py::make_tuple(std::string(revchain::strike_status_names[static_cast<std::size_t>(found.status)]),
                          found.leading, found.bell_angle, found.relative_speed, found.time, found.error_estimate);
}

py::tuple rig_sensitivity(const revchain::Rig& rig, double angular_speed, const Array& offset, double gravity) {
    const auto found = revchain::sensitivity(rig, angular_speed, vector(offset), gravity);
    return py::make_tuple(to_numpy(found.weight), to_numpy(found.length), to_numpy(found.centroid),
                          to_numpy(found.radius_of_gyration), to_numpy(found.length_in_proportion),
                          to_numpy(found.momentum), to_numpy(found.displaced_weight), to_numpy(found.added_weight),
                          found.stiffness, found.carriage_weight);
}

}  // namespace

void bind_sensitivity(py::module_& module) {
    module.attr("DATA") = words(revchain::datum_names);
    module.attr("BELL_DATA") = words(revchain::bell_datum_names);
    module.def("sensitivity", &sensitivity, "chain"_a, "first"_a, "conical_height"_a);
    module.def("uncertainty", &uncertainty, "conical_height"_a, "derivatives"_a, "deviations"_a);
    module.def("tune", &tune, "chain"_a, "mode"_a, "link"_a, "quantity"_a, "conical_height"_a, "angular_speed"_a,
               "gravity"_a, "low"_a, "high"_a);
    module.def("with_weight", &revchain::with_weight<double>, "chain"_a, "weight"_a, "pin"_a, "radius_of_gyration"_a);
    module.def("with_thread", &revchain::with_thread<double>, "chain"_a, "length"_a, "pin"_a);
    module.def("clamped", &revchain::clamped<double>, "chain"_a, "link"_a);
    module.def("bell_and_clapper", &bell_and_clapper, "chain"_a, "joint"_a, "inverted"_a);
    module.def("bell_and_clapper_with_ratio", &revchain::bell_and_clapper_with_ratio<double>, "chain"_a, "ratio"_a,
               "joint"_a, "inverted"_a);
    module.def("first_strike", &first_strike, "present"_a, "inverted"_a, "clearance"_a, "amplitude"_a,
               "clapper_angle"_a, "gravity"_a);
    module.def("rig_sensitivity", &rig_sensitivity, "rig"_a, "angular_speed"_a, "offset"_a, "gravity"_a);
    module.def("stiffness_for_speed", &revchain::stiffness_for_speed, "rig"_a, "angular_speed"_a, "gravity"_a);
    module.def("momentum_for_speed", &revchain::momentum_for_speed, "rig"_a, "link"_a, "angular_speed"_a, "gravity"_a);
}
