// SPDX-License-Identifier: GPL-3.0-or-later
// Branches of steady shapes of cords, inverse questions, stability and swing: against integration in 22 digits, laws of
// energy, and ever more links.
#include <random>

#include "revchain/branches.hpp"
#include "revchain/cord.hpp"
#include "revchain/swing.hpp"
#include "support/catch.hpp"
#include "support/tier.hpp"

using revchain::Chain;
using revchain::Cord;
using revchain::CordBranch;
using revchain::CordShape;
using revchain::Index;
using revchain::StabilityFrame;
using revchain::Vector;

namespace {

/// Three heavy beads on a light thread.
Cord beads() {
    return Cord(3.0, {.density = [](double s) {
                    double sum = 0.01;
                    for (const double at : {0.15, 1.0, 2.0})
                        sum += std::exp(-std::pow((s - at) / 0.05, 2)) / (0.05 * std::sqrt(std::numbers::pi));
                    return sum;
                }});
}

/// A cord of weight 1 and length 1, whose density goes like s^p, as links of equal length.
Chain<double> links_of(Index count, double p, double tip) {
    const auto rods =
        p == 0 ? Chain<double>::uniform_rods(count, 1.0, 1.0) : Chain<double>::tapered(count, 1.0, p, 1.0);
    std::vector<revchain::Link<double>> links;
    for (Index m = 0; m < count; ++m) links.push_back(rods.link(m));
    revchain::Link<double>& lowest = links.front();  // with the particle at its lower end, as one body
    const double a = lowest.length, weight = lowest.weight + tip;
    const double second =
        lowest.weight * (lowest.centroid * lowest.centroid + static_cast<double>(lowest.gyration_ratio) * a * a) +
        tip * a * a;
    const double centroid = (lowest.weight * lowest.centroid + tip * a) / weight;
    lowest.weight = weight, lowest.centroid = centroid;
    lowest.gyration_ratio = revchain::Wide<double>((second / weight - centroid * centroid) / (a * a));
    return Chain<double>(links);
}

}  // namespace

TEST_CASE("cord branches: the shapes of a list lie on them") {
    for (const Cord& cord : {Cord(1.0), Cord(1.0, {.tip_weight = 0.3}), Cord(1.0, {.density = 1.0, .tip_weight = 0.2}),
                             Cord(1.0, {.density = -0.5})}) {
        CAPTURE(cord.tip_weight(), cord.exponent().value());
        for (const Index mode : {1, 2, 3}) {
            const CordBranch branch = revchain::branch(cord, {.mode = mode, .min_conical_height = 0.004});
            CHECK(branch.end == revchain::BranchEnd::height);
            CHECK(branch.folds.empty());
            CHECK(branch.conical_height.back() == 0.004);
            for (const double height : {0.02, 0.004}) {
                const auto list = revchain::steady_shapes(cord, {.conical_height = height});
                const auto found = branch.shapes_at(height);
                REQUIRE(found.size() == 1);
                const CordShape& same = list.shapes[static_cast<std::size_t>(mode - 1)];
                CHECK(found[0].half_waves == mode);
                CHECK(std::abs(found[0].tip_offset / same.tip_offset - 1) <= same.error_bound + found[0].error_bound);
                for (const double s : {0.1, 0.5, 0.8})
                    CHECK(std::abs(found[0](s).inclination - same(s).inclination) <=
                          2 * (same.error_bound + found[0].error_bound));
            }
            const std::size_t last = branch.size() - 1;
            const CordShape end = branch.shape(last);
            CHECK(std::abs(end.offset[0] / branch.tip_radius[last] - 1) < 1e-12);
            CHECK(std::abs(end.inclination[0] - branch.tip_inclination[last]) < 1e-12);
            CHECK(std::abs(end.tension[end.tension.size() - 1] / branch.top_tension[last] - 1) < 1e-12);
        }
    }
}

