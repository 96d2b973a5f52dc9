// SPDX-License-Identifier: MPL-2.0
// Lists of the steady shapes of rigs: none missing, every one within its bound (support/rig_shapes.hpp).
#include "revchain/steady_shapes.hpp"

#include "revchain/conical_pendulum.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/quad_rig.hpp"
#include "support/rig_shapes.hpp"

using Catch::Matchers::ContainsSubstring;
using revchain::carried_round;
using revchain::Displaced;
using revchain::Fluid;
using revchain::Flywheel;
using revchain::horizontal_spring;
using revchain::Posture;
using revchain::Rigging;
using support::Quad;
using support::Random;
using namespace support::rig_shapes;

TEST_CASE("swing carousels of one to eight links: all roots", "[finite][rig]") {
    Random random(5);
    Measured measured;
    int scanned = 0, multiple = 0;
    for (int i = 0; i < 48; ++i) {
        const Index size = 1 + i % 8;
        const auto chain = i % 3 == 0   ? Chain<double>::uniform_plummets(size, 1.0, 1.0)
                           : i % 3 == 1 ? Chain<double>::uniform_rods(size, 1.0, 1.0)
                                        : support::chain_of(size, [&](Index) {
                                              const double W = random.log_between(0.2, 5);
                                              return plummet<double>(W, random.log_between(0.3, 3));
                                          });
        const double lambda = chain.total_length() * random.log_between(0.02, 2);
        const double b = chain.total_length() * random.log_between(1e-3, 2);
        const Rig rig(chain, {.support = carried_round(b)});
        const auto found = revchain::steady_shapes(rig, {.conical_height = lambda}, revchain::thorough);
        CAPTURE(i, size, lambda, b);
        CHECK(found.complete);
        CHECK(found.shapes.size() % 2 == 1);  // from far inwards to far outwards
        multiple += found.shapes.size() > 1;
        check_shapes(rig, lambda, found, 1, measured);
        scanned += check_by_scan(rig, lambda, found, 3000);
    }
    print("carousels", measured);
    CHECK(multiple > 20);
    CHECK(scanned > 9 * measured.shapes / 10);
    CHECK(measured.error <= 2.3e-16);
    CHECK(measured.residual <= 1e-25);
}

TEST_CASE("chains on springs, carried round or not: all roots", "[finite][rig]") {
    Random random(6);
    Measured measured;
    int scanned = 0;
    for (int i = 0; i < 60; ++i) {
        const Index size = 1 + i % 5;
        const auto chain =
            i % 2 == 0 ? Chain<double>::uniform_rods(size, 1.0, 1.0) : support::chain_of(size, [&](Index) {
                const double W = random.log_between(0.2, 5);
                return plummet<double>(W, random.log_between(0.3, 3));
            });
        const double lambda = chain.total_length() * random.log_between(0.03, 2);
        auto held = horizontal_spring(chain.total_weight() / chain.total_length() * random.log_between(0.3, 100),
                                      i % 3 == 0 ? 0 : chain.total_weight() * random.log_between(0.01, 3));
        if (i % 4 >= 2) held.radius = chain.total_length() * random.log_between(1e-2, 1);
        std::vector<Flywheel> wheels;
        if (i % 5 == 4)
            wheels.assign(
                static_cast<std::size_t>(size),
                Flywheel{0.02 * chain.total_weight() * chain.total_length() * std::sqrt(lambda / gravity), 0});
        const Rig rig(chain, {.support = held, .flywheels = wheels});
        const auto found = revchain::steady_shapes(rig, {.conical_height = lambda}, revchain::thorough);
        CAPTURE(i, size, lambda, held.stiffness.high, held.radius, held.carriage_weight);
        CHECK(found.complete);
        check_shapes(rig, lambda, found, 1, measured);
        scanned += check_by_scan(rig, lambda, found, 2000);
    }
    print("springs", measured);
    CHECK(scanned > 9 * measured.shapes / 10);
    CHECK(measured.error <= 2.3e-16);
    CHECK(measured.residual <= 1e-25);
}

