// SPDX-License-Identifier: MPL-2.0
#include "revchain/steady_shapes.hpp"
#include "revchain/finite/shapes/list.hpp"

#include "revchain/modes.hpp"
#include "revchain/two_links.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/quad_chain.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::SteadyShape;
using revchain::SteadyShapes;
using support::Quad;
using support::quad;

namespace {

/// The sweep of Greenhill's §8 from the lowest link up, in quadruple precision and in his letters, with nothing in common
/// with the library: tangent of the lowest link -> offset of the support.
struct Sweep {
    struct Link {
        Quad W, a, h, l;
    };
    std::vector<Link> links;
    Quad lambda;

    Sweep(const Chain<double>& chain, double height) : lambda(height) {
        for (Index m = 0; m < chain.size(); ++m) {
            const auto link = chain.link(m);
            const Quad a = link.length, h = link.centroid, rho2 = quad(link.gyration_ratio) * a * a;
            links.push_back({Quad(link.weight), a, h, h + rho2 / h});
        }
    }
    Quad operator()(Quad t1, std::vector<Quad>* inclinations = nullptr) const {
        Quad S = 0, H = 0, y = 0;  // weight below, sum of W y_G below, offset of the pin below
        for (std::size_t m = 0; m < links.size(); ++m) {
            const auto& [W, a, h, l] = links[m];
            Quad t = t1;
            if (m > 0) {
                // lambda (S + W h/a) t = H + W (h/a) (y_upper + l s), y_upper = y - a s
                const Quad pull = lambda * (S + W * h / a), turn = W * h / a * (a - l), R = H + W * h / a * y;
                t = R / pull;
                if (turn > 0) t = R / (pull + turn);
                for (int i = 0; i < 200; ++i) {
                    const Quad c = 1 / sqrtq(1 + t * t);
                    const Quad step = (R - pull * t - turn * t * c) / (pull + turn * c * c * c);
                    t += step;
                    if (fabsq(step) <= 1e-33 * fabsq(t)) break;
                }
            } else {
                y = (lambda * t - l * t / sqrtq(1 + t * t)) + a * t / sqrtq(1 + t * t);  // (4), at the lower end
            }
            const Quad s = t / sqrtq(1 + t * t);
            if (inclinations) inclinations->push_back(atanq(t));
            y -= a * s;
            H += W * (y + h * s);
            S += W;
        }
        return y;
    }
    Quad farthest() const {
        Quad reach = links[0].l;
        for (const Link& link : links) reach += link.a;
        return reach / lambda;
    }
    /// Sign changes on a grid that is even in ln t and near both ends: a number that can miss shapes.
    int changes(int steps) const {
        const Quad last = farthest() * Quad(1.01);
        int count = 0;
        Quad before = 0;
        for (int i = 0; i <= steps; ++i) {
            const Quad now = (*this)(last * expq(Quad(-40) * (steps - i) / steps));
            count += i > 0 && (now > 0) != (before > 0);
            before = now;
        }
        return count;
    }
};

/// Largest moment about an upper pin, over weights times lengths, of all that hangs below it; by its definition.
double worst_moment(const Chain<double>& chain, const SteadyShape& shape) {
    const Index n = chain.size();
    double worst = 0;
    for (Index m = 0; m < n; ++m) {
        Quad moment = 0, size = 0, reach = 0;
        for (Index r = 0; r <= m; ++r) reach += Quad(chain.link(r).length) + fabsq(Quad(chain.link(r).centroid));
        for (Index r = 0; r <= m; ++r) {
            const auto link = chain.link(r);
            const Quad d = shape.inclination[r], h = link.centroid, W = link.weight, a = link.length;
            const Quad y = Quad(shape.offset[r + 1]) + h * sinq(d), z = Quad(shape.height[r + 1]) - h * cosq(d);
            const Quad lever_y = y - shape.offset[m + 1], lever_z = z - shape.height[m + 1];
            const Quad rho2 = quad(link.gyration_ratio) * a * a;
            // weight downwards, W y/lambda outwards; and the body's own centrifugal couple
            moment += W * y / shape.conical_height * -lever_z - W * lever_y +
                      W * rho2 * sinq(d) * cosq(d) / shape.conical_height;
            size += W * (1 + (fabsq(Quad(shape.offset[r + 1])) + fabsq(h)) / shape.conical_height) * reach +
                    W * rho2 / shape.conical_height;
        }
        worst = std::max(worst, static_cast<double>(fabsq(moment) / size));
    }
    return worst;
}

Chain<double> plummets(Index n) { return Chain<double>::uniform_plummets(n, static_cast<double>(n), 1.0); }

/// Number of conical heights above one.
Index above(const Chain<double>& chain, double height) {
    return revchain::count_modes(chain, {.conical_height = height});
}

/// Negative directions of the energy at a shape, its rotation about the axis left aside: negative pivots of the tangent
/// stiffness k sec^3 [1 -1; -1 1] less M/lambda of the links, in quadruple precision.
int index(const Chain<double>& chain, double height, const SteadyShape& shape) {
    int negative = 0;
    Quad below = 0, corner = 0,
         link_below = 0;  // weight hung; what the link below adds to its upper pin; pivot's share
    for (Index m = 0; m < chain.size(); ++m) {
        const auto link = chain.link(m);
        const Quad W = link.weight, a = link.length, p = link.centroid / a, c = cosq(Quad(shape.inclination[m]));
        const Quad rho2 = quad(link.gyration_ratio), k = (W * p + below) / a / (c * c * c);
        const Quad lower = k - W * (p * p + rho2) / height, across = -k - W * (p * (1 - p) - rho2) / height,
                   upper = k - W * ((1 - p) * (1 - p) + rho2) / height;
        const Quad pivot = corner - link_below + lower;
        negative += pivot < 0;
        corner = upper, link_below = across * across / pivot, below += W;
    }
    return negative;
}

void check_list(const Chain<double>& chain, double height, const SteadyShapes& found) {
    REQUIRE(found.complete);
    const auto count = static_cast<Index>(found.shapes.size());
    const Index k = above(chain, height);
    CHECK(count >= k);  // Clark
    int degree = 0;
    for (const SteadyShape& shape : found.shapes) degree += index(chain, height, shape) % 2 == 0 ? 1 : -1;
    CHECK(degree == k % 2);  // of the balance: catches one shape missed or doubled, in any list
    for (const SteadyShape& shape : found.shapes) {
        CHECK(worst_moment(chain, shape) <= (chain.size() < 20 ? 1e-15 : 2e-15));
        CHECK(shape.offset[0] > 0);
        CHECK(shape.offset[chain.size()] == 0);
        CHECK(shape.height[chain.size()] == 0);
        CHECK(shape.inclination.cwiseAbs().maxCoeff() < 1.5707963267948966);
    }
    for (std::size_t i = 1; i < found.shapes.size(); ++i) {
        const SteadyShape &x = found.shapes[i - 1], &y = found.shapes[i];
        CHECK((x.half_waves < y.half_waves || (x.half_waves == y.half_waves && x.inclination[0] < y.inclination[0])));
    }
}

/// Every inclination within its bound, and far within: 2 ulp, or what the condition makes of two words. Against Newton's
/// method in quadruple precision on all links; a sweep, from the tip or not, loses the digits of what dies away from it.
void check_inclinations(const Chain<double>& chain, double height, const SteadyShapes& found) {
    const support::QuadChain links(chain);
    for (const SteadyShape& shape : found.shapes) {
        const std::vector<Quad> truth = links.balanced(shape.inclination, height);
        REQUIRE_FALSE(truth.empty());
        const double reach = 1e-27 * shape.condition;  // of an inclination
        double worst = 0;
        for (Index m = 0; m < chain.size(); ++m) {
            const Quad exact = truth[static_cast<std::size_t>(m)];
            CHECK(fabsq(shape.inclination[m] - exact) <= shape.error_bound);
            const double ulp = support::error_in_ulp(shape.inclination[m], exact);
            if (fabsq(shape.inclination[m] - exact) > reach) worst = std::max(worst, ulp);
        }
        CHECK(worst <= 2);
        CHECK(shape.error_bound <= 1e-15 + 10 * reach);
        CHECK(shape.residual <= 1e-20);
    }
}

}  // namespace

