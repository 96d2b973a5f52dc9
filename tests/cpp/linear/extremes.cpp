// SPDX-License-Identifier: MPL-2.0
// Chains at the ends of what a scalar holds, and random ones of every awkward kind, against singular values in
// quadruple precision and, where that does not suffice, counts in 5120 bits.
#include <cfenv>
#include <optional>

#include "revchain/modes.hpp"
#include "support/big_float.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/singular_values.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::Link;
using support::heights_by_singular_values;
using support::Quad;
using support::Random;

namespace {

using Links = std::vector<Link<double>>;

/// A chain of one to six links, of kinds drawn at random.
Links random_links(Random& random) {
    const auto one_of = [&](int count) { return static_cast<int>(random.between(0, count)); };
    const Index size = 1 + one_of(6);
    const int weights = one_of(7), lengths = one_of(4), bodies = one_of(9);
    const double per_link = std::pow(2.0, random.between(0, 1000.0 / static_cast<double>(size)));
    const double length_unit = std::ldexp(1.0, one_of(4) == 0 ? one_of(1900) - 950 : 0);
    Links links;
    double graded = weights == 2 ? 0x1p-500 : 0x1p500;
    for (Index m = 0; m < size; ++m) {
        double weight = 1;
        switch (weights) {
            case 0:
                weight = random.between(0.5, 1.5);
                break;
            case 1:
                weight = random.log_between(1e-8, 1e8);
                break;
            case 2:
                weight = graded, graded *= per_link;
                break;  // heavier upwards
            case 3:
                weight = graded, graded /= per_link;
                break;  // heavy tip
            case 4:
                weight = std::ldexp(1.0, one_of(1001) - 500);
                break;
            case 5:
                weight = m > 0 && one_of(2) == 0 ? 0 : random.log_between(1e-3, 1e3);
                break;
            default:
                break;  // equal
        }
        double a = 1;
        if (lengths == 1) a = random.between(0.5, 1.5);
        if (lengths == 2) a = random.log_between(1e-3, 1e3);
        if (lengths == 3) a = random.log_between(1e-12, 1e12);
        a *= length_unit;
        double h = a * random.between(0.1, 0.9), rho = 0, l = 0;
        switch (bodies == 8 ? one_of(8) : bodies) {
            case 0:
                links.push_back(revchain::plummet(weight, a));
                continue;
            case 1:
                links.push_back(revchain::uniform_rod(weight, a));
                continue;
            case 2:
                rho = a * random.between(0, 0.6);
                break;
            case 3:
                l = a;
                break;  // diagonal mass matrix
            case 4:
                l = h * (1 + random.log_between(1e-12, 1e3));
                break;  // l >> a, or hardly beyond h
            case 5:
                h = a * random.between(1, 3), rho = a * random.between(0, 2);
                break;  // h > a
            case 6:     // near and in the pin
                h = m > 0 && one_of(2) == 0 ? 0 : a * random.log_between(1e-6, 1e-1);
                rho = a * random.log_between(1e-3, 1);
                break;
            default:
                h = m > 0 ? -a * random.log_between(1e-6, 1) : h, rho = a * random.between(0, 1);  // above the pin
        }
        revchain::CompoundPendulum<double> body{.weight = weight, .length = a, .centroid = h};
        (l != 0 ? body.pendulum_length : body.radius_of_gyration) = l != 0 ? l : rho;
        links.push_back(revchain::compound_pendulum(body));
    }
    return links;
}

struct Tally {
    Index chains = 0, heights = 0, misses = 0, not_nearest = 0, out_of_range = 0, unproved = 0;
    double worst_bound = 0;
};

/// Compares all heights of `count` random chains.
Tally compare(Index count, std::uint64_t seed) {
    Random random(seed);
    Tally tally;
    while (tally.chains < count) {
        const Links links = random_links(random);
        std::optional<Chain<double>> chain;
        try {
            chain.emplace(links);
        } catch (const revchain::InvalidArgument&) {
            continue;  // it would stand
        }
        ++tally.chains;
        const auto m = revchain::modes(*chain, {.count = revchain::all_modes});
        const auto exact = heights_by_singular_values(*chain);
        for (Index j = 0; j < m.size(); ++j) {
            ++tally.heights;
            const double height = m.conical_height[j], bound = m.error_bound[j];
            const Quad truth = exact[static_cast<std::size_t>(j)];
            const double unit = std::ldexp(1.0, chain->units().length_exponent);
            if (!std::isfinite(bound)) {  // only near the ends of the range of double, in either unit
                ++tally.out_of_range;
                if (support::count_in_big_floats(*chain, std::max(0x1p-1020, unit * 0x1p-800), 0) > j &&
                    support::count_in_big_floats(*chain, std::min(0x1p1020, unit * 0x1p800), 0) <= j)
                    ++tally.unproved;
                continue;
            }
            const double error = static_cast<double>(fabsq(Quad(height) / truth - 1));
            const bool in_range = height > 0x1p-1021 && height > 0x1p-800 * unit;
            if (in_range) tally.worst_bound = std::max(tally.worst_bound, bound);
            if (error <= 0.501 * 0x1p-52) continue;
            // Not the nearest double; or the quadruple reference has lost it, where the weights go heavy, light, heavy.
            const auto outside = [&](double margin) {
                return support::count_in_big_floats(*chain, height, margin) > j ||
                       support::count_in_big_floats(*chain, height, -margin / (1 + margin)) <= j;
            };
            if (in_range && outside(0.501 * 0x1p-52)) ++tally.not_nearest;
            if (error > bound && outside(bound)) {
                ++tally.misses;
                CAPTURE(tally.chains, j, height, static_cast<double>(truth), bound);
                for (const auto& link : links)
                    UNSCOPED_INFO(link.weight << " " << link.length << " " << link.centroid << " "
                                              << link.gyration_ratio.high);
                CHECK(error <= bound);
            }
        }
    }
    return tally;
}

void require(const Tally& tally) {
    CAPTURE(tally.chains, tally.heights, tally.not_nearest, tally.out_of_range, tally.worst_bound);
    CHECK(tally.misses == 0);
    CHECK(tally.unproved == 0);
    CHECK(tally.worst_bound <= 0x1.001p-51);
    CHECK(tally.not_nearest * 1000 <= tally.heights);  // measured: 13 of 34,000
}

}  // namespace

