// SPDX-License-Identifier: GPL-3.0-or-later
// Cords hung from one end: closed forms and power series against each other, against ever more links, and small theory.
#include "revchain/cord.hpp"
#include "revchain/special/heavy_chain.hpp"
#include "revchain/special/tapered_chain.hpp"
#include "revchain/special/tip_mass.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/table.hpp"

namespace heavy_chain = revchain::analytic::heavy_chain;
namespace tapered_chain = revchain::analytic::tapered_chain;
namespace tip_mass = revchain::analytic::tip_mass;
using revchain::Cord;
using revchain::CordModes;
using revchain::Index;
using revchain::LineDensity;
using revchain::Vector;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A cord whose density goes like s^p, given as a function, so that series have to solve it.
Cord by_series(double length, double p, double tip_weight = 0) {
    const double weight = length / (p + 1);
    const auto density = [=](double s) { return std::pow(s / length, p); };
    return Cord(length, {.weight = weight, .density = density, .tip_weight = tip_weight});
}

}  // namespace

TEST_CASE("cord: the closed forms, each where it holds") {
    const CordModes uniform = revchain::modes(Cord(2.5), {.count = 40});
    CHECK(uniform.method == "zeros of J_0");
    CHECK(uniform.conical_height == heavy_chain::conical_heights(40, 2.5));
    CHECK(uniform.offset(6, 1.1) == heavy_chain::shape(1.1, 7, 2.5));
    CHECK(uniform.slope(6, 1.1) == heavy_chain::slope(1.1, 7, 2.5));
    CHECK(uniform.nodes(6) == heavy_chain::nodes(7, 2.5));
    CHECK(uniform.vertical_points(6) == heavy_chain::vertical_points(7, 2.5));

    const CordModes tapered = revchain::modes(Cord(2.5, {.weight = 9.0, .density = 1.5}), {.first = 3, .count = 5});
    CHECK(tapered.method == "zeros of J_p");
    CHECK(tapered.first == 3);
    CHECK(tapered.conical_height == tapered_chain::conical_heights(7, 2.5, 1.5).tail(5));
    CHECK(tapered.offset(1, 0.7) == tapered_chain::Mode(4, 2.5, 1.5).shape(0.7));
    CHECK(tapered.slope(1, 0.7) == tapered_chain::Mode(4, 2.5, 1.5).slope(0.7));
    CHECK(tapered.nodes(1) == tapered_chain::Mode(4, 2.5, 1.5).nodes());
    CHECK(tapered.vertical_points(1) == tapered_chain::Mode(4, 2.5, 1.5).vertical_points());

    // the particle weighs as much as 0.5 of cord
    const CordModes tip = revchain::modes(Cord(2.0, {.weight = 8.0, .tip_weight = 2.0}));
    CHECK(tip.method == "zeros of a cross product of Bessel functions");
    CHECK(tip.size() == 10);
    CHECK(tip.conical_height == tip_mass::conical_heights(10, 2.0, 0.5));
    CHECK(tip.offset(2, 1.2) == tip_mass::Mode(3, 2.0, 0.5).shape(1.2));
    CHECK(tip.slope(2, 1.2) == tip_mass::Mode(3, 2.0, 0.5).slope(1.2));
    CHECK(tip.nodes(2) == tip_mass::Mode(3, 2.0, 0.5).nodes());
    CHECK(tip.vertical_points(2) == tip_mass::Mode(3, 2.0, 0.5).vertical_points());

    CHECK(uniform.angular_speed(9.0)[0] == 3 / std::sqrt(uniform.conical_height[0]));
    CHECK(uniform.angular_speed()[1] == revchain::conical_pendulum::angular_speed(uniform.conical_height[1]));
    CHECK(uniform.period()[1] == revchain::conical_pendulum::period(uniform.conical_height[1]));
    const Vector<double> places = Vector<double>::LinSpaced(5, 0, 2.0), offsets = tip.offset(2, places),
                         slopes = tip.slope(2, places);
    for (Index i = 0; i < 5; ++i) {
        CHECK(offsets[i] == tip.offset(2, places[i]));
        CHECK(slopes[i] == tip.slope(2, places[i]));
    }
    CHECK(offsets[0] == 1);
    CHECK(std::abs(offsets[4]) < 1e-15);
}

