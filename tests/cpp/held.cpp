// SPDX-License-Identifier: MPL-2.0
// Chains held at both ends: against the bodies' Lagrangian in quadruple precision, triangles, the closed form of the
// skipping rope, laws, and small theory.
#include "revchain/held.hpp"

#include "revchain/rope.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/held.hpp"
#include "support/held_straight.hpp"
#include "support/held_truth.hpp"
#include "support/truth.hpp"

namespace {

using revchain::Chain;
using revchain::Held;
using revchain::HeldShape;
using revchain::Index;
using support::Quad;
using support::quad;

}  // namespace

TEST_CASE("held at both ends: inclinations within their proved bound of a Lagrangian in quadruple precision") {
    int shapes = 0, sharp = 0;
    double worst = 0, largest_bound = 0;
    for (const auto& family : support::families()) {
        if (family.name.find("1e12") != std::string::npos) continue;
        for (const Index size : {3, 6, 15})
            for (const double share : {0.999999, 0.8, 0.4, 0.1})
                for (const double slow : {0.0, 0.01, 0.05}) {
                    const Chain<double> chain = family.make(size);
                    const double length = chain.total_length();
                    const auto found =
                        support::held_shapes(chain, share * length, slow * length, {.max_half_waves = 3, .budget = 0});
                    CHECK(found.shapes.size() + found.missing.size() == 3);
                    CHECK_FALSE(found.complete);
                    for (const HeldShape& shape : found.shapes) {
                        INFO(family.name << ", " << size << " links, span " << share << ", height " << slow);
                        const double error = support::held_against_truth(chain, {}, shape);
                        ++shapes;
                        sharp += shape.error_bound < 4.5e-16;
                        CHECK(error <= shape.error_bound);
                        CHECK(shape.proved);
                        CHECK(shape.residual < 1e-28);
                        worst = std::max(worst, error), largest_bound = std::max(largest_bound, shape.error_bound);
                    }
                }
    }
    CAPTURE(shapes, sharp, worst, largest_bound);
    CHECK(sharp > 0.96 * shapes);
    CHECK(shapes > 360);
    CHECK(worst < 1.12e-16);
}

TEST_CASE("held at both ends: extremes of weight") {
    for (const auto& family : support::families()) {
        if (family.name.find("1e12") == std::string::npos) continue;
        const Chain<double> chain = family.make(8);
        for (const double share : {0.99, 0.7}) {
            const auto found = support::held_shapes(chain, share * chain.total_length(), 0.0);
            for (const HeldShape& shape : found.shapes) {
                INFO(family.name << " " << share);
                CHECK(support::held_against_truth(chain, {}, shape) <= shape.error_bound);
            }
        }
    }
}

TEST_CASE("held at both ends: two links make a triangle") {
    const double lower = 1.25, upper = 1.0, span = 1.5, heavy = 3.0;
    const Chain<double> chain({revchain::plummet(7.0, lower), revchain::plummet(heavy, upper)});
    const double up = (lower * lower - upper * upper + span * span) / (2 * span);
    const double out = std::sqrt(lower * lower - up * up);
    for (const double height : {0.0, 0.3}) {
        const auto found = support::held_shapes(chain, span, height, {.max_half_waves = 2});
        REQUIRE(found.shapes.size() == 1);
        CHECK(found.missing == std::vector<int>{2});
        const HeldShape& shape = found.shapes[0];
        CHECK(std::abs(shape.offset[1] - out) < 2e-16);
        CHECK(std::abs(shape.height[1] - up) < 3e-16);
        // both threads pull the upper plummet inwards, the upper thread by P up, the lower by Q down
        const double across = heavy * out;  // lambda times the centrifugal force
        // P out/(span - up) + Q out/up = across,   P - Q = height heavy; the lower plummet lies on its bearing
        const double Q = (across / out - height * heavy / (span - up)) / (1 / (span - up) + 1 / up);
        CHECK(std::abs(shape.lower_pull[1] - (Q - 7 * height)) < 2e-15);
        CHECK(std::abs(shape.lower_pull[0] - Q * out / up) < 2e-15);
        CHECK(std::abs(shape.upper_pull[1] + Q + height * heavy) < 2e-15);
    }
    // the lower thread cannot reach so far without the upper pushing
    const Chain<double> uneven({revchain::plummet(1.0, 2.0), revchain::plummet(1.0, 1.0)});
    CHECK(support::held_shapes(uneven, 1.5, 0.0).shapes.empty());
}