// The exact counter itself, against another formulation in quadruple precision.
TEST_CASE("counts in big floats", "[linear]") {
    Index compared = 0;
    for (const auto& family : support::families())
        for (const Index n : {1, 2, 3, 5}) {
            const auto chain = family.make(n);
            const auto heights = heights_by_singular_values(chain);
            for (Index j = 0; j < chain.mode_count(); ++j) {
                const Quad exact = heights[static_cast<std::size_t>(j)];
                const double height = static_cast<double>(exact);
                const double off = static_cast<double>(exact / Quad(height) - 1);  // rounding, known to 1e-30
                for (const double margin : {1e-3, 1e-14, 1e-24}) {
                    const auto near = [&](const Quad& other) { return fabsq(other / exact - 1) < 2 * margin; };
                    if (std::count_if(heights.begin(), heights.end(), near) != 1) continue;
                    CAPTURE(family.name, n, j, margin);
                    ++compared;
                    CHECK(support::count_in_big_floats(chain, height, off - margin) == j + 1);
                    CHECK(support::count_in_big_floats(chain, height, off + margin) == j);
                }
            }
        }
    CHECK(compared > 300);
}

TEST_CASE("10,000 random small chains: no height missed", "[linear]") { require(compare(10'000, 1)); }

TEST_CASE("1,000,000 random small chains: no height missed", "[.slow]") {
    for (std::uint64_t seed = 100; seed < 200; ++seed) require(compare(10'000, seed));
}

// Scaling all weights, or all lengths, by powers of two changes exponents and nothing else, from one end of the range of
// double to the other.
TEST_CASE("results do not know the units, to the last bit", "[linear]") {
    Random random(3);
    Index compared = 0;
    while (compared < 1500) {
        const Links links = random_links(random);
        double least = 1e308, most = 0, least_weight = 1e308, most_weight = 0;
        for (const auto& link : links) {
            for (const double x : {link.length, std::abs(link.centroid)})
                if (x != 0) least = std::min(least, x), most = std::max(most, x);
            if (link.weight != 0) least_weight = std::min(least_weight, link.weight);
            most_weight = std::max(most_weight, link.weight);
        }
        std::optional<revchain::Modes<double>> reference;
        try {
            reference = revchain::modes(Chain<double>(links), {.count = revchain::all_modes});
        } catch (const revchain::InvalidArgument&) {
            continue;
        }
        ++compared;
        // as far down and up as all numbers stay normal, digits included
        const int down = std::ilogb(least) + 960, up = 1000 - std::ilogb(most);
        const int lighter = std::ilogb(least_weight) + 960, heavier = 1000 - std::ilogb(most_weight);
        for (const auto& [weight, length] : {std::pair(-lighter, 0), std::pair(heavier, 0), std::pair(0, -down),
                                             std::pair(0, up), std::pair(heavier, -down), std::pair(-lighter, up)}) {
            auto scaled = links;
            for (auto& link : scaled) {
                link.weight = std::ldexp(link.weight, weight);
                link.length = std::ldexp(link.length, length);
                link.centroid = std::ldexp(link.centroid, length);
            }
            const auto m = revchain::modes(Chain<double>(scaled), {.count = revchain::all_modes});
            CAPTURE(compared, weight, length);
            REQUIRE(m.size() == reference->size());
            CHECK(m.shapes() == reference->shapes());
            for (Index j = 0; j < m.size(); ++j) {
                const double expected = std::ldexp(reference->conical_height[j], length);
                if (reference->conical_height[j] < 0x1p-960 || !(expected >= 0x1p-960 && expected <= 0x1p1022))
                    continue;
                CHECK(m.conical_height[j] == expected);
                CHECK(m.error_bound[j] == reference->error_bound[j]);
            }
        }
    }
}

TEST_CASE("no spurious flags, whatever the units and ratios", "[linear]") {
    Random random(4);
    for (int i = 0; i < 3000; ++i) {
        const Links links = random_links(random);
        std::feclearexcept(FE_ALL_EXCEPT);
        try {
            const Chain<double> chain(links);
            CAPTURE(i);
            CHECK(std::fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) == 0);
            const auto m = revchain::modes(chain, {.count = revchain::all_modes});
            REQUIRE(m.shapes().allFinite());
            if (!(m.error_bound.maxCoeff() <= 1)) continue;  // a height beyond the range: the overflow is its own
            CHECK(std::fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) == 0);
        } catch (const revchain::InvalidArgument&) {
        }
    }
}

// One, two and three links in closed form.
TEST_CASE("one link swings as its simple pendulum", "[linear]") {
    for (const double unit : {5e-324, 1e-300, 1.0, 1e300})
        for (const double weight : {5e-324, 1.0, 1e308}) {
            const auto of = [&](const Link<double>& link) {
                return revchain::modes(Chain<double>(Links{link}), {.count = revchain::all_modes}).conical_height[0];
            };
            CAPTURE(unit, weight);
            CHECK(of(revchain::plummet(weight, unit)) == unit);
            if (unit < 1e-320) continue;
            CHECK(of(revchain::uniform_rod(weight, unit * 1.5)) == Approx(unit).epsilon(1e-15));
            CHECK(of(revchain::compound_pendulum<double>(
                      {.weight = weight, .length = unit, .centroid = 0.25 * unit, .pendulum_length = 3 * unit})) ==
                  3 * unit);
        }
}

// Greenhill §2 (5): the truth is Lagrange's quadratic, in the form without cancellation.
TEST_CASE("two plummets, weights 2^-1000 to 2^1000 apart", "[linear]") {
    double worst = 0;
    for (int exponent = -1000; exponent <= 1000; exponent += 8) {
        const double w1 = std::ldexp(1.3, exponent / 2), w2 = std::ldexp(1.1, exponent / 2 - exponent), a1 = 0.7,
                     a2 = 0.9;
        const auto m = revchain::modes(Chain<double>(std::vector{revchain::plummet(w1, a1), revchain::plummet(w2, a2)}),
                                       {.count = revchain::all_modes});
        const Quad l1 = a1, l2 = a2, mu = Quad(w1) / (Quad(w1) + Quad(w2)), rest = Quad(w2) / (Quad(w1) + Quad(w2));
        const Quad first = (l1 + l2 + sqrtq((l1 - l2) * (l1 - l2) + 4 * mu * l1 * l2)) / 2;
        const Quad second = l1 * l2 * rest / first;
        CAPTURE(exponent, m.error_bound[0], m.error_bound[1]);
        CHECK(m.error_bound[0] <= 0x1.001p-51);
        if (exponent > 900) continue;  // the second height is 2^-exponent, and soon leaves what can be proved
        CHECK(m.error_bound[1] <= 0x1.001p-51);
        for (Index j = 0; j < 2; ++j) {
            const Quad exact = j == 0 ? first : second;
            worst = std::max(worst, static_cast<double>(fabsq(Quad(m.conical_height[j]) / exact - 1)) * 0x1p52);
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 0.5001);
}

// Equal weights and threads: Laguerre's cubic, heights a/x with x^3 - 9 x^2 + 18 x - 6 = 0.
TEST_CASE("three equal plummets at the ends of the range", "[linear]") {
    for (const double unit : {0x1p-1000, 1.0, 0x1p1020}) {
        const auto m = revchain::modes(Chain<double>(3, unit, unit, unit, revchain::Wide<double>(0)),
                                       {.count = revchain::all_modes});
        for (Index j = 0; j < 3; ++j) {
            Quad x = 1 / (Quad(m.conical_height[j]) / unit);
            for (int i = 0; i < 4; ++i) x -= (((x - 9) * x + 18) * x - 6) / ((3 * x - 18) * x + 18);
            CHECK(static_cast<double>(fabsq(Quad(m.conical_height[j]) / unit * x - 1)) <= 0.5001 * 0x1p-52);
        }
    }
}

// The middle link cuts the chain in two at lambda = 1 (lambda k + X = 0), and both halves swing at that height.
TEST_CASE("an exactly double height, and its neighbourhood", "[linear]") {
    using WideDouble = revchain::Wide<double>;
    for (const double off : {0.0, 0x1p-50, 0x1p-40, -0x1p-30, 0x1p-20, -0x1p-10}) {
        for (const int cut : {0, 1, 2}) {
            Links links{{1, 1, 0.5, WideDouble(0.375)}, {1, 1, 1, WideDouble(2)}, {1, 1, 0.5, WideDouble(2.25)}};
            links[static_cast<std::size_t>(cut)].gyration_ratio =
                links[static_cast<std::size_t>(cut)].gyration_ratio + off;
            const Chain<double> chain(links);
            const auto m = revchain::modes(chain, {.count = revchain::all_modes});
            const auto exact = heights_by_singular_values(chain);
            CAPTURE(off, cut, m.error_bound[0], m.error_bound[1], m.error_bound[2]);
            CHECK(m.error_bound.maxCoeff() <= 0x1.001p-51);
            for (Index j = 0; j < 3; ++j)
                CHECK(static_cast<double>(fabsq(Quad(m.conical_height[j]) / exact[static_cast<std::size_t>(j)] - 1)) <=
                      m.error_bound[j]);
        }
    }
}
