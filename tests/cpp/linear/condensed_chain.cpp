// SPDX-License-Identifier: MPL-2.0
// Chains made to break `condensed_chain`: each found a term that had not been counted, or was built from one that might not be.
#include "revchain/linear/condensed_chain.hpp"

#include <numeric>

#include "revchain/linear/condensed_heights.hpp"
#include "revchain/modes.hpp"
#include "support/big_float.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using namespace revchain;
using support::Random;

namespace {

using Links = std::vector<Link<double>>;

/// What heights are before they are rounded, against those of bisection (good to 1e-20), in units of the blocks' error
/// and the margin.
double error_of(const Chain<double>& chain, Index first, Index count) {
    const auto fast = detail::heights_by_condensation(chain, {first, count}, {});
    if (!fast) return -1;
    detail::LazyCounter<double> assembled(chain);
    const auto sure = detail::heights_by_bisection(chain, assembled, {first, count}, {});
    double worst = 0;
    for (std::size_t j = 0; j < sure.size(); ++j) {
        CHECK(fast->found[j].error_bound <= 0x1p-51);
        const auto difference = fast->found[j].unrounded - sure[j].unrounded;
        worst = std::max(worst, std::abs(static_cast<double>(difference)) / sure[j].eigenvalue);
    }
    return worst / (fast->condensed.pencil.error + 0x1p-55);
}

/// Whether height number j (from 1) is what `heights_by_condensation` says, by exact counts; true where it gives up.
bool is_within(const Chain<double>& chain, Index j) {
    const auto found = detail::heights_by_condensation(chain, {j, 1}, {});
    if (!found) return true;
    const auto& height = found->found[0];
    const double value = std::ldexp(height.eigenvalue, chain.units().length_exponent);
    return support::count_in_big_floats(chain, value, height.error_bound) < j &&
           support::count_in_big_floats(chain, value, -height.error_bound) >= j;
}

}  // namespace

// A leaf of a long run has three terms. Where one leaf is nearly all of the run its fourth is missed: 3e-16 of the height.
TEST_CASE("Runs in which one leaf outweighs all others", "[condensation]") {
    double worst = 0;
    for (const double weight : {10.0, 1000.0})
        for (const double length : {10.0, 1000.0})
            for (const double gyration_ratio : {0.0, 1.0 / 12}) {
                const Chain<double> chain(support::chain_of(8192, [&](Index m) -> Link<double> {
                    const bool heavy = m % 64 / 4 == 4;
                    const double a = heavy ? length : 1.0;
                    return {heavy ? weight : 1.0, a, a / 2, Wide<double>(gyration_ratio)};
                }));
                for (const Index first : {1, 3, 14}) {
                    const double error = error_of(chain, first, 1);
                    CAPTURE(weight, length, gyration_ratio, first);
                    CHECK(error >= 0);
                    worst = std::max(worst, error);
                }
            }
    CHECK(worst <= 0.1);  // measured 0.04; 2.5 while the term was missed
    WARN("worst error " << worst << " of the bound");
}

// S a + W h = 1 where both products have 30 digits: two words keep none of them.
TEST_CASE("A stiffness that cancels to its last digit is not trusted", "[condensation]") {
    Random random(5);
    int chains = 0;
    while (chains < 10) {
        const auto whole = [&](int bits) {
            return (1LL << bits) + static_cast<long long>(random() * std::ldexp(1.0, bits));
        };
        std::vector<long long> below(100);
        for (auto& w : below) w = whole(40);
        const long long hung = std::accumulate(below.begin(), below.end(), 0LL), weight = whole(45);
        long long r = hung, s = weight, x = 1, y = 0, u = 0, v = 1;  // Euclid: hung x + weight y = gcd
        while (s != 0) {
            const long long q = r / s;
            std::swap(r -= q * s, s);
            std::swap(x -= q * u, u);
            std::swap(y -= q * v, v);
        }
        if (r != 1) continue;
        if (x < 0) x += weight, y -= hung;
        if (x == 0 || y >= 0) continue;
        ++chains;
        const double a = static_cast<double>(x);
        Links links;
        for (const long long w : below) links.push_back(plummet<double>(static_cast<double>(w), a));
        links.push_back({static_cast<double>(weight), a, static_cast<double>(y), Wide<double>(0.1)});
        for (int m = 0; m < 200; ++m) links.push_back(plummet<double>(random.between(1, 2) * 0x1p40, a));
        const Chain<double> chain(links);
        CAPTURE(chains, hung, weight, x, y);
        for (const Index j : {1, 2, 5}) CHECK(is_within(chain, j));
    }
}

