// SPDX-License-Identifier: MPL-2.0
#include "revchain/linear/assembly.hpp"

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
