// SPDX-License-Identifier: GPL-3.0-or-later
// The costs that the comments of public headers state: CPU time of calls, the shortest of several. Each line has a name
// and a time, in the unit that the header counts (a link, a mode, a point ...). `bench_costs TEXT` prints the lines with
// TEXT. tests/claims/headers.toml compares the lines with the sentences.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "revchain/analytic.hpp"
#include "revchain/batch.hpp"
#include "revchain/bell.hpp"
#include "revchain/branches.hpp"
#include "revchain/buffer.hpp"
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
volatile double sink, half = 0.5;  // the compiler does not know these

/// Prints the time of a call divided by the number of items in it.
template <class F>
void cost(const std::string& name, double items, const F& call) {
    if (name.find(wanted) == std::string::npos) return;
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
    std::printf("%s\t%.3g %s\n", name.c_str(), best * unit, text);
    std::fflush(stdout);
}

Chain<double> plummets(Index n) { return Chain<double>::uniform_plummets(n, static_cast<double>(n)); }

/// Rods and plummets of unequal weights and lengths.
std::vector<revchain::Link<double>> links(Index n, double widest = 2) {
    support::Random random(static_cast<std::uint64_t>(n));
    std::vector<revchain::Link<double>> made;
    for (Index m = 0; m < n; ++m) {
        const double weight = random.log_between(1 / widest, widest), length = random.between(0.5, 2);
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
    cost("count: ModeCounter, link", 1000,
         [counter = revchain::ModeCounter<double>(chain)] { return counter.above_height(10.0); });
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
    cost("methods: all of 1000", 1,
         [&] { return revchain::modes(chain, {.count = 1000}, revchain::methods::all).conical_height[0]; });
    const auto found = revchain::modes(chain, {.count = 100});
    found.shapes();
    cost("sensitivity: link and mode", 1000 * 100,
         [&] { return revchain::sensitivity(chain, found).weight().value(0, 0); });
    Numbers speeds;
    for (int i = 0; i < 1000; ++i) speeds.push_back(0.1 + 0.01 * i);
    cost("response: link and speed", 1000 * 100,
         [c = mixed(100), &speeds] { return revchain::response(c, {.angular_speed = speeds}).offset(0, 0); });

    const Rig sprung(chain, {.support = revchain::horizontal_spring(50.0)});
    cost("rig_modes: link and mode, with shapes", 1000 * 100, [&] {
        const auto m = revchain::modes(sprung, {.count = 100});
        return m.forward.shapes()(0, 0);
    });
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
    cost("swing: link and mode", squared, [&] { return swing(one); });
    cost("swing: link, mode and time (with the modes)", squared * 1000, [&] { return swing(many); });
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
    Numbers very_many;
    for (int i = 0; i < 20'000; ++i) very_many.push_back(0.01 * i);
    cost("transient: link, motion and time (with the motions)", squared * 20'000,
         [&] { return std::abs(revchain::transient(dashpots, {.offset = pulled, .time = very_many}).offset(0, 0)); });
}

void shapes() {
    using revchain::thorough;
    const auto list = [](const std::string& name, const Chain<double>& chain, double height, bool hanging) {
        const revchain::SteadyShapesOptions options{.conical_height = height, .hanging_only = hanging};
        cost("steady_shapes: " + name, 1, [&] { return revchain::steady_shapes(chain, options, thorough).cells; });
    };
    list("46 of 8 plummets", plummets(8), 0.04, true);
    list("14 of 1000 plummets", plummets(1000), 2, true);
    list("18 of 3 plummets, any posture", plummets(3), 0.003, false);
    list("64 of 4 plummets, any posture", plummets(4), 0.004, false);

    const long links = 100'000;
    cost("steady_shapes: link evaluation", static_cast<double>(links), [chain = plummets(40), links] {
        return revchain::steady_shapes(chain, {.conical_height = 0.04, .budget = links}, thorough).cells;
    });

    const auto rods = Chain<double>::uniform_rods(100, 1.0);
    const revchain::BranchOptions to{.mode = 2, .min_conical_height = 0.01};
    const auto points = static_cast<double>(revchain::branch(rods, to).size());
    cost("branch: link and point", 100 * points, [&] { return revchain::branch(rods, to).tip_radius.back(); });
    const auto diagram = [](const std::string& name, const Chain<double>& chain, double height) {
        cost(name, 1,
             [&] { return revchain::branches(chain, {.min_conical_height = height}, thorough).branches.size(); });
    };
    diagram("branches: 3 plummets", plummets(3), 3 / 200.0);
    diagram("branches: 6 plummets", plummets(6), 6 / 200.0);
    const auto long_one = Chain<double>::uniform_rods(100'000, 1.0);
    const double critical = revchain::modes(long_one, {.count = 1}).angular_speed()[0];
    cost("steady_shape: 100,000 rods", 1,
         [&] { return revchain::steady_shape(long_one, {.angular_speed = 2 * critical}).offset[0]; });

    for (const Index n : {20, 40}) {
        const auto chain = plummets(n);
        const auto shape = revchain::steady_shape(chain, {.conical_height = 0.5 * static_cast<double>(n)});
        cost("stability: " + std::to_string(n) + " links", 1,
             [&] { return revchain::stability(chain, shape, thorough).growth_rate; });
    }
}

void held() {
    using revchain::Held;
    const Held rods(Chain<double>::uniform_rods(9, 1.0), {.span = 0.5});
    cost("held: steady_shapes of 9 rods", 1,
         [&] { return revchain::steady_shapes(rods, {.angular_speed = 10.0}).shapes.size(); });
    const auto chain = mixed(200);
    const Held taut(chain, {.tension = 2 * chain.total_weight()});
    cost("held: link and mode, with shapes", 200 * 50, [&] {
        const auto m = revchain::modes(taut, {.count = 50});
        return m.shapes()(0, 0);
    });
}

void cords() {
    using revchain::Cord;
    const revchain::Vector<double> along = revchain::Vector<double>::LinSpaced(1000, 0.0, 1.0);
    const auto modes_of = [&](const std::string& kind, const Cord& cord) {
        cost("cord: mode, " + kind, 20, [&] { return revchain::modes(cord, {.count = 20}).conical_height[0]; });
        const auto found = revchain::modes(cord, {.count = 5});
        cost("cord: offset, " + kind, 1000, [&] { return found.offset(3, along)[0]; });
    };
    modes_of("uniform", Cord(1.0));
    modes_of("tip", Cord(1.0, {.tip_weight = 1.0}));
    modes_of("particle", Cord(1.0, {.weights = {{0.5, 1.0}}}));
}

void closed_forms() {
    const auto clapper =
        revchain::compound_pendulum<double>({.weight = 10, .length = 0.8, .centroid = 0.7, .radius_of_gyration = 0.1});
    const auto body =
        revchain::compound_pendulum<double>({.weight = 200, .length = 0.2, .centroid = 0.4, .radius_of_gyration = 0.4});
    const auto bell = revchain::bell_and_clapper(Chain<double>({clapper, body}));
    cost("bell: first_strike", 1,
         [&] { return revchain::first_strike(bell, {.clearance = 0.4, .amplitude = 1.5}).time; });
    const revchain::Carriages carriages{
        .front_mass = 20e3, .rear_mass = 20e3, .buffer_stiffness = 2e6, .coupling_stiffness = 0.5e6, .speed = 2.0};
    const revchain::BufferImpact impact(carriages);
    cost("buffer: blow", static_cast<double>(impact.blows().size()),
         [&] { return revchain::BufferImpact(carriages).blows().size(); });
    cost("buffer: state", 1, [&] { return impact(0.2 * half).front; });
    cost("conical_pendulum: carried_inclinations", 1,
         [&] { return revchain::carried_inclinations<double>(1.0, 0.6 * half, 0.2).inclination[0]; });
    const auto pair = [] { return revchain::two_plummets_shapes<double>(1.0, 0.5, 1.0, 0.5, 0.2 * half); };
    cost("two_links: shape", static_cast<double>(pair().size()), [&] { return pair().size(); });
    revchain::analytic::Governor data{.angular_speed = 6.0, .pendulum_length = 0.5, .gravity = 9.80665, .angle = 1.2};
    const revchain::analytic::GovernorMotion motion(data);
    cost("governor: construct", 1, [&] {
        data.angle = 1.2 + half;
        return revchain::analytic::GovernorMotion(data).period();
    });
    cost("governor: time", 1, [&] { return motion(half).angle; });
    const revchain::SleeveGovernor watt(
        {.ball_mass = 4, .arm = 1.4, .lower_arm = 1.4, .sleeve_mass = 3, .gravity = 12});
    cost("sleeve_governor: point", 1, [&] { return watt.speed(half); });
    cost("sleeve_governor: equilibria", 1, [&] { return watt.equilibria(5.0).size(); });
    revchain::analytic::RopeGiven given{.span = 2.0, .length = 3.0, .angular_speed = 10.0};
    const revchain::analytic::SkippingRope rope(given);
    cost("rope: construct", 1, [&] {
        given.length = 2.5 + half;
        return revchain::analytic::SkippingRope(given).sag();
    });
    cost("rope: point", 1, [&] { return rope.at(half).offset; });
    cost("rope: point by arc", 1, [&] { return rope.at_arc(half).offset; });
    revchain::analytic::TortuousGiven wound{
        .least_radius = 0.3, .greatest_radius = 1.0, .angular_speed = 10.0, .tension = 3.0};
    const revchain::analytic::TortuousRope tortuous(wound);
    cost("rope: construct tortuous", 1, [&] {
        wound.tension = 2.5 + half;
        return revchain::analytic::TortuousRope(wound).half_wave();
    });
    cost("rope: point of tortuous", 1, [&] { return tortuous.at(half).radius; });
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
