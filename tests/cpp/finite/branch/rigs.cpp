// SPDX-License-Identifier: MPL-2.0
// Branches of rigs against forces on the bodies as vectors in quadruple precision (support/quad_rig.hpp), against proved
// lists of all shapes, and the enclosures of the diagram's proof against differences in quadruple precision.
#include "revchain/branches.hpp"

#include "revchain/finite/branch/enclosed_diagram.hpp"
#include "revchain/rig_modes.hpp"
#include "revchain/stability_windows.hpp"
#include "support/rig_shapes.hpp"

using revchain::Branch;
using revchain::BranchBirth;
using revchain::BranchEnd;
using revchain::Branches;
using revchain::Chain;
using revchain::Index;
using revchain::plummet;
using revchain::Rig;
using revchain::Rigging;
using revchain::SteadyShapes;
using support::Quad;
using support::Random;

namespace {

/// A chain of rods and plummets, which hang at one inclination each, on springs, arms, with wheels, in water.
Rig random_rig(Random& random, Index n, int kind) {
    const auto chain = support::chain_of(n, [&](Index) {
        const double W = random.log_between(0.5, 3), a = random.log_between(0.5, 2);
        return random() < 0.5 ? plummet<double>(W, a) : revchain::uniform_rod<double>(W, a);
    });
    Rigging with;
    const double whole = chain.total_weight(), long_ = chain.total_length();
    if (kind % 2 == 1) with.support.radius = long_ * random.log_between(1e-3, 0.5);
    if (kind / 2 % 2 == 1)
        with.support.stiffness = whole / long_ * random.log_between(40, 400),
        with.support.carriage_weight = random() < 0.5 ? 0 : whole * random.log_between(0.1, 1);
    if (kind / 4 % 2 == 1)
        for (Index m = 0; m < n; ++m)
            with.flywheels.push_back({whole * long_ * random.between(0, 0.3), random() < 0.5 ? 0.0 : 0.01});
    if (kind / 8 % 2 == 1)
        for (Index m = 0; m < n; ++m) {
            const auto link = chain.link(m);
            with.displaced.push_back(revchain::displaced_by(link, 0.3 * link.weight, 0.2 * link.weight));
        }
    return Rig(chain, with);
}

double first_height(const Rig& rig) { return revchain::modes(rig, {.count = 1}).forward.conical_height[0]; }

/// Every shape of the list is on the branches at its height once, and nothing else is.
void check_cut(const Branches& diagram, const SteadyShapes& list, double height) {
    std::size_t crossings = 0;
    std::vector<int> met(list.shapes.size(), 0);
    for (const Branch& branch : diagram.branches)
        for (const auto& shape : branch.shapes_at(height)) {
            ++crossings;
            for (std::size_t j = 0; j < met.size(); ++j)
                met[j] += (shape.inclination - list.shapes[j].inclination).cwiseAbs().maxCoeff() < 1e-12;
        }
    CHECK(crossings == list.shapes.size());
    CHECK(std::all_of(met.begin(), met.end(), [](int each) { return each == 1; }));
}

/// The function of EnclosedDiagram, by the numbers of the links.
Quad miss(const revchain::finite::BranchSystem& system, int side, Quad x, Quad height) {
    const auto& from = system.links;
    const Quad n = support::quad(from.pace) / sqrtq(height), b = side * support::quad(from.radius);
    Quad y = 0, sum = 0, moving = 0;
    for (std::size_t m = 0; m < from.bodies(); ++m) {
        const auto& link = from.links[m];
        const Quad a = support::quad(link.length), cross = support::quad(link.cross),
                   moment = support::quad(link.moment), rest = support::quad(link.rest),
                   pull = support::quad(link.pull) + (from.spin.empty() ? Quad(0) : n * support::quad(from.spin[m]));
        const auto load = [&](Quad t) { return height * pull * t + a * cross * t / sqrtq(1 + t * t); };
        Quad t = x / height, R = load(t);
        if (m > 0) {
            R = sum + moment * y, t = R / (height * pull);
            for (int i = 0; i < 80; ++i) {
                const Quad root = sqrtq(1 + t * t);
                t -= (load(t) - R) / (height * pull + a * cross / (root * root * root));
            }
        } else {
            y = R / moment;
        }
        y -= a * t / sqrtq(1 + t * t), sum = R + rest * y, moving += moment + rest;
    }
    if (!from.spring) return y - b;
    const auto& spring = from.links.back();
    const Quad stiffness = support::quad(spring.pull) / support::quad(spring.length);
    return height * stiffness * (y - b) - sum - support::quad(spring.moment) * y;
}

}  // namespace

