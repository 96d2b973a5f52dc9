// SPDX-License-Identifier: MPL-2.0
#include "revchain/pencil/twisted.hpp"

#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Index;
using revchain::Vector;
using support::Quad;
using support::Truth;

namespace {

/// Largest difference of two shapes whose signs may differ (the free end's own sign is lost where it underflows).
template <class Row, class Exact>
double difference(const Row& offset, const Exact& exact) {
    Quad along = 0;
    for (Index i = 0; i < offset.size(); ++i) along += Quad(offset[i]) * Quad(*(std::begin(exact) + i));
    double worst = 0;
    for (Index i = 0; i < offset.size(); ++i) {
        const Quad value = *(std::begin(exact) + i);
        const Quad d = Quad(offset[i]) - (along < 0 ? -value : value);
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
            const auto m = revchain::modes(chain, {.count = revchain::all_modes});
            const Truth truth(chain);
            const auto assembled = revchain::assemble(chain);
            const auto pencil = revchain::pencil::rounded<double>(assembled.pencil);
            const int exponent = assembled.units.length_exponent;
            for (Index j = 0; j < m.size(); j += n < 1000 ? 1 : 97) {
                const double h = m.conical_height[j];
                const Quad exact = truth.height(j, Quad(h) * (1 - Quad(1e-15)), Quad(h) * (1 + Quad(1e-15)), 1e-28);
                const double above = j == 0 ? 1.0 : m.conical_height[j - 1] / h - 1;
                const double below = j + 1 == m.size() ? 1.0 : 1 - m.conical_height[j + 1] / h;
                const double gap = std::min({above, below, 1.0});
                const double error = difference(m.shapes().row(j), truth.shape(exact));
                const double residual = truth.residual(Quad(h), m.shapes().row(j));
                CAPTURE(family.name, n, j, gap, error, residual);
                CHECK(m.shapes().row(j).cwiseAbs().maxCoeff() == 1.0);
                CHECK(m.shapes()(j, n) == 0.0);
                CHECK(m.shapes()(j, 0) >= 0.0);
                // 2^-54 is half an ulp of what is a little below 1; chains in several units go one by one.
                CHECK(error <= (assembled.pencil.units.empty() ? 0x1p-54 * 1.001 : 3.5e-16));
                worst = std::max(worst, error);
                // The same in double alone, as a loose tolerance has it: the price of the gap to the next mode.
                if (n < 1000) {
                    const auto plain = revchain::pencil::eigenvector(pencil, std::ldexp(h, -exponent)).offset;
                    worst_plain = std::max(worst_plain, difference(plain, truth.shape(exact)) * gap);
                }
                worst_residual = std::max(worst_residual, residual);
                worst_report = std::max(worst_report, std::abs(residual - m.residual()[j]));
            }
        }
    }
    CAPTURE(worst, worst_plain, worst_residual, worst_report);
    CHECK(worst_plain <= 1.5e-15);     // measured 1.45e-15
    CHECK(worst_residual <= 9.5e-17);  // measured 9.2e-17: the offsets' own rounding
    CHECK(worst_report <= 1e-20);      // the residual reported is the residual there is
}

TEST_CASE("the Rayleigh quotient squares the error of the shape", "[linalg]") {
    const auto chain = revchain::Chain<double>::uniform_rods(50);
    const auto assembled = revchain::assemble(chain);
    const auto pencil = revchain::pencil::rounded<double>(assembled.pencil);
    const double unit = std::ldexp(1.0, assembled.units.length_exponent);
    const Truth truth(chain);
    const Quad exact = truth.height(2, 1e-3, 1.0) / unit;
    const auto vector = revchain::pencil::eigenvector(pencil, static_cast<double>(exact) * (1 + 1e-9)).offset;
    const auto quotient = revchain::pencil::rayleigh_quotient<revchain::Wide<double>>(assembled.pencil, vector);
    CHECK(static_cast<double>(fabsq(support::quad(quotient) / exact - 1)) < 1e-17);
    // and the residual of a shape that is none
    auto broken = vector;
    broken[25] += 0.01;
    CHECK(revchain::pencil::relative_residual(pencil, static_cast<double>(exact), broken) > 1e-4);
}

TEST_CASE("a shape of 1e5 links is smooth to the last pin", "[linalg]") {
    const auto chain = revchain::Chain<double>::uniform_plummets(100'000);
    const auto m = revchain::modes(chain, {.count = 3, .method = revchain::ModesMethod::bisection});
    const auto from_blocks = revchain::modes(chain, {.count = 3}, revchain::methods::all);
    CHECK(from_blocks.method == "condensed");
    const Truth truth(chain);
    for (Index j = 0; j < 3; ++j) {
        const double h = m.conical_height[j];
        const auto exact =
            truth.shape(truth.height(j, Quad(h) * (1 - Quad(1e-15)), Quad(h) * (1 + Quad(1e-15)), 1e-28));
        const double error = difference(m.shapes().row(j), exact);
        CHECK(difference(from_blocks.shapes().row(j), exact) <= 2.2e-16);  // measured 2.14e-16
        const auto assembled = revchain::assemble(chain);
        const auto plain = revchain::pencil::eigenvector(revchain::pencil::rounded<double>(assembled.pencil),
                                                         std::ldexp(h, -assembled.units.length_exponent))
                               .offset;
        const double plain_error = difference(plain, m.shapes().row(j));
        CAPTURE(j, error, plain_error);
        CHECK(plain_error <= 6e-13);
        CHECK(error <= 5.7e-17);  // measured 5.6e-17: half an ulp of the largest offset
        CHECK(m.nodes()[static_cast<std::size_t>(j)].size() == j);
    }
}

// A light bob on a heavy one: the pin that moves most is not the one that sets the mode. The truth is Lagrange's
// quadratic, and y_0 (lambda - l_1) = lambda y_1 from the moment about the upper pin of the lower thread.
TEST_CASE("two plummets of weight ratio 1e12", "[linalg]") {
    support::Random random(41);
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
        const double w1 = random.log_between(1e-6, 1e6), w2 = random.log_between(1e-6, 1e6);
        const double a1 = random.between(0.1, 1), a2 = random.between(0.1, 1);
        const auto m =
            revchain::modes(revchain::Chain<double>(std::vector{revchain::plummet(w1, a1), revchain::plummet(w2, a2)}),
                            {.count = revchain::all_modes});
        const Quad l1 = a1, l2 = a2, mu = Quad(w1) / (Quad(w1) + Quad(w2)), rest = Quad(w2) / (Quad(w1) + Quad(w2));
        const Quad first = (l1 + l2 + sqrtq((l1 - l2) * (l1 - l2) + 4 * mu * l1 * l2)) / 2;
        const Quad second = l1 * l2 * rest / first;
        for (Index j = 0; j < 2; ++j) {
            const Quad height = j == 0 ? first : second;
            // (lambda - l_1)(lambda - l_2) = mu l_1 l_2 gives lambda - l_1 without cancelling where it is small
            const Quad away = fabsq(height - l1) > fabsq(height - l2) ? height - l1 : mu * l1 * l2 / (height - l2);
            std::vector<Quad> exact{height, away, 0};
            const Quad largest = fmaxq(fabsq(exact[0]), fabsq(exact[1]));
            for (Quad& y : exact) y /= largest;
            worst = std::max(worst, difference(m.shapes().row(j), exact));
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 1.5e-16);  // measured 1.493e-16
}
