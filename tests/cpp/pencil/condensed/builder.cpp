// SPDX-License-Identifier: MPL-2.0
// What a builder notes for a run against what truncating, rounding and merging have done to it, in quadruple precision.
#include "revchain/pencil/condensed/builder.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using namespace revchain;
using namespace revchain::pencil;
using support::Quad;
using support::quad;
using support::Random;

namespace {

constexpr std::size_t many = 16;  // terms: the rest is below 1e-30 for every run that is short
constexpr std::size_t degree = Block<double>::degree;

struct Both {
    CondensedRun<double> run;
    Transfer<Quad, many> exact;
};

/// One link, or a few of them in double words: a run as exact as may be.
Both some_links(Random& random, int links, double spread, bool inertia, Quad& below) {
    Both both;
    for (int m = 0; m < links; ++m) {
        const Quad weight = random.log_between(1, spread), p = inertia ? random() : 1.0;
        const Quad f = Quad(random.log_between(1, spread)) / (below + p * weight);
        const Quad turning = inertia ? weight * p * (1 - p) * Quad(random()) : Quad(0);
        append_mass(both.exact, weight * p);
        append_spring(both.exact, f, turning * f);
        append_mass(both.exact, weight * (1 - p));
        below += weight;
    }
    const auto wide = [](const Quad& x) {
        const double high = static_cast<double>(x);
        return Wide<double>(high, static_cast<double>(x - Quad(high)));
    };
    auto& run = both.run;
    run.links = links;
    run.weight = wide(both.exact.c[0]);
    run.flexibility = wide(both.exact.b[0]);
    run.moment = wide(both.exact.a[0]);
    for (std::size_t i = 0; i < degree; ++i) {
        run.transfer.a[i] = static_cast<double>(both.exact.a[i]);
        run.transfer.c[i] = static_cast<double>(both.exact.c[i]);
        run.transfer.d[i] = static_cast<double>(both.exact.d[i]);
    }
    for (std::size_t i = 0; i <= degree; ++i) run.transfer.b[i] = static_cast<double>(both.exact.b[i]);
    return both;
}

struct Ends {
    Quad spring, lower, upper;
};

/// Spring and masses at lambda = 1 / mu, of as many terms as there are.
template <class T, std::size_t Degree>
Ends element(const Transfer<T, Degree>& t, Quad mu, std::size_t kept) {
    Quad a = 0, b = 0, d = 0;
    for (std::size_t i = kept; i-- > 0;) {
        a = Quad(t.a[i]) - mu * a;
        d = Quad(t.d[i]) - mu * d;
    }
    for (std::size_t i = kept + 1; i-- > 0;) b = Quad(t.b[i]) - mu * b;
    return {1 / (mu * b), a / b, d / b};
}

double apart(const Quad& x, const Quad& y) { return std::abs(static_cast<double>(x / y - 1)); }

}  // namespace

TEST_CASE("what a truncated series leaves out is less than is noted", "[blocks]") {
    Random random(51);
    double closest = 0;
    int compared = 0;
    for (int i = 0; i < 3000; ++i) {
        Quad below = random.log_between(1e-3, 1e3);
        const int links = 1 + static_cast<int>(random() * 12);
        const auto both = some_links(random, links, std::pow(10.0, 3 * random()), random() < 0.5, below);
        const double phase = random.log_between(1e-4, 0.5);
        const double least = static_cast<double>(both.exact.b[0] * both.exact.c[0]) / phase;
        const CondensedPencilBuilder<double> builder(least);
        const auto compare = [&]<std::size_t Kept>() {
            CondensedRun<double> run = both.run;
            builder.note_truncation<Kept>(run);
            const Quad mu = 1 / Quad(least);
            const Ends cut = element(both.exact, mu, Kept), exact = element(both.exact, mu, many - 1);
            const double spring = apart(cut.spring, exact.spring);
            const double mass =
                std::abs(static_cast<double>((cut.lower + cut.upper - exact.lower - exact.upper) / both.exact.c[0]));
            CAPTURE(i, Kept, links, phase);
            ++compared;
            // 1/t - 1/t^ is the cut over t: no more than 1.2 of it at these phases. Rounding of b1 ... in double: 1e-15.
            CHECK(spring <= 1.2 * run.stiffness_error * (1 + 1e-14) + 1e-28);
            CHECK(mass <= run.mass_error / 2 * 1.2 + 1.2 * run.stiffness_error + 1e-28);
            if (run.stiffness_error > 1e-20 && run.stiffness_error < 1)
                closest = std::max(closest, spring / run.stiffness_error);
            CHECK(builder.is_complete<Kept>(run) == (run.stiffness_error + run.mass_error / 2 <= 0x1p-58));  // eps / 64
        };
        compare.template operator()<2>();
        compare.template operator()<4>();
        compare.template operator()<degree>();
    }
    CHECK(compared == 9000);
    CHECK(closest > 0.3);  // and not by much more: measured 0.997
    WARN("left out: " << closest << " of what is noted");
}

