// SPDX-License-Identifier: MPL-2.0
// Greenhill (1908) §8 at any inclination: every equation from (2) to (21), each with the secants of its own links, on all
// steady shapes of random chains at random speeds. Coded by hand in quadruple precision (section_8.hpp), and fed with the
// inclinations and offsets that the library gives out.
#include <functional>

#include "revchain/steady_shapes.hpp"
#include "revchain/two_links.hpp"
#include "section_8.hpp"

using paper::Index;
using paper::Letters;
using paper::Quad;
using revchain::Chain;
using revchain::compound_pendulum;
using revchain::Link;
using revchain::SteadyShape;
using namespace paper::section_8;

namespace {

/// A shape in the paper's letters. What is given is rounded: inclinations delta_1 ..., offsets y_0 ..., reactions phi_1 ...
struct Figure {
    Letterses link;
    Quad lambda;
    std::vector<Quad> delta, y, phi;

    Figure(const Chain<double>& chain, const SteadyShape& shape)
        : link(paper::letters(chain)), lambda(shape.conical_height), delta(1, 0), phi(1, 0) {
        for (Index m = 0; m < chain.size(); ++m) {
            delta.push_back(shape.inclination[m]);
            phi.push_back(shape.reaction_inclination[m]);
        }
        for (Index m = 0; m <= chain.size(); ++m) y.push_back(shape.offset[m]);
    }
    Index size() const { return static_cast<Index>(link.size()) - 1; }
    Quad sec(Index m) const { return 1 / cosq(delta[at(m)]); }
    Quad sin(Index m) const { return sinq(delta[at(m)]); }
    Slants slants() const {
        std::vector<Quad> slant(1, 0);
        for (Index m = 1; m <= size(); ++m) slant.push_back(lambda * sec(m));
        return Slants(slant);
    }
};

using Equation = std::function<Quad(const Figure&)>;

/// What an equation leaves, in ulp of the inclinations, offsets and reactions: 1 where each of them, changed by one ulp in
/// the worst direction, accounts for it. (Of the size of the terms it may be much: the secant of a link near the horizontal
/// knows few digits.)
double in_ulp(const Equation& equation, const Figure& figure) {
    const Quad left = equation(figure);
    const Quad step = 1e-11;
    Quad accounted = 0;
    Figure changed = figure;
    for (const auto member : {&Figure::delta, &Figure::y, &Figure::phi}) {
        for (Quad& x : changed.*member) {
            const Quad kept = x;
            x += step * x;
            accounted += fabsq(equation(changed) - left) / step;
            x = kept;
        }
    }
    if (left == 0) return 0;
    return static_cast<double>(fabsq(left) / accounted) / std::numeric_limits<double>::epsilon();
}

enum class Kind { plummets, rods, shorter, level, longer, mixed };  // of compound links: l < a, l = a, l > a

Link<double> random_link(paper::Random& random, Kind kind) {
    if (kind == Kind::mixed) kind = static_cast<Kind>(int(5 * random()));
    const double weight = random.log_between(0.1, 10.0), a = random.log_between(0.3, 3.0);
    if (kind == Kind::plummets) return revchain::plummet<double>(weight, a);
    if (kind == Kind::rods) return revchain::uniform_rod<double>(weight, a);
    const double l = kind == Kind::level     ? a
                     : kind == Kind::shorter ? a * random.between(0.4, 0.99)
                                             : a * random.between(1.01, 1.4);
    return compound_pendulum<double>(
        {.weight = weight, .length = a, .centroid = l * random.between(0.2, 0.95), .pendulum_length = l});
}

Chain<double> random_chain(paper::Random& random, Kind kind, Index size) {
    std::vector<Link<double>> links;
    for (Index m = 0; m < size; ++m) links.push_back(random_link(random, kind));
    return Chain<double>(links);
}

struct Shapes {
    Chain<double> chain;
    revchain::SteadyShapes found;
};

/// All shapes of chains of every kind, 1 to 8 links, at conical heights from the first of the chain to a hundredth of it.
const std::vector<Shapes>& random_shapes() {
    static const std::vector<Shapes> all = [] {
        paper::Random random(880);
        std::vector<Shapes> result;
        for (Index size = 1; size <= 8; ++size) {
            for (int i = 0; i < 24; ++i) {
                const auto chain = random_chain(random, static_cast<Kind>(i % 6), size);
                const double height =
                    revchain::modes(chain, {.count = 1}).conical_height[0] * (i < 6    ? random.between(0.7, 0.99)
                                                                              : i < 12 ? random.log_between(0.1, 0.7)
                                                                                       : random.log_between(0.01, 0.1));
                result.push_back({chain, revchain::steady_shapes(chain, {.conical_height = height, .budget = 5000})});
            }
        }
        return result;
    }();
    return all;
}

void for_random_figures(const std::function<void(const Figure&)>& check) {
    for (const Shapes& shapes : random_shapes())
        for (const SteadyShape& shape : shapes.found.shapes) check(Figure(shapes.chain, shape));
}

/// The largest of what an equation leaves.
struct Worst {
    double ulp = 0;
    void take(const Equation& equation, const Figure& figure) { ulp = std::max(ulp, in_ulp(equation, figure)); }
};

/// Horizontal pull at P_m times lambda: sum of weights times offsets of their centroids.
Quad pull_at(const Figure& f, Index m) {
    Quad sum = 0;
    for (Index r = 1; r <= m; ++r) {
        const auto [W, a, h, l, rho2] = f.link[at(r)];
        sum += W * (f.y[at(r)] + h / a * (f.y[at(r - 1)] - f.y[at(r)]));
    }
    return sum;
}

}  // namespace

