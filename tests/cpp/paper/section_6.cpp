// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §6: one compound link, and one on a thread (a boat on its davits, a bag in a hand).
#include "paper.hpp"
#include "revchain/count.hpp"
#include "revchain/two_links.hpp"

using paper::Index;
using paper::Letters;
using paper::Quad;
using revchain::Chain;
using revchain::compound_pendulum;
using revchain::Link;
using revchain::plummet;

TEMPLATE_TEST_CASE("§6 (1): a compound link turns like a plummet at L, and stays vertical till lambda < l",
                   "[paper][section_6]", float, double, long double) {
    using T = TestType;
    paper::Random random(601);
    for (int i = 0; i < 200; ++i) {
        const Link<T> link = paper::random_link<T>(random);
        const auto [W, a, h, l, rho2] = paper::letters(link);
        const Chain<T> chain({link});
        paper::check_heights(revchain::modes(chain, {.count = revchain::all_modes}), {l});
        CHECK(revchain::count_modes(chain, {.conical_height = static_cast<T>(l * Quad(1.001))}) == 0);
        CHECK(revchain::count_modes(chain, {.conical_height = static_cast<T>(l * Quad(0.999))}) == 1);
        CHECK(paper::error_in_ulp(revchain::pendulum_length(link), l) <= 1.0);
    }
}

TEMPLATE_TEST_CASE("§6 (6): C and L are convertible, CG.GL = k^2", "[paper][section_6]", float, double, long double) {
    using T = TestType;
    paper::Random random(606);
    for (int i = 0; i < 200; ++i) {
        const T h = static_cast<T>(random.between(0.1, 1.0)), rho = static_cast<T>(random.between(0.0, 0.8));
        const auto from_C = compound_pendulum<T>({.weight = 1, .length = 1, .centroid = h, .radius_of_gyration = rho});
        const auto [W, a, CG, CL, k2] = paper::letters(from_C);
        CHECK(fabsq(CG * (CL - CG) - k2) <= 1e-33 * CL * CG);
        if (rho < T(0.01)) continue;  // L and G all but coincide
        // Hung from L, whose distance from G is l - h; rounding that distance moves l by as much at most
        const T GL = static_cast<T>(CL - CG);
        const auto from_L = compound_pendulum<T>({.weight = 1, .length = 1, .centroid = GL, .radius_of_gyration = rho});
        const auto m = revchain::modes(Chain<T>({from_L}), {.count = revchain::all_modes});
        paper::check_heights(m, {paper::letters(from_L).l});
        const Quad change = fabsq(1 - k2 / (Quad(GL) * GL)) * fabsq(GL - (CL - CG));
        CHECK(fabsq(m.conical_height[0] - CL) <= 1.01 * change + CL * revchain::epsilon<T>());
    }
}

namespace {

/// A link (weight, centroid, rho) on a massless thread of length a.
template <class T>
struct Davit {
    Link<T> link;
    T thread;
    Chain<T> chain() const { return Chain<T>({link, plummet<T>(T(0), thread)}); }
};

template <class T>
Davit<T> random_davit(paper::Random& random) {
    const Link<T> link = paper::random_link<T>(random);
    return {link, static_cast<T>(random.log_between(0.01, 100.0))};
}

}  // namespace

TEMPLATE_TEST_CASE("§6 (10), (11): a link on a thread has two modes, (lambda - l)(lambda - a) = a h",
                   "[paper][section_6]", float, double, long double) {
    using T = TestType;
    paper::Random random(611);
    for (int i = 0; i < 500; ++i) {
        const auto davit = random_davit<T>(random);
        const Letters link = paper::letters(davit.link);
        const Quad a = davit.thread;
        if (link.rho2 == 0) continue;
        REQUIRE(davit.chain().mode_count() == 2);  // the thread is massless, but the link's inertia holds both its pins
        const auto m = revchain::modes(davit.chain(), {.count = revchain::all_modes});
        paper::check_heights(
            m, paper::roots(link.l + a, a * link.rho2 / link.h, (link.l - a) * (link.l - a) + 4 * a * link.h));
    }
}

TEMPLATE_TEST_CASE("§6 (11): a plummet on a thread has one mode, lambda = a + l", "[paper][section_6]", float, double,
                   long double) {
    using T = TestType;
    const Chain<T> chain({plummet<T>(T(3), T(0.75)), plummet<T>(T(0), T(0.5))});
    REQUIRE(chain.mode_count() == 1);
    paper::check_heights(revchain::modes(chain, {.count = revchain::all_modes}), {Quad(1.25)});
}

