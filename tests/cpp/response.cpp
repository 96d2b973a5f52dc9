// SPDX-License-Identifier: MPL-2.0
#include "revchain/response.hpp"

#include <quadmath.h>

#include "revchain/conical_pendulum.hpp"
#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::Response;
using revchain::Rig;
using support::Quad;

namespace {

/// The truth: height K - M assembled in quadruple precision, the last pin given, solved by Gaussian elimination with
/// partial pivoting, from the chain's own numbers and by none of the library's formulas.
struct QuadResponse {
    std::vector<Quad> offset;
    Quad force = 0;  ///< the pull on what carries the last pin, times height over radius
};

struct QuadSystem {
    std::vector<Quad> diagonal, off;  ///< pins 0 ... n, off-diagonal m between m and m + 1

    explicit QuadSystem(std::size_t links) : diagonal(links + 1, 0), off(links, 0) {}
    void add(std::size_t m, Quad stiffness, Quad lower, Quad cross, Quad upper) {
        diagonal[m] += stiffness - lower, diagonal[m + 1] += stiffness - upper;
        off[m] -= stiffness + cross;
    }
    QuadResponse solve() const {
        const std::size_t n = off.size();
        // Row i: columns i ... i + 2 after interchange, and the right-hand side.
        struct Row {
            Quad a[3] = {0, 0, 0};
            Quad right = 0;
        };
        std::vector<Row> rows(n);
        const auto fresh = [&](std::size_t i) {  // before elimination: its first entry in column i - 1
            Row row;
            row.a[0] = i == 0 ? Quad(0) : off[i - 1];
            row.a[1] = diagonal[i];
            row.a[2] = i + 1 < n ? off[i] : Quad(0);
            row.right = i + 1 < n ? Quad(0) : -off[i];
            Quad size = 0;  // rows of light links count as much as those of heavy ones
            for (const Quad& x : row.a) size = fmaxq(size, fabsq(x));
            for (Quad& x : row.a) x /= size;
            row.right /= size;
            return row;
        };
        Row current = fresh(0);
        current.a[0] = current.a[1], current.a[1] = current.a[2], current.a[2] = 0;
        for (std::size_t i = 0; i + 1 < n; ++i) {
            Row below = fresh(i + 1);
            if (fabsq(below.a[0]) > fabsq(current.a[0])) std::swap(current, below);
            const Quad factor = below.a[0] / current.a[0];
            rows[i] = current;
            Row next;
            next.a[0] = below.a[1] - factor * current.a[1];
            next.a[1] = below.a[2] - factor * current.a[2];
            next.right = below.right - factor * current.right;
            current = next;
        }
        rows[n - 1] = current;
        QuadResponse result{std::vector<Quad>(n + 1), 0};
        auto& y = result.offset;
        y[n] = 1;
        for (std::size_t i = n; i-- > 0;) {
            Quad right = rows[i].right;
            if (i + 1 < n) right -= rows[i].a[1] * y[i + 1];
            if (i + 2 < n) right -= rows[i].a[2] * y[i + 2];
            y[i] = right / rows[i].a[0];
        }
        result.force = -(diagonal[n] * y[n] + off[n - 1] * y[n - 1]);
        return result;
    }
};

QuadResponse truth(const Chain<double>& chain, Quad height) {
    QuadSystem system(static_cast<std::size_t>(chain.size()));
    Quad below = 0;
    for (Index m = 0; m < chain.size(); ++m) {
        const auto link = chain.link(m);
        const Quad W = link.weight, a = link.length, h = link.centroid, turn = support::quad(link.gyration_ratio);
        const Quad p = h / a, q = (a - h) / a;
        system.add(static_cast<std::size_t>(m), height * (W * h + a * below) / (a * a), W * (p * p + turn),
                   W * (p * q - turn), W * (q * q + turn));
        below += W;
    }
    return system.solve();
}

/// Largest error of row `row`, over the largest offset and the bound.
double error_over_bound(const Response& found, Index row, const QuadResponse& exact, double radius = 1) {
    Quad largest = 0, worst = 0;
    for (const Quad& y : exact.offset) largest = fmaxq(largest, fabsq(y));
    for (std::size_t i = 0; i < found.pins.size(); ++i) {
        const Quad y = exact.offset[static_cast<std::size_t>(found.pins[i])] * Quad(radius);
        worst = fmaxq(worst, fabsq(Quad(found.offset(row, static_cast<Index>(i))) - y));
    }
    return static_cast<double>(worst / (largest * Quad(radius)) / Quad(found.error_bound[row]));
}

}  // namespace

