// SPDX-License-Identifier: MPL-2.0
#include "revchain/bell.hpp"

#include "revchain/modes.hpp"
#include "revchain/two_links.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/ringing.hpp"
#include "support/tier.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using support::Quad;

namespace {

using Numbers = std::array<Quad, 7>;  // by BellDatum

/// The slower mode's ratio of inclinations in quadruple precision, from Lagrange's equations in the two angles.
Quad ratio(const Numbers& x) {
    const auto& [W1, h1, k1, W2, a2, h2, k2] = x;
    // inertia [W1 (h1^2 + k1^2), W1 h1 a2; ., W2 (h2^2 + k2^2) + W1 a2^2], moments W1 h1, W2 h2 + W1 a2
    const Quad A = W1 * (h1 * h1 + k1 * k1), B = W1 * h1 * a2, C = W2 * (h2 * h2 + k2 * k2) + W1 * a2 * a2;
    const Quad p = W1 * h1, q = W2 * h2 + W1 * a2;
    const Quad half = (A / p + C / q) / 2, rest = (A * C - B * B) / (p * q);
    const Quad lambda = half + sqrtq(half * half - rest);
    return B / (lambda * p - A);
}

Chain<double> chain_of(const Numbers& x) {
    const auto d = [&](std::size_t i) { return static_cast<double>(x[i]); };
    return Chain<double>({revchain::compound_pendulum<double>(
                              {.weight = d(0), .length = 1, .centroid = d(1), .radius_of_gyration = d(2)}),
                          revchain::compound_pendulum<double>(
                              {.weight = d(3), .length = d(4), .centroid = d(5), .radius_of_gyration = d(6)})});
}

std::vector<Numbers> bells() {
    support::Random random(23);
    std::vector<Numbers> all;
    while (all.size() < 300) {
        const double W2 = random.log_between(1, 1e3), W1 = random.log_between(0.1, 100),
                     a2 = random.log_between(0.05, 1);
        const double h2 = random.between(-0.3, 0.6);
        if (W2 * h2 + W1 * a2 < 1e-3 * W2 || h2 == 0) continue;
        all.push_back({W1, random.between(0.1, 1), random.between(0.01, 0.5), W2, a2, h2, random.between(0.05, 1)});
    }
    return all;
}

}  // namespace

TEST_CASE("ratios of inclinations and their derivatives, against quadruple precision", "[linear]") {
    double worst = 0, worst_height = 0, worst_derivative = 0;
    for (const Numbers& x : bells()) {
        const auto chain = chain_of(x);
        const auto found = revchain::bell_and_clapper(chain);
        const auto m = revchain::modes(chain, {.count = revchain::all_modes});
        const Quad exact = ratio(x);
        const auto off = [](double y, Quad t) { return static_cast<double>(fabsq((y - t) / t)) / 0x1p-52; };
        worst = std::max(worst, off(found.inclination_ratio[0], exact));
        for (std::size_t j = 0; j < 2; ++j)
            worst_height =
                std::max(worst_height, off(found.conical_height[j], m.conical_height[static_cast<Index>(j)]));
        CHECK(found.inclination_ratio[1] < 0);
        double largest = 0;
        std::array<double, 7> errors;
        for (std::size_t d = 0; d < 7; ++d) {
            const Quad step = Quad(1e-10) * fabsq(x[d]);
            Numbers up = x, down = x;
            up[d] += step, down[d] -= step;
            const Quad derivative = (ratio(up) - ratio(down)) / (2 * step);
            errors[d] = static_cast<double>(fabsq((found.derivative[d] - derivative) * x[d]));
            largest = std::max(largest, static_cast<double>(fabsq(derivative * x[d])));
            CHECK(off(found.present[d], x[d] == 0 ? Quad(1) : x[d]) <= 2);
        }
        for (const double error : errors) worst_derivative = std::max(worst_derivative, error / largest);
    }
    CAPTURE(worst, worst_height, worst_derivative);
    CHECK(worst <= 1);
    CHECK(worst_height <= 2);
    CHECK(worst_derivative <= 1e-15);
}

