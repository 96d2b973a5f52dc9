// SPDX-License-Identifier: MPL-2.0
// The truth from the raw data of links, fluid, flywheels, postures and support.
#include "revchain/response.hpp"

#include <quadmath.h>

#include "revchain/conical_pendulum.hpp"
#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/quad_response.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::Rig;
using support::error_over_bound;
using support::Quad;
using support::QuadResponse;
using support::QuadSystem;

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
        const Quad kappa = W * h - B * hb + a * below + speed * support::quad(wheel.momentum);
        const Quad sign = rig.stands(m) ? -1 : 1, C = support::quad(wheel.axial_moment);
        const Quad lower = W * (h * h + rho) + moves * (hb * hb + rhob) - C;
        const Quad upper = W * ((a - h) * (a - h) + rho) + moves * ((a - hb) * (a - hb) + rhob) - C;
        const Quad cross = W * (h * (a - h) - rho) + moves * (hb * (a - hb) - rhob) + C;
        system.add(static_cast<std::size_t>(m), sign * height * kappa / (a * a), lower / (a * a), cross / (a * a),
                   upper / (a * a));
        below += W - B;
    }
    if (!firm)
        system.add(static_cast<std::size_t>(chain.size()), height * support::quad(rig.support().stiffness),
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
        const auto found =
            revchain::response(rig, {.angular_speed = speeds, .support_radius = 0.25, .gravity = gravity});
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
        const auto found =
            revchain::response(rig, {.angular_speed = speeds, .support_radius = 0.25, .gravity = gravity});
        const auto own =
            revchain::response(without, {.angular_speed = speeds, .support_radius = 0.25, .gravity = gravity});
        const auto some = revchain::response(rig, {.angular_speed = speeds,
                                                   .support_radius = 0.25,
                                                   .pins = std::vector<Index>{n, idle, 0},
                                                   .gravity = gravity});
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
        const auto found =
            revchain::response(Rig(chain, with), {.conical_height = {0.1, 1.0, 10.0}, .support_radius = 0.5});
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
    const auto bare = revchain::response(Rig(chain, {}), {.conical_height = heights});
    const auto own = revchain::response(chain, {.conical_height = heights});
    CHECK(bare.offset == own.offset);
    CHECK(bare.modes_below == own.modes_below);
    // Greenhill (1908) section 2 (7): stiffness E as a massless thread of length W/E
    const double extra = 0.375;
    const auto sprung =
        revchain::response(Rig(chain, {.support = revchain::horizontal_spring(chain.total_weight() / extra)}),
                           {.conical_height = heights});
    std::vector<revchain::Link<double>> links;
    for (Index m = 0; m < 5; ++m) links.push_back(chain.link(m));
    links.push_back(revchain::plummet(0.0, extra));
    const auto longer = revchain::response(Chain<double>(links), {.conical_height = heights});
    for (Index i = 0; i < 3; ++i)
        for (Index pin = 0; pin <= 5; ++pin)
            CHECK(sprung.offset(i, pin) == Approx(longer.offset(i, pin)).epsilon(1e-13));
    // at given heights the sense is the positive one
    revchain::Rigging wheels;
    wheels.flywheels.assign(5, {0.5, 0.0});
    const auto by_height = revchain::response(Rig(chain, wheels), {.conical_height = heights, .gravity = 2});
    const auto by_speed = revchain::response(Rig(chain, wheels), {.angular_speed = {std::sqrt(2 / 0.7)}, .gravity = 2});
    CHECK(by_height.offset(1, 0) == Approx(by_speed.offset(0, 0)).epsilon(1e-12));
}