TEST_CASE("response: one plummet is Greenhill (1908) section 1 (9)", "[linear]") {
    const Chain<double> chain({revchain::plummet(3.0, 2.0)});
    const std::vector<double> heights{0.25, 1.0, 1.75, 2.5, 4.0, 1e6};
    const auto found = revchain::response(chain, heights, {.support_radius = 0.5});
    for (Index i = 0; i < 6; ++i) {
        const double height = heights[static_cast<std::size_t>(i)];
        const double expected = 0.5 * revchain::carried_response(2.0, height);
        CAPTURE(height);
        CHECK(std::abs(found.offset(i, 0) / expected - 1) <= 2.5 * 0x1p-52);  // the closed form has 2 ulp
        CHECK(found.offset(i, 1) == 0.5);
        CHECK(found.error_bound[i] <= 1.13e-16);
        CHECK(found.modes_below[i] == (height < 2 ? 1 : 0));
        CHECK(static_cast<bool>(found.reversed[static_cast<std::size_t>(i)]) == (height < 2));
        // the plummet's centrifugal force
        CHECK(std::abs(found.support_force[i] / (3 * expected / height) - 1) <= 4 * 0x1p-52);
    }
}

TEST_CASE("response: within its bound of quadruple precision, any chain", "[linear]") {
    double worst = 0, largest_bound = 0, worst_force = 0;
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 3, 7, 40, 300}) {
            const auto chain = family.make(n);
            support::Random random(static_cast<std::uint64_t>(n));
            std::vector<double> heights;
            for (int i = 0; i < 37; ++i) heights.push_back(random.log_between(1e-5, 10.0) * chain.total_length());
            const auto found = revchain::response(chain, heights);
            const revchain::ModeCounter<double> counter(chain);
            for (Index i = 0; i < 37; ++i) {
                const double height = heights[static_cast<std::size_t>(i)];
                const auto exact = truth(chain, height);
                CAPTURE(family.name, n, height, found.error_bound[i]);
                CHECK(!found.resonant[static_cast<std::size_t>(i)]);
                const double ratio = error_over_bound(found, i, exact);
                CHECK(ratio <= 1);
                worst = std::max(worst, ratio);
                largest_bound = std::max(largest_bound, found.error_bound[i]);
                CHECK(found.modes_below[i] == counter.above_height(height));
                CHECK(static_cast<bool>(found.reversed[static_cast<std::size_t>(i)]) == (exact.offset[0] < 0));
                const Quad force = exact.force / Quad(height);
                const double off = static_cast<double>(fabsq(Quad(found.support_force[i]) - force));
                CHECK(off <= found.support_force_error[i]);
                worst_force = std::max(worst_force, found.support_force_error[i] / static_cast<double>(fabsq(force)));
            }
        }
    }
    CAPTURE(worst, largest_bound, worst_force);
    CHECK(worst > 0.5);               // half an ulp of the largest offset is all that is left of it
    CHECK(largest_bound <= 1.2e-16);  // measured 1.15e-16
    CHECK(worst_force <= 1.2e-15);    // measured 1.12e-15
}