TEST_CASE("§6 (2), (5), (7)-(9): the construction of Fig. 7 on the computed shape", "[paper][section_6]") {
    paper::Random random(607);
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        const auto davit = random_davit<double>(random);
        const auto [W, length, h, l, rho2] = paper::letters(davit.link);
        const Quad a = davit.thread;
        const auto m = revchain::modes(davit.chain(), {.count = revchain::all_modes});
        for (Index k = 0; k < m.size(); ++k) {
            const auto y = paper::offsets(m, k);  // y[0] the link's lower end, y[1] its pin D, y[2] = 0 the point O
            const Quad lambda = m.conical_height[k], A = 1 / length;
            const auto note = [&](std::initializer_list<std::pair<Quad, Quad>> terms) {
                worst = std::max(worst, paper::imbalance(terms));
            };
            // (8): the link's line meets the axis at C, CD = lambda - l: y_1 = (lambda - l) delta, delta = (y_0 - y_1)/length
            note({{1, y[1]}, {(l - lambda) * A, y[0]}, {-(l - lambda) * A, y[1]}});
            // (2), (5), (9): OF = lambda: the thread, at phi = y_1/a, points at E, level with... the C.F. through G's offset
            // y_1 + h delta = lambda phi
            note({{1, y[1]}, {h * A, y[0]}, {-h * A, y[1]}, {-lambda / a, y[1]}});
            // (7): OD/CD = DE/DG with DE = lambda - a, DG = h
            note({{a * h, 1}, {-lambda * lambda, 1}, {lambda * (l + a), 1}, {-l * a, 1}});
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 1.3);  // ulp of the largest offset; measured 1.22
}

TEST_CASE("§6: at lambda - l small the bag follows the hand no more: the two heights keep apart",
          "[paper][section_6]") {
    // (lambda - l)(lambda - a) = a h > 0: one root above both l and a, one below both.
    paper::Random random(612);
    for (int i = 0; i < 200; ++i) {
        const auto davit = random_davit<double>(random);
        const auto m = revchain::modes(davit.chain(), {.count = revchain::all_modes});
        const double l = revchain::pendulum_length(davit.link);
        CHECK(m.conical_height[0] > std::max(l, davit.thread));
        if (m.size() == 2) CHECK(m.conical_height[1] < std::min(l, davit.thread));
    }
}

namespace {

template <class T>
revchain::CompoundLink<T> random_body(paper::Random& random) {
    const double h = random.log_between(1e-3, 1e3);
    return {static_cast<T>(h), static_cast<T>(h * random.log_between(1e-3, 1e3))};
}

}  // namespace

TEMPLATE_TEST_CASE("§6 (11)-(13): links on threads, hanging and standing, over twelve decades", "[paper][section_6]",
                   float, double, long double) {
    using T = TestType;
    paper::Random random(613);
    double hanging = 0, standing = 0, thread = 0, back = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto link = random_body<T>(random);
        const T a = static_cast<T>(random.log_between(1e-6, 1e6));
        const Quad h = link.centroid, rest = Quad(link.radius_of_gyration) * link.radius_of_gyration / h, l = h + rest,
                   A = a;
        const auto found = revchain::link_on_thread(a, link);
        const Quad half = (l - A) / 2, root = sqrtq(half * half + A * h), larger = (l + A) / 2 + root;
        hanging = std::max(
            {hanging, paper::error_in_ulp(found[0], larger), paper::error_in_ulp(found[1], A * rest / larger)});
        // lambda^2 + (l - a) lambda - a k^2/h = 0
        const Quad wide = sqrtq(half * half + A * rest), height = half > 0 ? A * rest / (half + wide) : wide - half;
        const T stands = revchain::standing_link(a, link);
        standing = std::max(standing, paper::error_in_ulp(stands, height));
        const Quad L = stands;
        const T needs = revchain::thread_of_standing_link(stands, link);
        thread = std::max(thread, paper::error_in_ulp(needs, L * (l + L) / (rest + L)));
        // there and back, in the thread given: d ln a / d ln lambda stays between 1 and 2
        back = std::max(back, paper::error_in_ulp(needs, A));
    }
    CAPTURE(hanging, standing, thread, back);
    CHECK(hanging <= 2.0);
    CHECK(standing <= 2.4);
    CHECK(thread <= 1.8);
    CHECK(back <= 2.2);
    // (13), a uniform rod of length 2h: a = lambda (4h/3 + lambda)/(h/3 + lambda)
    const T h = T(1.5), lambda = T(0.7);
    const revchain::CompoundLink<T> rod{h, h / std::sqrt(T(3))};
    CHECK(paper::error_in_ulp(revchain::thread_of_standing_link(lambda, rod),
                              Quad(lambda) * (2 + Quad(lambda)) / (Quad(0.5) + Quad(lambda))) <= 3);
}

