// SPDX-License-Identifier: MPL-2.0
#include "revchain/two_links.hpp"

#include "revchain/modes.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::JointedLinks;
using revchain::PairShape;
using support::error_in_ulp;
using support::Quad;
using support::Random;

namespace {

/// The numbers in the paper's letters, l from h and k.
struct Letters {
    Quad W1, h1, l1, W2, a2, h2, m_l2;  // m_l2 = W2 h2 l2: finite where h2 = 0
};

template <class T>
Letters letters(const JointedLinks<T>& links) {
    const Quad h1 = links.lower.centroid, k1 = links.lower.radius_of_gyration;
    const Quad h2 = links.upper_centroid, k2 = links.upper_radius_of_gyration, W2 = links.upper_weight;
    return {Quad(links.lower_weight), h1, h1 + k1 * k1 / h1,       W2,
            Quad(links.upper_length), h2, W2 * (h2 * h2 + k2 * k2)};
}

/// Links of any kind: centroids on either side of the support, pendulum lengths on either side of the length.
template <class T>
JointedLinks<T> random_links(Random& random, double span) {
    for (;;) {
        const double h1 = random.log_between(1 / span, span), a2 = random.log_between(1 / span, span);
        const double h2 = random() < 0.2 ? -a2 * random() : random() < 0.1 ? 0 : a2 * random.between(0.05, 2.0);
        const JointedLinks<T> links{
            static_cast<T>(random.log_between(1 / span, span)),
            {static_cast<T>(h1), static_cast<T>(random() < 0.2 ? 0 : h1 * random.between(0, 2))},
            static_cast<T>(random.log_between(1 / span, span)),
            static_cast<T>(a2),
            static_cast<T>(h2),
            static_cast<T>(random() < 0.2 ? 0 : a2 * random.log_between(0.01, 10))};
        const Letters q = letters(links);
        if (q.W1 * q.a2 + q.W2 * q.h2 > q.W1 * q.a2 / 1000 && q.m_l2 > 0) return links;
    }
}

/// Roots of (lambda - l1)((m + 1) lambda - m l2 - a2) = a2 h1, times W1 a2.
template <class T>
std::array<Quad, 2> true_heights(const JointedLinks<T>& links) {
    const auto [W1, h1, l1, W2, a2, h2, m_l2] = letters(links);
    const Quad hung = W1 * a2 + W2 * h2, p = (m_l2 + W1 * a2 * a2) / hung, c = W1 * a2 * a2 * h1 / hung;
    const Quad larger = (l1 + p) / 2 + sqrtq((l1 - p) * (l1 - p) / 4 + c);
    return {larger, (m_l2 * l1 + W1 * a2 * a2 * (l1 - h1)) / hung / larger};
}

/// Both moments, (10) and (11), over weights times lengths: the gradient of the energy by the inclinations.
struct Moments {
    Letters q;
    Quad lambda;

    std::array<Quad, 2> operator()(Quad d1, Quad d2) const {
        const auto [W1, h1, l1, W2, a2, h2, m_l2] = q;
        const Quad y1 = a2 * sinq(d2), s1 = sinq(d1), s2 = sinq(d2);
        return {(y1 + l1 * s1) * cosq(d1) - lambda * s1,
                (W1 * a2 * (y1 + h1 * s1) + m_l2 * s2) * cosq(d2) - lambda * (W1 * a2 + W2 * h2) * s2};
    }
    /// Newton's method; whether it ended within a right angle of the vertical.
    bool solve(Quad& d1, Quad& d2) const {
        const Quad step = 1e-17;
        for (int i = 0; i < 100; ++i) {
            const auto f = (*this)(d1, d2), f1 = (*this)(d1 + step, d2), f2 = (*this)(d1, d2 + step);
            const Quad a = (f1[0] - f[0]) / step, b = (f2[0] - f[0]) / step;
            const Quad c = (f1[1] - f[1]) / step, d = (f2[1] - f[1]) / step, whole = a * d - b * c;
            if (whole == 0) return false;
            const Quad x = (d * f[0] - b * f[1]) / whole, y = (a * f[1] - c * f[0]) / whole;
            d1 -= x, d2 -= y;
            if (fabsq(d1) > 2 || fabsq(d2) > 2) return false;
            if (fabsq(x) + fabsq(y) < Quad(1e-26)) return cosq(d1) > 0 && cosq(d2) > 0;
        }
        return false;
    }
};

}  // namespace

