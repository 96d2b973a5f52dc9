// SPDX-License-Identifier: MPL-2.0
// Truth: the moments of x^exponent between the ends of each link as plain differences in quadruple precision, which leave
// some 30 digits of weights and of the squares of radii as many less as (m + 1)^3/(exponent + 1) has, link m from 0. Error:
// relative, in units in the last place (2^-52).
#include <quadmath.h>

#include "revchain/modes.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/system/converted.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/quad_scalar.hpp"
#include "support/truth.hpp"

using namespace revchain;
using support::Quad;
using support::quad;

namespace {

struct Piece {
    Quad weight, centroid, gyration_ratio;
};

/// Link m of n, of a chain of length n and weight 1.
Piece piece(Index m, Index n, double exponent) {
    const Quad q = Quad(exponent) + 1, a = Quad(m), b = a + 1;
    Quad moment[3];
    for (int i = 0; i < 3; ++i) moment[i] = (powq(b, q + i) - (m > 0 ? powq(a, q + i) : 0)) / (q + i);
    const Quad mean = moment[1] / moment[0];
    return {moment[0] * q / powq(Quad(n), q), b - mean, moment[2] / moment[0] - mean * mean};
}

struct Worst {
    double weight = 0, centroid = 0, gyration_ratio = 0;
};

template <class T>
double off(const T& x, Quad truth) {
    return static_cast<double>(fabsq(quad(x) / truth - 1));
}

Worst worst(const Chain<double>& chain, double exponent, Index step) {
    Worst w;
    for (Index m = 0; m < chain.size(); m += m < 3000 ? 1 : step) {
        const Piece truth = piece(m, chain.size(), exponent);
        w.weight = std::max(w.weight, off(chain.weight()[m], truth.weight) / 0x1p-52);
        w.centroid = std::max(w.centroid, off(chain.centroid()[m], truth.centroid) / 0x1p-52);
        const double place = static_cast<double>(m + 1), lost = place * place * place / std::min(1.0, exponent + 1);
        w.gyration_ratio = std::max(w.gyration_ratio, off(chain.gyration_ratio()[m], truth.gyration_ratio) / lost);
    }
    return w;
}

}  // namespace

TEST_CASE("tapered chain: weights, centroids and radii of the pieces of a cord") {
    Worst all;
    for (const double exponent : {-0.999, -0.9, -0.5, -0.1, 1e-9, 0.5, 1.0, 2.0, 3.7, 10.0, 40.5, 100.0, 700.0})
        for (const Index n : {1, 2, 3, 10, 100, 1000}) {
            if (exponent * std::log10(static_cast<double>(n)) > 285) continue;
            const auto chain = Chain<double>::tapered(n, static_cast<double>(n), exponent);
            REQUIRE(chain.taper() == exponent);
            const Worst w = worst(chain, exponent, 1);
            CAPTURE(exponent, n, w.weight, w.centroid, w.gyration_ratio);
            all = {std::max(all.weight, w.weight), std::max(all.centroid, w.centroid),
                   std::max(all.gyration_ratio, w.gyration_ratio)};
        }
    CHECK(all.weight <= 0.51);
    CHECK(all.centroid <= 0.51);
    CHECK(all.gyration_ratio <= 3e-28);
    for (const double exponent : {-0.9, 1.0, 20.0}) {  // a million
        const Worst w = worst(Chain<double>::tapered(1'000'000, 1e6, exponent), exponent, 997);
        CHECK(w.weight <= 0.51);
        CHECK(w.centroid <= 0.51);
        CHECK(w.gyration_ratio <= 1e-31);
    }
}

TEST_CASE("tapered chain: a density that does not vary is uniform rods") {
    const auto chain = Chain<double>::tapered(1000, 2.5, 0.0, 3.0);
    CHECK(chain == Chain<double>::uniform_rods(1000, 2.5, 3.0));
    CHECK(chain.weight().is_scalar());
    CHECK(chain.taper() == 0.0);
    CHECK(!Chain<double>::uniform_rods(3).taper());
    const Chain<double> copy = chain;
    CHECK(copy.taper() == 0.0);
    const auto almost = Chain<double>::tapered(10, 2.5, 1e-300, 3.0), rods = Chain<double>::uniform_rods(10, 2.5, 3.0);
    for (Index m = 0; m < 10; ++m) {
        CHECK(almost.weight()[m] == rods.weight()[m]);
        CHECK(almost.centroid()[m] == rods.centroid()[m]);
        CHECK(off(almost.gyration_ratio()[m], quad(rods.gyration_ratio()[m])) <= 1e-30);
    }
}

TEST_CASE("tapered chain: one link, and two of a cord that thickens upwards") {
    for (const double p : {-0.5, 0.0, 1.0, 7.0}) {  // rho^2/h + h of x^p about its upper end: 2/(p + 3)
        const auto one = Chain<double>::tapered(1, 1.0, p, 5.0);
        CHECK(one.total_weight() == 5.0);
        CHECK(modes(one, {.count = revchain::all_modes}).conical_height[0] == Approx(2 / (p + 3)).epsilon(1e-15));
    }
    const auto two = Chain<double>::tapered(2, 2.0, 1.0, 4.0);
    CHECK(two.weight()[0] == 1.0);
    CHECK(two.weight()[1] == 3.0);
    CHECK(two.centroid()[1] == Approx(4.0 / 9).epsilon(1e-15));
}

