// SPDX-License-Identifier: GPL-3.0-or-later
// Cords with particles, jumps of the density and a bob; Bessel functions piece by piece are in tests/python/test_cord_masses.py.
#include <random>

#include "revchain/chain.hpp"
#include "revchain/cord.hpp"

#include "support/catch.hpp"

using revchain::Chain;
using revchain::Cord;
using revchain::Index;
using revchain::LineDensity;
using revchain::Link;
using revchain::Vector;

namespace {

/// A uniform cord of equal links, with particles at pins and the tip.
Chain<double> links(Index count, double length, double weight, const std::map<double, double>& particles, double tip) {
    std::vector<Link<double>> made;
    const double each = length / static_cast<double>(count);
    for (Index i = 0; i < count; ++i) {
        // the particle at the lower pin hangs from the link above it
        const double at = each * static_cast<double>(i), rod = weight / static_cast<double>(count);
        double hung = i == 0 ? tip : 0.0;
        for (const auto& [s, w] : particles)
            if (std::abs(s - at) < each / 2) hung += w;
        const double whole = rod + hung, centroid = (rod * each / 2 + hung * each) / whole;
        const double second = (rod * each * each / 3 + hung * each * each) / whole;
        made.push_back(
            {.weight = whole,
             .length = each,
             .centroid = centroid,
             .gyration_ratio = revchain::Wide<double>(std::max(0.0, second - centroid * centroid) / (each * each))});
    }
    return Chain<double>(made);
}

/// Power series of a uniform cord at small amplitude in quadruple precision: u' = -(w/lambda) y, y' = u/V (' by s).
class QuadCord {
   public:
    using Q = __float128;

    explicit QuadCord(const Cord& cord) : cord_(cord), line_(Q(cord.weight()) / Q(cord.length())) {}

    /// The error of a height by one step of the secant method, relative.
    double error(double height) const {
        const Q low = height, high = low * (1 + Q(1e-13)), at_low = at_support(low), at_high = at_support(high);
        return std::abs(static_cast<double>(at_low * (high - low) / (at_high - at_low) / low));
    }

   private:
    Q at_support(Q height) const {
        Q below = cord_.tip_weight(), offset = 1, pull = -below / height, at = 0;
        if (cord_.has_bob()) {  // at the inclination 1
            const Q h = cord_.tip_centroid(), k = cord_.tip_radius_of_gyration();
            offset = height - (h + k * k / h), pull = -below / height * (offset + h);
        }
        const auto advance_to = [&](Q place) {
            while (place - at > place * Q(1e-33)) advance(at, below, offset, pull, place, height);
            at = place;
        };
        for (const auto& [s, weight] : cord_.weights()) {
            advance_to(s);
            pull -= Q(weight) / height * offset, below += weight;
        }
        advance_to(cord_.length());
        return offset;
    }
    void advance(Q& at, Q& below, Q& offset, Q& pull, Q place, Q height) const {
        Q step = std::min(place - at, below / line_ / 4);
        while (step * step * line_ > height * below) step /= 2;
        Q y = offset, u = pull, power = 1;
        for (int k = 0; k < 120; ++k) {
            const Q y_next = (u - Q(k) * line_ * y) / (below * Q(k + 1)), u_next = -line_ / height * y / Q(k + 1);
            power *= step, y = y_next, u = u_next;
            offset += y * power, pull += u * power;
        }
        at += step, below += line_ * step;
    }

    const Cord& cord_;
    Q line_;
};

/// Cords with up to 8 particles and a tip, of weights 10^-span ... 10^span of the cord's; every third has a bob.
void check_random_cords(int count, unsigned seed) {
    std::mt19937 dice(seed);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(dice); };
    double worst = 0;
    for (int i = 0; i < count; ++i) {
        const double length = std::pow(10, uniform(-1, 1)), span = 2 * (i % 5);
        revchain::CordOptions options{.weight = 1.0, .tip_weight = std::pow(10, uniform(-span, span))};
        for (int k = i % 4 == 3 ? 8 : i % 4; k > 0; --k)
            options.weights[uniform(0.01, 0.99) * length] = std::pow(10, uniform(-span, span));
        if (i % 3 == 0 || options.weights.empty()) {
            options.tip_centroid = length * std::pow(10, uniform(-3, 0));
            options.tip_radius_of_gyration = length * std::pow(10, uniform(-3, 0));
        }
        const Cord cord(length, options);
        const auto modes = revchain::modes(cord, {.count = 6});
        const QuadCord exact(cord);
        for (Index j = 0; j < modes.size(); ++j) {
            CAPTURE(seed, i, j, modes.conical_height[j], modes.error_bound[j]);
            const double error = exact.error(modes.conical_height[j]);
            REQUIRE(error <= modes.error_bound[j]);
            worst = std::max(worst, error / modes.error_bound[j]);
        }
        for (const Index j : {0, 5}) {
            const double height = modes.conical_height[j], off = 2 * modes.error_bound[j];
            if (length / height > 9e5) continue;  // no counts beyond 1e6
            REQUIRE(revchain::count_modes(cord, {.conical_height = height * (1 - off)}) == j + 1);
            REQUIRE(revchain::count_modes(cord, {.conical_height = height * (1 + off)}) == j);
        }
    }
    CHECK(worst > 0.2);  // the bounds are of use
}

}  // namespace