TEMPLATE_TEST_CASE("Jointed links: both heights", "[finite][jointed]", float, double, long double) {
    using T = TestType;
    Random random(41);
    double worst = 0, worst_bell = 0, worst_modes = 0;
    for (const double span : {2.0, 30.0, 1e4}) {
        for (int i = 0; i < 1000; ++i) {
            const auto links = random_links<T>(random, span);
            const auto heights = revchain::jointed_links(links);
            const auto truth = true_heights(links);
            double& larger = links.upper_centroid < 0 ? worst_bell : worst;
            for (std::size_t k = 0; k < 2; ++k) larger = std::max(larger, error_in_ulp(heights[k], truth[k]));
            if (i >= 100 || span > 30) continue;
            // and of the chain of the two; the lower link's length is of no account
            const auto lower = revchain::compound_pendulum<T>({.weight = links.lower_weight,
                                                               .length = links.lower.centroid,
                                                               .centroid = links.lower.centroid,
                                                               .radius_of_gyration = links.lower.radius_of_gyration});
            const auto upper = revchain::compound_pendulum<T>({.weight = links.upper_weight,
                                                               .length = links.upper_length,
                                                               .centroid = links.upper_centroid,
                                                               .radius_of_gyration = links.upper_radius_of_gyration});
            const auto modes = revchain::modes(Chain<T>({lower, upper}), {.count = revchain::all_modes});
            for (std::size_t k = 0; k < 2; ++k)
                worst_modes = std::max(
                    worst_modes, error_in_ulp(heights[k], Quad(modes.conical_height[static_cast<revchain::Index>(k)])));
        }
    }
    CAPTURE(worst, worst_bell, worst_modes);
    CHECK(worst <= 3);       // measured 2.6
    CHECK(worst_bell <= 3);  // measured 2.3
    CHECK(worst_modes <= 3);
}

TEST_CASE("Jointed links: every figure, and no other", "[finite][jointed]") {
    Random random(43);
    std::array<int, 5> counts{};
    double worst = 0, worst_tension = 0;
    int compared = 0;
    for (int i = 0; i < 150; ++i) {
        const auto links = random_links<double>(random, 3.0);
        const auto heights = revchain::jointed_links(links);
        const double height =
            i % 3 == 0 ? heights[1] * random.log_between(0.01, 0.9) : heights[0] * random.log_between(0.02, 0.9);
        const auto shapes = revchain::jointed_links_shapes(links, height);
        ++counts[shapes.size()];
        const Moments moments{letters(links), Quad(height)};
        // Each solves the equations of moments, and Newton's method does not move it
        for (const PairShape<double>& shape : shapes) {
            Quad d1 = shape.inclination[0], d2 = shape.inclination[1];
            REQUIRE(moments.solve(d1, d2));
            worst = std::max({worst, error_in_ulp(shape.inclination[0], d1), error_in_ulp(shape.inclination[1], d2)});
            const auto [W1, h1, l1, W2, a2, h2, m_l2] = moments.q;
            const Quad y1 = a2 * sinq(d2), push1 = (y1 + h1 * sinq(d1)) / Quad(height), whole = W1 + W2;
            const Quad push = (W1 * push1 + W2 * h2 * sinq(d2) / Quad(height)) / whole;
            // of the sum of the sizes of the terms
            const Quad size1 = (fabsq(y1) + h1 * fabsq(sinq(d1))) / Quad(height);
            const Quad size = (W1 * size1 + W2 * h2 * fabsq(sinq(d2)) / Quad(height)) / whole;
            const auto off = [](double found, Quad exact, Quad of) {
                return static_cast<double>(fabsq(Quad(found) - exact) / of / Quad(0x1p-52));
            };
            worst_tension = std::max(
                {worst_tension,
                 off(shape.tension[0], W1 / whole * sqrtq(1 + push1 * push1), W1 / whole * sqrtq(1 + size1 * size1)),
                 off(shape.tension[1], sqrtq(1 + push * push), sqrtq(1 + size * size))});
        }
        // From many starts no other is found
        for (int at1 = 0; at1 < 9; ++at1) {
            for (int at2 = -9; at2 <= 9; ++at2) {
                Quad d1 = 1.5 * (at1 + 1) / 9.0, d2 = 1.5 * at2 / 9.0;
                if (!moments.solve(d1, d2) || fabsq(d1) < Quad(1e-12)) continue;
                if (d1 < 0) d1 = -d1, d2 = -d2;
                bool known = false;
                for (const auto& shape : shapes)
                    known = known || (fabsq(d1 - Quad(shape.inclination[0])) < Quad(1e-9) &&
                                      fabsq(d2 - Quad(shape.inclination[1])) < Quad(1e-9));
                CHECK(known);
            }
        }
        // The chain of the two: the same, where the upper link hangs at one inclination under one load
        const double a1 = links.lower.pendulum_length();
        const auto lower = revchain::compound_pendulum<double>(
            {.weight = links.lower_weight, .length = a1, .centroid = links.lower.centroid, .pendulum_length = a1});
        const auto upper = revchain::compound_pendulum<double>({.weight = links.upper_weight,
                                                                .length = links.upper_length,
                                                                .centroid = links.upper_centroid,
                                                                .radius_of_gyration = links.upper_radius_of_gyration});
        const Letters q = letters(links);
        const bool one_inclination = height * (q.W1 * q.a2 + q.W2 * q.h2) > q.m_l2 - q.W2 * q.h2 * q.a2;  // of link 2
        if (one_inclination) {
            const auto found =
                revchain::steady_shapes(Chain<double>({lower, upper}), {.conical_height = height, .budget = 2000});
            CHECK(found.complete);
            ++compared;
            REQUIRE(found.shapes.size() == shapes.size());
            for (std::size_t k = 0; k < shapes.size(); ++k) {
                for (std::size_t m = 0; m < 2; ++m) {
                    const auto j = static_cast<revchain::Index>(m);
                    CHECK(std::abs(found.shapes[k].inclination[j] - shapes[k].inclination[m]) < 1e-12);
                    const double tension = found.shapes[k].tension[j] / (links.lower_weight + links.upper_weight);
                    CHECK(std::abs(tension / shapes[k].tension[m] - 1) < 1e-12);
                }
                CHECK(found.shapes[k].half_waves == shapes[k].half_waves());
                CHECK(std::abs(found.shapes[k].offset[0] / shapes[k].offset[0] - 1) < 1e-12);
                CHECK(std::abs(found.shapes[k].offset[1] / shapes[k].offset[1] - 1) < 1e-9);
            }
        }
    }
    CAPTURE(counts, worst, compared);
    CHECK(counts[4] > 0);
    CHECK(compared > 50);
    CHECK(worst <= 8);  // measured 4.5
    CAPTURE(worst_tension);
    CHECK(worst_tension <= 4);  // measured 3.5 of 20,000
}

