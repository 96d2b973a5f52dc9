// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <memory>
#include <optional>
#include <variant>

#include "bindings.hpp"
#include "interrupt.hpp"
#include "revchain/cord.hpp"

#include <pybind11/functional.h>

namespace {

using revchain::Cord;
using revchain::CordShape;
using revchain::CordShapes;
using revchain::LineDensity;
using revchain::Vector;
using Density = std::variant<double, std::shared_ptr<LineDensity>>;

constexpr py::ssize_t numbers_of_piece = 4 + LineDensity::degree + 1;

/// Its length, and of each piece: middle, half length, power, doubt, coefficients.
py::tuple get_state(const LineDensity& density) {
    const auto& pieces = density.pieces();
    py::array_t<double> table({static_cast<py::ssize_t>(pieces.size()), numbers_of_piece});
    double* to = table.mutable_data();
    for (const LineDensity::Piece& piece : pieces) {
        *to++ = piece.middle, *to++ = piece.half, *to++ = piece.power, *to++ = piece.doubt;
        to = std::copy(piece.factor.begin(), piece.factor.end(), to);
    }
    return py::make_tuple(density.length(), frozen(std::move(table)));
}

std::shared_ptr<LineDensity> set_state(const py::tuple& state) {
    const Array table = state[1].cast<Array>();
    if (table.ndim() != 2 || table.shape(1) != numbers_of_piece)
        revchain::detail::throw_invalid("LineDensity", "this is not the state of a density");
    std::vector<LineDensity::Piece> pieces(static_cast<std::size_t>(table.shape(0)));
    const double* from = table.data();
    for (LineDensity::Piece& piece : pieces) {
        piece.middle = from[0], piece.half = from[1], piece.power = from[2], piece.doubt = from[3];
        std::copy(from + 4, from + numbers_of_piece, piece.factor.begin());
        from += numbers_of_piece;
    }
    return std::make_shared<LineDensity>(state[0].cast<double>(), std::move(pieces));
}

Cord cord_of(double length, std::optional<double> weight, const Density& density, double tip_weight) {
    revchain::CordOptions options{.weight = weight, .tip_weight = tip_weight};
    if (const double* exponent = std::get_if<double>(&density))
        options.density = *exponent;
    else
        options.density = std::shared_ptr<const LineDensity>(std::get<std::shared_ptr<LineDensity>>(density));
    return Cord(length, options);
}

}  // namespace

void bind_cord(py::module_& module) {
    const auto column = [](Vector<double> CordShape::*member) {
        return [member](const CordShape& shape) { return to_numpy(shape.*member); };
    };
    py::class_<LineDensity, std::shared_ptr<LineDensity>>(module, "LineDensity", "Weight per length, as polynomials.")
        .def(py::init<const std::function<double(double)>&, double>(), "weight_per_length"_a, "length"_a)
        .def(
            "__call__", [](const LineDensity& density, double s) { return density.about(s)[0]; }, "s"_a)
        .def("weight_below", &LineDensity::weight_below, "s"_a)
        .def(py::pickle(&get_state, &set_state));
    py::class_<Cord>(module, "Cord", "A flexible cord hung from one end; immutable.")
        .def(py::init(&cord_of), "length"_a, "weight"_a.none(true), "density"_a, "tip_weight"_a)
        .def_property_readonly("length", &Cord::length)
        .def_property_readonly("weight", &Cord::weight)
        .def_property_readonly("tip_weight", &Cord::tip_weight);
    py::class_<CordShape>(module, "CordShape", "A steady shape of a whirling cord.")
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
    py::class_<CordShapes>(module, "CordShapes", "The steady shapes of a cord.")
        .def_readonly("shapes", &CordShapes::shapes)
        .def_readonly("complete", &CordShapes::complete);
    module.def(
        "cord_shapes",
        [](const Cord& cord, double height, int scanned) {
            const py::gil_scoped_release release;
            return revchain::steady_shapes(cord, {.conical_height = height, .scanned = scanned});
        },
        "cord"_a, "height"_a, "scanned"_a);
    module.def(
        "cord_stability",
        [](const Cord& cord, const revchain::CordShape& shape, bool driven) {
            const auto frame = driven ? revchain::StabilityFrame::driven : revchain::StabilityFrame::free;
            return aside(nullptr, [=] { return revchain::stability(cord, shape, frame); });
        },
        "cord"_a, "shape"_a, "driven"_a);
}
