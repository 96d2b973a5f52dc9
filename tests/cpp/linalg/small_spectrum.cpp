// SPDX-License-Identifier: MPL-2.0
#include "revchain/linalg/small_spectrum.hpp"

#include <memory>
#include <vector>

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using support::Quad;
namespace linalg = revchain::linalg;
namespace small = revchain::linalg::small;

namespace {

constexpr double ulp = 0x1p-52;

/// A link of its own weight, centroid in the middle: half of W at either pin and X = W (1/4 - r). Where not rigid all of W
/// at its lower pin. The stiffness is free: these need not be chains.
struct Body {
    double weight, ratio, stiffness;
};

small::PinnedLinks pinned(const std::vector<Body>& bodies, bool rigid) {
    small::PinnedLinks links;
    links.size = bodies.size();
    links.rigid = rigid;
    double trace = 0, greatest = 0, hung = 0;
    for (std::size_t m = 0; m < bodies.size(); ++m) {
        const auto& [weight, r, k] = bodies[m];
        links.mass[m] = rigid ? (weight + (m == 0 ? 0 : bodies[m - 1].weight)) / 2 : weight;
        links.stiffness[m] = k;
        links.flexibility[m] = 1 / k;
        links.swing[m] = weight * (0.25 - r) / k;
        links.quarter_weight[m] = weight / 4;
        links.skew[m] = 0;
        links.turn[m] = weight * r;
        hung += weight;
        trace += hung / k;
        greatest =
            std::max(greatest, rigid ? k / (weight * r) : 2 * (k + (m == 0 ? 0 : bodies[m - 1].stiffness)) / weight);
    }
    links.least_shift = 0.999 / trace;
    links.greatest_shift = 1.001 * greatest;
    return links;
}

/// How many eigenvalues of the assembled pencil exceed `height`, in quadruple precision.
std::size_t above(const std::vector<Body>& bodies, bool rigid, Quad height) {
    std::size_t negative = 0;
    Quad pivot = 1, coupling = 0, k_below = 0, far = 0;
    for (std::size_t m = 0; m < bodies.size(); ++m) {
        const Quad w = bodies[m].weight, r = bodies[m].ratio, k = bodies[m].stiffness;
        const Quad near = rigid ? w * (Quad(0.25) + r) : w, cross = rigid ? w * (Quad(0.25) - r) : Quad(0);
        pivot = height * (k_below + k) - (far + near) - (m == 0 ? Quad(0) : coupling * coupling / pivot);
        negative += pivot < 0 ? 1 : 0;
        coupling = -(height * k) - cross;
        k_below = k;
        far = rigid ? near : Quad(0);
    }
    return negative;
}

Quad exact(const std::vector<Body>& bodies, bool rigid, std::size_t j, Quad low, Quad high) {
    while (above(bodies, rigid, low) <= j) low /= 2;
    while (above(bodies, rigid, high) > j) high *= 2;
    while ((high - low) > Quad(1e-25) * low) {
        const Quad middle = (low + high) / 2;
        (above(bodies, rigid, middle) > j ? low : high) = middle;
    }
    return low;
}

constexpr linalg::SmallRoundings lumped{2, 0, 6, 0}, rods{6, 4, 25, 0};

/// The worst error in ulp, checked against the bounds; negative where nothing was found.
double worst_error(const std::vector<Body>& bodies, bool rigid, double tolerance) {
    const auto found = std::make_unique<linalg::SmallSpectrum>();
    if (!linalg::small_spectrum(pinned(bodies, rigid), rigid ? rods : lumped, tolerance, *found)) return -1;
    double worst = 0;
    for (std::size_t j = 0; j < bodies.size(); ++j) {
        const Quad value = found->eigenvalue[j], reach = 4 * Quad(tolerance);
        const Quad truth = exact(bodies, rigid, j, value * (1 - reach), value * (1 + reach));
        const double error = static_cast<double>(fabsq((value - truth) / truth));
        CAPTURE(j, found->eigenvalue[j]);
        REQUIRE(error <= found->bound[j]);
        REQUIRE(found->bound[j] <= tolerance);
        worst = std::max(worst, error / ulp);
    }
    return worst;
}

std::vector<Body> random_bodies(support::Random& random, std::size_t n, double spread) {
    std::vector<Body> bodies;
    for (std::size_t m = 0; m < n; ++m)
        bodies.push_back({random.log_between(1.0, spread), random.between(0.02, 0.2), random.log_between(1.0, spread)});
    return bodies;
}

}  // namespace