TEST_CASE("the values that give a ratio do, and those that make one piece are the paper's", "[linear]") {
    int given = 0;
    for (const Numbers& x : bells())
        for (const double wanted : {1.0, 0.8, 1.3}) {
            const auto chain = chain_of(x);
            const auto values = revchain::bell_and_clapper_with_ratio(chain, wanted);
            for (std::size_t d = 0; d < 7; ++d) {
                if (std::isnan(values[d])) continue;
                ++given;
                Numbers changed = x;
                changed[d] = values[d];
                if (d == 2 || d == 6) changed[d] = fabsq(changed[d]);
                CAPTURE(d, wanted, values[d]);
                const auto again = revchain::bell_and_clapper(chain_of(changed));
                const double slack = 4e-16 * (1 + std::abs(again.derivative[d] * values[d]));
                CHECK(std::abs(again.inclination_ratio[0] - wanted) <= slack);
                if (wanted == 1) {
                    const auto& [W1, h1, k1, W2, a2, h2, k2] = changed;  // the sum of the sizes of its terms
                    const Quad f = W2 / W1, l1 = h1 + k1 * k1 / h1;
                    const Quad size = h1 + (f * fabsq(h2) / a2 + 1) * l1 + f * (fabsq(h2) + (h2 * h2 + k2 * k2) / a2);
                    CHECK(std::abs(again.mismatch) <= 4e-16 * static_cast<double>(size));
                    CHECK(std::abs(again.conical_height[0] / again.silent_height - 1) <= slack);
                }
            }
            // the joint is the one of pin_of_silent_clapper, where that knows one
            if (wanted == 1 && x[5] > 0 && std::isfinite(values[4])) {
                const auto d = [&](std::size_t i) { return static_cast<double>(x[i]); };
                const revchain::CompoundLink<double> bell{d(5), d(6)}, clapper{d(1), d(2)};
                CHECK(std::abs(values[4] / revchain::pin_of_silent_clapper(d(3), bell, d(0), clapper) - 1) < 1e-13);
            }
        }
    CHECK(given > 1000);
}

TEST_CASE("a silent bell is the clamped one", "[linear]") {
    const Numbers x{18, 0.52, 0.08, 500, 0.15, 0.2, 0.30};
    auto silent = x;
    silent[5] = revchain::bell_and_clapper_with_ratio(chain_of(x), 1.0)[5];
    CHECK(std::abs(static_cast<double>(silent[5]) - 0.177) < 0.05);  // examples/python/engineering/silent_bell.py
    const auto found = revchain::bell_and_clapper(chain_of(silent));
    CHECK(std::abs(found.inclination_ratio[0] - 1) < 1e-14);
    CHECK(std::abs(found.mismatch) < 1e-15);
}

TEST_CASE("what is no bell and clapper is refused", "[linear]") {
    CHECK_THROWS_AS(revchain::bell_and_clapper(Chain<double>::uniform_rods(3)), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::bell_and_clapper_with_ratio(Chain<double>::uniform_rods(2), 0.0),
                    revchain::InvalidArgument);
    const Chain<double> thread({revchain::plummet(1.0, 1.0), revchain::plummet(0.0, 1.0)});
    CHECK_THROWS_AS(revchain::bell_and_clapper(thread), revchain::InvalidArgument);
    // far joints: a right answer or a refusal
    const auto at = [&](double joint) { return revchain::bell_and_clapper(Chain<double>::uniform_rods(2), joint); };
    for (const double sign : {1.0, -1.0}) {
        CHECK(std::abs(at(sign * 1e-100).conical_height[0] / at(0).conical_height[0] - 1) < 1e-15);
        for (const double far : {1e-103, 1e-200, 1e104, 1e200})
            CHECK_THROWS_WITH(at(sign * far), Catch::Matchers::Contains("joint must be 0, or not more than 2^341"));
        CHECK_THROWS_WITH(at(sign * std::numeric_limits<double>::infinity()), Catch::Matchers::Contains("joint"));
    }
    CHECK(at(1e100).conical_height[0] == 1e100);
    CHECK_THROWS_WITH(at(std::numeric_limits<double>::quiet_NaN()), Catch::Matchers::Contains("joint"));
}

