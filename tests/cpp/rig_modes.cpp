// SPDX-License-Identifier: MPL-2.0
// Truths: closed forms in quadruple precision, the quartic of two gyrostats from angles and energies, and counts on
// assembled matrices in quadruple precision (support/rig_truth.hpp). Error: relative, in ulp (2^-52).
#include "revchain/rig_modes.hpp"

#include <Eigen/Eigenvalues>

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

TEST_CASE("one gyrostat: A n^2 - H n - W h = 0, free and driven", "[linear]") {
    Random random(61);
    double worst = 0;
    for (int i = 0; i < 300; ++i) {
        const auto body = random_body(random);
        const double H = random.log_between(1e-6, 1e6) * (random() < 0.5 ? -1 : 1);
        // C <= 2A is a disc's, and A less it may be negative: then both speeds have the sign of -H, or neither is real.
        const double C = i % 3 == 0 ? 0 : body.weight * body.length * body.length * random.between(0, 0.5);
        const auto m =
            modes(Rig(Chain<double>(std::vector{body}), {.flywheels = {{H, C}}}), {.count = revchain::all_modes});
        const Quad a = body.length, h = body.centroid, Wh = Quad(body.weight) * h;
        const Quad A = (Quad(body.weight) * (h * h + quad(body.gyration_ratio) * a * a) - Quad(C)) / Quad(g);
        const Quad root2 = Quad(H) * Quad(H) + 4 * A * Wh;
        CAPTURE(i, H, C, static_cast<double>(A), m.method);
        CHECK(m.complete);
        CHECK(m.status == Status::success);
        if (root2 < 0) {
            REQUIRE(m.other.size() == 2);
            CHECK(m.forward.size() + m.backward.size() == 0);
            const double rate = static_cast<double>(sqrtq(-root2) / (2 * fabsq(A)));
            CHECK(m.other[0].growth_rate == Approx(rate).epsilon(1e-14));
            CHECK(m.other[0].angular_speed.real() == Approx(static_cast<double>(Quad(H) / (2 * A))).epsilon(1e-14));
            continue;
        }
        const Quad far = (Quad(H) + (H < 0 ? -1 : 1) * sqrtq(root2)) / (2 * A), near = -Wh / (A * far);
        Index found = 0;
        for (const Quad n : {far, near}) {
            const WhirlModes& sense = n > 0 ? m.forward : m.backward;
            double best = 1e300;
            for (Index j = 0; j < sense.size(); ++j)
                best = std::min(best, error_in_ulp(sense.angular_speed[j], fabsq(n)));
            CHECK(best <= 0.501);
            worst = std::max(worst, best);
            ++found;
        }
        CHECK(m.forward.size() + m.backward.size() == found);
    }
    CHECK(worst >= 0.3);
}

// Angles t1 (lower), t2 about the vertical; kinetic energy of the two bodies in the turning plane, n^2/2g times
// W2 h2 l2 t2^2 + W1 [(a2 t2 + h1 t1)^2 + rho1^2 t1^2], and p n t^2/2 from each wheel, less the fall of the weights.
TEST_CASE("two gyrostats in series: the quartic", "[linear]") {
    Random random(62);
    double worst = 0;
    for (int i = 0; i < 300; ++i) {
        const std::vector<Link<double>> b{random_body(random), random_body(random)};
        const double H1 = random.between(-3, 3), H2 = random.between(-3, 3);
        const auto m = modes(Rig(Chain<double>(b), {.flywheels = {{H1, 0}, {H2, 0}}}), {.count = revchain::all_modes});
        CHECK(m.method == revchain::RigMethod::counts);
        REQUIRE(m.forward.size() == 2);
        REQUIRE(m.backward.size() == 2);
        const auto square = [](const Link<double>& x) {
            const Quad h = x.centroid, a = x.length;
            return h * h + quad(x.gyration_ratio) * a * a;
        };
        const Quad W1 = b[0].weight, W2 = b[1].weight, a2 = b[1].length;
        const Quad J11 = W1 * square(b[0]) / Quad(g), J12 = W1 * a2 * Quad(b[0].centroid) / Quad(g);
        const Quad J22 = (W2 * square(b[1]) + W1 * a2 * a2) / Quad(g);
        const Quad k1 = W1 * Quad(b[0].centroid), k2 = W2 * Quad(b[1].centroid) + W1 * a2;
        const auto wrong = [&](Quad n) {  // a Newton step of (k1 + n H1 - n^2 J11)(k2 + n H2 - n^2 J22) = n^4 J12^2
            const Quad x = k1 + n * Quad(H1) - n * n * J11, y = k2 + n * Quad(H2) - n * n * J22;
            const Quad dx = Quad(H1) - 2 * n * J11, dy = Quad(H2) - 2 * n * J22;
            return static_cast<double>(
                       fabsq((x * y - n * n * n * n * J12 * J12) / (dx * y + x * dy - 4 * n * n * n * J12 * J12) / n)) /
                   0x1p-52;
        };
        for (Index j = 0; j < 2; ++j)
            worst = std::max({worst, wrong(m.forward.angular_speed[j]), wrong(-Quad(m.backward.angular_speed[j]))});
    }
    CHECK(worst <= 0.501);
    CHECK(worst >= 0.4);
}