// As near as doubles come: the response is 1e16 of the support's and has to be as good as its bound says.
TEST_CASE("response: next to resonances the bound holds", "[linear]") {
    double worst = 0, largest_bound = 0;
    Index resonances = 0;
    for (const auto& family : support::families())
        for (const Index n : {2, 3, 7, 40}) {
            const auto chain = family.make(n);
            const auto modes = revchain::modes(chain, {.shapes = false});
            std::vector<double> heights;
            for (Index k = 0; k < modes.size(); ++k)
                for (const double away : {0.0, 0x1p-52, -0x1p-51, 1e-13, -1e-10, 1e-6})
                    heights.push_back(modes.conical_height[k] * (1 + away));
            const auto found = revchain::response(chain, heights);
            for (std::size_t i = 0; i < heights.size(); ++i) {
                const auto row = static_cast<Index>(i);
                CAPTURE(family.name, n, heights[i], found.error_bound[row]);
                const auto exact = truth(chain, heights[i]);
                if (found.resonant[i] != 0) {
                    ++resonances;
                    CHECK(std::isinf(found.error_bound[row]));
                    CHECK(std::isnan(found.offset(row, 0)));
                    continue;
                }
                const double ratio = error_over_bound(found, row, exact);
                CHECK(ratio <= 1);
                worst = std::max(worst, ratio);
                largest_bound = std::max(largest_bound, found.error_bound[row]);
            }
        }
    CAPTURE(worst, largest_bound, resonances);
    CHECK(resonances <= 2);
    CHECK(largest_bound <= 4e-6);  // measured 3.4e-6, random weights and lengths; equal links 3e-9
}

TEST_CASE("response: at a resonance nothing is made up", "[linear]") {
    // two plummets of weights 1 and 3: heights 3/2 and 1/2
    const Chain<double> chain({revchain::plummet(1.0, 1.0), revchain::plummet(3.0, 1.0)});
    const auto found = revchain::response(chain, {2.0, 1.5, 1.0, 0.5, 0.25});
    CHECK(found.resonant == std::vector<char>{0, 1, 0, 1, 0});
    for (const Index i : {1, 3}) {
        CHECK(std::isinf(found.error_bound[i]));
        CHECK(std::isnan(found.offset(i, 0)));
        CHECK(found.offset(i, 2) == 1);  // carried as before
        CHECK(std::isnan(found.support_force[i]));
        CHECK(std::isinf(found.support_force_error[i]));
    }
    for (Index i = 0; i < 5; ++i)
        CHECK(found.modes_below[i] == std::vector<Index>{0, 0, 1, 1, 2}[static_cast<std::size_t>(i)]);
    CHECK(found.reversed == std::vector<char>{0, 0, 1, 0, 0});
    CHECK(revchain::response(Chain<double>({revchain::plummet(1.0, 0.3)}), {0.3}).resonant[0] == 1);
}

// A plummet as long as the conical height holds its own pin still: what vibration absorbers do.
TEST_CASE("response: pins that do not move at all", "[linear]") {
    const Chain<double> two({revchain::plummet(1.0, 1.0), revchain::plummet(3.0, 1.0)});
    const auto still = revchain::response(two, {1.0});
    CHECK(still.offset(0, 1) == 0);
    CHECK(still.offset(0, 0) == -4);  // 4 b / 1, the pull of the upper thread, on the lower one
    CHECK(still.error_bound[0] <= 1.2e-16);
    CHECK(still.reversed[0] == 1);
    support::Random random(5);
    double worst = 0;
    Index nodes = 0, resonances = 0;
    for (int i = 0; i < 3000; ++i) {
        const Index n = 2 + static_cast<Index>(random() * 5);
        const auto chain = support::chain_of(n, [&](Index) {
            const double weight = std::floor(random.between(1, 4)), a = std::floor(random.between(1, 4));
            return random() < 0.5 ? revchain::plummet(weight, a) : revchain::uniform_rod(weight, 1.5 * a);
        });
        const double height = std::floor(random.between(1, 13)) / 4;
        const auto found = revchain::response(chain, {height});
        const auto exact = truth(chain, height);
        CAPTURE(i, n, height, found.error_bound[0]);
        if (found.resonant[0] != 0) {
            ++resonances;
            CHECK(fabsq(exact.offset[0]) + fabsq(exact.offset[1]) > Quad(1e25));
            continue;
        }
        for (Index pin = 0; pin < n; ++pin) nodes += found.offset(0, pin) == 0 ? 1 : 0;
        worst = std::max(worst, error_over_bound(found, 0, exact));
        CHECK(worst <= 1);
        CHECK(found.error_bound[0] <= 1.2e-16);
        CHECK(found.modes_below[0] == revchain::count_modes(chain, height));
    }
    CHECK(nodes > 30);
    CHECK(resonances > 5);
}