TEST_CASE("a clapper pinned in the axle or above it", "[public]") {
    // 500 kg, 18 kg; the pin 3 cm above the axle, g = 9.81
    const Chain<double> chain({revchain::compound_pendulum<double>(
                                   {.weight = 18, .length = 0.65, .centroid = 0.52, .radius_of_gyration = 0.08}),
                               revchain::compound_pendulum<double>(
                                   {.weight = 500, .length = 0.15, .centroid = 0.2, .radius_of_gyration = 0.3})});
    const auto above = revchain::bell_and_clapper(chain, -0.03);
    CHECK(std::abs(std::sqrt(9.81 / above.conical_height[1]) - 3.87184) <= 5e-6);
    CHECK(std::abs(std::sqrt(9.81 / above.conical_height[0]) - 4.29572) <= 5e-6);
    CHECK(above.inclination_ratio[0] > 0);
    CHECK(above.inclination_ratio[1] < 0);
    // W2 (h2^2 + rho2^2) + W1 a^2, W1 h1 a, W1 h1 l1 against W2 h2 + W1 a, W1 h1
    for (const double a : {-0.4, -0.03, -1e-7, 0.0, 1e-7, 0.15}) {
        const auto found = revchain::bell_and_clapper<double>(chain, a);
        const double M11 = 500 * (0.04 + 0.09) + 18 * a * a, M12 = 18 * 0.52 * a, M22 = 18 * (0.52 * 0.52 + 0.0064);
        for (std::size_t k = 0; k < 2; ++k) {
            const double x = found.conical_height[k], r = found.inclination_ratio[k];
            const double off = (x * (500 * 0.2 + 18 * a) - M11) * (x * 18 * 0.52 - M22) - M12 * M12;
            CAPTURE(a, k, x, r);
            CHECK(std::abs(off) <= 1e-13 * M11 * M22);
            if (a != 0)
                CHECK(std::abs(x * 18 * 0.52 * r - M12 - M22 * r) <= 1e-12 * (std::abs(M12) + std::abs(M22 * r)));
        }
        if (a == 0) continue;
        for (const double ratio : {0.7, 1.0, 1.8}) {  // the data that give it do
            const auto values = revchain::bell_and_clapper_with_ratio<double>(chain, ratio, a);
            if (!std::isnan(values[4])) {
                CHECK(values[4] * a > 0);
                CHECK(std::abs(revchain::bell_and_clapper<double>(chain, values[4]).inclination_ratio[0] - ratio) <=
                      1e-9);
            }
        }
        // derivative by the joint
        const double step = 1e-6 * std::abs(a);
        const double up = revchain::bell_and_clapper<double>(chain, a + step).inclination_ratio[0],
                     down = revchain::bell_and_clapper<double>(chain, a - step).inclination_ratio[0];
        CHECK(std::abs((up - down) / (2 * step) / found.derivative[4] - 1) <= 1e-5);
    }
    CHECK_THROWS_AS(revchain::bell_and_clapper_with_ratio<double>(chain, 1.0, 0.0), revchain::InvalidArgument);
}

namespace {

/// First ratio and both heights of bells any body of which may stand, from Lagrange's equations in quadruple precision:
/// (lambda s2 q - C)(lambda s1 p - A) = B^2, ratio s1 s2 B/(lambda s1 p - A).
std::array<Quad, 3> standing_ratio(const Numbers& x, const std::array<bool, 2>& inverted) {
    const auto& [W1, h1, k1, W2, a2, h2, k2] = x;
    const Quad s1 = inverted[0] ? -1 : 1, s2 = inverted[1] ? -1 : 1;
    const Quad A = W1 * (h1 * h1 + k1 * k1), B = s1 * s2 * W1 * h1 * a2, C = W2 * (h2 * h2 + k2 * k2) + W1 * a2 * a2;
    const Quad p = s1 * W1 * h1, q = s2 * (W2 * h2 + W1 * a2);
    const Quad half = (A / p + C / q) / 2, root = sqrtq(half * half - (A * C - B * B) / (p * q));
    Quad first = half + root, other = half - root;
    const auto ratio = [&](Quad lambda) { return B / (lambda * p - A); };
    if (p * q < 0 ? first < 0 : ratio(first) < 0) std::swap(first, other);
    return {ratio(first), first, other};
}

}  // namespace

