// SPDX-License-Identifier: MPL-2.0
// Springs and dashpots at pins, and free trolleys, against energies added up in rotations and quadruple precision: dense
// matrices K, C, G and M, which the library never assembles, and Newton's method on det(K + s (C - i G) + s^2 M/g).
#include "revchain/damped_modes.hpp"

#include "revchain/rig_modes.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/catch.hpp"
#include "support/damped_truth.hpp"

using namespace revchain;
using support::Quad;
using support::random_rig;
using support::Z;
using Truth = support::DampedTruth;

namespace {

/// Checks `count` rigs; returns how many modes were not proved.
struct Checked {
    Index modes = 0, unproved = 0, poor_estimates = 0;
};
Checked check(Index count, std::uint64_t seed, const support::DampedOptions& options) {
    support::Random random(seed);
    Checked result;
    for (Index k = 0; k < count; ++k) {
        const Rig rig = random_rig(random, options);
        if (!rig.is_damped()) continue;
        const DampedModes found = damped_modes(rig, {.gravity = 9.81});
        const Truth truth(rig, 9.81);
        CAPTURE(k, rig.size(), rig.support().stiffness.high, rig.support().damping.high);
        const bool drifts = rig.support().is_free() && rig.support().damping.high == 0 && !rig.has_drag();
        Index exponents = rig.support().is_free() && !drifts ? 1 : 0;
        for (Index j = 0; j < found.size(); ++j) {
            const std::complex<double> s = found.exponent[j];
            const Z exact = truth.root(s);
            const Quad off = size_of(exact - Z{s.real(), s.imag()}) / size_of(exact);
            exponents += rig.has_momentum() || s.imag() == 0 ? 1 : 2;
            ++result.modes;
            CAPTURE(j, s.real(), s.imag(), static_cast<double>(off), found.error_bound[j], found.error_estimate[j]);
            REQUIRE(off <= Quad(found.error_bound[j]));
            if (!(found.error_bound[j] < 1e-15)) ++result.unproved;
            if (off > 10 * Quad(found.error_estimate[j])) ++result.poor_estimates;
            if (j > 0 && !rig.has_momentum()) REQUIRE(std::abs(found.exponent[j - 1]) <= std::abs(s) * (1 + 1e-15));
        }
        const Index freedoms = static_cast<Index>(truth.size) - (drifts ? 1 : 0);
        if (found.complete) REQUIRE(exponents == 2 * freedoms);
        if (found.complete) REQUIRE(found.status == Status::success);
    }
    return result;
}

}  // namespace

TEST_CASE("one pendulum with a dashpot: s = -c/2 + i sqrt(g/l - c^2/4)", "[linear]") {
    const Chain<double> chain({plummet(9.81, 1.0)});
    for (const double c : {1e-12, 0.2, 3.0, 6.2}) {
        const auto m = damped_modes({chain, {.pins = {{.damping = c}}}}, {.gravity = 9.81});
        REQUIRE(m.size() == 1);
        CHECK(std::abs(m.exponent[0] - std::complex<double>(-c / 2, std::sqrt(9.81 - c * c / 4))) <= 1e-15 * 3.2);
        CHECK(m.error_bound[0] <= 1.2e-16);
        CHECK(m.complete);
        CHECK(std::abs(m.damping_ratio(0) - c / 2 / std::sqrt(9.81)) <= 4e-16);
        CHECK(std::abs(m.decay_time(0) - 2 / c) <= 4e-16 * 2 / c);
    }
    const auto m = damped_modes({chain, {.pins = {{.damping = 10}}}}, {.gravity = 9.81});  // over-damped
    REQUIRE(m.size() == 2);
    const double root = std::sqrt(25 - 9.81);
    CHECK(m.exponent[0].imag() == 0);
    CHECK(std::abs(m.exponent[0].real() - (root - 5)) <= 1e-15);
    CHECK(std::abs(m.exponent[1].real() + (root + 5)) <= 2e-15);
    CHECK(m.damping_ratio(0) == 1);
    CHECK(m.damped_frequency(1) == 0);
}

