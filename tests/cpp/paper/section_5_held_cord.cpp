// SPDX-License-Identifier: MPL-2.0
// Cords held at both ends: against the closed form without gravity, integration in quadruple precision with it, and links.
#include "revchain/held.hpp"

#include "revchain/rope.hpp"
#include "support/catch.hpp"
#include "support/held.hpp"
#include "support/truth.hpp"

using revchain::Cord;
using revchain::Held;
using revchain::HeldCordShape;
using revchain::Index;
using support::Quad;

TEST_CASE("cord held at both ends: the skipping rope without gravity") {
    double worst = 0, of_pull = 0;
    for (const double span : {0.999999, 0.9, 0.5, 0.1, 0.01, 0.001})
        for (const int waves : {1, 2, 3, 5}) {
            const auto found = support::held_shapes(Cord(1), span, 0, {.max_half_waves = waves});
            REQUIRE(found.shapes.size() == static_cast<std::size_t>(waves));
            CHECK(found.complete);  // length over span, 2 E/(k'^2 K) - 1, rises with the modulus k
            const HeldCordShape& shape = found.shapes.back();
            const revchain::analytic::SkippingRope rope(
                {.span = span, .length = 1.0, .angular_speed = 1.0, .half_waves = waves});
            INFO("span " << span << ", " << waves << " half waves");
            CHECK(shape.half_waves == waves);
            double error = 0;
            const auto compare = [&](double arc, double offset, double height, double tension) {
                const auto point = rope.at_arc(arc);
                error = std::max({error, std::abs(point.offset - offset), std::abs(point.x - height),
                                  std::abs(point.tension_ratio * rope.height_times_tension() - tension)});
            };
            for (Index i = 0; i < shape.arc_length.size(); ++i)
                compare(shape.arc_length[i], shape.offset[i], shape.height[i], shape.height_times_tension[i]);
            for (int i = 0; i <= 64; ++i) {
                const auto place = shape(i / 64.0);
                compare(i / 64.0, place.offset, place.height, place.height_times_tension);
            }
            CHECK(error <= shape.error_bound);
            worst = std::max(worst, span > 0.99 ? error / 10 : error);
            of_pull = std::max(of_pull, std::abs(shape.lower_pull[1] / rope.height_times_tension() - 1));
        }
    CAPTURE(worst, of_pull);
    CHECK(worst < 3e-15);
    CHECK(of_pull < 2.5e-15);
}

TEST_CASE("cord held at both ends: forces lead to the upper end, in quadruple precision") {
    double worst = 0;
    for (const double span : {0.95, 0.6, 0.3})
        for (const double height : {0.005, 0.05, 0.15}) {
            const auto found = support::held_shapes(Cord(1), span, height, {.max_half_waves = 2});
            for (const HeldCordShape& shape : found.shapes) {
                INFO("span " << span << ", height " << height << ", " << shape.half_waves << " half waves");
                // (y, z, u, V) by the arc, u and V the upward pull: classical Runge-Kutta steps, extrapolated to order 5
                using State = std::array<Quad, 4>;
                const auto slope = [&](const State& at) {
                    const Quad pull = sqrtq(at[2] * at[2] + at[3] * at[3]);
                    return State{at[2] / pull, at[3] / pull, -at[0], Quad(height)};
                };
                const auto along = [](const State& at, const State& k, Quad by) {
                    return State{at[0] + by * k[0], at[1] + by * k[1], at[2] + by * k[2], at[3] + by * k[3]};
                };
                const auto eighths = [&](int steps) {
                    std::vector<State> result;
                    State x{0, 0, shape.lower_pull[0], shape.lower_pull[1]};
                    const Quad h = Quad(1) / (8 * steps);
                    for (int i = 1; i <= 8 * steps; ++i) {
                        const auto a = slope(x), b = slope(along(x, a, h / 2)), c = slope(along(x, b, h / 2)),
                                   d = slope(along(x, c, h));
                        for (std::size_t j = 0; j < 4; ++j) x[j] += h / 6 * (a[j] + 2 * b[j] + 2 * c[j] + d[j]);
                        if (i % steps == 0) result.push_back(x);
                    }
                    return result;
                };
                const auto coarse = eighths(512), fine = eighths(1024);
                double error = 0;
                for (std::size_t i = 0; i < 8; ++i) {
                    State x;
                    for (std::size_t j = 0; j < 4; ++j) x[j] = fine[i][j] + (fine[i][j] - coarse[i][j]) / 15;
                    const auto place = shape(static_cast<double>(i + 1) / 8);
                    error = std::max(
                        {error, std::abs(static_cast<double>(x[0] - Quad(place.offset))),
                         std::abs(static_cast<double>(x[1] - Quad(place.height))),
                         std::abs(static_cast<double>(hypotq(x[2], x[3]) - Quad(place.height_times_tension)))});
                }
                CHECK(error <= shape.error_bound);
                worst = std::max(worst, error);
            }
        }
    CAPTURE(worst);
    CHECK(worst < 1.1e-15);
}