TEST_CASE("Jointed links: two plummets are two plummets", "[finite][jointed]") {
    Random random(44);
    for (int i = 0; i < 100; ++i) {
        const double W1 = random.log_between(0.1, 10), W2 = random.log_between(0.1, 10),
                     l1 = random.log_between(0.1, 10), l2 = random.log_between(0.1, 10),
                     height = random.log_between(0.01, 1) * (l1 + l2);
        const JointedLinks<double> links{W1, {l1, 0}, W2, l2, l2, 0};
        const auto heights = revchain::jointed_links(links), plummets = revchain::two_plummets(W1, l1, W2, l2);
        for (std::size_t k = 0; k < 2; ++k) CHECK(std::abs(heights[k] / plummets[k] - 1) <= 6e-16);
        const auto shapes = revchain::jointed_links_shapes(links, height);
        const auto others = revchain::two_plummets_shapes(W1, l1, W2, l2, height);
        REQUIRE(shapes.size() == others.size());
        for (std::size_t k = 0; k < shapes.size(); ++k) {
            for (std::size_t m = 0; m < 2; ++m) {
                CHECK(std::abs(shapes[k].inclination[m] - others[k].inclination[m]) < 1e-12);
                CHECK(std::abs(shapes[k].tension[m] / others[k].tension[m] - 1) < 1e-12);
            }
        }
    }
}

TEST_CASE("Silent clapper: its pin, (16), and both in one line at any inclination", "[finite][jointed]") {
    Random random(45);
    double worst = 0, worst_bend = 0, worst_height = 0;
    for (int i = 0; i < 300; ++i) {
        const revchain::CompoundLink<double> clapper{random.between(0.3, 1.0), random.between(0.05, 0.5)};
        const revchain::CompoundLink<double> bell{random.between(0.05, 0.5), random.between(0.5, 1.5)};
        const double W1 = random.log_between(0.02, 1.0), W2 = 1;
        if (!(bell.pendulum_length() > 1.1 * clapper.pendulum_length())) continue;
        const double pin = revchain::pin_of_silent_clapper(W2, bell, W1, clapper);
        const Quad h1 = clapper.centroid, k1 = clapper.radius_of_gyration, h2 = bell.centroid,
                   k2 = bell.radius_of_gyration, l1 = h1 + k1 * k1 / h1, l2 = h2 + k2 * k2 / h2;
        const Quad w = W2 * h2 / W1, a2 = w * (l2 - l1) / (w + l1 - h1), m = w / a2;
        CHECK(fabsq(h1 - (m + 1) * l1 - m * (a2 - l2)) < 1e-29 * (m * l2 + l1));  // it is (16)
        worst = std::max(worst, error_in_ulp(pin, a2) / static_cast<double>((l1 + l2) / (l2 - l1)));
        const JointedLinks<double> links{W1, clapper, W2, pin, bell.centroid, bell.radius_of_gyration};
        const double straight = clapper.pendulum_length() + pin;
        const auto heights = revchain::jointed_links(links);
        const std::size_t k = std::abs(heights[0] - straight) < std::abs(heights[1] - straight) ? 0 : 1;
        worst_height = std::max(worst_height, error_in_ulp(heights[k], l1 + a2));
        for (const double share : {0.99, 0.7, 0.1}) {
            const double turned = std::acos(share);
            double least = 1;
            for (const auto& shape : revchain::jointed_links_shapes(links, share * straight))
                least = std::min(
                    least, std::max(std::abs(shape.inclination[0] - turned), std::abs(shape.inclination[1] - turned)));
            worst_bend = std::max(worst_bend, least);
        }
    }
    CAPTURE(worst, worst_height, worst_bend);
    CHECK(worst <= 2);           // measured 1.4
    CHECK(worst_height <= 3);    // measured 1.9
    CHECK(worst_bend <= 5e-15);  // rad; measured 2.6e-15, at 0.99 of the height
}

