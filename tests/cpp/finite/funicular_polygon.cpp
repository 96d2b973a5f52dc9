// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §3: a funicular polygon between two supports, and its oscillation perpendicular to its plane.
#include "revchain/statics.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

using revchain::Index;
using support::error_in_ulp;
using support::Quad;
using support::Random;
using Vector = revchain::Vector<double>;

namespace {

struct Given {
    Vector weight, place;
    double horizontal, first, last;
};

Given random_polygon(Random& random, Index n, double span) {
    Given g{Vector(n), Vector(n + 2), random.log_between(0.1, 100), random.between(-3, 3), random.between(-3, 3)};
    for (Index j = 0; j < n; ++j) g.weight[j] = random.log_between(1 / span, span);
    g.place[0] = random.between(-5, 5);
    for (Index j = 0; j <= n; ++j) g.place[j + 1] = g.place[j] + random.log_between(1 / span, span);
    return g;
}

/// Heights by the moments of a beam that carries the weights: the drop below the chord is moment over horizontal tension.
std::vector<Quad> true_heights(const Given& g) {
    const Index n = g.weight.size();
    const Quad left = g.place[0], right = g.place[n + 1], span = right - left;
    std::vector<Quad> z;
    for (Index i = 0; i < n + 2; ++i) {
        const Quad x = g.place[i];
        Quad moment = 0;
        for (Index j = 0; j < n; ++j) {
            const Quad at = g.place[j + 1];
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
            const Quad dx = Quad(g.place[j + 1]) - g.place[j];
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
        const auto polygon = revchain::funicular_polygon<double>(g.weight, g.place, g.horizontal, g.first, g.last);
        const auto z = true_heights(g);
        Quad lowest = 0;
        for (Index j = 0; j < n + 2; ++j) lowest = fmaxq(lowest, fabsq(z[static_cast<std::size_t>(j)]));
        Quad total = g.weight.sum();
        for (Index j = 0; j < n + 2; ++j)
            worst =
                std::max(worst, static_cast<double>(fabsq(polygon.height[j] - z[static_cast<std::size_t>(j)]) /
                                                    (lowest + total / g.horizontal * (g.place[n + 1] - g.place[0]))) /
                                    revchain::epsilon<double>() / static_cast<double>(n));
        for (Index j = 0; j <= n; ++j) {
            const Quad dx = Quad(g.place[j + 1]) - g.place[j];
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
            const auto modes = revchain::transverse_modes<double>(g.weight, g.place, g.horizontal);
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
    for (const auto& [weight, place, tension] :
         {std::tuple(two, three, 1.0), std::tuple(two, back, 1.0), std::tuple(bad, four, 1.0),
          std::tuple(two, four, 0.0), std::tuple(two, four, nan)}) {
        CHECK_THROWS_AS((revchain::funicular_polygon<double>(weight, place, tension)), InvalidArgument);
        CHECK_THROWS_AS((revchain::transverse_modes<double>(weight, place, tension)), InvalidArgument);
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