TEST_CASE("rigs: the function of the diagram's proof and its derivatives stay within their enclosures",
          "[finite][rig]") {
    Random random(31);
    int narrow = 0;
    for (int i = 0; i < 160; ++i) {
        const Rig rig = random_rig(random, 1 + i % 4, i % 8);
        const revchain::finite::BranchSystem system(rig, support::rig_shapes::gravity, revchain::Rotation::forward);
        const int side = i % 3 == 0 ? -1 : 1;
        const revchain::finite::EnclosedDiagram diagram(system, side);
        const double unit = std::ldexp(1.0, -system.units.length_exponent), length = rig.chain().total_length() * unit;
        const double size = i % 3 == 0 ? 1e-2 : i % 3 == 1 ? 0.3 : 1e-5;
        const double low = length * random.log_between(1e-4, 1.0), high = low * (1 + size);
        const double height_low = length * random.log_between(0.03, 1.0),
                     height_high = height_low * (1 + size * random());
        const revchain::finite::Cell<double, 2> cell(revchain::Interval<double>(low, high),
                                                     revchain::Interval<double>(height_low, height_high));
        const auto y = diagram.spins() ? diagram.spinning_over(cell) : diagram.over(cell);
        narrow += y.bend[0].width() < 1e-3 * std::abs(y.bend[0].middle());
        for (int k = 0; k < 3; ++k) {
            const Quad x = low + random() * (high - low), h = height_low + random() * (height_high - height_low);
            const Quad dx = 1e-8 * high, dh = 1e-8 * height_low;
            const auto f = [&](int a, int b) {
                return miss(system, diagram.is_symmetric() ? 1 : side, x + a * dx, h + b * dh);
            };
            const Quad here = f(0, 0), right = f(1, 0), left = f(-1, 0), above = f(0, 1), below = f(0, -1);
            const auto holds = [&](const revchain::Interval<double>& range, Quad number, Quad steps) {
                const Quad off =
                    std::max(std::abs(range.low), std::abs(range.high)) * Quad(1e-12) + Quad(1e-28) / steps;
                return Quad(range.low) <= number + off && number - off <= Quad(range.high);
            };
            CAPTURE(i, k, rig.size());
            CHECK(holds(y.value, here, 1));
            CHECK(holds(y.slope[0], (right - left) / (2 * dx), dx));
            CHECK(holds(y.slope[1], (above - below) / (2 * dh), dh));
            CHECK(holds(y.bend[0], (right - 2 * here + left) / (dx * dx), dx * dx));
            CHECK(holds(y.bend[2], (above - 2 * here + below) / (dh * dh), dh * dh));
            CHECK(holds(y.bend[1], (f(1, 1) - f(1, -1) - f(-1, 1) + f(-1, -1)) / (4 * dx * dh), dx * dh));
            const int sign = diagram.at(static_cast<double>(x), static_cast<double>(h)).sign();
            const Quad there =
                miss(system, diagram.is_symmetric() ? 1 : side, static_cast<double>(x), static_cast<double>(h));
            CHECK((sign == 0 || (sign > 0) == (there > 0)));
        }
    }
    CHECK(narrow > 30);  // they say something
}

TEST_CASE("rigs: points of branches balance, and cuts of diagrams are the proved lists", "[finite][rig]") {
    Random random(32);
    support::rig_shapes::Measured measured;
    int complete = 0, rest = 0, born = 0;
    constexpr int rigs = 48;
    for (int i = 0; i < rigs; ++i) {
        const Rig rig = random_rig(random, 1 + i % 3, i % 16);
        const double first = first_height(rig), lowest = first * random.log_between(0.05, 0.5);
        const Branches diagram = revchain::branches(rig, {.min_conical_height = lowest});
        CAPTURE(i, rig.size(), diagram.remark);
        CHECK(diagram.consistent);
        complete += diagram.complete;
        for (const Branch& branch : diagram.branches) {
            rest += branch.birth == BranchBirth::rest, born += branch.birth == BranchBirth::fold;
            CHECK((branch.birth == BranchBirth::rest) == (rig.support().radius > 0 && branch.mode == 1));
            for (std::size_t at = branch.birth == BranchBirth::vertical ? 1 : 0; at < branch.size();
                 at += 1 + branch.size() / 7) {
                const auto shape = branch.shape(at);
                const auto truth = support::rig_shapes::truth_of(rig, shape.conical_height);
                // offsets are doubles: a spring drawn far out rounds by so much more of the weight
                const double reach = 1 + std::abs(shape.offset[rig.size()]) / rig.chain().total_length();
                CHECK(truth.balance(support::rig_shapes::state_of(shape)).worst <= 1e-13 * reach);
                CHECK(std::abs(branch.conical_height[at] / shape.conical_height - 1) < 1e-11);
                CHECK(std::abs(std::abs(branch.tip_radius[at]) - std::abs(shape.offset[0])) < 1e-10);
                CHECK(std::abs(branch.top_tension[at] / shape.tension[rig.size() - 1] - 1) < 1e-10);
                CHECK(std::abs(branch.moment_of_inertia[at] / shape.moment_of_inertia - 1) < 1e-10);
                CHECK(std::abs(branch.effective_energy[at] - shape.effective_energy) <
                      1e-11 * (rig.chain().total_weight() * rig.chain().total_length() +
                               shape.moment_of_inertia / shape.conical_height));
            }
        }
        for (int k = 0; k < 3; ++k) {
            const double height = lowest * std::pow(2 * first / lowest, random());
            const SteadyShapes list = revchain::steady_shapes(rig, {.conical_height = height});
            CAPTURE(height);
            CHECK(list.complete);
            check_cut(diagram, list, height);
            support::rig_shapes::check_shapes(rig, height, list, 1, measured);
        }
    }
    CHECK(complete >= rigs - 4);
    CHECK(rest == rigs / 2);
    CHECK(born > 10);
}