TEST_CASE("cord branches: the energy falls with the square of the speed as half the moment of inertia") {
    // E(k) at height 1/k: dE/dk = -I/2, by Richardson's extrapolation of central differences; both are integrals of
    // different functions of the shape.
    for (const Cord& cord :
         {Cord(1.0), Cord(1.0, {.tip_weight = 0.3}), Cord(1.0, {.density = 1.0, .tip_weight = 0.2})}) {
        const auto at = [&](double k) {
            const CordBranch branch = revchain::branch(cord, {.mode = 2, .min_conical_height = 1 / k});
            return std::pair(branch.effective_energy.back(), branch.moment_of_inertia.back());
        };
        const auto difference = [&](double h) { return (at(40 + h).first - at(40 - h).first) / (2 * h); };
        const double slope = (4 * difference(0.1) - difference(0.2)) / 3;
        CHECK(std::abs(slope / (-at(40).second / 2) - 1) < 3e-9);
    }
    // the straight cord: weight times the depth of its centre of gravity
    CHECK(std::abs(revchain::branch(Cord(1.0, {.tip_weight = 0.3}), {.min_conical_height = 0.5}).effective_energy[0] +
                   0.8) < 1e-15);
}

TEST_CASE("cord: a density with a tip weight, against 22 digits") {
    // mpmath, Taylor series of y' = U/T, U' = -rho y/lambda, T^2 = U^2 + V^2, shooting on the offset of the free end:
    // length 1, rho = 2 s, V = 0.2 + s^2
    struct Row {
        double height, tip, half, tension;
    };
    const Cord cord(1.0, {.density = 1.0, .tip_weight = 0.2});
    const std::array rows{Row{0.1, 0.990223955569497725, 0.493110737188041551, 5.4007254295601877},
                          Row{0.1, 0.172755825503117915, -0.191984080275404105, 1.40588947373921639},
                          Row{0.03, 0.999123298494735813, 0.499380404853227486, 17.798006618994619},
                          Row{0.03, 0.274102258284827185, -0.219531962755961437, 3.39385219615704636},
                          Row{0.03, 0.0498517765249128386, -0.0445222224028714704, 1.47055926130763114}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& [height, tip, half, tension] = rows[i];
        const Index mode = static_cast<Index>(i < 2 ? i : i - 2) + 1;
        CAPTURE(height, mode);
        const auto close = [&](const CordShape& shape) {
            CHECK(std::abs(shape.offset[0] - tip) <= shape.error_bound);
            CHECK(std::abs(shape(0.5).offset - half) <= shape.error_bound);
            CHECK(std::abs(shape(1.0).tension / tension - 1) < 1e-13);
        };
        close(revchain::steady_shapes(cord, {.conical_height = height}).shapes[static_cast<std::size_t>(mode - 1)]);
        close(revchain::steady_shape(cord, {.mode = mode, .conical_height = height}));
        const double free_end = std::atan(tip / height);
        CHECK(
            std::abs(revchain::steady_shape(cord, {.mode = mode, .tip_inclination = free_end}).conical_height / height -
                     1) < 1e-12);
        CHECK(std::abs(revchain::steady_shape(cord, {.mode = mode, .top_tension = tension}).conical_height / height -
                       1) < 1e-13);
        if (mode > 1)
            CHECK(std::abs(revchain::steady_shape(cord, {.mode = mode, .tip_radius = tip}).conical_height / height -
                           1) < 1e-12);
    }
    const Vector<double> heights = revchain::modes(cord, {.count = 3}).conical_height;
    const std::array<double, 3> reference{0.740651634323225618, 0.145367275496347337, 0.0436509348100847475};
    for (Index k = 0; k < 3; ++k) CHECK(std::abs(heights[k] / reference[static_cast<std::size_t>(k)] - 1) < 9e-16);
    const Cord thicker(1.0, {.density = [](double s) { return 1 + s; }, .tip_weight = 0.2});
    const std::array<double, 3> other{0.743509461072250769, 0.131917112075394888, 0.0449266256294686557};
    const Vector<double> found = revchain::modes(thicker, {.count = 3}).conical_height;
    for (Index k = 0; k < 3; ++k) CHECK(std::abs(found[k] / other[static_cast<std::size_t>(k)] - 1) < 9e-16);
}

