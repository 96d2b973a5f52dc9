// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <memory>
#include <optional>
#include <variant>

#include "bindings.hpp"
#include "forces.hpp"
#include "interrupt.hpp"
#include "revchain/cord.hpp"
#include "revchain/held.hpp"
#include "shapes.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>

namespace {

using revchain::Cord;
using revchain::CordShape;
using HeldCord = revchain::Held<Cord>;
using revchain::Index;
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

Cord cord_of(double length, std::optional<double> weight, const Density& density, double tip_weight,
             const std::map<double, double>& weights, double tip_centroid, double tip_radius_of_gyration) {
    revchain::CordOptions options{.weight = weight,
                                  .tip_weight = tip_weight,
                                  .weights = weights,
                                  .tip_centroid = tip_centroid,
                                  .tip_radius_of_gyration = tip_radius_of_gyration};
    if (const double* exponent = std::get_if<double>(&density))
        options.density = *exponent;
    else
        options.density = std::shared_ptr<const LineDensity>(std::get<std::shared_ptr<LineDensity>>(density));
    return Cord(length, options);
}

/// The steps of the path of a shape, and a last row: free end, support (arc, height), tip and unit of `finite::PathKind`.
py::array path_of(const CordShape& shape) {
    revchain::Table<double> table(static_cast<Index>(shape.steps.size()) + 1, 5);
    Index i = 0;
    for (const auto& [x, duration] : shape.steps) table.row(i++) << x.arc, x.offset, x.pull, x.height, duration;
    table.row(i) << shape.tip_offset, shape.support_arc, shape.support_height, shape.kind.tip, shape.kind.unit;
    return to_numpy(table);
}

void set_path(CordShape& shape, const Array& table) {
    if (table.size() < 5 || table.size() % 5 != 0)
        revchain::detail::throw_invalid("SteadyShape", "this is not the path of a shape");
    const double *x = table.data(), *last = x + table.size() - 5;
    shape.steps.clear();
    for (; x != last; x += 5) shape.steps.push_back({{x[0], x[1], x[2], x[3]}, x[4]});
    shape.tip_offset = x[0], shape.support_arc = x[1], shape.support_height = x[2];
    shape.kind.tip = x[3], shape.kind.unit = x[4];
}

CordShape blank_shape(const Cord& cord) {
    CordShape shape;
    shape.length = cord.length(), shape.density = cord.line_density();
    shape.kind = revchain::finite::kind_of(revchain::finite::ContinuousChain(cord), 1.0, 1.0);
    return shape;
}

}  // namespace

void bind_cord(py::module_& module) {
    py::class_<LineDensity, std::shared_ptr<LineDensity>>(module, "LineDensity", "Weight per length, as polynomials.")
        .def(py::init<const std::function<double(double)>&, double, std::vector<double>>(), "weight_per_length"_a,
             "length"_a, "breaks"_a)
        .def(
            "__call__", [](const LineDensity& density, double s) { return density.about(s)[0]; }, "s"_a)
        .def("weight_below", &LineDensity::weight_below, "s"_a)
        .def_readonly_static("least_place", &LineDensity::least_place)
        .def(py::pickle(&get_state, &set_state));
    py::class_<Cord>(module, "Cord", "A flexible cord hung from one end; immutable.")
        .def(py::init(&cord_of), "length"_a, "weight"_a.none(true), "density"_a, "tip_weight"_a, "weights"_a,
             "tip_centroid"_a, "tip_radius_of_gyration"_a)
        .def_property_readonly("length", &Cord::length)
        .def_property_readonly("weight", &Cord::weight)
        .def_property_readonly("tip_weight", &Cord::tip_weight)
        .def_property_readonly("has_bob", &Cord::has_bob);
    auto shapes = bind_shape<CordShape>(module, "CordShape", "A steady shape of a whirling cord.");
    def_column(shapes, "arc_length", &CordShape::arc_length);
    def_column(shapes, "tension", &CordShape::tension);
    shapes.def_property("path", &path_of, &set_path)
        .def(
            "along",
            [](const CordShape& shape, const Array& arc) {
                return columns<4>(
                    [&](double s) {
                        const revchain::CordPlace place = shape(s);
                        return std::array{place.offset, place.height, place.inclination, place.tension};
                    },
                    arc);
            },
            "arc"_a);
    py::class_<HeldCord>(module, "HeldCord", "A cord held at both ends; immutable.")
        .def(py::init([](const Cord& cord, std::optional<double> span, const Tension& pull, bool weightless) {
                 return HeldCord(cord, {.span = span, .tension = tension(pull), .weightless = weightless});
             }),
             "cord"_a, "span"_a, "tension"_a, "weightless"_a);
    module.def("blank_shape", &blank_shape, "system"_a);
    bind_shapes<revchain::CordShapes>(module, "CordShapes");
    def_steady_shapes<Cord>(module, [](const Cord& cord, const AtSpeed& at) {
        return revchain::steady_shapes(cord,
                                       {.conical_height = *at.conical_height, .scanned = static_cast<int>(at.budget)});
    });
    def_stability<Cord, CordShape>(
        module, [](const Cord& cord, const CordShape& shape, revchain::StabilityFrame in, int, double) {
            return aside(nullptr, [=] { return revchain::stability(cord, shape, in); });
        });
}
