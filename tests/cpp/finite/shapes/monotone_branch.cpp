// SPDX-License-Identifier: MPL-2.0
#include "revchain/finite/shapes/monotone_branch.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using support::Quad;
using support::Random;

TEST_CASE("the tangents of a piece: all that carry a load, and derivatives only away from the joints", "[finite]") {
    using revchain::Interval;
    using revchain::finite::MonotoneBranch;
    using revchain::finite::Posture;
    Random random(308);
    int smooth = 0, met_in_all = 0, near_joint = 0;
    for (int i = 0; i < 4000; ++i) {
        // R(t) = k t - c t/sqrt(1 + t^2), from all but flat to c = 1e4 k
        const double k = random.log_between(1e-3, 1e3);
        const double c = k * (1 + (i % 3 == 0 ? random.log_between(1e-16, 1e-3) : random.log_between(1e-3, 1e4)));
        const revchain::finite::Link<Interval<double>> link{1.0, k, -c, 1.0, 0.0};
        const revchain::finite::Response<double> response(link, 1.0, Posture::hangs);
        REQUIRE_FALSE(response.is_single());
        const Quad ratio = cbrtq(Quad(c) / k), joint = sqrtq(ratio * ratio - 1);
        const auto load = [&](const Quad& t) { return k * t - c * t / sqrtq(1 + t * t); };
        const auto piece = std::array{MonotoneBranch::right, MonotoneBranch::middle,
                                      MonotoneBranch::left}[static_cast<std::size_t>(i / 3 % 3)];
        const auto on_piece = [&]() -> Quad {
            const double off = random.log_between(1e-9, 1.0);
            if (piece == MonotoneBranch::middle) return joint * (random() < 0.5 ? -1 : 1) * (1 - off);
            return (piece == MonotoneBranch::right ? 1 : -1) * joint * (1 + off * 100);
        };
        const Quad one = on_piece(), other = random() < 0.3   ? one
                                             : random() < 0.5 ? one * (1 + Quad(1e-6))
                                                              : on_piece();
        const double a = static_cast<double>(load(one)), b = static_cast<double>(load(other));
        const Interval<double> R(std::min(a, b), std::max(a, b));
        const auto met = response.met(piece, R);
        CAPTURE(k, c, static_cast<int>(piece), R.low, R.high);
        REQUIRE(met.possible);
        smooth += met.smooth;
        if (met.smooth) {  // one monotone stretch
            const bool inside = Quad(met.tangent.high) < joint && Quad(met.tangent.low) > -joint;
            const bool beyond = Quad(met.tangent.low) > joint || Quad(met.tangent.high) < -joint;
            CHECK((piece == MonotoneBranch::middle ? inside : beyond));
        } else {
            ++near_joint;
        }
        for (int j = 0; j < 20; ++j) {
            const Quad t = j < 2 ? (j == 0 ? one : other) : one + (other - one) * random();
            const bool is_on = piece == MonotoneBranch::middle ? fabsq(t) <= joint
                                                               : (piece == MonotoneBranch::right ? t : -t) >= joint;
            if (!is_on || load(t) < R.low || load(t) > R.high) continue;
            ++met_in_all;
            CHECK(Quad(met.tangent.low) <= t);
            CHECK(t <= Quad(met.tangent.high));
        }
    }
    CHECK(smooth > 2000);
    CHECK(near_joint > 200);
    CHECK(met_in_all > 40000);
}