TEST_CASE("cord branches: a shape that no branch can be followed from leaves the diagram inconsistent") {
    const Cord cord(1.0, {.weight = 0.3, .tip_weight = 0.7, .weights = {{0.144, 5.3}, {0.1465, 4.1}, {0.232, 5.1}}});
    const auto diagram = revchain::branches(cord, {.min_conical_height = 8e-4});
    CHECK_FALSE(diagram.consistent);
    CHECK_FALSE(diagram.complete);
    for (const CordBranch& branch : diagram.branches) CHECK(branch.size() > (branch.mode > 0 ? 0 : 1));
}

TEST_CASE("cord branches: an isolated branch is found, and its fold") {
    const auto diagram = revchain::branches(beads(), {.min_conical_height = 0.06, .lists = 2});
    REQUIRE(diagram.branches.size() == 4);
    CHECK(diagram.consistent);
    CHECK_FALSE(diagram.complete);
    const CordBranch& born = diagram.branches[3];
    CHECK(born.mode == 0);
    CHECK(born.half_waves[0] == 3);
    REQUIRE(born.folds.size() == 1);
    const double fold = born.conical_height[born.folds[0]];
    CHECK(born.shapes_at(fold * (1 + 1e-9)).empty());
    const auto pair = born.shapes_at(fold * (1 - 1e-9));
    REQUIRE(pair.size() == 2);
    // the two meet as the square root of the distance, with the shape at the fold between them
    const CordShape middle = born.shape(born.folds[0]);
    CHECK(std::abs(pair[0].tip_offset / pair[1].tip_offset - 1) < 1e-2);
    CHECK(std::abs((pair[0].tip_offset + pair[1].tip_offset) / (2 * middle.tip_offset) - 1) < 1e-5);
    CHECK(middle.error_bound == 1e-7);
    // a scan far above the fold sees one shape of three half waves, just below three
    for (const auto& [height, count] : {std::pair(1.01 * fold, 1), std::pair(0.99 * fold, 3)}) {
        const auto list = revchain::steady_shapes(beads(), {.conical_height = height});
        CHECK(std::count_if(list.shapes.begin(), list.shapes.end(), [](const auto& x) { return x.half_waves == 3; }) ==
              count);
    }
    CHECK(revchain::branches(Cord(1.0), {.min_conical_height = 0.02}).complete);
    const auto none = revchain::branches(Cord(1.0), {.min_conical_height = 0.8});
    CHECK(none.branches.empty());
    CHECK(none.complete);
}

TEST_CASE("cord: heavy tips below a light end, against 22 digits") {
    // mpmath, Taylor series of y' = U/V, U' = -rho y/lambda
    struct Row {
        double p, tip;
        std::array<double, 3> height;
    };
    for (const auto& [p, tip, height] :
         {Row{1, 50, {0.996702693550480239, 0.00208490715201308794, 0.000483988482318211529}},
          Row{0.5, 1000, {0.999828670544711832, 0.000106680161851458351, 0.0000255070662788168346}},
          Row{10, 1, {0.950867553511619639, 0.0318894323978909672, 0.00712538023242559276}},
          Row{2.5, 1e-6, {0.421474122898676263, 0.1692999882111224, 0.0923702437256563728}}}) {
        const Vector<double> found =
            revchain::modes(Cord(1.0, {.density = p, .tip_weight = tip}), {.count = 3}).conical_height;
        CAPTURE(p, tip);
        for (Index k = 0; k < 3; ++k) CHECK(std::abs(found[k] / height[static_cast<std::size_t>(k)] - 1) < 2.5e-15);
    }
}

