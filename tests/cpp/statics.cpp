// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §3: the construction, checked as geometry, in quadruple precision.
#include "revchain/statics.hpp"

#include "revchain/modes.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::ForceDiagram;
using revchain::Index;
using revchain::Link;
using revchain::SteadyShape;
using support::Quad;
using support::quad;
using support::Random;

namespace {

Chain<double> random_chain(Random& random, Index size, int kind) {
    return support::chain_of(size, [&](Index m) -> Link<double> {
        const double weight = random.log_between(0.1, 10), a = random.log_between(0.3, 3);
        if (kind == 0) return revchain::plummet<double>(weight, a);
        if (kind == 1) return revchain::uniform_rod<double>(weight, a);
        if (kind == 2 && m % 2 == 1) return revchain::plummet<double>(0.0, a);  // threads between
        return revchain::compound_pendulum<double>({.weight = weight,
                                                    .length = a,
                                                    .centroid = a * random.between(m == 0 ? 0.1 : -0.02, 0.8),
                                                    .radius_of_gyration = a * random.between(0, 0.3)});
    });
}

void for_random_shapes(const std::function<void(const Chain<double>&, const SteadyShape&, int)>& check) {
    Random random(31);
    for (Index size = 1; size <= 8; ++size) {
        for (int i = 0; i < 16; ++i) {
            const auto chain = random_chain(random, size, i % 4);
            const double height =
                revchain::modes(chain, {.count = 1}).conical_height[0] * random.log_between(0.02, 0.98);
            for (const SteadyShape& shape : revchain::steady_shapes(chain, height, {.budget = 5000}).shapes)
                check(chain, shape, i % 4);
        }
    }
}

/// The sine of the angle between two directions, in ulp of it when each of the `loads` sideways is known to one.
double angle(Quad x1, Quad z1, Quad x2, Quad z2, Quad loads) {
    const Quad cross = fabsq(x1 * z2 - z1 * x2), first = hypotq(x1, z1), second = hypotq(x2, z2);
    return static_cast<double>(cross / (first * second) / (1 + loads / second)) /
           std::numeric_limits<double>::epsilon();
}

}  // namespace

TEST_CASE("Force diagram: sides are parallel to the rays, and pull as they do", "[finite][force_diagram]") {
    double worst_side = 0, worst_reaction = 0, worst_gk = 0, worst_tension = 0, worst_closing = 0, worst_crossing = 0;
    int shapes = 0;
    for_random_shapes([&](const Chain<double>& chain, const SteadyShape& shape, int kind) {
        const ForceDiagram d = revchain::force_diagram(chain, shape);
        ++shapes;
        Quad loads = 0, weight = 0, x = d.pin(0, 0), z = d.pin(0, 1), down = 0, out = 0, steep = 0;
        for (Index m = 0; m < chain.size(); ++m) {
            loads += fabsq(Quad(d.load(m, 0))) + fabsq(Quad(d.load(m, 1)));
            weight += chain.link(m).weight;
            down -= d.load(m, 1), out += d.load(m, 0);
            const Quad side_x = Quad(d.pin(m + 1, 0)) - d.pin(m, 0), side_z = Quad(d.pin(m + 1, 1)) - d.pin(m, 1);
            worst_side = std::max(worst_side, angle(side_x, side_z, d.ray(m, 0), d.ray(m, 1), loads));
            // the line of load: Q_m is at its level, and as far sideways as all forces below ask
            CHECK(fabsq(Quad(d.ray(m, 1)) - down) <= 4e-16 * down * m);
            CHECK(fabsq(Quad(d.ray(m, 0)) + out) <= 4e-16 * loads * m);
            // the reaction, of §8 (5), and its size
            const double phi = shape.reaction_inclination[m];
            worst_reaction = std::max(worst_reaction,
                                      angle(-sinq(phi), cosq(phi), d.reaction(m, 0), d.reaction(m, 1), loads + weight));
            worst_tension =
                std::max(worst_tension,
                         static_cast<double>(
                             fabsq(hypotq(Quad(d.reaction(m, 0)), Quad(d.reaction(m, 1))) / shape.tension[m] - 1) /
                             (1 + loads / shape.tension[m])) /
                             revchain::epsilon<double>());
            // GK, lambda above H, is parallel to it
            const double g_x = d.centre_of_gravity(m, 0);
            worst_gk = std::max(
                worst_gk, angle(-Quad(g_x), d.conical_height, d.reaction(m, 0), d.reaction(m, 1), loads + weight));
            // lifted onto the line lambda below O, each load is seen from O where it acts
            if (kind == 0) CHECK(std::abs(d.lifted[m] / shape.offset[m] - 1) <= 1e-15);
            CHECK(fabsq(Quad(d.lifted[m]) * -d.load(m, 1) - Quad(d.load(m, 0)) * d.conical_height) <=
                  1e-15 * fabsq(Quad(d.load(m, 0)) * d.conical_height));
            // C_m: in one line with both pins
            if (std::isfinite(d.crossing[m]))
                worst_crossing = std::max(
                    worst_crossing,
                    static_cast<double>(
                        fabsq(side_x * (Quad(d.crossing[m]) - d.pin(m + 1, 1)) + side_z * Quad(d.pin(m + 1, 0))) /
                        (fabsq(side_z * Quad(d.pin(m + 1, 0))) +
                         fabsq(side_x) * (fabsq(Quad(d.crossing[m])) + fabsq(Quad(d.pin(m + 1, 1)))) +
                         fabsq(side_z) * (fabsq(Quad(d.pin(m, 0))) + fabsq(Quad(d.pin(m + 1, 0)))))) /
                        revchain::epsilon<double>());
            // the construction from the free end upwards: every side a_m long and parallel to its ray
            const Quad ray = hypotq(Quad(d.ray(m, 0)), Quad(d.ray(m, 1)));
            x += chain.link(m).length * (Quad(d.ray(m, 0)) / ray),
                z += chain.link(m).length * (Quad(d.ray(m, 1)) / ray);
            steep += chain.link(m).length * (1 + loads / ray);
        }
        // It ends on the axis, at the support.
        worst_closing =
            std::max(worst_closing, static_cast<double>(hypotq(x, z) / steep) / revchain::epsilon<double>());
    });
    CAPTURE(shapes, worst_side, worst_reaction, worst_tension, worst_gk, worst_closing, worst_crossing);
    CHECK(shapes > 200);
    CHECK(worst_side <= 6);        // measured 4.2
    CHECK(worst_reaction <= 1.2);  // measured 0.72
    CHECK(worst_tension <= 1.5);   // measured 0.87
    CHECK(worst_gk <= 0.9);        // measured 0.51
    CHECK(worst_closing <= 0.9);   // measured 0.5
    CHECK(worst_crossing <= 0.5);  // measured 0.29
}