TEST_CASE("held at both ends: many links tend to the skipping rope by order 2") {
    for (const int waves : {1, 2, 3}) {
        const revchain::analytic::SkippingRope rope(
            {.span = 0.5, .length = 1.0, .angular_speed = 1.0, .half_waves = waves});
        std::array<double, 3> rods{}, plummets{}, pull{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Index size = 60 << i;
            const auto off = [&](const Chain<double>& chain) {
                const auto found = support::held_shapes(chain, 0.5, 0.0, {.max_half_waves = waves});
                REQUIRE(found.shapes.size() == static_cast<std::size_t>(waves));
                const HeldShape& shape = found.shapes.back();
                CHECK(shape.half_waves == waves);
                pull[i] = shape.lower_pull[1] / rope.height_times_tension() - 1;
                double worst = 0;
                for (Index m = 0; m <= size; ++m) {
                    const auto point = rope.at_arc(static_cast<double>(m) / static_cast<double>(size));
                    worst = std::max(
                        {worst, std::abs(point.offset - shape.offset[m]), std::abs(point.x - shape.height[m])});
                }
                return worst;
            };
            plummets[i] = off(Chain<double>::uniform_plummets(size)), rods[i] = off(Chain<double>::uniform_rods(size));
        }
        const double of_rods = std::log2(rods[1] / rods[2]), of_plummets = std::log2(plummets[1] / plummets[2]),
                     of_pull = std::log2(pull[1] / pull[2]);
        INFO(waves << " half waves: " << rods[2] << " " << plummets[2] << " " << pull[2]);
        CAPTURE(of_rods, of_plummets, of_pull);
        CHECK(std::abs(of_rods - 2) < 0.02);
        CHECK(std::abs(of_plummets - 2) < 0.02);
        CHECK(std::abs(of_pull - 2) < 0.02);
    }
}

TEST_CASE("held at both ends: laws") {
    const Chain<double> chain = support::families()[3].make(12);
    const double length = chain.total_length(), span = 0.6 * length, height = 0.04 * length;
    const HeldShape shape = support::held_shapes(chain, span, height).shapes.at(0);
    double weight = 0, centrifugal = 0, moment = 0;
    for (Index m = 0; m < chain.size(); ++m) {
        const auto link = chain.link(m);
        const double y = shape.offset[m + 1] + link.centroid * std::sin(shape.inclination[m]),
                     z = shape.height[m + 1] - link.centroid * std::cos(shape.inclination[m]),
                     turn = static_cast<double>(link.gyration_ratio) * link.length * link.length;
        weight += link.weight, centrifugal += link.weight * y;
        // about the lower end, centrifugal forces outwards and weights down; of a turned rod its product of inertia
        moment +=
            link.weight * (y * z + height * y - turn * std::sin(shape.inclination[m]) * std::cos(shape.inclination[m]));
    }
    CHECK(std::abs(shape.lower_pull[0] + shape.upper_pull[0] - centrifugal) < 4e-15 * centrifugal);
    CHECK(std::abs(shape.lower_pull[1] + shape.upper_pull[1] + height * weight) < 4e-15 * height * weight);
    CHECK(std::abs(shape.upper_pull[0] * span - moment) < 8e-15 * moment);

    SECTION("other units") {
        std::vector<revchain::Link<double>> links;
        for (Index m = 0; m < chain.size(); ++m) {
            auto link = chain.link(m);
            link.weight *= 0x1p40, link.length *= 0x1p-30, link.centroid *= 0x1p-30;
            links.push_back(link);
        }
        const HeldShape same =
            support::held_shapes(Chain<double>(links), span * 0x1p-30, height * 0x1p-30).shapes.at(0);
        CHECK(same.inclination == shape.inclination);
        CHECK(same.lower_pull[0] == shape.lower_pull[0] * 0x1p10);
        CHECK(same.moment_of_inertia == shape.moment_of_inertia * 0x1p-20);
        CHECK(same.height_times_energy == shape.height_times_energy * 0x1p-20);
    }
    SECTION("symmetric without gravity") {
        const HeldShape even = support::held_shapes(Chain<double>::uniform_rods(11), 0.5, 0.0).shapes.at(0);
        for (Index m = 0; m < 11; ++m) CHECK(std::abs(even.inclination[m] + even.inclination[10 - m]) < 2.3e-16);
    }
    SECTION("the speed, in two words") {
        const Held held(chain, {.span = span});
        const auto at =
            revchain::steady_shapes(held, {.angular_speed = std::sqrt(9.81 / height), .gravity = 9.81}).shapes.at(0);
        CHECK((at.inclination - shape.inclination).cwiseAbs().maxCoeff() < 1e-15);
        const Held light(chain, {.span = span, .weightless = true});
        const auto none = revchain::steady_shapes(light, {.angular_speed = 5.0}).shapes.at(0);
        CHECK(revchain::steady_shapes(light).shapes.at(0).inclination == none.inclination);
        CHECK(none.inclination == support::held_shapes(chain, span, 0.0).shapes.at(0).inclination);
    }
    SECTION("tension instead of span") {
        const double wanted = shape.height_times_tension[chain.size()];
        const auto under = [&](double tension) {
            return revchain::steady_shapes(Held(chain, {.tension = tension}), {.conical_height = height});
        };
        const auto found = under(wanted / height);
        REQUIRE(found.shapes.size() == 1);
        double nearest = length;
        for (const HeldShape& other : found.shapes) {
            CHECK(std::abs(other.height_times_tension[chain.size()] / wanted - 1) < 1e-15);
            nearest = std::min(nearest, std::abs(other.span - span));
        }
        CHECK(nearest < 1e-12 * length);
        CHECK(under(10 * wanted / height).shapes.empty());
    }
    SECTION("change of inclinations with the span") {
        const double by = 1e-6;
        double worst = 0;
        for (const auto& [further, slower] : {std::pair{1 + by, 1.0}, {1.0, 1 + by}}) {
            const HeldShape moved = support::held_shapes(chain, span * further, height * slower).shapes.at(0);
            worst = std::max(worst, (moved.inclination - shape.inclination).cwiseAbs().maxCoeff() / by);
        }
        CHECK(std::abs(worst / shape.condition - 1) < 1e-5);
    }
}

