// SPDX-License-Identifier: MPL-2.0
// Truth: `modes` of the chain itself to the last digit (0.5 ulp, itself tested against quadruple precision). Error: relative.
#include "revchain/models/heights.hpp"
#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using namespace revchain;
using namespace revchain::models;
using support::Random;

namespace {

struct Shares {
    double most = 0;      // of error over bound, within one answer to the other
    double foreseen = 0;  // the most of the bound foreseen over the bound
    double rounded = 0;   // error in ulp where the bound is mostly roundings
    double left_out = 0;  // of what the next order takes over its bound
};

/// All modes that the model takes of one chain, or some of them; n: links.
template <class M>
void compare(const M& model, const Chain<double>& chain, double exponent, Shares& shares, Index first = 1,
             Index count = 40) {
    const ChainKind kind(chain);
    const Index n = chain.size(), last = std::min<Index>(n / 2, first - 1 + count);
    const Modes<double> truth = modes(chain, {.first = first, .count = last + 1 - first});
    const revchain::detail::ZerosOfJ zeros(exponent);
    for (Index k = first; k <= last; ++k) {
        const Question question{.first = k, .count = 1};
        REQUIRE(model.applies(kind, question).applies);
        const Answer answer = model.solve(chain, kind, question);
        const double exact = truth.conical_height[k - first], bound = answer.error_bound[0];
        const double error = std::max(0.0, std::abs(answer.conical_height[0] / exact - 1) - 0x1p-53);
        const double foreseen = model.error_bound(kind, question);
        CAPTURE(exponent, n, k, error, bound, foreseen);
        REQUIRE(error <= bound);
        REQUIRE(bound <= foreseen * (1 + 1e-12));
        shares.most = std::max(shares.most, error / bound);
        shares.foreseen = std::max(shares.foreseen, foreseen / bound);
        if (bound < 20 * 0x1p-52) shares.rounded = std::max(shares.rounded, error / 0x1p-52);
        // cord/chain = 1 + lost (1 - d): 0 <= d <= the bound, where rounding lets that be seen
        const double j = zeros(k), cord = 4 * (exponent + 1) * chain.total_length() / (j * j);
        const double lost =
            models::detail::second_order(exponent, j) / (static_cast<double>(n) * static_cast<double>(n));
        const double d = 1 - (cord / exact - 1) / lost,
                     next = models::detail::next_order(exponent, k, chain.length()[0] / cord);
        if (lost * next > 1e-12) {
            REQUIRE(d >= -1e-3 * next);
            REQUIRE(d <= next);
            shares.left_out = std::max(shares.left_out, next < 1 ? d / next : 0);
        }
    }
}

}  // namespace

TEST_CASE("tapered chain: as near to the links as it says") {
    Shares shares;
    for (const double exponent :
         {-0.98, -0.95, -0.9, -0.8, -0.65, -0.5, -0.4, -0.2, -0.05, -1e-6, 1e-6, 0.05, 0.2,  0.35,
          0.5,   0.51,  0.75, 1.0,  1.3,   2.0,  3.0,  5.0,  8.0,   13.0,  20.0, 35.0, 60.0, 100.0}) {
        Shares here;
        for (const Index n : {2, 3, 4, 5, 6, 7, 8, 10, 12, 16, 25, 40, 80, 150, 400}) {
            if (exponent * std::log10(static_cast<double>(n)) > 285) continue;
            compare(models::TaperedChain{}, Chain<double>::tapered(n, 2.5, exponent, 3.0), exponent, here);
        }
        CHECK(here.left_out > 0.5);  // the bound is not idle
        shares.left_out = std::max(shares.left_out, here.left_out);
        shares.foreseen = std::max(shares.foreseen, here.foreseen);
        shares.most = std::max(shares.most, here.most), shares.rounded = std::max(shares.rounded, here.rounded);
    }
    CAPTURE(shares.most, shares.left_out, shares.foreseen, shares.rounded);
    CHECK(shares.left_out <= 0.95);
    CHECK(shares.foreseen <= 2);
    CHECK(shares.most > 0.8);
    CHECK(shares.rounded <= 5);
}

TEST_CASE("tapered chain: fast modes of long chains") {
    Shares shares;
    for (const double exponent : {-0.95, -0.5, 0.3, 1.0, 2.0, 5.0, 8.0, 12.0, 20.0, 35.0, 58.0}) {
        const auto chain = Chain<double>::tapered(30'000, 2.5, exponent, 3.0);
        for (const Index k : {11, 30, 60, 100, 150, 250, 400, 700, 2000, 15'000})
            compare(models::TaperedChain{}, chain, exponent, shares, k, 1);
    }
    CHECK(shares.left_out <= 0.95);
}

TEST_CASE("tapered chain: long chains to the last digits") {
    Shares shares;
    for (const double exponent : {-0.98, -0.9, -0.6, -0.3, 0.5, 1.0, 2.0, 10.0})
        compare(models::TaperedChain{}, Chain<double>::tapered(100'000, 0.7, exponent, 3.0), exponent, shares, 1, 3);
    CHECK(shares.rounded > 0);
    CHECK(shares.rounded <= 3);
    CAPTURE(shares.rounded);
    CHECK(models::TaperedChain{}.error_bound(ChainKind(Chain<double>::tapered(100'000, 1.0, 1.0)), {.count = 3}) <=
          2e-15);
}

TEST_CASE("tapered chain: what it is for") {
    const models::TaperedChain model;
    const auto fit = [&](double exponent, Index n, Index last) {
        return model.applies(ChainKind(Chain<double>::tapered(n, 1.0, exponent)), {.first = last}).applies;
    };
    CHECK(fit(1.0, 10, 5));
    CHECK(!fit(1.0, 10, 6));
    CHECK(!fit(0.0, 10, 1));  // equal rods
    CHECK(!fit(-0.99, 10, 1));
    CHECK(!fit(101.0, 10, 1));
    CHECK(!model.applies(ChainKind(Chain<double>::uniform_plummets(10)), {}).applies);
    const auto chain = Chain<double>::tapered(10'000, 2.0, 1.5);
    const Solution found = solve(chain, {.count = 3, .rtol = 1e-12});
    CHECK(found.model == models::TaperedChain::name);
    CHECK(found.status == Status::success);
    const Chain<double> told(10'000, chain.weight(), chain.length(), chain.centroid(), chain.gyration_ratio());
    CHECK(solve(told, {.count = 3, .rtol = 1e-12}).model != models::TaperedChain::name);  // it does not know
}

TEST_CASE("continuous chain of equal rods: as near to the links as it says") {
    Shares shares;
    for (const Index n : {2, 3, 4, 5, 6, 7, 8, 10, 12, 16, 25, 40, 80, 150, 400, 1500, 10'000, 100'000, 1'000'000})
        compare(models::ContinuousChain{}, Chain<double>::uniform_rods(n, 2.5), 0, shares);
    CHECK(shares.left_out <= 0.95);
    CHECK(shares.left_out > 0.7);
    CHECK(shares.rounded <= 3);
}