TEST_CASE("rigs: what is asked comes back", "[finite][rig]") {
    Random random(33);
    for (int i = 0; i < 16; ++i) {
        const Rig rig = random_rig(random, 1 + i % 4, i);
        const double height = 0.6 * first_height(rig);
        const auto shape = revchain::steady_shape(rig, {.conical_height = height});
        const auto truth = support::rig_shapes::truth_of(rig, height);
        const auto exact = truth.settled(support::rig_shapes::state_of(shape));
        REQUIRE(exact);
        CHECK(static_cast<double>(support::rig_shapes::apart(shape, *exact)) <= shape.error_bound);
        CHECK(shape.error_bound < 1e-15);
        CAPTURE(i);
        const auto comes_back = [&](const revchain::RigOnBranchOptions& options) {
            const auto found = revchain::shapes_on_branch(rig, options).shapes;
            return std::any_of(found.begin(), found.end(), [&](const auto& again) {
                return std::abs(again.conical_height / height - 1) < 1e-12 &&
                       (again.inclination - shape.inclination).cwiseAbs().maxCoeff() < 1e-12;
            });
        };
        CHECK(comes_back({.angular_speed = std::sqrt(revchain::conical_pendulum::standard_gravity / height)}));
        CHECK(comes_back({.tip_inclination = shape.inclination[0]}));
        CHECK(comes_back({.tip_radius = shape.offset[0]}));
        CHECK(comes_back({.top_tension = shape.tension[rig.size() - 1]}));
    }
}

TEST_CASE("rigs: a plain chain, a link that stands, and windows of stability", "[finite][rig]") {
    const auto chain = Chain<double>::uniform_plummets(3, 3.0);
    const auto plain = revchain::branches(chain, {.min_conical_height = 0.1});
    const auto rigged = revchain::branches(Rig(chain, {}), {.min_conical_height = 0.1});
    REQUIRE(plain.branches.size() == rigged.branches.size());
    CHECK((plain.complete && rigged.complete));
    for (std::size_t j = 0; j < plain.branches.size(); ++j)
        CHECK(std::abs(plain.branches[j].tip_radius.back() - rigged.branches[j].tip_radius.back()) < 1e-12);

    // a link that stands, held up by its wheel
    const Chain<double> bodies({plummet(1.0, 0.5), plummet(1.0, 1.0)});
    const Rig standing(bodies, {.support = {.radius = 0.1},
                                .posture = {revchain::Posture::stands, revchain::Posture::hangs},
                                .flywheels = {{-0.1, 0}, {0, 0}}});
    const auto rest = revchain::branch(standing, {.max_angular_speed = 0.5});
    CHECK(rest.birth == BranchBirth::rest);
    REQUIRE(rest.end == BranchEnd::height);
    for (std::size_t at = 0; at < rest.size(); at += 9) {
        const auto shape = rest.shape(at);
        CHECK(std::abs(shape.inclination[0] - rest.tip_inclination[at]) < 1e-12);
        CHECK(std::abs(shape.inclination[0]) > 1.58);
        const auto truth = support::rig_shapes::truth_of(standing, shape.conical_height);
        CHECK(truth.balance(support::rig_shapes::state_of(shape)).worst <= 1e-14);
    }
    CHECK_FALSE(revchain::branches(standing, {.max_angular_speed = 0.5}).complete);

    const Rig carousel(Chain<double>({plummet(80.0, 4.0)}), {.support = {.radius = 1.0}});
    const auto diagram = revchain::branches(carousel, {.max_angular_speed = 4.0});
    REQUIRE(diagram.branches.size() == 2);
    CHECK(diagram.complete);
    const auto outwards = revchain::stability_windows(carousel, diagram.branches[0]);
    REQUIRE(outwards.size() == 1);
    CHECK(outwards[0].verdict == revchain::Verdict::minimum);
    const auto inwards = revchain::stability_windows(carousel, diagram.branches[1]);
    CHECK(inwards.size() >= 2);
    CHECK_THROWS_WITH(revchain::branch(carousel, {.mode = 2, .max_angular_speed = 4.0}),
                      Catch::Matchers::ContainsSubstring("mode must be 1, the branch from rest"));
}