TEST_CASE("held at both ends: refused, and nothing where a chain folds") {
    const Chain<double> chain = Chain<double>::uniform_rods(20);
    using revchain::InvalidArgument;
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, nan, infinity}) {
        CAPTURE(bad);
        CHECK_THROWS_AS(Held(chain, {.span = bad}), InvalidArgument);
        CHECK_THROWS_AS(Held(chain, {.tension = bad}), InvalidArgument);
        const Held held(chain, {.span = 0.5});
        CHECK_THROWS_AS(revchain::steady_shapes(held, {.conical_height = bad}), InvalidArgument);
        CHECK_THROWS_AS(revchain::steady_shapes(held, {.angular_speed = bad}), InvalidArgument);
        CHECK_THROWS_AS(revchain::steady_shapes(held, {.angular_speed = 1.0, .gravity = bad}), InvalidArgument);
        const Held light(chain, {.span = 0.5, .weightless = true});
        CHECK_THROWS_AS(revchain::steady_shapes(light, {.angular_speed = bad}), InvalidArgument);
    }
    const auto slow = support::held_shapes(chain, 0.5, 10.0, {.max_half_waves = 2});
    CHECK(slow.shapes.empty());
    CHECK(slow.missing == std::vector<int>{1, 2});
    CHECK(support::held_shapes(Chain<double>::uniform_rods(1), 0.5, 0.1).shapes.empty());
}

TEST_CASE("held straight: heights within their proved bound, an ulp, of the assembled pencil in quadruple precision") {
    const revchain::Support soft{.stiffness = 3.0}, laden{.stiffness = 0.5, .carriage_weight = 0.25};
    for (const auto& family : support::families())
        for (const Index size : {2, 5, 40})
            for (const double pull : {1e-3, 1.0, 1e3})
                for (const auto& [lower, upper] : {std::pair<revchain::Support, revchain::Support>{}, {soft, laden}}) {
                    const Chain<double> chain = family.make(size);
                    const double tension = (1 + pull) * chain.total_weight();
                    const Held held(chain, {.tension = tension, .lower = lower, .upper = upper});
                    if (revchain::count_modes(held, {.conical_height = 1e-300}) == 0) continue;
                    const auto modes = revchain::modes(held, {.count = revchain::all_modes});
                    const support::TautCounts above(chain, tension, lower, upper);
                    CHECK(modes.status == revchain::Status::success);
                    CHECK(modes.size() == above(Quad(1e-25) * modes.conical_height[modes.size() - 1]));
                    for (Index k = 0; k < modes.size(); ++k) {
                        INFO(family.name << " " << size << " " << pull << " mode " << k + 1);
                        const Quad height = modes.conical_height[k], by = modes.error_bound[k];
                        CHECK(by <= revchain::epsilon<double>() * (1 + 1e-14));
                        CHECK(above(height * (1 - by)) == k + 1);
                        CHECK(above(height * (1 + by)) == k);
                    }
                }
}

TEST_CASE("held straight: a tension barely above the weight, or far above it") {
    for (const auto& family : support::families())
        for (const double more : {0x1p-52, 0x1p-40, 1e15}) {
            const Chain<double> chain = family.make(12);
            double tension = chain.total_weight() * (1 + more);
            while (!(revchain::Wide<double>(tension) > chain.weight_below(12)))
                tension = std::nextafter(tension, 1e300);
            const auto modes = revchain::modes(Held(chain, {.tension = tension}));
            const support::TautCounts above(chain, tension);
            for (Index k = 0; k < modes.size(); ++k) {
                INFO(family.name << " " << more << " mode " << k + 1);
                const Quad height = modes.conical_height[k], by = modes.error_bound[k];
                CHECK(by <= revchain::epsilon<double>() * (1 + 1e-14));
                CHECK(above(height * (1 - by)) == k + 1);
                CHECK(above(height * (1 + by)) == k);
            }
        }
}

