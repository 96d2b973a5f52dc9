// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §8: jointed links, every equation with sec delta = 1. At finite inclinations: section_8_finite.cpp.
#include <functional>

#include "revchain/linear/assembly.hpp"
#include "revchain/recurrence.hpp"
#include "section_8.hpp"

using paper::Index;
using paper::Letters;
using paper::Quad;
using revchain::Chain;
using revchain::compound_pendulum;
using revchain::Link;
using namespace paper::section_8;

namespace {

/// Any offsets that satisfy (10), so that y_0 may be eliminated as the paper does; the support on the axis.
Offsets random_offsets(paper::Random& random, const Letterses& link, Quad lambda) {
    Offsets y(link.size());
    for (std::size_t m = 1; m + 1 < y.size(); ++m) y[m] = random.between(-1, 1);
    if (y.size() == 2) {
        y[0] = random.between(-1, 1);  // one link: y_1 = 0, (10) is its equation
    } else {
        y[0] = y[1] * (1 + link[1].a / (lambda - link[1].l));
    }
    return y;
}

/// For random chains of 1 to 8 links, offsets tied by (10) and heights not too near l_1.
void for_random_chains(const std::function<void(const Chain<double>&, const Letterses&, Quad, const Offsets&)>& check) {
    paper::Random random(800);
    for (Index size = 1; size <= 8; ++size) {
        for (int i = 0; i < 25; ++i) {
            const auto chain = paper::random_chain<double>(random, size);
            const auto link = paper::letters(chain);
            const Quad lambda = link[1].l * Quad(random.between(0, 1) < 0.5 ? random.log_between(0.01, 0.9)
                                                                            : random.log_between(1.1, 100.0));
            check(chain, link, lambda, random_offsets(random, link, lambda));
        }
    }
}

const double ulp = std::numeric_limits<double>::epsilon();

}  // namespace

TEST_CASE("§8 (1): k^2 = h (l - h)", "[paper][section_8]") {
    // Erratum: P_m G_m . G_m P_{m-1} = h (a - h) is printed as equal to it; it is when L lies at the lower pin, l = a.
    for (const double l : {0.75, 1.0, 1.25}) {
        const auto link =
            compound_pendulum<double>({.weight = 1.0, .length = 1.0, .centroid = 0.625, .pendulum_length = l});
        CHECK(static_cast<double>(link.gyration_ratio) == 0.625 * (l - 0.625));
        CHECK((static_cast<double>(link.gyration_ratio) == 0.625 * (1.0 - 0.625)) == (l == 1.0));
        CHECK(revchain::pendulum_length(link) == l);
        const double k = revchain::radius_of_gyration(link);
        CHECK(k == std::sqrt(0.625 * (l - 0.625)));
    }
}