TEST_CASE("rigs of every kind, in any posture: nothing missing that random starts find", "[finite][rig]") {
    Random random(7);
    Measured measured;
    long met = 0;
    for (int i = 0; i < 36; ++i) {
        const Index size = 1 + i % 3;
        const auto chain = random_chain(size, random);
        const double lambda = chain.total_length() * random.log_between(0.05, 2);
        const double weight = chain.total_weight(), length = chain.total_length();
        Rigging with;
        if (i % 2 == 0)
            with.support =
                horizontal_spring(weight / length * random.log_between(0.3, 30), random() < 0.5 ? 0 : weight);
        if (i % 3 != 0) with.support.radius = length * random.log_between(0.01, 1);
        if (i % 4 >= 2)
            for (Index m = 0; m < size; ++m)
                with.flywheels.push_back({weight * length * std::sqrt(lambda / gravity) * random.between(-0.3, 0.3),
                                          random() < 0.5 ? 0 : weight * length * length * random.between(0, 0.1)});
        with.fluid = random() < 0.5 ? Fluid::still : Fluid::turning;
        if (i % 5 >= 2)
            for (Index m = 0; m < size; ++m) {
                const auto link = chain.link(m);
                auto fluid = revchain::displaced_by(link, link.weight * random.between(0, 1.6), 0);
                if (with.fluid == Fluid::still) fluid.added_weight = fluid.weight * random.between(0, 1);
                with.displaced.push_back(fluid);
            }
        const Rig rig(chain, with);
        const int sense = random() < 0.5 ? 1 : -1;
        const auto found = revchain::steady_shapes(
            rig, {.conical_height = lambda, .hanging_only = false, .direction = turning(sense)}, revchain::thorough);
        CAPTURE(i, size, lambda, found.cells, found.shapes.size());
        check_shapes(rig, lambda, found, sense, measured);
        check_by_random_starts(rig, lambda, found, sense, 100, random, met);
    }
    print("every kind", measured);
    CHECK(measured.incomplete == 0);
    CHECK(met > 500);
    CHECK(measured.error <= 4.5e-16);
    CHECK(measured.residual <= 1e-25);
}

TEST_CASE("a rig with nothing is its chain, bit for bit; with zeros, to the last digit", "[finite][rig]") {
    Random random(9);
    for (int i = 0; i < 20; ++i) {
        const auto chain = random_chain(1 + i % 5, random);
        const double lambda = chain.total_length() * random.log_between(0.02, 0.5);
        for (const bool hanging : {true, false}) {
            if (!hanging && chain.size() > 3) continue;
            const auto want =
                revchain::steady_shapes(chain, {.conical_height = lambda, .hanging_only = hanging}, revchain::thorough);
            const auto found = revchain::steady_shapes(
                Rig(chain, {}), {.conical_height = lambda, .hanging_only = hanging}, revchain::thorough);
            REQUIRE(found.shapes.size() == want.shapes.size());
            CHECK(found.cells == want.cells);
            for (std::size_t k = 0; k < want.shapes.size(); ++k) {
                CHECK(found.shapes[k].inclination == want.shapes[k].inclination);
                CHECK(found.shapes[k].effective_energy == want.shapes[k].effective_energy);
            }
            // wheels at rest, a fluid of no weight: the same numbers by what is made for rigs
            const auto size = static_cast<std::size_t>(chain.size());
            const Rig zeros(chain,
                            {.flywheels = std::vector<Flywheel>(size), .displaced = std::vector<Displaced>(size)});
            const auto same =
                revchain::steady_shapes(zeros, {.conical_height = lambda, .hanging_only = hanging}, revchain::thorough);
            REQUIRE(same.shapes.size() == want.shapes.size());
            CHECK(same.complete == want.complete);
            for (std::size_t k = 0; k < want.shapes.size(); ++k) {
                const SteadyShape &x = same.shapes[k], &y = want.shapes[k];
                CHECK((x.inclination - y.inclination).cwiseAbs().maxCoeff() <= 2.3e-16);
                CHECK((x.tension - y.tension).cwiseAbs().maxCoeff() <= 1e-15 * y.tension.maxCoeff());
                CHECK(x.half_waves == y.half_waves);
                CHECK(x.error_bound <= 1.01 * y.error_bound + 1e-18);
            }
        }
    }
}

TEST_CASE("a support hardly off the axis: each shape twice, and the chain all but straight", "[finite][rig]") {
    Random random(10);
    for (int i = 0; i < 12; ++i) {
        const auto chain = i % 2 == 0 ? Chain<double>::uniform_plummets(1 + i % 4, 1.0, 1.0)
                                      : Chain<double>::uniform_rods(1 + i % 4, 1.0, 1.0);
        const double lambda = random.log_between(0.02, 0.9);
        const auto axis = revchain::steady_shapes(chain, {.conical_height = lambda}, revchain::thorough);
        REQUIRE(axis.complete);
        double before = 0;
        for (const double b : {1e-6, 1e-9}) {
            const auto found = revchain::steady_shapes(Rig(chain, {.support = carried_round(b)}),
                                                       {.conical_height = lambda}, revchain::thorough);
            REQUIRE(found.complete);
            REQUIRE(found.shapes.size() == 2 * axis.shapes.size() + 1);
            double worst = 0;
            int straight = 0;
            for (const SteadyShape& shape : found.shapes) {
                double nearest = shape.inclination.cwiseAbs().maxCoeff();
                bool is_straight = true;
                for (const SteadyShape& other : axis.shapes)
                    for (const int sign : {1, -1}) {
                        const double off = (shape.inclination - sign * other.inclination).cwiseAbs().maxCoeff();
                        if (off < nearest) nearest = off, is_straight = false;
                    }
                straight += is_straight;
                worst = std::max(worst, nearest);
            }
            CHECK(straight == 1);
            CHECK(worst <= 1e5 * b);
            if (before > 0) CHECK(worst <= 1.1e-3 * before);  // in proportion to b
            before = worst;
        }
        // on the axis itself, with the shape of the spring's place alone changed
        const auto none = revchain::steady_shapes(Rig(chain, {.support = carried_round(0)}), {.conical_height = lambda},
                                                  revchain::thorough);
        CHECK(none.shapes.size() == axis.shapes.size());
    }
}