TEST_CASE("§8 at any inclination: what is tried", "[paper][section_8][finite]") {
    std::size_t shapes = 0;
    int complete = 0;
    double steepest = 0;
    for (const Shapes& s : random_shapes()) {
        shapes += s.found.shapes.size(), complete += s.found.complete;
        for (const SteadyShape& shape : s.found.shapes)
            steepest = std::max(steepest, shape.inclination.cwiseAbs().minCoeff());
    }
    CAPTURE(shapes, random_shapes().size(), complete, steepest);
    CHECK(shapes > 400);
    CHECK(complete >= 180);  // the others have links of three inclinations
    CHECK(steepest > 1.5);   // rad: a shape whose every link is all but horizontal
}

TEST_CASE("§8 (2)-(5), (10) at any inclination: the lowest link", "[paper][section_8][finite]") {
    Worst eq2, eq3, eq4, eq5, eq10, reactions;
    for_random_figures([&](const Figure& figure) {
        // (2): moments round P of the centrifugal force and the weight of the particle at L, W h/l
        eq2.take(
            [](const Figure& f) {
                const auto [W, a, h, l, rho2] = f.link[1];
                const Quad FL = f.y[1] + l * f.sin(1);
                return W * h / l * (FL / f.lambda) * l * cosq(f.delta[1]) - W * h / l * l * f.sin(1);
            },
            figure);
        // (3): FL = lambda tan delta, so that C lies lambda above F
        eq3.take([](const Figure& f) { return f.y[1] + f.link[1].l * f.sin(1) - f.lambda * tanq(f.delta[1]); }, figure);
        // (4): CP = lambda sec delta - l, y = CP sin delta
        eq4.take([](const Figure& f) { return f.y[1] - (f.lambda * f.sec(1) - f.link[1].l) * f.sin(1); }, figure);
        // (5): the reaction's inclination
        eq5.take([](const Figure& f) { return tanq(f.phi[1]) - (f.y[1] + f.link[1].h * f.sin(1)) / f.lambda; }, figure);
        // the same at every pin, with the centre of gravity G of all that hangs below
        for (Index m = 1; m <= figure.size(); ++m)
            reactions.take(
                [m](const Figure& f) {
                    Quad weight = 0;
                    for (Index r = 1; r <= m; ++r) weight += f.link[at(r)].W;
                    return tanq(f.phi[at(m)]) - pull_at(f, m) / weight / f.lambda;
                },
                figure);
        eq10.take([](const Figure& f) { return relation_10(f.link, f.slants(), f.y).sum; }, figure);
    });
    CAPTURE(eq2.ulp, eq3.ulp, eq4.ulp, eq5.ulp, reactions.ulp, eq10.ulp);
    CHECK(eq2.ulp <= 0.7);        // measured 0.54
    CHECK(eq3.ulp <= 0.7);        // measured 0.54
    CHECK(eq4.ulp <= 0.7);        // measured 0.54
    CHECK(eq5.ulp <= 0.7);        // measured 0.55
    CHECK(reactions.ulp <= 0.7);  // measured 0.5
    CHECK(eq10.ulp <= 0.7);       // measured 0.47
}

