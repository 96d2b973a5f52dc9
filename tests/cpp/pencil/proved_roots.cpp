// SPDX-License-Identifier: MPL-2.0
#include "revchain/pencil/proved_roots.hpp"

#include "revchain/linear/heights.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/tier.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::detail::Pencils;
using support::Quad;

namespace {

using Roots = std::optional<std::vector<revchain::pencil::ProvedRoot<double>>>;

Roots roots_of(const Chain<double>& chain, const Pencils<double>& pencils, Index first, Index count) {
    return revchain::pencil::proved_range(
        pencils.wide(), pencils.rounded(),
        [&](double x) { return revchain::pencil::certified_count<double, 1>(pencils.rounded(), {x})[0]; }, first, count,
        chain.mode_count(), pencils.scaled(chain.total_length()), 1.49 * 0x1p-52, {});
}

struct Seen {
    int proved = 0, unproved = 0;
    double worst = 0;  ///< error before rounding over what is proved of it, which has the truth's own 1e-26
};

/// Compares what is proved with the truth.
void compare(const Chain<double>& chain, Index first, Index count, Seen& seen) {
    const Pencils<double> pencils(chain);
    const Roots roots = roots_of(chain, pencils, first, count);
    if (!roots) {
        seen.unproved += static_cast<int>(count);
        return;
    }
    REQUIRE(static_cast<Index>(roots->size()) == count);
    const support::Truth truth(chain);
    const Quad unit = std::ldexp(1.0, pencils.length_exponent());
    for (Index j = 0; j < count; ++j) {
        const auto& [root, off] = (*roots)[static_cast<std::size_t>(j)];
        CAPTURE(first, j, root.high, off);
        if (!std::isfinite(off)) {
            ++seen.unproved;
            continue;
        }
        ++seen.proved;
        const Quad found = Quad(root.high) + Quad(root.low), reach = 1e-12;
        const Quad exact =
            truth.height(first + j, found * (1 - reach) * unit, found * (1 + reach) * unit, 1e-27) / unit;
        const double error = static_cast<double>(fabsq(found - exact));
        REQUIRE(off <= 1.49 * 0x1p-52 * root.high);
        REQUIRE(error <= off + 1e-26 * root.high);
        seen.worst = std::max(seen.worst, error / (off + 1e-26 * root.high));
    }
}

}  // namespace

TEST_CASE("roots eight at a time: every family, all of them and some", "[pencil]") {
    for (const auto& family : support::families()) {
        Seen seen;
        for (const Index n : {1, 2, 3, 7, 8, 9, 40, 150}) {
            CAPTURE(family.name, n);
            const Chain<double> chain = family.make(n);
            if (!chain.has_one_weight_unit()) continue;
            const Index all = chain.mode_count();
            compare(chain, 0, all, seen);
            compare(chain, 0, std::min<Index>(3, all), seen);
            compare(chain, all / 2, std::min<Index>(5, all - all / 2), seen);
            compare(chain, all - 1, 1, seen);
        }
        CAPTURE(family.name, seen.proved, seen.unproved, seen.worst);
        CHECK(30 * seen.unproved <= seen.proved);  // measured: 7 of 276, weights over 1e12
    }
}

// Brackets come from groups of elements here.
TEST_CASE("roots eight at a time: a few of many, every family", "[pencil]") {
    for (const auto& family : support::families()) {
        Seen seen;
        for (const Index n : {100, 350, 1000}) {
            CAPTURE(family.name, n);
            const Chain<double> chain = family.make(n);
            if (!chain.has_one_weight_unit()) continue;
            compare(chain, 0, 1, seen);
            compare(chain, 0, 3, seen);
            if (n >= 350) compare(chain, 2, 8, seen);
        }
        CAPTURE(family.name, seen.proved, seen.unproved, seen.worst);
        CHECK(seen.unproved == 0);
    }
}

TEST_CASE("roots eight at a time: a few of many, random chains", "[pencil]") {
    support::Random random(21);
    Seen seen;
    for (int i = 0; i < 200; ++i) {
        const Index n = 100 + static_cast<Index>(random() * 400);
        const double spread = random.between(0, 2);
        const bool points = random() < 0.5;
        const Chain<double> chain = support::chain_of(n, [&](Index) {
            const double weight = std::pow(10.0, spread * random.between(-1, 1)),
                         a = std::pow(10.0, spread * random.between(-0.5, 0.5));
            return points ? revchain::plummet<double>(weight, a) : revchain::uniform_rod<double>(weight, a);
        });
        const Index last = n / revchain::pencil::least_for_groups, first = static_cast<Index>(random() * double(last));
        CAPTURE(i, n, spread, points, first, last);
        compare(chain, first, last - first, seen);
    }
    CAPTURE(seen.proved, seen.unproved, seen.worst);
    CHECK(seen.unproved == 0);
}