TEST_CASE("shapes counted and proved before: 84, 412, 2969, 6466", "[finite]") {
    const struct {
        Index links;
        double ratio;  // a / lambda
        std::size_t shapes;
    } known[]{{2, 166, 2},   {3, 166, 5},   {4, 166, 10},    {5, 166, 23},    {6, 166, 56},     {7, 166, 119},
              {8, 2, 2},     {8, 5, 4},     {8, 16, 19},     {8, 25, 46},     {8, 35.4025, 84}, {8, 100, 248},
              {8, 166, 272}, {10, 50, 412}, {10, 100, 1120}, {11, 166, 2969}, {12, 166, 6466}};
    for (const auto& [links, ratio, shapes] : known) {
        CAPTURE(links, ratio);
        const auto found = revchain::steady_shapes(plummets(links), {.conical_height = 1 / ratio});
        CHECK(found.complete);
        CHECK(found.shapes.size() == shapes);
        if (links <= 8) check_list(plummets(links), 1 / ratio, found);
    }
    CHECK(revchain::steady_shapes(Chain<double>::uniform_rods(6, 6, 1), {.conical_height = 1 / 166.0}).shapes.size() ==
          42);
    CHECK(revchain::steady_shapes(Chain<double>::uniform_rods(8, 8, 1), {.conical_height = 1 / 166.0}).shapes.size() ==
          124);
}

