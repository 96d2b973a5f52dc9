// SPDX-License-Identifier: MPL-2.0
#include "revchain/branches.hpp"

#include "revchain/held.hpp"
#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::Branch;
using revchain::BranchEnd;
using revchain::Branches;
using revchain::Chain;
using revchain::Index;
using revchain::SteadyShape;

namespace {

Chain<double> plummets(Index n) { return Chain<double>::uniform_plummets(n, static_cast<double>(n), 1.0); }

/// At heights of its own choice: each shape of the proved list is on one branch, once, and branches have no others.
void check_at(const Chain<double>& chain, const Branches& found, double height) {
    const auto list = revchain::steady_shapes(chain, {.conical_height = height});
    REQUIRE(list.complete);
    std::vector<int> met(list.shapes.size(), 0);
    std::size_t crossings = 0;
    for (const Branch& branch : found.branches)
        for (const SteadyShape& state : branch.shapes_at(height)) {
            ++crossings;
            for (std::size_t j = 0; j < met.size(); ++j)
                met[j] += (list.shapes[j].inclination - state.inclination).cwiseAbs().maxCoeff() <=
                          1e-14 * std::max(1.0, state.condition);
        }
    CAPTURE(height);
    CHECK(crossings == list.shapes.size());
    CHECK(std::all_of(met.begin(), met.end(), [](int each) { return each == 1; }));
}

}  // namespace

TEST_CASE("three equal plummets: the third branch's companions are born at n = 3.90376215692 sqrt(g/a)", "[finite]") {
    const auto found = revchain::branches(plummets(3), {.min_conical_height = 1 / 25.0});
    CHECK(found.consistent);
    CHECK(found.complete);
    REQUIRE(found.branches.size() == 4);
    const Branch& born = found.branches[3];
    CHECK(born.mode == 0);
    REQUIRE(born.folds.size() == 1);
    CHECK(born.half_waves[0] == 3);
    CHECK(born.end == BranchEnd::height);
    const double speed = 1 / std::sqrt(born.conical_height[born.folds[0]]);
    CHECK(std::abs(speed - 3.90376215692) <= 1e-11);
    // the proved lists say the same: three shapes below, five beyond
    for (const double off : {1e-11, 1e-9}) {
        CHECK(revchain::steady_shapes(plummets(3), {.conical_height = 1 / std::pow(speed * (1 - off), 2)})
                  .shapes.size() == 3);
        CHECK(revchain::steady_shapes(plummets(3), {.conical_height = 1 / std::pow(speed * (1 + off), 2)})
                  .shapes.size() == 5);
    }
}

TEST_CASE("branches and proved lists agree, at heights that were not looked at before", "[finite]") {
    support::Random random(141);
    int isolated = 0;
    for (int i = 0; i < 20; ++i) {
        const Index n = 2 + i % 5;
        const auto chain = i < 5    ? plummets(n)
                           : i < 10 ? Chain<double>::uniform_rods(n, static_cast<double>(n), 1.0)
                                    : support::chain_of(n, [&](Index) {
                                          const double weight = random.log_between(1.0, 30.0);
                                          const double length = random.log_between(1.0, 5.0);
                                          return i % 2 == 0 ? revchain::uniform_rod<double>(weight, length)
                                                            : revchain::plummet<double>(weight, length);
                                      });
        const double lowest = chain.total_length() * random.log_between(3e-3, 1e-2);
        const Branches found = revchain::branches(chain, {.min_conical_height = lowest});
        CAPTURE(i, n, lowest);
        CHECK(found.consistent);
        CHECK(found.complete);
        const Index count = revchain::count_modes(chain, {.conical_height = lowest});
        REQUIRE(static_cast<Index>(found.branches.size()) >= count);
        isolated += static_cast<Index>(found.branches.size()) > count;
        for (const Branch& branch : found.branches)
            for (const int waves : branch.half_waves) CHECK(waves == branch.half_waves[0]);
        const double first = revchain::modes(chain, {.count = 1}).conical_height[0];
        for (int j = 0; j < 5; ++j) check_at(chain, found, lowest * random.log_between(1.0, first / lowest));
    }
    CHECK(isolated > 5);
}

