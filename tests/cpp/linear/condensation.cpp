// SPDX-License-Identifier: MPL-2.0
// Runs of links condensed in double against the same runs in quadruple precision: what `condensed_chain` notes as rounded is
// more than what is.
#include "revchain/linear/condensation.hpp"

#include "revchain/linear/condensed_chain.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using namespace revchain;
using namespace revchain::detail;
using support::Quad;
using support::quad;
using support::Random;
using V = Pack<double>;

namespace {

constexpr double half = 0x1p-53;

/// Links first ... first + length - 1, hung by all below, lengths in `unit`.
pencil::Transfer<Quad, leaf_degree> exact_run(const Chain<double>& chain, Index first, Index length, double unit) {
    pencil::Transfer<Quad, leaf_degree> run;
    Quad below = 0;
    for (Index m = 0; m < first; ++m) below += quad(chain.weight()[m]);
    for (Index m = first; m < first + length; ++m) {
        const auto link = chain.link(m);
        const Quad w = quad(link.weight), p = quad(link.centroid) / quad(link.length), r = quad(link.gyration_ratio);
        const Quad f = quad(link.length) / quad(unit) / (below + w * p), inertia = w * (p * (1 - p) - r);
        pencil::append_mass(run, w * p);
        pencil::append_spring(run, f, inertia * f);
        pencil::append_mass(run, w * (1 - p));
        below += w;
    }
    return run;
}

/// Worst errors of many runs, each in units of what is noted for it.
struct Worst {
    double weight = 0, flexibility = 0, moment = 0, other = 0;
    Index valid = 0;
};

void compare(const Chain<double>& chain, Index length, Worst& worst) {
    const LinkColumns<double> links(chain);
    for (Index first = 64; first + runs_at_once * length <= chain.size(); first += runs_at_once * length) {
        Wide<double> above = chain.weight_below(first);
        const auto below = weights_below<double, V>(chain, links, first, length, above);
        const auto runs = condensed<double, V>(links, first, length, below);
        for (std::size_t lane = 0; lane < pack_size; ++lane) {
            if (runs.worst[lane] > 0) continue;
            ++worst.valid;
            const auto run = lane_of<double>(runs, lane, length);
            const auto exact = exact_run(chain, first + static_cast<Index>(lane) * length, length, links.unit_length);
            const auto error = [](const Quad& x, const Quad& y) { return std::abs(static_cast<double>(x / y - 1)); };
            worst.weight = std::max(worst.weight, error(quad(run.weight), exact.c[0]) / (0.1 * half));
            worst.flexibility = std::max(worst.flexibility, error(quad(run.flexibility), exact.b[0]) / (1.1 * half));
            // Leaves and merges: two units of the whole run's moment, and those of its leaves.
            const Index leaf = leaf_links(length);
            const double moment = static_cast<double>(moment_roundings(leaf) + 2) * half;
            if (exact.a[0] > 0) worst.moment = std::max(worst.moment, error(quad(run.moment), exact.a[0]) / moment);
            if (leaf_terms(length) < leaf_degree) continue;  // others are cut off as well
            // As `condensed_chain` notes them: those of a leaf relative to a quarter of its phase, those of merging to the term.
            const double roundings = static_cast<double>(coefficient_roundings(leaf));
            const double merges = static_cast<double>(length / leaf);
            const auto compare_second = [&](const Quad& x, const Quad& y, const Quad& first_term) {
                const double term = static_cast<double>(y / first_term);
                const double merging = length > leaf ? (roundings + 5 * merges) * term : 0;
                const double noted = half * (roundings * runs.leaf_phase[lane] / 4 + merging);
                worst.other = std::max(worst.other, std::abs(static_cast<double>((x - y) / first_term)) / noted);
            };
            const auto& t = run.transfer;
            compare_second(Quad(t.b[1]), exact.b[1], exact.b[0]);
            compare_second(Quad(t.c[1]), exact.c[1], exact.c[0]);
            compare_second(Quad(t.a[1]) + Quad(t.d[1]), exact.a[1] + exact.d[1], exact.b[0] * exact.c[0]);
        }
    }
}

enum class LinkKind { equal_plummets, equal_links, any_links };

Chain<double> chain_of_kind(LinkKind kind, Index size, Random& random) {
    const double spread = random.log_between(1.0, 100.0), length = random.between(0.1, 10.0);
    const double p = random.between(0.01, 1.0), turning = p * (1 - p) * random();
    if (kind == LinkKind::any_links)
        return support::chain_of(size, [&](Index) -> Link<double> {
            const double a = random.between(0.1, 10.0), q = random();
            return {random.log_between(1.0, spread), a, a * q, Wide<double>(q * (1 - q) * random())};
        });
    std::vector<double> weight(static_cast<std::size_t>(size));
    for (double& w : weight) w = random.log_between(1.0, spread);
    if (kind == LinkKind::equal_plummets) return Chain<double>(size, weight, length, length, Wide<double>(0.0));
    return Chain<double>(size, weight, length, length * p, Wide<double>(turning));
}

}  // namespace

