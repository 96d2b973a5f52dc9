// SPDX-License-Identifier: GPL-3.0-or-later
// Cords held at both ends: modes under a tension, branches and stability at a span, against closed forms and against ever
// more links.
#include "revchain/cord.hpp"
#include "revchain/special/taut_cord.hpp"
#include "support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using revchain::Chain;
using revchain::Cord;
using revchain::Held;
using revchain::Index;
using revchain::Wide;

namespace {

constexpr double length = 2.0, weight = 3.0;
const Cord rope(length, {.weight = weight});

Chain<double> cut(Index links) { return Chain<double>::uniform_rods(links, length, weight); }

/// What is left of numbers of 1/N^2 when those of N and 2 N links are known.
double extrapolated(double few, double many) { return many + (many - few) / 3; }

}  // namespace

TEST_CASE("held cord: modes are those of the closed form, and of many links by order 2") {
    const Held<Cord> held(rope, {.tension = 4.5});
    const auto m = revchain::modes(held, {.first = 2, .count = 3});
    CHECK(m.method == "zeros of a cross product of Bessel functions");
    REQUIRE(m.held);
    for (Index j = 0; j < 3; ++j) {
        const revchain::analytic::taut_cord::Mode form(j + 2, length,
                                                       Wide<double>(1.0));  // 1.5 of weight is 1 of length
        CHECK(m.conical_height[j] == form.conical_height());
        CHECK(m.offset(j, 0.3) == form.shape(0.3));
        CHECK(m.slope(j, 0.3) == form.slope(0.3));
        CHECK(m.nodes(j) == form.nodes());
        CHECK(m.vertical_points(j) == form.vertical_points());
        const auto of = [&](Index links) {
            return revchain::modes(Held(cut(links), {.tension = 4.5}), {.first = 2, .count = 3}).conical_height[j];
        };
        const double few = of(200), many = of(400), whole = m.conical_height[j];
        CHECK((few - whole) / (many - whole) == Approx(4).epsilon(1e-3));
        CHECK(std::abs(extrapolated(few, many) / whole - 1) < 3e-8);
        for (const double off : {-1e-14, 1e-14})
            CHECK(revchain::count_modes(held, {.conical_height = whole * (1 + off)}) == j + 1 + (off < 0));
    }
    const auto window = revchain::modes(held, {.angular_speed = {{5.0, 30.0}}});
    CHECK(window.size() ==
          revchain::count_modes(held, {.angular_speed = 30.0}) - revchain::count_modes(held, {.angular_speed = 5.0}));
    // the tension at the lower end has no rounding: 2^-50 over the weight
    const auto barely = revchain::modes(Held<Cord>(rope, {.tension = weight + 0x1p-50}), {.count = 1});
    const revchain::analytic::taut_cord::Mode form(1, length, Wide<double>(0x1p-50) / Wide<double>(1.5));
    CHECK(barely.conical_height[0] == form.conical_height());
}

TEST_CASE("held cord: without gravity it is a string") {
    const double tension = 7.0, g = 9.80665;
    const Held<Cord> held(rope, {.tension = tension, .weightless = true});
    const auto m = revchain::modes(held, {.count = 6});
    CHECK(m.method == "half waves of a string");
    for (Index j = 0; j < 6; ++j) {
        const double n = static_cast<double>(j + 1) * M_PI * std::sqrt(tension / (weight * length));
        CHECK(std::abs(m.angular_speed(g)[j] / n - 1) < 1e-15);
        CHECK(m.offset(j, 0.1) == Approx(std::sin(M_PI * static_cast<double>(j + 1) * 0.05)).epsilon(1e-14));
        CHECK(m.offset(j, length) == 0);
        for (const double s : {-0.1, length * 1.001, std::numeric_limits<double>::quiet_NaN()}) {
            CHECK_THROWS_AS(m.offset(j, s), revchain::InvalidArgument);
            CHECK_THROWS_AS(m.slope(j, s), revchain::InvalidArgument);
        }
        CHECK(m.vertical_points(j)[0] == Approx(length / 2 / static_cast<double>(j + 1)).epsilon(1e-15));
        REQUIRE(m.nodes(j).size() == j);
        for (Index i = 0; i < j; ++i) CHECK(std::abs(m.offset(j, m.nodes(j)[i])) < 1e-15 * 20);
        CHECK(revchain::count_modes(held, {.angular_speed = n * (1 - 1e-14)}) == j);
        CHECK(revchain::count_modes(held, {.angular_speed = n * (1 + 1e-14)}) == j + 1);
    }
    const auto beads = [&](Index links) {
        return revchain::modes(Held(cut(links), {.tension = tension, .weightless = true}), {.count = 1})
            .conical_height[0];
    };
    CHECK(std::abs(extrapolated(beads(100), beads(200)) / m.conical_height[0] - 1) < 2e-9);
    // on the moon the formal height is another, the speed the same
    const auto moon = revchain::modes(held, {.count = 1, .gravity = 1.62});
    CHECK(moon.angular_speed(1.62)[0] == Approx(m.angular_speed(g)[0]).epsilon(1e-15));
    CHECK_THROWS_AS(revchain::modes(Held<Cord>(rope, {.tension = 2.9})), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(Held<Cord>(rope, {.span = 1.0})), revchain::InvalidArgument);
}