TEST_CASE("three equal plummets: two shapes are born at n = 3.90376215692 sqrt(g/a)", "[finite]") {
    const double fold = 3.90376215692;
    for (const double off : {1e-9, 1e-6, 1e-3}) {
        const double below = fold * (1 - off), beyond = fold * (1 + off);
        CHECK(revchain::steady_shapes(plummets(3), {.conical_height = 1 / (below * below)}).shapes.size() == 3);
        CHECK(revchain::steady_shapes(plummets(3), {.conical_height = 1 / (beyond * beyond)}).shapes.size() == 5);
    }
}

TEST_CASE("one link and two: the closed forms", "[finite]") {
    support::Random random(91);
    for (int i = 0; i < 200; ++i) {
        const double l = random.log_between(1e-3, 1e3), height = l * random.log_between(1e-3, 1.5);
        const auto one =
            revchain::steady_shapes(Chain<double>({revchain::plummet(2.0, l)}), {.conical_height = height});
        CHECK(one.complete);
        REQUIRE(one.shapes.size() == (height < l ? 1U : 0U));
        if (height < l) CHECK(support::error_in_ulp(one.shapes[0].inclination[0], acosq(Quad(height) / l)) <= 2);

        const double W1 = random.log_between(0.01, 100.0), W2 = random.log_between(0.01, 100.0);
        const double l2 = l * random.log_between(0.01, 100.0);
        const Chain<double> chain({revchain::plummet(W1, l), revchain::plummet(W2, l2)});
        const auto two = revchain::steady_shapes(chain, {.conical_height = height});
        const auto closed = revchain::two_plummets_shapes(W1, l, W2, l2, height);
        CAPTURE(W1, l, W2, l2, height);
        CHECK(two.complete);
        REQUIRE(two.shapes.size() == closed.size());
        for (std::size_t j = 0; j < closed.size(); ++j)
            for (Index m = 0; m < 2; ++m) {
                const auto at = static_cast<std::size_t>(m);
                CHECK(std::abs(two.shapes[j].inclination[m] - closed[j].inclination[at]) <=
                      1e-9 * std::abs(closed[j].inclination[at]));
            }
    }
}