TEST_CASE("cord: exponents are the limit of those of N links, and converge as 1/N^2") {
    const auto exponents = [](const revchain::Stability& s) {
        std::vector<std::complex<double>> slowest;
        for (const auto& x : s.exponents)
            if (x.imag() > 1e-9 && x.real() > -1e-12) slowest.push_back(x);
        slowest.resize(5);
        return slowest;
    };
    for (const auto& [p, tip] : {std::pair(0.0, 0.0), std::pair(0.0, 0.3), std::pair(1.0, 0.2)})
        for (const auto& [mode, height] : {std::pair(1, 0.1), std::pair(2, 0.05)}) {
            CAPTURE(p, tip, mode, height);
            const Cord cord(1.0, {.density = p, .tip_weight = tip});
            const CordShape shape = revchain::steady_shape(cord, {.mode = mode, .conical_height = height});
            const auto limit = revchain::stability(cord, shape);
            const auto exact = exponents(limit);
            std::array<std::vector<std::complex<double>>, 2> of{};
            std::array<double, 2> off{};
            for (std::size_t i = 0; i < 2; ++i) {
                const auto chain = links_of(40 << i, p, tip);
                const auto linked =
                    revchain::stability(chain, revchain::steady_shape(chain, {.mode = mode, .conical_height = height}));
                CHECK(linked.verdict == limit.verdict);
                CHECK(linked.negative_directions == limit.negative_directions);
                of[i] = exponents(linked);
                for (std::size_t k = 0; k < 5; ++k) off[i] = std::max(off[i], std::abs(of[i][k] - exact[k]));
            }
            double extrapolated = 0;
            for (std::size_t k = 0; k < 5; ++k)
                extrapolated = std::max(extrapolated, std::abs((4.0 * of[1][k] - of[0][k]) / 3.0 - exact[k]));
            CAPTURE(off, extrapolated);
            CHECK(std::abs(std::log2(off[0] / off[1]) - 2) < 0.1);
            CHECK(extrapolated < 0.05 * off[1]);
        }
    const Cord uniform(1.0);
    const auto shapes = revchain::steady_shapes(uniform, {.conical_height = 0.05}).shapes;
    const auto second = revchain::stability(uniform, shapes[1]);
    CHECK(second.verdict == revchain::Verdict::unstable);
    CHECK(second.negative_directions == 2);
    CHECK(second.margin < 1e-6);
    CHECK(std::isnan(second.internal_damping[0]));
    CHECK(std::abs(second.external_damping[0] + 0.5) < 1e-9);  // in proportion to mass, whatever the shape
    const auto driven = revchain::stability(uniform, shapes[0], StabilityFrame::driven);
    CHECK(driven.verdict == revchain::Verdict::minimum);
    CHECK_THROWS_AS(revchain::stability(Cord(2.0), shapes[0]), revchain::InvalidArgument);
}

TEST_CASE("cord: the slowest exponents of any power are those of N links") {
    std::mt19937 random(9);
    std::uniform_real_distribution<> any(0, 1);
    for (int i = 0; i < support::by_tier(3, 9); ++i) {
        const double p = 3.5 * any(random) - 0.5, tip = i % 3 == 0 ? any(random) : 0.0;
        const int mode = 1 + i % 3;
        const Cord cord(1.0, {.density = p, .tip_weight = tip});
        const double critical = revchain::modes(cord, {.first = mode, .count = 1}).conical_height[0];
        const double height = (0.3 + 0.6 * any(random)) * critical;
        CAPTURE(p, tip, mode, height);
        const auto slowest = [](const revchain::Stability& s) {
            std::vector<std::complex<double>> upper;
            for (const auto& x : s.exponents)
                if (x.imag() > -1e-9 && x.real() > -1e-9) upper.push_back(x);
            std::sort(upper.begin(), upper.end(),
                      [](const auto& x, const auto& y) { return std::abs(x) < std::abs(y); });
            return upper;
        };
        const auto apart = [](const std::complex<double>& s, const std::vector<std::complex<double>>& from) {
            double least = std::numeric_limits<double>::infinity();
            for (const auto& x : from) least = std::min(least, std::abs(x - s));
            return least;
        };
        const auto shape = revchain::steady_shape(cord, {.mode = mode, .conical_height = height});
        const auto limit = slowest(revchain::stability(cord, shape));
        std::array<std::vector<std::complex<double>>, 2> linked;
        for (std::size_t k = 0; k < 2; ++k) {
            const auto chain = links_of(24 << k, p, tip);
            linked[k] = slowest(
                revchain::stability(chain, revchain::steady_shape(chain, {.mode = mode, .conical_height = height})));
        }
        REQUIRE(limit.size() >= 6);
        for (std::size_t k = 0; k < 6; ++k) {
            CAPTURE(k, limit[k], linked[0][k], linked[1][k]);
            const double moved = apart(linked[1][k], linked[0]);
            CHECK(apart(limit[k], linked[1]) <= moved + 1e-3 * std::abs(limit[k]));  // a third of it at order 2
        }
    }
}