TEST_CASE("held straight: where shapes of finite amplitude begin") {
    const Chain<double> chain = support::families()[2].make(9);
    const double length = chain.total_length(), height = 0.03 * length;
    for (const double slack : {1e-4, 1e-6}) {
        const HeldShape shape = support::held_shapes(chain, length * (1 - slack), height).shapes.at(0);
        const auto modes = revchain::modes(Held(chain, {.tension = -shape.upper_pull[1] / height}), {.count = 1});
        CHECK(std::abs(modes.conical_height[0] / height - 1) < 3 * slack);
        const revchain::Vector<double> scaled = shape.offset / shape.offset.cwiseAbs().maxCoeff();
        CHECK((scaled - modes.shape(0)).cwiseAbs().maxCoeff() < 3 * slack);
    }
}

TEST_CASE("held straight: the tension at the upper end, less the weight in double-double") {
    for (const auto& family : support::families()) {
        const Chain<double> chain = family.make(12);
        const double tension = 1.25 * chain.total_weight();
        INFO(family.name);
        const auto modes = revchain::modes(Held(chain, {.tension = tension}));
        const support::TautCounts above(chain, tension);
        const auto all = revchain::modes(Held(chain, {.tension = tension}), {.count = revchain::all_modes});
        REQUIRE(modes.size() == std::min<Index>(10, all.size()));
        CHECK(modes.first == 1);
        CHECK(modes.method == "bisection");
        CHECK(modes.status == revchain::Status::success);
        const auto& shapes = modes.shapes();
        for (Index j = 0; j < modes.size(); ++j) {
            CHECK(modes.conical_height[j] == all.conical_height[j]);
            CHECK(modes.shape(j) == all.shape(j));
            CHECK(above.unbalanced(modes.conical_height[j], modes.shape(j)) < 1e-15);
            const double height = modes.conical_height[j];
            CHECK(revchain::count_modes(Held(chain, {.tension = tension}), {.conical_height = height * (1 - 1e-14)}) ==
                  j + 1);
            CHECK(revchain::count_modes(Held(chain, {.tension = tension}), {.conical_height = height * (1 + 1e-14)}) ==
                  j);
            CHECK(modes.residual()[j] < 1e-15);
            // mode k has k - 1 nodes, each between two pins of different sign
            const auto& nodes = modes.nodes()[static_cast<std::size_t>(j)];
            Index changes = 0;
            double below = 0;
            for (Index m = 0; m < 12; ++m) {
                const double y = shapes(j, m), next = shapes(j, m + 1), length = chain.link(m).length;
                if (y * next < 0) {
                    REQUIRE(changes < nodes.size());
                    CHECK(std::abs(nodes[changes] - (below + length * y / (y - next))) < 1e-14 * chain.total_length());
                    ++changes;
                }
                below += length;
            }
            CHECK(changes == nodes.size());
        }
    }
}

TEST_CASE("held straight: two plummets on three threads, in closed form") {
    // lambda K y = M y with the tensions 2 w + T, w + T and T over the threads of length 1: M is the weight w
    const double w = 0.5, T = 3.0;
    const Chain<double> chain({revchain::plummet(w, 1.0), revchain::plummet(w, 1.0), revchain::plummet(w, 1.0)});
    const auto modes = revchain::modes(Held(chain, {.tension = 3 * w + T}));  // the lowest one lies on its bearing
    REQUIRE(modes.size() == 2);
    const double lower = w + T, middle = 2 * w + T, upper = 3 * w + T;  // in the three threads
    const double a = lower + middle, b = middle, c = middle + upper, root = std::hypot((a - c) / 2, b);
    CHECK(std::abs(modes.conical_height[0] * ((a + c) / 2 - root) / w - 1) < 1e-15);
    CHECK(std::abs(modes.conical_height[1] * ((a + c) / 2 + root) / w - 1) < 1e-15);
    CHECK(modes.shape(0)[0] == 0);
    CHECK(modes.shape(0)[3] == 0);
    CHECK(std::abs(modes.shape(0)[1] / modes.shape(0)[2] - b / (a - w / modes.conical_height[0])) < 1e-14);
    CHECK(modes.angular_speed(10.0)[0] == std::sqrt(10.0) / std::sqrt(modes.conical_height[0]));
}

