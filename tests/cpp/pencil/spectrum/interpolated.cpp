// SPDX-License-Identifier: MPL-2.0
#include "revchain/pencil/spectrum/interpolated.hpp"

#include "revchain/linear/assembly.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Index;
using support::Quad;
namespace pencil = revchain::pencil;
namespace spectrum = revchain::pencil::spectrum;
using Wide = revchain::Wide<double>;

namespace {

constexpr double ulp = 0x1p-52;

/// Error of every `step`-th eigenvalue against quadruple precision, in ulp; each has to lie within its bound.
double worst_error(const revchain::Chain<double>& chain, Index step = 1, double tolerance = 1e-11) {
    const auto assembled = revchain::assemble(chain);
    const Index total = chain.mode_count();
    const auto found = pencil::all_eigenvalues(assembled.pencil, Index(0), total, total, tolerance);
    REQUIRE(static_cast<Index>(found.size()) == total);
    const support::Truth truth(chain);
    const Quad unit = std::ldexp(1.0, assembled.units.length_exponent);
    double worst = 0;
    for (Index j = 0; j < total; j += step) {
        const auto& c = found[static_cast<std::size_t>(j)];
        CAPTURE(j, c.eigenvalue, c.error_bound);
        REQUIRE(c.error_bound < 1e-9);
        const Quad value = Quad(c.eigenvalue), reach = 1000 * Quad(c.error_bound);
        const Quad exact = truth.height(j, value * (1 - reach) * unit, value * (1 + reach) * unit, 1e-21) / unit;
        const double error = static_cast<double>(fabsq((value - exact) / exact));
        REQUIRE(error <= c.error_bound);
        worst = std::max(worst, error / ulp);
    }
    return worst;
}

revchain::Chain<double> random_chain(support::Random& random, Index n) {
    const double spread = std::pow(10.0, random.between(0.0, 6.0));
    const bool plummets = random() < 0.4;
    return support::chain_of(n, [&](Index) {
        const double a = random.log_between(1.0, std::sqrt(spread)), weight = random.log_between(1.0, spread);
        if (plummets) return revchain::plummet<double>(weight, a);
        if (random() < 0.5) return revchain::uniform_rod<double>(weight, a);
        return revchain::compound_pendulum<double>({.weight = weight,
                                                    .length = a,
                                                    .centroid = a * random.between(0.05, 1.0),
                                                    .radius_of_gyration = a * random.between(0.0, 0.4)});
    });
}

}  // namespace

TEST_CASE("all eigenvalues of every kind of chain", "[linalg]") {
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 3, 5, 17, 64, 200}) {
            CAPTURE(family.name, n);
            CHECK(worst_error(family.make(n), n > 100 ? 7 : 1) <= 4);
        }
    }
}

TEST_CASE("every eigenvalue of long chains", "[linalg]") {
    for (std::size_t family = 0; family < 4; ++family) {
        CAPTURE(family);
        CHECK(worst_error(support::families()[family].make(2000), 37) <= 4);
    }
}

TEST_CASE("random chains: no eigenvalue missed, none outside its bound", "[linalg]") {
    support::Random random(2026);
    for (int i = 0; i < 400; ++i) {
        const Index n = 2 + static_cast<Index>(random() * 24);
        CAPTURE(i, n);
        CHECK(worst_error(random_chain(random, n), 1, 128 * ulp) <= 6);
    }
}

TEST_CASE("a range gives what all give", "[linalg]") {
    for (std::size_t family = 0; family < 6; ++family) {
        const auto chain = support::families()[family].make(300);
        const auto assembled = revchain::assemble(chain);
        const auto all = pencil::all_eigenvalues(assembled.pencil, Index(0), Index(300), Index(300), 1e-11);
        for (const auto& [first, last] : {std::pair<Index, Index>{0, 1}, {0, 60}, {37, 140}, {250, 300}, {299, 300}}) {
            const auto some = pencil::all_eigenvalues(assembled.pencil, first, last, Index(300), 1e-11);
            REQUIRE(static_cast<Index>(some.size()) == last - first);
            for (Index j = first; j < last; ++j) {
                const auto &a = all[static_cast<std::size_t>(j)], &b = some[static_cast<std::size_t>(j - first)];
                CAPTURE(family, first, last, j);
                CHECK(std::abs(a.eigenvalue - b.eigenvalue) <= (a.error_bound + b.error_bound) * a.eigenvalue);
            }
        }
        CHECK(pencil::all_eigenvalues(assembled.pencil, Index(5), Index(5), Index(300), 1e-11).empty());
    }
}

