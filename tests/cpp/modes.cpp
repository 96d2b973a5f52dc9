// SPDX-License-Identifier: MPL-2.0
#include "revchain/modes.hpp"
#include "revchain/methods.hpp"

#include <cfenv>

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::ModesOptions;
using support::Quad;
using support::Truth;

namespace {

/// Every height within its own bound of the truth: counts in quadruple precision at both ends of the interval.
void require_bounds(const Chain<double>& chain, const revchain::Modes<double>& m, Index step = 1) {
    const Truth truth(chain);
    for (Index j = 0; j < m.size(); j += step) {
        const Quad h = m.conical_height[j], bound = m.error_bound[j];
        CAPTURE(chain.size(), j, m.conical_height[j], m.error_bound[j]);
        REQUIRE(truth.above(h / (1 + bound) * (1 - Quad(1e-20))) > j);
        REQUIRE(truth.above(h / (1 - bound) * (1 + Quad(1e-20))) <= j);
    }
}

}  // namespace

TEST_CASE("every height of every chain is within its bound, and within 1 ulp", "[linear]") {
    double worst = 0;
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 3, 4, 7, 10, 31, 100, 316, 1000}) {
            const auto chain = family.make(n);
            const auto m = revchain::modes(chain, {.count = revchain::all_modes});
            CAPTURE(family.name, n);
            REQUIRE(m.size() == chain.mode_count());
            CHECK(m.status == revchain::Status::success);
            CHECK(m.error_bound.maxCoeff() <= 0x1.0001p-51);  // 2 ulp; asked: 1e-13
            require_bounds(chain, m);
            const Truth truth(chain);
            for (Index j = 0; j<m.size(); j += n> 100 ? 53 : 1) {
                const Quad h = m.conical_height[j];
                const Quad exact = truth.height(j, h * (1 - Quad(1e-15)), h * (1 + Quad(1e-15)), 1e-19);
                worst = std::max(worst, support::error_in_ulp(m.conical_height[j], exact));
                if (j > 0) CHECK(m.conical_height[j] < m.conical_height[j - 1]);
            }
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 0.501);  // the nearest double; asked: 8 (1 + log10 N)
}

TEST_CASE("3000 links, every height", "[linear]") {
    for (const auto& family : support::families()) {
        const auto chain = family.make(3000);
        const auto m = revchain::modes(chain, {.count = revchain::all_modes});
        CAPTURE(family.name);
        CHECK(m.error_bound.maxCoeff() <= 0x1.0001p-51);
        require_bounds(chain, m, 43);
    }
}