TEST_CASE("floats: a cork under water stands, and whirls where the turning water does not", "[finite][rig]") {
    // One plummet lighter than water by half its weight, W - B = -W/2, moves with W: it stands, and nothing lifts it.
    const Chain<double> one({plummet<double>(1.0, 1.0)});
    const auto in = [&](double weight, double added, Fluid fluid) {
        Rigging with;
        with.fluid = fluid;
        Displaced cork = revchain::displaced_by(one.link(0), weight, added);
        with.displaced = {cork};
        return Rig(one, with);
    };
    for (const double lambda : {0.2, 0.9}) {
        // hanging: lambda (W - B)/cos d = W + added: cos d of either sign
        for (const double B : {0.5, 0.9, 1.1, 1.5}) {
            const Quad cosine = Quad(lambda) * (1 - Quad(B)) / (1 + Quad(0.5));
            const auto found = revchain::steady_shapes(
                in(B, 0.5, Fluid::still), {.conical_height = lambda, .hanging_only = false}, revchain::thorough);
            REQUIRE(found.complete);
            REQUIRE(found.shapes.size() == 1);
            CHECK(apart(found.shapes[0].inclination[0], acosq(cosine)) <= found.shapes[0].error_bound);
        }
        // turning: net weights in both
        const auto found = revchain::steady_shapes(
            in(1.5, 0, Fluid::turning), {.conical_height = lambda, .hanging_only = false}, revchain::thorough);
        REQUIRE(found.complete);
        REQUIRE(found.shapes.size() == 1);
        CHECK(apart(found.shapes[0].inclination[0], acosq(Quad(lambda))) <= found.shapes[0].error_bound);
    }
    CHECK_THROWS_WITH(revchain::steady_shapes(in(1.0, 0, Fluid::still), {.conical_height = 0.5}, revchain::thorough),
                      ContainsSubstring("effective tension"));
    CHECK_THROWS_WITH(revchain::steady_shapes(in(1.0, 0, Fluid::turning), {.conical_height = 0.5}, revchain::thorough),
                      ContainsSubstring("links[0]"));
}

TEST_CASE("a rig's own posture: a broomstick on a hanging rod, and nothing else", "[finite][rig]") {
    Random random(11);
    Measured measured;
    int stood = 0;
    for (int i = 0; i < 20; ++i) {
        const auto chain = random_chain(2, random);
        const Rig rig(chain, {.support = carried_round(0.05), .posture = {Posture::stands, Posture::hangs}});
        const double lambda = chain.total_length() * random.log_between(0.05, 1);
        const auto own = revchain::steady_shapes(rig, {.conical_height = lambda}, revchain::thorough),
                   any = revchain::steady_shapes(rig, {.conical_height = lambda, .hanging_only = false},
                                                 revchain::thorough);
        check_shapes(rig, lambda, own, 1, measured);
        std::size_t count = 0;
        for (const SteadyShape& shape : any.shapes)
            count += std::cos(shape.inclination[0]) < 0 && std::cos(shape.inclination[1]) > 0;
        CHECK(own.shapes.size() == count);
        stood += static_cast<int>(count);
    }
    CHECK(measured.incomplete == 0);
    CHECK(stood > 10);
}

