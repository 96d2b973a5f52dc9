// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "revchain/finite/cord/continuous_chain.hpp"

#include <pybind11/functional.h>

namespace {

using revchain::ContinuousChain;
using revchain::ContinuousShape;
using revchain::ContinuousShapes;
using revchain::LineDensity;

ContinuousChain chain_of(double length, double tip_weight, const LineDensity* density) {
    return {length, tip_weight, density};
}

}  // namespace

void bind_continuous(py::module_& module) {
    const auto column = [](revchain::Vector<double> ContinuousShape::*member) {
        return [member](const ContinuousShape& shape) { return to_numpy(shape.*member); };
    };
    py::class_<LineDensity>(module, "LineDensity", "Weight per length, as polynomials.")
        .def(py::init<const std::function<double(double)>&, double>(), "weight_per_length"_a, "length"_a)
        .def("weight_below", &LineDensity::weight_below, "s"_a);
    py::class_<ContinuousShape>(module, "ContinuousShape", "A steady shape of a whirling chain without links.")
        .def_property_readonly("arc_length", column(&ContinuousShape::arc_length))
        .def_property_readonly("offset", column(&ContinuousShape::offset))
        .def_property_readonly("height", column(&ContinuousShape::height))
        .def_property_readonly("inclination", column(&ContinuousShape::inclination))
        .def_property_readonly("tension", column(&ContinuousShape::tension))
        .def_readonly("half_waves", &ContinuousShape::half_waves)
        .def_readonly("length", &ContinuousShape::length)
        .def_readonly("conical_height", &ContinuousShape::conical_height)
        .def_readonly("residual", &ContinuousShape::residual)
        .def_readonly("error_bound", &ContinuousShape::error_bound)
        .def_readonly("condition", &ContinuousShape::condition)
        .def(
            "at",
            [](const ContinuousShape& shape, const Array& arc) {
                return columns<4>(
                    [&](double s) {
                        const revchain::ContinuousPlace place = shape(s);
                        return std::array{place.offset, place.height, place.inclination, place.tension};
                    },
                    arc);
            },
            "arc"_a);
    py::class_<ContinuousShapes>(module, "ContinuousShapes", "The steady shapes of a chain without links.")
        .def_readonly("shapes", &ContinuousShapes::shapes)
        .def_readonly("complete", &ContinuousShapes::complete);
    module.def(
        "continuous_shapes",
        [](double length, double tip_weight, const LineDensity* density, double height, int scanned) {
            const py::gil_scoped_release release;
            return revchain::continuous_shapes(chain_of(length, tip_weight, density), height, {.scanned = scanned});
        },
        "length"_a, "tip_weight"_a, "density"_a.none(true), "height"_a, "scanned"_a, py::keep_alive<0, 3>());
    module.def(
        "continuous_critical_heights",
        [](double length, double tip_weight, const LineDensity* density, revchain::Index count) {
            revchain::Vector<double> heights;
            {
                const py::gil_scoped_release release;
                heights = revchain::continuous_critical_heights(chain_of(length, tip_weight, density), count);
            }
            return to_numpy(heights);
        },
        "length"_a, "tip_weight"_a, "density"_a.none(true), "count"_a);
}