TEST_CASE("roots eight at a time: random chains", "[pencil]") {
    support::Random random(19);
    Seen seen;
    for (int i = 0; i < support::by_tier(1000, 3000); ++i) {
        const Index n = 1 + static_cast<Index>(random() * 25);
        const double spread = random.between(0, 3);
        const bool points = random() < 0.5;
        const Chain<double> chain = support::chain_of(n, [&](Index) {
            const double weight = std::pow(10.0, spread * random.between(-1, 1)),
                         a = std::pow(10.0, spread * random.between(-0.5, 0.5));
            if (points) return revchain::plummet<double>(weight, a);
            return revchain::compound_pendulum<double>({.weight = weight,
                                                        .length = a,
                                                        .centroid = a * random.between(0, 1.2),
                                                        .radius_of_gyration = a * random.between(0.01, 1)});
        });
        CAPTURE(i, n, spread, points);
        compare(chain, 0, chain.mode_count(), seen);
    }
    CAPTURE(seen.proved, seen.unproved, seen.worst);
    CHECK(1000 * seen.unproved <= seen.proved);
}

TEST_CASE("roots eight at a time: the outermost of those asked for are as sure as the others", "[pencil]") {
    support::Random random(20);
    Seen seen;
    for (int i = 0; i < 300; ++i) {
        const Index n = 2 + static_cast<Index>(random() * 60);
        const Chain<double> chain = support::chain_of(n, [&](Index) {
            return i % 2 == 0 ? revchain::plummet<double>(random.between(0.5, 2), random.between(0.5, 2))
                              : revchain::uniform_rod<double>(random.between(0.5, 2), random.between(0.5, 2));
        });
        const Index first = static_cast<Index>(random() * static_cast<double>(n)),
                    count = 1 + static_cast<Index>(random() * static_cast<double>(n - first));
        CAPTURE(i, n, first, count);
        compare(chain, first, std::min(count, n - first), seen);
    }
    CAPTURE(seen.proved, seen.unproved, seen.worst);
    CHECK(seen.unproved == 0);
}

// A light point mass on a heavy one, on equal threads: the heights are 1 -+ the root of the light one's share.
TEST_CASE("roots eight at a time: roots that lie close together are left open, not guessed", "[pencil]") {
    int open = 0;
    for (const double weight : {1e-4, 1e-8, 1e-12, 1e-16, 1e-20}) {
        const Chain<double> chain({revchain::plummet(weight, 1.0), revchain::plummet(1.0, 1.0)});
        const Pencils<double> pencils(chain);
        const Roots roots = roots_of(chain, pencils, 0, 2);
        CAPTURE(weight);
        if (!roots || !std::isfinite((*roots)[0].off) || !std::isfinite((*roots)[1].off)) ++open;
        Seen seen;
        compare(chain, 0, 2, seen);
        compare(chain, 0, 1, seen);
        // and whatever happens here, the heights given out are right
        const auto given = revchain::detail::heights_in_lanes(pencils, {1, 2}, 2, pencils.scaled(2.0), {});
        if (!given) continue;
        const Quad mu = Quad(weight) / (1 + Quad(weight));  // (lambda - 1)^2 = mu
        for (const int j : {0, 1}) {
            const Quad exact = (1 + (j == 0 ? 1 : -1) * sqrtq(mu)) / std::ldexp(1.0, pencils.length_exponent());
            const auto& height = (*given)[static_cast<std::size_t>(j)];
            CHECK(static_cast<double>(fabsq(Quad(height.eigenvalue) / exact - 1)) <= height.error_bound);
        }
    }
    CHECK(open < 5);
}

// The intervals of the first two share one root; their high words are neighbours and their low words half way between.
TEST_CASE("two quotients either side of one root prove nothing of a third", "[linalg]") {
    using Root = revchain::pencil::ProvedRoot<double>;
    const revchain::DoubleWord<double> upper(1 + 0x1p-52, -0x1p-53 + 0x1p-80), lower(1.0, 0x1p-53 - 0x1p-80);
    std::vector<Root> roots{{upper, 0.0}, {lower, 0.0}, {revchain::DoubleWord<double>(0.5), 0.0}};
    const std::vector<double> reach{0x1p-75, 0x1p-75, 5e-10};
    const auto exact = [](double x) {  // 1 + 2^-53 and 0.5 +- 5e-10
        const revchain::Index above = (x <= 1) + (x < 0.5 + 5e-10) + (x < 0.5 - 5e-10);
        return revchain::pencil::CertifiedCount{above, true};
    };
    const double infinity = std::numeric_limits<double>::infinity();
    const bool proved = revchain::pencil::prove(roots, reach, 0, 0.0, infinity, 1e-15, exact);
    CHECK((!proved || roots[2].off >= 5e-10));
}
