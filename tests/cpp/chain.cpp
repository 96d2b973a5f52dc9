// SPDX-License-Identifier: MPL-2.0
#include "revchain/chain.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"

using Catch::Matchers::ContainsSubstring;
using Chain = revchain::Chain<double>;
using Links = std::vector<revchain::Link<double>>;
using revchain::compound_pendulum;
using revchain::plummet;
using revchain::uniform_rod;

namespace {
const double nan_value = std::nan("");
const double infinity = std::numeric_limits<double>::infinity();
}  // namespace

TEST_CASE("a chain keeps what it is given", "[chain]") {
    const Links links{plummet(1.0, 0.5), uniform_rod(2.0, 0.3)};
    const Chain chain(links);
    CHECK(chain.size() == 2);
    CHECK(chain.total_weight() == 3.0);
    CHECK(chain.total_length() == 0.8);
    CHECK(chain.link(1).weight == 2.0);
    CHECK(chain.link(1).centroid == 0.15);
    CHECK(chain == Chain(links));
    CHECK_FALSE(chain == Chain(Links{plummet(1.0, 0.5), uniform_rod(2.0, 0.31)}));
}

TEST_CASE("one number for all links is stored once", "[chain]") {
    const Chain chain = Chain::uniform_rods(10'000'000, 5.0, 2.0);
    CHECK(chain.weight().stored() + chain.length().stored() + chain.centroid().stored() +
              chain.gyration_ratio().stored() ==
          4);
    CHECK(chain.size() == 10'000'000);
    CHECK(chain.total_length() == Approx(5.0).epsilon(1e-15));
    CHECK(chain.total_weight() == Approx(2.0).epsilon(1e-15));
    CHECK(chain.link(9'999'999).length == 5.0 / 10'000'000);
    const Chain mixed(3, std::vector<double>{1, 2, 3}, 0.5, 0.5, revchain::Wide<double>(0));
    CHECK(mixed == Chain(3, std::vector<double>{1, 2, 3}, 0.5, 0.5, revchain::Wide<double>(0)));
    CHECK(mixed.link(2).weight == 3.0);
}

