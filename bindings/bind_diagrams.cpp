// SPDX-License-Identifier: GPL-3.0-or-later
// Diagrams of forces (statics.hpp) and jointed links (two_links.hpp).
#include "bindings.hpp"
#include "revchain/statics.hpp"
#include "revchain/two_links.hpp"

namespace {

using revchain::ForceDiagram;
using Polygon = revchain::FunicularPolygon<double>;
using Links = revchain::JointedLinks<double>;

revchain::Vector<double> vector(const Array& values) {
    return Eigen::Map<const revchain::Vector<double>>(values.data(), values.size());
}

template <class Object, class Member>
auto copied(Member Object::*member) {
    return [member](const Object& object) { return to_numpy(object.*member); };
}

}  // namespace

void bind_diagrams(py::module_& module) {
    py::class_<ForceDiagram>(module, "ForceDiagram", "Force diagram and funicular polygon of a steady shape.")
        .def_property_readonly("pin", copied(&ForceDiagram::pin))
        .def_property_readonly("load", copied(&ForceDiagram::load))
        .def_property_readonly("ray", copied(&ForceDiagram::ray))
        .def_property_readonly("reaction", copied(&ForceDiagram::reaction))
        .def_property_readonly("lifted", copied(&ForceDiagram::lifted))
        .def_property_readonly("centre_of_gravity", copied(&ForceDiagram::centre_of_gravity))
        .def_property_readonly("crossing", copied(&ForceDiagram::crossing))
        .def_readonly("conical_height", &ForceDiagram::conical_height);
    module.def("force_diagram", &revchain::force_diagram, "chain"_a, "shape"_a);
    module.def("transferred_to_axis", &revchain::transferred_to_axis, "chain"_a, "shape"_a);

    py::class_<Polygon>(module, "FunicularPolygon", "Weights on a thread between two supports.")
        .def_property_readonly("position", copied(&Polygon::position))
        .def_property_readonly("height", copied(&Polygon::height))
        .def_property_readonly("rise", copied(&Polygon::rise))
        .def_property_readonly("tension", copied(&Polygon::tension))
        .def_readonly("horizontal_tension", &Polygon::horizontal_tension);
    module.def(
        "funicular_polygon",
        [](const Array& weight, const Array& position, double horizontal_tension, double first, double last) {
            return revchain::funicular_polygon(vector(weight), vector(position), horizontal_tension, first, last);
        },
        "weight"_a, "position"_a, "horizontal_tension"_a, "first_height"_a, "last_height"_a);
    module.def(
        "transverse_modes",
        [](const Array& weight, const Array& position, double tension) {
            const auto found = revchain::transverse_modes(vector(weight), vector(position), tension);
            return py::make_tuple(to_numpy(found.conical_height), to_numpy(found.error_bound), to_numpy(found.shape));
        },
        "weight"_a, "position"_a, "tension"_a);

    module.def(
        "jointed_links",
        [](const Array& lower_weight, const Array& lower_centroid, const Array& lower_radius, const Array& upper_weight,
           const Array& upper_length, const Array& upper_centroid, const Array& upper_radius) {
            return columns<2>(
                [](double w1, double h1, double k1, double w2, double a2, double h2, double k2) {
                    return revchain::jointed_links(Links{w1, {h1, k1}, w2, a2, h2, k2});
                },
                lower_weight, lower_centroid, lower_radius, upper_weight, upper_length, upper_centroid, upper_radius);
        },
        "lower_weight"_a, "lower_centroid"_a, "lower_radius_of_gyration"_a, "upper_weight"_a, "upper_length"_a,
        "upper_centroid"_a, "upper_radius_of_gyration"_a);
    module.def(
        "jointed_links_shapes",
        [](double w1, double h1, double k1, double w2, double a2, double h2, double k2, double height) {
            return revchain::jointed_links_shapes(Links{w1, {h1, k1}, w2, a2, h2, k2}, height);
        },
        "lower_weight"_a, "lower_centroid"_a, "lower_radius_of_gyration"_a, "upper_weight"_a, "upper_length"_a,
        "upper_centroid"_a, "upper_radius_of_gyration"_a, "height"_a);
    module.def("pin_of_silent_clapper",
               vectorized([](double bell_weight, double bell_centroid, double bell_radius, double clapper_weight,
                             double clapper_centroid, double clapper_radius) {
                   return revchain::pin_of_silent_clapper<double>(bell_weight, {bell_centroid, bell_radius},
                                                                  clapper_weight, {clapper_centroid, clapper_radius});
               }),
               "bell_weight"_a, "bell_centroid"_a, "bell_radius_of_gyration"_a, "clapper_weight"_a,
               "clapper_centroid"_a, "clapper_radius_of_gyration"_a);
    module.def("joint_without_bending",
               vectorized([](double length, double pin) { return revchain::joint_without_bending(length, pin); }),
               "length"_a, "pin"_a);
}