TEST_CASE("Jointed rod: (17)", "[finite][jointed]") {
    double worst = 0, worst_bend = 0;
    Random random(46);
    for (int i = 0; i < 200; ++i) {
        const double length = random.log_between(0.01, 100), pin = length * random.between(0.17, 0.49);
        const double joint = revchain::joint_without_bending(length, pin);
        const Quad CA = Quad(length) / 2 - pin;
        worst = std::max(worst, error_in_ulp(joint, CA * CA / pin));
        // Above D and below it, as links; the moment at D of what hangs below is what (14) makes 0
        const double below = length / 2 + pin - joint, above = length - below;
        const JointedLinks<double> links{
            below, {below / 2, below / std::sqrt(12.0)}, above, joint, pin - below / 2, above / std::sqrt(12.0)};
        const double whole = pin + length / (12 * pin) * length;
        for (const double share : {0.99, 0.7, 0.1}) {
            const double turned = std::acos(share);
            double least = 1;
            for (const auto& shape : revchain::jointed_links_shapes(links, share * whole))
                least = std::min(
                    least, std::max(std::abs(shape.inclination[0] - turned), std::abs(shape.inclination[1] - turned)));
            worst_bend = std::max(worst_bend, least);
        }
    }
    CAPTURE(worst, worst_bend);
    CHECK(worst <= 2.5);         // measured 1.6
    CHECK(worst_bend <= 5e-15);  // rad; measured 3.3e-15, at 0.99 of the height
}

TEST_CASE("Jointed links: wrong numbers", "[finite][jointed]") {
    using revchain::InvalidArgument;
    const JointedLinks<double> good{1, {1, 0.5}, 1, 1, 0.5, 0.5};
    const auto refused = [&](auto change) {
        auto bad = good;
        change(bad);
        CHECK_THROWS_AS(revchain::jointed_links(bad), InvalidArgument);
        CHECK_THROWS_AS(revchain::jointed_links_shapes(bad, 0.1), InvalidArgument);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refused([](auto& l) { l.lower_weight = 0; });
    refused([](auto& l) { l.lower.centroid = -1; });
    refused([](auto& l) { l.upper_weight = -1; });
    refused([](auto& l) { l.upper_length = 0; });
    refused([&](auto& l) { l.upper_centroid = nan; });
    refused([](auto& l) { l.upper_centroid = -1; });  // W2 h2 + W1 a2 = 0: it would not hang
    refused([](auto& l) { l.upper_radius_of_gyration = -0.1; });
    for (const double height : {0.0, -1.0, nan, 1e-200})
        CHECK_THROWS_AS(revchain::jointed_links_shapes(good, height), InvalidArgument);
    CHECK_THROWS_AS(revchain::pin_of_silent_clapper<double>(1, {0.5, 0.5}, 1, {1, 0.5}), InvalidArgument);
    CHECK_THROWS_AS(revchain::joint_without_bending(1.0, 0.16), InvalidArgument);
    CHECK_THROWS_AS(revchain::joint_without_bending(1.0, 0.5), InvalidArgument);
    CHECK_THROWS_AS(revchain::joint_without_bending(-1.0, 0.2), InvalidArgument);
}

TEST_CASE("jointed links too far apart are refused", "[finite]") {
    revchain::JointedLinks<double> links{1, {1, 0.5}, 1, 1, 0.5, 0.3};
    CHECK(std::isfinite(revchain::jointed_links(links)[0]));
    for (const double far : {1e-300, 1e-160, 1e160, 1e300}) {
        auto odd = links;
        odd.lower.centroid = far;
        CHECK_THROWS_AS(revchain::jointed_links(odd), revchain::InvalidArgument);
        odd = links;
        odd.upper_length = far;
        CHECK_THROWS_AS(revchain::jointed_links(odd), revchain::InvalidArgument);
        odd = links;
        odd.upper_weight = far;
        CHECK_THROWS_AS(revchain::jointed_links(odd), revchain::InvalidArgument);
    }
}