TEST_CASE("cord: error bounds hold against 40 digits") {
    double worst = 0;
    for (const auto& row : support::table(REVCHAIN_TEST_DATA "/tip_mass.csv")) {
        const double tip = std::stod(row[0]);
        const Index mode = std::stol(row[1]);
        const CordModes m = revchain::modes(Cord(1, {.tip_weight = tip}), {.first = mode, .count = 1});
        const double off = std::abs(static_cast<double>(m.conical_height[0] / support::quad_of(row[2]) - 1));
        CHECK(off <= m.error_bound[0]);
        worst = std::max(worst, off);
    }
    CAPTURE(worst);
    CHECK(worst <= 2.4e-16);
}

TEST_CASE("cord: power series agree with the closed forms") {
    double heights = 0, offsets = 0, slopes = 0, nodes = 0, vertical = 0;
    const auto places_apart = [&](const CordModes& s, const CordModes& c, Index j, double length) {
        const Vector<double> places = Vector<double>::LinSpaced(60, 0, length);
        const Vector<double> offset = c.offset(j, places), slope = c.slope(j, places);
        const auto apart = [](const Vector<double>& x, const Vector<double>& y) {
            return x.size() > 0 ? (x - y).cwiseAbs().maxCoeff() : 0.0;
        };
        offsets = std::max(offsets, apart(s.offset(j, places), offset) / offset.cwiseAbs().maxCoeff());
        slopes = std::max(slopes, apart(s.slope(j, places), slope) / slope.cwiseAbs().maxCoeff());
        nodes = std::max(nodes, apart(s.nodes(j), c.nodes(j)) / length);
        vertical = std::max(vertical, apart(s.vertical_points(j), c.vertical_points(j)) / length);
    };
    for (const double p : {-0.5, 0.0, 0.5, 1.0, 3.0})
        for (const double length : {0.7, 40.0}) {
            const Cord series = by_series(length, p), closed(length, {.density = p});
            const CordModes s = revchain::modes(series, {.first = 2, .count = 6}),
                            c = revchain::modes(closed, {.first = 2, .count = 6});
            CAPTURE(p, length);
            CHECK(s.method == "power series");
            for (Index j = 0; j < 6; ++j) {
                const double off = std::abs(s.conical_height[j] / c.conical_height[j] - 1);
                CHECK(off <= s.error_bound[j] + c.error_bound[j]);
                heights = std::max(heights, off);
                REQUIRE(s.nodes(j).size() == j + 1);
                REQUIRE(s.vertical_points(j).size() == j + 1);
                places_apart(s, c, j, length);
            }
            for (const double at : {0.5, 0.02, 0.003})
                CHECK(revchain::count_modes(series, {.conical_height = at * length}) ==
                      revchain::count_modes(closed, {.conical_height = at * length}));
        }
    // a tip: the same cord, uniform by a function and by its exponent
    for (const double tip : {0.1, 1.0, 30.0}) {
        const Cord series = by_series(1.5, 0.0, tip), closed(1.5, {.weight = 1.5, .tip_weight = tip});
        const CordModes s = revchain::modes(series, {.count = 5}), c = revchain::modes(closed, {.count = 5});
        CAPTURE(tip);
        CHECK(s.method == "power series");
        for (Index j = 0; j < 5; ++j) {
            heights = std::max(heights, std::abs(s.conical_height[j] / c.conical_height[j] - 1));
            places_apart(s, c, j, 1.5);
        }
        CHECK(revchain::count_modes(series, {.conical_height = 0.01}) ==
              revchain::count_modes(closed, {.conical_height = 0.01}));
    }
    CAPTURE(heights, offsets, slopes, nodes, vertical);
    CHECK(heights < 2e-15);
    CHECK(offsets < 1e-14);
    CHECK(slopes < 1e-14);
    CHECK(nodes < 1e-15);
    CHECK(vertical < 1e-15);
}