// A weight over a long length underflows where the same weight over the length in its unit does not.
TEST_CASE("Blocks do not know the unit of length", "[condensation]") {
    Random random(6);
    for (const double longest : {1.0, 1e10, 1e40})
        for (const int exponent : {-900, 0, 640}) {
            Links links;
            for (Index m = 0; m < 600; ++m)
                links.push_back(plummet<double>(std::ldexp(random.between(1, 4), -400),
                                                std::ldexp(m % 60 == 22 ? longest : 1.0, exponent)));
            const Chain<double> chain(links);
            CAPTURE(longest, exponent);
            for (const Index j : {1, 3, 6}) CHECK(is_within(chain, j));
            const double error = error_of(chain, 1, 6);
            CHECK(error >= 0);
            CHECK(error <= 0.3);
        }
}

// 0/0 in a massless leaf would pass for the largest of all, and then for none.
TEST_CASE("Massless stretches condense like others", "[condensation]") {
    Random random(7);
    for (int i = 0; i < 20; ++i) {
        bool massless = false;
        const Chain<double> chain = support::chain_of(2000, [&](Index m) {
            if (random() < 0.03) massless = !massless;
            return plummet<double>(m > 0 && massless ? 0.0 : random.between(0.5, 2), random.between(0.5, 2));
        });
        const double error = error_of(chain, 1 + 10 * i, 5);
        CAPTURE(i);
        CHECK(error >= 0);
        CHECK(error <= 0.3);
        const auto condensed = condensed_chain(chain, 0.9 * detail::estimated_height(chain, 5));
        CHECK(condensed.pencil.blocks.size() < 200);
        CHECK(condensed.pencil.error > 0x1p-54);  // a division at least
    }
}

TEST_CASE("Every link is in a block, whatever the chain", "[condensation]") {
    Random random(8);
    for (const Index size : {1, 2, 3, 4, 5, 7, 8, 63, 64, 65, 255, 256, 1000, 4097})
        for (int kind = 0; kind < 5; ++kind) {
            double jump = 1;
            const Chain<double> chain = support::chain_of(size, [&](Index m) -> Link<double> {
                const double w = random.between(0.5, 2), a = random.between(0.5, 2);
                if (kind == 1 && random() < 0.02) jump = jump == 1 ? 1e8 : 1;
                if (kind == 2) return uniform_rod<double>(w, random() < 0.01 ? 1e8 * a : a);
                if (kind == 3) return {w, a, a * random.between(0.5, 2), Wide<double>(random.between(0, 3))};
                if (kind == 4) return uniform_rod<double>(m == 0 ? 1e12 : w, a);
                return plummet<double>(w * jump, a);
            });
            for (const double share : {1.0, 1e-3}) {
                const double least = share * chain.total_length() / detail::LinkColumns<double>(chain).unit_length;
                const auto condensed = condensed_chain(chain, least);
                Index links = 0;
                Wide<double> weight(0.0);
                for (const auto& block : condensed.pencil.blocks) {
                    links += block.links;
                    weight = weight + block.lower + block.upper;
                }
                CAPTURE(size, kind, share);
                CHECK(links == size);
                const auto total = chain.weight_below(size);
                CHECK(std::abs(static_cast<double>(weight - total)) <= 0x1p-54 * static_cast<double>(total));
                CHECK(condensed.pencil.error <= 1.5 * 0x1p-52);
            }
        }
}