TEST_CASE("a support that yields: plummet, compound link, carriage", "[linear]") {
    Random random(63);
    for (int i = 0; i < 100; ++i) {
        const double a = random.between(0.1, 3), W = random.between(0.1, 5), E = random.log_between(1e-4, 1e4);
        const auto m = modes(Rig(Chain<double>(std::vector{plummet(W, a)}), {.support = {E, 0, 0}}),
                             {.count = revchain::all_modes});
        REQUIRE(m.forward.size() == 1);  // a massless coordinate: one height fewer
        CHECK(m.complete);
        CHECK(error_in_ulp(m.forward.conical_height[0], Quad(a) + Quad(W) / Quad(E)) <= 0.501);

        const auto body = random_body(random);
        const Quad h = body.centroid, l = h + quad(body.gyration_ratio) * Quad(body.length) * Quad(body.length) / h;
        const Quad c = Quad(body.weight) / Quad(E);
        const auto two =
            modes(Rig(Chain<double>(std::vector{body}), {.support = {E, 0, 0}}), {.count = revchain::all_modes});
        REQUIRE(two.forward.size() == (body.gyration_ratio > Wide<double>(0.0) ? 2 : 1));
        for (const double lambda : two.forward.conical_height) {  // (lambda - l)(lambda - c) = c h
            const Quad x = lambda, f = (x - l) * (x - c) - c * h, slope = 2 * x - l - c;
            CHECK(static_cast<double>(fabsq(f / slope / x)) / 0x1p-52 <= 0.501);
        }
        CHECK(worst_error(RigTruth(Rig(Chain<double>(std::vector{body}), {.support = {E, 0.3, 0}})),
                          modes(Rig(Chain<double>(std::vector{body}), {.support = {E, 0.3, 0}}),
                                {.count = revchain::all_modes})) <= 0.501);
    }
}

TEST_CASE("standing links: sections 2 (8) and 6 (12); as many motions as links hang", "[linear]") {
    Random random(64);
    const auto root = [](Quad p, Quad q) { return (p + sqrtq(p * p + 4 * q)) / 2; };  // x^2 - p x - q = 0
    for (int i = 0; i < 50; ++i) {
        const double l1 = random.between(0.2, 3), l2 = random.between(0.2, 3), W1 = random.between(0.1, 9);
        const double W2 = random.between(0.1, 9);
        const Chain<double> two(std::vector{plummet(W1, l1), plummet(W2, l2)});
        const auto m = modes(Rig(two, {.posture = {Posture::stands, Posture::hangs}}), {.count = revchain::all_modes});
        // (l1 + lambda)(l2 - lambda) = W1 l1 l2 / (W1 + W2)
        const Quad p = Quad(l2) - Quad(l1), q = Quad(l1) * Quad(l2) * Quad(W2) / (Quad(W1) + Quad(W2));
        REQUIRE(m.forward.size() == 1);
        CHECK(error_in_ulp(m.forward.conical_height[0], root(p, q)) <= 0.501);
        REQUIRE(m.other.size() == 1);
        const Quad negative = -q / root(p, q);
        CHECK(error_in_ulp(m.other[0].conical_height.real(), negative) <= 0.501);
        CHECK(m.other[0].error_bound <= 2.3e-16);
        CHECK(m.other[0].growth_rate == Approx(static_cast<double>(sqrtq(Quad(g) / -negative))).epsilon(1e-15));
        CHECK(m.complete);

        // A body that stands on a massless link: (l + lambda)(a - lambda) = a h. The thread's own tension is W.
        const auto body = random_body(random, 1);
        const Quad h = body.centroid, l = h + quad(body.gyration_ratio) * Quad(body.length) * Quad(body.length) / h;
        const auto stick = modes(
            Rig(Chain<double>(std::vector{body, plummet(0.0, l2)}), {.posture = {Posture::stands, Posture::hangs}}),
            {.count = revchain::all_modes});
        REQUIRE(stick.forward.size() == 1);
        CHECK(error_in_ulp(stick.forward.conical_height[0], root(Quad(l2) - l, Quad(l2) * (l - h))) <= 0.501);
    }
    for (const Index n : {3, 20, 150}) {
        std::vector<Link<double>> links;
        Rigging with;
        Index hanging = 0;
        for (Index m = 0; m < n; ++m) {
            links.push_back(random_body(random));
            with.posture.push_back(random() < 0.5 ? Posture::hangs : Posture::stands);
            hanging += with.posture.back() == Posture::hangs;
        }
        const Rig rig{Chain<double>(links), with};
        const auto m = modes(rig, {.count = revchain::all_modes});
        CHECK(m.forward.available == hanging);
        CHECK(m.forward.size() == hanging);
        CHECK(static_cast<Index>(m.other.size()) == n - hanging);
        CHECK(m.complete);
        CHECK(worst_error(RigTruth(rig), m) <= 0.501);
        const RigTruth truth(rig);
        for (const auto& other : m.other)
            CHECK(RigTruth::off_by(other.conical_height.real(), [&](Quad x) { return truth.at_height(x); }) <= 0.501);
    }
}