TEST_CASE("cord: a power with a tip weight, against ever more links") {
    const Cord cord(1.0, {.weight = 2.0, .density = 1.0, .tip_weight = 0.5});
    const CordModes limit = revchain::modes(cord, {.count = 3});
    CHECK(limit.method == "power series");
    std::array<double, 3> off{}, apart{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Index size = 100 << i;
        const auto rods = revchain::Chain<double>::tapered(size, 1.0, 1.0, 2.0);
        std::vector<revchain::Link<double>> links;
        for (Index m = 0; m < size; ++m) links.push_back(rods.link(m));
        // the particle at the lower end of the lowest rod, as one body
        revchain::Link<double>& lowest = links.front();
        const double a = lowest.length, weight = lowest.weight + 0.5;
        const double second =
            lowest.weight * (lowest.centroid * lowest.centroid + static_cast<double>(lowest.gyration_ratio) * a * a) +
            0.5 * a * a;
        const double centroid = (lowest.weight * lowest.centroid + 0.5 * a) / weight;
        lowest.weight = weight, lowest.centroid = centroid;
        lowest.gyration_ratio = revchain::Wide<double>((second / weight - centroid * centroid) / (a * a));
        const auto linked = revchain::modes(revchain::Chain<double>(links), {.count = 3});
        off[i] = std::abs(linked.conical_height[2] / limit.conical_height[2] - 1);
        const Vector<double> shape = linked.shape(2) / linked.shape(2)[0];
        for (Index m = 0; m <= size; ++m)
            apart[i] = std::max(
                apart[i], std::abs(shape[m] - limit.offset(2, static_cast<double>(m) / static_cast<double>(size))));
    }
    CAPTURE(off, apart);
    CHECK(std::abs(std::log2(off[1] / off[2]) - 2) < 0.05);
    CHECK(std::abs(std::log2(apart[1] / apart[2]) - 2) < 0.05);
}

