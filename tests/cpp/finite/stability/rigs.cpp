// SPDX-License-Identifier: MPL-2.0
// Stability of the shapes of rigs: closed forms of one link, limits, laws of damping. Any rig against Lagrange's equations
// in 60 digits: tests/python/test_rig_stability.py.
#include "revchain/modes.hpp"
#include "revchain/stability.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using Catch::Matchers::ContainsSubstring;
using revchain::Chain;
using revchain::Index;
using revchain::plummet;
using revchain::Rig;
using revchain::Stability;
using revchain::StabilityFrame;
using revchain::SteadyShape;
using revchain::Verdict;

namespace {

using Complex = std::complex<double>;

double largest(const Stability& s) {
    double size = 0;
    for (const Complex& each : s.exponents) size = std::max(size, std::abs(each));
    return size;
}

/// How far the exponents of one are from those of another that has as many or more.
double apart(const Stability& one, const Stability& other) {
    double worst = 0;
    for (const Complex& s : one.exponents) {
        double nearest = 1e300;
        for (const Complex& t : other.exponents) nearest = std::min(nearest, std::abs(s - t));
        worst = std::max(worst, nearest);
    }
    return worst / largest(one);
}

Chain<double> some_chain(support::Random& random, Index size) {
    return support::chain_of(size, [&](Index) {
        const double weight = random.log_between(0.2, 5.0), length = random.log_between(0.3, 3.0);
        return size % 2 == 0 ? revchain::uniform_rod<double>(weight, length) : plummet<double>(weight, length);
    });
}

}  // namespace

TEST_CASE("a rig with nothing added is as stable as its chain", "[finite][rig][stability]") {
    support::Random random(61);
    int shapes = 0;
    for (int i = 0; i < 20; ++i) {
        const auto chain = some_chain(random, 1 + i % 4);
        const double height = random.between(0.1, 0.6) * revchain::modes(chain, {.count = 1}).conical_height[0];
        for (const auto& shape :
             revchain::steady_shapes(chain, {.conical_height = height, .hanging_only = false}).shapes)
            for (const auto frame : {StabilityFrame::free, StabilityFrame::driven}) {
                const auto one = revchain::stability(chain, shape, frame);
                const auto other = revchain::stability(Rig(chain, {}), shape, {.frame = frame});
                CHECK(one.exponents.size() == other.exponents.size());
                CHECK(apart(one, other) <= 1e-12);
                CHECK(one.verdict == other.verdict);
                CHECK(one.negative_directions == other.negative_directions);
                ++shapes;
            }
    }
    CHECK(shapes > 60);
}

TEST_CASE("carousel of one plummet: the closed quartic", "[finite][rig][stability]") {
    const double a = 4, b = 1;
    const Rig rig(Chain<double>({plummet(800.0, a)}), {.support = revchain::carried_round(b)});
    for (const double height : {20.0, 4.0, 1.0, 0.3})
        for (const SteadyShape& shape : revchain::steady_shapes(rig, {.conical_height = height}).shapes) {
            const double c = std::cos(shape.inclination[0]);
            const double in = height / (a * c) - c * c, out = height / (a * c) - 1, sum = in + out + 4 * c * c;
            const Stability s = revchain::stability(rig, shape);
            REQUIRE(s.exponents.size() == 4);
            for (const Complex& each : s.exponents) {
                const Complex square = each * each;
                CHECK(std::abs(square * square + sum * square + in * out) <= 1e-13 * (1 + sum * sum));
            }
            const bool outwards = shape.inclination[0] > 0;
            CHECK((s.verdict == Verdict::minimum) == outwards);  // inwards the plummet falls over the axis
            CHECK(s.negative_directions == (in < 0) + (out < 0));
            const Stability driven = revchain::stability(rig, shape, {.frame = StabilityFrame::driven});
            CHECK(std::abs(driven.exponents[0] * driven.exponents[0] + in) <= 1e-13 * (1 + std::abs(in)));
        }
}

