// SPDX-License-Identifier: MPL-2.0
#include "revchain/pencil/bisection.hpp"

#include "revchain/linear/assembly.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Index;
using support::Quad;
namespace pencil = revchain::pencil;

namespace {
const auto nothing = [](Index) {};
}

TEST_CASE("half way between", "[linalg]") {
    CHECK(pencil::between(1.0, 2.0) == 1.5);
    CHECK(pencil::between(1.0, 100.0) == 10.0);
    CHECK(pencil::between(1e-300, 1e300) == Approx(1.0));
}

TEST_CASE("brackets hold their eigenvalue, at any tolerance", "[linalg]") {
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 3, 5, 8, 9, 33}) {
            const auto chain = family.make(n);
            const auto assembled = revchain::assemble(chain);
            const auto pencil = pencil::rounded<double>(assembled.pencil);
            const double unit = std::ldexp(1.0, assembled.units.length_exponent);
            const support::Truth truth(chain);
            for (const double tolerance : {0.5, 1e-3, 1e-9, 0.0}) {
                for (const Index count : {Index(1), (n + 1) / 2, chain.mode_count()}) {
                    if (count > chain.mode_count()) continue;
                    const auto brackets = pencil::bisect(pencil, 0, count, tolerance, 1.0, nothing);
                    REQUIRE(static_cast<Index>(brackets.size()) == count);
                    for (Index j = 0; j < count; ++j) {
                        const auto& b = brackets[static_cast<std::size_t>(j)];
                        CAPTURE(family.name, n, tolerance, count, j, b.lower, b.upper);
                        CHECK(b.upper - b.lower <= std::max(tolerance, 4 * 0x1p-52) * b.lower);
                        CHECK((b.isolated || b.upper - b.lower <= 4 * 0x1p-52 * b.lower));
                        if (b.isolated && j > 0) CHECK(b.upper <= brackets[static_cast<std::size_t>(j - 1)].lower);
                        // by the truth, a few ulp wider: the counts are rounded
                        const Quad slack = 1 + Quad(64) * Quad(n) * Quad(0x1p-52);
                        CHECK(truth.above(Quad(b.lower) / slack * unit) > j);
                        CHECK(truth.above(Quad(b.upper) * slack * unit) <= j);
                    }
                }
            }
        }
    }
}

TEST_CASE("the first guess does not matter", "[linalg]") {
    const auto pencil = pencil::rounded<double>(revchain::assemble(revchain::Chain<double>::uniform_rods(6)).pencil);
    const auto expected = pencil::bisect(pencil, 0, 6, 1e-12, 1.0, nothing);
    for (const double guess : {1e-30, 1e-6, 1e6, 1e30}) {
        const auto brackets = pencil::bisect(pencil, 0, 6, 1e-12, guess, nothing);
        for (std::size_t j = 0; j < 6; ++j) CHECK(brackets[j].lower == Approx(expected[j].lower).epsilon(1e-11));
    }
}

TEST_CASE("every eigenvalue is reported done", "[linalg]") {
    const auto pencil = pencil::rounded<double>(revchain::assemble(revchain::Chain<double>::uniform_rods(50)).pencil);
    Index last = 0;
    pencil::bisect(pencil, 0, 50, 1e-6, 1.0, [&](Index done) {
        CHECK(done >= last);
        last = done;
    });
    CHECK(last == 50);
}
