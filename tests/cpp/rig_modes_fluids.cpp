// SPDX-License-Identifier: MPL-2.0
// Rigs in a fluid, against counts on assembled matrices in quadruple precision (support/rig_truth.hpp).
#include "revchain/rig_modes.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/checked_rig_modes.hpp"
#include "support/error_metric.hpp"
#include "support/rig_truth.hpp"

using namespace revchain;
using support::error_in_ulp;
using support::Quad;
using support::quad;
using support::Random;
using support::RigTruth;
using support::rig_modes::g;
using support::rig_modes::random_body;
using support::rig_modes::worst_error;

// Stokes (§2): plummets with mu = net W1 / net W2 < 0, in fluid that turns with them: lambda complex. At rest: real.
TEST_CASE("a float in fluid that turns, and in fluid at rest", "[linear]") {
    const Chain<double> chain(std::vector{plummet(1.0, 1.0), plummet(4.0, 1.0)});
    Rigging with{.fluid = Fluid::turning, .displaced = {{2.0, 1.0, Wide<double>(0.0), 0}, {}}};
    for (const bool turning : {true, false}) {
        with.fluid = turning ? Fluid::turning : Fluid::still;
        const auto m = modes(Rig(chain, with), {.count = revchain::all_modes});
        CHECK(m.complete);
        if (turning) {  // mu = -1/4, x = 0: (lambda - a)^2 = mu a^2 / (1 + mu) = -1/3
            CHECK(m.forward.size() == 0);
            REQUIRE(m.other.size() == 2);
            for (const auto& other : m.other) {
                CHECK(std::abs(other.conical_height.real() - 1) <= 4e-16);
                CHECK(std::abs(other.conical_height.imag() * other.conical_height.imag() - 1.0 / 3) <= 3e-16);
                CHECK(other.error_bound <= 2e-16);
                CHECK(other.growth_rate > 0);
            }
            CHECK(m.status == Status::success);
        } else {  // the float alone is lighter than water: it stands up in its thread, K is indefinite, M is not
            CHECK(m.method == revchain::RigMethod::counts);
            CHECK(m.forward.size() == 1);
            CHECK(m.other.size() == 1);
            CHECK(worst_error(RigTruth(Rig(chain, with)), m) <= 0.501);
        }
    }
    // mu > 0 and net weights: heights of plummets with the net weights
    with = {.fluid = Fluid::turning, .displaced = {{0.5, 1.0, Wide<double>(0.0), 0}, {3.0, 1.0, Wide<double>(0.0), 0}}};
    const auto net = modes(Rig(chain, with), {.count = revchain::all_modes});
    const auto same =
        modes(Chain<double>(std::vector{plummet(0.5, 1.0), plummet(1.0, 1.0)}), {.count = revchain::all_modes});
    CHECK(net.method == revchain::RigMethod::counts);
    CHECK((net.forward.conical_height - same.conical_height).cwiseAbs().maxCoeff() == 0);
}

// Heights where neither K nor M is definite: floats in fluid that turns.
TEST_CASE("random floats: heights real, negative and complex", "[linear]") {
    Random random(68);
    double worst = 0, step = 0;
    Index complex = 0, negative = 0;
    for (int i = 0; i < 60; ++i) {
        const Index n = i < 50 ? 1 + i % 8 : 60;
        std::vector<Link<double>> links;
        Rigging with{.fluid = Fluid::turning};
        for (Index m = 0; m < n; ++m) {
            links.push_back(random_body(random));
            with.displaced.push_back({links.back().weight * random.between(0, 2.5), links.back().centroid,
                                      links.back().gyration_ratio * Wide<double>(random.between(0.5, 1.5)), 0});
            with.posture.push_back(random() < 0.5 ? Posture::hangs : Posture::stands);
        }
        const Rig rig{Chain<double>(links), with};
        const auto m = modes(rig, {.count = revchain::all_modes});
        const RigTruth truth(rig);
        CAPTURE(i, n, m.method);
        REQUIRE(m.complete);
        CHECK(m.forward.size() + static_cast<Index>(m.other.size()) == n);
        worst = std::max(worst, worst_error(truth, m));
        for (const auto& other : m.other) {
            complex += other.conical_height.imag() != 0, negative += other.conical_height.imag() == 0;
            const double away = truth.newton_step(other.conical_height, false);
            CHECK(away <= other.error_bound * 1.001);
            step = std::max(step, away);
            // exp(s t) with s^2 = -g / lambda grows as the rate says
            const std::complex<double> s = std::sqrt(-g / other.conical_height);
            CHECK(std::abs(s.real()) == Approx(other.growth_rate).epsilon(1e-14).margin(1e-14 * std::abs(s)));
        }
    }
    CHECK(worst <= 0.501);
    CHECK(step <= 1.6e-16);
    CHECK(complex > 20);
    CHECK(negative > 20);
}

