// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "revchain/finite/cord/continuous_chain.hpp"

#include <pybind11/functional.h>

namespace {

using revchain::CordShape;
using revchain::CordShapes;
using revchain::LineDensity;

/// A density given is in the unit of the weights; else the cord weighs 1 for each unit of length.
revchain::Cord cord_of(double length, double tip_weight, std::shared_ptr<const LineDensity> density) {
    if (density) return revchain::Cord(length, {.density = std::move(density), .tip_weight = tip_weight});
    return revchain::Cord(length, {.weight = length, .tip_weight = tip_weight});
}

}  // namespace

void bind_continuous(py::module_& module) {
    const auto column = [](revchain::Vector<double> CordShape::*member) {
        return [member](const CordShape& shape) { return to_numpy(shape.*member); };
    };
    py::class_<LineDensity, std::shared_ptr<LineDensity>>(module, "LineDensity", "Weight per length, as polynomials.")
        .def(py::init<const std::function<double(double)>&, double>(), "weight_per_length"_a, "length"_a)
        .def("weight_below", &LineDensity::weight_below, "s"_a);
    py::class_<CordShape>(module, "ContinuousShape", "A steady shape of a whirling chain without links.")
        .def_property_readonly("arc_length", column(&CordShape::arc_length))
        .def_property_readonly("offset", column(&CordShape::offset))
        .def_property_readonly("height", column(&CordShape::height))
        .def_property_readonly("inclination", column(&CordShape::inclination))
        .def_property_readonly("tension", column(&CordShape::tension))
        .def_readonly("half_waves", &CordShape::half_waves)
        .def_readonly("length", &CordShape::length)
        .def_readonly("conical_height", &CordShape::conical_height)
        .def_readonly("residual", &CordShape::residual)
        .def_readonly("error_bound", &CordShape::error_bound)
        .def_readonly("condition", &CordShape::condition)
        .def(
            "at",
            [](const CordShape& shape, const Array& arc) {
                return columns<4>(
                    [&](double s) {
                        const revchain::CordPlace place = shape(s);
                        return std::array{place.offset, place.height, place.inclination, place.tension};
                    },
                    arc);
            },
            "arc"_a);
    py::class_<CordShapes>(module, "ContinuousShapes", "The steady shapes of a chain without links.")
        .def_readonly("shapes", &CordShapes::shapes)
        .def_readonly("complete", &CordShapes::complete);
    module.def(
        "continuous_shapes",
        [](double length, double tip_weight, std::shared_ptr<LineDensity> density, double height, int scanned) {
            const py::gil_scoped_release release;
            return revchain::steady_shapes(cord_of(length, tip_weight, std::move(density)),
                                           {.conical_height = height, .scanned = scanned});
        },
        "length"_a, "tip_weight"_a, "density"_a.none(true), "height"_a, "scanned"_a);
    module.def(
        "continuous_critical_heights",
        [](double length, double tip_weight, std::shared_ptr<LineDensity> density, revchain::Index count) {
            revchain::Vector<double> heights;
            {
                const py::gil_scoped_release release;
                const revchain::finite::ContinuousChain chain(cord_of(length, tip_weight, std::move(density)));
                heights = revchain::finite::critical_heights(chain, count);
            }
            return to_numpy(heights);
        },
        "length"_a, "tip_weight"_a, "density"_a.none(true), "count"_a);
}