TEST_CASE("random gyrostat chains against counts in quadruple precision", "[linear]") {
    Random random(65);
    double worst = 0;
    for (const Index n : {1, 2, 3, 5, 10, 40, 200, 1000}) {
        for (const double spins : {0.01, 1.0, 30.0}) {
            std::vector<Link<double>> links;
            Rigging with;
            for (Index m = 0; m < n; ++m) {
                links.push_back(random_body(random));
                with.flywheels.push_back({spins * random.between(-1, 1) * links.back().weight, 0});
            }
            if (n % 2 == 1) with.support = {random.log_between(0.1, 100), random() < 0.5 ? 0.0 : 0.7, 0};
            const Rig rig{Chain<double>(links), with};
            const bool all = n <= 40;
            const auto m = all ? modes(rig, {.count = revchain::all_modes}) : modes(rig, {.first = n / 3, .count = 5});
            CAPTURE(n, spins);
            CHECK(m.complete);
            CHECK(m.status == Status::success);
            const Index there = n + (with.support.carriage_weight > 0 ? 1 : 0);
            if (with.support.is_firm()) CHECK(m.forward.available == there);
            CHECK(m.forward.speed_error_bound.maxCoeff() <= 2.3e-16);
            CHECK(m.backward.error_bound.maxCoeff() <= 8e-16);
            worst = std::max(worst, worst_error(RigTruth(rig), m));
        }
    }
    CHECK(worst <= 0.501);
}