TEST_CASE("links that weigh nothing in the fluid around them", "[linear]") {
    const Link<double> one = plummet(1.0, 1.0), two = plummet(2.0, 1.0);
    const auto like = [](const Link<double>& link, double weight) {
        return Displaced{weight, link.centroid, link.gyration_ratio, 0};
    };
    const auto infinite = [](const RigModes& m) {
        return std::count_if(m.other.begin(), m.other.end(), [](const OtherMode& other) {
            return std::isinf(other.conical_height.real()) && other.growth_rate == 0 && other.error_bound == 0;
        });
    };
    {  // A n^2 - H n = 0: it stays where it is put, or precesses at H/A
        const RigModes m = modes(Rig(Chain<double>({one}), {.flywheels = {{3.0, 0}}, .displaced = {like(one, 1.0)}}),
                                 {.count = revchain::all_modes});
        REQUIRE(m.complete);
        REQUIRE(m.forward.size() == 1);
        CHECK(error_in_ulp(m.forward.angular_speed[0], Quad(3) * Quad(g)) <= 0.51);
        CHECK(m.backward.size() == 0);
        CHECK(infinite(m) == 1);
    }
    for (const std::size_t size : {1u, 2u, 3u})  // turning with the fluid such a link is not there
        for (const bool lowest : {true, false}) {
            if (!lowest && size < 3) continue;
            std::vector<Link<double>> links(size, one);
            Rigging with{.fluid = Fluid::turning, .displaced = std::vector<Displaced>(size, like(one, 0.0))};
            with.displaced[lowest ? 0 : 1] = like(one, 1.0);
            const RigModes m = modes(Rig(Chain<double>(links), with), {.count = revchain::all_modes});
            CAPTURE(size, lowest, m.method);
            REQUIRE(m.complete);
            CHECK(m.status == Status::success);
            CHECK(m.other.empty());
            std::vector<Link<double>> rest(size - 1, one);
            if (!lowest) rest = {plummet(1.0, 2.0), one};  // a thread in its place
            REQUIRE(m.forward.size() == static_cast<Index>(rest.size()));
            if (rest.empty()) continue;
            const Modes<double> plain = modes(Chain<double>(rest), {.count = revchain::all_modes});
            for (Index j = 0; j < plain.size(); ++j)
                CHECK(error_in_ulp(m.forward.conical_height[j], Quad(plain.conical_height[j])) <= 1.01);
            if (lowest) CHECK(m.forward.shapes().col(0) == m.forward.shapes().col(1));
        }
    {  // still: it moves without weight
        const RigModes m = modes(Rig(Chain<double>({one, two}), {.displaced = {like(one, 1.0), like(two, 0.0)}}),
                                 {.count = revchain::all_modes});
        REQUIRE(m.complete);
        CHECK(m.status == Status::success);
        REQUIRE(m.forward.size() == 1);
        CHECK(m.forward.conical_height[0] == 1.0);
        CHECK(infinite(m) == 1);
    }
    {  // net weights -2 and 1.5, (z - 1)^2 = 4: roots that are numbers, where P'/P is none
        const RigModes m = modes(
            Rig(Chain<double>({one, two}), {.fluid = Fluid::turning, .displaced = {like(one, 3.0), like(two, 0.5)}}),
            {.count = revchain::all_modes});
        REQUIRE(m.complete);
        REQUIRE(m.forward.size() == 1);
        CHECK(m.forward.conical_height[0] == 3.0);
        CHECK(m.forward.error_bound[0] <= 2.5e-16);
        REQUIRE(m.other.size() == 1);
        CHECK(m.other[0].conical_height == std::complex<double>(-1.0));
    }
}
