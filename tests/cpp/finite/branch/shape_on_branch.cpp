// SPDX-License-Identifier: MPL-2.0
#include "revchain/finite/branch/shape_on_branch.hpp"

#include "revchain/branches.hpp"
#include "revchain/modes.hpp"
#include "revchain/steady_shapes.hpp"
#include "revchain/two_links.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/quad_chain.hpp"

using revchain::Branch;
using revchain::BranchEnd;
using revchain::Chain;
using revchain::Index;
using revchain::SteadyShape;
using support::Quad;

namespace {

Chain<double> plummets(Index n) { return Chain<double>::uniform_plummets(n, static_cast<double>(n), 1.0); }

Chain<double> random_chain(support::Random& random, Index n, bool rods, double weights, double lengths) {
    return support::chain_of(n, [&](Index) {
        const double weight = random.log_between(1.0, weights), length = random.log_between(1.0, lengths);
        return rods ? revchain::uniform_rod<double>(weight, length) : revchain::plummet<double>(weight, length);
    });
}

double height_of(const Chain<double>& chain, Index mode) {
    return revchain::modes(chain, {.first = mode, .count = 1}).conical_height[0];
}

/// Largest error of an inclination at a height given.
double worst_error(const support::QuadChain& truth, const SteadyShape& shape, double height) {
    const auto exact = truth.balanced(shape.inclination, height);
    if (exact.empty()) return std::numeric_limits<double>::infinity();
    double worst = 0;
    for (std::size_t m = 0; m < exact.size(); ++m)
        worst = std::max(worst, static_cast<double>(fabsq(exact[m] - Quad(shape.inclination[static_cast<Index>(m)]))));
    return worst;
}

}  // namespace

TEST_CASE("a speed on a branch: 1 ... 1000 links, modes 1 ... 10, from the critical speed to 1e-4 of the length",
          "[finite]") {
    support::Random random(131);
    int checked = 0;
    for (const Index n : {1, 2, 3, 5, 10, 30, 100, 1000})
        for (const int kind : {0, 1, 2}) {
            const auto chain = kind == 0   ? Chain<double>::uniform_plummets(n, 1, 1)
                               : kind == 1 ? Chain<double>::uniform_rods(n, 1, 1)
                                           : random_chain(random, n, n % 2 == 0, 10, 3);
            const support::QuadChain truth(chain);
            for (const Index mode : {1, 2, 3, 5, 10}) {
                if (mode > n) break;
                const double critical = height_of(chain, mode), length = chain.total_length();
                for (const double height :
                     {critical * (1 - 2e-8), critical * (1 - 1e-5), critical * 0.99, critical * 0.7, critical * 0.25,
                      critical * 0.02, length * 1e-3, length * 1e-4}) {
                    if (!(height < critical)) continue;
                    CAPTURE(n, kind, mode, height / critical);
                    const SteadyShape shape = revchain::steady_shape(chain, {.mode = mode, .conical_height = height});
                    CHECK(shape.conical_height == height);
                    CHECK(shape.half_waves == mode);
                    CHECK(shape.offset[0] > 0);
                    const double error = worst_error(truth, shape, height);
                    CHECK(error <= 2.3e-16);
                    CHECK(error <= shape.error_bound);
                    CHECK(shape.residual <= 1e-18);
                    ++checked;
                }
            }
        }
    CHECK(checked > 500);
}

