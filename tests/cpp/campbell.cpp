// SPDX-License-Identifier: MPL-2.0
// Campbell diagrams against closed forms of one link, on the axis and on an arm, and against the energy of two plummets
// in a driven plane. Any rig in the free frame against Lagrange's equations in 60 digits: tests/python/test_campbell.py.
#include "revchain/campbell.hpp"

#include <algorithm>

#include "revchain/steady_shapes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/tier.hpp"

using Catch::Matchers::ContainsSubstring;
using revchain::Campbell;
using revchain::CampbellOptions;
using revchain::Chain;
using revchain::plummet;
using revchain::Rig;
using revchain::StabilityFrame;

namespace {

constexpr double g = 9.80665;

std::vector<double> speeds(double low, double high, int count) {
    std::vector<double> made;
    for (int i = 0; i < count; ++i) made.push_back(low * std::pow(high / low, i / (count - 1.0)));
    return made;
}

/// One plummet on a thread of length a, tied at b from the axis, at an inclination: the speed, and the squares of the
/// frequencies over it. In the plane: U''/(m a^2) = g cos/a - n^2 cos^2 + g sin^2/(a cos). Out of it the thread is a
/// pendulum of g/(a cos) - n^2, and Coriolis' force couples both by 2 n cos.
struct OneLink {
    long double a, b, inclination;
    long double sine() const { return std::sin(inclination); }
    long double cosine() const { return std::cos(inclination); }
    long double speed() const { return std::sqrt(g * sine() / cosine() / (b + a * sine())); }
    long double in() const { return g / (a * cosine() * speed() * speed()) - cosine() * cosine(); }
    long double out() const { return g / (a * cosine() * speed() * speed()) - 1; }
    std::vector<double> free() const {
        const long double sum = in() + out() + 4 * cosine() * cosine(), product = in() * out();
        const long double high = (sum + std::sqrt(sum * sum - 4 * product)) / 2;
        return {static_cast<double>(std::sqrt(product / high)), static_cast<double>(std::sqrt(high))};
    }
    /// At a multiple of the speed this is 0 in the free frame.
    long double off(int order) const {
        const long double square = order * order;
        return (in() - square) * (out() - square) - 4 * cosine() * cosine() * square;
    }
};

/// The inclination between two at which a function of the link changes its sign.
template <class F>
OneLink where(const OneLink& link, long double low, long double high, const F& value) {
    const bool sign = value(OneLink{link.a, link.b, low}) < 0;
    for (int i = 0; i < 80; ++i) {
        const long double middle = (low + high) / 2;
        ((value(OneLink{link.a, link.b, middle}) < 0) == sign ? low : high) = middle;
    }
    return {link.a, link.b, low};
}

}  // namespace

TEST_CASE("one link on the axis: n sqrt(1 + 3 cos^2) free, n sin driven", "[finite]") {
    const double a = 0.7;
    const Chain<double> chain({plummet(5.0, a)});
    const std::vector<double> n = speeds(std::sqrt(g / a) * 1.05, 30.0, 7);
    for (const auto frame : {StabilityFrame::free, StabilityFrame::driven}) {
        const Campbell found = revchain::campbell(chain, {.angular_speed = n, .frame = frame});
        REQUIRE((found.frequency.rows() == 7 && found.frequency.cols() == 1));
        for (int i = 0; i < 7; ++i) {
            const double speed = n[static_cast<std::size_t>(i)], c = g / (a * speed * speed);
            const double ratio = frame == StabilityFrame::free ? std::sqrt(1 + 3 * c * c) : std::sqrt(1 - c * c);
            CHECK(std::abs(found.frequency(i, 0) / speed - ratio) <= 2e-14);
        }
        CHECK(found.crossings.empty());  // between 1n and 2n, and below 1n
        CHECK(std::count(found.stable.begin(), found.stable.end(), true) == 7);
    }
}

TEST_CASE("below the critical speed there is no shape", "[finite]") {
    const Campbell found = revchain::campbell(Chain<double>({plummet(1.0, 1.0)}), {.angular_speed = {1.0, 3.0, 6.0}});
    CHECK((std::isnan(found.frequency(0, 0)) && std::isnan(found.frequency(1, 0)) && found.frequency(2, 0) > 6));
    CHECK(found.stable == std::vector<bool>{false, false, true});
}