TEST_CASE("response: some pins only, any radius, speeds for heights", "[linear]") {
    const auto chain = support::families()[3].make(60);
    std::vector<double> heights, speeds;
    support::Random random(9);
    for (int i = 0; i < 20; ++i) speeds.push_back(random.log_between(0.1, 20));
    for (const double n : speeds) heights.push_back(9.80665 / n / n);
    const auto all = revchain::response(chain, heights, {.support_radius = 3});
    const auto some =
        revchain::response(chain, heights, {.support_radius = 3, .pins = std::vector<Index>{60, 7, 0, 7}});
    const auto turned = revchain::response_at_speed(chain, speeds, {.support_radius = 3});
    for (Index i = 0; i < 20; ++i) {
        const double size = all.offset.row(i).cwiseAbs().maxCoeff();
        CHECK(some.offset(i, 0) == 3);
        CHECK(std::abs(some.offset(i, 1) - all.offset(i, 7)) <= 2.3e-16 * size);
        CHECK(std::abs(some.offset(i, 2) - all.offset(i, 0)) <= 2.3e-16 * size);
        CHECK(some.offset(i, 3) == some.offset(i, 1));
        CHECK(std::abs(turned.offset(i, 0) - all.offset(i, 0)) <= 1e-12 * size);  // heights were rounded
    }
    CHECK(revchain::response(chain, heights, {.pins = std::vector<Index>{}}).offset.cols() == 0);
    CHECK(revchain::response(chain, {}).offset.rows() == 0);
}

TEST_CASE("response: 100,000 random drives keep their bound, any radius", "[linear]") {
    support::Random random(77);
    double worst = 0;
    int drives = 0, beyond = 0;
    while (drives < 100'000) {
        const Index n = 1 + static_cast<Index>(6 * random() * random());
        const double length = random.log_between(1e-3, 1e3), spread = random.log_between(1.0, 1e4);
        const auto chain = support::chain_of(n, [&](Index) {
            const double a = length * random.log_between(1.0, spread), h = a * random.between(0.05, 1.0);
            if (random() < 0.3) return revchain::plummet<double>(random.log_between(1.0, spread), a);
            return revchain::compound_pendulum<double>({.weight = random.log_between(1.0, spread),
                                                        .length = a,
                                                        .centroid = h,
                                                        .radius_of_gyration = a * random.between(0.0, 0.5)});
        });
        const double radius = random.log_between(1e-6, 1e6), gravity = random.between(1.0, 25.0);
        const bool speeds = random() < 0.5;
        std::vector<double> given(100);
        for (double& x : given) {
            const double height = random.log_between(1e-3, 1e2) * chain.total_length();
            x = speeds ? std::sqrt(gravity / height) : height;
        }
        const revchain::ResponseOptions options{.support_radius = radius, .gravity = gravity};
        const Response found =
            speeds ? revchain::response_at_speed(chain, given, options) : revchain::response(chain, given, options);
        for (std::size_t i = 0; i < given.size(); ++i, ++drives) {
            const auto row = static_cast<Index>(i);
            if (found.resonant[i] != 0) continue;
            const Quad height = speeds ? Quad(gravity) / Quad(given[i]) / Quad(given[i]) : Quad(given[i]);
            const auto exact = truth(chain, height);
            const double ratio = error_over_bound(found, row, exact, radius);
            const Quad force = exact.force * Quad(radius) / height;
            beyond += ratio > 1;
            beyond +=
                static_cast<double>(fabsq(Quad(found.support_force[row]) - force)) > found.support_force_error[row];
            worst = std::max(worst, ratio);
        }
    }
    CAPTURE(worst);
    CHECK(beyond == 0);
    CHECK(worst > 0.9);
}