TEST_CASE("1e5 links, the slowest", "[linear]") {
    for (const auto& family : support::families()) {
        const auto chain = family.make(100'000);
        const auto m = revchain::modes(chain, {.count = 4});
        CAPTURE(family.name);
        CHECK(m.error_bound.maxCoeff() <= 0x1.0001p-51);
        require_bounds(chain, m, 3);
    }
}

TEST_CASE("the tolerance asked is the tolerance kept, from 1 to the last digit", "[linear]") {
    double tightest = 1;
    for (const auto& family : support::families()) {
        for (const Index n : {1, 6, 50, 2000}) {
            const auto chain = family.make(n);
            const Index count = std::min(chain.mode_count(), Index(6));
            for (int eighth = 0; eighth <= 8 * 20; eighth += n > 1000 ? 8 : 1) {
                const double rtol = std::pow(10.0, -eighth / 8.0);
                const auto m = revchain::modes(chain, {.count = count, .rtol = rtol});
                CAPTURE(family.name, n, rtol, m.error_bound.maxCoeff());
                require_bounds(chain, m);
                if (m.status == revchain::Status::success) {
                    REQUIRE(m.error_bound.maxCoeff() <= rtol);
                    tightest = std::min(tightest, rtol);
                } else {
                    REQUIRE(m.error_bound.maxCoeff() > rtol);
                    REQUIRE(rtol < 0x1.0001p-51);  // refused only when beyond the scalar
                }
            }
        }
    }
    CHECK(tightest <= 5.7e-16);  // the last step of an eighth of a decade above 2 ulp
}

TEMPLATE_TEST_CASE("laws", "[linear]", float, double, long double) {
    using T = TestType;
    const T eps = revchain::epsilon<T>();
    support::Random random(21);
    for (const double scale : {1.0, 1e-8, 1e8, -1.0}) {  // ordinary, tiny, huge, random
        for (int repeat = 0; repeat < 6; ++repeat) {
            const double unit = scale > 0 ? scale : random.log_between(1e-8, 1e8);
            std::vector<revchain::Link<T>> links;
            const int n = 1 + static_cast<int>(9 * random());
            for (int m = 0; m < n; ++m) {
                const T a = static_cast<T>(unit * random.between(0.5, 1.5));
                links.push_back(
                    revchain::compound_pendulum<T>({.weight = static_cast<T>(unit * random.between(0.1, 2)),
                                                    .length = a,
                                                    .centroid = a * static_cast<T>(random.between(0.2, 1)),
                                                    .radius_of_gyration = a * static_cast<T>(random.between(0, 0.6))}));
            }
            const Chain<T> chain(links);
            const auto m = revchain::modes(chain, {.count = revchain::all_modes});
            CAPTURE(unit, n);
            REQUIRE(m.status == revchain::Status::success);

            // powers of two scale weights without a trace and lengths in proportion, to the last bit
            auto scaled = links;
            for (auto& link : scaled) {
                link.weight *= T(1024);
                link.length *= T(0.125);
                link.centroid *= T(0.125);
            }
            const auto s = revchain::modes(Chain<T>(scaled), {.count = revchain::all_modes});
            CHECK((s.conical_height * T(8)).isApprox(m.conical_height, T(0)));
            CHECK(s.shapes().isApprox(m.shapes(), T(0)));

            // the sum of the heights is the trace of K^-1 M: sum over links of what hangs from each, by hand
            long double trace = 0, below = 0;
            std::vector<long double> flexibility(static_cast<std::size_t>(n));
            for (std::size_t i = 0; i < links.size(); ++i) {
                flexibility[i] =
                    static_cast<long double>(links[i].length) * links[i].length /
                    (static_cast<long double>(links[i].weight) * links[i].centroid + links[i].length * below);
                below += links[i].weight;
            }
            for (std::size_t i = 0; i < links.size(); ++i) {
                const long double p = static_cast<long double>(links[i].centroid) / links[i].length;
                const long double r2 = static_cast<long double>(support::quad(links[i].gyration_ratio));
                // K^-1 between two pins: the sum of flexibilities above the higher; M_i = W (y_G^2 + rho^2 s^2)
                long double above = 0;
                for (std::size_t k = i + 1; k < links.size(); ++k) above += flexibility[k];
                trace += links[i].weight * (above + flexibility[i] * (p * p + r2));
            }
            long double sum = 0;
            for (Index j = 0; j < m.size(); ++j) sum += m.conical_height[j];
            CHECK(std::abs(static_cast<double>(sum / trace - 1)) <= 8 * static_cast<double>(eps));

            // interlacing: a link added at the top leaves what hangs below as it was, and frees its upper pin
            auto longer = links;
            longer.push_back(links.front());
            const auto more = revchain::modes(Chain<T>(longer), {.count = revchain::all_modes});
            for (Index j = 0; j < m.size(); ++j) {
                CHECK(more.conical_height[j] >= m.conical_height[j]);
                CHECK(more.conical_height[j + 1] <= m.conical_height[j]);  // equal when closer than an ulp
            }

            // k - 1 nodes when l <= a
            bool short_pendulums = true;
            for (const auto& link : links)
                short_pendulums = short_pendulums && revchain::pendulum_length(link) <= link.length;
            for (Index j = 0; j < m.size() && short_pendulums; ++j) {
                REQUIRE(m.nodes()[static_cast<std::size_t>(j)].size() == j);
                for (Index i = 0; i < j; ++i) {
                    const T node = m.nodes()[static_cast<std::size_t>(j)][i];
                    CHECK(node > T(0));
                    CHECK(node < chain.total_length());
                }
            }
            CHECK(m.residual().maxCoeff() <= T(8) * eps);
        }
    }
}

TEST_CASE("a stiffer-minded count: mode numbers by counting, for long pendulum lengths", "[linear]") {
    // l > a: nodes do not number the modes, counts do
    support::Random random(31);
    Index odd = 0;
    for (int i = 0; i < 300; ++i) {
        const auto chain = support::chain_of(4, [&](Index) {
            const double a = random.between(0.5, 1.5), h = a * random.between(0.1, 1.0);
            return revchain::compound_pendulum<double>({.weight = random.between(0.5, 2),
                                                        .length = a,
                                                        .centroid = h,
                                                        .pendulum_length = h + a * random.between(1, 4)});
        });
        const auto m = revchain::modes(chain, {.count = revchain::all_modes});
        const Truth truth(chain);
        for (Index j = 0; j < 4; ++j) {
            REQUIRE(truth.above(Quad(m.conical_height[j]) * (1 + Quad(1e-15))) == j);
            if (m.nodes()[static_cast<std::size_t>(j)].size() != j) ++odd;
        }
    }
    CHECK(odd > 0);
}

TEST_CASE("what was asked is what comes", "[linear]") {
    const auto chain = Chain<double>::uniform_rods(7);
    const auto all = revchain::modes(chain, {.count = revchain::all_modes}, revchain::methods::all);
    CHECK(all.size() == 7);
    CHECK(all.method == "aberth");
    const auto some = revchain::modes(chain, {.count = 3});
    CHECK(some.size() == 3);
    CHECK(some.conical_height == all.conical_height.head(3));
    CHECK(some.shapes() == all.shapes().topRows(3));
    const auto alone = revchain::modes(chain, {.count = revchain::all_modes});
    CHECK(alone.shape(2) == all.shapes().row(2).transpose());  // one shape before the others are asked for
    CHECK(alone.shapes() == all.shapes());
    CHECK(all.shape(2) == alone.shape(2));
    CHECK_THROWS_AS(all.shape(7), revchain::InvalidArgument);
    CHECK_THROWS_AS(all.shape(-1), revchain::InvalidArgument);
    const auto copy = all;
    CHECK(&copy.shapes() == &all.shapes());
    CHECK(revchain::Modes<double>{}.shapes().size() == 0);
    CHECK(revchain::modes(chain).size() == 7);  // ten by default, or all where there are fewer
    CHECK(revchain::modes(Chain<double>::uniform_rods(20)).size() == 10);
    CHECK(all.angular_speed(9.8)[2] == std::sqrt(9.8) / std::sqrt(all.conical_height[2]));
    CHECK(all.period(9.8)[2] == Approx(2 * M_PI / all.angular_speed(9.8)[2]).epsilon(1e-15));
    CHECK(all.revolutions_per_second(9.8)[2] == Approx(1 / all.period(9.8)[2]).epsilon(1e-15));
    CHECK_THROWS_AS(all.angular_speed(0.0), revchain::InvalidArgument);
    CHECK(revchain::modes(chain, {.count = revchain::all_modes, .rtol = 0.0}).status ==
          revchain::Status::tolerance_not_met);
    CHECK(revchain::modes(chain, {.count = revchain::all_modes, .rtol = std::numeric_limits<double>::infinity()})
              .status == revchain::Status::success);
}

TEST_CASE("wrong calls", "[linear]") {
    const auto chain = Chain<double>::uniform_rods(3);
    CHECK_THROWS_AS(revchain::modes(chain, {.count = 0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(chain, {.count = -1}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(chain, {.count = 4}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(chain, {.count = revchain::all_modes, .rtol = -1e-3}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(chain, {.count = revchain::all_modes, .rtol = std::nan("")}),
                    revchain::InvalidArgument);
    const Chain<double> threaded(std::vector{revchain::plummet(1.0, 1.0), revchain::plummet(0.0, 1.0)});
    CHECK_THROWS_WITH(revchain::modes(threaded, {.count = 2}), Catch::Matchers::ContainsSubstring("the 1 modes"));
}

TEST_CASE("a computation can be watched and stopped", "[linear]") {
    const auto chain = Chain<double>::uniform_rods(100);
    revchain::Progress progress;
    (void)revchain::modes(chain, {.count = revchain::all_modes, .progress = &progress});
    CHECK(progress.fraction() == 1.0);
    progress.cancel();
    CHECK_THROWS_AS(revchain::modes(chain, {.count = revchain::all_modes, .progress = &progress}), revchain::Cancelled);
}

TEST_CASE("no floating-point alarms, at extremes too", "[linear]") {
    for (const auto& family : support::families()) {
        for (const double unit : {1e-150, 1.0, 1e150}) {
            std::vector<revchain::Link<double>> links;
            const auto ordinary = family.make(20);
            for (Index m = 0; m < 20; ++m) {
                auto link = ordinary.link(m);
                link.weight *= unit;
                links.push_back(link);
            }
            const Chain<double> chain(links);
            std::feclearexcept(FE_ALL_EXCEPT);
            const auto m = revchain::modes(chain, {.count = revchain::all_modes});
            CAPTURE(family.name, unit);
            CHECK(std::fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) == 0);
            CHECK(m.status == revchain::Status::success);
            require_bounds(chain, m);
        }
    }
}

// At the limits that Chain sets; the truth is Lagrange's quadratic, Greenhill §2 (5), in the form without cancellation.
TEST_CASE("two plummets at the limits of the scalar", "[linear]") {
    for (const auto& [w1, w2] : {std::pair(1e-60, 1e60), std::pair(1e60, 1e-60), std::pair(1.0, 3.0)}) {
        for (const auto& [a1, a2] : {std::pair(1e-38, 1e38), std::pair(1e38, 1e-38), std::pair(0.3, 0.7)}) {
            const auto m =
                revchain::modes(Chain<double>(std::vector{revchain::plummet(w1, a1), revchain::plummet(w2, a2)}),
                                {.count = revchain::all_modes});
            const Quad l1 = a1, l2 = a2, mu = Quad(w1) / (Quad(w1) + Quad(w2)), rest = Quad(w2) / (Quad(w1) + Quad(w2));
            const Quad first = (l1 + l2 + sqrtq((l1 - l2) * (l1 - l2) + 4 * mu * l1 * l2)) / 2;
            const Quad second = l1 * l2 * rest / first;
            CAPTURE(w1, w2, a1, a2, m.conical_height[0], m.conical_height[1], m.error_bound[0], m.error_bound[1]);
            CHECK(support::error_in_ulp(m.conical_height[0], first) <= 0.5001);
            CHECK(support::error_in_ulp(m.conical_height[1], second) <= 0.5001);
            CHECK(m.error_bound.maxCoeff() <= 0x1.0001p-51);
        }
    }
}

TEST_CASE("a link that hardly hangs, and one that hardly swings", "[linear]") {
    std::vector<Chain<double>> chains;
    chains.emplace_back(
        std::vector{revchain::plummet(1.0, 1.0),
                    revchain::compound_pendulum<double>(
                        {.weight = 1, .length = 1, .centroid = -1 + 1e-15, .radius_of_gyration = 0.3})});
    chains.emplace_back(std::vector{
        revchain::compound_pendulum<double>({.weight = 1, .length = 1, .centroid = 1e-15, .radius_of_gyration = 1})});
    for (const auto& chain : chains) {
        const auto m = revchain::modes(chain, {.count = revchain::all_modes});
        CHECK(m.error_bound.maxCoeff() <= 4e-14);  // the first: W h + a S keeps 1e-15 of its terms
        CHECK(m.status == revchain::Status::success);
        require_bounds(chain, m);
    }
}

// W^2 rho^2 / a^2 must not underflow on the way: it is of the order of 1e-340 before the division.
TEST_CASE("a tiny coupling of masses", "[linear]") {
    using WideDouble = revchain::Wide<double>;
    const Chain<double> chain(std::vector<revchain::Link<double>>{
        {0xd.9fb4658eeac6p-411, 0xb.918e68241ce9p-258, 0xb.918e68241ce9p-258,
         WideDouble(0xd.4caa40da0ebf8p-394, -0xe.43d943a343b8p-449) / WideDouble(0xb.918e68241ce9p-258) /
             WideDouble(0xb.918e68241ce9p-258)},
        {0x8.49c10ff790c6p-36, 0x8.527d19d678dfp-27, 0xd.72d47d36b021p-228, WideDouble(0)}});
    const auto m = revchain::modes(chain, {.count = revchain::all_modes});
    CHECK(support::error_in_ulp(m.conical_height[0], strtoflt128("1.319699319837711969577697e-41", nullptr)) <= 0.501);
    CHECK(support::error_in_ulp(m.conical_height[1], strtoflt128("2.634016138520184008980816e-60", nullptr)) <= 0.501);
    CHECK(m.error_bound.maxCoeff() <= 0x1.0001p-51);
}

TEST_CASE("a chain at the edge of float comes to an end", "[linear]") {
    const auto link = [](float weight, float length, float centroid, double gyration_squared) {
        return revchain::Link<float>{weight, length, centroid, gyration_squared / length / length};
    };
    const Chain<float> chain(std::vector{link(0xf.01fa8p-53F, 0x9.fa325p-34F, 0x9.fa325p-34F, 0x1.6193bap-9),
                                         link(0xf.f33b7p-4F, 0xa.98629p-16F, 0xe.20837p-18F, 0x1.31900ap-59),
                                         link(0x0p+0F, 0xb.53693p-19F, 0x0p+0F, 0x1.15d492p-10),
                                         link(0xc.9e48fp-53F, 0xa.a854fp-13F, 0x0p+0F, 0x1.7be1aep-47),
                                         link(0xa.f5a4dp-4F, 0x8.2a0ffp-27F, 0x8.2a0ffp-27F, 0x0p+0),
                                         link(0x8.36cdp-30F, 0x8.c3a9cp-4F, 0xb.36ddp-32F, 0x0p+0),
                                         link(0x8.d3ddbp-51F, 0xd.a6e38p-30F, 0xd.a6e38p-31F, 0x1.f0ffbcp-57)});
    CHECK(revchain::modes(chain, {.count = revchain::all_modes}).size() == chain.mode_count());
}

// Offsets below 1e-308 underflow; nodes and the free end's sign are taken from ratios, which do not.
TEST_CASE("every node of every mode, where offsets underflow too", "[linear]") {
    support::Random random(51);
    std::vector<Chain<double>> chains{Chain<double>::uniform_plummets(1000)};
    for (const double ratio : {1e2, 1e6, 1e12})
        chains.push_back(support::chain_of(
            300, [&](Index) { return revchain::plummet<double>(random.log_between(1, ratio), 1.0); }));
    for (const auto& chain : chains) {
        const auto m = revchain::modes(chain, {.count = revchain::all_modes});
        const Truth truth(chain);
        for (Index j = 0; j < m.size(); ++j) {
            const auto& nodes = m.nodes()[static_cast<std::size_t>(j)];
            REQUIRE(nodes.size() == j);
            for (Index i = 1; i < j; ++i) REQUIRE(nodes[i] > nodes[i - 1]);
            if (j % 50 != 49) continue;
            const Quad h = m.conical_height[j];
            const auto shape = truth.shape(truth.height(j, h * (1 - Quad(1e-15)), h * (1 + Quad(1e-15)), 1e-28));
            for (Index i = 0; i <= chain.size();
                 ++i)  // quadruple precision reaches to 1e-4932: the true sign of the free end
                if (std::abs(m.shapes()(j, i)) > 1e-3)
                    REQUIRE((m.shapes()(j, i) > 0) == (shape[static_cast<std::size_t>(i)] > 0));
        }
    }
}

// lambda k + X = 0 at lambda = 1 cuts the chain there; both parts have the height 1. Bounds hold, heights stay in order.
TEST_CASE("heights that coincide, and nearly", "[linear]") {
    for (const double away : {0.0, 1e-30, 1e-16, 1e-15, 4e-15, 1e-14, 1e-12, 1e-8, 1e-4}) {
        const Chain<double> chain(
            {revchain::plummet(1.0, 3.0),
             revchain::Link<double>{1.0, 1.0, 0.5, revchain::Wide<double>(1.75) + revchain::Wide<double>(away)},
             revchain::plummet(0.0, 4.0)});
        const auto m = revchain::modes(chain, {.count = revchain::all_modes});
        CAPTURE(away, m.conical_height[0], m.conical_height[1], m.conical_height[2], m.error_bound[1],
                m.error_bound[2]);
        CHECK(m.conical_height[1] >= m.conical_height[2]);
        CHECK(m.error_bound.maxCoeff() <= 1e-13);
        CHECK(m.residual().maxCoeff() <= 1e-15);
        const Truth truth(chain);
        for (Index j = 0; j < 3; ++j) {
            const Quad exact = away == 0 ? Quad(j == 0 ? 7 : 1) : truth.height(j, 0.5, 10, 1e-30);
            CHECK(static_cast<double>(fabsq(Quad(m.conical_height[j]) / exact - 1)) <= m.error_bound[j] + 1e-25);
        }
    }
}

TEST_CASE("what does not fit into the scalar is not promised", "[linear]") {
    const auto m = revchain::modes(Chain<double>::uniform_plummets(1000, 1e-304), {.count = revchain::all_modes});
    const auto ordinary = revchain::modes(Chain<double>::uniform_plummets(1000, 1.0), {.count = revchain::all_modes});
    for (Index j = 0; j < m.size(); ++j) {
        const Quad exact = Quad(ordinary.conical_height[j]) * Quad(1e-304);
        const double error = static_cast<double>(fabsq(Quad(m.conical_height[j]) / exact - 1));
        CHECK(error <= m.error_bound[j] + 2e-15);
    }
    CHECK(m.error_bound[0] <= 0x1.0001p-51);
    CHECK(m.error_bound[999] > 1e-14);  // subnormal
}