TEST_CASE("§8 (10): as printed its first term lacks the secant", "[paper][section_8][finite]") {
    // W h (y_1 + l sin delta)/lambda - W h sin delta: 0 only as delta goes to 0
    double least = 1, greatest = 0;
    for_random_figures([&](const Figure& f) {
        const auto [W, a, h, l, rho2] = f.link[1];
        const Quad printed = W * h * (f.y[1] + l * f.sin(1)) / f.lambda, turning = W * h * f.sin(1);
        const double left = static_cast<double>((printed - turning) / (printed + turning));
        const double predicted = static_cast<double>((f.sec(1) - 1) / (f.sec(1) + 1));
        CHECK(std::abs(left - predicted) < 1e-12);
        least = std::min(least, left), greatest = std::max(greatest, left);
    });
    CAPTURE(least, greatest);
    CHECK(greatest > 0.9);
}

TEST_CASE("§8 (6)-(9), (11), (18) at any inclination: moments about each pin", "[paper][section_8][finite]") {
    Worst eq6, eq7, eq8, eq9, eq11;
    double sum_8 = 0, sum_18 = 0;
    int count_8 = 0, count_18 = 0;
    for_random_figures([&](const Figure& figure) {
        for (Index m = 1; m <= figure.size(); ++m) {
            // (6): its first form by the particle at L, its last in the secant; FL = y + l sin delta
            const auto first = [m](const Figure& f) {
                const auto [W, a, h, l, rho2] = f.link[at(m)];
                const Quad FL = f.y[at(m)] + l * f.sin(m);
                return W * h / l * (FL / f.lambda) * l * cosq(f.delta[at(m)]) - W * h / l * l * f.sin(m);
            };
            const auto last = [m](const Figure& f) {
                const auto [W, a, h, l, rho2] = f.link[at(m)];
                const Quad slant = f.lambda * f.sec(m);
                return W * h / slant * (f.y[at(m)] - (slant - l) * f.sin(m));
            };
            // an identity of any inclination and offset
            const auto [W, a, h, l, rho2] = figure.link[at(m)];
            const Quad size = W * h * (fabsq(figure.y[at(m)]) / figure.lambda + l / figure.lambda + 1);
            eq6.ulp = std::max(eq6.ulp, static_cast<double>(fabsq(first(figure) - last(figure)) / size) * 1e34);
            // (7): by the offsets of both pins
            eq7.take([&](const Figure& f) { return last(f) - own_moment(f.link, m, f.slants(), f.y); }, figure);
            if (m == 1) continue;
            for (Index r = 1; r < m; ++r) {
                // (8), (9): the left hand, with the lever a_m of the link the moment is about
                const auto left = [m, r](const Figure& f) {
                    const Letters& below = f.link[at(r)];
                    const Quad lever = f.link[at(m)].a, y_G = f.y[at(r)] + below.h * f.sin(r);
                    return below.W * (y_G / f.lambda) * lever * cosq(f.delta[at(m)]) - below.W * lever * f.sin(m);
                };
                (r == 1 ? eq9 : eq8)
                    .take([&](const Figure& f) { return left(f) - moment_below(f.link, m, r, f.slants(), f.y); },
                          figure);
                if (r > 1) {  // printed with a_r cos delta_r, a_r sin delta_r
                    const Letters& below = figure.link[at(r)];
                    const Quad y_G = figure.y[at(r)] + below.h * figure.sin(r);
                    const Quad outwards = below.W * (y_G / figure.lambda) * below.a * cosq(figure.delta[at(r)]);
                    const Quad down = below.W * below.a * figure.sin(r);
                    const Quad right = moment_below(figure.link, m, r, figure.slants(), figure.y);
                    sum_8 += static_cast<double>(fabsq(outwards - down - right) /
                                                 (fabsq(outwards) + fabsq(down) + fabsq(right)));
                    ++count_8;
                }
            }
            // (11), (18) and so on up the chain: they add up to nothing
            const auto moments = [m](const Figure& f) {
                const Slants slant = f.slants();
                Quad sum = own_moment(f.link, m, slant, f.y);
                for (Index r = 1; r < m; ++r) sum += moment_below(f.link, m, r, slant, f.y);
                return sum;
            };
            eq11.take(moments, figure);
            if (m == 3) {  // printed with - W_3 (y_2 - y_3) in its second line
                const Slants slant = figure.slants();
                const Quad printed = (figure.link[2].W - figure.link[3].W) * (figure.y[2] - figure.y[3]);
                Quad terms = fabsq(own_moment(figure.link, 3, slant, figure.y));
                for (Index r = 1; r < 3; ++r) terms += fabsq(moment_below(figure.link, 3, r, slant, figure.y));
                const double left = static_cast<double>(fabsq(moments(figure) + printed) / terms);
                sum_18 += left, ++count_18;
            }
        }
    });
    CAPTURE(eq6.ulp, eq7.ulp, eq8.ulp, eq9.ulp, eq11.ulp, sum_8 / count_8, sum_18 / count_18);
    CHECK(eq6.ulp <= 4);           // an identity: in 1e-34; measured 2.1
    CHECK(eq7.ulp <= 0.7);         // measured 0.54
    CHECK(eq8.ulp <= 0.7);         // measured 0.45
    CHECK(eq9.ulp <= 0.7);         // measured 0.5
    CHECK(eq11.ulp <= 0.7);        // measured 0.47
    CHECK(sum_8 / count_8 > 0.1);  // as printed: mean of what is left, of the terms; measured 0.3
    CHECK(sum_18 / count_18 > 2);  // measured 3.2
}