TEST_CASE("cord: the exponents that are listed have none between them") {
    // here the free end, where the density is a root, needs an integral of its own
    const Cord cord(1.913709480229319, {.weight = 2.8310588882513597, .density = 0.5});
    const auto found =
        revchain::stability(cord, revchain::steady_shape(cord, {.mode = 2, .angular_speed = 11.02126420501079}));
    std::vector<double> turning;
    for (const auto& s : found.exponents)
        if (s.imag() > 0) turning.push_back(s.imag());
    REQUIRE(turning.size() > 10);
    // Richardson's extrapolation of chains of 60 and 120 links
    for (const auto& [k, linked] : {std::pair(0, 0.60324125), std::pair(1, 0.60733235), std::pair(2, 0.80415949)})
        CHECK(std::abs(turning[static_cast<std::size_t>(k)] - linked) < 1e-6);
    const auto sparse = links_of(40, 0.5, 0.0);
    const Cord one(1.0, {.density = 0.5});
    const auto limit = revchain::stability(one, revchain::steady_shape(one, {.mode = 2, .conical_height = 0.05}));
    const auto chain = revchain::stability(sparse, revchain::steady_shape(sparse, {.mode = 2, .conical_height = 0.05}));
    const auto below = [](const revchain::Stability& s, double most) {
        return std::count_if(s.exponents.begin(), s.exponents.end(), [&](const auto& x) { return std::abs(x) < most; });
    };
    for (const double most : {1.0, 2.0}) CHECK(below(limit, most) == below(chain, most));
}

TEST_CASE("cord: it swings as ever more links do") {
    const std::function<double(double)> aside = [](double s) { return 0.1 * (1 - s) * (1 - s) * (1 + s); };
    const std::function<double(double)> thrown = [](double s) { return 0.3 * std::sin(std::numbers::pi * s); };
    const std::vector<double> times{0.0, 0.3, 1.0};
    for (const auto& [p, tip] : {std::pair(0.0, 0.3), std::pair(1.0, 0.2)}) {
        CAPTURE(p, tip);
        const Cord cord(1.0, {.density = p, .tip_weight = tip});
        const auto swung = revchain::swing(
            cord,
            {.offset = aside, .velocity = thrown, .time = times, .arc_length = Vector<double>::LinSpaced(11, 0, 1)});
        std::array<double, 2> off{};
        for (std::size_t i = 0; i < 2; ++i) {
            const Index size = 80 << i;
            Vector<double> offset(size + 1), velocity(size + 1);
            for (Index m = 0; m <= size; ++m) {
                const double s = static_cast<double>(m) / static_cast<double>(size);
                offset[m] = aside(s), velocity[m] = m == size ? 0 : thrown(s);
            }
            const auto linked = revchain::swing(links_of(size, p, tip),
                                                {.offset = offset, .velocity = velocity, .time = times, .count = 60});
            for (Index t = 0; t < 3; ++t) off[i] = std::max(off[i], std::abs(linked.offset(t, 0) - swung.offset(t, 0)));
        }
        CAPTURE(off);
        CHECK(std::abs(std::log2(off[0] / off[1]) - 2) < 0.3);
        CHECK(off[1] < 2e-5);
        for (Index m = 0; m < 11; ++m)
            CHECK(std::abs(swung.offset(0, m) - aside(0.1 * static_cast<double>(m))) <= swung.error_estimate[m]);
        CHECK(swung.energy_left_out < 1e-4 * swung.energy.sum());
    }
}