TEST_CASE("a rod with linear drag: s = -c/(2 m) + i sqrt(3 g/(2 l) - (c/(2 m))^2)", "[linear]") {
    const double m = 2, l = 1.5, g = 9.81;
    for (const double c : {1e-9, 0.6, 5.0}) {
        const auto found = damped_modes({Chain<double>({uniform_rod(m * g, l)}), {.drag = {c}}}, {.gravity = g});
        const double decay = c / (2 * m), own = 1.5 * g / l;
        REQUIRE(found.size() == 1);
        CHECK(std::abs(found.exponent[0] - std::complex<double>(-decay, std::sqrt(own - decay * decay))) <= 2e-15);
        CHECK(std::abs(found.damping_ratio(0) - decay / std::sqrt(own)) <= 4e-16);
        CHECK(found.error_bound[0] <= 1.2e-16);
    }
    // drag in proportion to mass moves every exponent by -c/(2 m) along a circle
    const Chain<double> chain = Chain<double>::uniform_rods(5, 2.0, 3.0 * g);
    const auto free = modes(Rig(chain, {}), {.count = all_modes, .gravity = g});
    const auto found = damped_modes({chain, {.drag = std::vector<Wide<double>>(5, 0.3)}}, {.gravity = g});
    for (Index j = 0; j < 5; ++j) {
        CHECK(std::abs(std::abs(found.exponent[j]) / free.forward.angular_speed[j] - 1) <= 4e-15);
        CHECK(std::abs(found.exponent[j].real() + 0.3 / (2 * 0.6)) <= 4e-15);
    }
    // a free trolley comes to rest in air, and does not drift
    const auto trolley =
        damped_modes({chain, {.support = free_trolley(1.0), .drag = std::vector<Wide<double>>(5, 0.3)}});
    CHECK(trolley.rigid == 1);
    Index exponents = 1;
    for (const auto& s : trolley.exponent) exponents += s.imag() == 0 ? 1 : 2;
    CHECK(exponents == 12);
}

TEST_CASE("random rigs with dashpots: every exponent within its bound, none missed", "[linear]") {
    const Checked plain = check(250, 1, {});
    CHECK(plain.unproved == 0);
    const Checked spinning = check(120, 2, {.momentum = true});
    CHECK(spinning.unproved * 100 <= spinning.modes);
    const Checked standing = check(120, 3, {.stands = true});
    CHECK(standing.unproved * 100 <= standing.modes);
    const Checked extreme = check(120, 4, {.extreme = true, .most = 6});
    const Checked dragged = check(250, 5, {.drag = true});
    CHECK(dragged.unproved == 0);
    for (const Checked& each : {plain, spinning, standing, extreme, dragged})
        CHECK(each.poor_estimates * 100 <= each.modes);
}

TEST_CASE("10,000 random rigs with dashpots", "[.slow]") {
    const Checked all[] = {check(5000, 11, {}), check(2000, 12, {.momentum = true}), check(2000, 13, {.stands = true}),
                           check(1000, 14, {.extreme = true})};
    for (const Checked& each : all) {
        WARN(each.modes << " modes, " << each.unproved << " without a proved bound of 1e-15, " << each.poor_estimates
                        << " estimates below a tenth of the error");
        CHECK(each.poor_estimates * 100 <= each.modes);
    }
}

TEST_CASE("10,000 random rigs with linear drag", "[.slow]") {
    const Checked all[] = {check(7000, 15, {.drag = true}),
                           check(2000, 16, {.momentum = true, .stands = true, .drag = true}),
                           check(1000, 17, {.extreme = true, .drag = true})};
    for (const Checked& each : all) {
        WARN(each.modes << " modes, " << each.unproved << " without a proved bound of 1e-15, " << each.poor_estimates
                        << " estimates below a tenth of the error");
        CHECK(each.poor_estimates * 100 <= each.modes);
    }
}

TEST_CASE("a long damped chain, whose modes are nearly dependent, is proved in two words", "[linear]") {
    const std::vector<Pin> pins(100, Pin{0.5, 0.01});
    const Rig rig(Chain<double>::uniform_rods(100, 10.0, 100.0), {.support = horizontal_spring(50, 1), .pins = pins});
    const auto m = damped_modes(rig);
    CHECK(m.complete);
    CHECK(m.error_bound.maxCoeff() <= 1e-14);
    Index exponents = 0;
    for (const auto& s : m.exponent) exponents += s.imag() == 0 ? 1 : 2;
    CHECK(exponents == 202);
}