TEST_CASE("bells and clappers that stand on their pins", "[linear]") {
    support::Random random(1908);
    double worst = 0, worst_derivative = 0, worst_given = 0;
    int given = 0, falling = 0;
    for (int i = 0; i < support::by_tier(300, 10'000); ++i) {
        const double a = random.log_between(0.01, 1) * (random.between(0, 1) < 0.5 ? 1 : -1);
        const Numbers x{random.log_between(0.1, 100),
                        random.between(0.1, 1),
                        random.between(0.01, 0.5),
                        random.log_between(1, 1e3),
                        a,
                        random.between(0.02, 0.6),
                        random.between(0.05, 1)};
        const std::array<bool, 2> inverted{random.between(0, 1) < 0.5, random.between(0, 1) < 0.5};
        const auto numbers = [&](const Numbers& y, const std::optional<double>& ratio = {}) {
            Numbers z = y;
            z[4] = 1;  // the length of the bell is not used
            z[5] = fabsq(z[5]);
            const auto chain = chain_of(z);
            const double joint = static_cast<double>(y[4]);
            return std::pair(revchain::bell_and_clapper<double>(chain, joint, inverted),
                             ratio ? revchain::bell_and_clapper_with_ratio<double>(chain, *ratio, joint, inverted)
                                   : revchain::ByBellDatum<double>{});
        };
        const auto exact = standing_ratio(x, inverted);
        const Quad moment = x[3] * x[5] + x[0] * x[4];
        if (fabsq(moment) < 1e-3 * x[3] * x[5]) continue;
        const auto found = numbers(x).first;
        const auto off = [](double y, Quad t) { return static_cast<double>(fabsq((y - t) / t)); };
        CAPTURE(i, inverted, a, static_cast<double>(moment));
        CHECK(found.inverted == inverted);
        worst = std::max({worst, off(found.inclination_ratio[0], exact[0]), off(found.conical_height[0], exact[1]),
                          off(found.conical_height[1], exact[2])});
        falling += exact[1] > 0 && exact[2] < 0;
        double largest = 0, error = 0;
        for (std::size_t d = 0; d < 7; ++d) {
            const Quad step = Quad(1e-10) * fabsq(x[d]);
            Numbers up = x, down = x;
            up[d] += step, down[d] -= step;
            const Quad slope = (standing_ratio(up, inverted)[0] - standing_ratio(down, inverted)[0]) / (2 * step);
            largest = std::max(largest, static_cast<double>(fabsq(slope * x[d])));
            error = std::max(error, static_cast<double>(fabsq((found.derivative[d] - slope) * x[d])));
        }
        worst_derivative = std::max(worst_derivative, error / largest);
        for (const double wanted : {0.6, 1.0, 2.5}) {
            const auto values = numbers(x, wanted).second;
            for (std::size_t d = 0; d < 7; ++d) {
                if (std::isnan(values[d]) || (d == 5 && values[d] < 0)) continue;
                ++given;
                Numbers changed = x;
                changed[d] = values[d];
                const Quad again = standing_ratio(changed, inverted)[0];
                const double slack = 1e-15 * (1 + std::abs(numbers(changed).first.derivative[d] * values[d]));
                CAPTURE(d, wanted, values[d], static_cast<double>(again));
                CHECK(fabsq(again - wanted) <= slack);
                worst_given = std::max(worst_given, static_cast<double>(fabsq(again - wanted)) / slack);
            }
        }
    }
    CAPTURE(worst, worst_derivative, worst_given, given, falling);
    CHECK(worst <= 4.5e-16);
    CHECK(worst_derivative <= 1e-15);
    CHECK(given > 500);
    CHECK(falling > 50);
}

TEST_CASE("a silent bell with its centroid above the axle", "[public]") {
    // The pin of the clapper is 60 cm below the axle; the other data are chosen one at a time for a ratio of 1.
    const Numbers x{18, 0.52, 0.08, 100, 0.15, 0.05, 0.30};
    const std::array<bool, 2> bell_stands{false, true};
    const auto values = revchain::bell_and_clapper_with_ratio<double>(chain_of(x), 1.0, -0.6, bell_stands);
    int silent = 0;
    for (const std::size_t d : {0, 1, 2, 3, 5, 6}) {
        if (!(values[d] > 0)) continue;
        Numbers changed = x;
        changed[d] = values[d];
        const auto found = revchain::bell_and_clapper<double>(chain_of(changed), -0.6, bell_stands);
        CAPTURE(d, values[d], found.mismatch, found.silent_height, found.conical_height);
        CHECK(std::abs(found.mismatch) <= 1e-13);
        CHECK(std::abs(found.inclination_ratio[0] - 1) <= 1e-13);
        CHECK(std::abs(found.conical_height[0] / found.silent_height - 1) <= 1e-13);
        ++silent;
    }
    CHECK(silent >= 2);
}

namespace {

/// Random bells of every kind against Hamilton's equations in long double.
void check_first_blows(int many) {
    support::Random random(1887);
    double worst = 0, beyond = 0;
    int struck = 0, turned = 0, unsure = 0, wide = 0;
    for (int i = 0; i < many; ++i) {
        const auto chance = [&] { return random.between(0, 1); };
        revchain::BellAndClapper<double> bell{};
        bell.present = {1,
                        random.between(0.1, 1),
                        random.between(0.01, 0.5),
                        random.log_between(0.1, 1e3),
                        random.between(-0.6, 0.6),
                        random.between(0.02, 0.6),
                        random.between(0.05, 1)};
        bell.inverted = {chance() < 0.5, chance() < 0.5};
        const bool opposite = bell.inverted[0] != bell.inverted[1], circle = !opposite && chance() < 0.3;
        const double c = random.between(0.1, 0.7), kind = chance();
        revchain::StrikeStart start{.clearance = c, .gravity = 1};
        const double angle = random.between(0, 3.141592653589793);
        if (!circle) start.amplitude = angle;
        if (kind < 0.4) start.clapper_angle = chance() < 0.5 ? c : -c;
        if (kind > 0.8 && !circle) start.clapper_angle = c * random.between(-1, 1);
        // where the clapper starts in the bell, in the sense of the bell's angle
        const double hangs = std::clamp((opposite ? std::numbers::pi : 0.0) - angle, -c, c);
        const double given = start.clapper_angle.value_or(0);
        const double at = start.clapper_angle ? (opposite ? given : -given) : circle ? c : hangs;

        const auto found = revchain::first_strike(bell, start);
        const auto truth = support::RingingTruth(bell.present, opposite, c).first_blow(angle, at, circle);
        CAPTURE(i, bell.present, bell.inverted, c, circle, angle, at, found.error_estimate, truth.status);
        if (std::isinf(found.error_estimate) || truth.closest < 1e-12L) {
            ++unsure;
            continue;
        }
        REQUIRE(revchain::strike_status_names[static_cast<std::size_t>(found.status)] == truth.status);
        turned += truth.status == "turns";
        if (truth.status != "strikes") continue;
        ++struck;
        CHECK(found.leading == (truth.side * truth.way > 0));
        const auto off = [](double x, long double y, long double size) {
            return static_cast<double>(std::abs((static_cast<long double>(x) - y) / size));
        };
        // over the top it falls on the other side
        const auto past_lowest = truth.bell > std::numbers::pi ? truth.bell - 2 * std::numbers::pi : truth.bell;
        const double error = std::max({off(found.bell_angle, truth.way * past_lowest, 1),
                                       off(found.relative_speed, truth.way * truth.speed, truth.speed),
                                       off(found.time, truth.time, truth.time)});
        worst = std::max(worst, error), beyond = std::max(beyond, error / found.error_estimate);
        CHECK(error <= found.error_estimate);
        wide += found.error_estimate > 1e-11;
    }
    CAPTURE(worst, beyond, struck, turned, unsure, wide);
    CHECK(wide <= 2 + many / 100);
    CHECK(struck > many / 2);
    CHECK(turned > many / 10);
    CHECK(unsure <= many / 500);
}

}  // namespace

TEST_CASE("first blows against Hamilton's equations", "[public]") { check_first_blows(support::by_tier(200, 600)); }
TEST_CASE("10,000 random bells", "[.slow]") { check_first_blows(10'000); }

TEST_CASE("first blows of mirror images", "[public]") {
    const auto bell = revchain::bell_and_clapper(
        revchain::Chain<double>({revchain::compound_pendulum<double>(
                                     {.weight = 18, .length = 0.65, .centroid = 0.52, .radius_of_gyration = 0.08}),
                                 revchain::compound_pendulum<double>(
                                     {.weight = 500, .length = 0.15, .centroid = 0.2, .radius_of_gyration = 0.3})}));
    const double clearance = 27 * std::numbers::pi / 180;
    for (const double part : {1.0, 0.5, 0.1}) {
        const auto one = revchain::first_strike(
            bell, {.clearance = clearance, .amplitude = std::numbers::pi, .clapper_angle = part * clearance});
        const auto other = revchain::first_strike(
            bell, {.clearance = clearance, .amplitude = std::numbers::pi, .clapper_angle = -part * clearance});
        CAPTURE(part, one.bell_angle, other.bell_angle);
        REQUIRE(one.status == other.status);
        CHECK(one.leading == other.leading);
        CHECK(std::abs(one.bell_angle - other.bell_angle) < 1e-11);
        CHECK(std::abs(one.relative_speed / other.relative_speed - 1) < 1e-11);
        CHECK(std::abs(one.bell_angle) < std::numbers::pi);
    }
}