TEST_CASE("§8 (12), (19), (21) at any inclination: the general recurring relation", "[paper][section_8][finite]") {
    Worst eq12, eq19, eq21;
    double sum_printed = 0;
    int figures = 0;
    for_random_figures([&](const Figure& figure) {
        double printed = 0;
        for (Index m = 2; m <= figure.size(); ++m) {
            (m == 2   ? eq12
             : m == 3 ? eq19
                      : eq21)
                .take([m](const Figure& f) { return relation(f.link, m, f.slants(), f.y).sum; }, figure);
            if (m < 3) continue;
            eq21.take([m](const Figure& f) { return relation_21(f.link, m, f.slants(), f.y).sum; }, figure);
            eq21.take([m](const Figure& f) { return relation_21(f.link, m, f.slants(), f.y, Form::with_y_0).sum; },
                      figure);
            if (m < 4) continue;
            const Balance b = relation_21(figure.link, m, figure.slants(), figure.y, Form::printed);
            printed = std::max(printed, static_cast<double>(fabsq(b.sum) / b.size));
        }
        if (figure.size() < 4) return;
        sum_printed += printed, ++figures;
    });
    CAPTURE(eq12.ulp, eq19.ulp, eq21.ulp, figures, sum_printed / figures);
    CHECK(eq12.ulp <= 0.7);              // measured 0.46
    CHECK(eq19.ulp <= 0.7);              // measured 0.45
    CHECK(eq21.ulp <= 0.7);              // measured 0.47
    CHECK(sum_printed / figures > 0.2);  // of the terms, mean of 378 shapes; measured 0.25
    CHECK(sum_printed / figures < 0.3);
}

namespace {

/// Two random links at a height below the first, all their figures.
void for_two_links(std::uint64_t seed, const std::function<Chain<double>(paper::Random&)>& make,
                   const std::function<void(const Figure&)>& check) {
    paper::Random random(seed);
    for (int i = 0; i < 200; ++i) {
        const auto chain = make(random);
        const double height = revchain::modes(chain, {.count = 1}).conical_height[0] * random.log_between(0.02, 0.99);
        for (const SteadyShape& shape :
             revchain::steady_shapes(chain, {.conical_height = height, .budget = 5000}).shapes)
            check(Figure(chain, shape));
    }
}

}  // namespace

