// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §3: the construction, checked as geometry, in quadruple precision; a funicular polygon between two
// supports, and its oscillation perpendicular to its plane.
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
using support::error_in_ulp;
using support::Quad;
using support::quad;
using support::Random;
using Vector = revchain::Vector<double>;

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
            for (const SteadyShape& shape :
                 revchain::steady_shapes(chain, {.conical_height = height, .budget = 5000}).shapes)
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
    CHECK(worst_side <= 5);        // measured 4.2
    CHECK(worst_reaction <= 1.2);  // measured 0.72
    CHECK(worst_tension <= 1.5);   // measured 0.87
    CHECK(worst_gk <= 0.9);        // measured 0.51
    CHECK(worst_closing <= 0.9);   // measured 0.5
    CHECK(worst_crossing <= 0.5);  // measured 0.29
}

TEST_CASE("Force diagram: C_1 of a plummet is lambda above it", "[finite][force_diagram]") {
    const auto chain = Chain<double>::uniform_plummets(4, 4.0, 1.0);
    for (const SteadyShape& shape : revchain::steady_shapes(chain, {.conical_height = 0.2}).shapes) {
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
            worst_offset = std::max(worst_offset, std::abs(modes.shapes()(k, pin) - offset[pin]) /
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
    const auto shape = revchain::steady_shapes(chain, {.conical_height = 0.5}).shapes.at(0);
    const auto other = Chain<double>::uniform_plummets(4, 3.0, 1.0);
    CHECK_THROWS_AS(revchain::force_diagram(other, shape), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::transferred_to_axis(other, shape), revchain::InvalidArgument);
}

namespace {

struct Given {
    Vector weight, position;
    double horizontal, first, last;
};

Given random_polygon(Random& random, Index n, double span) {
    Given g{Vector(n), Vector(n + 2), random.log_between(0.1, 100), random.between(-3, 3), random.between(-3, 3)};
    for (Index j = 0; j < n; ++j) g.weight[j] = random.log_between(1 / span, span);
    g.position[0] = random.between(-5, 5);
    for (Index j = 0; j <= n; ++j) g.position[j + 1] = g.position[j] + random.log_between(1 / span, span);
    return g;
}

/// Heights by the moments of a beam that carries the weights: the drop below the chord is moment over horizontal tension.
std::vector<Quad> true_heights(const Given& g) {
    const Index n = g.weight.size();
    const Quad left = g.position[0], right = g.position[n + 1], span = right - left;
    std::vector<Quad> z;
    for (Index i = 0; i < n + 2; ++i) {
        const Quad x = g.position[i];
        Quad moment = 0;
        for (Index j = 0; j < n; ++j) {
            const Quad at = g.position[j + 1];
            moment += g.weight[j] * (x < at ? (x - left) * (right - at) : (at - left) * (right - x)) / span;
        }
        z.push_back(g.first + (Quad(g.last) - g.first) * (x - left) / span - moment / g.horizontal);
    }
    return z;
}

/// Weights that move perpendicular to the plane of the polygon, on sides of given tension and length: stiffness T/a each.
struct Sides {
    std::vector<Quad> stiffness, weight;

    Sides(const Given& g) {
        const auto z = true_heights(g);
        const Index n = g.weight.size();
        for (Index j = 0; j <= n; ++j) {
            const Quad dx = Quad(g.position[j + 1]) - g.position[j];
            const Quad dz = z[static_cast<std::size_t>(j) + 1] - z[static_cast<std::size_t>(j)];
            const Quad length = hypotq(dx, dz), tension = g.horizontal * (length / dx);
            stiffness.push_back(tension / length);
        }
        for (Index j = 0; j < n; ++j) weight.push_back(g.weight[j]);
    }
    /// How many heights exceed one: negative pivots of  height K - W.
    Index above(Quad height) const {
        Index negative = 0;
        Quad pivot = 0;
        for (std::size_t j = 0; j < weight.size(); ++j) {
            const Quad off = height * stiffness[j];
            pivot = height * (stiffness[j] + stiffness[j + 1]) - weight[j] - (j == 0 ? Quad(0) : off * off / pivot);
            negative += pivot < 0;
        }
        return negative;
    }
    Quad height(Index k) const {
        Quad lower = 1e-40, upper = 1e40;
        while (upper - lower > 1e-24 * lower) {
            const Quad middle = upper > 2 * lower ? sqrtq(lower * upper) : lower + (upper - lower) / 2;
            (above(middle) > k ? lower : upper) = middle;
        }
        return lower;
    }
    Quad largest_force(Quad height, const revchain::Table<double>& shape, Index k, Quad* size) const {
        Quad worst = 0;
        *size = 0;
        for (std::size_t j = 0; j < weight.size(); ++j) {
            const auto at = [&](std::size_t i) { return Quad(shape(k, static_cast<Index>(i))); };
            const Quad below = stiffness[j] * (at(j + 1) - at(j)),
                       above_it = stiffness[j + 1] * (at(j + 2) - at(j + 1));
            const Quad inertia = weight[j] * at(j + 1) / height;
            worst = fmaxq(worst, fabsq(below - above_it - inertia));
            *size = fmaxq(*size, (stiffness[j] + stiffness[j + 1]) + weight[j] / height);
        }
        return worst;
    }
};

}  // namespace

TEST_CASE("Funicular polygon: by the moments of a beam", "[finite][funicular]") {
    Random random(51);
    double worst = 0, worst_tension = 0;
    for (int i = 0; i < 300; ++i) {
        const Index n = 1 + i % 12;
        const Given g = random_polygon(random, n, 10);
        const auto polygon = revchain::funicular_polygon<double>(g.weight, g.position, g.horizontal, g.first, g.last);
        const auto z = true_heights(g);
        Quad lowest = 0;
        for (Index j = 0; j < n + 2; ++j) lowest = fmaxq(lowest, fabsq(z[static_cast<std::size_t>(j)]));
        Quad total = g.weight.sum();
        for (Index j = 0; j < n + 2; ++j)
            worst = std::max(
                worst, static_cast<double>(fabsq(polygon.height[j] - z[static_cast<std::size_t>(j)]) /
                                           (lowest + total / g.horizontal * (g.position[n + 1] - g.position[0]))) /
                           revchain::epsilon<double>() / static_cast<double>(n));
        for (Index j = 0; j <= n; ++j) {
            const Quad dx = Quad(g.position[j + 1]) - g.position[j];
            const Quad dz = z[static_cast<std::size_t>(j) + 1] - z[static_cast<std::size_t>(j)];
            worst_tension = std::max(
                worst_tension, static_cast<double>(fabsq(polygon.tension[j] - g.horizontal * hypotq(dx, dz) / dx) /
                                                   (total + g.horizontal * hypotq(dx, dz) / dx)) /
                                   revchain::epsilon<double>());
        }
    }
    CAPTURE(worst, worst_tension);
    CHECK(worst <= 1.2);          // ulp a weight, of the drop; measured 0.68
    CHECK(worst_tension <= 1.6);  // measured 1.04
}

TEST_CASE("String of weights: it oscillates as the polygon does perpendicular to its plane", "[finite][funicular]") {
    Random random(52);
    double worst = 0, over_bound = 0, worst_force = 0;
    for (const double span : {2.0, 100.0, 1e4}) {
        for (int i = 0; i < 60; ++i) {
            const Index n = 1 + i % 10;
            const Given g = random_polygon(random, n, span);
            const auto modes = revchain::transverse_modes<double>(g.weight, g.position, g.horizontal);
            REQUIRE(modes.conical_height.size() == n);
            const Sides sides(g);
            for (Index k = 0; k < n; ++k) {
                const Quad truth = sides.height(k);
                const double error = error_in_ulp(modes.conical_height[k], truth);
                worst = std::max(worst, error);
                over_bound = std::max(over_bound, error * revchain::epsilon<double>() / modes.error_bound[k]);
                Quad size;
                const Quad force = sides.largest_force(truth, modes.shape, k, &size);
                worst_force = std::max(worst_force, static_cast<double>(force / size) / revchain::epsilon<double>());
                CHECK(modes.shape(k, 0) == 0);
                CHECK(modes.shape(k, n + 1) == 0);
                CHECK(modes.shape(k, 1) > 0);
                CHECK(modes.shape.row(k).cwiseAbs().maxCoeff() == 1.0);
            }
        }
    }
    CAPTURE(worst, over_bound, worst_force);
    CHECK(worst <= 2);  // ulp; measured 1.01
    CHECK(over_bound <= 1);
    CHECK(worst_force <= 0.8);  // ulp of the forces; measured 0.42
}

TEST_CASE("String of weights: equal weights, Lagrange's sines", "[finite][funicular]") {
    // lambda_k = W a/H / (2 sin(k pi/2(n + 1)))^2
    for (const Index n : {1, 2, 7, 100}) {
        const auto modes = revchain::transverse_modes<double>(
            Vector::Constant(n, 2.0), Vector::LinSpaced(n + 2, 0, static_cast<double>(n + 1)), 8.0);
        for (Index k = 0; k < n; ++k) {
            const Quad s = 2 * sinq(static_cast<double>(k + 1) * acosq(Quad(-1)) / (2 * static_cast<double>(n + 1)));
            CHECK(error_in_ulp(modes.conical_height[k], Quad(0.25) / (s * s)) <= 2);
        }
    }
    const auto one = revchain::transverse_modes<double>(Vector::Constant(1, 2.0), Vector::LinSpaced(3, 0, 2), 8.0);
    CHECK(one.conical_height[0] == 0.125);
    CHECK(std::abs(one.period(9.81)[0] - 0.70926) < 1e-5);
}

TEST_CASE("Funicular polygon, string of weights: wrong numbers", "[finite][funicular]") {
    using revchain::InvalidArgument;
    const Vector two = Vector::Ones(2), four = Vector::LinSpaced(4, 0, 3), three = Vector::LinSpaced(3, 0, 2);
    Vector back = four, bad = two;
    back[2] = 0.5, bad[1] = -1;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [weight, position, tension] :
         {std::tuple(two, three, 1.0), std::tuple(two, back, 1.0), std::tuple(bad, four, 1.0),
          std::tuple(two, four, 0.0), std::tuple(two, four, nan)}) {
        CHECK_THROWS_AS((revchain::funicular_polygon<double>(weight, position, tension)), InvalidArgument);
        CHECK_THROWS_AS((revchain::transverse_modes<double>(weight, position, tension)), InvalidArgument);
    }
    CHECK_THROWS_AS((revchain::transverse_modes<double>(Vector(), Vector::LinSpaced(2, 0, 1), 1.0)), InvalidArgument);
    CHECK_THROWS_AS((revchain::funicular_polygon<double>(two, four, 1.0, nan)), InvalidArgument);
    CHECK(revchain::funicular_polygon<double>(Vector(), Vector::LinSpaced(2, 0, 1), 1.0, 0.0, 1.0).tension[0] ==
          std::sqrt(2.0));
}

TEST_CASE("polygons at the ends of the range", "[finite]") {
    const auto vector = [](std::initializer_list<double> x) {
        revchain::Vector<double> result(static_cast<revchain::Index>(x.size()));
        std::copy(x.begin(), x.end(), result.data());
        return result;
    };
    CHECK(revchain::funicular_polygon(vector({1.0}), vector({-1e290, 0, 1e290}), 1.0).height[1] == -5e289);
    CHECK_THROWS_AS(revchain::funicular_polygon(vector({1.0}), vector({-1e308, 0, 1e308}), 1.0),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::funicular_polygon(vector({1e300, 1e300}), vector({0, .5, 1, 2}), 1e-300),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::transverse_modes(vector({1e300, 1e300}), vector({0, .5, 1, 2}), 1e-300),
                    revchain::InvalidArgument);
}