TEST_CASE("merged runs are as accurate as is noted", "[blocks]") {
    Random random(52);
    double worst = 0;
    int whole = 0;
    for (int i = 0; i < 300; ++i) {
        const double spread = std::pow(10.0, random());
        const bool inertia = random() < 0.5;
        // Sixty-four links that are just short together: six levels of merging.
        Quad below = random.log_between(1, 1e3);
        std::vector<Both> links;
        Transfer<Quad, many> exact;
        for (int m = 0; m < 64; ++m) {
            links.push_back(some_links(random, 1, spread, inertia, below));
            exact = m == 0 ? links[0].exact : merged(exact, links.back().exact);
        }
        const double least = static_cast<double>(exact.b[0] * exact.c[0]) / 0.06;
        CondensedPencilBuilder<double> builder(least);
        for (const Both& link : links) {
            auto run = link.run;
            builder.note_roundings(run, 1, builder.second_terms(run));
            builder.add(run);
        }
        const auto pencil = builder.finish();
        CAPTURE(i, spread, inertia);
        if (pencil.blocks.size() != 1) continue;  // inertia of one link outweighs the others: not complete
        ++whole;
        const auto& block = pencil.blocks[0];
        CHECK(block.links == 64);
        for (const double share : {1.0, 1.7, 30.0}) {
            const double shift = least * share;
            const auto e = element_at(block, Wide<double>(shift));
            const Ends truth = element(exact, 1 / Quad(shift), many - 1);
            const double spring = apart(quad(e.spring), truth.spring);
            const double lower = std::abs(static_cast<double>((quad(e.lower) - truth.lower) / exact.c[0]));
            const double upper = std::abs(static_cast<double>((quad(e.upper) - truth.upper) / exact.c[0]));
            CHECK(spring + lower + upper <= pencil.error);
            worst = std::max(worst, (spring + lower + upper) / pencil.error);
        }
        // What is kept in two words is right in both.
        CHECK(apart(quad(block.stiffness), 1 / exact.b[0]) <= 1e-29);
        CHECK(apart(quad(block.lower), exact.a[0] / exact.b[0]) <= 1e-29);
        CHECK(static_cast<double>((quad(block.lower) + quad(block.upper)) / exact.c[0] - 1) <= 1e-29);
    }
    CHECK(whole > 150);
    CHECK(worst > 0.05);  // measured 0.12
    WARN("merged: " << worst << " of what is noted");
}

TEST_CASE("runs are merged while the result is short, complete and accurate, and else kept", "[blocks]") {
    Random random(53);
    Quad below = 10;
    const Both one = some_links(random, 1, 1.0, false, below), two = some_links(random, 1, 1.0, false, below);
    const double phase_of_two =
        static_cast<double>((one.exact.b[0] + two.exact.b[0]) * (one.exact.c[0] + two.exact.c[0]));
    const auto blocks = [&](double phase, const CondensedRun<double>& first) {
        CondensedPencilBuilder<double> builder(phase_of_two / phase);
        builder.add(first);
        builder.add(two.run);
        return builder.finish().blocks.size();
    };
    CHECK(blocks(0.07, one.run) == 1);
    CHECK(blocks(0.08, one.run) == 2);
    CondensedRun<double> alone = one.run;
    alone.alone = true;
    CHECK(blocks(0.01, alone) == 2);
    CondensedRun<double> inaccurate = one.run;
    inaccurate.mass_error = 1.2 * 0x1p-52;
    CHECK(blocks(0.01, inaccurate) == 2);
    // The largest errors are those of the chain.
    CondensedPencilBuilder<double> builder(phase_of_two);
    builder.add(inaccurate);
    CHECK(builder.finish().error >= 1.2 * 0x1p-52);
}

TEST_CASE("a massless run has no error of its masses", "[blocks]") {
    const CondensedPencilBuilder<double> builder(1.0);
    CondensedRun<double> run;
    run.flexibility = Wide<double>(0.01);
    append_spring(run.transfer, 0.01);
    CHECK(builder.is_complete<degree>(run));
    builder.note_truncation<degree>(run);
    builder.note_roundings(run, 9, builder.second_terms(run));
    CHECK(run.mass_error == 0);
    CHECK(run.stiffness_error == 0);
}
