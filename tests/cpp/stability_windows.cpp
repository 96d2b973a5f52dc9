// SPDX-License-Identifier: MPL-2.0
#include "revchain/stability_windows.hpp"

#include "revchain/modes.hpp"
#include "support/catch.hpp"

using revchain::Branch;
using revchain::Chain;
using revchain::Index;
using revchain::StabilityFrame;
using revchain::Verdict;

namespace {

double height_of(const Chain<double>& chain, Index mode) {
    return revchain::modes(chain, {.first = mode, .count = 1}).conical_height[0];
}

}  // namespace

TEST_CASE("two links, second branch: stable down to 0.463321 (plummets) and 0.500763 (rods)", "[finite]") {
    for (const bool rods : {false, true}) {
        const auto chain = rods ? Chain<double>::uniform_rods(2, 2, 1) : Chain<double>::uniform_plummets(2, 2, 1);
        const double critical = height_of(chain, 2);
        const Branch branch = revchain::branch(chain, {.mode = 2, .min_conical_height = 0.05 * critical});
        const auto windows = revchain::stability_windows(chain, branch, {.tolerance = 1e-9});
        REQUIRE(windows.size() == 2);
        CHECK(windows[0].verdict == Verdict::spectrally_stable);
        CHECK(windows[1].verdict == Verdict::unstable);
        CHECK(windows[0].height_to == windows[1].height_from);
        CHECK(windows[0].arc_to == windows[1].arc_from);
        CHECK(std::abs(windows[1].height_from / critical - (rods ? 0.500763 : 0.463321)) <= 6e-7);
        CHECK(windows[1].height_to == Approx(0.05 * critical).epsilon(1e-9));
        // the verdict itself on either side of the edge
        for (const double off : {-1e-7, 1e-7}) {
            const double height = windows[1].height_from * (1 + off);
            const auto shapes = branch.shapes_at(height);
            REQUIRE(shapes.size() == 1);
            const bool stable = revchain::stability(chain, shapes[0]).verdict == Verdict::spectrally_stable;
            CHECK(stable == (off > 0));
        }
    }
}

TEST_CASE("windows cover the branch, one after another", "[finite]") {
    const auto chain = Chain<double>::uniform_plummets(3, 3, 1);
    for (Index mode = 1; mode <= 3; ++mode) {
        const Branch branch =
            revchain::branch(chain, {.mode = mode, .min_conical_height = 0.05 * height_of(chain, mode)});
        for (const auto frame : {StabilityFrame::free, StabilityFrame::driven}) {
            const auto windows = revchain::stability_windows(chain, branch, {.frame = frame});
            CHECK(windows.front().arc_from == branch.arc[1]);
            CHECK(windows.back().arc_to == branch.arc.back());
            for (std::size_t i = 1; i < windows.size(); ++i) {
                CHECK(windows[i].arc_from == windows[i - 1].arc_to);
                CHECK(windows[i].verdict != windows[i - 1].verdict);
            }
            if (mode == 1) CHECK(windows.size() == 1);
            if (mode == 1) CHECK(windows[0].verdict == Verdict::minimum);
            if (mode > 1 && frame == StabilityFrame::driven) CHECK(windows[0].verdict == Verdict::unstable);
        }
    }
}

TEST_CASE("two verdicts meet at an edge, not at an undecided window shorter than the tolerance", "[finite]") {
    const revchain::Support mast{.stiffness = 1000 / 9.80665, .carriage_weight = 30, .radius = 3};
    int edges = 0;
    for (int k = 0; k < 12; ++k) {
        const double rider = 110 + 2 * k;
        const Chain<double> chain({revchain::compound_pendulum<double>(
                                       {.weight = 8 + rider, .length = 1, .centroid = 0.8, .radius_of_gyration = 0.3}),
                                   revchain::uniform_rod(10.0, 4.0)});
        const revchain::Rig rig(chain, {.support = mast});
        for (const Branch& branch : revchain::branches(rig, {.min_conical_height = 1.8}).branches) {
            const auto windows = revchain::stability_windows(rig, branch);
            for (std::size_t i = 1; i + 1 < windows.size(); ++i)
                CHECK_FALSE((windows[i].verdict == Verdict::undecided &&
                             windows[i - 1].verdict != windows[i + 1].verdict &&
                             windows[i].arc_to - windows[i].arc_from <= 1e-6));
            edges += static_cast<int>(windows.size()) - 1;
        }
    }
    CHECK(edges >= 5);
}

TEST_CASE("a link that passes the vertical leaves no undecided window", "[finite]") {
    const Chain<double> chain({revchain::plummet(90.0, 2.0), revchain::plummet(90.0, 2.0)});
    const revchain::Rig rig(chain, {.support = revchain::carried_round(0.5)});
    int passing = 0;
    for (const Branch& branch : revchain::branches(rig, {.max_angular_speed = 8.0}).branches) {
        for (const auto& window : revchain::stability_windows(rig, branch)) CHECK(window.verdict != Verdict::undecided);
        for (std::size_t i = 1; i < branch.size(); ++i)
            passing += branch.shape(i - 1).inclination[1] * branch.shape(i).inclination[1] < 0;
    }
    CHECK(passing > 0);
}

TEST_CASE("windows of nothing; errors", "[finite]") {
    const auto chain = Chain<double>::uniform_plummets(2, 2, 1);
    const Branch branch = revchain::branch(chain, {.mode = 1, .min_conical_height = 0.5});
    CHECK(revchain::stability_windows(chain, Branch{}).empty());
    CHECK_THROWS_AS(revchain::stability_windows(chain, branch, {.tolerance = 0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::stability_windows(chain, branch, {.samples = 0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::stability_windows(Chain<double>::uniform_plummets(3, 2, 1), branch),
                    revchain::InvalidArgument);
}
