// SPDX-License-Identifier: MPL-2.0
#include "revchain/system/edit.hpp"

#include "revchain/modes.hpp"
#include "revchain/two_links.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using support::Quad;

namespace {

/// A body about its link's upper pin, in quadruple precision: weight, first and second moment.
struct Moments {
    Quad weight, first, second;
};

Moments moments(const revchain::Link<double>& link) {
    const Quad W = link.weight, a = link.length, h = link.centroid;
    return {W, W * h, W * (h * h + support::quad(link.gyration_ratio) * a * a)};
}

double off(Quad x, Quad exact) { return static_cast<double>(fabsq(x / exact - 1)) / 0x1p-53; }

}  // namespace

TEST_CASE("a weight attached has the moments of both bodies, each rounded once", "[chain]") {
    support::Random random(5);
    double worst = 0;
    for (int round = 0; round < 2000; ++round) {
        const auto chain = support::chain_of(3, [&](Index) {
            const double a = random.log_between(1e-3, 1e3);
            return revchain::compound_pendulum<double>({.weight = random.log_between(1e-6, 1e6),
                                                        .length = a,
                                                        .centroid = a * random.between(0.01, 1.5),
                                                        .radius_of_gyration = a * random.log_between(1e-6, 10)});
        });
        const Index pin = round % 3;
        const double w = random.log_between(1e-9, 1e9), rho = round % 2 == 0 ? 0 : random.log_between(1e-3, 1e3);
        const auto with = revchain::with_weight(chain, w, pin, rho);
        const auto was = moments(chain.link(pin)), is = moments(with.link(pin));
        const Quad a = chain.link(pin).length;
        worst = std::max(worst, off(is.weight, was.weight + w));
        worst = std::max(worst, off(is.first, was.first + w * a));
        worst = std::max(worst, off(is.second, was.second + w * (a * a + Quad(rho) * rho)));
        for (Index m = 0; m < 3; ++m)
            if (m != pin) CHECK(with.link(m) == chain.link(m));
    }
    CAPTURE(worst);
    CHECK(worst <= 3);  // of weight and centroid; the second moment has the centroid's square
}

TEST_CASE("weights on plummets add, and change nothing else", "[chain]") {
    const auto chain = Chain<double>::uniform_plummets(4, 3.0, 8.0);
    const auto with = revchain::with_weight(chain, 5.0, 2);
    CHECK(with.link(2) == revchain::plummet(7.0, 0.75));
    CHECK(with.link(0) == chain.link(0));
    CHECK(revchain::with_weight(chain, 5.0).link(0) == revchain::plummet(7.0, 0.75));
    const auto threads = revchain::with_thread(chain, 0.5, 4);
    CHECK(threads.size() == 5);
    CHECK(threads.link(4) == revchain::plummet(0.0, 0.5));
    CHECK(revchain::with_weight(threads, 2.0, 4).link(4) == revchain::plummet(2.0, 0.5));
    // a thread between bodies, and what hangs from it, is a string with a longer link
    const auto longer = revchain::modes(revchain::with_thread(Chain<double>::uniform_plummets(1), 1.0, 1),
                                        {.count = revchain::all_modes});
    CHECK(longer.size() == 1);
    CHECK(longer.conical_height[0] == 2);
}

TEST_CASE("clamped links: the body of both, and its heights between those of the chain", "[chain]") {
    double worst = 0;
    for (const auto& family : support::families()) {
        const auto chain = family.make(6);
        const auto free = revchain::modes(chain, {.count = revchain::all_modes}).conical_height;
        for (Index m = 1; m < 6; ++m) {
            const auto one = revchain::clamped(chain, m - 1);
            CAPTURE(family.name, m);
            REQUIRE(one.size() == 5);
            const auto lower = moments(chain.link(m - 1)), upper = moments(chain.link(m)),
                       both = moments(one.link(m - 1));
            const Quad a = chain.link(m).length;
            worst = std::max(worst, off(both.weight, lower.weight + upper.weight));
            worst = std::max(
                worst, off(both.second, upper.second + lower.second + 2 * a * lower.first + a * a * lower.weight));
            const auto heights = revchain::modes(one, {.count = revchain::all_modes}).conical_height;
            for (Index j = 0; j < heights.size(); ++j) {
                CHECK(heights[j] <= free[j] * (1 + 1e-15));
                if (j + 1 < free.size()) CHECK(heights[j] >= free[j + 1] * (1 - 1e-15));
            }
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 3.5);
}

TEST_CASE("a uniform rod jointed where it does not bend whirls as the whole rod does, 8 (17)", "[chain]") {
    // A rod of length 2 from A to B, hung at C, jointed at D: CG.CD = CA^2.
    for (const double pin : {0.35, 0.45, 0.6, 0.8, 0.95}) {
        const double above = 1 - pin, joint = revchain::joint_without_bending(2.0, pin);  // CA, CD
        const double upper = above + joint, lower = 2 - upper;
        const Chain<double> jointed(
            {revchain::uniform_rod(lower, lower),
             revchain::compound_pendulum<double>({.weight = upper,
                                                  .length = joint,
                                                  .centroid = upper / 2 - above,
                                                  .radius_of_gyration = upper / std::sqrt(12.0)})});
        const auto whole = revchain::modes(revchain::clamped(jointed, 0), {.count = revchain::all_modes});
        const auto free = revchain::modes(jointed, {.count = revchain::all_modes});
        CAPTURE(pin);
        CHECK(std::abs(free.conical_height[0] / whole.conical_height[0] - 1) < 1e-15);
        CHECK(std::abs(whole.conical_height[0] / (pin + 1 / (3 * pin)) - 1) < 1e-15);
        CHECK(std::abs((free.shapes()(0, 0) - free.shapes()(0, 1)) / lower - free.shapes()(0, 1) / joint) < 2e-15);
    }
}

TEST_CASE("what cannot be attached is refused", "[chain]") {
    const auto chain = Chain<double>::uniform_rods(3);
    CHECK_THROWS_AS(revchain::with_weight(chain, 0.0, 1), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::with_weight(chain, 1.0, 3), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::with_weight(chain, 1.0, -1), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::with_weight(chain, 1.0, 1, -1.0), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::with_thread(chain, 1.0, 0), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::with_thread(chain, 1.0, 4), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::with_thread(chain, 0.0, 1), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::clamped(chain, 2), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::clamped(chain, -1), revchain::InvalidArgument);
}
