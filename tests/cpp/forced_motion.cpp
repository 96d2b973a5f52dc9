// SPDX-License-Identifier: MPL-2.0
// Forced motion of rigs with springs, dashpots and trolleys against dense complex equations in quadruple precision, in which
// the support's offset is one more coordinate; and against `response` where both apply.
#include "revchain/forced_motion.hpp"

#include "revchain/response.hpp"
#include "support/catch.hpp"
#include "support/damped_truth.hpp"

using namespace revchain;
using support::Quad;
using support::quad;
using support::random_rig;
using support::Z;

namespace {

enum class By { radius, acceleration, force };

/// Offsets of all pins, free end first, for a unit radius or force.
std::vector<Z> exact_offsets(const Rig& rig, double gravity, double n, By by, double amount) {
    const support::DampedTruth truth(rig, gravity, true);
    const Support& support = rig.support();
    const std::size_t links = truth.links;
    const Z s{0, n};
    const Quad radius = by == By::radius         ? Quad(amount)
                        : by == By::acceleration ? -Quad(amount) / Quad(n) / Quad(n)
                                                 : Quad(0);
    const bool itself = by != By::force && (support.is_firm() || support.is_free());
    const std::size_t unknowns = links + (itself ? 0 : 1);
    std::vector<std::vector<Z>> Q(unknowns, std::vector<Z>(unknowns + 1));
    for (std::size_t k = 0; k < unknowns; ++k) {
        for (std::size_t l = 0; l < unknowns; ++l) Q[k][l] = truth.at(s, k, l);
        if (itself) Q[k][unknowns] = Z{0, 0} - truth.at(s, k, links) * Z{radius, 0};
    }
    if (!itself) Q[links][unknowns] = {by == By::force ? Quad(amount) : quad(support.stiffness) * radius, 0};
    support::reduce(Q);
    std::vector<Z> offset(links + 1);
    offset[links] = itself ? Z{radius, 0} : Q[links][unknowns] / Q[links][links];
    for (std::size_t m = links; m-- > 0;)
        offset[m] = offset[m + 1] + Z{truth.lever(rig, m), 0} * (Q[m][unknowns] / Q[m][m]);
    return offset;
}

struct Checked {
    Index rows = 0, poor = 0;
    double worst = 0;  ///< error over the largest offset
};
Checked check(Index count, std::uint64_t seed, const support::DampedOptions& options) {
    support::Random random(seed);
    Checked result;
    for (Index k = 0; k < count; ++k) {
        const Rig rig = random_rig(random, options);
        const double own = std::sqrt(9.81 / rig.chain().total_length());
        const By by = rig.support().is_firm()
                          ? (random() < 0.5 ? By::radius : By::acceleration)
                          : std::array{By::radius, By::acceleration, By::force}[std::size_t(random() * 2.99)];
        const double sense = options.momentum && random() < 0.5 ? -1 : 1, n = sense * own * random.log_between(0.1, 30);
        const double amount = random.between(0.5, 2);
        ForcedMotionOptions with{.angular_speed = {n}, .gravity = 9.81};
        (by == By::radius ? with.radius : by == By::acceleration ? with.acceleration : with.force) = amount;
        const ForcedMotion found = forced_motion(rig, with);
        const std::vector<Z> exact = exact_offsets(rig, 9.81, n, by, amount);
        Quad largest = 0, off = 0;
        for (const Z& y : exact) largest = std::max(largest, size_of(y));
        for (std::size_t m = 0; m < exact.size(); ++m) {
            const std::complex<double> y = found.offset(0, static_cast<Index>(m));
            off = std::max(off, size_of(exact[m] - Z{y.real(), y.imag()}) / largest);
        }
        CAPTURE(k, rig.size(), n, int(by), static_cast<double>(off), found.error_estimate[0]);
        REQUIRE(found.resonant[0] == 0);
        result.worst = std::max(result.worst, static_cast<double>(off));
        ++result.rows, result.poor += off > 10 * Quad(found.error_estimate[0]) ? 1 : 0;
        REQUIRE(found.error_estimate[0] <= 1e-10);
    }
    return result;
}

}  // namespace

TEST_CASE("random rigs driven by radius, acceleration and force: offsets to the last digit", "[linear]") {
    for (const Checked& each : {check(400, 1, {}), check(200, 2, {.momentum = true}), check(200, 3, {.stands = true}),
                                check(100, 4, {.extreme = true, .most = 6}), check(300, 5, {.drag = true})}) {
        CHECK(each.poor == 0);
        CHECK(each.worst <= 1.6e-16);  // half an ulp of the real and of the imaginary part
    }
}

TEST_CASE("10,000 random rigs driven", "[.slow]") {
    for (const Checked& each :
         {check(5000, 11, {}), check(2000, 12, {.momentum = true}), check(2000, 13, {.stands = true}),
          check(1000, 14, {.extreme = true, .most = 6}), check(5000, 15, {.drag = true})}) {
        WARN(each.rows << " rigs, " << each.poor << " estimates below a tenth of the error, largest error "
                       << each.worst);
        CHECK(each.poor * 100 <= each.rows);
        CHECK(each.worst <= 1.6e-16);
    }
}

