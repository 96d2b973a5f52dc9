// SPDX-License-Identifier: MPL-2.0
// Steady shapes of rigs of one and two links against closed forms (support/rig_shapes.hpp).
#include "revchain/steady_shapes.hpp"

#include "revchain/conical_pendulum.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/quad_rig.hpp"
#include "support/rig_shapes.hpp"

using revchain::carried_round;
using revchain::Flywheel;
using revchain::horizontal_spring;
using support::Quad;
using support::Random;
using namespace support::rig_shapes;

TEST_CASE("one plummet on a support carried round: the closed form's one or three", "[finite][rig]") {
    Random random(1);
    double worst = 0;
    int threes = 0;
    for (int i = 0; i < 300; ++i) {
        const double l = random.log_between(0.1, 10), lambda = l * random.log_between(0.02, 3);
        const double b = l * random.log_between(1e-6, 3);
        const auto exact = revchain::carried_inclinations(l, lambda, b);
        const Chain<double> one({plummet<double>(random.log_between(0.1, 10), l)});
        const auto found = revchain::steady_shapes(Rig(one, {.support = carried_round(b)}), {.conical_height = lambda},
                                                   revchain::thorough);
        REQUIRE(found.complete);
        REQUIRE(static_cast<int>(found.shapes.size()) == exact.count);
        threes += exact.count == 3;
        std::vector<double> inclinations;
        for (const SteadyShape& shape : found.shapes) inclinations.push_back(shape.inclination[0]);
        std::sort(inclinations.begin(), inclinations.end());
        for (int j = 0; j < exact.count; ++j) {
            const auto k = static_cast<std::size_t>(j);
            worst = std::max(worst, std::abs(inclinations[k] - exact.inclination[k]));
        }
    }
    CHECK(threes > 50);
    CHECK(worst < 2e-15);  // of the closed form in double
}

TEST_CASE("a plummet under a spring: (lambda - W/E) sec d = l", "[finite][rig]") {
    Random random(2);
    double worst = 0;
    int flown = 0;
    for (int i = 0; i < 300; ++i) {
        const double l = random.log_between(0.1, 10), W = random.log_between(0.1, 10),
                     E = W / l * random.log_between(0.2, 50);
        const double lambda = l * random.log_between(0.02, 3);
        const Quad c = Quad(W) / E, cosine = (Quad(lambda) - c) / l;
        const auto found =
            revchain::steady_shapes(Rig(Chain<double>({plummet<double>(W, l)}), {.support = horizontal_spring(E)}),
                                    {.conical_height = lambda}, revchain::thorough);
        REQUIRE(found.complete);
        const bool flies = cosine > 0 && cosine < 1;
        REQUIRE(found.shapes.size() == (flies ? 1U : 0U));
        if (!flies) continue;
        ++flown;
        const Quad d = found.shapes[0].inclination[0], exact = acosq(cosine);
        CHECK(fabsq(d - exact) <= found.shapes[0].error_bound);
        worst = std::max(worst, static_cast<double>(fabsq(d - exact)));
        const double top = static_cast<double>(c * tanq(exact));
        CHECK(std::abs(found.shapes[0].offset[1] - top) <= 1e-15 * std::abs(found.shapes[0].offset[0]));
    }
    CHECK(flown > 50);
    CHECK(worst < 2.3e-16);
}

TEST_CASE("one gyrostat: (I cos d) n^2 - p n - W h = 0, a top hung up", "[finite][rig]") {
    Random random(3);
    double worst = 0;
    int inclined = 0, standing = 0;
    for (int i = 0; i < 400; ++i) {
        const double W = random.log_between(0.1, 10), a = random.log_between(0.1, 10), h = a * random.between(0.1, 1);
        const double rho = a * random.between(0.05, 1), lambda = a * random.log_between(0.05, 10);
        const int sense = random() < 0.5 ? 1 : -1;
        const Chain<double> one({revchain::compound_pendulum<double>(
            {.weight = W, .length = a, .centroid = h, .radius_of_gyration = rho})});
        const Quad n = sense * sqrtq(Quad(gravity) / lambda), g = gravity;
        const Quad rho2 = support::quad(one.link(0).gyration_ratio) * Quad(a) * a,
                   I = Quad(W) / g * (Quad(h) * h + rho2);
        // of the size of what the others are, of either sign; half of the wheels driven by a motor
        const double H = static_cast<double>(I * fabsq(n)) * random.between(-1.5, 1.5);
        const double C = i % 2 == 0 ? 0 : static_cast<double>(I * g) * random.between(0, 1.5);
        const Rig rig(one, {.flywheels = {{H, C}}});
        const Quad cosine = (Quad(H) * n + Quad(W) * h) / ((I - Quad(C) / g) * n * n);
        for (const bool hanging : {true, false}) {
            const auto found = revchain::steady_shapes(
                rig, {.conical_height = lambda, .hanging_only = hanging, .direction = turning(sense)},
                revchain::thorough);
            REQUIRE(found.complete);
            const bool there = fabsq(cosine) < 1 && (cosine > 0 || !hanging);
            REQUIRE(found.shapes.size() == (there ? 1U : 0U));
            if (!there) continue;
            const Quad d = found.shapes[0].inclination[0];
            CHECK(apart(fabsq(d), acosq(cosine)) <= found.shapes[0].error_bound);
            worst = std::max(worst, static_cast<double>(fabsq(fabsq(d) - acosq(cosine))));
            inclined += cosine > 0, standing += cosine < 0;
        }
        // the same at the speed, the sense its sign
        const double speed = static_cast<double>(n);
        const auto again =
            revchain::steady_shapes(rig, {.angular_speed = speed, .hanging_only = false}, revchain::thorough);
        if (fabsq(cosine) < 0.999)
            CHECK(again.shapes.size() ==
                  revchain::steady_shapes(
                      rig, {.conical_height = lambda, .hanging_only = false, .direction = turning(sense)},
                      revchain::thorough)
                      .shapes.size());
    }
    CHECK(inclined > 50);
    CHECK(standing > 20);
    CHECK(worst < 4.5e-16);
}

