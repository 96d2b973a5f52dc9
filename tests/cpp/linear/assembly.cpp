// SPDX-License-Identifier: MPL-2.0
#include "revchain/linear/assembly.hpp"

#include "revchain/linear/plain_pencil.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Index;
using support::quad;
using support::Quad;

TEST_CASE("every entry is within entry_error of the exact one", "[linear]") {
    for (const auto& family : support::families()) {
        const auto chain = family.make(50);
        const auto assembled = revchain::assemble(chain);
        const Quad weight_unit = std::ldexp(1.0, assembled.units.weight_exponent);
        const Quad length_unit = std::ldexp(1.0, assembled.units.length_exponent);
        const double bound = assembled.pencil.entry_error + 1e-32;  // of the reference
        Quad below = 0;
        for (Index m = 0; m < chain.size(); ++m) {
            const auto link = chain.link(m);
            const auto& e = assembled.pencil.elements[static_cast<std::size_t>(m)];
            const Quad W = quad(link.weight), a = quad(link.length), h = quad(link.centroid),
                       r = quad(link.gyration_ratio), g = r * a * a;
            const auto off = [](Quad got, Quad want) {
                return want == 0 ? static_cast<double>(fabsq(got)) : static_cast<double>(fabsq(got / want - 1));
            };
            CAPTURE(family.name, m);
            CHECK(off(quad(e.stiffness) * weight_unit / length_unit, (W * h + a * below) / (a * a)) <= bound);
            CHECK(off(quad(e.lower) * weight_unit, W * (h * h + g) / (a * a)) <= bound);
            CHECK(off(quad(e.upper) * weight_unit, W * ((a - h) * (a - h) + g) / (a * a)) <= bound);
            CHECK(off(quad(e.turning) * weight_unit, W * r) <= bound);
            CHECK(Quad(e.weight) * weight_unit == W);
            below += W;
        }
        CHECK(assembled.pencil.entry_error <= 1e-25);
    }
}

TEST_CASE("a link whose pendulum length is its length has a diagonal mass matrix", "[linear]") {
    // Greenhill §8, last remark: kinetically equivalent to plummets at the pins. h = 1/4, l = a = 1.
    const revchain::Chain<double> chain(std::vector{
        revchain::compound_pendulum<double>({.weight = 2, .length = 1, .centroid = 0.25, .pendulum_length = 1})});
    const auto e = revchain::assemble(chain).pencil.elements[0];
    CHECK(e.lower.high + e.upper.high == e.weight);
    CHECK(e.lower.high / e.weight == 0.25);
}

TEST_CASE("the pencil in double alone: every entry within its entry_error of that in double words", "[linear]") {
    using support::Random;
    Random random(71);
    double worst = 0;
    for (int i = 0; i < 60; ++i) {
        std::vector<revchain::Link<double>> links;
        const Index size = static_cast<Index>(random.log_between(1, 3000));
        const double wide = random.between(0, 20);
        for (Index m = 0; m < size; ++m) {
            const double W = std::exp(wide * random.between(-1, 1)), a = std::exp(random.between(-3, 3));
            links.push_back(revchain::compound_pendulum<double>({.weight = W,
                                                                 .length = a,
                                                                 .centroid = a * random.between(0, 2),
                                                                 .radius_of_gyration = a * random.between(0.01, 1)}));
        }
        const revchain::Chain<double> chain(links);
        const auto plain = revchain::plain_pencil(chain);
        REQUIRE(plain);
        const auto fine = revchain::assemble(chain).pencil;
        for (std::size_t m = 0; m < links.size(); ++m) {
            const auto& e = plain->elements[m];
            const auto& exact = fine.elements[m];
            const auto off = [&](double got, const revchain::DoubleWord<double>& want, double size_of) {
                return std::abs((want - got).high) / size_of;
            };
            double most = off(e.stiffness, exact.stiffness, e.stiffness);
            most = std::max(most, off(e.lower, exact.lower, e.lower));
            most = std::max(most, off(e.upper, exact.upper, e.upper));
            most = std::max(most, off(e.cross, exact.cross, std::abs(e.cross) + 2 * e.turning));
            most = std::max(most, off(e.turning, exact.turning, e.turning));
            worst = std::max(worst, most / plain->entry_error);
            REQUIRE(e.weight == exact.weight);
        }
        CHECK(plain->entry_error <= 3e-14);
    }
    CHECK(worst <= 1);
    CHECK(worst > 0.02);  // no idle bound
}

TEST_CASE("no pencil in double alone where one unit cannot serve, or a centroid lies above its pin", "[linear]") {
    using revchain::Chain;
    using revchain::plummet;
    CHECK_FALSE(revchain::plain_pencil(Chain<double>(std::vector{plummet(1e-200, 1.0), plummet(1e200, 1.0)})));
    CHECK_FALSE(revchain::plain_pencil(Chain<double>(
        std::vector{plummet(5.0, 1.0), revchain::compound_pendulum<double>(
                                           {.weight = 1, .length = 1, .centroid = -0.5, .radius_of_gyration = 0.5})})));
    CHECK(revchain::plain_pencil(Chain<double>(std::vector{plummet(1e-290, 1e-290)})));
}
