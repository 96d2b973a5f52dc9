// SPDX-License-Identifier: MPL-2.0
#include "revchain/response.hpp"

#include <quadmath.h>

#include "revchain/conical_pendulum.hpp"
#include "revchain/count.hpp"
#include "revchain/linear/driven_chain.hpp"
#include "revchain/modes.hpp"
#include "revchain/pencil/forced/lanes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/quad_response.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::Response;
using support::error_over_bound;
using support::Quad;
using support::truth;

TEST_CASE("response: one plummet is Greenhill (1908) section 1 (9)", "[linear]") {
    const Chain<double> chain({revchain::plummet(3.0, 2.0)});
    const std::vector<double> heights{0.25, 1.0, 1.75, 2.5, 4.0, 1e6};
    const auto found = revchain::response(chain, {.conical_height = heights, .support_radius = 0.5});
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
            const auto found = revchain::response(chain, {.conical_height = heights});
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
            const auto modes = revchain::modes(chain, {.count = revchain::all_modes});
            std::vector<double> heights;
            for (Index k = 0; k < modes.size(); ++k)
                for (const double away : {0.0, 0x1p-52, -0x1p-51, 1e-13, -1e-10, 1e-6})
                    heights.push_back(modes.conical_height[k] * (1 + away));
            const auto found = revchain::response(chain, {.conical_height = heights});
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
    CHECK(largest_bound <= 4.2e-6);  // measured 4.15e-6, random weights and lengths; equal links 3e-9
}

TEST_CASE("response: at a resonance nothing is made up", "[linear]") {
    // two plummets of weights 1 and 3: heights 3/2 and 1/2
    const Chain<double> chain({revchain::plummet(1.0, 1.0), revchain::plummet(3.0, 1.0)});
    const auto found = revchain::response(chain, {.conical_height = {2.0, 1.5, 1.0, 0.5, 0.25}});
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
    CHECK(revchain::response(Chain<double>({revchain::plummet(1.0, 0.3)}), {.conical_height = {0.3}}).resonant[0] == 1);
}

// A plummet as long as the conical height holds its own pin still: what vibration absorbers do.
TEST_CASE("response: pins that do not move at all", "[linear]") {
    const Chain<double> two({revchain::plummet(1.0, 1.0), revchain::plummet(3.0, 1.0)});
    const auto still = revchain::response(two, {.conical_height = {1.0}});
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
        const auto found = revchain::response(chain, {.conical_height = {height}});
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
        CHECK(found.modes_below[0] == revchain::count_modes(chain, {.conical_height = height}));
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
    const auto all = revchain::response(chain, {.conical_height = heights, .support_radius = 3});
    const auto some = revchain::response(
        chain, {.conical_height = heights, .support_radius = 3, .pins = std::vector<Index>{60, 7, 0, 7}});
    const auto turned = revchain::response(chain, {.angular_speed = speeds, .support_radius = 3});
    for (Index i = 0; i < 20; ++i) {
        const double size = all.offset.row(i).cwiseAbs().maxCoeff();
        CHECK(some.offset(i, 0) == 3);
        CHECK(std::abs(some.offset(i, 1) - all.offset(i, 7)) <= 2.3e-16 * size);
        CHECK(std::abs(some.offset(i, 2) - all.offset(i, 0)) <= 2.3e-16 * size);
        CHECK(some.offset(i, 3) == some.offset(i, 1));
        CHECK(std::abs(turned.offset(i, 0) - all.offset(i, 0)) <= 1e-12 * size);  // heights were rounded
    }
    CHECK(revchain::response(chain, {.conical_height = heights, .pins = std::vector<Index>{}}).offset.cols() == 0);
    CHECK(revchain::response(chain, {}).offset.rows() == 0);
    CHECK_THROWS_AS(revchain::response(chain, {.conical_height = {1.0}, .angular_speed = {1.0}}),
                    revchain::InvalidArgument);
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
        revchain::ResponseOptions options{.support_radius = radius, .gravity = gravity};
        (speeds ? options.angular_speed : options.conical_height) = given;
        const Response found = revchain::response(chain, options);
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
        const auto found = revchain::response(chain, {.conical_height = {30.0, 5.0, 0.7, 0.05}});
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
        const auto found = revchain::response(chain, {.conical_height = {0.1 * length}, .support_radius = 1e-300});
        CHECK(error_over_bound(found, 0, truth(chain, 0.1 * length), 1e-300) <= 1);
        CHECK(found.error_bound[0] <= 1.2e-16);
    }
    // far below and far above every resonance
    const auto chain = Chain<double>::uniform_plummets(3, 3.0);
    const auto found = revchain::response(chain, {.conical_height = {1e60, 1e-60}});
    CHECK(found.offset(0, 0) == 1);
    CHECK(found.offset(1, 2) == Approx(-3e-60).epsilon(1e-15).margin(0));
    CHECK(found.modes_below[1] == 3);
}

TEST_CASE("response: wrong calls", "[linear]") {
    const auto chain = Chain<double>::uniform_plummets(3);
    for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL, 1e300}) {
        CHECK_THROWS_AS(revchain::response(chain, {.conical_height = {1.0, bad}}), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::response(chain, {.angular_speed = {bad}}), revchain::InvalidArgument);
    }
    CHECK_THROWS_AS(revchain::response(chain, {.conical_height = {1.0}, .support_radius = 0}),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::response(chain, {.conical_height = {1.0}, .pins = std::vector<Index>{4}}),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::response(chain, {.conical_height = {1.0}, .pins = std::vector<Index>{-1}}),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::response(chain, {.angular_speed = {1.0}, .gravity = -1}), revchain::InvalidArgument);
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
                driven.pencil.elements, at.data(), pins, found.data(),
                [&](std::size_t lane, std::size_t which, const revchain::Wide<double>& y) {
                    offset[lane][which] = y.high;
                });
            std::vector<double> scratch;
            revchain::pencil::sharpen<false, false, V>(driven.pencil.elements, at.data(), found.data(), scratch);
            for (std::size_t j = 0; j < together; ++j) {
                const auto exact = truth(chain, heights[j]);
                CAPTURE(family.name, heights[j]);
                if (!found[j].decided) continue;
                Quad largest = 0;
                for (const Quad& y : exact.offset) largest = fmaxq(largest, fabsq(y));
                const double bound = found[j].error_bound + 1.2e-16;
                CHECK(found[j].negative == revchain::count_modes(chain, {.conical_height = heights[j]}));
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