TEST_CASE("random chains: the proved list holds all that a scan finds", "[finite]") {
    support::Random random(92);
    int many = 0;
    for (int i = 0; i < 60; ++i) {
        const Index n = 2 + i % 5;
        const bool rods = i % 2 == 0;
        const auto chain = support::chain_of(n, [&](Index) {
            const double weight = random.log_between(1.0, 100.0), length = random.log_between(1.0, 10.0);
            return rods ? revchain::uniform_rod<double>(weight, length) : revchain::plummet<double>(weight, length);
        });
        const double height = chain.total_length() * random.log_between(1e-3, 0.3);
        const auto found = revchain::steady_shapes(chain, {.conical_height = height});
        CAPTURE(i, n, height);
        check_list(chain, height, found);
        const int scanned = Sweep(chain, height).changes(4000);
        CHECK(static_cast<int>(found.shapes.size()) >= scanned);
        many += found.shapes.size() > static_cast<std::size_t>(above(chain, height));
        check_inclinations(chain, height, found);
    }
    CHECK(many > 5);
}

TEST_CASE("just below a critical height, and long chains", "[finite]") {
    for (const Index n : {1, 2, 5, 20, 100, 1000})
        for (const bool rods : {false, true}) {
            const double a = static_cast<double>(n);
            const auto chain = rods ? Chain<double>::uniform_rods(n, a, 1) : Chain<double>::uniform_plummets(n, a, 1);
            const auto modes = revchain::modes(chain, {.count = std::min<Index>(n, 3)});
            for (Index k = 0; k < modes.size(); ++k)
                for (const double off : {1e-2, 1e-8, 1e-15}) {
                    if (n == 1000 && (k > 0 || (rods && off < 1e-3))) continue;  // seconds
                    const double height = modes.conical_height[k] * (1 - off);
                    CAPTURE(n, rods, k, off);
                    const auto found = revchain::steady_shapes(chain, {.conical_height = height});
                    CHECK(found.shapes.size() == static_cast<std::size_t>(k + 1));
                    check_list(chain, height, found);
                    check_inclinations(chain, height, found);
                }
        }
    // 1e-4 of the length
    for (const Index n : {2, 3, 4, 6}) {
        const double height = static_cast<double>(n) * 1e-4;
        CAPTURE(n);
        const auto found = revchain::steady_shapes(plummets(n), {.conical_height = height});
        check_list(plummets(n), height, found);
        check_inclinations(plummets(n), height, found);
    }
}