TEST_CASE("Force diagram: C_1 of a plummet is lambda above it", "[finite][force_diagram]") {
    const auto chain = Chain<double>::uniform_plummets(4, 4.0, 1.0);
    for (const SteadyShape& shape : revchain::steady_shapes(chain, 0.2).shapes) {
        const ForceDiagram d = revchain::force_diagram(chain, shape);
        CHECK(std::abs(d.crossing[0] - d.pin(0, 1) - 0.2) < 1e-14);
        CHECK(d.crossing[3] == 0.0);
    }
}

TEST_CASE("Weights transferred to the axis: the shape is a mode of the straight chain", "[finite][force_diagram]") {
    double worst_height = 0, worst_offset = 0;
    int wrong_number = 0, plummets = 0;
    for_random_shapes([&](const Chain<double>& chain, const SteadyShape& shape, int kind) {
        const auto modes = revchain::modes(revchain::transferred_to_axis(chain, shape), {.count = revchain::all_modes});
        Index k = 0;
        for (Index j = 1; j < modes.size(); ++j)
            if (std::abs(modes.conical_height[j] - shape.conical_height) <
                std::abs(modes.conical_height[k] - shape.conical_height))
                k = j;
        const double steep =
            shape.inclination.unaryExpr([](double d) { return 1 + std::abs(d * std::tan(d)); }).maxCoeff();
        worst_height =
            std::max(worst_height, support::error_in_ulp(modes.conical_height[k], Quad(shape.conical_height)) / steep);
        double nearest = 1;  // of the other heights: how well the shape is told
        for (Index j = 0; j < modes.size(); ++j)
            if (j != k) nearest = std::min(nearest, std::abs(modes.conical_height[j] / shape.conical_height - 1));
        const auto offset = shape.offset / shape.offset.cwiseAbs().maxCoeff();
        for (Index pin = 0; pin <= chain.size(); ++pin)
            worst_offset = std::max(worst_offset, std::abs(modes.shapes().offset(k, pin) - offset[pin]) /
                                                      revchain::epsilon<double>() / steep * nearest);
        if (kind == 0) ++plummets, wrong_number += modes.first + k != shape.half_waves;
    });
    CAPTURE(worst_height, worst_offset, wrong_number, plummets);
    CHECK(plummets > 50);
    CHECK(wrong_number == 0);    // of plummets, mode k has k half waves
    CHECK(worst_height <= 0.8);  // measured 0.46
    CHECK(worst_offset <= 0.7);  // measured 0.38
}

TEST_CASE("Force diagram: of another chain", "[finite][force_diagram]") {
    const auto chain = Chain<double>::uniform_plummets(3, 3.0, 1.0);
    const auto shape = revchain::steady_shapes(chain, 0.5).shapes.at(0);
    const auto other = Chain<double>::uniform_plummets(4, 3.0, 1.0);
    CHECK_THROWS_AS(revchain::force_diagram(other, shape), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::transferred_to_axis(other, shape), revchain::InvalidArgument);
}