TEST_CASE("held cord: branches go through the shapes at a speed, and end where the cord hangs folded") {
    const Held<Cord> held(rope, {.span = 1.2});
    const auto branches = revchain::branches(held, {.min_conical_height = 0.02});
    REQUIRE(branches.size() >= 3);
    // hung from an end, straight parts of the lengths (2 +- 1.2)/2 begin to whirl at 4 length/j_0^2
    const std::array<double, 3> end{4 * 1.6 / std::pow(2.404825557695773, 2), 4 * 0.4 / std::pow(2.404825557695773, 2),
                                    4 * 1.6 / std::pow(5.520078110286311, 2)};
    for (std::size_t k = 0; k < 3; ++k) {
        const revchain::HeldCordBranch& branch = branches[k];
        CAPTURE(k);
        CHECK(branch.half_waves == static_cast<int>(k) + 1);
        CHECK(branch.end == revchain::HeldBranchEnd::folded);
        CHECK(branch.folds.empty());
        const double last = branch.shapes.back().conical_height;
        CHECK(last < end[k]);
        CHECK(last > 0.9 * end[k]);
        const auto folded = revchain::stability(rope, branch.shapes.back());  // no mass moves across the axis
        CHECK((folded.verdict == revchain::Verdict::undecided || !folded.exponents.empty()));
        for (std::size_t i = 0; i < branch.shapes.size() / 4; i += 9) {
            const revchain::HeldCordShape& shape = branch.shapes[i];
            const auto there =
                revchain::steady_shape(held, {.mode = branch.half_waves, .conical_height = shape.conical_height});
            CHECK(std::abs(there.inclination[0] - shape.inclination[0]) < 1e-12);
            CHECK(there.moment_of_inertia == Approx(shape.moment_of_inertia).epsilon(1e-11));
            const double tension = shape.height_times_tension.tail(1)[0] / shape.conical_height;
            const auto taut = revchain::steady_shape(held, {.mode = branch.half_waves, .top_tension = tension});
            CHECK(taut.conical_height == Approx(shape.conical_height).epsilon(1e-11));
        }
    }
    const auto of = [&](Index links) {
        return revchain::steady_shape(Held(cut(links), {.span = 1.2}), {.mode = 2, .conical_height = 0.03})
            .moment_of_inertia;
    };
    const auto shape = revchain::steady_shape(held, {.mode = 2, .conical_height = 0.03});
    CHECK(extrapolated(of(80), of(160)) == Approx(shape.moment_of_inertia).epsilon(1e-6));
    CHECK_THROWS_AS(revchain::steady_shape(held, {.conical_height = 1.2}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::branches(Held<Cord>(rope, {.tension = 9.0}), {.min_conical_height = 0.1}),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(
        revchain::branches(Held<Cord>(rope, {.span = 1.0, .weightless = true}), {.min_conical_height = 0.1}),
        revchain::InvalidArgument);
}

TEST_CASE("held cord: stability is that of ever more links, by order 2") {
    for (const double height : {0.0, 0.05})
        for (const auto frame : {revchain::StabilityFrame::free, revchain::StabilityFrame::driven}) {
            CAPTURE(height, frame == revchain::StabilityFrame::free);
            const revchain::HeldBy by{.span = 1.2, .weightless = height == 0};
            const auto speed = height > 0 ? std::optional<double>(height) : std::nullopt;
            const auto shapes =
                revchain::steady_shapes(Held<Cord>(rope, by), {.conical_height = speed, .max_half_waves = 2});
            REQUIRE(shapes.shapes.size() == 2);
            for (std::size_t k = 0; k < 2; ++k) {
                const auto whole = revchain::stability(rope, shapes.shapes[k], frame);
                const auto of = [&](Index links) {
                    const Chain<double> chain = cut(links);
                    const auto found = revchain::steady_shapes(
                        Held(chain, by), {.conical_height = speed, .max_half_waves = 2, .prove = false});
                    return revchain::stability(chain, found.shapes[k], frame);
                };
                const auto few = of(40), many = of(80);
                CHECK(whole.verdict == many.verdict);
                CHECK(whole.negative_directions == many.negative_directions);
                double off_few = 0, off_many = 0, off_limit = 0;
                for (std::size_t i = 0; i < 4; ++i) {
                    const auto slow = [i](const auto& s) { return s.exponents[s.exponents.size() / 2 + i]; };
                    off_few += std::abs(slow(few) - slow(whole)), off_many += std::abs(slow(many) - slow(whole));
                    off_limit += std::abs(slow(many) + (slow(many) - slow(few)) / 3.0 - slow(whole));
                    CHECK(whole.external_damping[whole.exponents.size() / 2 + i] ==
                          Approx(-length / weight / 2).epsilon(1e-3));
                }
                CHECK(off_few / off_many == Approx(4).epsilon(0.2));
                CHECK(off_limit < 0.05 * off_few);
            }
        }
}

TEST_CASE("held cord: nearly straight without gravity, modes of a string seen from the turning frame") {
    const auto shapes =
        revchain::steady_shapes(Held<Cord>(rope, {.span = length * (1 - 1e-7), .weightless = true}), {});
    const auto found = revchain::stability(rope, shapes.shapes.at(0));
    CHECK(found.verdict == revchain::Verdict::minimum);
    // half waves j go with the speeds j, 1 being the turning one: j - 1 and j + 1
    for (const double expected : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
        double nearest = 1;
        for (const auto& s : found.exponents)
            nearest = std::min(nearest, std::abs(s - std::complex<double>(0, expected)));
        CAPTURE(expected);
        CHECK(nearest < 1e-5);
    }
    // two half waves are two ropes, whose motions it shares where they move alike
    const Held<Cord> half(Cord(length / 2, {.weight = weight / 2}), {.span = 0.6, .weightless = true});
    const auto one = revchain::stability(half.system(), revchain::steady_shapes(half, {}).shapes.at(0));
    const auto two = revchain::stability(
        rope, revchain::steady_shapes(Held<Cord>(rope, {.span = 1.2, .weightless = true}), {.max_half_waves = 2})
                  .shapes.at(1));
    for (std::size_t i = one.exponents.size() / 2; i < one.exponents.size() / 2 + 4; ++i) {
        double nearest = 1;
        for (const auto& s : two.exponents) nearest = std::min(nearest, std::abs(s - one.exponents[i]));
        CHECK(nearest < 1e-9);
    }
    CHECK_THROWS_AS(revchain::stability(half.system(), shapes.shapes.at(0)), revchain::InvalidArgument);
}

TEST_CASE("cord: derivatives of its heights are those of differences") {
    const auto slope = [](const auto& f, double x, double step) {
        return (f(x - 2 * step) - 8 * f(x - step) + 8 * f(x + step) - f(x + 2 * step)) / (12 * step);
    };
    const auto height = [](const auto& system) {
        return revchain::modes(system, {.first = 3, .count = 1}).conical_height[0];
    };
    for (const double p : {0.0, 1.3, -0.4})
        for (const double tip : {0.02, 2.0}) {
            CAPTURE(p, tip);
            const auto of = [&](double weight_of, double tip_of, double exponent) {
                return height(Cord(length, {.weight = weight_of, .density = exponent, .tip_weight = tip_of}));
            };
            const Cord cord(length, {.weight = weight, .density = p, .tip_weight = tip});
            const auto m = revchain::modes(cord, {.first = 3, .count = 1});
            const auto s = revchain::sensitivity(m);
            const double whole = m.conical_height[0];
            CHECK(s.length[0] == whole / length);
            const double by_weight = slope([&](double x) { return of(x, tip, p); }, weight, 1e-3 * weight),
                         by_tip = slope([&](double x) { return of(weight, x, p); }, tip, 1e-3 * tip),
                         by_exponent = slope([&](double x) { return of(weight, tip, x); }, p, 1e-3);
            CHECK(std::abs(s.weight[0] - by_weight) * weight < 1e-11 * whole);
            CHECK(std::abs(s.tip_weight[0] - by_tip) * tip < 1e-11 * whole);
            CHECK(std::abs(s.exponent[0] - by_exponent) < 1e-9 * whole);
            CHECK(s.tension[0] == 0);
        }
    for (const double tension : {3.001, 3.5, 5.9, 6.1, 3e4})
        for (const bool weightless : {false, true}) {
            CAPTURE(tension, weightless);
            const auto held = [&](double x) { return Held<Cord>(rope, {.tension = x, .weightless = weightless}); };
            const auto m = revchain::modes(held(tension), {.first = 3, .count = 1});
            const auto s = revchain::sensitivity(m);
            const double step = 1e-3 * (weightless ? tension : tension - weight);
            const double by_tension = slope([&](double x) { return height(held(x)); }, tension, step);
            CHECK(s.tension[0] == Approx(by_tension).epsilon(1e-8));
            CHECK(s.weight[0] * weight == Approx(-s.tension[0] * tension).epsilon(1e-14));
            CHECK(s.tip_weight[0] == 0);
        }
}

TEST_CASE("held cord: the tension at the upper end is at least that of the cord which hangs folded") {
    for (const double span : {0.02, 0.3, 1.2, 1.9}) {
        const Held<Cord> held(rope, {.span = span});
        const double least = weight * (1 + span / length) / 2;
        for (const int mode : {1, 2, 3}) {
            CAPTURE(span, mode);
            for (const double over : {1.02, 3.0}) {
                const auto shape = revchain::steady_shape(held, {.mode = mode, .top_tension = over * least});
                CHECK(shape.height_times_tension.tail(1)[0] / shape.conical_height == Approx(over * least));
            }
            CHECK_THROWS_WITH(revchain::steady_shape(held, {.mode = mode, .top_tension = least * (1 - 1e-12)}),
                              ContainsSubstring("no shape of the branch has this tension"));
        }
    }
}