TEST_CASE("response: weights beyond one unit, and extremes of scale", "[linear]") {
    for (const double ratio : {1e100, 1e160}) {
        const auto chain =
            support::chain_of(12, [&](Index m) { return revchain::plummet(support::graded(m, 12, ratio), 1.0); });
        const auto found = revchain::response(chain, {30.0, 5.0, 0.7, 0.05});
        for (Index i = 0; i < 4; ++i) {
            CAPTURE(ratio, i);
            CHECK(error_over_bound(
                      found, i, truth(chain, std::vector<double>{30.0, 5.0, 0.7, 0.05}[static_cast<std::size_t>(i)])) <=
                  1);
            CHECK(found.error_bound[i] <= 1.2e-16);
        }
    }
    for (const double length : {1e-200, 1e200}) {
        const auto chain = Chain<double>::uniform_rods(5, length, 1e-150);
        const auto found = revchain::response(chain, {0.1 * length}, {.support_radius = 1e-300});
        CHECK(error_over_bound(found, 0, truth(chain, 0.1 * length), 1e-300) <= 1);
        CHECK(found.error_bound[0] <= 1.2e-16);
    }
    // far below and far above every resonance
    const auto chain = Chain<double>::uniform_plummets(3, 3.0);
    const auto found = revchain::response(chain, {1e60, 1e-60});
    CHECK(found.offset(0, 0) == 1);
    CHECK(found.offset(1, 2) == Approx(-3e-60).epsilon(1e-15).margin(0));
    CHECK(found.modes_below[1] == 3);
}