TEMPLATE_TEST_CASE("tapered chain: of any scalar", "", float, long double, DoubleDouble, support::QuadScalar) {
    for (const double exponent : {-0.9, 0.5, 3.0}) {
        const auto chain = Chain<TestType>::tapered(50, TestType(50), exponent);
        CHECK(chain.taper() == exponent);
        double worst = 0;
        for (Index m = 0; m < 50; ++m) {
            const Piece truth = piece(m, 50, exponent);
            const auto error = [&](const TestType& x, Quad t) {
                if constexpr (std::is_same_v<TestType, DoubleDouble>)
                    return off(x.word(), t);
                else if constexpr (std::is_same_v<TestType, support::QuadScalar>)
                    return static_cast<double>(fabsq(x.value() / t - 1));
                else
                    return off(x, t);
            };
            worst =
                std::max({worst, error(chain.weight()[m], truth.weight), error(chain.centroid()[m], truth.centroid)});
        }
        CAPTURE(exponent, worst);
        const double unit = std::max(static_cast<double>(std::numeric_limits<TestType>::epsilon()), 1e-30);
        CHECK(worst <= 60 * unit);
    }
}

TEST_CASE("tapered chain: what is refused, what is forgotten") {
    using C = Chain<double>;
    for (const double exponent : {-1.0, -2.0, 1000.5, std::nan(""), std::numeric_limits<double>::infinity()})
        CHECK_THROWS_AS(C::tapered(3, 1.0, exponent), InvalidArgument);
    CHECK_THROWS_AS(C::tapered(0, 1.0, 1.0), InvalidArgument);
    CHECK_THROWS_AS(C::tapered(3, 0.0, 1.0), InvalidArgument);
    CHECK_THROWS_AS(C::tapered(3, 1.0, 1.0, -1.0), InvalidArgument);
    CHECK_THROWS_AS(C::tapered(1'000'000, 1.0, 100.0), InvalidArgument);
    CHECK_THROWS_AS(C::tapered(10, 1.0, 400.0), InvalidArgument);
    CHECK(C::tapered(10, 1.0, 280.0).size() == 10);
    const C chain = C::tapered(5, 1.0, 2.0);
    CHECK(!revchain::detail::converted<float>(chain).taper());
    CHECK(C(5, chain.weight(), chain.length(), chain.centroid(), chain.gyration_ratio()) == chain);
}

// A foreign exponent would give heights that are wrong and called proved: links of taper 7 with equal weights, 0.52 in
// place of 0.91.
TEMPLATE_TEST_CASE("tapered chain: the exponent of stored links is checked", "", float, double, long double,
                   DoubleDouble) {
    using T = TestType;
    using C = Chain<T>;
    static_assert(!std::is_constructible_v<C, Index, Column<T>, Column<T>, Column<T>, Column<Wide<T>>, double>);
    support::Random random(5);
    for (int i = 0; i < 300; ++i) {
        const Index n = 1 + static_cast<Index>(random.between(0, 40));
        const double p = i % 10 == 0 ? 0.0 : random.between(-0.98, 12);
        const T length = static_cast<T>(std::exp(random.between(-9, 9)));
        const T weight = static_cast<T>(std::exp(random.between(-9, 9)));
        const C made = C::tapered(n, length, p, weight);
        const C stored(n, made.weight(), made.length(), made.centroid(), made.gyration_ratio());
        CAPTURE(n, p);
        REQUIRE(!stored.taper());
        CHECK(stored.as_tapered(p).taper() == p);
        CHECK(stored.as_tapered(p) == made);
        CHECK_THROWS_AS(stored.as_tapered(p + 1e-3), InvalidArgument);
        CHECK_THROWS_AS(C::uniform_plummets(n, length, weight).as_tapered(p), InvalidArgument);
        // one number of one link
        std::vector<Link<T>> links;
        for (Index m = 0; m < n; ++m) links.push_back(made.link(m));
        Link<T>& one = links[static_cast<std::size_t>(random.between(0, static_cast<double>(n)))];
        const T more = static_cast<T>(1.0001);
        if (i % 3 == 0 && n > 1) one.weight = one.weight * more;
        if (i % 3 == 1 || n == 1) one.centroid = one.centroid * more;
        if (i % 3 == 2) one.gyration_ratio = one.gyration_ratio * Wide<T>(more);
        CHECK_THROWS_AS(C(links).as_tapered(p), InvalidArgument);
    }
    for (const double exponent : {-1.0, 1000.5, std::nan("")})
        CHECK_THROWS_AS(C::uniform_rods(3).as_tapered(exponent), InvalidArgument);
}
