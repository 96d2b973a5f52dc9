// SPDX-License-Identifier: GPL-3.0-or-later
// Forced motion, swings and motion in time.
#include <algorithm>
#include <array>
#include <complex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/forced_motion.hpp"
#include "revchain/response.hpp"
#include "revchain/swing.hpp"
#include "revchain/transient.hpp"

namespace {

using revchain::Chain;
using revchain::Index;
using revchain::Rig;
using Numbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

std::vector<double> as_vector(const Array& array) { return {array.data(), array.data() + array.size()}; }

py::array flags(const std::vector<char>& values) {
    py::array_t<bool> array(static_cast<py::ssize_t>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) array.mutable_data()[i] = values[i] != 0;
    return frozen(std::move(array));
}

py::array whole(const revchain::Vector<Index>& values) {
    py::array_t<std::int64_t> array(values.size());
    for (Index i = 0; i < values.size(); ++i) array.mutable_data()[i] = values[i];
    return frozen(std::move(array));
}

template <class Carried>
py::tuple response(const Carried& carried, const Array& given, bool speeds, double support_radius,
                   const std::optional<Numbers>& pins, double gravity, Index threads) {
    revchain::ResponseOptions options{.support_radius = support_radius, .gravity = gravity, .threads = threads};
    (speeds ? options.angular_speed : options.conical_height) = as_vector(given);
    if (pins) options.pins = std::vector<Index>(pins->data(), pins->data() + pins->size());
    const auto found = without_lock([&] { return revchain::response(carried, options); });
    return py::make_tuple(to_numpy(found.offset), to_numpy(found.error_bound), whole(found.modes_below),
                          flags(found.reversed), flags(found.resonant), to_numpy(found.support_force),
                          to_numpy(found.support_force_error));
}

template <class Number>
revchain::Vector<Number> column(const py::array_t<Number, py::array::c_style | py::array::forcecast>& array) {
    return Eigen::Map<const revchain::Vector<Number>>(array.data(), array.size());
}

template <class System>
py::tuple swing(const System& system, const Array& offsets, const Array& velocities, const Array& time,
                std::optional<Index> modes, double gravity) {
    const revchain::SwingOptions options{.offset = column(offsets),
                                         .velocity = column(velocities),
                                         .time = as_vector(time),
                                         .count = modes,
                                         .gravity = gravity};
    const auto found = without_lock([&] { return revchain::swing(system, options); });
    return py::make_tuple(to_numpy(found.offset), to_numpy(found.velocity), to_numpy(found.angular_frequency),
                          to_numpy(found.energy), to_numpy(found.shape), to_numpy(found.cosine), to_numpy(found.sine),
                          to_numpy(found.start), found.projected, found.energy_left_out,
                          to_numpy(found.truncation_error), to_numpy(found.error_bound));
}

using ComplexArray = py::array_t<std::complex<double>, py::array::c_style | py::array::forcecast>;

py::tuple whirl_swing(const Rig& rig, const ComplexArray& offsets, const ComplexArray& velocities, const Array& time,
                      std::optional<Index> whirls, double gravity) {
    const revchain::WhirlSwingOptions options{.offset = column(offsets),
                                              .velocity = column(velocities),
                                              .time = as_vector(time),
                                              .count = whirls,
                                              .gravity = gravity};
    const auto found = without_lock([&] { return revchain::whirl_swing(rig, options); });
    const std::vector<py::ssize_t> shape{found.offset.rows(), found.offset.cols()};
    return py::make_tuple(complex_numbers(found.offset, shape), complex_numbers(found.velocity, shape),
                          to_numpy(found.angular_speed), complex_numbers(found.amplitude, {found.amplitude.size()}),
                          to_numpy(found.energy), to_numpy(found.shape), found.energy_left_out,
                          to_numpy(found.truncation_error), to_numpy(found.error_bound));
}

py::tuple forced_motion(const Rig& rig, const Array& speeds, double radius, double acceleration, double force,
                        double gravity, Index threads) {
    const revchain::ForcedMotionOptions options{.angular_speed = as_vector(speeds),
                                                .radius = radius,
                                                .acceleration = acceleration,
                                                .force = force,
                                                .gravity = gravity,
                                                .threads = threads};
    const auto found = without_lock([&] { return revchain::forced_motion(rig, options); });
    return py::make_tuple(complex_numbers(found.offset, {found.offset.rows(), found.offset.cols()}),
                          to_numpy(found.error_estimate), whole(found.modes_below), flags(found.resonant),
                          complex_numbers(found.support_force, {found.support_force.size()}));
}

py::tuple transient(const Rig& rig, const std::optional<ComplexArray>& offsets,
                    const std::optional<ComplexArray>& velocities, const Array& time, const std::string& given,
                    const Array& motion_time, const Array& motion, bool rests, double gravity) {
    using Given = revchain::SupportMotion::Given;
    const std::pair<const char*, Given> kinds[] = {{"acceleration", Given::acceleration},
                                                   {"velocity", Given::velocity},
                                                   {"offset", Given::offset},
                                                   {"force", Given::force}};
    revchain::TransientOptions options{
        .time = as_vector(time),
        .motion = {.time = as_vector(motion_time), .value = as_vector(motion), .rests = rests},
        .gravity = gravity};
    for (const auto& [name, kind] : kinds)
        if (given == name) options.motion.given = kind;
    if (offsets) options.offset = column(*offsets);
    if (velocities) options.velocity = column(*velocities);
    const auto found =
        aside(rig.chain(), nullptr, [rig, options](const Chain<double>&) { return revchain::transient(rig, options); });
    const std::vector<py::ssize_t> shape{found.offset.rows(), found.offset.cols()};
    return py::make_tuple(complex_numbers(found.offset, shape), complex_numbers(found.velocity, shape),
                          to_numpy(found.error_estimate), found.end, to_numpy(found.sway),
                          complex_numbers(found.exponent, {found.exponent.size()}),
                          complex_numbers(found.shape, {found.shape.rows(), found.shape.cols()}),
                          complex_numbers(found.amplitude, {found.amplitude.size()}),
                          complex_numbers(found.start, {found.start.size()}), found.projected);
}

}  // namespace

void bind_response(py::module_& module) {
    module.def("response", &response<Chain<double>>, "chain"_a, "given"_a, "speeds"_a, "support_radius"_a, "pins"_a,
               "gravity"_a, "threads"_a = 1);
    module.def("rig_response", &response<Rig>, "rig"_a, "given"_a, "speeds"_a, "support_radius"_a, "pins"_a,
               "gravity"_a, "threads"_a = 1);
    module.def("swing", &swing<Chain<double>>, "chain"_a, "offsets"_a, "velocities"_a, "time"_a, "modes"_a,
               "gravity"_a);
    module.def("rig_swing", &swing<Rig>, "rig"_a, "offsets"_a, "velocities"_a, "time"_a, "modes"_a, "gravity"_a);
    module.def("whirl_swing", &whirl_swing, "rig"_a, "offsets"_a, "velocities"_a, "time"_a, "whirls"_a, "gravity"_a);
    module.def("forced_motion", &forced_motion, "rig"_a, "speeds"_a, "radius"_a, "acceleration"_a, "force"_a,
               "gravity"_a, "threads"_a = 1);
    module.def("transient", &transient, "rig"_a, "offsets"_a, "velocities"_a, "time"_a, "given"_a, "motion_time"_a,
               "motion"_a, "rests"_a, "gravity"_a);
}