TEST_CASE("two gyrostats, hanging and standing: torques on both", "[finite][rig]") {
    Random random(4);
    Measured measured;
    long met = 0;
    for (int i = 0; i < 40; ++i) {
        const auto chain = random_chain(2, random);
        const double lambda = chain.total_length() * random.log_between(0.02, 1);
        const double size = chain.total_weight() * chain.total_length() * std::sqrt(lambda / gravity);
        const bool driven = i % 3 == 0;
        std::vector<Flywheel> wheels;
        for (int m = 0; m < 2; ++m)
            wheels.push_back(
                {size * random.between(-0.5, 0.5), driven ? chain.link(m).weight * random.between(0, 0.5) : 0});
        const Rig rig(chain, {.flywheels = wheels});
        const int sense = i % 2 == 0 ? 1 : -1;
        for (const bool hanging : {true, false}) {
            const auto found = revchain::steady_shapes(
                rig, {.conical_height = lambda, .hanging_only = hanging, .direction = turning(sense)},
                revchain::thorough);
            CAPTURE(i, hanging, found.cells);
            check_shapes(rig, lambda, found, sense, measured);
            if (!hanging) check_by_random_starts(rig, lambda, found, sense, 100, random, met);
        }
    }
    print("two gyrostats", measured);
    CHECK(measured.incomplete == 0);
    CHECK(met > 500);
    CHECK(measured.error <= 4.5e-16);
    CHECK(measured.residual <= 1e-25);
}

TEST_CASE("a compound link on a spring, at any inclination", "[finite][rig]") {
    Random random(8);
    Measured measured;
    long met = 0;
    for (int i = 0; i < 40; ++i) {
        const auto chain = random_chain(1, random);
        const double l = chain.total_length(), lambda = l * random.log_between(0.05, 2);
        const Rig rig(chain, {.support = horizontal_spring(chain.total_weight() / l * random.log_between(0.3, 100))});
        for (const bool hanging : {true, false}) {
            const auto found =
                revchain::steady_shapes(rig, {.conical_height = lambda, .hanging_only = hanging}, revchain::thorough);
            check_shapes(rig, lambda, found, 1, measured);
            if (!hanging) check_by_random_starts(rig, lambda, found, 1, 60, random, met);
        }
    }
    print("compound link on a spring", measured);
    CHECK(measured.incomplete == 0);
    CHECK(met > 200);
    CHECK(measured.error <= 4.5e-16);
}

TEST_CASE("a load under a trolley that rolls freely: the centre of mass is on the axis", "[finite][rig]") {
    const double l = 1.7;
    for (const double w : {0.1, 4.0, 300.0})
        for (const double c : {0.05, 1.0, 1e6})
            for (const double lambda : {0.01, 0.3, 1.2}) {
                // the load is at l sin d c / (c + w) from the axis: cos d = lambda (c + w) / (l c)
                const double cosine = lambda * (c + w) / (l * c);
                const auto found = revchain::steady_shapes(
                    Rig(Chain<double>({plummet<double>(w, l)}), {.support = revchain::free_trolley(c)}),
                    {.conical_height = lambda});
                CAPTURE(w, c, lambda, cosine);
                REQUIRE(found.complete);
                REQUIRE(found.shapes.size() == (cosine < 1 ? 1U : 0U));
                if (found.shapes.empty()) continue;
                const auto& shape = found.shapes[0];
                CHECK(std::abs(std::cos(shape.inclination[0]) - cosine) <= 1e-15);
                CHECK(std::abs(w * shape.offset[0] + c * shape.offset[1]) <= 1e-15 * w * std::abs(shape.offset[0]));
                CHECK(shape.half_waves == 2);
            }
}
