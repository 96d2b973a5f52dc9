// SPDX-License-Identifier: MPL-2.0
#include "revchain/pencil/spectrum/aberth.hpp"

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using support::Quad;
namespace pencil = revchain::pencil;
namespace aberth = revchain::pencil::aberth;

namespace {

constexpr double ulp = 0x1p-52;

/// A link of its own weight, centroid in the middle: half of W at either pin and X = W (1/4 - r). Where not rigid all of W
/// at its lower pin. The stiffness is free: these need not be chains.
struct Body {
    double weight, ratio, stiffness;
};

aberth::LumpedLinks lumped(const std::vector<Body>& bodies, bool rigid) {
    aberth::LumpedLinks links;
    links.size = bodies.size();
    links.rigid = rigid;
    double trace = 0, greatest = 0, hung = 0;
    for (std::size_t m = 0; m < bodies.size(); ++m) {
        const auto& [weight, r, k] = bodies[m];
        links.mass[m] = rigid ? (weight + (m == 0 ? 0 : bodies[m - 1].weight)) / 2 : weight;
        links.stiffness[m] = k;
        links.flexibility[m] = 1 / k;
        links.cross_ratio[m] = weight * (0.25 - r) / k;
        links.weight[m] = weight;
        links.lower_share[m] = links.upper_share[m] = 0.5;
        links.turn[m] = weight * r;
        hung += weight;
        trace += hung / k;
        greatest =
            std::max(greatest, rigid ? k / (weight * r) : 2 * (k + (m == 0 ? 0 : bodies[m - 1].stiffness)) / weight);
    }
    links.least_shift = 0.999 / trace;
    links.greatest_shift = 1.001 * greatest;
    links.roundings = {2, 0, 6, 0};
    if (rigid) links.roundings = {6, 4, 25, 0};
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

/// The worst error in ulp, checked against the bounds; negative where nothing was found.
double worst_error(const std::vector<Body>& bodies, bool rigid, double tolerance) {
    const auto found = std::make_unique<pencil::AberthSpectrum>();
    if (!pencil::aberth_spectrum(lumped(bodies, rigid), tolerance, *found)) return -1;
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
    const auto found = std::make_unique<pencil::AberthSpectrum>();
    REQUIRE(pencil::aberth_spectrum(lumped({{3, 0, 2}}, false), 1e-14, *found));
    CHECK_THAT(found->eigenvalue[0], Catch::Matchers::WithinULP(1.5, 1));
    // two equal plummets, k = 1 and 2: mu = 2 -+ sqrt(2)
    REQUIRE(pencil::aberth_spectrum(lumped({{1, 0, 1}, {1, 0, 2}}, false), 1e-14, *found));
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
        for (std::size_t n : {15u, 16u, 17u, 31u, 32u, 33u, 48u, 64u, 100u, 127u, 128u}) {
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
    const auto found = std::make_unique<pencil::AberthSpectrum>();
    const std::vector<Body> ordinary{{1, 0, 1}, {1, 0, 2}, {1, 0, 3}};
    CHECK(pencil::aberth_spectrum(lumped(ordinary, false), 1e-14, *found));
    CHECK_FALSE(pencil::aberth_spectrum(lumped(ordinary, false), 1e-15, *found));
    // A range of shifts that leaves eigenvalues out.
    auto short_range = lumped(ordinary, false);
    short_range.greatest_shift /= 4;
    CHECK_FALSE(pencil::aberth_spectrum(short_range, 1e-14, *found));
    // Numbers beyond 2^64, a NaN, and a polynomial that leaves the range of double.
    CHECK_FALSE(pencil::aberth_spectrum(lumped({{1, 0, 0x1p65}, {1, 0, 1}}, false), 0.5, *found));
    CHECK_FALSE(pencil::aberth_spectrum(lumped({{0x1p-65, 0, 1}, {1, 0, 1}}, false), 0.5, *found));
    for (const double mass : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 0.0}) {
        auto broken = lumped(std::vector<Body>(40, {1, 0, 1}), false);
        broken.mass[17] = mass;
        CHECK_FALSE(pencil::aberth_spectrum(broken, 0.5, *found));
    }
    std::vector<Body> steep;
    for (int m = 0; m < 128; ++m) steep.push_back({m % 2 == 0 ? 0x1p40 : 1, 0.1, m % 2 == 0 ? 1 : 0x1p40});
    for (const bool rigid : {false, true}) CHECK_FALSE(pencil::aberth_spectrum(lumped(steep, rigid), 0.5, *found));
}

TEST_CASE("small spectra: however loose the tolerance, bounds stay where their squares do not count", "[linalg]") {
    support::Random random(10);
    const auto found = std::make_unique<pencil::AberthSpectrum>();
    int served = 0;
    for (int i = 0; i < 400; ++i) {
        const std::size_t n = 1 + static_cast<std::size_t>(random() * 8);
        const std::vector<Body> bodies = random_bodies(random, n, 1e6);
        if (!pencil::aberth_spectrum(lumped(bodies, i % 2 == 0), 0.5, *found)) continue;
        ++served;
        for (std::size_t j = 0; j < n; ++j) {
            const Quad value = found->eigenvalue[j],
                       truth = exact(bodies, i % 2 == 0, j, value * Quad(0.9), value * Quad(1.1));
            REQUIRE(found->bound[j] <= 0x1p-32);
            REQUIRE(fabsq(value - truth) <= found->bound[j] * truth);
        }
    }
    CHECK(served >= 200);
}

namespace {

/// What the bounds of `solve` are about, for vectors built from exact data: the worst error of the quotient and of the
/// residual over what docs/theory/spectrum.md, "Small chains", allows, at these shifts.
template <bool rigid>
std::array<double, 2> worst_roundings(const std::vector<Body>& bodies, const aberth::LumpedLinks& links,
                                      const aberth::Four& mu) {
    const std::size_t n = links.size;
    std::vector<aberth::Four> up(n + 1), down(n + 1);
    const auto yield = [&](std::size_t m) {
        return aberth::Four(links.flexibility[m]) /
               (aberth::Four(1.0) + mu * aberth::Four(rigid ? links.cross_ratio[m] : 0.0));
    };
    aberth::Walk<rigid, false> walk;
    walk.offset = aberth::Four(1.0);
    for (std::size_t m = 0; m < n; ++m) {
        walk.pass_pin(links, m, mu, true);
        up[m] = walk.offset;
        walk.pass_link(links, m, yield(m), true);
    }
    walk = {};
    walk.force = aberth::Four(1.0);
    std::vector<double> above(n + 1);
    double square = 0, cross_ratio = 0;
    for (std::size_t m = n; m-- > 0;) {
        above[m] = above[m + 1] + links.flexibility[m];
        square += links.stiffness[m] * above[m];
        cross_ratio = rigid ? std::max(cross_ratio, links.cross_ratio[m]) : 0;
        walk.pass_link(links, m, yield(m), false);
        down[m] = walk.offset;
        walk.pass_pin(links, m, mu, false);
    }
    const auto found = aberth::quotients<rigid, false, 1>(links, above.data(), {mu})[0];
    // Data are exact but for 1/k and X/k, which `drop` counts with three more operations and the product.
    const double allowed = 0x1p-53 * ((rigid ? 18 : 15) + 2 * static_cast<double>(n - 1));
    std::array<double, 2> worst{};
    for (std::size_t i = 0; i < 4; ++i) {
        const double room = 1.01 * 0x1p-53 * (1 + mu[i] * cross_ratio) * (10 * std::sqrt(square) + (rigid ? 6 : 2));
        std::array<double, 2> best{1e300, 1e300};
        for (std::size_t t = 0; t < n; ++t) {  // which pin they were joined at is not told
            const auto y = [&](std::size_t m) {
                return m <= t ? Quad(up[m][i]) * down[t][i] : Quad(down[m][i]) * up[t][i];
            };
            Quad stiffness = 0, inertia = 0, sum = 0, residual = 0;
            for (std::size_t m = 0; m < n; ++m) {
                const Quad w = bodies[m].weight, r = bodies[m].ratio, k = bodies[m].stiffness, d = y(m) - y(m + 1);
                const Quad x = rigid ? w * (Quad(0.25) - r) : Quad(0), middle = (y(m) + y(m + 1)) / 2;
                stiffness += k * d * d;
                inertia += rigid ? w * (middle * middle + r * d * d) : w * y(m) * y(m);
                sum += mu[i] * Quad(links.mass[m]) * y(m);
                const Quad f = sum - (k + mu[i] * x) * d;
                residual += f * f / k;
            }
            const Quad quotient = inertia / stiffness;
            const double off = static_cast<double>(fabsq(Quad(found.ratio[i] / mu[i]) - quotient) / quotient);
            const double beyond = static_cast<double>(sqrtq(residual / stiffness)) - std::sqrt(found.square[i]);
            if (off / allowed + std::max(0.0, beyond / room) < best[0] + best[1])
                best = {off / allowed, std::max(0.0, beyond / room)};
        }
        for (std::size_t j = 0; j < 2; ++j) worst[j] = std::max(worst[j], best[j]);
    }
    return worst;
}

}  // namespace

TEST_CASE("small spectra: roundings of quotients and residuals against what is allowed for them", "[linalg]") {
    support::Random random(11);
    const auto found = std::make_unique<pencil::AberthSpectrum>();
    for (const bool rigid : {false, true}) {
        std::array<double, 2> worst{};
        for (int i = 0; i < 3000; ++i) {
            std::vector<Body> bodies = random_bodies(random, 1 + static_cast<std::size_t>(random() * 16), 100.0);
            for (Body& body : bodies)  // few digits, so that products with them are exact
                body.weight = std::ceil(body.weight), body.ratio = std::ceil(64 * body.ratio) / 64;
            const aberth::LumpedLinks links = lumped(bodies, rigid);
            if (!pencil::aberth_spectrum(links, 1e-13, *found)) continue;
            aberth::Four mu;
            for (std::size_t j = 0; j < 4; ++j) {
                const std::size_t mode = static_cast<std::size_t>(random() * static_cast<double>(bodies.size()));
                mu.set(j, (1 + random.log_between(1e-16, 1e-3)) / found->eigenvalue[mode]);
            }
            const auto some =
                rigid ? worst_roundings<true>(bodies, links, mu) : worst_roundings<false>(bodies, links, mu);
            for (std::size_t j = 0; j < 2; ++j) worst[j] = std::max(worst[j], some[j]);
        }
        CAPTURE(rigid, worst[0], worst[1]);
        CHECK(worst[0] <= 0.3);  // as measured; 1 is what is proved
        CHECK(worst[1] <= 0.35);
        CHECK(worst[0] >= 0.05);  // it measures something
    }
}