TEST_CASE("cord: numbers, windows, counts") {
    for (const Cord& cord : {Cord(3), Cord(3, {.density = 2.0}), Cord(3, {.tip_weight = 0.4}), by_series(3, 1)}) {
        const CordModes ten = revchain::modes(cord);
        CAPTURE(ten.method);
        REQUIRE(ten.size() == 10);
        CHECK(ten.range() == revchain::ModeRange{1, 10});
        for (Index j = 0; j < 10; ++j) {
            const double height = ten.conical_height[j];
            CHECK(revchain::count_modes(cord, {.conical_height = height * (1 + 1e-13)}) == j);
            CHECK(revchain::count_modes(cord, {.conical_height = height * (1 - 1e-13)}) == j + 1);
            CHECK(ten.nodes(j).size() == j);
            CHECK(ten.offset(j, 0) == 1);
            CHECK(std::abs(ten.slope(j, 0) * height + 1) < 4e-16);
            CHECK(std::abs(ten.offset(j, 3)) < 1e-13);
        }
        const double low = ten.conical_height[5] * 0.999, high = ten.conical_height[2] * 1.001;
        const auto window = revchain::modes(cord, {.conical_height = revchain::HeightWindow<double>{low, high}});
        CHECK(window.range() == revchain::ModeRange{3, 4});
        CHECK(window.offset(0, 1.0) == ten.offset(2, 1.0));
        const auto speeds = ten.angular_speed(2.0);
        const revchain::SpeedWindow<double> between{0, speeds[5] * 1.001};
        CHECK(revchain::modes(cord, {.angular_speed = between, .gravity = 2.0}).size() == 6);
        CHECK(revchain::count_modes(cord, {.angular_speed = speeds[5] * 1.001, .gravity = 2.0}) == 6);
        CHECK(revchain::modes(cord, {.conical_height = revchain::HeightWindow<double>{5, infinity}}).size() == 0);
        CHECK(revchain::modes(cord, {.rtol = 1e-14}).status == revchain::Status::success);
        CHECK(revchain::modes(cord, {.rtol = 1e-17}).status == revchain::Status::tolerance_not_met);
    }
    CHECK(revchain::count_modes(Cord(1), {.conical_height = 1e-12}) == 636'620);  // 2e6 / pi + 1/4
}

TEST_CASE("cord: weights scale tensions and nothing else") {
    const Cord unit(2.0, {.weight = 2.0, .tip_weight = 0.3}), heavy(2.0, {.weight = 20.0, .tip_weight = 3.0});
    CHECK(revchain::modes(unit).conical_height == revchain::modes(heavy).conical_height);
    const auto light = revchain::steady_shapes(unit, {.conical_height = 0.2}),
               ten = revchain::steady_shapes(heavy, {.conical_height = 0.2});
    REQUIRE(light.shapes.size() == ten.shapes.size());
    for (std::size_t j = 0; j < light.shapes.size(); ++j) {
        CHECK((light.shapes[j].inclination - ten.shapes[j].inclination).cwiseAbs().maxCoeff() < 1e-12);
        CHECK((10 * light.shapes[j].tension - ten.shapes[j].tension).cwiseAbs().maxCoeff() < 1e-11);
        CHECK(std::abs(light.shapes[j].tension[0] - 0.3 * std::hypot(1.0, light.shapes[j].offset[0] / 0.2)) < 1e-12);
    }
    // by a function: its own unit, or a weight that only the proportions share
    const auto thicker = [](double s) { return 1 + s; };
    const Cord own(2.0, {.density = thicker}), given(2.0, {.weight = 8.0, .density = thicker});
    CHECK(std::abs(own.weight() - 4) < 1e-14);
    CHECK(given.weight() == 8);
    const auto a = revchain::steady_shapes(own, {.conical_height = 0.2}).shapes.at(0),
               b = revchain::steady_shapes(given, {.conical_height = 0.2}).shapes.at(0);
    CHECK((2 * a.tension - b.tension).cwiseAbs().maxCoeff() < 1e-12);
    CHECK(a.inclination == b.inclination);
    CHECK(std::abs(b.tension[b.tension.size() - 1] * std::cos(b.inclination[b.inclination.size() - 1]) - 8) < 1e-12);
    // a density of s^p is the same by its exponent and by a function
    const Cord power(2.0, {.weight = 3.0, .density = 2.0}),
        function(2.0, {.weight = 3.0, .density = [](double s) { return s * s; }});
    const auto c = revchain::steady_shapes(power, {.conical_height = 0.1}),
               d = revchain::steady_shapes(function, {.conical_height = 0.1});
    REQUIRE(c.shapes.size() == d.shapes.size());
    for (std::size_t j = 0; j < c.shapes.size(); ++j)
        CHECK(std::abs(c.shapes[j](1.3).offset - d.shapes[j](1.3).offset) < 1e-12);
    // several cords share one density; the shapes keep it
    auto shared = std::make_shared<const LineDensity>(thicker, 2.0);
    const auto e = revchain::steady_shapes(Cord(2.0, {.density = std::exchange(shared, nullptr)}),
                                           {.angular_speed = 7.0, .gravity = 9.8})
                       .shapes.at(0);
    CHECK(std::abs(e(1.3).offset - a(1.3).offset) < 1e-12);
}

TEST_CASE("cord: wrong cords, and questions without an answer") {
    using Catch::Matchers::ContainsSubstring;
    using revchain::InvalidArgument;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, nan, infinity}) {
        CAPTURE(bad);
        CHECK_THROWS_AS(Cord(bad), InvalidArgument);
        CHECK_THROWS_AS(Cord(1, {.weight = bad}), InvalidArgument);
        CHECK_THROWS_AS(Cord(1, {.density = [=](double) { return bad; }}), InvalidArgument);
        if (bad != 0) CHECK_THROWS_AS(Cord(1, {.tip_weight = bad}), InvalidArgument);
        CHECK_THROWS_AS(revchain::steady_shapes(Cord(1), {.conical_height = bad}), InvalidArgument);
        CHECK_THROWS_AS(revchain::steady_shapes(Cord(1), {.angular_speed = bad}), InvalidArgument);
        CHECK_THROWS_AS(revchain::steady_shapes(Cord(1), {.angular_speed = 1.0, .gravity = bad}), InvalidArgument);
        CHECK_THROWS_AS(revchain::count_modes(Cord(1), {.conical_height = bad}), InvalidArgument);
        CHECK_THROWS_AS(revchain::count_modes(Cord(1), {.angular_speed = bad}), InvalidArgument);
        CHECK_THROWS_AS(revchain::modes(Cord(1)).angular_speed(bad), InvalidArgument);
        CHECK_THROWS_AS(revchain::modes(Cord(1)).period(bad), InvalidArgument);
    }
    for (const double bad : {-1.0, -2.0, 1.1e4, nan, infinity})
        CHECK_THROWS_WITH(Cord(1, {.density = bad}), ContainsSubstring("exponent of the density"));
    CHECK_THROWS_WITH(Cord(1, {.density = std::make_shared<const LineDensity>([](double) { return 1.0; }, 2.0)}),
                      ContainsSubstring("over the length of the cord"));
    CHECK_THROWS_AS(Cord(1, {.density = std::shared_ptr<const LineDensity>()}), InvalidArgument);
    CHECK_THROWS_AS(Cord(1, {.density = std::function<double(double)>()}), InvalidArgument);

    const Cord cord(1);
    CHECK_THROWS_WITH(revchain::modes(cord, {.count = revchain::all_modes}), ContainsSubstring("infinitely many"));
    CHECK_THROWS_WITH(revchain::modes(cord, {.conical_height = revchain::HeightWindow<double>{0, 1}}),
                      ContainsSubstring("infinitely many"));
    CHECK_THROWS_WITH(revchain::modes(cord, {.angular_speed = revchain::SpeedWindow<double>{1, infinity}}),
                      ContainsSubstring("infinitely many"));
    CHECK_THROWS_AS(revchain::modes(cord, {.first = 0}), InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(cord, {.count = 0}), InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(cord, {.rtol = nan}), InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(cord, {.conical_height = revchain::HeightWindow<double>{2, 1}}), InvalidArgument);
    CHECK_THROWS_WITH(revchain::modes(by_series(1, 1), {.first = 100'000, .count = 2}), ContainsSubstring("100000"));
    CHECK_THROWS_WITH(revchain::modes(Cord(1, {.density = 30.0, .tip_weight = 1})), ContainsSubstring("up to 20 only"));
    CHECK(revchain::modes(Cord(1, {.density = 30.0})).size() == 10);
    CHECK_THROWS_WITH(revchain::count_modes(by_series(1, 1), {.conical_height = 1e-7}), ContainsSubstring("1e6"));
    CHECK_THROWS_WITH(revchain::count_modes(cord, {}), ContainsSubstring("give either"));
    CHECK_THROWS_WITH(revchain::count_modes(cord, {.conical_height = 1.0, .angular_speed = 1.0}),
                      ContainsSubstring("give either"));
    CHECK_THROWS_WITH(revchain::count_modes(cord, {.conical_height = 1e-40}), ContainsSubstring("more than 1e15"));
    CHECK_THROWS_WITH(revchain::steady_shapes(cord, {}), ContainsSubstring("give either"));
    CHECK_THROWS_WITH(revchain::steady_shapes(cord, {.conical_height = 1e-7}), ContainsSubstring("at most 1e6"));
    CHECK_THROWS_WITH(revchain::steady_shapes(cord, {.conical_height = 1.0, .scanned = 0}),
                      ContainsSubstring("scanned"));

    for (const CordModes& modes : {revchain::modes(cord, {.count = 2}), revchain::modes(by_series(1, 1), {.count = 2})})
        for (const Index wrong : {-1, 2}) {
            CHECK_THROWS_AS(modes.offset(wrong, 0.5), InvalidArgument);
            CHECK_THROWS_AS(modes.slope(wrong, 0.5), InvalidArgument);
            CHECK_THROWS_AS(modes.nodes(wrong), InvalidArgument);
            CHECK_THROWS_AS(modes.vertical_points(wrong), InvalidArgument);
            for (const double outside : {-0.1, 1.1, nan}) {
                CHECK_THROWS_AS(modes.offset(0, outside), InvalidArgument);
                CHECK_THROWS_AS(modes.slope(0, outside), InvalidArgument);
            }
        }

    revchain::Progress progress;
    CHECK(revchain::modes(cord, {.count = 4, .progress = &progress}).size() == 4);
    CHECK(progress.fraction() == 1);
    progress.cancel();
    CHECK_THROWS_AS(revchain::modes(cord, {.count = 4, .progress = &progress}), revchain::Cancelled);
}