TEST_CASE("where the proof ends, what a scan finds is there", "[finite]") {
    const auto chain = plummets(100);
    const auto found = revchain::steady_shapes(chain, {.conical_height = 0.2, .budget = 100'000});
    CHECK_FALSE(found.complete);
    REQUIRE(found.undecided.size() == 2);
    CHECK(found.undecided[0].high < found.undecided[1].low);
    REQUIRE(found.shapes.size() == 14);
    for (int k = 0; k < 14; ++k) CHECK(found.shapes[static_cast<std::size_t>(k)].half_waves == k + 1);
    for (const SteadyShape& shape : found.shapes)
        CHECK(worst_moment(chain, shape) <= (chain.size() < 20 ? 1e-15 : 2e-15));
    check_inclinations(chain, 0.2, found);
    const auto whole = revchain::steady_shapes(chain, {.conical_height = 0.2});
    CHECK(whole.complete);
    CHECK(whole.shapes.size() == 14);
}

TEST_CASE("a speed out of range, a budget of nothing: said so, soon", "[finite]") {
    for (const double height : {1e-100, 1e-200, 1e-300}) {
        const auto found = revchain::steady_shapes(plummets(4), {.conical_height = height});
        CHECK_FALSE(found.complete);
        CHECK(found.cells < 10'000);
        for (const SteadyShape& shape : found.shapes) CHECK(shape.error_bound == shape.error_bound);
    }
    CHECK(revchain::steady_shapes(plummets(4), {.conical_height = 1e300}).complete);
    for (const double height : {5e-324, 1e-310, 1e-308}) {  // tangents beyond any number
        const auto found = revchain::steady_shapes(plummets(3), {.conical_height = height});
        CHECK_FALSE(found.complete);
        REQUIRE(found.undecided.size() == 1);
        CHECK(found.undecided[0].high > 1.57);
    }
    for (const double speed : {1e-150, 1e-300}) {
        const auto found = revchain::steady_shapes(plummets(2), {.angular_speed = speed});
        CHECK(found.complete);
        CHECK(found.shapes.empty());
    }
    for (const double speed : {1e160, 1e300})
        CHECK_FALSE(revchain::steady_shapes(plummets(2), {.angular_speed = speed}).complete);
    for (const long budget : {0L, -1L}) {
        const auto found = revchain::steady_shapes(plummets(4), {.conical_height = 0.1, .budget = budget});
        CHECK_FALSE(found.complete);
        REQUIRE(found.undecided.size() == 1);
        CHECK(found.undecided[0].low == 0);
        CHECK(found.undecided[0].high > 1.5);
    }
}

TEST_CASE("what a cell is said to hold, it holds", "[finite]") {
    support::Random random(93);
    for (int i = 0; i < 400; ++i) {
        const Index n = 1 + i % 6;
        const auto chain = support::chain_of(n, [&](Index) {
            const double weight = random.log_between(0.1, 10.0), length = random.log_between(0.1, 10.0);
            return i % 2 == 0 ? revchain::uniform_rod<double>(weight, length)
                              : revchain::plummet<double>(weight, length);
        });
        const double height = chain.total_length() * random.log_between(1e-3, 0.3);
        const Sweep sweep(chain, height);
        const auto links = revchain::finite::links_of(chain);
        const auto enclosed = revchain::finite::enclosed<double>(links.links);
        const double unit = std::ldexp(1.0, -links.units.length_exponent);
        const double low = static_cast<double>(sweep.farthest()) * random.log_between(1e-12, 1.0);
        const double high = low * (1 + random.log_between(1e-9, 0.3));
        const auto jet =
            revchain::finite::support_offset(enclosed, revchain::Interval<double>(height * unit),
                                             revchain::finite::Cell<double, 1>(revchain::Interval<double>(low, high)));
        for (int j = 0; j < 8; ++j) {
            const Quad t = low + (Quad(high) - low) * random(), e = t * Quad(1e-9);
            const Quad y = sweep(t) * unit, before = sweep(t - e) * unit, after = sweep(t + e) * unit;
            const Quad slope = (after - before) / (2 * e), bend = (after - 2 * y + before) / (e * e);
            const auto within = [&](const revchain::Interval<double>& x, Quad value, Quad size) {
                return Quad(x.low) <= value + size && value - size <= Quad(x.high);
            };
            CAPTURE(n, low, high);
            CHECK(within(jet.value, y, 0));
            CHECK(within(jet.slope[0], slope, 1e-12 * fabsq(slope) + 1e-12 * fabsq(y / t)));
            CHECK(within(jet.bend[0], bend, 1e-9 * fabsq(bend) + 1e-9 * fabsq(slope / t) + 1e-9 * fabsq(y / (t * t))));
        }
    }
}

TEST_CASE("nothing leaves the vertical above the first critical height", "[finite]") {
    for (const double ratio : {1.0000001, 1.5, 1e6}) {
        const auto rods = Chain<double>::uniform_rods(5, 1, 1);
        const double first = revchain::modes(rods, {.count = 1}).conical_height[0];
        const auto found = revchain::steady_shapes(rods, {.conical_height = first * ratio});
        CHECK(found.complete);
        CHECK(found.shapes.empty());
        CHECK(revchain::steady_shapes(rods, {.conical_height = first * (1 - 1e-8)}).shapes.size() == 1);
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()})
        CHECK_THROWS_AS(revchain::steady_shapes(plummets(3), {.conical_height = bad}), revchain::InvalidArgument);
    // a budget that does not do: what is known stands, the rest is named
    const auto some = revchain::steady_shapes(plummets(8), {.conical_height = 1 / 166.0, .budget = 100});
    CHECK_FALSE(some.complete);
    CHECK_FALSE(some.undecided.empty());
}
