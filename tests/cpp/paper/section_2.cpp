// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §2: two plummets on one thread. In the paper P_1 is the lower plummet, P_2 the upper, l_1 the thread
// between them, l_2 the one above; here these are links 1 and 2.
#include "paper.hpp"
#include "revchain/linear/assembly.hpp"
#include "revchain/two_links.hpp"

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
        paper::check_heights(revchain::modes(two_plummets(W1, l1, W2, l2), {.count = revchain::all_modes}),
                             lagrange(W1, l1, W2, l2));
    }
}

TEST_CASE("§2 (1)-(3): the construction of Fig. 3 on the computed shape", "[paper][section_2]") {
    paper::Random random(203);
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        const double W1 = random.log_between(0.1, 10.0), W2 = random.log_between(0.1, 10.0);
        const double l1 = random.log_between(0.3, 3.0), l2 = random.log_between(0.3, 3.0);
        const auto m = revchain::modes(two_plummets(W1, l1, W2, l2), {.count = revchain::all_modes});
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
    paper::check_heights(revchain::modes(two_plummets(T(1), T(1.5), T(2), T(0.5)), {.count = revchain::all_modes}),
                         {1 + half_root_2, 1 - half_root_2});
    paper::check_heights(revchain::modes(two_plummets(T(1), T(0.5), T(2), T(1.5)), {.count = revchain::all_modes}),
                         {1 + half_root_2, 1 - half_root_2});
    // the same weights, x = 0: 1 +- sqrt(3)/3
    paper::check_heights(revchain::modes(two_plummets(T(1), T(1), T(2), T(1)), {.count = revchain::all_modes}),
                         {1 + third_root_3, 1 - third_root_3});
    // W_2 = 3 W_1, x = 0: 3a/2 and a/2, exactly
    const auto m = revchain::modes(two_plummets(T(1), T(1), T(3), T(1)), {.count = revchain::all_modes});
    paper::check_heights(m, {Quad(1.5), Quad(0.5)});
}