TEST_CASE("cord: a mode swings by itself, and an array is what lies straight between its numbers") {
    const Cord cord(1.0);
    const auto mode = revchain::modes(cord, {.count = 3});
    const std::function<double(double)> third = [&](double s) { return 0.01 * mode.offset(2, s); };
    const double period = mode.period()[2];
    const auto pure = revchain::swing(cord, {.offset = third, .time = {0, period / 2, 1000.5 * period}, .count = 8});
    for (Index k = 0; k < 8; ++k) CHECK(std::abs(pure.cosine[k] - (k == 2 ? 0.01 : 0.0)) < 1e-15);
    CHECK(std::abs(pure.offset(1, 0) + 0.01) < 1e-15);
    CHECK(std::abs(pure.offset(2, 0) + 0.01) < 1e-12);
    CHECK(pure.energy_left_out < 1e-15 * pure.energy[2]);
    // energy: of the start, by hand: integral of s (0.1)^2 / 2
    Vector<double> numbers(3), places(3);
    numbers << 0.1, 0.05, 0, places << 0, 0.5, 1;
    const auto listed = revchain::swing(cord, {.offset = numbers, .time = {0}, .arc_length = places, .count = 60});
    const auto same = revchain::swing(
        cord,
        {.offset = std::function<double(double)>([](double s) { return 0.1 * (1 - s); }), .time = {0}, .count = 60});
    for (Index k = 0; k < 60; ++k) CHECK(std::abs(listed.cosine[k] - same.cosine[k]) < 1e-15);
    CHECK(std::abs(listed.energy.sum() + listed.energy_left_out - 0.0025) < 1e-15);
}

TEST_CASE("cord: wrong questions about branches and swings") {
    using Catch::Matchers::ContainsSubstring;
    const Cord cord(1.0);
    CHECK_THROWS_WITH(revchain::branch(cord, {.mode = 0, .min_conical_height = 0.1}),
                      ContainsSubstring("mode must be"));
    CHECK_THROWS_WITH(revchain::branch(cord, {.min_conical_height = 0.7}), ContainsSubstring("must be less"));
    CHECK_THROWS_WITH(revchain::branch(cord, {.min_conical_height = 1e-7}), ContainsSubstring("at most 1e6"));
    CHECK_THROWS_WITH(revchain::branch(cord, {}), ContainsSubstring("give either min_conical_height"));
    CHECK_THROWS_WITH(revchain::branches(cord, {.min_conical_height = 0.1, .lists = 0}), ContainsSubstring("lists"));
    CHECK_THROWS_WITH(revchain::steady_shape(cord, {}), ContainsSubstring("exactly one"));
    CHECK_THROWS_WITH(revchain::steady_shape(cord, {.tip_radius = 1.0}), ContainsSubstring("less than the length"));
    CHECK_THROWS_WITH(revchain::steady_shape(cord, {.top_tension = 1.0}), ContainsSubstring("more than the weight"));
    CHECK_THROWS_WITH(revchain::steady_shape(cord, {.tip_inclination = 1.6}), ContainsSubstring("between 0 and pi/2"));
    CHECK_THROWS_WITH(revchain::steady_shape(cord, {.conical_height = 0.7}),
                      ContainsSubstring("where mode 1 leaves the vertical"));
    CHECK_THROWS_WITH(revchain::steady_shape(cord, {.mode = 2, .tip_radius = 0.9}), ContainsSubstring("is not met"));
    CHECK(revchain::shapes_on_branch(cord, {.mode = 2, .tip_radius = 0.9}).shapes.empty());
    using Function = std::function<double(double)>;
    CHECK_THROWS_WITH(revchain::swing(cord, {.offset = Function([](double s) { return s < 0.3 ? 1.0 : 0.0; })}),
                      ContainsSubstring("must be continuous"));
    CHECK_THROWS_WITH(revchain::swing(cord, {.offset = Function([](double) { return 1.0; })}),
                      ContainsSubstring("of the support must be 0"));
    CHECK_THROWS_WITH(revchain::swing(cord, {.offset = Vector<double>(Vector<double>::Zero(3))}),
                      ContainsSubstring("a number for each"));
    CHECK_THROWS_WITH(revchain::swing(cord, {.count = 0}), ContainsSubstring("count must be"));
    CHECK_THROWS_WITH(revchain::swing(cord, {.time = {NAN}}), ContainsSubstring("times must be finite"));
}
