// SPDX-License-Identifier: MPL-2.0
#include "revchain/linalg/twisted.hpp"

#include "revchain/linear/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Index;
using revchain::Vector;
using support::Quad;
using support::Truth;

namespace {

/// Largest difference of two shapes whose signs may differ (the free end's own sign is lost where it underflows).
template <class Row>
double difference(const Row& offset, const std::vector<Quad>& exact) {
    Quad along = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) along += Quad(offset[static_cast<Index>(i)]) * exact[i];
    double worst = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const Quad d = Quad(offset[static_cast<Index>(i)]) - (along < 0 ? -exact[i] : exact[i]);
        worst = std::max(worst, std::abs(static_cast<double>(d)));
    }
    return worst;
}

}  // namespace

// Shapes from `modes` against the quadruple-precision eigenvector, in units of the largest offset.
TEST_CASE("mode shapes", "[linalg]") {
    double worst = 0, worst_plain = 0, worst_residual = 0, worst_report = 0;
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 3, 10, 100, 1000}) {
            const auto chain = family.make(n);
            const auto m = revchain::modes(chain, {});
            const Truth truth(chain);
            const auto assembled = revchain::assemble(chain);
            const auto pencil = revchain::linalg::rounded<double>(assembled.pencil);
            const int exponent = assembled.units.length_exponent;
            for (Index j = 0; j < m.size(); j += n < 1000 ? 1 : 97) {
                const double h = m.conical_height[j];
                const Quad exact = truth.height(j, Quad(h) * (1 - Quad(1e-15)), Quad(h) * (1 + Quad(1e-15)), 1e-28);
                const double above = j == 0 ? 1.0 : m.conical_height[j - 1] / h - 1;
                const double below = j + 1 == m.size() ? 1.0 : 1 - m.conical_height[j + 1] / h;
                const double gap = std::min({above, below, 1.0});
                const double error = difference(m.shape.row(j), truth.shape(exact));
                const double residual = truth.residual(Quad(h), m.shape.row(j));
                CAPTURE(family.name, n, j, gap, error, residual);
                CHECK(m.shape.row(j).cwiseAbs().maxCoeff() == 1.0);
                CHECK(m.shape(j, n) == 0.0);
                CHECK(m.shape(j, 0) >= 0.0);
                CHECK(error <= 6e-16);  // measured 5.7e-16, N = 1000; a rounding costs 1.1e-16
                worst = std::max(worst, error);
                // The same in double alone, as a loose tolerance has it: the price of the gap to the next mode.
                if (n < 1000) {
                    Vector<double> plain = revchain::linalg::eigenvector(pencil, std::ldexp(h, -exponent));
                    revchain::detail::normalise(plain);
                    worst_plain = std::max(worst_plain, difference(plain, truth.shape(exact)) * gap);
                }
                worst_residual = std::max(worst_residual, residual);
                worst_report = std::max(worst_report, std::abs(residual - m.residual[j]));
            }
        }
    }
    CAPTURE(worst, worst_plain, worst_residual, worst_report);
    CHECK(worst_plain <= 4.1e-14);     // measured 2.4e-14 without and 4.03e-14 with FMA
    CHECK(worst_residual <= 1.1e-16);  // measured 1.02e-16: the offsets' own rounding
    CHECK(worst_report <= 1e-20);      // the residual reported is the residual there is
}

TEST_CASE("the Rayleigh quotient squares the error of the shape", "[linalg]") {
    const auto chain = revchain::Chain<double>::uniform_rods(50);
    const auto assembled = revchain::assemble(chain);
    const auto pencil = revchain::linalg::rounded<double>(assembled.pencil);
    const double unit = std::ldexp(1.0, assembled.units.length_exponent);
    const Truth truth(chain);
    const Quad exact = truth.height(2, 1e-3, 1.0) / unit;
    const auto vector = revchain::linalg::eigenvector(pencil, static_cast<double>(exact) * (1 + 1e-9));
    const auto quotient = revchain::linalg::rayleigh_quotient<revchain::Wide<double>>(assembled.pencil, vector);
    CHECK(static_cast<double>(fabsq(support::quad(quotient) / exact - 1)) < 1e-17);
    // and the residual of a shape that is none
    auto broken = vector;
    broken[25] += 0.01;
    CHECK(revchain::linalg::relative_residual(pencil, static_cast<double>(exact), broken) > 1e-4);
}

TEST_CASE("a shape of 1e5 links is smooth to the last pin", "[linalg]") {
    const auto chain = revchain::Chain<double>::uniform_plummets(100'000);
    const auto m = revchain::modes(chain, {.count = 3});
    const Truth truth(chain);
    for (Index j = 0; j < 3; ++j) {
        const double h = m.conical_height[j];
        const double error =
            difference(m.shape.row(j),
                       truth.shape(truth.height(j, Quad(h) * (1 - Quad(1e-15)), Quad(h) * (1 + Quad(1e-15)), 1e-28)));
        CAPTURE(j, error);
        CHECK(error <= 1e-16);  // measured 9e-17
        CHECK(m.nodes[static_cast<std::size_t>(j)].size() == j);
    }
}
