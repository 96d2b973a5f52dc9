// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <memory>
#include <optional>
#include <variant>

#include "bindings.hpp"
#include "revchain/cord.hpp"

#include <pybind11/functional.h>

namespace {

using revchain::Cord;
using HeldCord = revchain::Held<Cord>;
using revchain::CordModes;
using revchain::CordShape;
using revchain::CordShapes;
using revchain::Index;
using revchain::LineDensity;
using revchain::Vector;
using Density = std::variant<double, std::shared_ptr<LineDensity>>;
using Pair = std::pair<double, double>;

constexpr py::ssize_t numbers_of_piece = 3 + LineDensity::degree + 1;

/// Its length, and of each piece: middle, half length, power, coefficients.
py::tuple get_state(const LineDensity& density) {
    const auto& pieces = density.pieces();
    py::array_t<double> table({static_cast<py::ssize_t>(pieces.size()), numbers_of_piece});
    double* to = table.mutable_data();
    for (const LineDensity::Piece& piece : pieces) {
        *to++ = piece.middle, *to++ = piece.half, *to++ = piece.power;
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
        piece.middle = from[0], piece.half = from[1], piece.power = from[2];
        std::copy(from + 3, from + numbers_of_piece, piece.factor.begin());
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

template <class System>
CordModes modes(const System& cord, Index first, std::optional<Index> count, std::optional<Pair> conical_height,
                std::optional<std::tuple<double, double, double>> angular_speed, std::optional<double> rtol,
                revchain::Progress* progress, double gravity) {
    const py::gil_scoped_release release;
    revchain::ModesOptions<double> options{.first = first, .count = count, .gravity = gravity};
    if (conical_height) options.conical_height = {conical_height->first, conical_height->second};
    if (angular_speed) {
        options.angular_speed = {std::get<0>(*angular_speed), std::get<1>(*angular_speed)};
        options.gravity = std::get<2>(*angular_speed);
    }
    options.rtol = rtol;
    options.progress = progress;
    return revchain::modes(cord, options);
}

/// Offsets or slopes of every mode at places, shape (k, places).
template <Vector<double> (CordModes::*value)(Index, const Vector<double>&) const>
py::array along(const CordModes& found, const Array& arc) {
    const auto at = Eigen::Map<const Vector<double>>(arc.data(), arc.size());
    revchain::Table<double> table(found.size(), arc.size());
    {
        const py::gil_scoped_release release;
        for (Index j = 0; j < found.size(); ++j) {
            revchain::detail::look();
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

}  // namespace

void bind_cord_branches(py::module_& module);  // bind_cord_branches.cpp

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
    py::class_<CordModes>(module, "CordModes", "Modes of a cord.")
        .def_readonly("first", &CordModes::first)
        .def_property_readonly("conical_height", [](const CordModes& m) { return to_numpy(m.conical_height); })
        .def_property_readonly("error_bound", [](const CordModes& m) { return to_numpy(m.error_bound); })
        .def_readonly("method", &CordModes::method)
        .def_property_readonly("status", [](const CordModes& m) { return std::string(to_string(m.status)); })
        .def("offset", &along<&CordModes::offset>, "arc_length"_a)
        .def("slope", &along<&CordModes::slope>, "arc_length"_a)
        .def_property_readonly("nodes", &of_modes<&CordModes::nodes>)
        .def_property_readonly("vertical_points", &of_modes<&CordModes::vertical_points>);
    py::class_<HeldCord>(module, "HeldCord", "A cord held at both ends; immutable.")
        .def(py::init([](const Cord& cord, std::optional<double> span, std::optional<double> tension, bool weightless) {
                 return HeldCord(cord, {.span = span, .tension = tension, .weightless = weightless});
             }),
             "cord"_a, "span"_a, "tension"_a, "weightless"_a);
    module.def("cord_modes", &modes<Cord>, "cord"_a, "first"_a, "count"_a, "conical_height"_a, "angular_speed"_a,
               "rtol"_a, "progress"_a = py::none(), "gravity"_a = revchain::conical_pendulum::standard_gravity);
    module.def("held_modes", &modes<HeldCord>, "held"_a, "first"_a, "count"_a, "conical_height"_a, "angular_speed"_a,
               "rtol"_a, "progress"_a, "gravity"_a);
    module.def(
        "cord_sensitivity",
        [](const CordModes& found) {
            const auto s = without_lock([&] { return revchain::sensitivity(found); });
            return py::make_tuple(to_numpy(s.length), to_numpy(s.weight), to_numpy(s.tip_weight), to_numpy(s.exponent),
                                  to_numpy(s.tension));
        },
        "modes"_a);
    module.def("count_cord_modes", &counts_above<Cord>, "cord"_a, "conical_height"_a,
               "gravity"_a = revchain::conical_pendulum::standard_gravity);
    module.def("count_held_modes", &counts_above<HeldCord>, "held"_a, "conical_height"_a, "gravity"_a);
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
    bind_cord_branches(module);
}