TEST_CASE("extremes of scale, and ten thousand gyrostats", "[linear]") {
    Random random(66);
    double worst = 0;
    for (const Index n : {2, 10, 60}) {
        for (int i = 0; i < 4; ++i) {
            std::vector<Link<double>> links;
            Rigging with;
            for (Index m = 0; m < n; ++m) {
                const double W = random.log_between(1e-6, 1e6), a = random.log_between(1e-3, 1e3);
                links.push_back(i % 2 == 0 ? plummet(W, a) : uniform_rod(W, a));
                with.flywheels.push_back({W * random.between(-1, 1) * std::sqrt(a) * a, 0});
            }
            const Rig rig{Chain<double>(links), with};
            const auto m = modes(rig, {.count = revchain::all_modes});
            CAPTURE(n, i);
            CHECK(m.complete);
            CHECK(m.status == Status::success);
            for (const WhirlModes* sense : {&m.forward, &m.backward})
                CHECK(sense->speed_error_bound.maxCoeff() <= 2.3e-16);
            worst = std::max(worst, worst_error(RigTruth(rig), m));
        }
    }
    for (int i = 0; i < 2; ++i) {
        std::vector<Link<double>> links;
        Rigging with;
        for (Index m = 0; m < 10'000; ++m) {
            links.push_back(i == 0 ? uniform_rod(1e-4, 1e-4) : random_body(random));
            with.flywheels.push_back({links.back().weight * random.between(-0.1, 1), 0});
        }
        const Rig rig{Chain<double>(links), with};
        for (const Index first : {1, 7000}) {
            const auto m = modes(rig, {.first = first, .count = 2});
            CHECK(m.complete);
            CHECK(m.forward.available == 10'000);
            CHECK(m.forward.speed_error_bound.maxCoeff() <= 2.3e-16);
            worst = std::max(worst, worst_error(RigTruth(rig), m));
        }
    }
    CHECK(worst <= 0.501);
}

// Where neither stiffness nor mass is definite: every speed from the companion matrix in double, independent of discs.
TEST_CASE("standing gyrostats: all speeds accounted for", "[linear]") {
    Random random(67);
    double worst = 0;
    for (const Index n : {1, 2, 3, 6, 20, 60}) {
        for (const double spins : {0.3, 3.0, 40.0}) {
            std::vector<Link<double>> links;
            Rigging with;
            for (Index m = 0; m < n; ++m) {
                links.push_back(random_body(random));
                with.flywheels.push_back({spins * random.between(0.2, 1) * links.back().weight, 0});
                with.posture.push_back(m % 2 == 0 ? Posture::stands : Posture::hangs);
            }
            const Rig rig{Chain<double>(links), with};
            const auto m = modes(rig, {.count = revchain::all_modes});
            CAPTURE(n, spins);
            REQUIRE(m.method == revchain::RigMethod::discs);
            REQUIRE(m.complete);
            CHECK(m.status == Status::success);
            CHECK(m.forward.size() + m.backward.size() + static_cast<Index>(m.other.size()) == 2 * n);
            const RigTruth truth(rig);
            worst = std::max(worst, worst_error(truth, m));
            for (const WhirlModes* sense : {&m.forward, &m.backward})
                if (sense->size() > 0) CHECK(sense->speed_error_bound.maxCoeff() <= 4.5e-16);
            for (const auto& other : m.other) {
                CHECK(other.error_bound <= 4e-15);
                CHECK(truth.newton_step(other.angular_speed, true) <= 1.12e-16);
            }
            const Matrix<double> inverse = (truth.dense<double>(truth.M) / g).inverse();
            Matrix<double> C(2 * n, 2 * n);
            C << Matrix<double>::Zero(n, n), Matrix<double>::Identity(n, n), inverse * truth.dense<double>(truth.K),
                inverse * truth.dense<double>(truth.G);
            const Eigen::EigenSolver<Matrix<double>> dense(C, false);
            std::vector<std::complex<double>> mine;
            for (const double s : m.forward.angular_speed) mine.emplace_back(s);
            for (const double s : m.backward.angular_speed) mine.emplace_back(-s);
            for (const auto& other : m.other) mine.push_back(other.angular_speed);
            double largest = 0, far = 0;
            for (Index i = 0; i < 2 * n; ++i) largest = std::max(largest, std::abs(dense.eigenvalues()[i]));
            for (Index i = 0; i < 2 * n; ++i) {
                double best = 1e300;
                for (const auto& z : mine) best = std::min(best, std::abs(z - dense.eigenvalues()[i]));
                far = std::max(far, best / largest);
            }
            CHECK(far <= 1e-9);
        }
    }
    CHECK(worst <= 0.51);
}

TEST_CASE("a rig without anything is its chain; next to nothing changes nothing", "[linear]") {
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 7, 40}) {
            const auto chain = family.make(n);
            const auto plain = modes(chain, {.count = revchain::all_modes});
            const auto same = modes(Rig(chain, {}), {.count = revchain::all_modes});
            CHECK(same.method == revchain::RigMethod::modes);
            CHECK(same.forward.conical_height == plain.conical_height);
            CHECK(same.forward.shapes() == plain.shapes());
            CHECK(same.forward.angular_speed == plain.angular_speed());
            // The same chain by the rig's own road, with a spring too stiff to matter, and with momenta too small to.
            const double stiff = chain.total_weight() / chain.total_length() * 1e40;
            const auto held = modes(Rig(chain, {.support = {stiff, 0, 0}}), {.count = revchain::all_modes});
            CAPTURE(family.name, n);
            // A rod's upper end, held by the spring alone, has a mode of its own, 1e40 times as fast.
            REQUIRE(held.forward.size() >= plain.size());
            CHECK(held.forward.size() <= plain.size() + 1);
            CHECK(held.complete);
            for (Index j = 0; j < plain.size(); ++j) {
                CHECK(std::abs(held.forward.conical_height[j] / plain.conical_height[j] - 1) <= 2.3e-16);
                CHECK((held.forward.shapes().row(j) - plain.shapes().row(j)).cwiseAbs().maxCoeff() <= 3e-16);
            }
            std::vector<Flywheel> slow(static_cast<std::size_t>(n));
            slow[0].momentum = 1e-60;
            const auto spun = modes(Rig(chain, {.flywheels = slow}), {.count = revchain::all_modes});
            REQUIRE(spun.forward.size() == plain.size());
            for (Index j = 0; j < plain.size(); ++j)
                for (const WhirlModes* sense : {&spun.forward, &spun.backward})
                    CHECK(std::abs(sense->angular_speed[j] / plain.angular_speed()[j] - 1) <= 6.7e-16);
        }
    }
}