TEST_CASE("cord held at both ends: links tend to it by order 2, with gravity") {
    for (const double height : {0.02, 0.2}) {
        const HeldCordShape cord = support::held_shapes(Cord(1), 0.5, height).shapes.at(0);
        std::array<double, 3> off{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Index size = 60 << i;
            const auto rods = support::held_shapes(revchain::Chain<double>::uniform_rods(size), 0.5, height);
            for (Index m = 0; m <= size; ++m) {
                const auto place = cord(static_cast<double>(m) / static_cast<double>(size));
                off[i] = std::max(off[i], std::abs(place.offset - rods.shapes.at(0).offset[m]));
            }
        }
        CAPTURE(off);
        CHECK(std::abs(std::log2(off[1] / off[2]) - 2) < 0.007);
    }
}

TEST_CASE("cord held at both ends: slow speeds fold it along the axis, tensions, units, refusals") {
    CHECK(support::held_shapes(Cord(1), 0.5, 0.4).shapes.size() == 1);
    const auto folded = support::held_shapes(Cord(1), 0.5, 0.5);
    CHECK(folded.shapes.empty());
    CHECK(folded.missing == std::vector<int>{1});

    const Cord heavy(3, {.weight = 7});
    const HeldCordShape shape = support::held_shapes(heavy, 1.5, 0.3).shapes.at(0),
                        unit = support::held_shapes(Cord(1), 0.5, 0.1).shapes.at(0);
    CHECK(std::abs(shape.lower_pull[1] / unit.lower_pull[1] / 21 - 1) < 1e-14);
    CHECK(std::abs(shape.offset.maxCoeff() / unit.offset.maxCoeff() / 3 - 1) < 1e-14);
    CHECK(std::abs(shape.lower_pull[1] + shape.upper_pull[1] + 0.3 * 7) < 1e-15 * 10);

    // slower, the tension grows with the span; faster, it is largest between
    double wanted = 0;
    for (const auto& [height, count] : {std::pair{0.3, 1}, {0.15, 2}}) {
        const HeldCordShape given = support::held_shapes(heavy, 1.5, height).shapes.at(0);
        wanted = given.height_times_tension[given.height_times_tension.size() - 1];
        const auto under =
            revchain::steady_shapes(Held(heavy, {.tension = wanted / height}), {.conical_height = height});
        REQUIRE(under.shapes.size() == static_cast<std::size_t>(count));
        double nearest = 1;
        for (const auto& found : under.shapes) {
            CHECK(std::abs(found.height_times_tension[found.height_times_tension.size() - 1] / wanted - 1) < 1e-15);
            nearest = std::min(nearest, std::abs(found.span - 1.5));
        }
        CHECK(nearest < 1e-12);
    }
    CHECK(
        revchain::steady_shapes(Held(heavy, {.tension = 100 * wanted / 0.3}), {.conical_height = 0.3}).shapes.empty());

    using revchain::InvalidArgument;
    CHECK_THROWS_AS(Held(Cord(1), {.span = 1.0}), InvalidArgument);
    CHECK_THROWS_AS(unit(1.5), InvalidArgument);
}