TEST_CASE("one link on an arm: the closed quartic", "[finite][rig]") {
    support::Random random(71);
    int crossings = 0;
    for (int i = 0; i < support::by_tier(20, 500); ++i) {
        const double a = random.log_between(0.1, 30), b = a * random.log_between(0.05, 10);
        const double w = random.log_between(1e-3, 1e4);
        const Rig rig(Chain<double>({plummet(w, a)}), {.support = revchain::carried_round(b)});
        const OneLink link{a, b, 0};
        std::vector<double> n;
        std::vector<OneLink> at;
        for (long double d = 0.1L; d < 1.4L; d += 0.1L) {
            at.push_back({a, b, d});
            n.push_back(static_cast<double>(at.back().speed()));
        }
        const Campbell found = revchain::campbell(rig, {.angular_speed = n, .orders = {1, 2, 3}});
        REQUIRE(found.frequency.cols() == 2);
        for (std::size_t k = 0; k < n.size(); ++k) {
            const std::vector<double> exact = at[k].free();
            for (int j = 0; j < 2; ++j)
                CHECK(std::abs(found.frequency(static_cast<int>(k), j) / n[k] - exact[static_cast<std::size_t>(j)]) <=
                      1e-13 * exact[1]);
        }
        std::size_t next = 0;
        for (const int order : {1, 2, 3})
            for (std::size_t k = 0; k + 1 < n.size(); ++k) {
                const auto off = [&](const OneLink& one) { return one.off(order); };
                if ((off(at[k]) < 0) == (off(at[k + 1]) < 0)) continue;  // one frequency crosses, the other does not
                const OneLink exact = where(link, at[k].inclination, at[k + 1].inclination, off);
                REQUIRE(next < found.crossings.size());
                CHECK(found.crossings[next].order == order);
                CHECK(std::abs(found.crossings[next].angular_speed / static_cast<double>(exact.speed()) - 1) <= 1e-12);
                const double ratio = exact.free()[static_cast<std::size_t>(found.crossings[next].motion - 1)];
                CHECK(std::abs(ratio / order - 1) <= 1e-12);
                ++next, ++crossings;
            }
        CHECK(next == found.crossings.size());
    }
    CHECK(crossings >= support::by_tier(20, 500));
}

TEST_CASE("two plummets on an arm in a driven plane: the second derivatives of the energy", "[finite][rig]") {
    using R = long double;
    support::Random random(72);
    int crossings = 0;
    for (int i = 0; i < support::by_tier(10, 200); ++i) {
        const double a0 = random.log_between(0.2, 5), a1 = random.log_between(0.2, 5);
        const double w0 = random.log_between(0.1, 10), w1 = random.log_between(0.1, 10), b = random.log_between(0.5, 5);
        const Rig rig(Chain<double>({plummet(w0, a0), plummet(w1, a1)}), {.support = revchain::carried_round(b)});
        const double unit = std::sqrt(g / (a0 + a1 + b));
        const Campbell found = revchain::campbell(
            rig,
            {.angular_speed = speeds(0.2 * unit, 3 * unit, 9), .orders = {1, 2, 3}, .frame = StabilityFrame::driven});
        for (const auto& one : found.crossings) {
            const R height = g / (R(one.angular_speed) * one.angular_speed);
            double farthest = -1;
            R d0 = 0, d1 = 0;
            for (const auto& shape : revchain::steady_shapes(rig, {.angular_speed = one.angular_speed}).shapes)
                if (shape.half_waves == 1 && shape.offset[0] > farthest)
                    farthest = shape.offset[0], d0 = shape.inclination[0], d1 = shape.inclination[1];
            R u00 = 0, u01 = 0, u11 = 0;
            for (int step = 0; step < 3; ++step) {  // the last one only evaluates
                const R s0 = std::sin(d0), c0 = std::cos(d0), s1 = std::sin(d1), c1 = std::cos(d1);
                const R x1 = b + a1 * s1, x0 = x1 + a0 * s0;
                const R off0 = w0 * a0 * (s0 - x0 * c0 / height);
                const R off1 = (w0 + w1) * a1 * s1 - (w1 * x1 + w0 * x0) * a1 * c1 / height;
                u00 = w0 * a0 * c0 - w0 / height * (a0 * a0 * c0 * c0 - x0 * a0 * s0);
                u01 = -w0 / height * a0 * c0 * a1 * c1;
                u11 = (w0 + w1) * a1 * c1 - ((w0 + w1) * a1 * a1 * c1 * c1 - (w1 * x1 + w0 * x0) * a1 * s1) / height;
                const R det = u00 * u11 - u01 * u01;
                if (step == 2) break;
                d0 -= (u11 * off0 - u01 * off1) / det, d1 -= (u00 * off1 - u01 * off0) / det;
            }
            const R m00 = w0 * a0 * a0 / height, m11 = (w0 + w1) * a1 * a1 / height;
            const R m01 = w0 * a0 * a1 * std::cos(d1 - d0) / height;
            // det (U - r M) = 0
            const R p = m00 * m11 - m01 * m01, q = u00 * m11 + u11 * m00 - 2 * u01 * m01, r = u00 * u11 - u01 * u01;
            const R high = (q + std::sqrt(q * q - 4 * p * r)) / (2 * p), low = r / (p * high);
            std::vector<R> ratios;
            for (const R square : {low, high})
                if (square > 0) ratios.push_back(std::sqrt(square));
            REQUIRE(static_cast<std::size_t>(one.motion) <= ratios.size());
            CHECK(std::abs(ratios[static_cast<std::size_t>(one.motion - 1)] / one.order - 1) <= 1e-11L);
            ++crossings;
        }
    }
    CHECK(crossings >= support::by_tier(15, 300));
}