TEST_CASE("response: wrong calls", "[linear]") {
    const auto chain = Chain<double>::uniform_plummets(3);
    for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL, 1e300}) {
        CHECK_THROWS_AS(revchain::response(chain, {1.0, bad}), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::response_at_speed(chain, {bad}), revchain::InvalidArgument);
    }
    CHECK_THROWS_AS(revchain::response(chain, {1.0}, {.support_radius = 0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::response(chain, {1.0}, {.pins = std::vector<Index>{4}}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::response(chain, {1.0}, {.pins = std::vector<Index>{-1}}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::response_at_speed(chain, {1.0}, {.gravity = -1}), revchain::InvalidArgument);
}

// Rigs: the truth from the raw data of links, fluid, flywheels, postures and support.
namespace {

QuadResponse truth(const Rig& rig, Quad speed, Quad gravity) {
    const Chain<double>& chain = rig.chain();
    const Quad height = gravity / (speed * speed);
    const bool firm = rig.support().is_firm();
    QuadSystem system(static_cast<std::size_t>(chain.size()) + (firm ? 0 : 1));
    Quad below = 0;
    for (Index m = 0; m < chain.size(); ++m) {
        const auto link = chain.link(m);
        const auto fluid = rig.displaced(m);
        const auto wheel = rig.flywheel(m);
        const Quad a = link.length, W = link.weight, B = fluid.weight;
        const Quad moves = rig.fluid() == revchain::Fluid::turning ? -B : Quad(fluid.added_weight);
        const Quad h = link.centroid, hb = fluid.centroid;
        const Quad rho = support::quad(link.gyration_ratio) * a * a, rhob = support::quad(fluid.gyration_ratio) * a * a;
        const Quad kappa = W * h - B * hb + a * below + speed * Quad(wheel.momentum);
        const Quad sign = rig.stands(m) ? -1 : 1, C = wheel.axial_moment;
        const Quad lower = W * (h * h + rho) + moves * (hb * hb + rhob) - C;
        const Quad upper = W * ((a - h) * (a - h) + rho) + moves * ((a - hb) * (a - hb) + rhob) - C;
        const Quad cross = W * (h * (a - h) - rho) + moves * (hb * (a - hb) - rhob) + C;
        system.add(static_cast<std::size_t>(m), sign * height * kappa / (a * a), lower / (a * a), cross / (a * a),
                   upper / (a * a));
        below += W - B;
    }
    if (!firm)
        system.add(static_cast<std::size_t>(chain.size()), height * Quad(rig.support().stiffness),
                   Quad(rig.support().carriage_weight), 0, 0);
    return system.solve();
}

}  // namespace

TEST_CASE("response of rigs: springs, standing links, flywheels, fluids", "[linear]") {
    support::Random random(21);
    double worst = 0, largest_bound = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const Index n = 1 + static_cast<Index>(random() * 9);
        const auto chain = support::chain_of(n, [&](Index) {
            const double a = random.between(0.3, 2);
            return revchain::compound_pendulum<double>({.weight = random.log_between(0.1, 10),
                                                        .length = a,
                                                        .centroid = a * random.between(0.2, 1.2),
                                                        .radius_of_gyration = a * random.between(0, 0.6)});
        });
        revchain::Rigging with;
        if (random() < 0.5)
            with.support = revchain::horizontal_spring(random.log_between(0.1, 1e3), random.between(0, 2));
        with.fluid = random() < 0.5 ? revchain::Fluid::still : revchain::Fluid::turning;
        const bool stand = random() < 0.4, wheels = random() < 0.6, wet = random() < 0.5;
        for (Index m = 0; m < n; ++m) {
            const double a = chain.link(m).length;
            if (stand) with.posture.push_back(random() < 0.5 ? revchain::Posture::stands : revchain::Posture::hangs);
            if (wheels) with.flywheels.push_back({random.between(-3, 3), random() < 0.5 ? 0 : random.between(0, 0.3)});
            if (wet)
                with.displaced.push_back({.weight = chain.link(m).weight * random.between(0, 0.9),
                                          .centroid = a * random(),
                                          .gyration_ratio = random.between(0, 0.3),
                                          .added_weight = random()});
        }
        const Rig rig(chain, with);
        const double gravity = 3.7;
        std::vector<double> speeds;
        for (int i = 0; i < 10; ++i)
            speeds.push_back(random.log_between(0.1, 30) * (wheels && random() < 0.5 ? -1 : 1));
        const auto found = revchain::response_at_speed(rig, speeds, {.support_radius = 0.25, .gravity = gravity});
        for (Index i = 0; i < 10; ++i) {
            const Quad speed = speeds[static_cast<std::size_t>(i)];
            const auto exact = truth(rig, speed, gravity);
            CAPTURE(trial, n, speeds[static_cast<std::size_t>(i)], found.error_bound[i]);
            const double ratio = error_over_bound(found, i, exact, 0.25);
            CHECK(ratio <= 1);
            worst = std::max(worst, ratio);
            largest_bound = std::max(largest_bound, found.error_bound[i]);
            const Quad force = exact.force * (speed * speed / Quad(gravity)) * Quad(0.25);
            CHECK(static_cast<double>(fabsq(Quad(found.support_force[i]) - force)) <= found.support_force_error[i]);
        }
    }
    CHECK(largest_bound <= 1.2e-16);
}

TEST_CASE("response of rigs: lowest links that weigh nothing in a fluid that turns hang along", "[linear]") {
    support::Random random(77);
    const double gravity = 3.7;
    for (int trial = 0; trial < 200; ++trial) {
        const Index n = 1 + static_cast<Index>(random() * 6);
        const auto idle = static_cast<Index>(random() * static_cast<double>(n));  // fewer than n
        const bool stand = random() < 0.4, wheels = random() < 0.5;
        std::vector<revchain::Link<double>> links, kept;
        revchain::Rigging with{.fluid = revchain::Fluid::turning};
        if (random() < 0.5)
            with.support = revchain::horizontal_spring(random.log_between(0.1, 1e3), random.between(0, 2));
        revchain::Rigging rest = with;
        for (Index m = 0; m < n; ++m) {
            const double a = random.between(0.3, 2);
            const auto link = revchain::compound_pendulum<double>({.weight = random.log_between(0.1, 10),
                                                                   .length = a,
                                                                   .centroid = a * random.between(0.2, 1.2),
                                                                   .radius_of_gyration = a * random.between(0, 0.6)});
            const bool floats = m < idle;
            const revchain::Displaced fluid{.weight = link.weight * (floats ? 1 : random.between(0, 0.9)),
                                            .centroid = link.centroid,
                                            .gyration_ratio = link.gyration_ratio};
            const auto posture = stand && random() < 0.5 ? revchain::Posture::stands : revchain::Posture::hangs;
            const revchain::Flywheel wheel{wheels && !floats ? random.between(-3, 3) : 0.0, 0.0};
            const auto put = [&](std::vector<revchain::Link<double>>& into, revchain::Rigging& rigging) {
                into.push_back(link);
                rigging.displaced.push_back(fluid);
                rigging.posture.push_back(posture);
                rigging.flywheels.push_back(wheel);
            };
            put(links, with);
            if (!floats) put(kept, rest);
        }
        const Rig rig(Chain<double>(links), with), without(Chain<double>(kept), rest);
        std::vector<double> speeds;
        for (int i = 0; i < 10; ++i) speeds.push_back(random.log_between(0.1, 30));
        const auto found = revchain::response_at_speed(rig, speeds, {.support_radius = 0.25, .gravity = gravity});
        const auto own = revchain::response_at_speed(without, speeds, {.support_radius = 0.25, .gravity = gravity});
        const auto some = revchain::response_at_speed(
            rig, speeds, {.support_radius = 0.25, .pins = std::vector<Index>{n, idle, 0}, .gravity = gravity});
        CHECK(found.modes_below == own.modes_below);
        CHECK(found.resonant == own.resonant);
        CHECK(found.reversed == own.reversed);
        for (Index i = 0; i < 10; ++i) {
            CAPTURE(trial, n, idle, speeds[static_cast<std::size_t>(i)]);
            auto exact = truth(without, speeds[static_cast<std::size_t>(i)], gravity);
            exact.offset.insert(exact.offset.begin(), static_cast<std::size_t>(idle), exact.offset.front());
            CHECK(error_over_bound(found, i, exact, 0.25) <= 1);
            CHECK(found.error_bound[i] <= 1.2e-16);
            CHECK(std::abs(found.support_force[i] - own.support_force[i]) <=
                  found.support_force_error[i] + own.support_force_error[i]);
            CHECK(found.offset.row(i).head(idle + 1).isConstant(found.offset(i, idle), 0));
            const double size = found.offset.row(i).cwiseAbs().maxCoeff();
            for (Index column = 0; column < 3; ++column)
                CHECK(std::abs(some.offset(i, column) - found.offset(i, some.pins[static_cast<std::size_t>(column)])) <=
                      2.3e-16 * size);
        }
    }
}

TEST_CASE("response of rigs: a chain of which nothing has weight stays below what carries it", "[linear]") {
    const auto rod = revchain::uniform_rod(2.0, 1.0);
    const revchain::Displaced like{rod.weight, rod.centroid, rod.gyration_ratio, 0};
    const Chain<double> chain({rod, rod});
    for (const bool firm : {true, false}) {
        revchain::Rigging with{.fluid = revchain::Fluid::turning, .displaced = {like, like}};
        if (!firm) with.support = revchain::horizontal_spring(3.0);
        const auto found = revchain::response(Rig(chain, with), {0.1, 1.0, 10.0}, {.support_radius = 0.5});
        CAPTURE(firm);
        CHECK((found.offset.array() == 0.5).all());
        CHECK(found.error_bound.maxCoeff() <= 1.2e-16);
        CHECK(found.support_force.cwiseAbs().maxCoeff() <= found.support_force_error.maxCoeff());
        CHECK(found.support_force_error.maxCoeff() <= 1e-28);
        CHECK(found.modes_below.isZero(0));
        CHECK(found.resonant == std::vector<char>(3, 0));
    }
}

TEST_CASE("response of rigs: a plain rig is its chain, a spring is a thread more", "[linear]") {
    const auto chain = support::families()[2].make(5);
    const std::vector<double> heights{4.0, 0.7, 0.2};
    const auto bare = revchain::response(Rig(chain, {}), heights);
    const auto own = revchain::response(chain, heights);
    CHECK(bare.offset == own.offset);
    CHECK(bare.modes_below == own.modes_below);
    // Greenhill (1908) section 2 (7): stiffness E as a massless thread of length W/E
    const double extra = 0.375;
    const auto sprung =
        revchain::response(Rig(chain, {.support = revchain::horizontal_spring(chain.total_weight() / extra)}), heights);
    std::vector<revchain::Link<double>> links;
    for (Index m = 0; m < 5; ++m) links.push_back(chain.link(m));
    links.push_back(revchain::plummet(0.0, extra));
    const auto longer = revchain::response(Chain<double>(links), heights);
    for (Index i = 0; i < 3; ++i)
        for (Index pin = 0; pin <= 5; ++pin)
            CHECK(sprung.offset(i, pin) == Approx(longer.offset(i, pin)).epsilon(1e-13));
    // at given heights the sense is the positive one
    revchain::Rigging wheels;
    wheels.flywheels.assign(5, {0.5, 0.0});
    const auto by_height = revchain::response(Rig(chain, wheels), heights, {.gravity = 2});
    const auto by_speed = revchain::response_at_speed(Rig(chain, wheels), {std::sqrt(2 / 0.7)}, {.gravity = 2});
    CHECK(by_height.offset(1, 0) == Approx(by_speed.offset(0, 0)).epsilon(1e-12));
}

// Portable builds choose at run time: the narrow registers without fused operations have to be right, too.
TEST_CASE("response: registers of two doubles, products not fused", "[linear]") {
    using V = revchain::Pack<double, 2>;
    constexpr std::size_t together = revchain::pencil::driven_together<V>;
    double worst = 0;
    for (const auto& family : support::families()) {
        const auto chain = family.make(60);
        const auto driven = revchain::detail::driven_chain(chain);
        support::Random random(31);
        for (int i = 0; i < 5; ++i) {
            std::array<revchain::pencil::Driving, together> at;
            std::array<double, together> heights{};
            std::array<revchain::pencil::Driven, together> found;
            for (std::size_t j = 0; j < together; ++j) {
                heights[j] = random.log_between(1e-3, 3.0) * chain.total_length();
                at[j] = {std::ldexp(heights[j], -driven.units.length_exponent), 0.0};
            }
            revchain::pencil::DrivenPins pins{{0, 17}};
            std::array<std::array<double, 2>, together> offset{};
            revchain::pencil::driven_lanes<false, false, V>(
                driven.elements, at.data(), pins, found.data(),
                [&](std::size_t lane, std::size_t which, const revchain::Wide<double>& y) {
                    offset[lane][which] = y.high;
                });
            std::vector<double> scratch;
            revchain::pencil::sharpen<false, false, V>(driven.elements, at.data(), found.data(), scratch);
            for (std::size_t j = 0; j < together; ++j) {
                const auto exact = truth(chain, heights[j]);
                CAPTURE(family.name, heights[j]);
                if (!found[j].decided) continue;
                Quad largest = 0;
                for (const Quad& y : exact.offset) largest = fmaxq(largest, fabsq(y));
                const double bound = found[j].error_bound + 1.2e-16;
                CHECK(found[j].negative == revchain::count_modes(chain, heights[j]));
                for (const std::size_t which : {0u, 1u}) {
                    const Quad off = fabsq(Quad(offset[j][which]) - exact.offset[pins.pins[which]]) / largest;
                    CHECK(static_cast<double>(off) <= bound);
                }
                worst = std::max(worst, found[j].error_bound);
            }
        }
    }
    CHECK(worst <= 1e-17);
}