TEST_CASE("one link and two: the closed forms on each branch", "[finite]") {
    support::Random random(132);
    for (int i = 0; i < 100; ++i) {
        const double l = random.log_between(1e-3, 1e3), height = l * random.log_between(1e-3, 0.999);
        const Chain<double> one({revchain::plummet(2.0, l)});
        const auto shape = revchain::steady_shape(one, {.mode = 1, .conical_height = height});
        CHECK(support::error_in_ulp(shape.inclination[0], acosq(Quad(height) / l)) <= 2);

        const double W1 = random.log_between(0.01, 100.0), W2 = random.log_between(0.01, 100.0);
        const double l2 = l * random.log_between(0.01, 100.0);
        const Chain<double> two({revchain::plummet(W1, l), revchain::plummet(W2, l2)});
        CAPTURE(W1, l, W2, l2, height);
        for (const Index mode : {1, 2}) {
            if (!(height < height_of(two, mode))) continue;
            const auto found = revchain::steady_shape(two, {.mode = mode, .conical_height = height});
            double nearest = 1;
            for (const auto& closed : revchain::two_plummets_shapes(W1, l, W2, l2, height))
                if (closed.half_waves() == mode)
                    nearest = std::min(nearest, std::max(std::abs(closed.inclination[0] - found.inclination[0]),
                                                         std::abs(closed.inclination[1] - found.inclination[1])));
            CHECK(nearest <= 1e-9);
        }
    }
}

TEST_CASE("every point of a branch is in the proved list at its speed", "[finite]") {
    support::Random random(133);
    int folded = 0;
    for (int i = 0; i < 24; ++i) {
        const Index n = 2 + i % 5;
        const auto chain = i < 5 ? plummets(n) : random_chain(random, n, i % 2 == 0, 100, 10);
        for (Index mode = 1; mode <= n; ++mode) {
            const Branch branch = revchain::branch(
                chain, {.mode = mode, .min_conical_height = 0.02 * height_of(chain, mode), .max_step = 0.5});
            CAPTURE(i, n, mode);
            REQUIRE(branch.end == BranchEnd::height);
            CHECK(branch.conical_height.back() == Approx(0.02 * height_of(chain, mode)).epsilon(1e-9));
            folded += !branch.folds.empty();
            for (std::size_t at = 0; at < branch.size(); ++at) CHECK(branch.half_waves[at] == mode);
            for (std::size_t at = 2; at < branch.size(); at += 3) {
                const SteadyShape shape = branch.shape(at);
                CHECK(shape.conical_height == Approx(branch.conical_height[at]).epsilon(1e-12));
                CHECK(shape.inclination[0] == Approx(branch.tip_inclination[at]).epsilon(1e-10));
                CHECK(std::abs(shape.offset[0] - branch.tip_radius[at]) <= 1e-12 * chain.total_length());
                CHECK(shape.tension[n - 1] == Approx(branch.top_tension[at]).epsilon(1e-11));
                CHECK(shape.moment_of_inertia == Approx(branch.moment_of_inertia[at]).epsilon(1e-11));
                CHECK(shape.effective_energy == Approx(branch.effective_energy[at]).epsilon(1e-11));
                if (std::find(branch.folds.begin(), branch.folds.end(), at) != branch.folds.end()) continue;
                const auto list = revchain::steady_shapes(chain, {.conical_height = shape.conical_height});
                double nearest = 1;
                for (const SteadyShape& each : list.shapes)
                    nearest = std::min(nearest, (each.inclination - shape.inclination).cwiseAbs().maxCoeff());
                CHECK(nearest <= 1e-13 * std::max(1.0, shape.condition));
            }
        }
    }
    CHECK(folded > 0);
}