TEST_CASE("a loop between the heights looked at: the proof finds it, lists do not", "[finite]") {
    const double weights[] = {12.1342, 26.048, 11.7601, 461.771}, lengths[] = {1.4122, 2.89757, 7.23786, 1.03565};
    const auto chain = support::chain_of(4, [&](Index m) { return revchain::plummet<double>(weights[m], lengths[m]); });
    const double lowest = 0.0057 * chain.total_length();
    for (const int lists : {1, 16}) {
        const auto unproved =
            revchain::branches(chain, {.min_conical_height = lowest, .lists = lists, .proof_budget = 0});
        CHECK(unproved.consistent);
        CHECK_FALSE(unproved.complete);
        const auto found = revchain::branches(chain, {.min_conical_height = lowest, .lists = lists});
        CHECK(found.complete);
        CHECK(found.remark == "proved complete: no branch is missing");
        REQUIRE(found.branches.size() == unproved.branches.size() + 1);
        CHECK(found.looked_at.size() == static_cast<std::size_t>(lists) + 1);  // and one through the loop
        CHECK(std::is_sorted(found.looked_at.begin(), found.looked_at.end(), std::greater<>()));
        const auto loop = std::find_if(found.branches.begin(), found.branches.end(),
                                       [](const Branch& each) { return each.end == BranchEnd::closed; });
        REQUIRE(loop != found.branches.end());
        REQUIRE(loop->folds.size() == 2);
        double ends[] = {loop->conical_height[loop->folds[0]], loop->conical_height[loop->folds[1]]};
        if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
        CHECK(std::abs(ends[0] / chain.total_length() - 0.0418736) < 1e-7);
        CHECK(std::abs(ends[1] / chain.total_length() - 0.0488881) < 1e-7);
        // proved lists have two shapes more within it
        const auto count = [&](double height) {
            return revchain::steady_shapes(chain, {.conical_height = height}).shapes.size();
        };
        CHECK(count(ends[0] * (1 + 1e-9)) == count(ends[0] * (1 - 1e-9)) + 2);
        CHECK(count(ends[1] * (1 - 1e-9)) == count(ends[1] * (1 + 1e-9)) + 2);
        for (const double share : {0.01, 0.3, 0.6, 0.99}) check_at(chain, found, ends[0] + share * (ends[1] - ends[0]));
        // next to the point where it begins and ends
        CHECK(std::is_sorted(loop->arc.begin(), loop->arc.end()));
        CHECK(loop->conical_height.front() == loop->conical_height.back());
        for (const double off : {0.0, 1e-6, -1e-6}) check_at(chain, found, loop->conical_height.front() * (1 + off));
    }
}

TEST_CASE("where the proof's budget ends, or a link hangs at several inclinations, it says so", "[finite]") {
    const auto some = revchain::branches(plummets(4), {.min_conical_height = 0.02, .proof_budget = 8000});
    CHECK(some.consistent);
    CHECK_FALSE(some.complete);
    CHECK(some.remark.find("between the heights 0.02 and ") != std::string::npos);
    const auto several = support::chain_of(2, [&](Index) {
        return revchain::compound_pendulum<double>(
            {.weight = 1.0, .length = 1.0, .centroid = 0.5, .pendulum_length = 2.0});
    });
    const auto open = revchain::branches(several, {.min_conical_height = 0.05});
    CHECK_FALSE(open.complete);
    CAPTURE(open.remark);
    CHECK((!open.consistent || open.remark.find("several inclinations") != std::string::npos));
}

TEST_CASE("eight plummets at n = 5.95 sqrt(g/a): all 84 shapes are on 8 branches and 38 isolated ones", "[finite]") {
    const auto found = revchain::branches(plummets(8), {.min_conical_height = 1 / 35.4025, .lists = 4});
    CHECK(found.consistent);
    Index ends = 0;
    for (const Branch& branch : found.branches) ends += branch.mode > 0 ? 1 : 2;
    CHECK(ends == 84);
}

TEST_CASE("states of a branch next to the vertical", "[finite]") {
    for (const Index n : {1, 3, 6})
        for (Index mode = 1; mode <= n; ++mode)
            for (const double down : {0.5, 1e-3, 1e-8}) {
                const auto chain = plummets(n);
                const double critical = revchain::modes(chain, {.first = mode, .count = 1}).conical_height[0];
                const Branch branch =
                    revchain::branch(chain, {.mode = mode, .min_conical_height = critical * (1 - down)});
                for (const double gap : {1e-2, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12, 1e-14}) {
                    CAPTURE(n, mode, down, gap);
                    const auto found = branch.shapes_at(critical * (1 - gap));
                    REQUIRE(found.size() == (gap <= down ? 1 : 0));
                    if (found.empty()) continue;
                    CHECK(found[0].half_waves == mode);
                    const auto same =
                        revchain::steady_shape(chain, {.mode = mode, .conical_height = critical * (1 - gap)});
                    CHECK((found[0].inclination - same.inclination).cwiseAbs().maxCoeff() <= 1e-15);
                }
                for (const double none : {critical, std::nextafter(critical, 9.0), critical * (1 + 1e-9), 2 * critical})
                    CHECK(branch.shapes_at(none).empty());
            }
}

