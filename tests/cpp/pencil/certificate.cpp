// SPDX-License-Identifier: MPL-2.0
#include "revchain/pencil/certificate.hpp"

#include "revchain/linear/assembly.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Index;
using support::Quad;
namespace pencil = revchain::pencil;
using WideDouble = revchain::Wide<double>;

TEST_CASE("a wrong height or a wrong number is not certified", "[linalg]") {
    const auto chain = revchain::Chain<double>::uniform_rods(20);
    const auto assembled = revchain::assemble(chain);
    const double unit = std::ldexp(1.0, assembled.units.length_exponent);
    const support::Truth truth(chain);
    for (const Index j : {0, 1, 10, 19}) {
        const double height = static_cast<double>(truth.height(j, 1e-6, 2.0) / unit);
        const auto within = [&](Index number, double h, double margin) {
            return pencil::lies_within<WideDouble>(assembled.pencil, number, h, margin);
        };
        CHECK(within(j, height, 0x1p-51));
        CHECK(within(j, height, 1e-3));
        CHECK_FALSE(within(j + 1, height, 1e-3));
        CHECK_FALSE(within(j - 1, height, 1e-3));
        CHECK_FALSE(within(j, height * (1 + 1e-13), 1e-14));
        CHECK_FALSE(within(j, height * (1 - 1e-13), 1e-14));
        CHECK_FALSE(within(j, std::nan(""), 1e-3));
    }
}

// The road taken when the fast certificate is refused, called on purpose and from bad guesses.
TEST_CASE("bisection by proved counts from any guess", "[linalg]") {
    for (const auto& family : support::families()) {
        const auto chain = family.make(12);
        const auto assembled = revchain::assemble(chain);
        const double unit = std::ldexp(1.0, assembled.units.length_exponent);
        const support::Truth truth(chain);
        for (Index j = 0; j < chain.mode_count(); ++j) {
            for (const double off : {1.0, 1 + 1e-12, 0.5, 3.0}) {
                const Quad exact = truth.height(j, 1e-30, 1e12) / unit;
                const auto found =
                    pencil::bisect_certified<WideDouble>(assembled.pencil, j, static_cast<double>(exact) * off);
                const double error = static_cast<double>(fabsq(Quad(found.eigenvalue) / exact - 1));
                CAPTURE(family.name, j, off, found.eigenvalue, error, found.error_bound);
                CHECK(error <= found.error_bound);
                CHECK(found.error_bound <= 1.2 * 0x1p-52);
            }
        }
    }
    const auto assembled = revchain::assemble(revchain::Chain<double>::uniform_rods(5));
    CHECK(
        std::isinf(pencil::bisect_certified<WideDouble>(assembled.pencil, 5, 1e-3).error_bound));  // there is no sixth
}