TEST_CASE("one and two links, by formula", "[linalg]") {
    const auto found = std::make_unique<linalg::SmallSpectrum>();
    REQUIRE(linalg::small_spectrum(pinned({{3, 0, 2}}, false), lumped, 1e-14, *found));
    CHECK_THAT(found->eigenvalue[0], Catch::Matchers::WithinULP(1.5, 1));
    // two equal plummets, k = 1 and 2: mu = 2 -+ sqrt(2)
    REQUIRE(linalg::small_spectrum(pinned({{1, 0, 1}, {1, 0, 2}}, false), lumped, 1e-14, *found));
    CHECK_THAT(found->eigenvalue[0], Catch::Matchers::WithinULP(1 / (2 - std::sqrt(2.0)), 4));
    CHECK_THAT(found->eigenvalue[1], Catch::Matchers::WithinULP(1 / (2 + std::sqrt(2.0)), 4));
}

TEST_CASE("small spectra: every eigenvalue within its bound, the bound within the tolerance", "[linalg]") {
    support::Random random(7);
    for (const bool rigid : {false, true}) {
        for (const double spread : {1.0, 4.0, 1e3, 1e6}) {
            int served = 0;
            double worst = 0;
            for (int i = 0; i < 300; ++i) {
                const std::size_t n = 1 + static_cast<std::size_t>(random() * 20);
                CAPTURE(rigid, spread, i, n);
                const double error = worst_error(random_bodies(random, n, spread), rigid, 1e-14);
                served += error >= 0 ? 1 : 0;
                worst = std::max(worst, error);
            }
            CAPTURE(rigid, spread);
            CHECK(worst <= 5);
            CHECK(served >= (spread < 1e4 ? 285 : rigid ? 80 : 275));  // as measured; the rest is refused, none wrong
        }
    }
}

TEST_CASE("small spectra of every size", "[linalg]") {
    support::Random random(8);
    for (const bool rigid : {false, true})
        for (std::size_t n : {15, 16, 17, 31, 32, 33, 48, 64, 100, 127, 128}) {
            CAPTURE(rigid, n);
            std::vector<Body> bodies = random_bodies(random, n, 1.0);
            for (std::size_t m = 0; m < n; ++m) bodies[m].stiffness = static_cast<double>(m + 1);
            const double error = worst_error(bodies, rigid, 1e-14);
            if (n <= 64) CHECK(error >= 0);
            CHECK(error <= 4);
        }
}

TEST_CASE("small spectra: what cannot be proved is refused", "[linalg]") {
    // Two equal halves that a soft spring joins: pairs a relative 1e-13 apart.
    const std::vector<Body> pairs{{1, 0, 1}, {1e-13, 0, 1e-13}, {1, 0, 1e13}, {1, 0, 1}};
    const double error = worst_error(pairs, false, 1e-14);
    CHECK(error <= 5);  // refused, or right
    const auto found = std::make_unique<linalg::SmallSpectrum>();
    const std::vector<Body> ordinary{{1, 0, 1}, {1, 0, 2}, {1, 0, 3}};
    CHECK(linalg::small_spectrum(pinned(ordinary, false), lumped, 1e-14, *found));
    CHECK_FALSE(linalg::small_spectrum(pinned(ordinary, false), lumped, 1e-15, *found));
    // A range of shifts that leaves eigenvalues out.
    auto short_range = pinned(ordinary, false);
    short_range.greatest_shift /= 4;
    CHECK_FALSE(linalg::small_spectrum(short_range, lumped, 1e-14, *found));
}