TEST_CASE("nutation of a gyrostat in steady precession, on free bearings and driven", "[finite][rig][stability]") {
    const double g = revchain::conical_pendulum::standard_gravity;
    const Chain<double> chain({revchain::uniform_rod(2.0, 1.0)});
    for (const double momentum : {0.0, 0.3, 1.0, -0.1})
        for (const double axial : {0.0, 0.05})
            for (const int direction : {1, -1}) {
                const auto turning = direction > 0 ? revchain::Rotation::forward : revchain::Rotation::backward;
                const Rig rig(chain, {.flywheels = {{momentum, axial}}});
                const double height = 0.3, n = direction * std::sqrt(g / height), A = 2.0 / 3 / g;
                for (const SteadyShape& shape :
                     revchain::steady_shapes(rig,
                                             {.conical_height = height, .hanging_only = false, .direction = turning})
                         .shapes) {
                    const double c = std::cos(shape.inclination[0]), p = momentum + axial * n * c / g;
                    const Stability s = revchain::stability(rig, shape, {.direction = turning});
                    const double square = std::pow(p / (A * n) - 2 * c, 2) + 1 - c * c;
                    CAPTURE(momentum, axial, direction, c);
                    REQUIRE(s.exponents.size() == 2);
                    CHECK(s.exponents.back().imag() == Approx(std::sqrt(square)).epsilon(1e-13));
                    CHECK(s.verdict == Verdict::minimum);
                }
            }
}

TEST_CASE("limits: no arm, a stiff spring", "[finite][rig][stability]") {
    support::Random random(62);
    for (int i = 0; i < 12; ++i) {
        const auto chain = some_chain(random, 1 + i % 3);
        const double height = random.between(0.3, 0.8) * revchain::modes(chain, {.count = 1}).conical_height[0];
        const SteadyShape whole = revchain::steady_shapes(chain, {.conical_height = height}).shapes.at(0);
        const Stability firm = revchain::stability(chain, whole);
        const auto nearest = [&](const Rig& rig) {
            for (const SteadyShape& shape : revchain::steady_shapes(rig, {.conical_height = height}).shapes)
                if ((shape.inclination - whole.inclination).norm() < 1e-3) return revchain::stability(rig, shape);
            throw std::runtime_error("no such shape");
        };
        const double arm = 1e-8 * chain.total_length();
        const Stability carried = nearest(Rig(chain, {.support = revchain::carried_round(arm)}));
        CHECK(carried.exponents.size() == firm.exponents.size() + 2);
        CHECK(apart(firm, carried) <= 1e-5);
        const double least =
            std::abs(*std::min_element(carried.exponents.begin(), carried.exponents.end(),
                                       [](const Complex& x, const Complex& y) { return std::abs(x) < std::abs(y); }));
        CHECK(least < 1e-3);  // the rotation, that an arm holds back in proportion to its length
        CHECK(least > 1e-7);
        const double stiff = 1e9 * chain.total_weight() / chain.total_length();
        const Stability sprung = nearest(Rig(chain, {.support = revchain::horizontal_spring(stiff, 1.0)}));
        CHECK(sprung.exponents.size() == firm.exponents.size() + 4);
        CHECK(apart(firm, sprung) <= 1e-6);
        CHECK(sprung.verdict == firm.verdict);
        const Stability light = nearest(Rig(chain, {.support = revchain::horizontal_spring(stiff)}));
        CHECK(light.exponents.size() == firm.exponents.size() + (i % 3 == 1 ? 4 : 2));  // rods move their pins' mass
        CHECK(apart(firm, light) <= 1e-6);
    }
}