namespace {
/// Returns how many bounds of modes with masses 1e16 apart are wider than 1e-12.
Index check_springs(int count, std::uint64_t seed) {
    Index wide = 0;
    support::Random random(seed);
    for (const bool extreme : {false, true})
        for (int k = 0; k < count; ++k) {
            const Rig rig = random_rig(random, {.damped = false, .extreme = extreme});
            if (rig.is_plain_chain()) continue;
            const RigModes found = modes(rig, {.count = all_modes, .gravity = 9.81});
            const Truth truth(rig, 9.81);
            const Index rigid = rig.support().is_free() ? 1 : 0;
            CAPTURE(k, extreme, rig.size(), found.forward.size());
            REQUIRE(found.rigid == rigid);
            REQUIRE(found.complete);
            REQUIRE(found.forward.size() == static_cast<Index>(truth.size) - rigid);
            for (Index j = 0; j < found.forward.size(); ++j) {
                const double n = found.forward.angular_speed[j];
                const Quad off = size_of(truth.root({0, n}) - Z{0, n}) / n;
                CAPTURE(j, n, static_cast<double>(off), found.forward.speed_error_bound[j]);
                REQUIRE(off <= Quad(found.forward.speed_error_bound[j]));
                if (!extreme) REQUIRE(found.forward.speed_error_bound[j] <= 3e-16);
                wide += found.forward.speed_error_bound[j] <= 1e-12 ? 0 : 1;
            }
        }
    return wide;
}
}  // namespace

TEST_CASE("springs at pins without dashpots: proved speeds and all of them", "[linear]") {
    CHECK(check_springs(200, 5) == 0);
}

TEST_CASE("10,000 random rigs with springs at pins", "[.slow]") {
    const Index wide = check_springs(5000, 15);
    WARN(wide << " bounds wider than 1e-12");
    CHECK(wide <= 10);
}

TEST_CASE("standing links on springs: growth rates and modes", "[linear]") {
    support::Random random(6);
    for (int k = 0; k < 200; ++k) {
        const Rig rig = random_rig(random, {.damped = false, .stands = true});
        const RigModes found = modes(rig, {.count = all_modes, .gravity = 9.81});
        const Truth truth(rig, 9.81);
        CAPTURE(k, rig.size());
        REQUIRE(found.complete);
        REQUIRE(found.forward.size() + found.other_available + found.rigid == static_cast<Index>(truth.size));
        for (const OtherMode& other : found.other) {
            const Quad off = size_of(truth.root({other.growth_rate, 0}) - Z{other.growth_rate, 0});
            REQUIRE(off <= Quad(4e-16) * other.growth_rate);
        }
    }
}

TEST_CASE("trolleys: a crane's load, five bobs upright on a cart, a trolley on a spring", "[linear]") {
    const double g = 9.81;
    const auto crane =
        modes(Rig(Chain<double>({plummet(4000 * g, 10.0)}), {.support = free_trolley(1000 * g)}), {.gravity = g});
    REQUIRE(crane.forward.size() == 1);
    CHECK(crane.rigid == 1);
    CHECK(crane.other_available == 0);
    CHECK(std::abs(crane.forward.angular_speed[0] - 2.2147234590) <= 5e-11);
    CHECK(crane.forward.speed_error_bound[0] <= 3e-16);
    CHECK(std::abs(crane.forward.shape(0)[0] / crane.forward.shape(0)[1] + 0.25) <= 1e-15);

    const Rig cart(Chain<double>::uniform_plummets(5, 1.0, 5 * 0.002 * g),
                   {.support = free_trolley(0.002 * g), .posture = std::vector<Posture>(5, Posture::stands)});
    const auto bobs = modes(cart, {.gravity = g});
    CHECK(bobs.forward.size() == 0);
    REQUIRE(bobs.other.size() == 5);
    // 50 digits: the matrices of the Lagrangian in rotations and the cart's offset, mpmath
    const double growth[] = {5.5013964911919557909, 10.180421418992271246, 15.038662375936563491, 20.297148443503030888,
                             26.447269336992368467};
    for (std::size_t k = 0; k < 5; ++k) CHECK(std::abs(bobs.other[k].growth_rate - growth[k]) <= 3e-16 * growth[k]);

    // 10 kg on 4 pi^2 N/m, 1 kg on 2 m: w^4 - (k/M + g/l (1 + m/M)) w^2 + k g / (M l) = 0
    const Rig sprung(Chain<double>({plummet(g, 2.0)}), {.support = horizontal_spring(4 * M_PI * M_PI, 10 * g)});
    const auto m = modes(sprung, {.gravity = g});
    REQUIRE(m.forward.size() == 2);
    CHECK(std::abs(m.forward.angular_speed[0] - 1.76156811) <= 5e-9);
    CHECK(std::abs(m.forward.angular_speed[1] - 2.49804315) <= 5e-9);
}