TEST_CASE("where a link goes slack, and mirror images", "[linear]") {
    const Chain<double> chain(std::vector{uniform_rod(1.0, 1.0), uniform_rod(2.0, 0.5)});
    // the upper link: tension (W h + a S)/a = 2; momentum/a = -1: slack at n = 2 of its own sense
    const Rig rig(chain, {.flywheels = {{0, 0}, {-0.5, 0}}}), mirror(chain, {.flywheels = {{0, 0}, {0.5, 0}}});
    const auto m = modes(rig, {.count = revchain::all_modes}), other = modes(mirror, {.count = revchain::all_modes});
    REQUIRE(m.slack.size() == 1);
    CHECK(m.slack[0].link == 1);
    CHECK(m.slack[0].angular_speed == 2);
    REQUIRE(other.slack.size() == 1);
    CHECK(other.slack[0].angular_speed == -2);
    CHECK(m.forward.angular_speed == other.backward.angular_speed);
    CHECK(m.forward.shapes() == other.backward.shapes());
    CHECK(modes(rig, {.count = 1}).slack.size() == (m.forward.angular_speed[0] >= 2 ? 1 : 0));
    CHECK(worst_error(RigTruth(rig), m) <= 0.501);
}

// (T/a + n p/a^2) 4 sin^2(theta/2) = (n^2/g)[W - 4 (W h (a-l)/a^2) sin^2(theta/2)]: gyrostats that move but do not weigh
// (added weight), stretched by a plummet. The shape of every mode is one of the waves of that length.
TEST_CASE("Thomson's uniform gyrostatic string", "[linear]") {
    const Index n = 40;
    const double T = 2, a = 0.25, p = 0.03, w = 0.1;
    std::vector<Link<double>> links{plummet(T, a)};
    Rigging with{.flywheels = {{0, 0}}, .displaced = {{}}};
    for (Index m = 1; m < n; ++m) {
        links.push_back(plummet(0.0, a));
        with.flywheels.push_back({p, 0});
        with.displaced.push_back({0, a / 2, Wide<double>(1.0) / Wide<double>(12.0), w});
    }
    const Rig rig{Chain<double>(links), with};
    const auto m = modes(rig, {.count = revchain::all_modes});
    CHECK(m.complete);
    CHECK(m.forward.size() == n);
    CHECK(worst_error(RigTruth(rig), m) <= 0.501);
    const double h = a / 2, l = 2 * a / 3;
    for (const WhirlModes* sense : {&m.forward, &m.backward})
        for (Index j = 0; j < n; ++j) {
            const double speed = (sense == &m.backward ? -1 : 1) * sense->angular_speed[j], square = speed * speed / g;
            const double sine2 = square * w / (T / a + speed * p / (a * a) + square * w * h * (a - l) / (a * a)) / 4;
            for (Index i = 3; i + 1 < n; ++i)  // y_{i-1} + y_{i+1} = 2 cos(theta) y_i
                CHECK(std::abs(sense->shapes()(j, i - 1) + sense->shapes()(j, i + 1) -
                               2 * (1 - 2 * sine2) * sense->shapes()(j, i)) <= 4e-15 * (1 + 4 * std::abs(sine2)));
        }
}