TEST_CASE("held straight: numbers, windows, all modes") {
    const Chain<double> rods = Chain<double>::uniform_rods(30, 1.0, 2.0);
    const Held held(rods, {.tension = 7.0});
    const auto all = revchain::modes(held, {.count = revchain::all_modes});
    REQUIRE(all.size() == 29);
    const auto some = revchain::modes(held, {.first = 4, .count = 3});
    CHECK(some.first == 4);
    CHECK(some.conical_height == all.conical_height.segment(3, 3));
    CHECK(some.shape(1) == all.shape(4));
    CHECK(revchain::modes(held, {.first = 25}).size() == 5);
    const double low = all.conical_height[6], high = all.conical_height[2];
    const auto window =
        revchain::modes(held, {.conical_height = revchain::HeightWindow<double>{low * 0.999, high * 1.001}});
    CHECK(window.range() == revchain::ModeRange{3, 5});
    CHECK(window.conical_height == all.conical_height.segment(2, 5));
    const auto speeds = all.angular_speed();
    const auto by_speed =
        revchain::modes(held, {.angular_speed = revchain::SpeedWindow<double>{speeds[2] * 0.999, speeds[6] * 1.001}});
    CHECK(by_speed.range() == window.range());
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(revchain::modes(held, {.angular_speed = revchain::SpeedWindow<double>{0, infinity}}).size() == 29);
    CHECK(revchain::modes(held, {.conical_height = revchain::HeightWindow<double>{1e3, infinity}}).size() == 0);
    CHECK(revchain::count_modes(held, {.angular_speed = speeds[6] * 1.001}) == 7);
    CHECK(revchain::count_modes(held, {.angular_speed = 2 * speeds[6] * 1.001, .gravity = 4 * 9.80665}) == 7);
    CHECK(revchain::modes(held, {.rtol = 1e-3}).status == revchain::Status::success);
    CHECK(revchain::modes(held, {.rtol = 1e-20}).status == revchain::Status::tolerance_not_met);
    const auto certified = revchain::modes(held, {.count = revchain::all_modes, .certify = true});
    const auto& certificate = certified.certificate;
    for (Index j = 0; j < 29; ++j) {
        const double height = certified.conical_height[j];
        CHECK(certificate.lower[j] >= height * (1 - 1e-15));
        CHECK(certificate.upper[j] <= height * (1 + 1e-15));
        CHECK(revchain::count_modes(held, {.conical_height = certificate.lower[j]}) == certificate.above_lower[j]);
        CHECK(revchain::count_modes(held, {.conical_height = certificate.upper[j]}) == certificate.above_upper[j]);
        CHECK(certificate.above_lower[j] == j + 1);
        CHECK(certificate.above_upper[j] == j);
    }
    const auto shared = revchain::modes(held, {.count = revchain::all_modes, .threads = 3});
    CHECK(shared.conical_height == all.conical_height);
    CHECK(shared.shapes() == all.shapes());
}

TEST_CASE("held straight: pins that move without mass have no mode") {
    const auto count = [](const std::vector<revchain::Link<double>>& links, const revchain::Support& lower = {}) {
        const Held held(Chain<double>(links), {.tension = 5.0, .lower = lower});
        const Index slower = revchain::count_modes(held, {.conical_height = 1e-300});
        if (slower > 0) CHECK(revchain::modes(held, {.count = revchain::all_modes}).size() == slower);
        return slower;
    };
    const auto thread = revchain::plummet(0.0, 1.0), bead = revchain::plummet(1.0, 1.0);
    const auto rod = revchain::uniform_rod(1.0, 1.0);
    const revchain::Link<double> middle{.weight = 1.0, .length = 1.0, .centroid = 0.5};  // a plummet on a thin rod
    const revchain::Support spring{.stiffness = 2.0}, laden{.stiffness = 2.0, .carriage_weight = 0.5};
    CHECK(count({bead, thread}) == 0);  // the mass of a plummet is at its lower pin
    CHECK(count({bead, bead}) == 1);
    CHECK(count({rod}) == 0);
    CHECK(count({rod, thread, rod}) == 2);
    CHECK(count({bead, thread, bead, thread}) == 1);
    CHECK(count({middle, thread}) == 1);
    CHECK(count({middle, middle, thread}) == 2);
    CHECK(count({bead, thread}, spring) == 1);
    CHECK(count({middle, thread}, spring) == 1);
    CHECK(count({middle, thread}, laden) == 2);
}

