// SPDX-License-Identifier: MPL-2.0
// Without `thorough` questions have the same answers, or say that they need it.
#include "revchain/thorough.hpp"

#include <algorithm>
#include <cmath>

#include "revchain/branches.hpp"
#include "revchain/finite/branch/diagram.hpp"
#include "revchain/finite/shapes/shapes_by.hpp"
#include "revchain/finite/stability/judged.hpp"
#include "revchain/stability.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::InvalidArgument;
using revchain::Posture;
using revchain::Rig;
using revchain::Stability;
using revchain::StabilityFrame;
using revchain::SteadyShape;
using revchain::SteadyShapes;
using revchain::SteadyShapesOptions;
using revchain::thorough;
using revchain::Verdict;
using support::Random;

namespace {

/// The means of a program that includes the headers and does not give `thorough`.
struct Brief {};

template <class System, class Options>
SteadyShapes briefly(const System& system, const Options& options) {
    return revchain::finite::shapes_by(system, options, Brief{});
}

bool same(const SteadyShape& x, const SteadyShape& y) {
    return x.inclination == y.inclination && x.error_bound == y.error_bound && x.condition == y.condition;
}

}  // namespace

TEST_CASE("Lists of ordinary chains are the same without thorough") {
    Random random(3);
    int shapes = 0;
    for (int round = 0; round < 150; ++round) {
        const auto size = static_cast<Index>(1 + round % 6);
        const auto chain = support::chain_of(size, [&](Index) {
            const double weight = random.log_between(0.01, 100), length = random.log_between(0.05, 5);
            return random() < 0.5 ? revchain::plummet(weight, length) : revchain::uniform_rod(weight, length);
        });
        const double height = chain.total_length() * random.log_between(0.005, 1);
        const SteadyShapesOptions options{.conical_height = height, .budget = 200'000};
        const SteadyShapes brief = briefly(chain, options);
        const SteadyShapes whole = revchain::steady_shapes(chain, options, thorough);
        INFO(size << " links, height " << height);
        REQUIRE(brief.shapes.size() == whole.shapes.size());
        CHECK(std::equal(brief.shapes.begin(), brief.shapes.end(), whole.shapes.begin(), same));
        CHECK(brief.complete == whole.complete);
        CHECK(brief.cells == whole.cells);
        const SteadyShapes rig = briefly(Rig(chain, {}), revchain::RigShapesOptions{.conical_height = height});
        CHECK((!rig.complete || rig.shapes.size() == whole.shapes.size()));
        shapes += static_cast<int>(brief.shapes.size());
    }
    CHECK(shapes > 200);
}

TEST_CASE("Almost level links without thorough: proved bounds, or left undecided") {
    Random random(4);
    int undecided = 0, sharper = 0;
    for (int round = 0; round < 60; ++round) {
        const auto chain = support::chain_of(static_cast<Index>(1 + round % 4), [&](Index) {
            return revchain::plummet(random.log_between(0.1, 10), random.between(0.5, 2));
        });
        const SteadyShapesOptions options{.conical_height = random.log_between(1e-13, 1e-4), .budget = 20'000};
        const SteadyShapes brief = briefly(chain, options);
        const SteadyShapes whole = revchain::steady_shapes(chain, options, thorough);
        CHECK((whole.complete || !brief.complete));
        CHECK(brief.shapes.size() <= whole.shapes.size());
        CHECK((brief.shapes.size() == whole.shapes.size() || !brief.complete));
        undecided += brief.shapes.size() < whole.shapes.size() ? 1 : 0;
        for (const SteadyShape& shape : brief.shapes) {
            const bool known = std::any_of(whole.shapes.begin(), whole.shapes.end(), [&](const SteadyShape& x) {
                const double apart = (x.inclination - shape.inclination).cwiseAbs().maxCoeff();
                sharper += apart <= shape.error_bound && x.error_bound < shape.error_bound ? 1 : 0;
                return apart <= x.error_bound + shape.error_bound;
            });
            CHECK(known);
        }
    }
    CHECK(undecided > 0);  // lists without a shape that thorough ones have
    CHECK(sharper > 0);    // bounds that thorough ones have better
}

TEST_CASE("What needs thorough says so") {
    const Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
    const SteadyShapesOptions any_posture{.conical_height = 0.2, .hanging_only = false};
    CHECK_THROWS_WITH(briefly(chain, any_posture), Catch::Contains("revchain::thorough") && Catch::Contains("0.2"));
    CHECK(revchain::steady_shapes(chain, any_posture, thorough).complete);

    // l = (h^2 + k^2)/h = 5.1 is longer than the link
    const revchain::Link<double> turned =
        revchain::compound_pendulum<double>({.weight = 1.0, .length = 1.0, .centroid = 0.1, .radius_of_gyration = 0.7});
    const Chain<double> several({revchain::plummet(1.0, 1.0), turned});
    CHECK_THROWS_AS(briefly(several, SteadyShapesOptions{.conical_height = 0.05}), InvalidArgument);
    CHECK_NOTHROW(revchain::steady_shapes(several, {.conical_height = 0.05}, thorough));
    CHECK_THROWS_AS(briefly(Rig(chain, {.posture = {Posture::hangs, Posture::stands}}),
                            revchain::RigShapesOptions{.conical_height = 0.2}),
                    InvalidArgument);
}

TEST_CASE("A diagram without thorough has the same branches, without the proof") {
    const auto chain = Chain<double>::uniform_plummets(4, 1.0, 1.0);
    const revchain::DiagramOptions options{.min_conical_height = 0.02};
    const auto brief = revchain::finite::diagram_of<revchain::finite::ChainQuestions<Brief>>(chain, options, Brief{});
    const auto whole = revchain::branches(chain, options, thorough);
    REQUIRE(brief.branches.size() == whole.branches.size());
    for (std::size_t i = 0; i < brief.branches.size(); ++i)
        CHECK(brief.branches[i].conical_height == whole.branches[i].conical_height);
    CHECK(brief.consistent);
    CHECK_FALSE(brief.complete);
    CHECK(whole.complete);
    CHECK_THAT(brief.remark, Catch::Contains("revchain::thorough"));
    CHECK_THAT(whole.remark, !Catch::Contains("revchain::thorough"));
}

TEST_CASE("Stability without thorough: the same verdict, or undecided") {
    Random random(5);
    int undecided = 0, decided = 0;
    for (int round = 0; round < 80; ++round) {
        const double apart = random.log_between(1, 1e16);
        const auto chain = support::chain_of(static_cast<Index>(2 + round % 3), [&](Index) {
            return revchain::plummet(random.log_between(1 / apart, 1), random.between(0.5, 2));
        });
        const double height = chain.total_length() * random.log_between(0.02, 0.5);
        for (const SteadyShape& shape : revchain::steady_shapes(chain, {.conical_height = height}).shapes) {
            const Stability brief = revchain::finite::judged(StabilityFrame::free, chain, shape, Brief{});
            const Stability whole = revchain::stability(chain, shape, thorough);
            INFO("weights " << apart << " apart");
            CHECK((brief.verdict == whole.verdict || brief.verdict == Verdict::undecided));
            CHECK(std::abs(brief.growth_rate - whole.growth_rate) <= brief.margin + whole.margin);
            ++(brief.verdict == Verdict::undecided ? undecided : decided);
        }
    }
    CHECK(decided > undecided);
}