TEST_CASE("weights 1e12 apart: three modes within 1.5e-6 of one height, each with its own branch", "[finite]") {
    const Chain<double> chain(
        {revchain::plummet(1e-12, 1.0), revchain::plummet(1.0, 1.0), revchain::plummet(1e12, 1.0)});
    const Branches found = revchain::branches(chain, {.min_conical_height = 0.1});
    CHECK(found.consistent);
    REQUIRE(found.branches.size() == 3);
    for (Index mode = 1; mode <= 3; ++mode) {
        const Branch& branch = found.branches[static_cast<std::size_t>(mode - 1)];
        CHECK(branch.mode == mode);
        CHECK(branch.end == BranchEnd::height);
        const auto shape = revchain::steady_shape(chain, {.mode = mode, .conical_height = 0.1});
        CHECK(std::abs(shape.inclination[0] - std::abs(branch.tip_inclination.back())) <= 1e-12);
    }
}

TEST_CASE("diagrams that end next to a critical height", "[finite]") {
    for (const Index n : {1, 2, 3})
        for (Index mode = 1; mode <= n; ++mode)
            for (const double gap : {1e-3, 1e-6, 1e-9, 1e-10, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16, 0.0}) {
                const auto chain = plummets(n);
                const double critical = revchain::modes(chain, {.first = mode, .count = 1}).conical_height[0];
                CAPTURE(n, mode, gap);
                const Branches found =
                    revchain::branches(chain, {.min_conical_height = critical * (1 - gap), .lists = 2});
                if (gap >= 1e-15) CHECK(static_cast<Index>(found.branches.size()) == mode);
                for (const Branch& branch : found.branches) CHECK(branch.size() >= 1);
                if (gap >= 1e-12) CHECK(found.consistent);
            }
}

TEST_CASE("no branch at all; errors", "[finite]") {
    const auto none = revchain::branches(plummets(3), {.min_conical_height = 3.0});
    CHECK(none.branches.empty());
    CHECK(none.remark == "no shape leaves the vertical at this height or above");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, nan})
        CHECK_THROWS_AS(revchain::branches(plummets(3), {.min_conical_height = bad}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::branches(plummets(3), {.min_conical_height = 0.1, .lists = 0}),
                    revchain::InvalidArgument);
}

TEST_CASE("the end of a branch is given as a speed or as a height", "[finite]") {
    const auto chain = plummets(3);
    const double gravity = 1.62, speed = 2.0, height = gravity / speed / speed;
    const Branch fast = revchain::branch(chain, {.mode = 1, .max_angular_speed = speed, .gravity = gravity}),
                 low = revchain::branch(chain, {.mode = 1, .min_conical_height = height});
    CHECK(fast.conical_height == low.conical_height);
    CHECK(fast.angular_speed(fast.size() - 1, gravity) == Approx(speed).epsilon(1e-12));
    const Branches all = revchain::branches(chain, {.max_angular_speed = speed, .lists = 2, .gravity = gravity});
    CHECK(all.conical_height == Approx(height).epsilon(1e-15));
    CHECK(revchain::steady_shape(chain, {.angular_speed = speed, .gravity = gravity}).inclination[0] ==
          Approx(fast.shape(fast.size() - 1).inclination[0]).epsilon(1e-12));
    using Catch::Matchers::ContainsSubstring;
    const auto either = ContainsSubstring("give either min_conical_height or max_angular_speed");
    CHECK_THROWS_WITH(revchain::branch(chain, {}), either);
    CHECK_THROWS_WITH(revchain::branch(chain, {.min_conical_height = 0.1, .max_angular_speed = 3.0}), either);
    CHECK_THROWS_WITH(revchain::branches(chain, {}), either);
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_AS(revchain::branch(chain, {.max_angular_speed = bad}), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::branches(chain, {.max_angular_speed = bad}), revchain::InvalidArgument);
        CHECK_THROWS_AS(low.shapes_at(bad), revchain::InvalidArgument);
    }
}