TEST_CASE("without springs and dashpots the offsets are those of `response`", "[linear]") {
    const Chain<double> chain({plummet(3.0, 1.0), uniform_rod(2.0, 0.5), plummet(1.0, 0.7)});
    std::vector<double> speeds;
    for (int i = 1; i < 40; ++i) speeds.push_back(0.37 * i);
    for (const Support& support : {Support{}, Support{40.0, 2.0, 0}}) {
        const Rig rig(chain, {.support = support});
        const auto known = response(rig, {.angular_speed = speeds, .support_radius = 0.01});
        const auto found = forced_motion(rig, {.angular_speed = speeds, .radius = 0.01});
        for (Index i = 0; i < known.offset.rows(); ++i) {
            CHECK((known.offset.row(i) - found.offset.row(i).real()).cwiseAbs().maxCoeff() <=
                  1.2e-16 * known.offset.row(i).cwiseAbs().maxCoeff());
            CHECK(found.offset.row(i).imag().cwiseAbs().maxCoeff() == 0);
            CHECK(known.modes_below[i] == found.modes_below[i]);
            CHECK(std::abs(known.support_force[i] - found.support_force[i]) <=
                  1e-13 * std::abs(known.support_force[i]));
        }
    }
}

TEST_CASE("a trolley on a spring, pushed at the spring's own speed, stands where the load balances the push",
          "[linear]") {
    const double k = 4 * M_PI * M_PI, g = 9.81;  // 10 kg on k N/m, 1 kg on 2 m
    const Rig rig(Chain<double>({plummet(g, 2.0)}), {.support = horizontal_spring(k, 10 * g)});
    const auto found = forced_motion(rig, {.angular_speed = {std::sqrt(k / 10)}, .force = 1, .gravity = g});
    CHECK(std::abs(found.offset(0, 1).real() + 0.04942936) <= 5e-9);
    CHECK(std::abs(found.offset(0, 0).real() + 0.25330296) <= 5e-9);
    CHECK(std::abs(found.support_force[0] + 1.0) <= 1e-13);
}

TEST_CASE("at the speed of the load alone the load balances the drive: the support stands", "[linear]") {
    for (const double damping : {0.0, 0.5})
        for (const double stiffness : {0.0, 2.0}) {
            const Rig absorber(Chain<double>({plummet(1.0, 1.0)}), {.support = {stiffness, 1.0, 0, damping}});
            const auto pushed = forced_motion(absorber, {.angular_speed = {1.0}, .force = 0.1, .gravity = 1});
            CAPTURE(damping, stiffness, pushed.offset, pushed.error_estimate);
            CHECK(pushed.resonant[0] == 0);
            CHECK(std::abs(pushed.offset(0, 0) + 0.1) <= 1e-15);
            CHECK(std::abs(pushed.offset(0, 1)) <= 1e-15);
            CHECK(pushed.error_estimate[0] <= 1e-14);
        }
}

TEST_CASE("resonance: none with a dashpot, said without", "[linear]") {
    const Chain<double> chain({plummet(1.0, 1.0)});
    const Rig free(chain, {}), damped(chain, {.pins = {{.damping = 1e-3}}});
    const auto at = [](const Rig& rig) {
        return forced_motion(rig, {.angular_speed = {1.0}, .radius = 1, .gravity = 1});
    };
    CHECK(at(free).resonant[0] == 1);
    CHECK(std::isnan(at(free).offset(0, 0).real()));
    CHECK(std::isinf(at(free).error_estimate[0]));
    // (1 - n^2 + i c n) r = n^2 b at n = 1
    CHECK(std::abs(at(damped).offset(0, 0) - std::complex<double>(1, -1000)) <= 1e-12);
    CHECK(at(damped).resonant[0] == 0);
}

TEST_CASE("what forced motion refuses", "[linear]") {
    using Catch::Matchers::Contains;
    const Rig rig(Chain<double>({plummet(1.0, 1.0)}), {});
    CHECK_THROWS_WITH(forced_motion(rig, {.angular_speed = {1}}),
                      Contains("give one of radius, acceleration and force"));
    CHECK_THROWS_WITH(forced_motion(rig, {.angular_speed = {1}, .radius = 1, .force = 1}), Contains("give one of"));
    CHECK_THROWS_WITH(forced_motion(rig, {.angular_speed = {1}, .force = 1}), Contains("does not move a firm support"));
    CHECK_THROWS_WITH(forced_motion(rig, {.angular_speed = {-1}, .radius = 1}), Contains("angular speed"));
    CHECK_THROWS_WITH(forced_motion(rig, {.angular_speed = {0}, .radius = 1}), Contains("angular speed"));
    CHECK_THROWS_WITH(forced_motion(rig, {.radius = 1, .gravity = 0}), Contains("gravity"));
    CHECK_THROWS_WITH(forced_motion(rig, {.angular_speed = {1e200}, .radius = 1}),
                      Contains("that far from the rig's own"));
    CHECK_THROWS_WITH(forced_motion(rig, {.angular_speed = {1}, .radius = 1e300}), Contains("too large"));
}