TEST_CASE("a frequency that jumps at the limit speed of a mast meets no multiple there", "[finite][rig]") {
    // Below sqrt(stiffness / moving mass) the link hangs outwards, above it inwards.
    const Rig rig(Chain<double>({plummet(g, 1.0)}),
                  {.support = {.stiffness = 200.0, .carriage_weight = 2 * g, .radius = 3.0}});
    const double limit = std::sqrt(200.0 / 3);
    const std::vector<double> n{2, 3, 4, 5, 6, 7, 8, 8.1, 8.2, 8.3, 9, 10, 11, 12};
    const Campbell found =
        revchain::campbell(rig, {.angular_speed = n, .orders = {1, 2, 3}, .frame = StabilityFrame::driven});
    CHECK((found.frequency(7, 0) < 8.1 && found.frequency(8, 0) > 3 * 8.2));  // all three signs change
    CHECK(found.crossings.size() == 6);
    for (const auto& one : found.crossings) {
        CHECK(std::abs(one.angular_speed - limit) > 1);
        const double next = one.angular_speed * (1 + 1e-9);
        const Campbell at =
            revchain::campbell(rig, {.angular_speed = {one.angular_speed, next}, .frame = StabilityFrame::driven});
        const double multiple = static_cast<double>(one.order) * one.angular_speed;
        CHECK(std::abs(at.frequency(0, one.motion - 1) / multiple - 1) <= 1e-12);
    }
}

TEST_CASE("what campbell refuses", "[finite]") {
    const Chain<double> chain({plummet(1.0, 1.0)});
    const auto refused = [&](const CampbellOptions& options, const char* words) {
        CHECK_THROWS_WITH(revchain::campbell(chain, options), ContainsSubstring(words));
        CHECK_THROWS_AS(revchain::campbell(Rig(chain, {}), options), revchain::InvalidArgument);
    };
    refused({.angular_speed = {5.0}}, "campbell: angular_speed must have at least two speeds, got 1");
    refused({.angular_speed = {5.0, 5.0}}, "angular_speed must be ascending, got 5");
    refused({.angular_speed = {-5.0, 5.0}}, "angular_speed must be positive and finite, got -5");
    refused({.angular_speed = {5.0, 6.0}, .orders = {}}, "orders must have at least one number");
    refused({.angular_speed = {5.0, 6.0}, .orders = {1, 0}}, "orders must be at least 1, got 0");
    refused({.angular_speed = {5.0, 6.0}, .half_waves = 0}, "half_waves must be at least 1, got 0");
    refused({.angular_speed = {5.0, 6.0}, .half_waves = 2},
            "at none of the speeds, 5 to 6 rad/s, is there a shape with this number of half_waves");
    refused({.angular_speed = {5.0, 6.0}, .gravity = 0}, "gravity must be positive");
}