TEST_CASE("cord: random cords with particles and bobs in quadruple precision") { check_random_cords(500, 1); }

TEST_CASE("cord: 10,000 random cords with particles and bobs in quadruple precision", "[.slow]") {
    check_random_cords(10'000, 2);
}

TEST_CASE("cord: particles stand between the pieces of a density") {
    const auto density = std::make_shared<LineDensity>([](double s) { return 1 + s * s; }, 2.0);
    const LineDensity carried = density->with_particles(3, {{0.5, 0.25}, {1.5, 4.0}});
    CHECK(std::abs(carried.total() - (3 * density->total() + 4.25)) < 1e-14);
    for (const double s : {0.1, 0.4999, 0.5, 0.7, 1.2, 1.5, 1.7, 1.9999, 2.0}) {
        const double particles = (s >= 0.5 ? 0.25 : 0.0) + (s >= 1.5 ? 4.0 : 0.0);
        CHECK(carried.particles_below(s) == particles);
        CHECK(std::abs(carried.weight_below(s) - (3 * (s + s * s * s / 3) + particles)) < 1e-13);
        if (s < 2) CHECK(std::abs(carried.about(s)[0] - 3 * (1 + s * s)) < 1e-13);
    }
    CHECK(carried.end_of_piece(0.499) == 0.5);
    // two at one place, and one where a piece ends already
    CHECK(carried.with_particles(1, {{0.5, 1.0}}).particles_below(0.6) == 1.25);
    CHECK(carried.with_particles(1, {{0.5, 1.0}}).pieces().size() == carried.pieces().size());
    for (const double s : {0.0, 1e-9, 2.0, 3.0, -1.0})
        CHECK_THROWS_AS(density->with_particles(1, {{s, 1.0}}), revchain::InvalidArgument);
    CHECK_THROWS_AS(density->with_particles(1, {{1.0, -1.0}}), revchain::InvalidArgument);
}

TEST_CASE("cord: breaks of a density") {
    std::size_t calls = 0;
    const auto stepped = [&](double s) { return ++calls, s >= 0.7 && s < 0.70001 ? 1e4 : 1.0; };
    const LineDensity missed(stepped, 2.0);
    CHECK(std::abs(missed.total() - 2) < 1e-12);  // narrower than the grid: not seen
    calls = 0;
    const LineDensity found(stepped, 2.0, {0.70001, 0.7});
    CHECK(std::abs(found.total() - (2 - 1e-5 + 0.1)) < 1e-11);
    CHECK(calls < 3000);
    CHECK(found.error(2.0) < 1e-14);
    CHECK_THROWS_AS(LineDensity(stepped, 2.0, {2.0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(LineDensity(stepped, 2.0, {0.0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(Cord(2.0, {.breaks = {1.0}}), revchain::InvalidArgument);
}

TEST_CASE("cord: particles of a cord that weighs little are plummets") {
    // two equal plummets on equal threads, Greenhill section 2: lambda / l = 1 +- 1/sqrt(2)
    const Cord cord(2.0, {.weight = 1e-12, .tip_weight = 1.0, .weights = {{1.0, 1.0}}});
    const auto modes = revchain::modes(cord, {.count = 2});
    CHECK(std::abs(modes.conical_height[0] - (1 + std::sqrt(0.5))) < 1e-11);
    CHECK(std::abs(modes.conical_height[1] - (1 - std::sqrt(0.5))) < 1e-11);
    CHECK(std::abs(modes.offset(0, 1.0) - (1 - 1 / modes.conical_height[0])) < 1e-11);
    // the lower thread has the slope of the free end: y_1 = 1 - l / lambda
    const double upper = 1 - 1 / modes.conical_height[1];
    CHECK(std::abs(modes.nodes(1)[0] - 1 / (1 - upper)) < 1e-11);
}

TEST_CASE("cord: links with particles tend to the cord, as 1/N^2") {
    const std::map<double, double> particles{{0.5, 0.4}, {1.25, 0.7}};
    const Cord cord(2.0, {.weight = 0.6, .tip_weight = 0.2, .weights = particles});
    const auto exact = revchain::modes(cord, {.count = 3}).conical_height;
    Vector<double> last = Vector<double>::Zero(3);
    for (const Index count : {80, 160}) {
        const auto found = revchain::modes(links(count, 2.0, 0.6, particles, 0.2), {.count = 3}).conical_height;
        const Vector<double> off = (found.array() / exact.array() - 1).abs().matrix();
        if (count == 160)
            for (Index j = 0; j < 3; ++j) {
                CAPTURE(j, off[j], last[j]);
                CHECK(last[j] / off[j] > 3.8);
                CHECK(last[j] / off[j] < 4.2);
                CHECK(off[j] < 2e-3);
            }
        last = off;
    }
}

TEST_CASE("cord: branches with particles pass through the shapes at a speed") {
    const Cord cord(2.0, {.weight = 0.6, .tip_weight = 0.2, .weights = {{0.5, 0.4}, {1.25, 0.7}}});
    const double critical = revchain::modes(cord, {.first = 2, .count = 1}).conical_height[0], height = 0.6 * critical;
    const auto branch = revchain::branch(cord, {.mode = 2, .min_conical_height = 0.5 * critical});
    const auto on = branch.shapes_at(height);
    const auto listed = revchain::steady_shapes(cord, {.conical_height = height});
    REQUIRE(on.size() == 1);
    REQUIRE(listed.shapes.size() == 2);
    const auto& shape = listed.shapes[1];
    CHECK(std::abs(on[0].tip_offset / shape.tip_offset - 1) < 1e-10);
    // sums over the cord by Simpson's rule on pieces, the particles apart
    double inertia = 0.2 * shape(0).offset * shape(0).offset, sink = 0.2 * shape(0).height;
    for (const auto& [s, w] : cord.weights()) inertia += w * std::pow(shape(s).offset, 2), sink += w * shape(s).height;
    const std::vector<double> ends{0, 0.5, 1.25, 2.0};
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        constexpr int parts = 2000;
        for (int k = 0; k <= parts; ++k) {
            const double s = ends[i] + (ends[i + 1] - ends[i]) * k / parts;
            const double w = (k == 0 || k == parts ? 1
                              : k % 2 == 1         ? 4
                                                   : 2) *
                             (ends[i + 1] - ends[i]) / (3.0 * parts) * 0.3;
            inertia += w * std::pow(shape(s).offset, 2), sink += w * shape(s).height;
        }
    }
    const revchain::finite::PathKind kind = shape.kind;
    revchain::finite::PathEnergies energies(kind, shape.tip_offset);
    const revchain::finite::Path path(kind, shape.tip_offset, {.crossings = 2, .with_change = false}, energies);
    const double unit = cord.line_weight() * height;
    CHECK(std::abs(unit * height * height * energies.inertia() / inertia - 1) < 1e-10);
    CHECK(std::abs(unit * height * energies.potential() / (sink)-1) < 1e-10);
}

TEST_CASE("cord: a bob is the lowest link of a chain") {
    const double h = 0.05, k = 0.04;
    const Cord cord(1.0, {.weight = 0.3, .tip_weight = 0.5, .tip_centroid = h, .tip_radius_of_gyration = k});
    const auto modes = revchain::modes(cord, {.count = 5});
    {
        constexpr Index count = 200;
        const double lever = h + k * k / h;
        std::vector<Link<double>> made{{.weight = 0.5,
                                        .length = 2 * h,
                                        .centroid = h,
                                        .gyration_ratio = revchain::Wide<double>(k * k / (4 * h * h))}};
        const double each = 1.0 / static_cast<double>(count);
        for (Index i = 0; i < count; ++i)
            made.push_back({.weight = 0.3 * each,
                            .length = each,
                            .centroid = each / 2,
                            .gyration_ratio = revchain::Wide<double>(1 / 12.0)});
        const auto found = revchain::modes(Chain<double>(made), {.count = 5});
        for (Index j = 0; j < 5; ++j) {
            CHECK(std::abs(found.conical_height[j] / modes.conical_height[j] - 1) < 1e-3);
            CHECK(std::abs(modes.bob_slope(j) + 1 / (modes.conical_height[j] - lever)) <
                  1e-9 * std::abs(modes.bob_slope(j)));
            CHECK(modes.offset(j, 0.0) == 1);
        }
    }
    // of nodes below the support, one may lie in the bob
    for (Index j = 0; j < 5; ++j) {
        const bool across = modes.conical_height[j] < h + k * k / h;
        CHECK(modes.nodes(j).size() == j - (across ? 1 : 0));
    }
    // a bob of no size is a particle
    const auto point = revchain::modes(Cord(1.0, {.weight = 0.3, .tip_weight = 0.5}), {.count = 5});
    const auto small =
        revchain::modes(Cord(1.0, {.weight = 0.3, .tip_weight = 0.5, .tip_centroid = 1e-13}), {.count = 5});
    for (Index j = 0; j < 5; ++j) CHECK(std::abs(small.conical_height[j] / point.conical_height[j] - 1) < 1e-11);
    CHECK_THROWS_AS(point.bob_slope(0), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::steady_shapes(cord, {.angular_speed = 9.0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::branch(cord, {.mode = 1, .min_conical_height = 0.2}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::sensitivity(modes), revchain::InvalidArgument);
    CHECK_THROWS_AS(Cord(1.0, {.tip_weight = 1, .tip_radius_of_gyration = 0.1}), revchain::InvalidArgument);
    CHECK_THROWS_AS(Cord(1.0, {.tip_centroid = 0.1}), revchain::InvalidArgument);
}
