// SPDX-License-Identifier: MPL-2.0
// All steady shapes of a chain, proved complete: how many, whether proved, cells looked at, CPU milliseconds (median of 5
// runs, of 1 where it takes over a second), and the worst proved bound of an inclination, as CSV. Families of random chains
// give their largest number of shapes, worst time and bound, and how many lists stayed open. Diagrams of branches give the
// number of branches, whether proved complete, the number of points, and the time. Half a minute.
#include <cstdio>
#include <functional>
#include <string>

#include "revchain/branches.hpp"
#include "revchain/modes.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/chains.hpp"
#include "timing.hpp"

namespace {

using revchain::Chain;
using revchain::Index;
using revchain::SteadyShapes;

struct Timed {
    SteadyShapes found;
    double milliseconds = 0, worst_bound = 0;
};

Timed timed(const Chain<double>& chain, const revchain::SteadyShapesOptions& options, int runs = 5) {
    Timed result;
    std::vector<double> times;
    double sink = 0;
    for (int i = 0; i < runs; ++i) {
        const double start = bench::cpu_seconds();
        result.found = revchain::steady_shapes(chain, options, revchain::thorough);
        times.push_back(1e3 * (bench::cpu_seconds() - start));
        sink += static_cast<double>(result.found.cells);
        if (times.back() > 1000) break;
    }
    for (const auto& shape : result.found.shapes) result.worst_bound = std::max(result.worst_bound, shape.error_bound);
    result.milliseconds = sink > 0 ? bench::median(times) : -1;
    return result;
}

void report(const std::string& name, const Timed& t) {
    std::printf("%s,%zu,%s,%ld,%.3g,%.2g\n", name.c_str(), t.found.shapes.size(), t.found.complete ? "yes" : "no",
                t.found.cells, t.milliseconds, t.worst_bound);
    std::fflush(stdout);
}

Chain<double> plummets(Index n) { return Chain<double>::uniform_plummets(n, static_cast<double>(n), 1.0); }
Chain<double> rods(Index n) { return Chain<double>::uniform_rods(n, static_cast<double>(n), 1.0); }

/// All branches down to a conical height.
void diagram(const std::string& name, const Chain<double>& chain, double least) {
    revchain::Branches found;
    std::vector<double> times;
    for (int i = 0; i < 5; ++i) {
        const double start = bench::cpu_seconds();
        found = revchain::branches(chain, {.min_conical_height = least}, revchain::thorough);
        times.push_back(1e3 * (bench::cpu_seconds() - start));
        if (times.back() > 1000) break;
    }
    std::size_t points = 0;
    for (const auto& branch : found.branches) points += branch.size();
    std::printf("branches: %s,%zu,%s,%zu,%.3g,\n", name.c_str(), found.branches.size(), found.complete ? "yes" : "no",
                points, bench::median(times));
    std::fflush(stdout);
}

/// Random chains of 2 ... 8 links (or fewer) at heights down to `least` of their length.
void family(const std::string& name, int count, Index most_links, double weights, double lengths, double least,
            bool hanging_only, const std::function<revchain::Link<double>(support::Random&, double, double)>& link) {
    support::Random random(17);
    Timed worst;
    long cells = 0;
    std::size_t shapes = 0;
    int open = 0;
    for (int i = 0; i < count; ++i) {
        const Index n = 2 + i % (most_links - 1);
        const auto chain = support::chain_of(
            n, [&](Index) { return link(random, random.log_between(1.0, weights), random.log_between(1.0, lengths)); });
        const double height = chain.total_length() * random.log_between(least, 10 * least);
        const Timed t = timed(chain, {.conical_height = height, .hanging_only = hanging_only}, 1);
        worst.milliseconds = std::max(worst.milliseconds, t.milliseconds);
        worst.worst_bound = std::max(worst.worst_bound, t.worst_bound);
        shapes = std::max(shapes, t.found.shapes.size()), cells = std::max(cells, t.found.cells);
        open += !t.found.complete;
    }
    std::printf("%d %s,%zu,%s,%ld,%.3g,%.2g\n", count, name.c_str(), shapes,
                open == 0 ? "yes" : (std::to_string(open) + " open").c_str(), cells, worst.milliseconds,
                worst.worst_bound);
    std::fflush(stdout);
}

}  // namespace

