// SPDX-License-Identifier: MPL-2.0
#include "revchain/finite/branch/diagram_proof.hpp"

#include "revchain/branches.hpp"
#include "revchain/finite/shapes/list.hpp"
#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Branch;
using revchain::Chain;
using revchain::Index;
using revchain::Interval;
using support::Quad;

namespace {

/// Offset of the support in quadruple precision: from the forces on each link, its tangent by halving.
Quad offset(const Chain<double>& chain, Quad x, Quad height) {
    const auto links = revchain::finite::links_of(chain).links;
    Quad y = 0, sum = 0;
    for (std::size_t m = 0; m < links.size(); ++m) {
        const Quad a = support::quad(links[m].length), pull = support::quad(links[m].pull),
                   cross = support::quad(links[m].cross), moment = support::quad(links[m].moment),
                   rest = support::quad(links[m].rest);
        const auto load = [&](Quad t) { return height * pull * t + a * cross * t / sqrtq(1 + t * t); };
        Quad t = x / height, R = load(t);
        if (m > 0) {
            R = sum + moment * y;
            t = R / (height * pull);
            for (int i = 0; i < 80; ++i) {
                const Quad root = sqrtq(1 + t * t);
                t -= (load(t) - R) / (height * pull + a * cross / (root * root * root));
            }
        } else {
            y = R / moment;
        }
        y -= a * t / sqrtq(1 + t * t);
        sum = R + rest * y;
    }
    return y;
}

Chain<double> chain_for(support::Random& random, Index n, bool rods) {
    return support::chain_of(n, [&](Index) {
        const double weight = random.log_between(1.0, 30.0), length = random.log_between(1.0, 5.0);
        return rods ? revchain::uniform_rod<double>(weight, length) : revchain::plummet<double>(weight, length);
    });
}

bool holds(const Interval<double>& range, Quad number, Quad off) {
    return Quad(range.low) <= number + off && number - off <= Quad(range.high);
}

/// The offset over a rectangle, computed in one lane beside another rectangle in the other lane.
revchain::finite::Taylor<double, 2> second_lane(const revchain::finite::EnclosedLinks<double>& links,
                                                const revchain::finite::Rectangle& over) {
    using V = revchain::Pack<double, 2>;
    const auto beside = [](double other, double number) {
        V x(other);
        x.set(1, number);
        return x;
    };
    const Interval<V> x(beside(0.0, over.low), beside(0.5, over.high)),
        height(beside(0.1, over.height_low), beside(3.0, over.height_high));
    const auto y = revchain::finite::support_offset(links, revchain::finite::Cell<V, 2>(x, height));
    const auto lane = [](const Interval<V>& of) { return Interval<double>(of.low[1], of.high[1]); };
    revchain::finite::Taylor<double, 2> result;
    result.value = lane(y.value);
    for (std::size_t i = 0; i < 2; ++i) result.slope[i] = lane(y.slope[i]);
    for (std::size_t i = 0; i < 3; ++i) result.bend[i] = lane(y.bend[i]);
    return result;
}

/// A proof for which `known` branches are all there are.
struct Trial {
    revchain::finite::DiagramProof proof;
    std::vector<revchain::finite::DiagramPoint> others;  ///< shapes found on none of them
};
Trial trial(const Chain<double>& chain, double lowest, const std::vector<Branch>& known, bool accept) {
    const auto links = revchain::finite::links_of(chain);
    const double unit = std::ldexp(1.0, -links.units.length_exponent);
    const auto narrow = revchain::finite::enclosed<double>(links.links);
    revchain::finite::Corrector corrector(revchain::finite::rounded<double>(links.links));
    revchain::finite::DiagramProver prover(narrow, 300'000);
    const double first = revchain::modes(chain, {.count = 1}).conical_height[0], low = lowest * unit;
    Trial result;
    result.proof = prover.run(low, first * unit * (1 + 1e-9),
                              low * revchain::finite::tangent_limit(narrow, Interval<double>(low)) * (1 + 1e-12),
                              [&](const revchain::finite::DiagramPoint& at, const revchain::finite::Rectangle& within) {
                                  for (const Branch& branch : known)
                                      if (revchain::finite::goes_through(branch, corrector, at, within)) return true;
                                  result.others.push_back({at.x / unit, at.height / unit});
                                  return accept;
                              });
    result.proof.open_low /= unit, result.proof.open_high /= unit;
    return result;
}

}  // namespace

TEST_CASE("the offset and its derivatives stay within their enclosures: quadruple precision", "[finite]") {
    support::Random random(5);
    int narrow = 0, narrow_in_lane = 0;
    for (int i = 0; i < 300; ++i) {
        const Index n = 1 + i % 5;
        const auto chain = chain_for(random, n, i % 2 == 1);
        const auto links = revchain::finite::links_of(chain);
        const double unit = std::ldexp(1.0, -links.units.length_exponent), length = chain.total_length() * unit;
        const double size = i % 3 == 0 ? 1e-2 : i % 3 == 1 ? 0.3 : 1e-5;
        revchain::finite::Rectangle over{};
        over.low = i % 7 == 0 ? 0.0 : length * random.log_between(1e-6, 1.0);
        over.high = over.low + (over.low == 0 ? length * size : over.low * size);
        over.height_low = length * random.log_between(0.01, 1.0);
        over.height_high = over.height_low * (1 + size * random());
        const auto narrow_links = revchain::finite::enclosed<double>(links.links);
        const auto y =
            revchain::finite::support_offset(narrow_links, revchain::finite::Cell<double, 2>(over.x(), over.height()));
        const auto in_lane = second_lane(narrow_links, over);
        narrow += y.bend[0].width() < 1e-3 * std::abs(y.bend[0].middle());
        narrow_in_lane += in_lane.bend[0].width() < 1e-3 * std::abs(in_lane.bend[0].middle());
        for (int k = 0; k < 4; ++k) {
            const Quad x = over.low + random() * (over.high - over.low),
                       h = over.height_low + random() * (over.height_high - over.height_low);
            const Quad dx = 1e-8 * over.high, dh = 1e-8 * over.height_low;
            const auto f = [&](int a, int b) { return offset(chain, x + a * dx, h + b * dh); };
            const Quad here = f(0, 0), right = f(1, 0), left = f(-1, 0), above = f(0, 1), below = f(0, -1);
            const Quad rounding =
                1e-31;  // of the offset; and what differences leave out, 1e-16 of a term of the next order
            const auto within = [&](const Interval<double>& range, Quad number, Quad steps) {
                const double most = std::max(std::abs(range.low), std::abs(range.high));
                return holds(range, number, Quad(most) * Quad(1e-12) + rounding / steps);
            };
            const Quad mixed = (f(1, 1) - f(1, -1) - f(-1, 1) + f(-1, -1)) / (4 * dx * dh);
            for (const auto* found : {&y, &in_lane}) {
                CAPTURE(i, k, n, found == &y);
                CHECK(holds(found->value, here, Quad(1e-28)));
                CHECK(within(found->slope[0], (right - left) / (2 * dx), dx));
                CHECK(within(found->slope[1], (above - below) / (2 * dh), dh));
                CHECK(within(found->bend[0], (right - 2 * here + left) / (dx * dx), dx * dx));
                CHECK(within(found->bend[2], (above - 2 * here + below) / (dh * dh), dh * dh));
                CHECK(within(found->bend[1], mixed, dx * dh));
            }
        }
    }
    CHECK(narrow > 50);  // they say something
    CHECK(narrow_in_lane > 50);
}

TEST_CASE("a branch left out is missed: three plummets without their isolated branch", "[finite]") {
    const auto chain = Chain<double>::uniform_plummets(3, 3.0, 1.0);
    const auto found = revchain::branches(chain, {.min_conical_height = 0.02, .proof_budget = 0}).branches;
    REQUIRE(found.size() == 4);
    const auto whole = trial(chain, 0.02, found, false);
    CHECK(whole.proof.complete);
    CHECK(whole.others.empty());
    const double born = found[3].conical_height[found[3].folds[0]];
    const std::vector<Branch> fewer(found.begin(), found.begin() + 3);
    const auto open = trial(chain, 0.02, fewer, false);
    CHECK_FALSE(open.proof.complete);
    CHECK((open.proof.open_low <= born && born <= open.proof.open_high));
    const auto met = trial(chain, 0.02, fewer, true);
    CHECK(met.proof.complete);
    REQUIRE_FALSE(met.others.empty());
    for (const auto& at : met.others) {  // shapes on the branch left out, near its fold
        const auto list = revchain::steady_shapes(chain, {.conical_height = at.height}).shapes;
        const double inclination = std::atan(at.x / at.height);
        CHECK(std::any_of(list.begin(), list.end(), [&](const auto& shape) {
            return shape.half_waves == 3 && std::abs(shape.inclination[0] - inclination) < 1e-6;
        }));
        CHECK(std::abs(at.height / born - 1) < 0.05);
    }
}

TEST_CASE("every isolated branch left out is missed", "[finite]") {
    support::Random random(77);
    int isolated = 0;
    for (int i = 0; i < 12; ++i) {
        const Index n = 3 + i % 3;
        const auto chain = chain_for(random, n, i % 2 == 0);
        const double lowest = chain.total_length() * 6e-3;
        const auto found = revchain::branches(chain, {.min_conical_height = lowest});
        CHECK(found.complete);
        for (std::size_t j = 0; j < found.branches.size(); ++j) {
            if (found.branches[j].mode > 0) continue;
            ++isolated;
            auto fewer = found.branches;
            fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(j));
            CAPTURE(i, j, n);
            CHECK_FALSE(trial(chain, lowest, fewer, true).others.empty());
        }
    }
    CHECK(isolated > 10);
}
