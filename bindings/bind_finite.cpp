// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/campbell.hpp"
#include "revchain/stability.hpp"
#include "revchain/steady_shapes.hpp"
#include "shapes.hpp"

#include <pybind11/complex.h>

namespace {

using Chain = revchain::Chain<double>;
using revchain::Rig;
using revchain::SteadyShape;

/// `campbell(system, speeds, orders, half_waves, driven, gravity)`: frequencies, stable, and crossings as tuples.
template <class System>
void def_campbell(py::module_& module) {
    module.def(
        "campbell",
        [](const System& system, const std::vector<double>& speeds, const std::vector<revchain::Index>& orders,
           revchain::Index half_waves, bool driven, double gravity) {
            const revchain::CampbellOptions options{speeds, orders, half_waves, frame(driven), gravity};
            const auto found = [&] {
                if constexpr (std::is_same_v<System, Rig>)
                    return aside(system.chain(), nullptr,
                                 [=](const Chain&) { return revchain::campbell(system, options); });
                else
                    return aside(system, nullptr, [=](const Chain& own) { return revchain::campbell(own, options); });
            }();
            py::list crossings;
            for (const auto& one : found.crossings)
                crossings.append(py::make_tuple(one.order, one.motion, one.angular_speed));
            return py::make_tuple(to_numpy(found.frequency), found.stable, std::move(crossings));
        },
        "system"_a, "angular_speed"_a, "orders"_a, "half_waves"_a, "driven"_a, "gravity"_a);
}

}  // namespace

void bind_finite(py::module_& module) {
    auto shape = bind_shape<SteadyShape>(module, "SteadyShape", "A steady shape of a chain or rig.");
    def_column(shape, "tension", &SteadyShape::tension);
    def_column(shape, "reaction_inclination", &SteadyShape::reaction_inclination);
    shape.def_readwrite("moment_of_inertia", &SteadyShape::moment_of_inertia)
        .def_readwrite("effective_energy", &SteadyShape::effective_energy);
    module.def(
        "blank_shape", [](const Chain&) { return SteadyShape{}; }, "system"_a);
    module.def(
        "blank_shape", [](const Rig&) { return SteadyShape{}; }, "system"_a);
    bind_shapes<revchain::SteadyShapes>(module, "SteadyShapes");
    using revchain::Stability;
    const auto each = []<class T>(std::vector<T> Stability::*member) {
        return [member](const Stability& s) {
            const auto& of = s.*member;
            return frozen(py::array_t<T>(static_cast<py::ssize_t>(of.size()), of.data()));
        };
    };
    py::class_<Stability>(module, "Stability", "Linear stability of a steady shape.")
        .def_property_readonly("verdict", [](const Stability& s) { return std::string(to_string(s.verdict)); })
        .def_property_readonly("exponents", each(&Stability::exponents))
        .def_property_readonly("exponent_error", each(&Stability::exponent_error))
        .def_property_readonly("internal_damping", each(&Stability::internal_damping))
        .def_property_readonly("external_damping", each(&Stability::external_damping))
        .def_readonly("growth_rate", &Stability::growth_rate)
        .def_readonly("margin", &Stability::margin)
        .def_readonly("negative_directions", &Stability::negative_directions);
    def_stability<Chain, SteadyShape>(
        module, [](const Chain& chain, const SteadyShape& of, revchain::StabilityFrame in, int, double) {
            return aside(chain, nullptr, [=](const Chain& own) { return revchain::stability(own, of, in); });
        });
    def_stability<Rig, SteadyShape>(module, [](const Rig& rig, const SteadyShape& of, revchain::StabilityFrame in,
                                               int direction, double gravity) {
        const revchain::RigStabilityOptions options{.frame = in, .direction = rotation(direction), .gravity = gravity};
        return aside(rig.chain(), nullptr, [=](const Chain&) { return revchain::stability(rig, of, options); });
    });
    def_campbell<Chain>(module), def_campbell<Rig>(module);
    def_steady_shapes<Chain>(module, [](const Chain& chain, const AtSpeed& at) {
        return revchain::steady_shapes(chain, {.conical_height = at.conical_height,
                                               .angular_speed = at.angular_speed,
                                               .budget = at.budget,
                                               .hanging_only = at.hanging_only,
                                               .gravity = at.gravity,
                                               .threads = at.threads});
    });
    def_steady_shapes<Rig>(module, [](const Rig& rig, const AtSpeed& at) {
        std::optional<double> speed = at.angular_speed;
        if (speed) speed = at.direction * *speed;
        return revchain::steady_shapes(rig, {.conical_height = at.conical_height,
                                             .angular_speed = speed,
                                             .budget = at.budget,
                                             .hanging_only = at.hanging_only,
                                             .direction = rotation(at.direction),
                                             .gravity = at.gravity,
                                             .threads = at.threads});
    });
}
