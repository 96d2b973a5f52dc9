// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>

#include "bindings.hpp"
#include "forces.hpp"
#include "revchain/gyrostatic_string.hpp"
#include "revchain/rig.hpp"

namespace {

using revchain::Chain;
using revchain::Displaced;
using revchain::Flywheel;
using revchain::Index;
using revchain::Posture;
using revchain::Rig;
using Flags = py::array_t<bool, py::array::c_style | py::array::forcecast>;

/// Number m of an array with one for each link, or for all; `otherwise` where none was given.
double at(const std::optional<Array>& array, Index m, double otherwise) {
    if (!array) return otherwise;
    return array->data()[array->ndim() == 0 ? 0 : m];
}

/// `force` is the unit of stiffness and momentum over that of the weights. Wheels are given by their momentum and axial
/// moment, or by weight, radius of gyration, spin in rad/s and whether a motor turns them, which takes gravity.
Rig make_rig(const Chain<double>& chain, double stiffness, double carriage_weight, double support_radius,
             const std::optional<Flags>& standing, const std::optional<Array>& momentum,
             const std::optional<Array>& axial_moment, const std::optional<Array>& wheel_weight,
             const std::optional<Array>& wheel_radius_of_gyration, const std::optional<Array>& spin,
             const std::optional<Array>& driven, const std::optional<Array>& displaced_weight,
             const std::optional<Array>& displaced_centroid, const std::optional<Array>& displaced_radius_of_gyration,
             const std::optional<Array>& added_weight, bool turning_fluid, double force, double gravity,
             double support_damping, const std::optional<Array>& pin_stiffness, const std::optional<Array>& pin_damping,
             const std::optional<Array>& drag) {
    for (const auto* array :
         {&momentum, &axial_moment, &wheel_weight, &wheel_radius_of_gyration, &spin, &driven, &displaced_weight,
          &displaced_centroid, &displaced_radius_of_gyration, &added_weight, &pin_stiffness, &pin_damping, &drag})
        if (*array && (*array)->ndim() > 0 && (*array)->size() != chain.size())
            revchain::detail::throw_invalid("Rig", "arrays must have one number for each link", (*array)->size());
    if (standing && standing->size() != chain.size())
        revchain::detail::throw_invalid("Rig", "standing must have one entry for each link", standing->size());
    revchain::Rigging with{.support = support({stiffness, force, carriage_weight, support_radius})};
    with.support.damping = quotient(support_damping, force);
    with.fluid = turning_fluid ? revchain::Fluid::turning : revchain::Fluid::still;
    const bool floats = displaced_weight || displaced_centroid || displaced_radius_of_gyration || added_weight;
    for (Index m = 0; m < chain.size(); ++m) {
        if (standing) with.posture.push_back(standing->data()[m] ? Posture::stands : Posture::hangs);
        if (momentum || axial_moment)
            with.flywheels.push_back({quotient(at(momentum, m, 0), force), at(axial_moment, m, 0)});
        if (wheel_weight)
            with.flywheels.push_back(wheel(at(wheel_weight, m, 0), at(wheel_radius_of_gyration, m, 0), at(spin, m, 0),
                                           at(driven, m, 0) != 0, gravity));
        if (pin_stiffness || pin_damping)
            with.pins.push_back({quotient(at(pin_stiffness, m, 0), force), quotient(at(pin_damping, m, 0), force)});
        if (drag) with.drag.push_back(quotient(at(drag, m, 0), force));
        if (!floats) continue;
        const revchain::Link<double> link = chain.link(m);
        Displaced fluid = displaced_by(link, at(displaced_weight, m, 0), at(added_weight, m, 0));
        fluid.centroid = at(displaced_centroid, m, link.centroid);
        if (displaced_radius_of_gyration)
            fluid.gyration_ratio = revchain::detail::gyration_from_radius<double>(
                "Rig: links[" + std::to_string(m) + "]", link.length, at(displaced_radius_of_gyration, m, 0));
        with.displaced.push_back(fluid);
    }
    without_idle(with.flywheels);
    return Rig(chain, std::move(with));
}

/// A number of the flywheel of each link.
template <revchain::Wide<double> Flywheel::*number>
py::array of_wheels(const Rig& rig) {
    revchain::Vector<double> numbers(rig.size());
    for (Index m = 0; m < rig.size(); ++m) numbers[m] = (rig.flywheel(m).*number).high;
    return to_numpy(numbers);
}

using String = revchain::GyrostaticString<double>;

/// A function of a string and a number, for arrays of numbers: `count` arrays of their shape.
template <std::size_t count, class Function>
auto of_string(const Function& function) {
    return [function](const Array& at, double weight, double length, double tension, double momentum, double centroid,
                      double radius_of_gyration, double gravity) {
        const String string{weight, length, tension, momentum, centroid, radius_of_gyration, gravity};
        return columns<count>([&](double x) { return function(string, x); }, at);
    };
}

}  // namespace

void bind_rig(py::module_& module) {
    py::class_<Rig>(module, "Rig", "A chain with a support, flywheels, a fluid or inverted links; immutable.")
        .def(py::init(&make_rig), "chain"_a, "stiffness"_a, "carriage_weight"_a, "support_radius"_a,
             "standing"_a = py::none(), "momentum"_a = py::none(), "axial_moment"_a = py::none(),
             "wheel_weight"_a = py::none(), "wheel_radius_of_gyration"_a = py::none(), "spin"_a = py::none(),
             "driven"_a = py::none(), "displaced_weight"_a = py::none(), "displaced_centroid"_a = py::none(),
             "displaced_radius_of_gyration"_a = py::none(), "added_weight"_a = py::none(), "turning_fluid"_a = false,
             "force"_a = 1.0, "gravity"_a = revchain::conical_pendulum::standard_gravity, "support_damping"_a = 0.0,
             "pin_stiffness"_a = py::none(), "pin_damping"_a = py::none(), "drag"_a = py::none())
        .def_property_readonly("momentum", &of_wheels<&Flywheel::momentum>)
        .def_property_readonly("axial_moment", &of_wheels<&Flywheel::axial_moment>)
        .def(
            "__eq__", [](const Rig& x, const Rig& y) { return x == y; }, py::is_operator());

    const auto def = [&](const char* name, const auto& function) {
        module.def(name, function, "at"_a, "weight"_a, "length"_a, "tension"_a, "momentum"_a, "centroid"_a,
                   "radius_of_gyration"_a, "gravity"_a);
    };
    def("gyrostatic_string_phase", of_string<2>([](const String& string, double speed) {
            const auto found = link_phase(string, speed);
            return std::array<double, 2>{found.phase, found.attenuation};
        }));
    def("gyrostatic_string_speeds",
        of_string<2>([](const String& string, double phase) { return wave_speeds(string, phase); }));
    def("gyrostatic_string_rotation", of_string<1>([](const String& string, double speed) {
            return std::array<double, 1>{plane_rotation(string, speed)};
        }));
}