TEST_CASE("held: a weightless system under a tension") {
    const Chain<double> rods = Chain<double>::uniform_rods(25, 1.0, 2.0);
    const double speed = 7.0;
    for (const auto& shape :
         revchain::steady_shapes(Held(rods, {.span = 0.7, .weightless = true}), {.max_half_waves = 2}).shapes) {
        CHECK(shape.conical_height == 0);
        const double tension = shape.height_times_tension[25] * speed * speed;  // newtons, of masses
        const auto found = revchain::steady_shapes(Held(rods, {.tension = tension, .weightless = true}),
                                                   {.angular_speed = speed, .max_half_waves = shape.half_waves});
        REQUIRE(!found.shapes.empty());
        CHECK(std::abs(found.shapes.back().span - 0.7) < 1e-12);
        CHECK((found.shapes.back().inclination - shape.inclination).cwiseAbs().maxCoeff() < 1e-11);
    }
    const revchain::Cord cord(1.0, {.weight = 2.0});
    const auto rope = revchain::steady_shapes(Held(cord, {.span = 0.7, .weightless = true})).shapes.at(0);
    const double tension = rope.height_times_tension[rope.height_times_tension.size() - 1] * speed * speed;
    const auto found =
        revchain::steady_shapes(Held(cord, {.tension = tension, .weightless = true}), {.angular_speed = speed});
    REQUIRE(found.shapes.size() == 1);
    CHECK(std::abs(found.shapes[0].span - 0.7) < 1e-12);
}