TEST_CASE("what people ask: tip inclination, tip radius and top tension come back", "[finite]") {
    support::Random random(134);
    int same = 0;
    for (int i = 0; i < 60; ++i) {
        const Index n = std::array<Index, 6>{1, 2, 3, 8, 40, 300}[static_cast<std::size_t>(i % 6)];
        const auto chain = random_chain(random, n, i % 2 == 0, 10, 5);
        const Index mode = 1 + i / 6 % std::min<Index>(n, 4);
        const double height = height_of(chain, mode) * (1 - random.log_between(1e-7, 0.9));
        const auto shape = revchain::steady_shape(chain, {.mode = mode, .conical_height = height});
        const support::QuadChain truth(chain);
        CAPTURE(i, n, mode, height);
        const double tip = shape.inclination[0], radius = shape.offset[0], tension = shape.tension[n - 1];
        const auto by_tip = revchain::steady_shape(chain, {.mode = mode, .tip_inclination = tip});
        CHECK(std::abs(by_tip.inclination[0] - tip) <= 2.3e-16);
        const auto by_radius = revchain::steady_shape(chain, {.mode = mode, .tip_radius = radius});
        CHECK(support::error_in_ulp(by_radius.offset[0], radius) <= 1);
        const auto by_tension = revchain::steady_shape(chain, {.mode = mode, .top_tension = tension});
        CHECK(support::error_in_ulp(by_tension.tension[n - 1], tension) <= 4);
        for (const SteadyShape* each : {&by_tip, &by_radius, &by_tension}) {
            CHECK(each->half_waves == mode);
            // the height is rounded: what that changes is in the condition at a given height
            const auto again = revchain::steady_shape(chain, {.mode = mode, .conical_height = each->conical_height});
            CHECK((again.inclination - each->inclination).cwiseAbs().maxCoeff() <=
                  1e-15 * std::max(1.0, again.condition));
            // what forces do at a height that is given is told exactly, and as the proved list tells it
            if (n > 8) continue;
            const auto list = revchain::steady_shapes(chain, {.conical_height = again.conical_height});
            for (const SteadyShape& proved : list.shapes)
                if ((proved.inclination - again.inclination).cwiseAbs().maxCoeff() < again.error_bound) {
                    CHECK(again.condition == Approx(proved.condition).epsilon(1e-9));
                    ++same;
                }
        }
        // on branch 1 all three grow all along: the state itself comes back, to what the number given can tell
        if (mode > 1) continue;
        for (const SteadyShape* each : {&by_tip, &by_radius, &by_tension})
            CHECK((each->inclination - shape.inclination).cwiseAbs().maxCoeff() <=
                  1e-13 * std::max(1.0, each->condition));
    }
    CHECK(same > 100);
}

TEST_CASE("bodies of any centroid: a shape of a branch is found by the size of its tip inclination and tip radius",
          "[finite]") {
    // where l > a the lowest link may lean either way, and the free end be on either side, when the other is positive
    support::Random random(135);
    int asked = 0, missed = 0, inwards = 0;
    const auto has = [](const revchain::ShapesOnBranch& found, const SteadyShape& shape) {
        return std::any_of(found.shapes.begin(), found.shapes.end(), [&](const SteadyShape& each) {
            const double same = (each.inclination - shape.inclination).cwiseAbs().maxCoeff();
            const double mirrored = (each.inclination + shape.inclination).cwiseAbs().maxCoeff();
            return std::min(same, mirrored) <= 1e-9 * std::max(1.0, each.condition);
        });
    };
    for (int i = 0; i < 400; ++i) {
        const auto chain = support::chain_of(2 + i % 5, [&](Index) {
            const double length = random.log_between(0.1, 10.0);
            return revchain::Link<double>{random.log_between(0.1, 10.0), length, length * random.between(0.05, 1.5),
                                          random.between(0.0, 1.0)};
        });
        const Index mode = 1 + i % std::min<Index>(chain.mode_count(), 4);
        const double critical = height_of(chain, mode), height = critical * random.between(0.05, 0.95);
        const auto shape = revchain::steady_shape(chain, {.mode = mode, .conical_height = height});
        const double tip = std::abs(shape.inclination[0]), radius = std::abs(shape.offset[0]);
        CAPTURE(i, mode, height / critical, tip, radius);
        inwards += shape.inclination[0] < 0;
        asked += 2;
        const double end = 0.9 * height;
        const bool by_tip =
            has(revchain::shapes_on_branch(chain, {.mode = mode, .tip_inclination = tip, .min_conical_height = end}),
                shape);
        const bool by_radius = has(
            revchain::shapes_on_branch(chain, {.mode = mode, .tip_radius = radius, .min_conical_height = end}), shape);
        CHECK(by_tip);
        CHECK(by_radius);
        missed += !by_tip + !by_radius;
    }
    CAPTURE(asked, missed, inwards);
    CHECK(missed == 0);
    CHECK(inwards > 20);
}