TEST_CASE("a uniform chain costs nothing to check", "[chain]") {
    const Chain chain = Chain::uniform_rods(1'000'000'000'000, 5.0, 2.0);
    CHECK(chain.mode_count() == 1'000'000'000'000);
    CHECK(chain.total_length() == Approx(5.0).epsilon(1e-15));
    CHECK_THROWS_AS(Chain(Chain(Links{plummet(1.0, 1.0)}).size() + 9, 1e308, 1.0, 1.0, revchain::Wide<double>(0)),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(Chain(10, 1.0, 1e308, 1.0, revchain::Wide<double>(0)), revchain::InvalidArgument);
    CHECK_THROWS_AS(Chain(10, 1.0, 1.0, -0.5, revchain::Wide<double>(1)), revchain::InvalidArgument);
    CHECK(Chain(10, 1.0, 1.0, 0.5, revchain::Wide<double>(0)).mode_count() == 10);
}

TEST_CASE("double words that are none", "[chain]") {
    using WideDouble = revchain::Wide<double>;
    CHECK_THROWS_AS(Chain(Links{{1.0, 1.0, 0.5, WideDouble(0.1, nan_value)}}), revchain::InvalidArgument);
    CHECK_THROWS_AS(Chain(Links{{1.0, 1.0, 0.5, WideDouble(0.1, -0.2)}}), revchain::InvalidArgument);
    CHECK_THROWS_AS(Chain(Links{{1.0, 1.0, 0.5, WideDouble(0.0, 1e-9)}}), revchain::InvalidArgument);
}

TEST_CASE("weights and lengths are summed without loss", "[chain]") {
    // 1e6 times 0.1: a plain sum is off by 1e-6 relative 1e-11
    CHECK(Chain(1'000'000, 0.1, 0.1, 0.1, revchain::Wide<double>(0)).total_weight() == 100000.0 * (1 + 0x1p-54));
}

TEST_CASE("modes are counted by the rank of the mass matrix", "[chain]") {
    const auto point = [](double h) {
        return compound_pendulum<double>({.weight = 1, .length = 1, .centroid = h, .radius_of_gyration = 0});
    };
    const auto thread = plummet(0.0, 1.0);
    const auto bead = plummet(1.0, 1.0);
    const auto rod = uniform_rod(1.0, 1.0);
    CHECK(Chain(Links{bead}).mode_count() == 1);
    CHECK(Chain(Links{bead, bead, bead}).mode_count() == 3);
    CHECK(Chain(Links{bead, thread, bead}).mode_count() == 2);
    CHECK(Chain(Links{bead, bead, thread}).mode_count() == 2);
    CHECK(Chain(Links{bead, thread, thread}).mode_count() == 1);
    // a rod on a thread (Greenhill §6 (11)): the thread's lower pin carries the rod's inertia, two modes
    CHECK(Chain(Links{rod, thread}).mode_count() == 2);
    CHECK(Chain(Links{rod, thread, rod}).mode_count() == 3);
    CHECK(Chain(Links{rod, thread, bead}).mode_count() == 3);
    CHECK(Chain(Links{rod, thread, thread, rod}).mode_count() == 3);
    // mass point within the link: one coordinate each
    CHECK(Chain(Links{point(0.5), point(0.5)}).mode_count() == 2);
    CHECK(Chain(Links{point(0.5), thread}).mode_count() == 1);
    // all mass at the upper pin of the second link: its lower pin moves freely, but the bead below holds it
    CHECK(Chain(Links{bead, point(0.0)}).mode_count() == 1);
}

TEST_CASE("a wrong chain is refused, naming the link and the value", "[chain]") {
    CHECK_THROWS_WITH(Chain(Links{}), ContainsSubstring("at least one link"));
    CHECK_THROWS_WITH(
        Chain(Links{plummet(1.0, 1.0), plummet(1.0, 1.0), plummet(1.0, -0.5)}),
        Catch::Matchers::Equals("revchain::Chain: links[2]: length must be positive and finite, got -0.5"));
    CHECK_THROWS_WITH(Chain(Links{plummet(1.0, 0.0)}), ContainsSubstring("links[0]: length"));
    CHECK_THROWS_WITH(Chain(Links{plummet(1.0, nan_value)}), ContainsSubstring("links[0]: length"));
    CHECK_THROWS_WITH(Chain(Links{plummet(nan_value, 1.0)}), ContainsSubstring("links[0]: weight"));
    CHECK_THROWS_WITH(Chain(Links{plummet(infinity, 1.0)}), ContainsSubstring("links[0]: weight"));
    CHECK_THROWS_WITH(Chain(Links{plummet(1.0, 1.0), plummet(-2.0, 1.0)}),
                      ContainsSubstring("links[1]: weight") && ContainsSubstring("-2"));
    CHECK_THROWS_WITH(Chain(Links{plummet(0.0, 1.0), plummet(1.0, 1.0)}),
                      ContainsSubstring("lowest link must have weight"));
    CHECK_THROWS_WITH(Chain(Links{plummet(1e308, 1.0), plummet(1.1e308, 1.0)}),
                      ContainsSubstring("links[1]: the weights add up to infinity"));
    CHECK_THROWS_WITH(Chain(Links{plummet(1.0, 1e308), plummet(1.0, 1e308)}), ContainsSubstring("lengths add up"));
    CHECK_THROWS_WITH(Chain(Links{{1.0, 1.0, infinity, 0.0}}), ContainsSubstring("centroid"));
    CHECK_THROWS_WITH(Chain(Links{{1.0, 1.0, 0.5, -1.0}}), ContainsSubstring("radius of gyration"));
    CHECK_THROWS_WITH(Chain(Links{{1.0, 1.0, 0.0, 1.0}}), ContainsSubstring("links[0]: it would stand"));
    CHECK_THROWS_WITH(Chain(Links{plummet(1.0, 1.0), {10.0, 1.0, -0.2, 1.0}}),
                      ContainsSubstring("links[1]: it would stand") && ContainsSubstring("-1"));
    CHECK_NOTHROW(Chain(Links{plummet(1.0, 1.0), {4.9, 1.0, -0.2, 1.0}}));
    CHECK_THROWS_WITH(Chain(2, std::vector<double>{1, 2, 3}, 1.0, 1.0, revchain::Wide<double>(0)),
                      ContainsSubstring("weight must have one number"));
    CHECK_THROWS_AS(Chain::uniform_rods(0), revchain::InvalidArgument);
    CHECK_THROWS_AS(Chain::uniform_rods(-3), revchain::InvalidArgument);
    CHECK_THROWS_AS(Chain::uniform_rods(3, -1.0), revchain::InvalidArgument);
    CHECK_THROWS_AS(Chain::uniform_plummets(3, 1.0, nan_value), revchain::InvalidArgument);
}

TEST_CASE("any unit of weight and length is taken, and any ratio of weights", "[chain]") {
    for (const double unit : {5e-324, 1e-300, 1e-100, 1.0, 1e100, 1e300}) {
        CHECK_NOTHROW(Chain(Links{plummet(unit, 1.0), plummet(2 * unit, 1.0)}));
        CHECK_NOTHROW(Chain(Links{plummet(1.0, unit), uniform_rod(2.0, unit)}));
        CHECK_NOTHROW(Chain(Links{plummet(unit, 1.0), plummet(1 / std::max(unit, 1e-308), 1.0)}));
        CHECK(Chain(1, unit, 1.0, 1.0, revchain::Wide<double>(0)).total_weight() == unit);
        // -1/4 + 1/2 > 0
        CHECK_NOTHROW(Chain(Links{plummet(unit, 1.0), {unit, 2.0, -0.5, 1.0}}));
        CHECK_THROWS_WITH(Chain(Links{plummet(unit, 1.0), {unit, 2.0, -2.0, 1.0}}), ContainsSubstring("stand"));
        CHECK_THROWS_WITH(Chain(Links{plummet(1.0, unit), {1.0, unit, -unit, 1.0}}), ContainsSubstring("stand"));
    }
    CHECK(Chain(Links{plummet(1e60, 1.0), plummet(1e-60, 1.0)}).has_one_weight_unit());
    CHECK_FALSE(Chain(Links{plummet(1e70, 1.0), plummet(1e-70, 1.0)}).has_one_weight_unit());
    CHECK_FALSE(Chain(Links{plummet(1e-300, 1.0), plummet(1e300, 1.0)}).has_one_weight_unit());
    CHECK(Chain(Links{plummet(1.0, 1.0), plummet(0.0, 1.0)}).has_one_weight_unit());
}

TEST_CASE("lengths too far apart are refused", "[chain]") {
    CHECK_NOTHROW(Chain(Links{plummet(1.0, 1e-38), plummet(1.0, 1e38)}));
    CHECK_THROWS_WITH(Chain(Links{plummet(1.0, 1e-40), plummet(1.0, 1e40)}), ContainsSubstring("lengths span"));
    CHECK_THROWS_WITH(Chain(Links{{1.0, 1.0, 1e-80, 1.0}}), ContainsSubstring("lengths span"));
    CHECK_THROWS_WITH(Chain(Links{{1.0, 1.0, 1.0, 1e-160}}), ContainsSubstring("radius of gyration is too far"));
    CHECK_THROWS_WITH(Chain(Links{{1.0, 1.0, 1.0, 1e160}}), ContainsSubstring("radius of gyration is too far"));
}

TEST_CASE("links are written by name where the chain is made", "[chain]") {
    const Chain chain({{.weight = 1.0, .length = 2.0, .centroid = 2.0}, {.weight = 3.0, .length = 4.0}});
    CHECK(chain.link(0) == revchain::plummet(1.0, 2.0));
    CHECK(chain.link(1) == revchain::Link<double>{3.0, 4.0, 0.0, 0.0});
}

TEST_CASE("links that are all the same are stored once", "[chain]") {
    const Chain equal(std::vector<revchain::Link<double>>(1000, revchain::uniform_rod(2.0, 0.25)));
    CHECK(equal.weight().is_scalar());
    CHECK(equal.gyration_ratio().is_scalar());
    CHECK(equal == Chain::uniform_rods(1000, 250.0, 2000.0));
    CHECK_THROWS_WITH(Chain(std::vector{plummet(1e308, 1.0), plummet(1e308, 1.0)}),
                      ContainsSubstring("the weights add up to infinity"));
    std::vector<revchain::Link<double>> links(1000, revchain::uniform_rod(2.0, 0.25));
    links.back().centroid = 0.1;
    const Chain unlike(links);
    CHECK(unlike.weight().stored() == 1000);
    CHECK(unlike.link(999).centroid == 0.1);
    CHECK(unlike.link(998).centroid == 0.125);
}