TEST_CASE("§8 (2)-(5), (10): the lowest link, y_1 = (lambda - l_1) delta_1", "[paper][section_8]") {
    paper::Random random(805);
    double worst = 0;
    for (Index size = 2; size <= 6; ++size) {
        for (int i = 0; i < 20; ++i) {
            const auto chain = paper::random_chain<double>(random, size);
            const auto link = paper::letters(chain);
            const auto modes = revchain::modes(chain, {.count = revchain::all_modes});
            for (Index k = 0; k < modes.size(); ++k) {
                const auto y = paper::offsets(modes, k);
                const Quad lambda = modes.conical_height[k];
                const auto [W, a, h, l, rho2] = link[1];
                // (4): CP = lambda - l, and with (5) the reaction at P_1 leans by phi = (y_1 + h delta)/lambda
                worst =
                    std::max(worst, paper::imbalance({{1, y[1]}, {(l - lambda) / a, y[0]}, {-(l - lambda) / a, y[1]}}));
            }
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 0.7);  // ulp of the largest offset; measured 0.57
}

TEST_CASE("§8 (7)-(9), (11), (18): the moments add up to (12), (19), (21)", "[paper][section_8]") {
    Quad worst = 0, least_printed_18 = 1;
    for_random_chains([&](const Chain<double>& chain, const Letterses& link, Quad lambda, const Offsets& y) {
        for (Index m = 2; m <= chain.size(); ++m) {
            Quad sum = own_moment(link, m, lambda, y);
            for (Index r = 1; r < m; ++r) sum += moment_below(link, m, r, lambda, y);
            const Balance b = relation(link, m, lambda, y);
            const Quad factor = lambda / link[at(m)].a;  // "multiplying by lambda/a_m"
            worst = std::max(worst, fabsq(sum * factor - b.sum) / b.size);
            if (m == 3) {  // erratum in (18): the second line ends in - W_3 (y_2 - y_3) for - W_2 (y_2 - y_3)
                const Quad printed = sum + (link[2].W - link[3].W) * (y[2] - y[3]);
                least_printed_18 = std::min(least_printed_18, fabsq(printed * factor - b.sum) / b.size);
            }
        }
    });
    CAPTURE(static_cast<double>(worst * Quad(1e34)), static_cast<double>(least_printed_18));
    CHECK(worst < Quad(1e-33));                           // an identity; measured 9e-34
    CHECK(static_cast<double>(least_printed_18) > 5e-5);  // measured 6.5e-5, where W_2 and W_3 happen to be near
}

TEST_CASE("§8 (10), (12), (19), (21): recurrence_matrices is the relation coded by hand", "[paper][section_8]") {
    Quad worst = 0;
    for_random_chains([&](const Chain<double>& chain, const Letterses& link, Quad lambda, const Offsets& y) {
        const auto pencil = revchain::recurrence_matrices(chain);
        for (Index m = 1; m <= chain.size(); ++m) {
            Quad sum = 0, size = 0;
            for (Index column = 0; column < chain.size(); ++column) {
                const Quad a = pencil.A(m - 1, column) * y[at(column)],
                           b = lambda * pencil.B(m - 1, column) * y[at(column)];
                sum += a - b;
                size += fabsq(a) + fabsq(b);
            }
            worst = std::max(worst, fabsq(sum - relation(link, m, lambda, y).sum) / size / ulp);
        }
    });
    CAPTURE(static_cast<double>(worst));
    CHECK(worst <= 4);  // ulp of the terms; measured 3.01
}

TEST_CASE("§8 (21): it is a row summation of the element pencil", "[paper][section_8]") {
    Quad worst = 0;
    for_random_chains([&](const Chain<double>& chain, const Letterses& link, Quad lambda, const Offsets& y) {
        const auto assembled = revchain::assemble(chain);
        const Quad unit = scalbnq(Quad(1), assembled.units.weight_exponent);
        const Quad height = scalbnq(lambda, -assembled.units.length_exponent);
        Quad sum = 0;         // rows 0 ... m - 1 of (lambda K - M) y
        Quad from_below = 0;  // what the element below puts on the pin both share
        for (Index m = 1; m <= chain.size(); ++m) {
            const auto& e = assembled.pencil.elements[at(m - 1)];
            const Quad k = height * support::quad(e.stiffness), A = support::quad(e.lower), B = support::quad(e.upper);
            const Quad X = (Quad(e.weight) - A - B) / 2, lower = y[at(m - 1)], upper = y[at(m)];
            sum += from_below + k * (lower - upper) - A * lower - X * upper;
            from_below = k * (upper - lower) - X * lower - B * upper;
            const Balance b = relation(link, m, lambda, y);
            worst = std::max(worst, fabsq(sum * unit + b.sum) / b.size);
        }
    });
    CAPTURE(static_cast<double>(worst) * 1e30);
    CHECK(worst < Quad(5e-30));  // the entries are double words; measured 4.2e-30
}

TEST_CASE("§8 (21): the modes satisfy it as corrected, not as printed", "[paper][section_8]") {
    // h_{m-2}/a_{m-1} is printed for h_{m-2}/a_{m-2}: harmless while the lengths are equal, wrong from m = 4 on.
    paper::Random random(821);
    double worst = 0, worst_of_terms = 0, least_printed = 1, sum_printed = 0;
    int chains = 0;
    for (Index size = 4; size <= 8; ++size) {
        for (int i = 0; i < 20; ++i) {
            const auto chain = paper::random_chain<double>(random, size);
            const auto link = paper::letters(chain);
            const auto modes = revchain::modes(chain, {.count = revchain::all_modes});
            double printed = 0;
            for (Index k = 0; k < modes.size(); ++k) {
                const auto y = paper::offsets(modes, k);
                const Quad lambda = modes.conical_height[k];
                for (Index m = 3; m <= size; ++m) {
                    const Balance b = relation_21(link, m, lambda, y, Form::with_y_0);
                    const Balance moved = relation_21(link, m, lambda * (1 + Quad(0x1p-53)), y, Form::with_y_0);
                    const Quad left = fabsq(b.sum) - fabsq(moved.sum - b.sum);  // by half an ulp of the height
                    worst = std::max(worst, static_cast<double>(left / b.coefficients) * 0x1p52);
                    worst_of_terms = std::max(worst_of_terms, static_cast<double>(left / b.size) * 0x1p53);
                }
                if (fabsq(lambda - link[1].l) < link[1].l / 100) continue;
                for (Index m = 4; m <= size; ++m) {
                    const Balance b = relation_21(link, m, lambda, y, Form::printed);
                    printed = std::max(printed, static_cast<double>(fabsq(b.sum) / b.size));
                }
            }
            least_printed = std::min(least_printed, printed);
            sum_printed += printed;
            ++chains;
        }
    }
    CAPTURE(worst, worst_of_terms, least_printed, sum_printed / chains);
    CHECK(worst <= 0.25);                // ulp of the largest offset: half an ulp of those below 1
    CHECK(worst_of_terms <= 1);          // half an ulp of each offset
    CHECK(least_printed > 0.001);        // measured 0.002: a chain whose lengths differ little
    CHECK(sum_printed / chains > 0.35);  // of the terms; measured 0.38
}

TEMPLATE_TEST_CASE("§8 (13), (14): two links", "[paper][section_8]", float, double, long double) {
    using T = TestType;
    paper::Random random(814);
    int hung_above = 0;
    for (int i = 0; i < 300; ++i) {
        const Link<T> lower = paper::random_link<T>(random);
        Link<T> upper = paper::random_link<T>(random);
        if (i % 3 == 0) {  // a bell: centroid above its pin
            upper.centroid = static_cast<T>(-0.3 * random()) * upper.length;
            upper.weight *= T(0.3);
        }
        const auto [W1, a1, h1, l1, rho1] = paper::letters(lower);
        const auto [W2, a2, h2, l2, rho2] = paper::letters(upper);
        const Quad m = W2 * h2 / (W1 * a2);
        if (m < Quad(-0.5)) continue;
        hung_above += h2 < 0;
        // (14) expanded; m l_2 = W_2 (h_2^2 + k_2^2)/(W_1 a_2), and no term of the discriminant is negative
        const Quad ml2 = W2 * (h2 * h2 + rho2) / (W1 * a2);
        const Quad b = (ml2 + a2) / (m + 1);
        const auto truth =
            paper::roots(l1 + b, (ml2 * l1 + a2 * (l1 - h1)) / (m + 1), (l1 - b) * (l1 - b) + 4 * a2 * h1 / (m + 1));
        for (const Quad& lambda : truth) {
            const Quad left = a2 * h1 / (lambda - l1), right = (m + 1) * (lambda - l2) + l2 - a2;
            if (fabsq(lambda - l1) > l1 / 1000)
                CHECK(fabsq(left - right) < 1e-28 * ((m + 1) * (lambda + fabsq(l2)) + fabsq(l2) + a2));
        }
        paper::check_heights(revchain::modes(Chain<T>({lower, upper}), {.count = revchain::all_modes}), truth);
    }
    CHECK(hung_above > 50);
}

TEMPLATE_TEST_CASE("§8 (15): two links, L_2 at the lower pin", "[paper][section_8]", float, double, long double) {
    using T = TestType;
    paper::Random random(815);
    for (int i = 0; i < 200; ++i) {
        const Link<T> lower = paper::random_link<T>(random);
        const T a = static_cast<T>(random.between(0.5, 1.5));
        const auto upper = compound_pendulum<T>({.weight = static_cast<T>(random.log_between(0.1, 10.0)),
                                                 .length = a,
                                                 .centroid = a * static_cast<T>(random.between(0.1, 1.0)),
                                                 .pendulum_length = a});
        const auto [W1, a1, h1, l1, rho1] = paper::letters(lower);
        const auto [W2, a2, h2, l2, rho2] = paper::letters(upper);
        const Quad share = l2 * h1 / (W2 * h2 / (W1 * a2) + 1);
        paper::check_heights(revchain::modes(Chain<T>({lower, upper}), {.count = revchain::all_modes}),
                             paper::roots(l1 + l2, l1 * l2 - share, (l1 - l2) * (l1 - l2) + 4 * share));
    }
}

namespace {

/// How far from one line the links of a two-link mode are: y_1/y_0 against a_2/(a_1 + a_2), in ulp.
double bend(const revchain::Modes<double>& m, Index k, const Letterses& link) {
    const Quad straight = link[2].a / (link[1].a + link[2].a);
    return static_cast<double>(fabsq(m.shapes()(k, 1) / Quad(m.shapes()(k, 0)) - straight) / straight) / ulp;
}

/// The mode whose height is nearest.
Index nearest(const revchain::Modes<double>& m, Quad height) {
    return fabsq(m.conical_height[0] - height) < fabsq(m.conical_height[1] - height) ? 0 : 1;
}

}  // namespace

TEST_CASE("§8 (16): a bell and its clapper in one line, h_1 = (m+1) l_1 + m (a_2 - l_2)", "[paper][section_8]") {
    // Numbers a double holds exactly: m = 1/2, l_1 = 1, a_2 = 1/4, l_2 = 7/4, so h_1 = 3/4.
    const Link<double> clapper =
        compound_pendulum<double>({.weight = 1.0, .length = 1.25, .centroid = 0.75, .pendulum_length = 1.0});
    const auto bell = [](double pendulum_length) {
        return compound_pendulum<double>(
            {.weight = 1.0, .length = 0.25, .centroid = 0.125, .pendulum_length = pendulum_length});
    };
    const Chain<double> chain({clapper, bell(1.75)});
    const auto modes = revchain::modes(chain, {.count = revchain::all_modes});
    const Index k = nearest(modes, 1.25);
    CHECK(modes.conical_height[k] == 1.25);  // lambda - l_1 = a_2
    CHECK(bend(modes, k, paper::letters(chain)) <= 1);
    // Any other bell rings.
    const Chain<double> other({clapper, bell(1.5)});
    const auto ringing = revchain::modes(other, {.count = revchain::all_modes});
    CHECK(bend(ringing, nearest(ringing, 1.25), paper::letters(other)) * ulp > 0.01);

    paper::Random random(816);
    double worst_height = 0, worst_bend = 0;
    for (int i = 0; i < 200; ++i) {
        const double W1 = random.between(0.5, 2.0), W2 = random.between(0.5, 2.0), a2 = random.between(0.1, 1.0);
        const double h2 = a2 * random.between(0.1, 0.5), l1 = random.between(0.5, 2.0), m = W2 * h2 / (W1 * a2);
        const double excess = l1 / m * random.between(0.05, 0.8);  // l_2 = l_1 + a_2 + excess keeps k_1 real
        const double l2 = l1 + a2 + excess, h1 = (m + 1) * l1 + m * (a2 - l2);
        const Chain<double> random_bell(
            {compound_pendulum<double>({.weight = W1, .length = 1.5 * h1, .centroid = h1, .pendulum_length = l1}),
             compound_pendulum<double>({.weight = W2, .length = a2, .centroid = h2, .pendulum_length = l2})});
        const auto m2 = revchain::modes(random_bell, {.count = revchain::all_modes});
        const Index straight = nearest(m2, Quad(l1) + a2);
        worst_height = std::max(worst_height, paper::error_in_ulp(m2.conical_height[straight], Quad(l1) + a2));
        worst_bend = std::max(worst_bend, bend(m2, straight, paper::letters(random_bell)));
    }
    CAPTURE(worst_height, worst_bend);
    CHECK(worst_height <= 1);  // h_1 is rounded, and what it is made of; measured 0.61
    CHECK(worst_bend <= 3);    // measured 2.5
}

TEST_CASE("§8 (17): a uniform rod hung at C and jointed at D, CG.CD = CA^2", "[paper][section_8]") {
    // Half the rod is the unit of length; G is its middle, C lies c above G, A is the end above C. Then D lies 1/c - 2
    // below G: within the rod when c > 1/3, "C must lie outside the middle third". The rest of the gloss is wrong: at
    // c = 0.45 D lies 0.22 below G, within the middle half; at c = 0.8 on the same side of G as C.
    double worst = 0, worst_height = 0;
    for (const double c : {0.34, 0.42, 0.45, 0.5, 0.6, 0.8, 0.9, 0.95}) {
        const Quad C = c, CA = 1 - C, CD = CA * CA / C, D = CD - C;  // (17); D below G
        const double below = static_cast<double>(1 - D);             // D to the lower end
        const double above = static_cast<double>(1 + D);             // A to D
        const Link<double> lower = revchain::uniform_rod<double>(below, below);
        const Link<double> upper = compound_pendulum<double>({.weight = above,
                                                              .length = static_cast<double>(CD),
                                                              .centroid = static_cast<double>((D - 1) / 2 + C),
                                                              .radius_of_gyration = above / std::sqrt(12.0)});
        const Chain<double> chain({lower, upper});
        const auto link = paper::letters(chain);
        // It is (16):
        const auto [W1, a1, h1, l1, rho1] = link[1];
        const auto [W2, a2, h2, l2, rho2] = link[2];
        const Quad m = W2 * h2 / (W1 * a2), m_l2 = W2 * (h2 * h2 + rho2) / (W1 * a2);
        CHECK(fabsq((m + 1) * l1 + m * a2 - m_l2 - h1) < 3e-14);
        // "L of the rod DB about D must be the centre of oscillation of the whole rod about C"
        const Quad whole = C + 1 / (3 * C);
        CHECK(fabsq(CD + l1 - whole) < 1e-15);
        const auto modes = revchain::modes(chain, {.count = revchain::all_modes});
        const Index k = nearest(modes, whole);
        INFO("c = " << c);
        worst_height = std::max(worst_height, paper::error_in_ulp(modes.conical_height[k], whole));
        worst = std::max(worst, bend(modes, k, link));
        CHECK((D < 0) == (c > 0.5));
        CHECK((fabsq(D) < Quad(0.5)) == (c > 0.4 && c < 2.0 / 3));
    }
    CAPTURE(worst, worst_height);
    CHECK(worst_height <= 1);  // measured 0.46
    CHECK(worst <= 0.8);       // measured 0.67
    CHECK(1 / 0.33 - 2 > 1);   // and C within the middle third has its D beyond the rod
}

TEMPLATE_TEST_CASE("§8 (20): three links, a cubic", "[paper][section_8]", float, double, long double) {
    using T = TestType;
    paper::Random random(820);
    for (int i = 0; i < 200; ++i) {
        const auto chain = paper::random_chain<T>(random, 3);
        const auto link = paper::letters(chain);
        const Polynomial cubic = cubic_20(link, {0, 1, 1, 1});
        REQUIRE(cubic.size() == 4);
        const auto m = revchain::modes(chain, {.count = revchain::all_modes});
        std::vector<Quad> truth;
        for (const T& height : m.conical_height) truth.push_back(root(cubic, Quad(height)));
        // Three different roots, and their sum: all of them are found
        CHECK(fabsq(truth[0] + truth[1] + truth[2] + cubic[2] / cubic[3]) < 1e-30 * truth[0]);
        CHECK(truth[0] > truth[1]);
        CHECK(truth[1] > truth[2]);
        paper::check_heights(m, truth);
    }
}

TEMPLATE_TEST_CASE("§8: links whose L is the lower pin are kinetically plummets at the pins", "[paper][section_8]",
                   float, double, long double) {
    using T = TestType;
    paper::Random random(822);
    for (Index size = 1; size <= 8; ++size) {
        // Lengths and weights of few bits, centroids at quarters: the plummets' weights are exact.
        std::vector<Link<T>> links, plummets;
        for (Index m = 0; m < size; ++m) {
            const T a = static_cast<T>(1 + int(4 * random())), weight = static_cast<T>(1 + int(16 * random()));
            const T share = static_cast<T>(1 + int(4 * random())) / T(4);  // h/a
            links.push_back(
                compound_pendulum<T>({.weight = weight, .length = a, .centroid = share * a, .pendulum_length = a}));
            plummets.push_back(revchain::plummet<T>(weight * share, a));
            if (m + 1 < size)
                plummets.push_back({weight * (T(1) - share), T(0), T(0), {}});  // goes to the next plummet
        }
        std::vector<Link<T>> merged;
        for (std::size_t i = 0; i < plummets.size(); i += 2) {
            merged.push_back(plummets[i]);
            if (i > 0) merged.back().weight += plummets[i - 1].weight;
        }
        const auto m = revchain::modes(Chain<T>(links), {.count = revchain::all_modes}),
                   p = revchain::modes(Chain<T>(merged), {.count = revchain::all_modes});
        REQUIRE(m.size() == p.size());
        for (Index k = 0; k < m.size(); ++k) {
            CHECK(m.conical_height[k] == p.conical_height[k]);
            for (Index pin = 0; pin <= size; ++pin)
                CHECK(std::abs(m.shapes()(k, pin) - p.shapes()(k, pin)) <= T(1) * revchain::epsilon<T>());  // measured
        }
    }
}