TEMPLATE_TEST_CASE("§2 (6): (lambda - a)^2 = (mu a^2 + x^2)/(1 + mu), periods at x = 0 as sqrt(1+mu) + sqrt(mu)",
                   "[paper][section_2]", float, double, long double) {
    using T = TestType;
    double worst = 0;
    for (const T mu : {T(1e-3), T(0.25), T(1) / T(3), T(0.5), T(1), T(2), T(1e3)}) {
        const Quad ratio = sqrtq(1 + Quad(mu)) + sqrtq(Quad(mu));
        const auto middle = revchain::modes(two_plummets(mu, T(1), T(1), T(1)), {.count = revchain::all_modes});
        const Quad reach = sqrtq(Quad(mu) / (1 + Quad(mu)));
        paper::check_heights(middle, {1 + reach, 1 / (1 + Quad(mu)) / (1 + reach)});
        const auto period = middle.period();
        worst = std::max(worst, paper::error_in_ulp(static_cast<T>(period[0] / period[1]), ratio));
        // "is least": whatever the place x of the upper plummet, the two heights keep at least that far apart
        for (const T x : {T(-0.9375), T(-0.5), T(-0.0625), T(0.0625), T(0.5), T(0.9375)}) {
            const auto m = revchain::modes(two_plummets(mu, T(1) + x, T(1), T(1) - x), {.count = revchain::all_modes});
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

TEMPLATE_TEST_CASE("§2 (5): the quadratic without a chain, over twelve decades of every datum", "[paper][section_2]",
                   float, double, long double) {
    using T = TestType;
    paper::Random random(206);
    double worst = 0;
    for (int i = 0; i < 5000; ++i) {
        const T W1 = static_cast<T>(random.log_between(1e-6, 1e6)), W2 = static_cast<T>(random.log_between(1e-6, 1e6));
        const T l1 = static_cast<T>(random.log_between(1e-6, 1e6));
        const T l2 = i % 2 == 0 ? static_cast<T>(random.log_between(1e-6, 1e6))
                                : static_cast<T>(l1 * (1 + random.log_between(1e-12, 1.0)));
        const auto found = revchain::two_plummets(W1, l1, W2, l2);
        const auto truth = lagrange(W1, l1, W2, l2);
        for (std::size_t k = 0; k < 2; ++k) worst = std::max(worst, paper::error_in_ulp(found[k], truth[k]));
    }
    CAPTURE(worst);
    CHECK(worst <= 2.5);
    // at the ends of the range
    const T big = std::ldexp(T(1), std::numeric_limits<T>::max_exponent - 4),
            small = std::numeric_limits<T>::min() * 16;
    for (const T l : {big, small}) {
        const auto found = revchain::two_plummets(big, l, big, l), one = revchain::two_plummets(T(1), T(1), T(1), T(1));
        CHECK(found[0] == one[0] * l);
        CHECK(found[1] == one[1] * l);
    }
}

TEMPLATE_TEST_CASE("§2 (6): from the middle, and Stokes's float", "[paper][section_2]", float, double, long double) {
    using T = TestType;
    paper::Random random(207);
    double worst = 0;
    for (int i = 0; i < 5000; ++i) {
        const T a = static_cast<T>(random.log_between(1e-6, 1e6)),
                x = static_cast<T>(a * random.between(-0.999, 0.999));
        const T mu = static_cast<T>(random.log_between(1e-6, 1e6));
        const Quad A = a, X = x, M = mu, larger = A + sqrtq((M * A * A + X * X) / (1 + M));
        const auto found = revchain::two_plummets_from_the_middle(a, x, mu);
        worst = std::max({worst, paper::error_in_ulp(found[0], larger),
                          paper::error_in_ulp(found[1], (A - X) * (A + X) / (1 + M) / larger)});
    }
    CAPTURE(worst);
    CHECK(worst <= 2.2);
    // A float, mu < 0: real roots where |x| >= a sqrt(-mu) alone; at the limit both are a.
    const auto limit = revchain::two_plummets_from_the_middle(T(2), T(1), T(-0.25));
    CHECK(limit[0] == 2);
    CHECK(limit[1] == 2);
    for (const T x : {T(-1.5), T(1.25), T(1.75)}) {
        const auto found = revchain::two_plummets_from_the_middle(T(2), x, T(-0.25));
        for (const T height : found)
            CHECK(fabsq(Quad(height) * height - 4 * Quad(height) + (4 - Quad(x) * x) / Quad(0.75)) <=
                  Quad(64 * revchain::epsilon<T>()));
    }
    // next to the limit, where the heights depend on x as on a square root
    double edge = 0;
    for (int i = 0; i < 2000; ++i) {
        const T ratio = static_cast<T>(-random.log_between(1e-6, 0.999));
        const T x = static_cast<T>(std::sqrt(static_cast<double>(-ratio)) * (1 + random.log_between(1e-7, 1e-3)));
        if (!(x < 1)) continue;
        const Quad square = (Quad(x) * x + Quad(ratio)) / (1 + Quad(ratio));
        if (!(square > 0)) continue;
        const auto found = revchain::two_plummets_from_the_middle(T(1), x, ratio);
        edge = std::max(
            {edge, paper::error_in_ulp(found[0], 1 + sqrtq(square)),
             paper::error_in_ulp(found[1], (1 - Quad(x)) * (1 + Quad(x)) / (1 + Quad(ratio)) / (1 + sqrtq(square)))});
    }
    CAPTURE(edge);
    CHECK(edge <= 1.6);
    CHECK_THROWS_AS(revchain::two_plummets_from_the_middle(T(2), T(0.99), T(-0.25)), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::two_plummets_from_the_middle(T(2), T(0), T(-0.25)), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::two_plummets_from_the_middle(T(2), T(2), T(1)), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::two_plummets_from_the_middle(T(2), T(1), T(-1)), revchain::InvalidArgument);
}

namespace {

/// What (4) and its companion leave in units of the height: (A1 A2 - s l1 l2, A1 sin d1 - l2 sin d2), A = sec d - l, over
/// the sizes of their terms, for the tangents of a shape.
template <class T>
double imbalance_of(const revchain::PairShape<T>& shape, Quad l1, Quad l2, Quad coupling, T height) {
    const Quad t1 = Quad(shape.offset[0]) / height;  // lambda tan d1, the lowest offset
    // near the horizontal the tension tells more of the inclination than its own digits do
    const Quad d2 = shape.inclination[1], q = fabsq(d2) < 1 ? 1 / cosq(d2) : Quad(shape.tension[1]);
    const Quad t2 = fabsq(d2) < 1 ? tanq(d2) : copysignq(sqrtq((q - 1) * (q + 1)), d2);
    const Quad p = sqrtq(1 + t1 * t1);
    const Quad second = (p - l1) * t1 / p - l2 * t2 / q, size = (p + fabsq(l1)) * fabsq(t1 / p) + l2 * fabsq(t2 / q);
    // The product tells nothing that d1 and d2 together do not: moments about the joint and about the support.
    const Quad first = (p - l1) * (q - l2) - coupling, first_size = (p + fabsq(l1)) * (q + l2) + fabsq(coupling);
    return static_cast<double>(std::max(fabsq(first) / first_size, fabsq(second) / size));
}

/// How many hanging figures there are, counted another way: from the lowest inclination upwards, sec d2 from the balance of
/// all below, the support's offset changes its sign at every figure.
int figures_by_sweeping(double share, double l1, double l2) {
    using Long = long double;  // signs are all that is wanted
    const auto end = [&](Long t1) {
        const Long y0 = t1, y1 = y0 - l1 * t1 / std::sqrt(1 + t1 * t1);  // y0 = lambda tan d1, lambda = 1
        const Long t2 = share * y0 + (1 - share) * y1;
        return y1 - l2 * t2 / std::sqrt(1 + t2 * t2);
    };
    int count = 0;
    Long last = 0;
    const int steps = 40000;
    for (int i = 0; i <= steps; ++i) {  // d1 towards the vertical and the horizontal alike
        const Long t1 =
            std::exp(Long(-14) + Long(28) * i / steps + (i == steps ? 0 : std::log(Long(l1 + l2))) * i / steps);
        const Long now = end(t1);
        count += i > 0 && (now > 0) != (last > 0);
        last = now;
    }
    return count;
}

}  // namespace

TEMPLATE_TEST_CASE("§2 (4): every hanging figure of two plummets", "[paper][section_2]", float, double, long double) {
    using T = TestType;
    paper::Random random(208);
    double worst = 0;
    std::array<int, 5> seen{};
    for (int i = 0; i < 3000; ++i) {
        const T W1 = static_cast<T>(random.log_between(1e-3, 1e3)), W2 = static_cast<T>(random.log_between(1e-3, 1e3));
        const T l1 = static_cast<T>(random.log_between(1e-2, 1e2)), l2 = static_cast<T>(random.log_between(1e-2, 1e2));
        const auto linear = revchain::two_plummets(W1, l1, W2, l2);
        const T height = static_cast<T>(linear[0] * random.log_between(1e-4, 2.0));
        const auto shapes = revchain::two_plummets_shapes(W1, l1, W2, l2, height);
        ++seen[shapes.size()];
        const Quad share = Quad(W1) / (Quad(W1) + W2), m1 = Quad(l1) / height, m2 = Quad(l2) / height;
        int waves[2] = {0, 0};
        for (const auto& shape : shapes) {
            worst = std::max(worst, imbalance_of(shape, m1, m2, share * m1 * m2, height) /
                                        static_cast<double>(revchain::epsilon<T>()));
            ++waves[shape.half_waves() - 1];
            const Quad d1 = shape.inclination[0], d2 = shape.inclination[1];
            // what the rounding of d leaves of sec d: d tan d
            CHECK(paper::error_in_ulp(shape.tension[0], share / cosq(d1)) <= 4 + 1.6 * static_cast<double>(tanq(d1)));
            CHECK(paper::error_in_ulp(shape.tension[1], 1 / cosq(d2)) <=
                  4 + 1.6 * static_cast<double>(fabsq(tanq(d2))));
        }
        CHECK(waves[0] == (height < linear[0] ? 1 : 0));
        CHECK((waves[1] == (height < linear[1] ? 1 : 0) || (waves[1] == 3 && height < linear[1])));
    }
    CAPTURE(worst, seen[0], seen[1], seen[2], seen[4]);
    CHECK(worst <= 1.5);
    CHECK(seen[0] > 50);
    CHECK(seen[1] > 50);
    CHECK(seen[2] > 50);
    CHECK(seen[4] > 10);
}

TEST_CASE("§2 (4): as many figures as a sweep finds, four where the lower thread is long", "[paper][section_2]") {
    paper::Random random(209);
    int four = 0;
    for (int i = 0; i < 300; ++i) {
        const double share = random.between(0.02, 0.6), l1 = random.log_between(2.0, 100.0),
                     l2 = random.log_between(2.0, 100.0);
        const auto shapes = revchain::two_plummets_shapes(share, l1, 1 - share, l2, 1.0);
        CHECK(static_cast<int>(shapes.size()) == figures_by_sweeping(share, l1, l2));
        four += shapes.size() == 4;
    }
    CHECK(four > 10);
    // W = (1, 3), a = (2, 1), lambda = 1/64
    CHECK(revchain::two_plummets_shapes(1.0, 2.0, 3.0, 1.0, 1.0 / 64).size() == 4);
    // equal plummets on equal threads never have more than two
    for (const double height : {0.25, 0.1, 1e-3, 1e-6})
        CHECK(revchain::two_plummets_shapes(1.0, 1.0, 1.0, 1.0, height).size() == 2);
}

TEST_CASE("§2 (4): four figures however fast", "[paper][section_2]") {
    for (int e = 6; e < 300; e += 3) {
        const double height = std::ldexp(1.0, -e);
        CAPTURE(height);
        const auto shapes = revchain::two_plummets_shapes(1.0, 2.0, 3.0, 1.0, height);
        REQUIRE(shapes.size() == 4);
        for (const auto& shape : shapes)
            CHECK(imbalance_of(shape, Quad(2) / height, Quad(1) / height, Quad(0.5) / height / height, height) <=
                  4e-16);
    }
    CHECK_THROWS_AS(revchain::two_plummets_shapes(1.0, 2.0, 3.0, 1.0, 1e-150), revchain::InvalidArgument);
    CHECK(revchain::two_plummets_shapes(1.0, 2.0, 3.0, 1.0, 1e150).empty());
}

TEST_CASE("§2 (4): a figure that has just left the vertical is the mode", "[paper][section_2]") {
    paper::Random random(210);
    for (int i = 0; i < 100; ++i) {
        const double W1 = random.log_between(0.1, 10.0), W2 = random.log_between(0.1, 10.0);
        const double l1 = random.log_between(0.1, 10.0), l2 = random.log_between(0.1, 10.0);
        const auto m = revchain::modes(two_plummets(W1, l1, W2, l2), {.count = revchain::all_modes});
        for (paper::Index k = 0; k < 2; ++k) {
            const double height = m.conical_height[k] * (1 - 1e-8);
            const auto shapes = revchain::two_plummets_shapes(W1, l1, W2, l2, height);
            // the one of least inclination with k + 1 half waves
            const auto* shape = &shapes[0];
            for (const auto& other : shapes)
                if (other.half_waves() == k + 1 &&
                    (shape->half_waves() != k + 1 || other.inclination[0] < shape->inclination[0]))
                    shape = &other;
            REQUIRE(shape->half_waves() == k + 1);
            CHECK(shape->inclination[0] < 0.1);
            CHECK(std::abs(shape->offset[1] / shape->offset[0] - m.shapes()(k, 1) / m.shapes()(k, 0)) < 1e-5);
        }
    }
}

TEMPLATE_TEST_CASE("§2 (8): a plummet that stands above the other, small and at any inclination", "[paper][section_2]",
                   float, double, long double) {
    using T = TestType;
    paper::Random random(211);
    double linear = 0, worst = 0;
    int none = 0;
    for (int i = 0; i < 3000; ++i) {
        const T W1 = static_cast<T>(random.log_between(1e-3, 1e3)), W2 = static_cast<T>(random.log_between(1e-3, 1e3));
        const T l1 = static_cast<T>(random.log_between(1e-2, 1e2)), l2 = static_cast<T>(random.log_between(1e-2, 1e2));
        const Quad share = Quad(W1) / (Quad(W1) + W2), rest = Quad(W2) / (Quad(W1) + W2) * l1 * l2;
        const Quad half = (Quad(l1) - l2) / 2, root = sqrtq(half * half + rest);
        const T found = revchain::standing_plummet(W1, l1, W2, l2);
        linear = std::max(linear, paper::error_in_ulp(found, half > 0 ? rest / (half + root) : root - half));
        const T height = static_cast<T>(found * random.log_between(1e-3, 1.5));
        const auto shape = revchain::standing_plummet_shape(W1, l1, W2, l2, height);
        CHECK(shape.has_value() == (height < found));
        none += !shape;
        if (!shape) continue;
        // l1 turned round in (4)
        const Quad m1 = Quad(l1) / height, m2 = Quad(l2) / height;
        worst = std::max(worst, imbalance_of(*shape, -m1, m2, -share * m1 * m2, height) /
                                    static_cast<double>(revchain::epsilon<T>()));
        CHECK(shape->tension[0] < 0);
    }
    CAPTURE(linear, worst, none);
    CHECK(linear <= 2.2);
    CHECK(worst <= 1.4);
    CHECK(none > 100);
}

TEST_CASE("§2: what cannot be is refused", "[paper][section_2]") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, nan, inf}) {
        CHECK_THROWS_AS(revchain::two_plummets(bad, 1.0, 1.0, 1.0), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::two_plummets(1.0, 1.0, 1.0, bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::standing_plummet(1.0, bad, 1.0, 1.0), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::two_plummets_shapes(1.0, 1.0, 1.0, 1.0, bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::standing_plummet_shape(1.0, 1.0, bad, 1.0, 1.0), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::spring_deflection(1.0, bad), revchain::InvalidArgument);
    }
}
