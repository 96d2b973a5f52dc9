// SPDX-License-Identifier: MPL-2.0
#include "revchain/compound_link.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

using support::error_in_ulp;
using support::Quad;

namespace {

template <class T>
revchain::CompoundLink<T> random_body(support::Random& random) {
    const double h = random.log_between(1e-3, 1e3);
    return {static_cast<T>(h), static_cast<T>(h * random.log_between(1e-3, 1e3))};
}

}  // namespace

TEMPLATE_TEST_CASE("§6: two particles that are kinetically the link", "[core]", float, double, long double) {
    using T = TestType;
    support::Random random(611);
    for (int i = 0; i < 1000; ++i) {
        const auto link = random_body<T>(random);
        const Quad h = link.centroid, k2 = Quad(link.radius_of_gyration) * link.radius_of_gyration, l = h + k2 / h;
        CHECK(error_in_ulp(link.pendulum_length(), l) <= 1.5);
        CHECK(error_in_ulp(link.square_over_centroid(), k2 / h) <= 1);
        CHECK(error_in_ulp(link.share_at_centre_of_oscillation(), h / l) <= 2);
        // weight h/l at L and 1 - h/l at C: the same centre of gravity and moment of inertia about C
        const Quad share = link.share_at_centre_of_oscillation(), length = link.pendulum_length();
        CHECK(fabsq(share * length - h) <= 4 * h * revchain::epsilon<T>());
        CHECK(fabsq(share * length * length - (h * h + k2)) <= 4 * (h * h + k2) * revchain::epsilon<T>());
        // hung from L the centre of oscillation is C
        const revchain::CompoundLink<T> turned{link.square_over_centroid(), link.radius_of_gyration};
        CHECK(error_in_ulp(turned.pendulum_length(), l) <= 3);
    }
}

TEMPLATE_TEST_CASE("§6 (1), (2): a link swings round its axle as a plummet at L, its pull through E", "[core]", float,
                   double, long double) {
    using T = TestType;
    support::Random random(612);
    double worst = 0;
    const double nearest = std::is_same_v<T, long double> ? 1e-12 : 1e-17;  // what 34 digits can tell
    for (int i = 0; i < 2000; ++i) {
        const auto link = random_body<T>(random);
        const T gap = static_cast<T>(i % 2 == 0 ? random.log_between(1e-6, 2.0) : 1 - random.log_between(nearest, 1.0));
        const T height = link.pendulum_length() * gap;
        const auto found = revchain::swung_link(link, height);
        const Quad h = link.centroid, l = h + Quad(link.radius_of_gyration) * link.radius_of_gyration / h,
                   lambda = height;
        const Quad cosine = lambda < l ? lambda / l : Quad(1), sine = sqrtq((1 - cosine) * (1 + cosine));
        const Quad outwards = h / lambda * sine;
        worst = std::max({worst, error_in_ulp(found.inclination, atan2q(sine, cosine)),
                          error_in_ulp(found.reaction, sqrtq(1 + outwards * outwards)),
                          error_in_ulp(found.reaction_inclination, atanq(outwards))});
        // E is below G and level with L: the line of the pull passes it, CE = (h sin d, l cos d)
        if (lambda < l)
            CHECK(fabsq(tanq(Quad(found.reaction_inclination)) - h * sine / (l * cosine)) <=
                  8 * revchain::epsilon<T>() * (1 + outwards * outwards));
    }
    CAPTURE(worst);
    CHECK(worst <= 2.3);
}

TEST_CASE("§6: wrong numbers of a link that swings", "[core]") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, nan, inf}) {
        CHECK_THROWS_AS(revchain::swung_link<double>({bad, 1.0}, 1.0), revchain::InvalidArgument);
        if (bad != 0) CHECK_THROWS_AS(revchain::swung_link<double>({1.0, bad}, 1.0), revchain::InvalidArgument);
    }
}
