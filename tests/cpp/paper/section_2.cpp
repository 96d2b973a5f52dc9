// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §2: two plummets on one thread. In the paper P_1 is the lower plummet, P_2 the upper, l_1 the thread
// between them, l_2 the one above; here these are links 1 and 2.
#include "paper.hpp"
#include "revchain/linear/assembly.hpp"

using paper::Quad;
using revchain::Chain;
using revchain::plummet;

namespace {

/// Lagrange's equation (5), solved: the discriminant (l_1 - l_2)^2 + 4 l_1 l_2 W_1/(W_1 + W_2) is a sum of positives.
std::vector<Quad> lagrange(Quad W1, Quad l1, Quad W2, Quad l2) {
    const Quad share = W1 / (W1 + W2);
    return paper::roots(l1 + l2, l1 * l2 * W2 / (W1 + W2), (l1 - l2) * (l1 - l2) + 4 * l1 * l2 * share);
}

template <class T>
Chain<T> two_plummets(T W1, T l1, T W2, T l2) {
    return Chain<T>({plummet<T>(W1, l1), plummet<T>(W2, l2)});
}

}  // namespace

TEMPLATE_TEST_CASE("§2 (5): Lagrange's quadratic for two plummets", "[paper][section_2]", float, double, long double) {
    using T = TestType;
    paper::Random random(205);
    for (int i = 0; i < 500; ++i) {
        const T W1 = static_cast<T>(random.log_between(1e-6, 1e6)), W2 = static_cast<T>(random.log_between(1e-6, 1e6));
        const T l1 = static_cast<T>(random.log_between(1e-3, 1e3)), l2 = static_cast<T>(random.log_between(1e-3, 1e3));
        paper::check_heights(revchain::modes(two_plummets(W1, l1, W2, l2)), lagrange(W1, l1, W2, l2));
    }
}

TEST_CASE("§2 (1)-(3): the construction of Fig. 3 on the computed shape", "[paper][section_2]") {
    paper::Random random(203);
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        const double W1 = random.log_between(0.1, 10.0), W2 = random.log_between(0.1, 10.0);
        const double l1 = random.log_between(0.3, 3.0), l2 = random.log_between(0.3, 3.0);
        const auto m = revchain::modes(two_plummets(W1, l1, W2, l2));
        for (paper::Index k = 0; k < 2; ++k) {
            const Quad lambda = m.conical_height[k];
            const auto y = paper::offsets(m, k);  // y[0] of P_1, y[1] of P_2
            const Quad GP2 = Quad(W1) / (Quad(W1) + W2) * l1;
            const auto note = [&](std::initializer_list<std::pair<Quad, Quad>> terms) {
                worst = std::max(worst, paper::imbalance(terms));
            };
            // (1): N_1 C_1 = lambda, where the slope of the lower thread is (y_0 - y_1)/l_1
            note({{1, y[0]}, {-lambda / l1, y[0]}, {lambda / l1, y[1]}});
            // (1): H K = lambda, G the centre of gravity, y_1/l_2 the slope of the upper thread
            note({{W1 / (Quad(W1) + W2), y[0]}, {W2 / (Quad(W1) + W2), y[1]}, {-lambda / l2, y[1]}});
            // (2): C_1 P_2 = lambda - l_1
            note({{1, y[1]}, {-(lambda - l1) / l1, y[0]}, {(lambda - l1) / l1, y[1]}});
            // (3): P_2 E / G P_2 = P_2 C_2 / C_1 P_2, multiplied out, with P_2 E = lambda - l_2 from (2)
            note({{lambda * lambda, 1}, {-lambda * l1, 1}, {-lambda * l2, 1}, {Quad(l1) * l2, 1}, {-GP2 * l2, 1}});
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 0.45);  // measured 0.40
}