TEST_CASE("a heavy column buckles at w L^3 = 7.8373474 EI: Greenhill (1881); the error falls as 1/N^2", "[linear]") {
    double before = 0;
    for (const Index n : {10, 20, 40}) {
        const double a = 1.0 / static_cast<double>(n);
        double stiff = 1, soft = 0.01;
        for (int k = 0; k < 50; ++k) {
            const double EI = (stiff + soft) / 2;
            std::vector<Pin> pins(static_cast<std::size_t>(n), Pin{EI / a});
            pins.back() = Pin{2 * EI / a};
            const Rig column(
                Chain<double>::uniform_rods(n, 1.0, 1.0),
                {.posture = std::vector<Posture>(static_cast<std::size_t>(n), Posture::stands), .pins = pins});
            (modes(column, {.count = 1}).other_available == 0 ? stiff : soft) = EI;
        }
        const double error = 7.8373473864390 - 1 / stiff;
        CAPTURE(n, 1 / stiff);
        CHECK(error > 0);
        CHECK(error <= 7.8373474 * 0.0052 * 100 / static_cast<double>(n * n));
        if (before > 0) CHECK(std::abs(before / error - 4) <= 0.02);
        before = error;
    }
}

TEST_CASE("what springs, dashpots and trolleys refuse", "[linear]") {
    const Chain<double> chain({plummet(1.0, 1.0), plummet(2.0, 1.0)});
    using Catch::Matchers::Contains;
    const auto with = [&](Rigging rigging) { return Rig(chain, std::move(rigging)); };
    CHECK_THROWS_WITH(with({.pins = {{.stiffness = 1}}}),
                      Contains("pins must be empty or have one entry for each of the 2"));
    CHECK_THROWS_WITH(with({.pins = {{.stiffness = 1}, {.damping = -2}}}),
                      Contains("links[1]") && Contains("damping of the upper pin"));
    CHECK_THROWS_WITH(with({.support = {.stiffness = 0, .radius = 2}}), Contains("no radius"));
    CHECK_THROWS_WITH(with({.support = {.damping = 2}}), Contains("a firm one does not move its dashpot"));
    CHECK_THROWS_WITH(with({.support = {.stiffness = -1}}), Contains("must not be negative"));
    CHECK_THROWS_WITH(with({.drag = {1.0}}), Contains("drag must be empty or have one entry for each of the 2"));
    CHECK_THROWS_WITH(with({.drag = {1.0, -1.0}}), Contains("links[1]") && Contains("linear drag"));
    CHECK_THROWS_WITH(steady_shapes(with({.drag = {1.0, 1.0}}), {.conical_height = 0.3}),
                      Contains("linear drag: leave it out"));
    const Rig damped = with({.pins = {{.damping = 1}, {}}});
    CHECK_THROWS_WITH(modes(damped), Contains("damped_modes"));
    CHECK_THROWS_WITH(damped_modes(damped, {.first = 0}), Contains("first must be at least 1"));
    CHECK_THROWS_WITH(damped_modes(damped, {.count = 0}), Contains("count must be at least 1"));
    CHECK_THROWS_WITH(damped_modes(damped, {.gravity = -1}), Contains("gravity"));
}
