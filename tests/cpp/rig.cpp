// SPDX-License-Identifier: MPL-2.0
// A rigged link's numbers against energies written down body by body in quadruple precision: with the pins at offsets
// (lower, upper), the moving bodies' sum of W (y^2 + rho^2 tilt^2), less the axial moments' C tilt^2, and the bearing ones'
// rise. No formula of the library is in them.
#include "revchain/rig.hpp"

#include "revchain/system/rig_links.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using Catch::Matchers::ContainsSubstring;
using revchain::carried_round;
using revchain::Chain;
using revchain::Displaced;
using revchain::driven_flywheel;
using revchain::Fluid;
using revchain::Flywheel;
using revchain::free_flywheel;
using revchain::horizontal_spring;
using revchain::Index;
using revchain::InvalidArgument;
using revchain::plummet;
using revchain::Posture;
using revchain::Rig;
using revchain::Rigging;
using revchain::uniform_rod;
using revchain::detail::rig_links;
using support::Quad;
using support::quad;
using support::Random;

namespace {

struct Body {
    Quad bears, moves, centroid, gyration;  // gyration: radius squared
};

std::vector<Body> bodies_of(const Rig& rig, Index m) {
    const auto link = rig.chain().link(m);
    const Quad a = link.length;
    std::vector<Body> bodies{{link.weight, link.weight, link.centroid, quad(link.gyration_ratio) * a * a}};
    const Displaced fluid = rig.displaced(m);
    const bool turning = rig.fluid() == Fluid::turning;
    bodies.push_back({-Quad(fluid.weight), turning ? -Quad(fluid.weight) : Quad(fluid.added_weight), fluid.centroid,
                      quad(fluid.gyration_ratio) * a * a});
    return bodies;
}

/// Twice the energy of whirling, over n^2/g, of link m with its pins at offsets.
Quad whirling(const Rig& rig, Index m, Quad lower, Quad upper) {
    const Quad a = rig.chain().link(m).length, tilt = (lower - upper) / a;
    Quad sum = -quad(rig.flywheel(m).axial_moment) * tilt * tilt;
    for (const Body& body : bodies_of(rig, m)) {
        const Quad y = upper + body.centroid * tilt;
        sum += body.moves * (y * y + body.gyration * tilt * tilt);
    }
    return sum;
}

void check_numbers(const Rig& rig) {
    const auto units = rig.chain().units();
    const auto length = [&](auto x) { return ldexpq(quad(x), units.length_exponent); };
    const auto weight = [&](auto x) { return ldexpq(quad(x), units.weight_exponent); };
    const auto links = rig_links(rig);
    REQUIRE(static_cast<Index>(links.size()) == rig.size());
    Quad hung = 0, hung_size = 0;
    for (Index m = 0; m < rig.size(); ++m) {
        const auto& link = links[static_cast<std::size_t>(m)];
        const Quad a = rig.chain().link(m).length, C = fabsq(quad(rig.flywheel(m).axial_moment)) / (a * a);
        Quad bearing = a * hung, moment = 0, total = 0, size = C, bearing_size = a * hung_size;
        Quad weight_of_link = 0, size_of_weight = 0;
        for (const Body& body : bodies_of(rig, m)) {
            bearing += body.bears * body.centroid, bearing_size += fabsq(body.bears * body.centroid);
            moment += body.moves * body.centroid / a, total += body.moves;
            const Quad p = fabsq(body.centroid / a);
            size += fabsq(body.moves) * ((p + 1) * (p + 1) + body.gyration / (a * a));
            weight_of_link += body.bears, size_of_weight += fabsq(body.bears);
        }
        hung += weight_of_link, hung_size += size_of_weight;
        constexpr double tolerance = revchain::detail::RigLink::error_part;
        CHECK(static_cast<double>(fabsq(length(link.length) - a) / a) == 0);
        CHECK(static_cast<double>(fabsq(weight(link.tension) - bearing / a) * a / bearing_size) < tolerance);
        CHECK(static_cast<double>(fabsq(weight(link.hung) - hung) / hung_size) < tolerance);
        CHECK(static_cast<double>(fabsq(weight(link.moment) - moment) / size) < tolerance);
        CHECK(static_cast<double>(fabsq(weight(link.rest) - (total - moment)) / size) < tolerance);
        const Quad A = whirling(rig, m, 1, 0), B = whirling(rig, m, 0, 1), X = (whirling(rig, m, 1, 1) - A - B) / 2;
        CHECK(static_cast<double>(fabsq(weight(link.lower) - A) / size) < tolerance);
        CHECK(static_cast<double>(fabsq(weight(link.upper) - B) / size) < tolerance);
        CHECK(static_cast<double>(fabsq(weight(link.cross) - X) / size) < tolerance);
        const Quad spin = quad(rig.flywheel(m).momentum) / a;
        CHECK(static_cast<double>(fabsq(weight(link.spin) - spin)) <= 1e-30 * static_cast<double>(fabsq(spin)));
    }
}

Rig random_rig(Random& random, Index size) {
    const Chain<double> chain = support::chain_of(size, [&](Index) {
        const double a = random.log_between(0.1, 10);
        return revchain::compound_pendulum<double>({.weight = random.log_between(1e-3, 1e3),
                                                    .length = a,
                                                    .centroid = a * random.between(0.05, 1.4),
                                                    .radius_of_gyration = a * random.between(0, 0.6)});
    });
    Rigging with{.fluid = random() < 0.5 ? Fluid::still : Fluid::turning};
    for (Index m = 0; m < size; ++m) {
        with.posture.push_back(random() < 0.5 ? Posture::stands : Posture::hangs);
        with.flywheels.push_back({random.between(-1, 1), random() < 0.5 ? 0.0 : random.between(0, 2)});
        with.displaced.push_back(displaced_by(chain.link(m), random.between(0, 2) * chain.link(m).weight, random()));
    }
    return Rig(chain, with);
}

}  // namespace