TEST_CASE("massless links and what was asked", "[linear]") {
    const Chain<double> chain(std::vector{plummet(1.0, 1.0), plummet(0.0, 0.5), plummet(2.0, 1.5), plummet(0.0, 1.0)});
    const auto m = modes(Rig(chain, {.flywheels = {{0.2, 0}, {}, {0.4, 0}, {}}}), {.count = revchain::all_modes});
    CHECK(m.forward.size() == 2);  // the lower thread with momentum's pins included
    CHECK(m.backward.size() == m.backward.available);
    CHECK(m.complete);
    // a thin body's mass is one square of two offsets; what it leaves free a massless link above cannot hold
    const Chain<double> thin(
        std::vector{compound_pendulum<double>({.weight = 1, .length = 1, .centroid = 0.3, .radius_of_gyration = 0.0}),
                    plummet(0.0, 0.5), uniform_rod(1.0, 1.0)});
    const auto t = modes(Rig(thin, {.flywheels = {{}, {}, {0.5, 0}}}), {.count = revchain::all_modes});
    CHECK(t.forward.size() == thin.mode_count());
    CHECK(t.complete);
    const auto stand = modes(Rig(chain, {.posture = {Posture::hangs, Posture::hangs, Posture::stands, Posture::hangs}}),
                             {.count = revchain::all_modes});
    CHECK(stand.complete);
    CHECK(stand.forward.size() + static_cast<Index>(stand.other.size()) == 2);
    const Rig rig(chain, {.support = {3, 0, 0}});
    CHECK(modes(rig, {.count = revchain::all_modes}).forward.size() == 2);
    CHECK(modes(rig, {.first = 2, .count = revchain::all_modes}).forward.first == 2);
    CHECK(modes(rig, {.first = 2, .count = revchain::all_modes}).forward.conical_height[0] ==
          modes(rig, {.count = revchain::all_modes}).forward.conical_height[1]);
    CHECK(modes(rig, {.first = 3, .count = revchain::all_modes}).forward.size() == 0);
    CHECK(modes(rig, {.first = 3, .count = revchain::all_modes}).forward.available == 2);
    CHECK_THROWS_AS(modes(rig, {.first = 0, .count = revchain::all_modes}), InvalidArgument);
    CHECK(modes(rig, {.first = 2, .count = 3}).forward.size() == 1);
    CHECK_THROWS_AS(modes(rig, {.count = 0}), InvalidArgument);
    CHECK_THROWS_AS(modes(rig, {.count = revchain::all_modes, .gravity = -1}), InvalidArgument);
    Progress progress;
    (void)modes(rig, {.count = revchain::all_modes, .progress = &progress});
    CHECK(progress.fraction() == 1);
    progress.cancel();
    CHECK_THROWS_AS(modes(rig, {.count = revchain::all_modes, .progress = &progress}), Cancelled);
}

// Point masses on rigid links and springs without carriages leave coordinates without inertia.
TEST_CASE("coordinates without inertia: speeds as many as there are, each proved", "[linear]") {
    const auto link = [](double weight, double length, double centroid, double radius) {
        return compound_pendulum<double>(
            {.weight = weight, .length = length, .centroid = centroid, .radius_of_gyration = radius});
    };
    const Rig three(Chain<double>({link(31, 3.4, 0.94, 0), link(0.016, 2, 1.6, 0.24), link(63, 0.18, 0.18, 0)}),
                    {.support = horizontal_spring(420, 0), .flywheels = {{3.3, 0}, {0, 0.0015}, {0, 0}}});
    const auto m = modes(three, {.count = revchain::all_modes});
    CHECK(m.forward.size() == 3);
    CHECK(m.backward.size() == 3);
    CHECK(m.other.empty());
    CHECK(m.status == Status::success);
    CHECK(m.complete);
    CHECK(worst_error(RigTruth(three), m) <= 1.5);
    const Rig spun(Chain<double>({link(1, 1, 0.1, 0)}), {.support = horizontal_spring(5, 0), .flywheels = {{0.3, 0}}});
    const auto s = modes(spun, {.count = revchain::all_modes});
    CHECK(s.forward.size() == 1);
    CHECK(s.backward.size() == 2);
    CHECK(s.status == Status::success);
    CHECK(worst_error(RigTruth(spun), s) <= 1);
    const auto upright = modes(
        Rig(Chain<double>({link(1, 1, 0.5, 0)}), {.support = horizontal_spring(5, 0), .posture = {Posture::stands}}),
        {.count = revchain::all_modes});
    CHECK(upright.forward.size() == 0);
    CHECK(upright.other.size() == 1);
    CHECK(upright.status == Status::success);
}

