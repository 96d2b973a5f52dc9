// SPDX-License-Identifier: GPL-3.0-or-later
// The costs that the comments of public headers state: CPU time of calls, the shortest of several. A line for each: name,
// time, in the unit that the header counts (a link, a mode, a point ...). `bench_costs TEXT` prints the lines with TEXT.
// tests/claims/headers.toml compares the lines with the sentences.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "revchain/analytic.hpp"
#include "revchain/batch.hpp"
#include "revchain/bell.hpp"
#include "revchain/branches.hpp"
#include "revchain/buffer.hpp"
#include "revchain/campbell.hpp"
#include "revchain/damped_modes.hpp"
#include "revchain/drag.hpp"
#include "revchain/explain.hpp"
#include "revchain/forced_motion.hpp"
#include "revchain/held.hpp"
#include "revchain/methods.hpp"
#include "revchain/response.hpp"
#include "revchain/rig_modes.hpp"
#include "revchain/sensitivity.hpp"
#include "revchain/sleeve_governor.hpp"
#include "revchain/stability.hpp"
#include "revchain/steady_shapes.hpp"
#include "revchain/swing.hpp"
#include "revchain/transient.hpp"
#include "revchain/two_links.hpp"
#include "support/chains.hpp"
#include "timing.hpp"

namespace {

using revchain::Chain;
using revchain::Index;
using revchain::Rig;
using Numbers = std::vector<double>;

const char* wanted = "";
volatile double sink;

/// Prints the time of a call divided by the number of items in it.
template <class F>
double cost(const char* name, double items, const F& call) {
    if (!std::strstr(name, wanted)) return 0;
    double best = std::numeric_limits<double>::infinity(), spent = 0;
    for (int round = 0; round < 5 || (spent < 0.1 && round < 1000); ++round) {
        const double start = bench::cpu_seconds();
        best = std::min(best, bench::seconds_of([&] { sink = static_cast<double>(call()); }));
        spent += bench::cpu_seconds() - start;
        if (spent > 3) break;
    }
    best /= items;
    const auto [unit, text] = best < 1e-6   ? std::pair(1e9, "ns")
                              : best < 1e-3 ? std::pair(1e6, "µs")
                              : best < 1    ? std::pair(1e3, "ms")
                                            : std::pair(1.0, "s");
    std::printf("%s\t%.3g %s\n", name, best * unit, text);
    std::fflush(stdout);
    return best;
}

Chain<double> plummets(Index n) { return Chain<double>::uniform_plummets(n, static_cast<double>(n)); }

/// Rods and plummets of unequal weights and lengths.
std::vector<revchain::Link<double>> links(Index n, double widest = 2) {
    support::Random random(static_cast<std::uint64_t>(n));
    std::vector<revchain::Link<double>> made;
    for (Index m = 0; m < n; ++m) {
        const double weight = random.between(1 / widest, widest), length = random.between(0.5, 2);
        made.push_back(m % 2 ? revchain::uniform_rod(weight, length) : revchain::plummet(weight, length));
    }
    return made;
}
Chain<double> mixed(Index n) { return Chain<double>(links(n)); }

void chains() {
    const auto equal = std::vector(1000, revchain::uniform_rod(1.0, 1.0)), unequal = links(1000);
    cost("chain: equal link", 1000, [&] { return Chain<double>(equal).total_weight(); });
    cost("chain: link", 1000, [&] { return Chain<double>(unequal).total_weight(); });
    const Chain<double> chain(unequal);
    cost("chain: weight_below", 1000, [&] {
        double sum = 0;
        for (Index m = 0; m < 1000; ++m) sum += chain.weight_below(m).high;
        return sum;
    });
    cost("count: ModeCounter, link", 1000, [counter = revchain::ModeCounter<double>(chain)] {
        return counter.above_height(10.0);
    });
    cost("count: count_modes, link", 1000, [&] { return revchain::count_modes(chain, {.conical_height = 10.0}); });

    for (const bool rods : {false, true}) {
        const Index count = 10'000, n = 10;
        support::Random random(1);
        Numbers weight, length, centroid, gyration;
        for (Index i = 0; i < count * n; ++i) {
            weight.push_back(random.between(0.5, 2));
            length.push_back(random.between(0.5, 2));
            centroid.push_back(length.back() / 2);
            gyration.push_back(length.back() / std::sqrt(12.0));
        }
        revchain::ChainBatch<double> batch{
            .chains = count, .size = n, .weight = {weight.data(), n, 1}, .length = {length.data(), n, 1}};
        if (rods) {
            batch.centroid = {centroid.data(), n, 1};
            batch.radius_of_gyration = {gyration.data(), n, 1};
        }
        cost(rods ? "batch: 10 rods" : "batch: 10 plummets", static_cast<double>(count),
             [&] { return revchain::conical_heights(batch)(0, 0); });
    }
}

void modes() {
    const auto chain = mixed(1000);
    cost("modes: link and mode", 1000 * 100, [&] { return revchain::modes(chain, {.count = 100}).conical_height[0]; });
    cost("modes: link and mode, with shapes", 1000 * 100, [&] {
        const auto m = revchain::modes(chain, {.count = 100});
        return m.shapes()(0, 0);
    });
    const Chain<double> wide(links(1000, 1e100));
    cost("modes: link and mode, several units", 1000 * 20,
         [&] { return revchain::modes(wide, {.count = 20}).conical_height[0]; });
    cost("modes: all of 1000", 1, [&] { return revchain::modes(chain, {.count = 1000}).conical_height[0]; });
    cost("modes: all of 30", 1,
         [c = mixed(30)] { return revchain::modes(c, {.count = 30}).conical_height[0]; });
    cost("methods: all of 1000", 1,
         [&] { return revchain::modes(chain, {.count = 1000}, revchain::methods::all).conical_height[0]; });
    cost("methods: all of 30", 1,
         [c = mixed(30)] { return revchain::modes(c, {.count = 30}, revchain::methods::all).conical_height[0]; });
    cost("explain", 1, [&] { return revchain::explain(chain, {.count = 10}).chosen; });
    const auto found = revchain::modes(chain, {.count = 100});
    found.shapes();
    cost("sensitivity: link and mode", 1000 * 100,
         [&] { return revchain::sensitivity(chain, found).weight().value(0, 0); });
    Numbers speeds;
    for (int i = 0; i < 1000; ++i) speeds.push_back(0.1 + 0.01 * i);
    cost("response: link and speed", 1000 * 100, [c = mixed(100), &speeds] {
        return revchain::response(c, {.angular_speed = speeds}).offset(0, 0);
    });

    const Rig sprung(chain, {.support = revchain::horizontal_spring(50.0)});
    cost("rig_modes: link and mode, with shapes", 1000 * 100, [&] {
        const auto m = revchain::modes(sprung, {.count = 100});
        return m.forward.shapes()(0, 0);
    });
    revchain::Rigging spinning{.flywheels = std::vector<revchain::Flywheel>(300)};
    for (auto& wheel : spinning.flywheels) wheel.momentum = revchain::Wide<double>(0.1);
    const Rig wheels(mixed(300), spinning);
    cost("rig_modes: link and mode, momentum", 300 * 40,
         [&] { return revchain::modes(wheels, {.count = 20, .other = false}).forward.angular_speed[0]; });
    cost("rig_modes: count_modes, link", 1000, [&] { return revchain::count_modes(sprung, {.angular_speed = 3.0}); });
    for (const bool momentum : {false, true}) {
        const Index n = 500;
        revchain::Rigging turning{.fluid = revchain::Fluid::turning};
        const auto c = mixed(n);
        for (Index m = 0; m < n; ++m) turning.displaced.push_back(revchain::displaced_by(c.link(m), m % 3 ? 0.1 : 2.5));
        if (momentum) {
            turning = {.posture = std::vector(static_cast<std::size_t>(n), revchain::Posture::hangs),
                       .flywheels = std::vector<revchain::Flywheel>(static_cast<std::size_t>(n))};
            turning.posture[3] = revchain::Posture::stands;
            for (auto& wheel : turning.flywheels) wheel.momentum = revchain::Wide<double>(0.1);
        }
        const Rig rig(c, turning);
        cost(momentum ? "rig_modes: discs with momentum, link squared" : "rig_modes: discs, link squared",
             static_cast<double>(n * n), [&] {
                 const auto m = revchain::modes(rig, {.count = 1});
                 if (m.method != revchain::RigMethod::discs) std::puts("not discs");
                 return m.forward.conical_height.size() ? m.forward.conical_height[0] : 0.0;
             });
    }
}

void motion() {
    const Index n = 100;
    const auto chain = mixed(n);
    revchain::Vector<double> start = revchain::Vector<double>::Zero(n + 1);
    start[0] = 0.01;
    Numbers one{0.0}, many;
    for (int i = 0; i < 1000; ++i) many.push_back(0.01 * i);
    const double squared = static_cast<double>(n * n);
    const auto swing = [&](const Numbers& time) {
        return revchain::swing(chain, {.offset = start, .time = time}).offset(0, 0);
    };
    const double once = cost("swing: link and mode", squared, [&] { return swing(one); });
    cost("swing: link, mode and time (with the modes)", squared * 1000, [&] { return swing(many) + 0 * once; });
    revchain::Rigging spinning{.flywheels = std::vector<revchain::Flywheel>(static_cast<std::size_t>(n))};
    for (auto& wheel : spinning.flywheels) wheel.momentum = revchain::Wide<double>(0.1);
    const Rig wheels(chain, spinning);
    const revchain::Vector<std::complex<double>> pulled = start.cast<std::complex<double>>();
    const auto whirl = [&](const Numbers& time) {
        return std::abs(revchain::whirl_swing(wheels, {.offset = pulled, .time = time}).offset(0, 0));
    };
    cost("whirl_swing: link and whirl", 2 * squared, [&] { return whirl(one); });
    cost("whirl_swing: link, whirl and time (with the whirls)", 2 * squared * 1000, [&] { return whirl(many); });
    revchain::Rigging damped{.pins = std::vector<revchain::Pin>(static_cast<std::size_t>(n))};
    for (auto& pin : damped.pins) pin.damping = revchain::Wide<double>(0.01);
    const Rig dashpots(chain, damped);
    cost("forced_motion: link and speed", 100.0 * 1000, [&, speeds = Numbers(many.begin() + 1, many.end())] {
        return std::abs(revchain::forced_motion(dashpots, {.angular_speed = speeds, .radius = 0.01}).offset(0, 0));
    });
    cost("damped_modes: link cubed", squared * 100,
         [&] { return std::abs(revchain::damped_modes(dashpots).exponent[0]); });
    Numbers very_many;
    for (int i = 0; i < 20'000; ++i) very_many.push_back(0.01 * i);
    cost("transient: link, motion and time (with the motions)", squared * 20'000, [&] {
        return std::abs(revchain::transient(dashpots, {.offset = pulled, .time = very_many}).offset(0, 0));
    });
    for (const Index size : {1, 100, 300}) {
        const auto rods = Chain<double>::uniform_rods(size, 10.0, 10.0);
        const Rig rig(rods, {.support = revchain::carried_round(1.0)});
        const revchain::Drag air{.coefficient = {1.2}, .diameter = {0.02}};
        char name[40];
        std::snprintf(name, sizeof name, "drag_shape: %d links", static_cast<int>(size));
        cost(name, 1, [&] { return revchain::drag_shape(rig, air, {.angular_speed = 2.0}).torque; });
    }
}

void shapes() {
    using revchain::thorough;
    const auto list = [](const char* name, const Chain<double>& chain, double height, bool hanging) {
        revchain::SteadyShapesOptions options{.conical_height = height, .hanging_only = hanging};
        const auto found = revchain::steady_shapes(chain, options, thorough);
        char whole[120];
        std::snprintf(whole, sizeof whole, "steady_shapes: %s (%d shapes)", name, static_cast<int>(found.shapes.size()));
        cost(whole, 1, [&] { return revchain::steady_shapes(chain, options, thorough).cells; });
    };
    list("3 rods", Chain<double>::uniform_rods(3, 3.0), 0.03, true);
    list("8 plummets", plummets(8), 0.04, true);
    list("12 plummets", plummets(12), 0.024, true);
    list("1000 plummets, first", plummets(1000), 650, true);
    list("1000 plummets", plummets(1000), 2, true);
    list("3 plummets, any posture", plummets(3), 0.003, false);
    list("4 plummets, any posture", plummets(4), 0.004, false);
    list("6 plummets, any posture", plummets(6), 0.006, false);

    const auto budget = [](const char* name, const Chain<double>& chain, double height) {
        const long links = 100'000;
        cost(name, static_cast<double>(links), [&] {
            return revchain::steady_shapes(chain, {.conical_height = height, .budget = links}).cells;
        });
    };
    budget("steady_shapes: link evaluation", plummets(40), 0.04);

    const auto rods = Chain<double>::uniform_rods(100, 1.0);
    const revchain::BranchOptions to{.mode = 2, .min_conical_height = 0.01};
    const auto points = static_cast<double>(revchain::branch(rods, to).size());
    cost("branch: link and point", 100 * points, [&] { return revchain::branch(rods, to).tip_radius.back(); });
    const auto diagram = [](const char* name, const Chain<double>& chain, double height) {
        cost(name, 1, [&] {
            return revchain::branches(chain, {.min_conical_height = height}, thorough).branches.size();
        });
    };
    diagram("branches: 3 plummets", plummets(3), 3 / 200.0);
    diagram("branches: 3 rods", Chain<double>::uniform_rods(3, 3.0), 3 / 200.0);
    diagram("branches: 5 plummets", plummets(5), 5 / 200.0);
    diagram("branches: 6 plummets", plummets(6), 6 / 200.0);
    diagram("branches: 8 plummets", plummets(8), 1 / 25.0);
    diagram("branches: 20 rods", Chain<double>::uniform_rods(20, 1.0), 9.80665 / 400);
    const auto long_one = Chain<double>::uniform_rods(100'000, 1.0);
    const double critical = revchain::modes(long_one, {.count = 1}).angular_speed()[0];
    cost("steady_shape: 100,000 rods", 1, [&] {
        return revchain::steady_shape(long_one, {.angular_speed = 2 * critical}).offset[0];
    });

    for (const Index n : {20, 40}) {
        const auto chain = plummets(n);
        const auto shape = revchain::steady_shape(chain, {.conical_height = 0.5 * static_cast<double>(n)});
        char name[40];
        std::snprintf(name, sizeof name, "stability: %d links", static_cast<int>(n));
        cost(name, 1, [&] { return revchain::stability(chain, shape).growth_rate; });
        std::snprintf(name, sizeof name, "stability: %d links, driven", static_cast<int>(n));
        cost(name, 1, [&] {
            return revchain::stability(chain, shape, revchain::StabilityFrame::driven).growth_rate;
        });
        const auto second = revchain::steady_shape(chain, {.mode = 2, .conical_height = 0.1 * static_cast<double>(n)});
        std::snprintf(name, sizeof name, "stability: %d links, one node", static_cast<int>(n));
        cost(name, 1, [&] { return revchain::stability(chain, second).growth_rate; });
    }
    const Rig carousel(Chain<double>({revchain::plummet(80.0, 4.0)}), {.support = revchain::carried_round(3.0)});
    cost("campbell: speed without crossings", 2,
         [&] { return revchain::campbell(carousel, {.angular_speed = {0.5, 0.51}}).frequency(0, 0); });
    cost("campbell: two speeds and a crossing", 1, [&] {
        return revchain::campbell(carousel, {.angular_speed = {0.5, 1.0}, .orders = {1}}).frequency(0, 0);
    });
}

void held() {
    using revchain::Held;
    const auto rods = Chain<double>::uniform_rods(40, 1.0);
    const Held spanned(rods, {.span = 0.5});
    cost("held: steady_shapes without proof, link", 40, [&] {
        return revchain::steady_shapes(spanned, {.angular_speed = 10.0, .prove = false}).shapes.size();
    });
    cost("held: steady_shapes, 40 links", 1,
         [&] { return revchain::steady_shapes(spanned, {.angular_speed = 10.0}).shapes.size(); });
    for (const Index n : {3, 6, 9}) {
        char name[60];
        std::snprintf(name, sizeof name, "held: steady_shapes, %d links", static_cast<int>(n));
        const Held few(Chain<double>::uniform_rods(n, 1.0), {.span = 0.5});
        cost(name, 1, [&] { return revchain::steady_shapes(few, {.angular_speed = 10.0}).shapes.size(); });
    }
    const Held tight(rods, {.tension = 1.3});
    cost("held: steady_shapes at a tension without proof, link", 40, [&] {
        return revchain::steady_shapes(tight, {.angular_speed = 10.0, .prove = false}).shapes.size();
    });
    const Held rope(revchain::Cord(1.0), {.span = 0.5});
    cost("held: steady_shapes of a cord", 1,
         [&] { return revchain::steady_shapes(rope, {.angular_speed = 10.0}).shapes.size(); });
    const auto chain = mixed(200);
    const Held taut(chain, {.tension = 2 * chain.total_weight()});
    cost("held: link and mode", 200 * 50, [&] { return revchain::modes(taut, {.count = 50}).conical_height[0]; });
    cost("held: link and mode, with shapes", 200 * 50, [&] {
        const auto m = revchain::modes(taut, {.count = 50});
        return m.shapes()(0, 0);
    });
    cost("held: count_modes, link", 200, [&] { return revchain::count_modes(taut, {.conical_height = 1.0}); });
    cost("held: branches", 1, [&] {
        return revchain::branches(Held(Chain<double>::uniform_rods(10, 1.0), {.span = 0.5}), {.max_angular_speed = 10.0})
            .size();
    });
}

void cords() {
    using revchain::Cord;
    const std::pair<const char*, Cord> kinds[]{
        {"uniform", Cord(1.0)},
        {"power", Cord(1.0, {.density = 0.5})},
        {"tip", Cord(1.0, {.tip_weight = 1.0})},
        {"power and tip", Cord(1.0, {.density = 0.5, .tip_weight = 1.0})},
        {"particle", Cord(1.0, {.weights = {{0.5, 1.0}}})},
        {"function", Cord(1.0, {.density = [](double s) { return 1 + s; }})}};
    for (const auto& [kind, cord] : kinds) {
        char name[80];
        std::snprintf(name, sizeof name, "cord: mode, %s", kind);
        cost(name, 20, [&] { return revchain::modes(cord, {.count = 20}).conical_height[0]; });
        const auto found = revchain::modes(cord, {.count = 5});
        std::snprintf(name, sizeof name, "cord: offset, %s", kind);
        cost(name, 1, [&] { return found.offset(3, 0.3); });
        const revchain::Vector<double> along = revchain::Vector<double>::LinSpaced(1000, 0.0, 1.0);
        std::snprintf(name, sizeof name, "cord: offset of 1000, %s", kind);
        cost(name, 1000, [&] { return found.offset(3, along)[0]; });
        std::snprintf(name, sizeof name, "cord: count_modes, %s", kind);
        cost(name, 1, [&] { return revchain::count_modes(cord, {.angular_speed = 30.0}); });
        std::snprintf(name, sizeof name, "cord: sensitivity, mode, %s", kind);
        cost(name, 5, [&] { return revchain::sensitivity(found).length[0]; });
        std::snprintf(name, sizeof name, "cord: branch, point, %s", kind);
        const revchain::BranchOptions to{.mode = 2, .min_conical_height = 0.01};
        const auto points = static_cast<double>(revchain::branch(cord, to).size());
        cost(name, points, [&] { return revchain::branch(cord, to).size(); });
        std::snprintf(name, sizeof name, "cord: steady_shapes, shape, %s", kind);
        const auto shapes = revchain::steady_shapes(cord, {.conical_height = 0.03});
        cost(name, static_cast<double>(shapes.shapes.size()),
             [&] { return revchain::steady_shapes(cord, {.conical_height = 0.03}).shapes.size(); });
    }
    const Cord cord(1.0);
    for (const Index mode : {1, 3}) {
        const auto shape = revchain::steady_shape(cord, {.mode = mode, .conical_height = 0.03});
        cost(mode == 1 ? "cord: stability, no node" : "cord: stability, two nodes", 1,
             [&] { return revchain::stability(cord, shape).growth_rate; });
    }
    cost("cord: swing", 1, [&] {
        return revchain::swing(cord, {.offset = [](double s) { return 0.1 * (1 - s); }, .time = {1.0}}).offset(0, 0);
    });
}

void closed_forms() {
    const auto clapper = revchain::compound_pendulum<double>(
        {.weight = 10, .length = 0.8, .centroid = 0.7, .radius_of_gyration = 0.1});
    const auto body = revchain::compound_pendulum<double>(
        {.weight = 200, .length = 0.2, .centroid = 0.4, .radius_of_gyration = 0.4});
    const auto bell = revchain::bell_and_clapper(Chain<double>({clapper, body}));
    cost("bell: first_strike", 1,
         [&] { return revchain::first_strike(bell, {.clearance = 0.4, .amplitude = 1.5}).time; });
    cost("bell: first_strike, full circle", 1,
         [&] { return revchain::first_strike(bell, {.clearance = 0.4}).time; });
    const revchain::Carriages carriages{
        .front_mass = 20e3, .rear_mass = 20e3, .buffer_stiffness = 2e6, .coupling_stiffness = 0.5e6, .speed = 2.0};
    const revchain::BufferImpact impact(carriages);
    cost("buffer: blow", static_cast<double>(impact.blows().size()),
         [&] { return revchain::BufferImpact(carriages).blows().size(); });
    cost("buffer: state", 1, [&] { return impact(0.1).front; });
    cost("conical_pendulum: carried_inclinations", 1,
         [&] { return revchain::carried_inclinations(1.0, 0.3, 0.2).inclination[0]; });
    const auto pair = [] { return revchain::two_plummets_shapes(1.0, 0.5, 1.0, 0.5, 0.1); };
    cost("two_links: shape", static_cast<double>(pair().size()), [&] { return pair().size(); });
    const revchain::analytic::Governor data{
        .angular_speed = 6.0, .pendulum_length = 0.5, .gravity = 9.80665, .angle = 1.2};
    const revchain::analytic::GovernorMotion motion(data);
    cost("governor: construct", 1, [&] { return revchain::analytic::GovernorMotion(data).period(); });
    cost("governor: time", 1, [&] { return motion(0.3).angle; });
    const revchain::SleeveGovernor watt(
        {.ball_mass = 4, .arm = 1.4, .lower_arm = 1.4, .sleeve_mass = 3, .gravity = 12});
    cost("sleeve_governor: point", 1, [&] { return watt.speed(0.9); });
    cost("sleeve_governor: equilibria", 1, [&] { return watt.equilibria(5.0).size(); });
    const revchain::analytic::RopeGiven given{.span = 2.0, .length = 3.0, .angular_speed = 10.0};
    const revchain::analytic::SkippingRope rope(given);
    cost("rope: construct", 1, [&] { return revchain::analytic::SkippingRope(given).sag(); });
    cost("rope: point", 1, [&] { return rope.at(0.5).offset; });
    cost("rope: point by arc", 1, [&] { return rope.at_arc(0.5).offset; });
    const revchain::analytic::TortuousGiven wound{
        .least_radius = 0.3, .greatest_radius = 1.0, .angular_speed = 10.0, .tension = 3.0};
    const revchain::analytic::TortuousRope tortuous(wound);
    cost("rope: construct tortuous", 1, [&] { return revchain::analytic::TortuousRope(wound).half_wave(); });
    cost("rope: point of tortuous", 1, [&] { return tortuous.at(0.5).radius; });
}

}  // namespace

int main(int count, char** words) {
    if (count > 1) wanted = words[1];
    chains();
    closed_forms();
    modes();
    motion();
    cords();
    held();
    shapes();
}
