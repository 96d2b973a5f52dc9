// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §6: one compound link, and one on a thread (a boat on its davits, a bag in a hand).
#include "paper.hpp"
#include "revchain/linear/count.hpp"

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
        paper::check_heights(revchain::modes(chain), {l});
        CHECK(revchain::count_modes(chain, static_cast<T>(l * Quad(1.001))) == 0);
        CHECK(revchain::count_modes(chain, static_cast<T>(l * Quad(0.999))) == 1);
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
        const auto m = revchain::modes(Chain<T>({from_L}));
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
        const auto m = revchain::modes(davit.chain());
        paper::check_heights(
            m, paper::roots(link.l + a, a * link.rho2 / link.h, (link.l - a) * (link.l - a) + 4 * a * link.h));
    }
}

TEMPLATE_TEST_CASE("§6 (11): a plummet on a thread has one mode, lambda = a + l", "[paper][section_6]", float, double,
                   long double) {
    using T = TestType;
    const Chain<T> chain({plummet<T>(T(3), T(0.75)), plummet<T>(T(0), T(0.5))});
    REQUIRE(chain.mode_count() == 1);
    paper::check_heights(revchain::modes(chain), {Quad(1.25)});
}

TEST_CASE("§6 (2), (5), (7)-(9): the construction of Fig. 7 on the computed shape", "[paper][section_6]") {
    paper::Random random(607);
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        const auto davit = random_davit<double>(random);
        const auto [W, length, h, l, rho2] = paper::letters(davit.link);
        const Quad a = davit.thread;
        const auto m = revchain::modes(davit.chain());
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
        const auto m = revchain::modes(davit.chain());
        const double l = revchain::pendulum_length(davit.link);
        CHECK(m.conical_height[0] > std::max(l, davit.thread));
        if (m.size() == 2) CHECK(m.conical_height[1] < std::min(l, davit.thread));
    }
}