TEMPLATE_TEST_CASE("§6 (10): every hanging figure of a link on a thread, and the standing one", "[paper][section_6]",
                   float, double, long double) {
    using T = TestType;
    paper::Random random(614);
    double worst = 0;
    std::array<int, 5> seen{};
    int standing = 0;
    for (int i = 0; i < 2000; ++i) {
        const T h = static_cast<T>(random.log_between(0.01, 100.0));
        const revchain::CompoundLink<T> link{h, static_cast<T>(h * random.log_between(0.1, 10.0))};
        const T a = static_cast<T>(random.log_between(0.01, 100.0));
        const auto linear = revchain::link_on_thread(a, link);
        const T height = static_cast<T>(linear[0] * random.log_between(1e-4, 1.5));
        const Quad lambda = height, H = h, A = a, k2 = Quad(link.radius_of_gyration) * link.radius_of_gyration,
                   l = H + k2 / H;
        // Forces and moments of the body, with the weight as unit: outwards at its centroid (a sin p + h sin d)/lambda.
        const auto check = [&](const revchain::PairShape<T>& shape, Quad up) {
            const Quad td = Quad(shape.offset[0]) / lambda,
                       sp = Quad(shape.offset[1]) / A;  // offset of L is lambda tan d
            const Quad sd = td / sqrtq(1 + td * td), cd = up / sqrtq(1 + td * td), cp = 1 / Quad(shape.tension[1]);
            const Quad across = A * sp + up * H * sd - lambda * sp / cp;  // = lambda tan phi
            const Quad size = A * fabsq(sp) + H * fabsq(sd) + lambda * fabsq(sp / cp);
            // about the joint: C.F. W (a sin p + l sin d)/lambda of the particle h/l at L, and its weight
            const Quad moment = (A * sp + up * l * sd) / lambda * cd - up * sd;
            const Quad moment_size = (A * fabsq(sp) + l * fabsq(sd)) / lambda * fabsq(cd) + fabsq(sd);
            worst = std::max(worst, static_cast<double>(std::max(fabsq(across) / size, fabsq(moment) / moment_size)) /
                                        static_cast<double>(revchain::epsilon<T>()));
        };
        const auto shapes = revchain::link_on_thread_shapes(a, link, height);
        ++seen[shapes.size()];
        for (const auto& shape : shapes) check(shape, 1);
        const auto stands = revchain::standing_link_shape(a, link, height);
        CHECK(stands.has_value() == (height < revchain::standing_link(a, link)));
        standing += stands.has_value();
        if (stands) check(*stands, -1);
    }
    CAPTURE(worst, seen[0], seen[1], seen[2], seen[4], standing);
    CHECK(worst <= 4.4);
    CHECK(seen[1] > 50);
    CHECK(seen[2] > 50);
    CHECK(standing > 50);
}

TEST_CASE("§2 text and §6: a support that yields, and the clock that hangs from it", "[paper][section_6]") {
    paper::Random random(615);
    double worst = 0, conditioned = 0;
    for (int i = 0; i < 2000; ++i) {
        auto link = random_body<double>(random);
        if (i % 4 == 1) link.centroid = link.radius_of_gyration * random.log_between(1e-16, 1.0);
        const double near = 1 - random.log_between(1e-16, 1.0);
        const double c = link.pendulum_length() * (i % 2 == 0 ? random.log_between(1e-12, 10.0) : near);
        const Quad h = link.centroid, l = h + Quad(link.radius_of_gyration) * link.radius_of_gyration / h, C = c;
        const Quad half = (l - C) / 2, root = sqrtq(half * half + C * h);
        const Quad longer = half > 0 ? C * h / (half + root) : root - half, height = l + longer;
        const double condition = 1 + static_cast<double>(l / root);  // what rounded data leave
        const double error = paper::error_in_ulp(revchain::seconds_lost_per_day(c, link),
                                                 86400 * longer / (sqrtq(height) * (sqrtq(height) + sqrtq(l))));
        worst = std::max(worst, error), conditioned = std::max(conditioned, error / condition);
    }
    CAPTURE(worst, conditioned);
    CHECK(worst <= 3.5);
    CHECK(conditioned <= 1.3);
    // a plummet: exactly as if its thread were longer by the deflection, which the paper says of any pendulum
    const auto plummet = revchain::link_on_spring(0.25, {1.0, 0.0});
    CHECK(plummet[0] == 1.25);
    CHECK(plummet[1] == 0.0);
    const auto rod = revchain::link_on_spring(0.25, {1.0, 1.0});
    CHECK(std::abs(rod[0] - 2.25) > 0.1);
}

TEST_CASE("§6: what cannot be is refused", "[paper][section_6]") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, nan, inf}) {
        CHECK_THROWS_AS(revchain::link_on_thread<double>(1.0, {bad, 1.0}), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::standing_link<double>(bad, {1.0, 1.0}), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::thread_of_standing_link<double>(bad, {1.0, 1.0}), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::link_on_thread_shapes<double>(1.0, {1.0, 1.0}, bad), revchain::InvalidArgument);
    }
}