TEST_CASE("condensed runs are as accurate as is noted for them", "[blocks]") {
    Random random(41);
    for (const LinkKind kind : {LinkKind::equal_plummets, LinkKind::equal_links, LinkKind::any_links}) {
        Worst worst;
        for (int i = 0; i < 40; ++i) {
            const Chain<double> chain = chain_of_kind(kind, 1100, random);
            REQUIRE(LinkColumns<double>(chain).equal == (kind != LinkKind::any_links));
            for (const Index length : {2, 4, 8, 32, 64, 256}) compare(chain, length, worst);
        }
        CAPTURE(static_cast<int>(kind), worst.valid);
        CHECK(worst.valid > 5000);
        CHECK(worst.weight <= 1.0);
        CHECK(worst.flexibility <= 1.0);
        CHECK(worst.moment <= 1.0);
        CHECK(worst.other <= 1.0);
        CHECK(worst.flexibility >= 0.3);  // measured 0.84 to 0.87; the rest 0.24 to 0.38
        WARN("kind " << static_cast<int>(kind) << ": weight " << worst.weight << ", flexibility " << worst.flexibility
                     << ", moment " << worst.moment << ", others " << worst.other << " of what is noted");
    }
}

TEST_CASE("a run that is not one says so", "[blocks]") {
    const Index size = 512, length = 8, odd = 300;
    const auto worst_with = [&](const Link<double>& link) {
        std::vector<Link<double>> links(static_cast<std::size_t>(size), uniform_rod<double>(1.0, 1.0));
        links[static_cast<std::size_t>(odd)] = link;
        const Chain<double> chain(links);
        const LinkColumns<double> columns(chain);
        const Index first = odd / (4 * length) * (4 * length), lane = (odd - first) / length;
        Wide<double> above = chain.weight_below(first);
        const auto below = weights_below<double, V>(chain, columns, first, length, above);
        const auto runs = condensed<double, V>(columns, first, length, below);
        for (Index other = 0; other < 4; ++other)
            if (other < lane) CHECK(!(runs.worst[static_cast<std::size_t>(other)] > 0));
        return runs.worst[static_cast<std::size_t>(lane)];
    };
    CHECK(worst_with(uniform_rod<double>(1.0, 1.0)) <= 0);
    CHECK(worst_with(uniform_rod<double>(0.0, 1.0)) <= 0);
    CHECK(worst_with(plummet<double>(2.0, 1e8)) <= 0);
    CHECK(worst_with({1.0, 1.0, 1.0 + 0x1p-52, Wide<double>(0.0)}) > 0);   // centroid beyond the lower pin
    CHECK(worst_with({1.0, 1.0, -0x1p-60, Wide<double>(0.0)}) > 0);        // above the upper one
    CHECK(worst_with({1.0, 1.0, 0.5, Wide<double>(0.25)}) <= 0);           // l = a
    CHECK(worst_with({1.0, 1.0, 0.5, Wide<double>(0.25 + 0x1p-44)}) > 0);  // l > a
    CHECK(worst_with(plummet<double>(301.0, 1.0)) > 0);                    // outweighs all below
}

TEST_CASE("sums of two words are exact to the second", "[blocks]") {
    Random random(42);
    revchain::CompensatedSum<double> sum, falling;
    Quad exact = 0, exact_falling = 0;
    double x = 1;
    for (int i = 0; i < 10000; ++i) {
        const double w = random.log_between(1e-6, 1e6);
        sum.add(w);
        exact += Quad(w);
        falling.add_smaller(x);
        exact_falling += Quad(x);
        x *= 0.999;
    }
    sum.normalise();
    CHECK(std::abs(static_cast<double>((Quad(sum.high) + Quad(sum.low)) / exact - 1)) <= 1e-28);
    CHECK(sum.high + sum.low == sum.high);
    CHECK(std::abs(static_cast<double>((Quad(falling.high) + Quad(falling.low)) / exact_falling - 1)) <= 1e-28);
}