TEST_CASE("the onset of every branch is the pitchfork's", "[finite]") {
    // one plummet: cos d = lambda/l, sin^2 d = (l^2 - lambda^2)/l^2 -> 2 (1 - lambda/l)
    const auto rods = Chain<double>::uniform_rods(7, 1, 1);
    for (Index mode = 1; mode <= 7; ++mode) {
        const double critical = height_of(rods, mode);
        double last = 0;
        for (const double gap : {1e-6, 1e-8, 1e-10, 1e-12}) {
            const auto shape = revchain::steady_shape(rods, {.mode = mode, .conical_height = critical * (1 - gap)});
            const double ratio = shape.offset[0] / std::sqrt(gap);
            if (last != 0) CHECK(ratio == Approx(last).epsilon(gap < 1e-11 ? 2e-4 : 1e-4));
            last = ratio;
        }
    }
}

TEST_CASE("states of one branch at one speed, all of them", "[finite]") {
    // on branch 2 of three equal plummets the free end goes out to 0.555 and comes back to 0.5
    const auto found = revchain::shapes_on_branch(plummets(3), {.mode = 2, .tip_radius = 0.53});
    REQUIRE(found.shapes.size() == 2);
    for (const SteadyShape& shape : found.shapes) {
        CHECK(shape.offset[0] == Approx(0.53).epsilon(1e-15));
        CHECK(shape.half_waves == 2);
    }
    CHECK(found.shapes[0].conical_height > found.shapes[1].conical_height);
}