TEST_CASE("§8 (13), (14) at any inclination: two links", "[paper][section_8][finite]") {
    Worst eq13, eq14;
    for_two_links(
        8814, [](paper::Random& random) { return random_chain(random, Kind::mixed, 2); },
        [&](const Figure& figure) {
            eq13.take(
                [](const Figure& f) {
                    const auto [W1, a1, h1, l1, rho1] = f.link[1];
                    const auto [W2, a2, h2, l2, rho2] = f.link[2];
                    const Quad first = f.lambda * f.sec(1), second = f.lambda * f.sec(2);
                    return 1 + h1 / (first - l1) - second / a2 - W2 / W1 * (h2 / a2) * (second - l2) / a2;
                },
                figure);
            eq14.take(
                [](const Figure& f) {
                    const auto [W1, a1, h1, l1, rho1] = f.link[1];
                    const auto [W2, a2, h2, l2, rho2] = f.link[2];
                    const Quad m = W2 / W1 * (h2 / a2);
                    return a2 * h1 / (f.lambda * f.sec(1) - l1) - (m + 1) * (f.lambda * f.sec(2) - l2) - l2 + a2;
                },
                figure);
        });
    CAPTURE(eq13.ulp, eq14.ulp);
    CHECK(eq13.ulp <= 1.1);  // measured 0.81
    CHECK(eq14.ulp <= 1.1);  // measured 0.81
}

TEST_CASE("§8 (15) at any inclination: two links, L_2 at the lower pin", "[paper][section_8][finite]") {
    Worst eq15;
    for_two_links(
        8815,
        [](paper::Random& random) {
            const auto lower = random_link(random, Kind::mixed);
            return Chain<double>({lower, random_link(random, Kind::level)});
        },
        [&](const Figure& figure) {
            eq15.take(
                [](const Figure& f) {
                    const auto [W1, a1, h1, l1, rho1] = f.link[1];
                    const auto [W2, a2, h2, l2, rho2] = f.link[2];
                    const Quad m = W2 / W1 * (h2 / a2);
                    return (f.lambda * f.sec(1) - l1) * (f.lambda * f.sec(2) - l2) - l2 * h1 / (m + 1);
                },
                figure);
        });
    CAPTURE(eq15.ulp);
    CHECK(eq15.ulp <= 0.7);  // measured 0.51
}

namespace {

/// How far the figure that is nearest to one line, inclined by `turned`, is from it, rad.
double bend(const revchain::JointedLinks<double>& links, double height, double turned) {
    double least = 2;
    for (const auto& figure : revchain::jointed_links_shapes(links, height))
        least = std::min(least,
                         std::max(std::abs(figure.inclination[0] - turned), std::abs(figure.inclination[1] - turned)));
    return least;
}

}  // namespace

TEST_CASE("§8 (16) at any inclination: a bell and its clapper whirl in one line", "[paper][section_8][finite]") {
    // m = 1/2, l_1 = 1, a_2 = 1/4, l_2 = 7/4, h_1 = 3/4: at any speed, cos delta = lambda/(l_1 + a_2).
    const auto links = [](double l2) {
        return revchain::JointedLinks<double>{1,     {0.75, std::sqrt(0.75 * (1 - 0.75))}, 1, 0.25,
                                              0.125, std::sqrt(0.125 * (l2 - 0.125))};
    };
    double worst = 0, least_other = 2;
    for (const double height : {1.24, 1.2, 1.0, 0.5, 0.25, 0.01}) {
        worst = std::max(worst, bend(links(1.75), height, std::acos(height / 1.25)));
        least_other = std::min(least_other, bend(links(1.5), height, std::acos(height / 1.25)));
    }
    CAPTURE(worst, least_other);
    CHECK(worst <= 2e-15);       // rad; measured 1.1e-15, at 0.99 of the first height
    CHECK(least_other >= 1e-4);  // any other bell rings
}