TEMPLATE_TEST_CASE("§2 (6): the worked examples", "[paper][section_2]", float, double, long double) {
    using T = TestType;
    const Quad half_root_2 = sqrtq(Quad(2)) / 2, third_root_3 = sqrtq(Quad(3)) / 3;
    // W_2 = 2 W_1, x = +-a/2 (l_1 = a + x, l_2 = a - x, a = 1 half the thread): lambda/a = 1 +- sqrt(2)/2
    paper::check_heights(revchain::modes(two_plummets(T(1), T(1.5), T(2), T(0.5))), {1 + half_root_2, 1 - half_root_2});
    paper::check_heights(revchain::modes(two_plummets(T(1), T(0.5), T(2), T(1.5))), {1 + half_root_2, 1 - half_root_2});
    // the same weights, x = 0: 1 +- sqrt(3)/3
    paper::check_heights(revchain::modes(two_plummets(T(1), T(1), T(2), T(1))), {1 + third_root_3, 1 - third_root_3});
    // W_2 = 3 W_1, x = 0: 3a/2 and a/2, exactly
    const auto m = revchain::modes(two_plummets(T(1), T(1), T(3), T(1)));
    paper::check_heights(m, {Quad(1.5), Quad(0.5)});
}

TEMPLATE_TEST_CASE("§2 (6): (lambda - a)^2 = (mu a^2 + x^2)/(1 + mu), periods at x = 0 as sqrt(1+mu) + sqrt(mu)",
                   "[paper][section_2]", float, double, long double) {
    using T = TestType;
    double worst = 0;
    for (const T mu : {T(1e-3), T(0.25), T(1) / T(3), T(0.5), T(1), T(2), T(1e3)}) {
        const Quad ratio = sqrtq(1 + Quad(mu)) + sqrtq(Quad(mu));
        const auto middle = revchain::modes(two_plummets(mu, T(1), T(1), T(1)));
        const Quad reach = sqrtq(Quad(mu) / (1 + Quad(mu)));
        paper::check_heights(middle, {1 + reach, 1 / (1 + Quad(mu)) / (1 + reach)});
        const auto period = middle.period();
        worst = std::max(worst, paper::error_in_ulp(static_cast<T>(period[0] / period[1]), ratio));
        // "is least": whatever the place x of the upper plummet, the two heights keep at least that far apart
        for (const T x : {T(-0.9375), T(-0.5), T(-0.0625), T(0.0625), T(0.5), T(0.9375)}) {
            const auto m = revchain::modes(two_plummets(mu, T(1) + x, T(1), T(1) - x));
            paper::check_heights(m, lagrange(mu, T(1) + x, T(1), T(1) - x));
            const auto p = m.period();
            CHECK(p[0] / p[1] > period[0] / period[1]);
            CHECK(m.conical_height[0] - m.conical_height[1] > middle.conical_height[0] - middle.conical_height[1]);
            const Quad from_middle = m.conical_height[0] - Quad(1);
            const Quad square = (Quad(mu) + Quad(x) * x) / (1 + Quad(mu));
            // lambda - a loses what lambda, of order 2 at most, was rounded by
            CHECK(fabsq(from_middle * from_middle - square) <= 2 * from_middle * 2 * revchain::epsilon<T>());
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 1.3);  // measured 1.16
}

TEST_CASE("§2 text: two springs, of strengths W_1/l_1 and (W_1 + W_2)/l_2", "[paper][section_2]") {
    // Erratum: the upper one is printed as W_2/l_2, but it carries both weights.
    const double W1 = 1.0, l1 = 1.5, W2 = 2.0, l2 = 0.5;
    const auto chain = revchain::assemble(two_plummets(W1, l1, W2, l2));
    const double unit = std::ldexp(1.0, chain.units.weight_exponent - chain.units.length_exponent);
    CHECK(static_cast<double>(chain.pencil.elements[0].stiffness) * unit == W1 / l1);
    CHECK(static_cast<double>(chain.pencil.elements[1].stiffness) * unit == (W1 + W2) / l2);

    // Railway carriages W_1 and W_2 on springs k_1 (between) and k_2 (to the buffer stop): both equations of motion give
    // (k_1 lambda - W_1)((k_1 + k_2) lambda - W_2) = k_1^2 lambda^2, with lambda = g/n^2.
    const auto discord = [&](double k2, Quad lambda) {
        const Quad k1 = Quad(W1) / l1;
        return fabsq((k1 * lambda - W1) * ((k1 + k2) * lambda - W2) - k1 * k1 * lambda * lambda);
    };
    for (const Quad& lambda : lagrange(W1, l1, W2, l2)) {
        CHECK(discord((W1 + W2) / l2, lambda) < Quad(1e-32));
        CHECK(discord(W2 / l2, lambda) > Quad(0.1));  // as printed
    }
}