int main() {
    std::printf("chain,shapes,complete,cells,milliseconds,worst_bound\n");
    for (const auto& [n, ratio] : {std::pair<Index, double>{8, 35.4025}, {8, 166}, {10, 50}, {10, 166}, {12, 166}})
        report("plummets " + std::to_string(n) + " at a/lambda " + std::to_string(ratio).substr(0, 7),
               timed(plummets(n), {.conical_height = 1 / ratio}));
    for (const Index n : {6, 8})
        report("rods " + std::to_string(n) + " at a/lambda 166", timed(rods(n), {.conical_height = 1 / 166.0}));
    for (const Index n : {100, 1000}) {
        const double length = static_cast<double>(n);
        report("plummets " + std::to_string(n) + " at lambda = L/10",
               timed(plummets(n), {.conical_height = length / 10}));
        report("rods " + std::to_string(n) + " at lambda = L/10", timed(rods(n), {.conical_height = length / 10}));
    }
    for (const Index n : {2, 3, 4})
        report("any posture: plummets " + std::to_string(n) + " at a/lambda 166",
               timed(plummets(n), {.conical_height = 1 / 166.0, .hanging_only = false}));
    for (const Index n : {3, 4})
        report("any posture: rods " + std::to_string(n) + " at a/lambda 166",
               timed(rods(n), {.conical_height = 1 / 166.0, .hanging_only = false}));

    const auto plummet = [](support::Random&, double W, double a) { return revchain::plummet(W, a); };
    const auto rod = [](support::Random&, double W, double a) { return revchain::uniform_rod(W, a); };
    const auto heavy = [](support::Random& random, double W, double a) {  // l > a: three inclinations under one load
        return revchain::compound_pendulum<double>({.weight = W,
                                                    .length = a,
                                                    .centroid = a * random.log_between(0.1, 0.9),
                                                    .pendulum_length = a * random.log_between(1.1, 100.0)});
    };
    family("plummets to 8 links at lambda >= 1e-3 L", 120, 8, 100, 10, 1e-3, true, plummet);
    family("rods to 8 links at lambda >= 1e-3 L", 120, 8, 100, 10, 1e-3, true, rod);
    family("plummets to 6 links at lambda >= 1e-4 L", 60, 6, 100, 10, 1e-4, true, plummet);
    family("links of l > a to 4 links at lambda >= 1e-3 L", 120, 4, 100, 10, 1e-3, true, heavy);
    family("links of l > a to 4 links in any posture", 60, 4, 100, 10, 1e-3, false, heavy);

    diagram("plummets 8 to n = 5 sqrt(g/a)", plummets(8), 1.0 / 25);
    for (const double length : {1.0, 2.0})
        diagram("rods 20 of " + std::to_string(length).substr(0, 1) + " m to 20 rad/s",
                Chain<double>::uniform_rods(20, length, 1.0), 9.80665 / 400);
    for (const Index n : {2, 3, 4, 5, 6, 8, 10, 12}) {
        support::Random random(static_cast<unsigned>(n));
        const auto some = [&](auto link) {
            return support::chain_of(
                n, [&](Index) { return link(random.log_between(1.0, 10.0), random.log_between(1.0, 5.0)); });
        };
        const auto points = some([](double W, double a) { return revchain::plummet(W, a); });
        const auto bars = some([](double W, double a) { return revchain::uniform_rod(W, a); });
        const std::string size = std::to_string(n);
        for (const double share : {100, 1000}) {
            const std::string at = size + " at lambda = L/" + std::to_string(static_cast<int>(share));
            report("random plummets " + at, timed(points, {.conical_height = points.total_length() / share}));
            report("random rods " + at, timed(bars, {.conical_height = bars.total_length() / share}));
        }
        const double share = n > 6 ? 50 : 200;
        diagram("random plummets " + size + " to L/" + (n > 6 ? "50" : "200"), points, points.total_length() / share);
        diagram("random rods " + size + " to L/" + (n > 6 ? "50" : "200"), bars, bars.total_length() / share);
    }

    // Not a list: one shape of a long chain, on the branch of the slowest mode.
    const auto long_chain = Chain<double>::uniform_rods(100'000, 1.0, 1.0);
    const double first = revchain::modes(long_chain, {.count = 1}).conical_height[0];
    const double start = bench::cpu_seconds();
    const auto shape = revchain::steady_shape(long_chain, {.mode = 1, .conical_height = first / 4});
    std::printf("rods 100000 on branch 1 at twice the first speed,%d,,,%.3g,%.2g\n", shape.half_waves,
                1e3 * (bench::cpu_seconds() - start), shape.error_bound);
}