TEST_CASE("chains stiffer than their spring by many decades", "[linear]") {
    const auto body = [](double W, double a, double h) {
        return compound_pendulum<double>({.weight = W, .length = a, .centroid = h, .radius_of_gyration = 0.1});
    };
    for (const double stiffness : {1e3, 1.0, 1e-6, 1e-12, 1e-30, 1e-100})
        for (const double carriage : {0.0, 2.0}) {
            const Rig rig(Chain<double>({body(1, 0.5, 0.2), body(1e12, 1, 0.4), body(2, 0.3, 0.15)}),
                          {.support = horizontal_spring(stiffness, carriage)});
            const RigModes m = modes(rig, {.count = revchain::all_modes});
            CAPTURE(stiffness, carriage);
            REQUIRE(m.complete);
            REQUIRE(m.forward.size() == 4);
            CHECK(m.forward.error_bound.maxCoeff() <= 2.3e-16);
            CHECK(m.forward.residual().maxCoeff() <= 1e-16);
            if (stiffness < 1) continue;  // what is assembled has not the digits
            CHECK(worst_error(RigTruth(rig), m) <= 0.501);
        }
    // all of the chain moves as one on the softest of springs: height = weight/stiffness + c, c seen at 1e12
    const Rig soft(Chain<double>({plummet(1.0, 1.0), plummet(1.0, 1e-6)}), {.support = horizontal_spring(1e-12, 0)});
    CHECK(modes(soft, {.count = revchain::all_modes}).forward.conical_height[0] == 2e12 + 0.5);
}

TEST_CASE("all modes under a spring: plummets, rods and bodies, with a carriage and without", "[linear]") {
    Random random(66);
    double worst = 0;
    for (int i = 0; i < 240; ++i) {
        const Index n = i % 8 == 0 ? 60 + i / 4 : 1 + i / 10;
        std::vector<Link<double>> links;
        for (Index m = 0; m < n; ++m) {
            const double W = random.log_between(0.01, 1), a = random.log_between(0.1, 1), p = random.between(0.2, 0.8);
            if (i % 3 == 0) links.push_back(plummet(W, a));
            if (i % 3 == 1) links.push_back(uniform_rod(W, a));
            if (i % 3 == 2)
                links.push_back(compound_pendulum<double>({.weight = W,
                                                           .length = a,
                                                           .centroid = a * p,
                                                           .radius_of_gyration = a * 0.3 * random.between(0.3, 1)}));
        }
        const double carriage = i % 2 == 0 ? 0 : random.log_between(1e-3, 1e3);
        const Rig rig(Chain<double>(links), {.support = {random.log_between(1e-3, 1e3), carriage, 0}});
        const auto m = modes(rig, {.count = revchain::all_modes});
        CAPTURE(i, n, carriage);
        CHECK(m.complete);
        CHECK(m.forward.size() == n + (i % 3 == 0 && carriage == 0 ? 0 : 1));
        CHECK(m.forward.error_bound.maxCoeff() <= 2.3e-16);
        worst = std::max(worst, worst_error(RigTruth(rig), m, n > 30 ? 7 : 1));
    }
    CHECK(worst <= 0.501);
}

TEST_CASE("rigs: shapes when they are asked for, and where they cross the axis", "[linear]") {
    const Rig rig(Chain<double>::uniform_rods(12), {.support = horizontal_spring(2.0)});
    const auto m = modes(rig).forward;
    REQUIRE(m.size() == 10);
    CHECK(m.available == 13);
    const auto first = m.shape(4);  // alone, before the others
    CHECK(m.shapes().row(4).transpose() == first);
    for (Index j = 0; j < m.size(); ++j) {
        const auto& nodes = m.nodes()[static_cast<std::size_t>(j)];
        const auto offset = m.shape(j);
        Index changes = 0;
        for (Index pin = 0; pin + 1 < offset.size(); ++pin) {
            if (offset[pin] * offset[pin + 1] >= 0) continue;
            const double share = offset[pin] / (offset[pin] - offset[pin + 1]);
            REQUIRE(changes < nodes.size());
            CHECK(std::abs(nodes[changes] - (static_cast<double>(pin) + share) / 12) < 1e-15);
            ++changes;
        }
        CHECK(changes == nodes.size());
    }
    CHECK_THROWS_AS(m.shape(10), InvalidArgument);
}