TEST_CASE("long chains: 100,000 rods, and where a mode is all but zero at the tip", "[finite]") {
    const auto rods = Chain<double>::uniform_rods(100'000, 1, 1);
    const double first = height_of(rods, 1);
    const auto shape = revchain::steady_shape(rods, {.mode = 1, .conical_height = first / 4});
    CHECK(shape.half_waves == 1);
    CHECK(worst_error(support::QuadChain(rods), shape, first / 4) <= 2.3e-16);
    const auto last =
        revchain::branch(Chain<double>::uniform_plummets(10, 1, 1), {.mode = 10, .min_conical_height = 1e-5});
    CHECK(last.end == BranchEnd::height);
}

TEST_CASE("branches that end next to the vertical: there is always the vertical, and a state in two words",
          "[finite]") {
    for (const Index n : {1, 2, 3, 10})
        for (Index mode = 1; mode <= n; ++mode) {
            const auto chain = plummets(n);
            const support::QuadChain truth(chain);
            const double critical = height_of(chain, mode);
            for (const double gap : {1e-2, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12, 1e-13, 1e-14, 4e-15}) {
                const double height = critical * (1 - gap);
                CAPTURE(n, mode, gap);
                const Branch branch = revchain::branch(chain, {.mode = mode, .min_conical_height = height});
                CHECK(branch.end == BranchEnd::height);
                REQUIRE(branch.size() >= 2);
                CHECK(branch.tip_inclination[0] == 0);
                CHECK(branch.conical_height[0] == critical);
                CHECK(branch.half_waves.back() == mode);
                CHECK(branch.conical_height.back() == Approx(height).epsilon(1e-9 * gap + 4e-16));
                const SteadyShape shape = branch.shape(branch.size() - 1);
                // from 1e-8 on the height is the one given; else told by its logarithm in double
                const double off = gap > 2e-8 ? 1e-12 : 4e-16 / std::sqrt(gap);
                CHECK(worst_error(truth, shape, branch.conical_height.back()) <= off);
                const auto same = revchain::steady_shape(chain, {.mode = mode, .conical_height = height});
                CHECK((shape.inclination.cwiseAbs() - same.inclination.cwiseAbs()).cwiseAbs().maxCoeff() <=
                      1e-3 * same.inclination.cwiseAbs().maxCoeff());
            }
            // one digit below: there, or the vertical alone
            const Branch least =
                revchain::branch(chain, {.mode = mode, .min_conical_height = std::nextafter(critical, 0)});
            REQUIRE(least.size() >= 1);
            CHECK((least.end == BranchEnd::height) == (least.size() == 2));
        }
}

TEST_CASE("as many points as asked for, at the most", "[finite]") {
    for (const std::size_t most : {1u, 2u, 3u, 7u}) {
        const Branch branch = revchain::branch(plummets(3), {.mode = 1, .min_conical_height = 0.1, .max_points = most});
        CHECK(branch.size() == most);
        CHECK(branch.end == BranchEnd::budget);
    }
    // the third branch turns: its fold counts too
    const auto chain = random_chain(*std::make_unique<support::Random>(133), 4, true, 100, 10);
    for (Index mode = 1; mode <= 4; ++mode)
        for (std::size_t most = 1; most < 60; ++most)
            CHECK(revchain::branch(
                      chain, {.mode = mode, .min_conical_height = 0.02 * height_of(chain, mode), .max_points = most})
                      .size() <= most);
}

TEST_CASE("the tip hardly off the axis: tip inclination and tip radius of 1e-3 ... 1e-14", "[finite]") {
    for (const Index n : {1, 3, 20})
        for (Index mode = 1; mode <= std::min<Index>(n, 3); ++mode) {
            const auto chain = plummets(n);
            const double critical = height_of(chain, mode);
            for (double given = 1e-3; given > 5e-15; given /= 10) {
                CAPTURE(n, mode, given);
                const auto by_tip = revchain::steady_shape(chain, {.mode = mode, .tip_inclination = given});
                CHECK(std::abs(by_tip.inclination[0] - given) <= 2.3e-16 * given);
                const auto by_radius = revchain::steady_shape(chain, {.mode = mode, .tip_radius = given});
                CHECK(support::error_in_ulp(by_radius.offset[0], given) <= 1);
                for (const SteadyShape* each : {&by_tip, &by_radius}) {
                    CHECK(each->half_waves == mode);
                    CHECK(each->conical_height == Approx(critical).epsilon(1e-4));
                    CHECK(each->conical_height <= critical * (1 + 0x1p-50));
                }
                CHECK(revchain::shapes_on_branch(chain, {.mode = mode, .tip_inclination = given}).shapes.size() >= 1);
            }
        }
}

TEST_CASE("fast modes of many plummets: lowest links inclined by 1e-20 ... 1e-220 to their own digits", "[finite]") {
    double least = 1;
    for (const auto& [n, mode, part] : {std::tuple<Index, Index, double>{50, 50, 0.999},
                                        {50, 50, 0.5},
                                        {30, 30, 0.5},
                                        {50, 43, 0.5},
                                        {50, 47, 0.5},
                                        {300, 200, 0.99},
                                        {300, 250, 0.99},
                                        {300, 300, 0.99},
                                        {300, 100, 0.5}}) {
        const auto chain = plummets(n);
        const double height = part * height_of(chain, mode);
        CAPTURE(n, mode, part);
        const auto shape = revchain::steady_shape(chain, {.mode = mode, .conical_height = height});
        CHECK(shape.half_waves == mode);
        CHECK(shape.residual <= 1e-18);
        CHECK(worst_error(support::QuadChain(chain), shape, height) <= 2.3e-16);
        // up from the tip, its offset given: tan d_m = sum of offsets so far/(lambda m). That the support is met on the axis
        // tells the tip's offset to its last digits.
        Quad y = shape.offset[0], sum = 0, widest = 0;
        for (Index m = 0; m < n; ++m) {
            sum += y, widest = std::max(widest, fabsq(y));
            const Quad tangent = sum / (Quad(height) * Quad(m + 1));
            y -= tangent / sqrtq(1 + tangent * tangent);
        }
        // far from the vertical that way up grows errors
        if (part > 0.9) CHECK(static_cast<double>(fabsq(y) / widest) <= 1e-14);
        least = std::min(least, shape.inclination[0]);
    }
    CHECK(least < 1e-200);
    CHECK(least > 0);
}

TEST_CASE("modes that all but coincide, weights 1e12 apart, pendulum lengths beyond the links", "[finite]") {
    for (const auto& family : support::families())
        for (const Index n : {2, 5, 12}) {
            const auto chain = family.make(n);
            const support::QuadChain truth(chain);
            const bool counted = family.name.find("upward") != std::string::npos;
            for (Index mode = 1; mode <= chain.mode_count(); ++mode) {
                const double critical = height_of(chain, mode);
                CAPTURE(family.name, n, mode);
                CHECK(revchain::branch(chain, {.mode = mode, .min_conical_height = 0.01 * critical}).end ==
                      BranchEnd::height);
                for (const double ratio : {1 - 1e-8, 0.9, 0.3, 0.02}) {
                    const auto shape =
                        revchain::steady_shape(chain, {.mode = mode, .conical_height = critical * ratio});
                    CAPTURE(ratio);
                    if (counted) CHECK(shape.half_waves == mode);
                    CHECK(shape.offset[0] > 0);
                    CHECK(worst_error(truth, shape, critical * ratio) <= 2.3e-16);
                }
            }
        }
}

TEST_CASE("a branch that is none: errors", "[finite]") {
    const auto chain = plummets(3);
    const double first = height_of(chain, 1), nan = std::numeric_limits<double>::quiet_NaN();
    for (const Index bad : {0, -1, 4}) {
        CHECK_THROWS_AS(revchain::branch(chain, {.mode = bad, .min_conical_height = 0.1}), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::steady_shape(chain, {.mode = bad, .conical_height = 0.1}), revchain::InvalidArgument);
    }
    for (const double bad : {0.0, -1.0, nan, first, 2 * first}) {
        CHECK_THROWS_AS(revchain::branch(chain, {.mode = 1, .min_conical_height = bad}), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::steady_shape(chain, {.mode = 1, .conical_height = bad}), revchain::InvalidArgument);
    }
    CHECK_THROWS_AS(revchain::steady_shape(chain, {.mode = 1}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::steady_shape(chain, {.mode = 1, .conical_height = 0.1, .tip_radius = 0.1}),
                    revchain::InvalidArgument);
    for (const double bad : {0.0, 1.5707963267948966, nan})
        CHECK_THROWS_AS(revchain::steady_shape(chain, {.mode = 1, .tip_inclination = bad}), revchain::InvalidArgument);
    for (const double bad : {0.0, 3.0, nan})
        CHECK_THROWS_AS(revchain::steady_shape(chain, {.mode = 1, .tip_radius = bad}), revchain::InvalidArgument);
    for (const double bad : {1 - 1e-15, 0.5, nan, std::numeric_limits<double>::infinity()})
        CHECK_THROWS_AS(revchain::steady_shape(chain, {.mode = 1, .top_tension = bad}), revchain::InvalidArgument);
    // the third branch never reaches that far out
    CHECK_THROWS_WITH(revchain::steady_shape(chain, {.mode = 3, .tip_radius = 2.5}),
                      Catch::Matchers::ContainsSubstring("not met on the branch of mode 3"));
    // what to do where the search ended for want of a smaller end
    CHECK_THROWS_WITH(revchain::steady_shape(chain, {.mode = 1, .top_tension = 1e9}),
                      Catch::Matchers::ContainsSubstring("give a smaller min_conical_height"));
    CHECK_NOTHROW(revchain::steady_shape(chain, {.mode = 1, .top_tension = 1e9, .min_conical_height = 1e-12}));
    for (const double bad : {first, 2 * first})
        CHECK_THROWS_WITH(revchain::steady_shape(chain, {.mode = 1, .tip_radius = 0.1, .min_conical_height = bad}),
                          Catch::Matchers::ContainsSubstring("min_conical_height must be less than"));
    CHECK_THROWS_AS(revchain::branch(chain, {.mode = 1, .min_conical_height = 0.1}).shape(0),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::branch(chain, {.mode = 1, .min_conical_height = 0.1}).shape(10'000),
                    revchain::InvalidArgument);
}