TEST_CASE("what damping does: energies, drag in proportion to mass", "[finite][rig][stability]") {
    support::Random random(63);
    int gyroscopic = 0, minima = 0;
    for (int i = 0; i < 60; ++i) {
        const auto chain = some_chain(random, 1 + i % 5);
        revchain::Rigging with;
        if (i % 3 == 1) with.support = revchain::horizontal_spring(random.log_between(5, 500), 0.5);
        if (i % 3 == 2) with.support = revchain::carried_round(random.log_between(0.01, 1));
        const Rig rig(chain, with);
        const double height = random.between(0.05, 0.6) * revchain::modes(chain, {.count = 1}).conical_height[0];
        for (const SteadyShape& shape : revchain::steady_shapes(rig, {.conical_height = height}).shapes) {
            const Stability s = revchain::stability(rig, shape);
            REQUIRE(s.internal_damping.size() == s.exponents.size());
            REQUIRE(s.external_damping.size() == s.exponents.size());
            if (s.verdict != Verdict::minimum && s.verdict != Verdict::spectrally_stable) continue;
            Index grow = 0;
            for (const double rate : s.internal_damping) grow += rate > 0;
            CAPTURE(i, shape.half_waves, s.negative_directions);
            CHECK(grow == s.negative_directions);  // motions of negative energy, two exponents each
            ++(s.verdict == Verdict::minimum ? minima : gyroscopic);
        }
    }
    CHECK(minima > 40);
    CHECK(gyroscopic > 10);
    // rods of one density: drag goes with mass
    const auto rods = Chain<double>::uniform_rods(6, 3.0, 12.0);
    for (const SteadyShape& shape : revchain::steady_shapes(rods, {.conical_height = 0.2}).shapes)
        for (const double rate : revchain::stability(rods, shape).external_damping)
            CHECK(rate == Approx(-0.5 * 3.0 / 12.0).epsilon(1e-8));
}

TEST_CASE("one link with a dashpot at its pin: a damped oscillation in the plane", "[finite][rig][stability]") {
    // (W l^2/g) q'' + c q' + (W l^2/g) n^2 (1 + 3 cos^2 d) q = 0: out of the plane a ball joint and a support that turns
    // freely lose nothing.
    const double g = revchain::conical_pendulum::standard_gravity, height = 0.9, n = std::sqrt(g / height);
    for (const double c : {1e-6, 0.5, 3.0, 30.0}) {
        const Rig rig(Chain<double>({plummet(2.0, 1.5)}), {.pins = {{.damping = c}}});
        const auto found = revchain::steady_shapes(rig, {.conical_height = height});
        const Stability s = revchain::stability(rig, found.shapes.at(0));
        const double half = c * g / (2 * 1.5 * 1.5) / 2 / n, cosine = height / 1.5;
        const Complex root = std::sqrt(Complex(half * half - 1 - 3 * cosine * cosine));
        REQUIRE(s.exponents.size() == 2);
        CHECK(s.verdict == Verdict::minimum);
        for (const Complex& wanted : {-half + root, -half - root}) {
            const double off = std::min(std::abs(s.exponents[0] - wanted), std::abs(s.exponents[1] - wanted));
            CHECK(off <= 1e-14 * std::abs(half + std::abs(root)));
        }
    }
}