TEST_CASE("pairs of nearly equal eigenvalues", "[linalg]") {
    // Two equal stretches between weights that hardly move: every mode of one has a twin in the other.
    for (const double heavy : {1e3, 1e6, 1e9, 1e13}) {
        pencil::ElementPencil<Wide> pencil;
        const auto add = [&](double k, double weight) {  // plummets, but with a tension of our choosing
            pencil.elements.push_back({Wide(k), Wide(weight), Wide(0.0), Wide(0.0), Wide(0.0), weight});
        };
        for (int stretch = 0; stretch < 2; ++stretch) {
            add(1.0, heavy);
            for (int i = 0; i < 20; ++i) add(1.0, 1.0);
        }
        pencil.entry_error = 1e-31;
        const Index n = pencil.size();
        const auto found = pencil::all_eigenvalues(pencil, Index(0), n, n, 1e-11);
        for (Index j = 0; j < n; ++j) {
            const auto& c = found[static_cast<std::size_t>(j)];
            const auto sure = pencil::bisect_certified<Wide>(pencil, j, c.eigenvalue);
            CAPTURE(heavy, j, c.eigenvalue, c.error_bound, sure.eigenvalue, sure.error_bound);
            CHECK(std::abs(c.eigenvalue - sure.eigenvalue) <=
                  (c.error_bound + sure.error_bound) * 1.000001 * c.eigenvalue);
            CHECK(c.error_bound <= 1e-11);
        }
    }
}

TEST_CASE("counts from the characteristic polynomial are those of the pivots", "[linalg]") {
    for (const auto& family : support::families()) {
        for (const Index n : {1, 7, 100, 333}) {
            const auto assembled = revchain::assemble(family.make(n));
            const auto pencil = pencil::rounded<double>(assembled.pencil);
            const auto chain = spectrum::lumped(assembled.pencil);
            if (!chain.fit) continue;
            std::vector<double> shifts;
            for (double mu = 1e-9; mu < 1e20; mu *= 7.3) shifts.push_back(mu);
            const auto samples = spectrum::sample_all(chain, shifts);
            for (std::size_t i = 0; i < shifts.size(); ++i) {
                CAPTURE(family.name, n, shifts[i]);
                CHECK(samples[i].below == pencil::count_above(pencil, std::array<double, 1>{1 / shifts[i]})[0]);
            }
        }
    }
}

TEST_CASE("some eigenvalue lies within the residual of any shift's quotient", "[linalg]") {
    support::Random random(7);
    for (int i = 0; i < 300; ++i) {
        const Index n = 2 + static_cast<Index>(random() * 60);
        const auto made = random_chain(random, n);
        const auto assembled = revchain::assemble(made);
        const auto chain = spectrum::lumped(assembled.pencil);
        if (!chain.fit) continue;
        const auto all = pencil::all_eigenvalues(assembled.pencil, Index(0), n, n, 1e-11);
        std::vector<double> shifts;
        for (int s = 0; s < 16; ++s) {  // anywhere, or close to an eigenvalue
            const auto& c = all[static_cast<std::size_t>(random() * static_cast<double>(n))];
            shifts.push_back((1 + (random() - 0.5) * std::pow(10.0, -16 * random())) / c.eigenvalue);
        }
        const auto quotients = spectrum::quotients_all(chain, shifts);
        for (std::size_t s = 0; s < shifts.size(); ++s) {
            const auto& q = quotients[s];
            const double value = q.ratio / shifts[s], reach = q.residual / shifts[s];
            bool within = false;
            for (const auto& c : all)
                within = within || std::abs(c.eigenvalue - value) <= reach + (c.error_bound + 50 * ulp) * c.eigenvalue;
            CAPTURE(i, n, s, q.ratio, q.residual);
            CHECK(within);
        }
    }
}

TEST_CASE("zeros of an interpolant, close pairs among them", "[linalg]") {
    for (const double gap : {0.3, 1e-2, 1e-4, 1e-6}) {
        const std::vector<double> zeros{-0.9, -0.2, -0.2 + gap, 0.31, 0.7};
        const std::size_t n = 32;
        std::vector<double> values(n, 1.0);
        for (std::size_t i = 0; i < n; ++i)
            for (const double z : zeros) values[i] *= spectrum::Chebyshev::node(i, n) - z;
        using V = revchain::Pack<double>;
        const auto found = spectrum::zeros<V>(spectrum::interpolant<V>(values), 5);
        REQUIRE(found.size() == 5);
        auto expected = zeros;
        std::sort(expected.begin(), expected.end());
        for (std::size_t i = 0; i < 5; ++i) CHECK(std::abs(found[i] - expected[i]) < 1e-14 / gap);
    }
}