TEST_CASE("held: what has no answer says what to ask instead") {
    using Catch::Matchers::ContainsSubstring;
    using revchain::Cord;
    const Chain<double> rods = Chain<double>::uniform_rods(20, 1.0, 3.0);
    CHECK_THROWS_WITH(Held(rods, {}), ContainsSubstring("give either span or tension"));
    CHECK_THROWS_WITH(Held(rods, {.span = 0.5, .tension = 1.0}), ContainsSubstring("give either span or tension"));
    CHECK_THROWS_WITH(Held(rods, {.span = 1.0}), ContainsSubstring("less than the length 1, got 1"));
    CHECK_THROWS_WITH(Held(Cord(1, {.tip_weight = 1}), {.span = 0.5}), ContainsSubstring("must be uniform"));
    CHECK_THROWS_WITH(Held(Cord(1, {.density = 1.0}), {.span = 0.5}), ContainsSubstring("Chain::tapered"));
    CHECK_THROWS_WITH(Held(rods, {.tension = 4.0, .lower = {.radius = 0.2}}),
                      ContainsSubstring("lower radius must be 0") && ContainsSubstring("got 0.2"));
    CHECK_THROWS_WITH(Held(Cord(1), {.span = 0.5, .upper = {.radius = 0.1}}),
                      ContainsSubstring("upper radius must be 0") && ContainsSubstring("got 0.1"));
    CHECK_THROWS_WITH(Held(Cord(1), {.span = 0.5, .lower = {.stiffness = 5.0, .carriage_weight = 2.0}}),
                      ContainsSubstring("lower stiffness must be infinite") && ContainsSubstring("got 5"));
    CHECK_THROWS_WITH(Held(rods, {.span = 0.5, .upper = {.stiffness = 100.0, .damping = 3.0}}),
                      ContainsSubstring("upper damping must be 0") && ContainsSubstring("got 3"));

    const Held bent(rods, {.span = 0.5}), straight(rods, {.tension = 4.0});
    const Held light(rods, {.tension = 4.0, .weightless = true}), light_bent(rods, {.span = 0.5, .weightless = true});
    CHECK_THROWS_WITH(revchain::steady_shapes(bent), ContainsSubstring("give either conical_height or angular_speed"));
    CHECK_THROWS_WITH(revchain::steady_shapes(bent, {.conical_height = 1.0, .angular_speed = 1.0}),
                      ContainsSubstring("give either conical_height or angular_speed"));
    CHECK_THROWS_WITH(revchain::steady_shapes(bent, {.angular_speed = 1.0, .gravity = 0}),
                      ContainsSubstring("weightless = true"));
    CHECK_THROWS_WITH(revchain::steady_shapes(bent, {.angular_speed = 1e200}),
                      ContainsSubstring("gravity / angular_speed^2 must be positive and finite"));
    CHECK_THROWS_WITH(revchain::steady_shapes(bent, {.conical_height = 0.1, .max_half_waves = 0}),
                      ContainsSubstring("max_half_waves must be at least 1"));
    CHECK_THROWS_WITH(revchain::steady_shapes(light_bent, {.conical_height = 0.1}),
                      ContainsSubstring("give angular_speed"));
    CHECK_THROWS_WITH(revchain::steady_shapes(light), ContainsSubstring("give angular_speed"));

    CHECK_THROWS_WITH(revchain::modes(bent), ContainsSubstring("stability"));
    CHECK_THROWS_WITH(revchain::count_modes(bent, {.conical_height = 0.1}), ContainsSubstring("stability"));
    CHECK_THROWS_WITH(revchain::modes(light, {.gravity = 0}), ContainsSubstring("gravity"));
    CHECK(revchain::modes(light, {.count = revchain::all_modes}).size() == 19);
    const Chain<double> beads = Chain<double>::uniform_plummets(4, 1.0, 3.0);
    CHECK_THROWS_WITH(revchain::modes(Held(beads, {.tension = 3.0})), ContainsSubstring("must exceed the weight 3"));
    CHECK_THROWS_WITH(revchain::count_modes(Held(rods, {.tension = 2.0}), {.conical_height = 0.1}),
                      ContainsSubstring("must exceed the weight"));
    CHECK_THROWS_WITH(revchain::modes(straight, {.first = 20}), ContainsSubstring("must not exceed the 19 modes"));
    CHECK_THROWS_WITH(revchain::modes(straight, {.count = 20}), ContainsSubstring("must not exceed the 19 modes"));
    CHECK_THROWS_AS(revchain::modes(straight, {.first = 0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(straight, {.count = 0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(straight, {.rtol = -1.0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(straight, {.conical_height = revchain::HeightWindow<double>{2, 1}}),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(straight, {.angular_speed = revchain::SpeedWindow<double>{-1, 1}}),
                    revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::modes(straight, {.angular_speed = revchain::SpeedWindow<double>{1, 2}, .gravity = 0}),
                    revchain::InvalidArgument);
    CHECK_THROWS_WITH(revchain::count_modes(straight, {}), ContainsSubstring("give either"));
    CHECK_THROWS_AS(revchain::count_modes(straight, {.conical_height = 0.0}), revchain::InvalidArgument);

    const Held rope(Cord(1), {.tension = 2.0});
    CHECK_THROWS_WITH(revchain::steady_shapes(rope), ContainsSubstring("give either conical_height or angular_speed"));
}

TEST_CASE("held: a run can be cancelled") {
    revchain::Progress progress;
    const Chain<double> rods = Chain<double>::uniform_rods(20);
    const auto modes = revchain::modes(Held(rods, {.tension = 4.0}), {.count = 3, .progress = &progress});
    CHECK(progress.fraction() == 1);
    progress.cancel();
    CHECK_THROWS_AS(revchain::modes(Held(rods, {.tension = 4.0}), {.count = 3, .progress = &progress}),
                    revchain::Cancelled);
    CHECK_THROWS_AS(modes.shapes(&progress), revchain::Cancelled);
}

namespace {

/// Chains that begin with a pull along the lowest link, at an angle, brought to the upper end by Newton's method in double
/// from many starts, each link from where it is pulled; those of one half wave, as the lowest link's angle and pull.
std::vector<std::array<double, 2>> by_trials(const Chain<double>& chain, double span, double height, int starts) {
    using revchain::finite::Direction;
    const auto wide = revchain::finite::links_of(chain);
    const auto links = revchain::finite::rounded<double>(wide.links);
    const double reach = std::ldexp(chain.total_length(), -wide.units.length_exponent),
                 apart = std::ldexp(span, -wide.units.length_exponent),
                 lambda = std::ldexp(height, -wide.units.length_exponent);
    double weight = 0;
    for (const auto& link : links) weight += link.moment + link.rest;
    std::vector<std::array<double, 2>> found;
    for (int i = 0; i < starts; ++i)
        for (int j = 0; j < starts; ++j) {
            const double pull = 1.5 * weight * (reach + lambda) * std::pow((i + 0.5) / starts, 2),
                         angle = std::numbers::pi * (j + 0.5) / starts;
            revchain::finite::HeldForces<double> forces{-pull * std::sin(angle),
                                                        pull * std::cos(angle) - lambda * links[0].pull, lambda};
            int changes = 0;
            double last = 1, sweep_gap = 1;
            for (int round = 0; round < 60; ++round) {
                std::vector<Direction<double>> way(links.size());
                changes = 0, last = 1;
                const auto solve = [&](std::size_t m, double R, double V, Direction<double>& to) {
                    to = {R / std::hypot(R, V), V / std::hypot(R, V)};
                    return revchain::finite::find_direction(links[m], R, V, to);
                };
                const auto end = revchain::finite::held_sweep<2>(
                    links, {}, forces, solve, [&](std::size_t m, double y, double, double, double, const auto&) {
                        if (m > 0 && y * last < 0) ++changes, last = -last;
                    });
                if (!end.known) break;
                sweep_gap = std::hypot(end.offset, end.rise - apart);
                if (sweep_gap < 1e-13 * reach) break;
                auto [across, along] = end.forces_to_move(-end.offset, apart - end.rise);
                const double size = std::hypot(across, along), most = 0.3 * std::hypot(forces.across, forces.along);
                if (size > most) across *= most / size, along *= most / size;
                forces.across += across, forces.along += along;
            }
            if (!(sweep_gap < 1e-11 * reach) || changes != 0 || !(forces.across < -1e-9 * weight * reach)) continue;
            const std::array<double, 2> here{forces.across, forces.along};
            if (std::none_of(found.begin(), found.end(), [&](const auto& x) {
                    return std::hypot(x[0] - here[0], x[1] - here[1]) < 1e-7 * weight * reach;
                }))
                found.push_back(here);
        }
    for (auto& x : found)
        for (double& force : x) force = std::ldexp(force, wide.units.length_exponent + wide.units.weight_exponent);
    return found;
}

}  // namespace

TEST_CASE("held at both ends: lists proved complete hold all that trials find") {
    int lists = 0, complete = 0, two = 0;
    for (const std::size_t kind : {0, 1, 2, 3}) {
        const support::Family family = support::families()[kind];
        for (const Index size : {3, 6, 9})
            for (const double share : {0.97, 0.713, 0.211})
                for (const double slow : {0.0, 0.0437, 0.317}) {
                    const Chain<double> chain = family.make(size);
                    const double length = chain.total_length();
                    INFO(family.name << ", " << size << " links, span " << share << ", height " << slow);
                    const auto list = support::held_shapes(chain, share * length, slow * length);
                    ++lists, complete += list.complete, two += list.shapes.size() > 1;
                    CHECK(list.complete == list.undecided.empty());
                    for (const auto& [across, along] : by_trials(chain, share * length, slow * length, 12)) {
                        const auto at = [&, across = across, along = along](const HeldShape& shape) {
                            const double size_of = std::hypot(across, along);
                            return std::hypot(shape.lower_pull[0] + across, shape.lower_pull[1] - along) <
                                   1e-6 * size_of;
                        };
                        CAPTURE(across, along, list.complete);
                        const bool listed = std::any_of(list.shapes.begin(), list.shapes.end(), at);
                        CHECK((listed || !list.complete));
                    }
                }
    }
    CAPTURE(two);
    CHECK(lists == 108);
    CHECK(complete >= 99);
}

TEST_CASE("held at both ends: branches pass through the listed shapes, and a tension gives its shape again") {
    using Catch::Matchers::ContainsSubstring;
    support::Random random(31);
    for (int i = 0; i < 12; ++i) {
        const Index n = 3 + static_cast<Index>(random() * 5);
        const bool points = i % 2 == 0;
        const Chain<double> chain = support::chain_of(n, [&](Index) {
            const double weight = random.between(0.5, 2), a = random.between(0.5, 2);
            return points ? revchain::plummet<double>(weight, a) : revchain::uniform_rod<double>(weight, a);
        });
        const double span = random.between(0.5, 0.9) * chain.total_length(), least = 0.1 * chain.total_length();
        const Held held(chain, {.span = span});
        const auto branches = revchain::branches(held, {.min_conical_height = least});
        CAPTURE(i, n, span);
        REQUIRE(!branches.empty());
        for (const revchain::HeldBranch& branch : branches) {
            CAPTURE(branch.half_waves, to_string(branch.end));
            REQUIRE(branch.shapes.size() > 2);
            CHECK(branch.shapes.front().half_waves == branch.half_waves);
            CHECK(branch.shapes.front().conical_height == Approx(least).epsilon(1e-14));
            for (const HeldShape& shape : branch.shapes)
                if (shape.condition < 1e3)
                    CHECK(support::held_against_truth(chain, {}, shape) < 1e-13 * (1 + shape.condition));
        }
        const HeldShape& middle = branches[0].shapes[branches[0].shapes.size() / 2];
        const auto listed =
            revchain::steady_shapes(held, {.conical_height = middle.conical_height, .prove = false}).shapes;
        double nearest = 10;
        for (const HeldShape& shape : listed)
            nearest = std::min(nearest, (shape.inclination - middle.inclination).cwiseAbs().maxCoeff());
        CHECK(nearest < 1e-9);
        const double tension = middle.height_times_tension[n] / middle.conical_height;
        const HeldShape again = revchain::steady_shape(held, {.top_tension = tension});
        CHECK(again.height_times_tension[n] / again.conical_height == Approx(tension).epsilon(1e-13));
        const HeldShape same = revchain::steady_shape(held, {.conical_height = middle.conical_height});
        CHECK((same.inclination - middle.inclination).cwiseAbs().maxCoeff() < 1e-9);
    }
    const Held held(support::chain_of(3, [](Index) { return revchain::uniform_rod(1.0, 1.0); }), {.span = 2.0});
    CHECK_THROWS_WITH(revchain::branches(held, {}),
                      ContainsSubstring("give either min_conical_height or max_angular_speed"));
    CHECK_THROWS_AS(revchain::steady_shape(held, {.mode = 0, .angular_speed = 9.0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::steady_shape(held, {.mode = 1}), revchain::InvalidArgument);
    const Held pulled(held.system(), {.tension = 50.0});
    CHECK_THROWS_AS(revchain::branches(pulled, {.max_angular_speed = 9.0}), revchain::InvalidArgument);
}