TEST_CASE("weak dashpots change exponents at the rate of `internal_damping`; they undo gyroscopic stability",
          "[finite][rig][stability]") {
    const double g = revchain::conical_pendulum::standard_gravity, height = 0.15, n = std::sqrt(g / height);
    const Chain<double> chain({plummet(1.0, 1.0), plummet(2.0, 0.7), revchain::uniform_rod(1.0, 1.2)});
    const double c = 1e-6;
    const Rig plain(chain, {}), damped(chain, {.pins = {{.damping = c}, {.damping = c}, {.damping = c}}});
    const auto shape = revchain::steady_shapes(plain, {.conical_height = height}).shapes.at(1);
    const Stability before = revchain::stability(plain, shape), after = revchain::stability(damped, shape);
    CHECK(before.verdict == Verdict::spectrally_stable);
    CHECK(after.verdict == Verdict::unstable);
    REQUIRE(before.exponents.size() == after.exponents.size());
    for (std::size_t k = 0; k < before.exponents.size(); ++k) {
        CHECK(std::abs(after.exponents[k].real() * n - before.internal_damping[k] * g * c) <= 1e-4 * std::abs(g * c));
        CHECK(std::abs(after.internal_damping[k] - before.internal_damping[k]) <= 1e-4);
        CHECK(std::abs(after.external_damping[k] - before.external_damping[k]) <= 1e-4);
        CHECK(after.exponent_error[k] <= 1e-11);
    }
    // without mass a dashpot's pin has no acceleration of its own
    const Chain<double> threads({plummet(1.0, 1.0), plummet(0.0, 0.5), plummet(2.0, 0.7)});
    const Rig light(threads, {.pins = {{}, {.damping = 0.2}, {}}}),
        other(threads, {.pins = {{.damping = 0.2}, {}, {}}});
    const auto found = revchain::steady_shapes(Rig(threads, {}), {.conical_height = 0.5}).shapes.at(0);
    CHECK(revchain::stability(light, found).exponents.size() > 0);
    CHECK_THROWS_WITH(revchain::stability(other, found), ContainsSubstring("pins must have mass"));
}

TEST_CASE("stability of rigs: refusals", "[finite][rig][stability]") {
    const Chain<double> chain({plummet(1.0, 1.0), plummet(2.0, 0.7)});
    const auto shape_of = [](const Rig& rig) {
        return revchain::steady_shapes(rig, {.conical_height = 0.3, .hanging_only = false}).shapes.at(0);
    };
    const auto refuses = [](const Rig& rig, const SteadyShape& shape, const std::string& words) {
        CHECK_THROWS_WITH(revchain::stability(rig, shape), ContainsSubstring(words));
    };
    const Rig arm(chain, {.support = revchain::carried_round(0.2)}), plain(chain, {});
    refuses(plain, shape_of(arm), "not of this rig; its upper end is at");
    refuses(Rig(Chain<double>::uniform_rods(3, 1.0, 1.0), {}), shape_of(plain), "its links number");
    const Rig wheel(chain, {.support = revchain::horizontal_spring(50.0), .flywheels = {{}, {0.1, 0.0}}});
    refuses(wheel, shape_of(wheel), "give it a carriage weight");
    CHECK_THROWS_WITH(revchain::stability(arm, shape_of(arm), {.gravity = -1}), ContainsSubstring("gravity"));
}

TEST_CASE("stability of rigs: in a fluid that turns, by the energy alone", "[finite][rig][stability]") {
    // what fluid of the same place displaces leaves a chain of the net weights, as far as the potential goes
    const Chain<double> chain({plummet(1.0, 1.0), plummet(2.0, 0.7)}), net({plummet(0.6, 1.0), plummet(1.8, 0.7)});
    const Rig turning(chain, {.fluid = revchain::Fluid::turning, .displaced = {{0.4, 1.0}, {0.2, 0.7}}});
    const auto found = revchain::steady_shapes(turning, {.conical_height = 0.15, .hanging_only = false});
    CHECK(found.shapes.size() > 2);
    Index minima = 0;
    for (const auto frame : {StabilityFrame::free, StabilityFrame::driven})
        for (const SteadyShape& shape : found.shapes) {
            const auto got = revchain::stability(turning, shape, {.frame = frame});
            CHECK(got.exponents.empty());
            CHECK((got.verdict == Verdict::minimum) == (got.negative_directions == 0));
            CHECK((got.verdict == Verdict::undecided) == std::isnan(got.growth_rate));
            const auto alike = revchain::stability(net, shape, frame);  // at constant momentum where it is free
            CHECK(got.negative_directions >= alike.negative_directions);
            if (frame == StabilityFrame::driven) CHECK(got.negative_directions == alike.negative_directions);
            minima += got.verdict == Verdict::minimum;
        }
    CHECK(minima >= 2);
}