TEST_CASE("§8 (17) at any inclination: a uniform rod jointed where it does not bend", "[paper][section_8][finite]") {
    double worst = 0;
    for (const double c : {0.34, 0.42, 0.45, 0.5, 0.6, 0.8, 0.9, 0.95}) {  // half the rod is 1; C c above the middle G
        const Quad C = c, CA = 1 - C, CD = CA * CA / C, D = CD - C, whole = C + 1 / (3 * C);
        const double below = static_cast<double>(1 - D), above = static_cast<double>(1 + D);
        const revchain::JointedLinks<double> links{below,
                                                   {below / 2, below / std::sqrt(12.0)},
                                                   above,
                                                   static_cast<double>(CD),
                                                   static_cast<double>((D - 1) / 2 + C),
                                                   above / std::sqrt(12.0)};
        for (const double share : {0.95, 0.5, 0.1, 0.01}) {
            const double height = share * static_cast<double>(whole);
            worst = std::max(worst, bend(links, height, static_cast<double>(acosq(height / whole))));
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 2e-15);  // rad; measured
}

TEST_CASE("§8 (20) at any inclination: three links, both ratios and the cubic", "[paper][section_8][finite]") {
    Worst left, right;
    paper::Random random(8820);
    double worst_height = 0, worst_pencil = 0;
    int figures = 0;
    for (int i = 0; i < 150; ++i) {
        const auto chain = random_chain(random, Kind::mixed, 3);
        const double height = revchain::modes(chain, {.count = 1}).conical_height[0] * random.log_between(0.05, 0.99);
        for (const SteadyShape& shape :
             revchain::steady_shapes(chain, {.conical_height = height, .budget = 5000}).shapes) {
            const Figure figure(chain, shape);
            left.take(
                [](const Figure& f) {
                    const auto [W1, a1, h1, l1, rho1] = f.link[1];
                    const auto [W2, a2, h2, l2, rho2] = f.link[2];
                    const auto [W3, a3, h3, l3, rho3] = f.link[3];
                    const Quad s1 = f.lambda * f.sec(1), s3 = f.lambda * f.sec(3);
                    return f.y[1] * (W1 * (1 + h1 / (s1 - l1)) + W2 * h2 / a2) +
                           f.y[2] * (W2 * (1 - h2 / a2) - (W1 + W2) * s3 / a3 - W3 * h3 / a3 * (s3 - l3) / a3);
                },
                figure);
            right.take(
                [](const Figure& f) {
                    const auto [W1, a1, h1, l1, rho1] = f.link[1];
                    const auto [W2, a2, h2, l2, rho2] = f.link[2];
                    const Quad s1 = f.lambda * f.sec(1), s2 = f.lambda * f.sec(2);
                    return f.y[1] * (W1 * (1 + h1 / (s1 - l1)) - W1 * s2 / a2 - W2 * h2 / a2 * (s2 - l2) / a2) +
                           f.y[2] * (W1 * s2 / a2 + W2 * h2 / a2 * (1 + (s2 - l2) / a2));
                },
                figure);
            // With the secants of the shape the cubic has the shape's height for a root, and for all three those of
            // the chain whose links are each shortened by its cosine.
            const Polynomial cubic = cubic_20(figure.link, {0, figure.sec(1), figure.sec(2), figure.sec(3)});
            double steep = 1;
            std::vector<Link<double>> pressed;
            for (Index m = 0; m < 3; ++m) {
                Link<double> link = chain.link(m);
                const double cosine = std::cos(shape.inclination[m]);
                steep = std::max(steep, std::abs(std::tan(shape.inclination[m]) * shape.inclination[m]));
                link.length *= cosine, link.centroid *= cosine;
                pressed.push_back(link);
            }
            worst_height = std::max(worst_height, paper::error_in_ulp(height, root(cubic, Quad(height))) / steep);
            const auto modes = revchain::modes(Chain<double>(pressed), {.count = revchain::all_modes});
            for (const double h : modes.conical_height)
                worst_pencil = std::max(worst_pencil, paper::error_in_ulp(h, root(cubic, Quad(h))) / steep);
            ++figures;
        }
    }
    CAPTURE(figures, left.ulp, right.ulp, worst_height, worst_pencil);
    CHECK(left.ulp <= 0.7);      // measured 0.41
    CHECK(right.ulp <= 0.7);     // measured 0.42
    CHECK(worst_height <= 0.7);  // ulp of the height and of the inclinations that would explain it; measured 0.42
    CHECK(worst_pencil <= 1.5);  // measured 0.96
}