TEST_CASE("numbers of rigged links are those of their bodies", "[rig]") {
    Random random(1);
    for (int round = 0; round < 100; ++round) check_numbers(random_rig(random, 1 + round % 7));
}

TEST_CASE("numbers of rigged links in any unit", "[rig]") {
    const auto rig = [](double kilo, double metre) {
        const Chain<double> chain({plummet(1.0 * kilo, 0.5 * metre), uniform_rod(2.0 * kilo, 1.0 * metre)});
        return Rig(chain, {.flywheels = {{0.25 * kilo * metre, 0.125 * kilo * metre * metre}, {}},
                           .displaced = {{}, displaced_by(chain.link(1), 0.5 * kilo, 0.25 * kilo)}});
    };
    const auto plain = rig_links(rig(1, 1)), scaled = rig_links(rig(0x1p300, 0x1p-200));
    for (std::size_t m = 0; m < 2; ++m) {
        CHECK(plain[m].tension == scaled[m].tension);
        CHECK(plain[m].spin == scaled[m].spin);
        CHECK(plain[m].lower == scaled[m].lower);
        CHECK(plain[m].cross == scaled[m].cross);
        CHECK(plain[m].hung == scaled[m].hung);
    }
    check_numbers(rig(1, 1));
}

TEST_CASE("a flywheel is free or driven", "[rig]") {
    const Flywheel free = free_flywheel(9.80665, 0.3, 100.0), driven = driven_flywheel(9.80665, 0.3, 100.0);
    CHECK(free.momentum.high == Approx(9.0).epsilon(1e-15));
    CHECK(free.axial_moment.high == 0);
    CHECK(driven.momentum == free.momentum);
    const Quad product = Quad(9.80665) * Quad(0.3) * Quad(0.3) * Quad(100.0) / Quad(9.80665);
    CHECK(fabsq(quad(free.momentum) / product - 1) < Quad(1e-30));
    CHECK(driven.axial_moment.high == Approx(0.8825985).epsilon(1e-15));
    CHECK_THROWS_WITH(free_flywheel(-1, 0.3, 1), ContainsSubstring("weight must be finite and not negative, got -1"));
    CHECK_THROWS_WITH(driven_flywheel(1, 0.3, std::nan("")), ContainsSubstring("spin must be finite"));
    CHECK_THROWS_WITH(free_flywheel(1, 0.3, 1, 0), ContainsSubstring("gravity must be positive"));
}

TEST_CASE("a rig refuses what cannot be", "[rig]") {
    const Chain<double> chain({plummet(1.0, 0.5), uniform_rod(2.0, 1.0)});
    const auto refused = [&](const Rigging& with, const std::string& says) {
        CHECK_THROWS_AS(Rig(chain, with), InvalidArgument);
        CHECK_THROWS_WITH(Rig(chain, with), ContainsSubstring(says));
    };
    const double infinity = std::numeric_limits<double>::infinity();
    refused({.support = {.stiffness = -1}}, "stiffness of the support must not be negative, got -1");
    refused({.support = {.carriage_weight = infinity}}, "carriage weight must be finite and not negative");
    refused({.support = {.carriage_weight = 2}},
            "the support must have a stiffness (0: it rolls freely): what moves sideways");
    refused({.support = {.radius = -1}}, "radius of the support must be finite and not negative, got -1");
    refused({.posture = {Posture::stands}}, "posture must be empty or have one entry for each of the 2 links, got 1");
    refused({.flywheels = {{}, {infinity, 0}}}, "links[1]: momentum must be finite, got inf");
    refused({.flywheels = {{0, -1}, {}}}, "links[0]: axial moment must be finite and not negative, got -1");
    refused({.displaced = {{}, {.weight = -1}}}, "links[1]: weight displaced must be finite and not negative, got -1");
    refused({.displaced = {{.centroid = std::nan("")}, {}}}, "links[0]: centre of buoyancy must be finite");
    refused({.displaced = {{.added_weight = -1}, {}}}, "links[0]: added weight must be finite and not negative");
    CHECK_THROWS_WITH(horizontal_spring(0), ContainsSubstring("stiffness must be positive"));
    CHECK_THROWS_WITH(horizontal_spring(1, -1), ContainsSubstring("carriage weight"));
    CHECK_THROWS_WITH(carried_round(infinity), ContainsSubstring("radius must be finite"));
    const Rig plain(chain, {});
    CHECK(plain.support().is_firm());
    CHECK_FALSE(plain.has_momentum());
    CHECK_FALSE(plain.stands(0));
    CHECK(plain == Rig(chain, {}));
    CHECK_FALSE(plain == Rig(chain, {.support = horizontal_spring(1)}));
}