TEST_CASE("bells carried round, the lowest link in the axis: met from both sides, counted once", "[finite][rig]") {
    // Link 2 carries no load and leans either way, as lambda sigma/cos d = -a X: link 1 hangs straight in the axis if the
    // support is where link 2 then ends.
    const Chain<double> chain(
        {plummet<double>(1.0, 1.0), revchain::compound_pendulum<double>(
                                        {.weight = 1.0, .length = 1.0, .centroid = 0.5, .radius_of_gyration = 1.5})});
    // sigma = 1.5, -a X = 2.25 - 0.25 = 2: cos d = lambda 0.75
    const double lambda = 0.8;
    const double b = 0.8;  // sin d = 0.8 where cos d = 0.6
    const auto found = revchain::steady_shapes(Rig(chain, {.support = carried_round(b)}),
                                               {.conical_height = lambda, .hanging_only = false}, revchain::thorough);
    CHECK(found.undecided.empty());
    CHECK_FALSE(found.complete);  // the topmost link may lean out of the plane
    Measured measured;
    const Rig rig(chain, {.support = carried_round(b)});
    check_shapes(rig, lambda, found, 1, measured);
    long met = 0;
    Random random(12);
    check_by_random_starts(rig, lambda, found, 1, 400, random, met);
    CHECK(met > 100);
    for (std::size_t i = 0; i < found.shapes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            CHECK((found.shapes[i].inclination - found.shapes[j].inclination).cwiseAbs().maxCoeff() > 1e-6);
    int in_axis = 0;
    for (const SteadyShape& shape : found.shapes) in_axis += std::abs(shape.inclination[0]) < 1e-12;
    CHECK(in_axis == 1);
}

TEST_CASE("rods on end, carried round: every list proved, and no shape in it twice", "[finite][rig]") {
    // The lowest leans so little that its box, with tangents to one side, reaches across 0.
    int lists = 0;
    for (Index size = 1; size <= 6; ++size)
        for (const double each : {0.15, 0.25, 0.3, 0.5})
            for (const double turns : {0.5, 1.0, 1.2, 1.5, 2.0})
                for (const double b : {0.01, 0.05}) {
                    const auto chain = Chain<double>::uniform_rods(size, each * static_cast<double>(size), 1.0);
                    const std::vector<Posture> stand(static_cast<std::size_t>(size), Posture::stands);
                    const Rig rig(chain, {.support = carried_round(b), .posture = stand});
                    const auto found = revchain::steady_shapes(rig, {.angular_speed = 2 * std::numbers::pi * turns},
                                                               revchain::thorough);
                    CAPTURE(size, each, turns, b);
                    CHECK(found.undecided.empty());
                    REQUIRE(!found.shapes.empty());
                    for (std::size_t i = 0; i < found.shapes.size(); ++i)
                        for (std::size_t j = 0; j < i; ++j) {
                            const auto off = found.shapes[i].inclination - found.shapes[j].inclination;
                            CHECK(off.cwiseAbs().maxCoeff() > 1e-9);
                        }
                    ++lists;
                }
    CHECK(lists == 240);
}

TEST_CASE("long carousels: outwards at rest and at speed", "[finite][rig]") {
    for (const Index size : {100, 1000}) {
        const auto chain = Chain<double>::uniform_rods(size, 1.0, 1.0);
        const Rig rig(chain, {.support = carried_round(0.5)});
        const auto found = revchain::steady_shapes(rig, {.conical_height = 2.0}, revchain::thorough);
        CHECK(found.complete);
        REQUIRE(found.shapes.size() == 1);
        CHECK(found.shapes[0].residual <= 1e-20);
        CHECK(found.shapes[0].inclination.minCoeff() > 0);
        CHECK(found.shapes[0].error_bound < 3e-16);
    }
}

TEST_CASE("what cannot be told is said", "[finite][rig]") {
    const auto chain = Chain<double>::uniform_plummets(2, 1.0, 1.0);
    // lambda E is all the weight: nothing keeps the support from running away
    for (const double radius : {0.0, 0.1}) {
        auto held = horizontal_spring(4.0);
        held.radius = radius;
        const auto found =
            revchain::steady_shapes(Rig(chain, {.support = held}), {.conical_height = 0.25}, revchain::thorough);
        CHECK_FALSE(found.complete);
        CHECK_FALSE(found.undecided.empty());
    }
    const auto poor = revchain::steady_shapes(Rig(chain, {.support = carried_round(0.1)}),
                                              {.conical_height = 0.1, .budget = 4}, revchain::thorough);
    CHECK_FALSE(poor.complete);
    // wheels against the rotation on a chain too long for boxes of all its tangents
    const Rig many(Chain<double>::uniform_rods(300, 1.0, 1.0), {.flywheels = std::vector<Flywheel>(300, {-1e-3})});
    CHECK_FALSE(revchain::steady_shapes(many, {.conical_height = 0.1}, revchain::thorough).complete);
    const Rig rig(chain, {.flywheels = {{-1.0}, {0.0}}});
    for (const double bad : {0.0, -1.0, std::nan("")}) {
        CHECK_THROWS_AS(revchain::steady_shapes(rig, {.conical_height = bad}, revchain::thorough),
                        revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::steady_shapes(rig, {.conical_height = 1.0, .gravity = bad}, revchain::thorough),
                        revchain::InvalidArgument);
    }
    CHECK_THROWS_AS(revchain::steady_shapes(rig, {.angular_speed = 0.0}, revchain::thorough),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::steady_shapes(rig, {.angular_speed = 1e-200}, revchain::thorough),
                    revchain::InvalidArgument);
    CHECK_FALSE(revchain::steady_shapes(rig, {.angular_speed = 1e200}, revchain::thorough).complete);
}
