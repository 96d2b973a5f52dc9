// SPDX-License-Identifier: MPL-2.0
// Truth: the eigenvalues of the whole, from `modes` (0.5 ulp).
#include "revchain/pencil/grouped.hpp"

#include "revchain/linear/plain_pencil.hpp"
#include "revchain/modes.hpp"
#include "revchain/pencil/bisection.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using namespace revchain;
using support::Random;

namespace {

Chain<double> random_chain(Random& random, Index size, double wide) {
    std::vector<Link<double>> links;
    for (Index m = 0; m < size; ++m) {
        const double W = std::exp(wide * random.between(-1, 1)), a = std::exp(random.between(-1, 1));
        links.push_back(compound_pendulum<double>({.weight = W,
                                                   .length = a,
                                                   .centroid = a * random.between(0.01, 1.5),
                                                   .radius_of_gyration = a * random.between(0, 0.7)}));
    }
    return Chain<double>(links);
}

}  // namespace

TEST_CASE("grouped elements: coarse <= exact <= coarse + spread, every eigenvalue") {
    Random random(81);
    double most = 0;
    int left_alone = 0;
    Index grouped_away = 0;
    for (int i = 0; i < 200; ++i) {
        const Chain<double> chain = random_chain(random, static_cast<Index>(random.log_between(2, 200)),
                                                 random.between(0, 1) < 0.5 ? 0.5 : random.between(0, 12));
        const Modes<double> truth = modes(chain, {.count = revchain::all_modes});
        const double unit = std::ldexp(1.0, chain.units().length_exponent);
        const double spread = truth.conical_height[0] / unit * random.log_between(1e-4, 1);
        const auto plain = plain_pencil(chain);
        REQUIRE(plain);
        const auto coarse = pencil::grouped(*plain, spread, spread);
        CHECK(coarse.spread <= spread * (1 + 1e-9));
        const Index count = coarse.pencil.size();
        REQUIRE(count <= chain.size());
        grouped_away += chain.size() - count;
        const auto brackets = pencil::bisect(coarse.pencil, 0, count, 0.0, 1.0, [](Index) {});
        for (Index j = 0; j < count; ++j) {
            const auto& b = brackets[static_cast<std::size_t>(j)];
            const double height = pencil::between(b.lower, b.upper), exact = truth.conical_height[j] / unit;
            CAPTURE(i, j, height, exact, coarse.spread);
            REQUIRE(height <= exact * (1 + 1e-12));
            REQUIRE(exact <= (height + coarse.spread) * (1 + 1e-12));
            if (coarse.spread == 0) continue;
            most = std::max(most, (exact - height) / coarse.spread);
        }
        if (count == chain.size()) {
            CHECK(coarse.spread == 0);
            ++left_alone;
        }
    }
    CHECK(grouped_away > 2000);
    CHECK(left_alone > 0);
    CHECK(most > 0.5);  // no idle bound
    CHECK(most <= 1);
}

TEST_CASE("grouped elements: short links whose radius of gyration is that of long ones") {
    Random random(82);
    Index grouped_away = 0;
    for (int i = 0; i < 200; ++i) {
        const Index size = static_cast<Index>(random.log_between(20, 200));
        const double lengths = random.between(1, 30), spread = random.log_between(1e-5, 0.1);
        std::vector<Link<double>> links;
        for (Index m = 0; m < size; ++m) {
            const double a = std::exp(lengths * random.between(-1, 1));
            links.push_back(compound_pendulum<double>({.weight = random.between(0.1, 2),
                                                       .length = a,
                                                       .centroid = a * random.between(0.01, 1.5),
                                                       .radius_of_gyration = 1.0}));
        }
        const Chain<double> chain(links);
        const Modes<double> truth = modes(chain, {.count = 1});
        const double unit = std::ldexp(1.0, chain.units().length_exponent), exact = truth.conical_height[0] / unit;
        const auto plain = plain_pencil(chain);
        REQUIRE(plain);
        const auto coarse = pencil::grouped(*plain, exact / 2, exact * spread);
        grouped_away += size - coarse.pencil.size();
        const auto bracket = pencil::bisect(coarse.pencil, 0, 1, 0.0, exact, [](Index) {}).front();
        const double height = pencil::between(bracket.lower, bracket.upper);
        CAPTURE(i, size, lengths, height, exact, coarse.spread);
        REQUIRE(height <= exact * (1 + 1e-10));
        REQUIRE(exact <= (height + coarse.spread) * (1 + 1e-10));
    }
    CAPTURE(grouped_away);
    CHECK(grouped_away > 2000);
}

TEST_CASE("grouped elements: of a uniform chain, short at the free end, and as many as the phase says") {
    const Chain<double> chain = Chain<double>::uniform_rods(20'000, 1.0);
    const auto plain = plain_pencil(chain);
    REQUIRE(plain);
    const double unit = std::ldexp(1.0, chain.units().length_exponent);
    for (const double groups : {10.0, 100.0}) {
        const double length = chain.total_length() / unit;
        // of n groups equally long in the square root of the place, each holds 2/3 L/n^2
        const double spread = 2.0 / 3 * length / (groups * groups);
        const auto coarse = pencil::grouped(*plain, spread, spread);
        CHECK(static_cast<double>(coarse.pencil.size()) == Approx(groups).epsilon(0.12));
        const auto& elements = coarse.pencil.elements;  // the last is what is left over
        CHECK(elements[elements.size() - 2].weight > 1.2 * (groups - 2) * elements.front().weight);
    }
}
