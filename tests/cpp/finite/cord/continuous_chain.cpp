// SPDX-License-Identifier: MPL-2.0
#include "revchain/finite/cord/continuous_chain.hpp"

#include <map>
#include <memory>
#include <random>

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/table.hpp"

using revchain::Cord;
using revchain::CordShape;
using revchain::CordShapes;
using revchain::Index;
using revchain::LineDensity;

namespace {

constexpr double pi = 3.14159265358979323846;

std::function<double(double)> function_of(const std::string& name, double length) {
    if (name.rfind("power:", 0) == 0)
        return [length, p = std::stod(name.substr(6))](double s) { return std::pow(s / length, p); };
    if (name == "linear") return [length](double s) { return 0.2 + 1.6 * (s / length); };
    return [length](double s) {
        const double x = (s / length - 0.4) / 0.1;
        return 1 + 3 * std::exp(-x * x);
    };
}

/// A cord whose weight per length is 1, or as a function says; the tip in that unit.
Cord cord(double length, double tip_weight = 0, std::shared_ptr<const LineDensity> density = nullptr) {
    if (density) return Cord(length, {.density = density, .tip_weight = tip_weight});
    return Cord(length, {.weight = length, .tip_weight = tip_weight});
}

CordShapes shapes_at(const Cord& of, double height) { return revchain::steady_shapes(of, {.conical_height = height}); }

revchain::Vector<double> critical_heights(const Cord& of, Index count) {
    return revchain::finite::critical_heights(revchain::finite::ContinuousChain(of), count);
}

const CordShape* with(const CordShapes& found, int half_waves) {
    for (const CordShape& shape : found.shapes)
        if (shape.half_waves == half_waves) return &shape;
    return nullptr;
}

/// Three beads of unit weight, the lowest at the free end all but, on a thread a hundredth as heavy for its length.
double beads(double s) {
    constexpr double width = 0.05;
    double sum = 0.01;
    for (const double at : {3 * width, 1.0, 2.0})
        sum += std::exp(-(s - at) * (s - at) / (width * width)) / (width * std::sqrt(pi));
    return sum;
}

/// Largest resultant, over the largest tension, of weight, centrifugal force and tensions of the chain below a place: by
/// Simpson's rule on the shape's own places.
double worst_balance(const CordShape& shape, double tip_weight) {
    double pull = tip_weight * shape.offset[0] / shape.conical_height, worst = 0;
    for (Index i = 1; i < shape.arc_length.size(); ++i) {
        const double from = shape.arc_length[i - 1], to = shape.arc_length[i];
        const double middle = shape(from + (to - from) / 2).offset;
        pull += (to - from) * (shape.offset[i - 1] + 4 * middle + shape.offset[i]) / 6 / shape.conical_height;
        const double across = shape.tension[i] * std::sin(shape.inclination[i]);
        const double along = shape.tension[i] * std::cos(shape.inclination[i]);
        worst = std::max({worst, std::abs(across - pull) / shape.tension.maxCoeff(),
                          std::abs(along - tip_weight - to) / shape.tension.maxCoeff()});
    }
    return worst;
}

}  // namespace

TEST_CASE("shapes against 22 digits", "[finite]") {
    std::string chain_of_row;
    std::shared_ptr<LineDensity> density;
    CordShapes found;
    double worst_of_bound = 0, worst_residual = 0;
    std::map<std::string, double> worst;  // inclinations, by density; offsets and heights over the length
    int rows = 0;
    for (const auto& row : support::table(REVCHAIN_TEST_DATA "/continuous_shapes.csv")) {
        const double length = std::stod(row[1]), tip = std::stod(row[2]);
        const int half_waves = std::stoi(row[3]);
        CAPTURE(row[0], length, tip, half_waves, row[4]);
        if (const std::string name = row[0] + "," + row[1] + "," + row[2]; name != chain_of_row) {
            chain_of_row = name;
            density =
                row[0] == "uniform" ? nullptr : std::make_shared<LineDensity>(function_of(row[0], length), length);
            found = shapes_at(cord(length, tip, density), 1.0);
        }
        const CordShape* shape = with(found, half_waves);
        REQUIRE(shape != nullptr);
        const auto place = (*shape)(std::stod(row[4]));
        const auto error = [](double value, const std::string& exact) {
            return std::abs(static_cast<double>(value - support::quad_of(exact)));
        };
        const double inclination = error(place.inclination, row[6]);
        const double lengths = std::max(error(place.offset, row[5]), error(place.height, row[7])) / length;
        CHECK(std::max(inclination, lengths) <= shape->error_bound);
        worst_of_bound = std::max(worst_of_bound, std::max(inclination, lengths) / shape->error_bound);
        worst_residual = std::max(worst_residual, shape->residual);
        const std::string group =
            row[0].substr(0, 5) + (length <= 500 ? "" : " long") + (length == 1.4458 ? " near" : "");
        worst[group] = std::max(worst[group], inclination);
        worst[group + " lengths"] = std::max(worst[group + " lengths"], lengths);
        ++rows;
    }
    CHECK(rows == 766);
    for (const auto& [group, error] : worst) UNSCOPED_INFO(group << " " << error);
    CHECK(worst_of_bound <= 0.6);
    CHECK(worst_residual <= 3e-15);
    CHECK(worst["unifo"] <= 6e-14);  // length/height up to 500
    CHECK(worst["unifo lengths"] <= 8e-15);
    CHECK(worst["unifo long"] <= 1e-12);  // 1e4
    CHECK(worst["unifo near"] <= 1.5e-13);
    CHECK(worst["power"] <= 3e-15);
    CHECK(worst["linea"] <= 1.2e-14);
    CHECK(worst["bump"] <= 1e-13);
}

TEST_CASE("counted by the critical heights: Kolodner's theorem", "[finite]") {
    for (const double ratio : {1.0, 1.4457, 1.4459, 7.6, 7.7, 50.0, 500.0, 3000.0, 10000.0}) {
        CAPTURE(ratio);
        const auto found = shapes_at(cord(ratio), 1.0);
        const auto critical = critical_heights(cord(ratio), 70);
        CHECK(found.complete);
        CHECK(static_cast<Index>(found.shapes.size()) == (critical.array() > 1.0).count());
        for (std::size_t j = 0; j < found.shapes.size(); ++j) {
            const CordShape& shape = found.shapes[j];
            CAPTURE(j);
            REQUIRE(shape.half_waves == static_cast<int>(j) + 1);
            // Nodes among the places, that lie closer than the shape turns.
            int changes = 0;
            for (Index i = 1; i + 1 < shape.offset.size(); ++i) changes += shape.offset[i] * shape.offset[i - 1] < 0;
            CHECK(changes == static_cast<int>(j));
            CHECK(shape.residual <= 1e-14);
            CHECK(shape.error_bound <=
                  3e-16 * ratio * std::max(1.0, 5 * ratio / (ratio - 1 / critical[static_cast<Index>(j)] * ratio)));
            if (j > 0) CHECK(shape.offset[0] < found.shapes[j - 1].offset[0]);
            CHECK(shape.offset[0] > 0);
        }
    }
    CHECK(shapes_at(cord(500), 1.0).shapes.size() == 14);
    CHECK(shapes_at(cord(10000), 1.0).shapes.size() == 63);
}

TEST_CASE("no shape at or above the first critical height, and its side told to rounding", "[finite]") {
    const double first = critical_heights(cord(1), 1)[0];
    CHECK(first == Approx(0.69166027612257974).epsilon(4e-16));
    for (const double above : {1e-13, 1e-9, 1e-3, 1.0, 1e6}) {
        const auto none = shapes_at(cord(1), first * (1 + above));
        CHECK(none.complete);
        CHECK(none.shapes.empty());
        if (above > 0.5) continue;
        const auto one = shapes_at(cord(1), first * (1 - above));
        CHECK(one.complete);
        REQUIRE(one.shapes.size() == 1);
        // Small amplitude: the rise of s_1 is 0.3224 eta_0^2.
        const double tip = one.shapes[0].offset[0] / first;
        if (above < 1e-2)
            CHECK(tip ==
                  Approx(std::sqrt(1.4457964907366961 * above / 0.32244)).epsilon(2 * above + 2e-3 + 1e-15 / above));
        CHECK(one.shapes[0].error_bound >= 1e-16 * tip / above);
    }
    const auto at = shapes_at(cord(1), first);
    CHECK_FALSE(at.complete);
}

TEST_CASE("forces balance; tip weights; free end", "[finite]") {
    for (const double tip : {0.0, 1e-9, 0.03, 1.0, 70.0, 1000.0}) {
        for (const double height : {0.3, 0.05, 0.004}) {
            const auto found = shapes_at(cord(1, tip), height);
            const auto critical = critical_heights(cord(1, tip), 15);
            CAPTURE(tip, height);
            REQUIRE(static_cast<Index>(found.shapes.size()) == (critical.array() > height).count());
            CHECK(found.complete);
            for (const CordShape& shape : found.shapes) {
                CHECK(worst_balance(shape, tip) <= 2e-6);  // Simpson's rule
                CHECK(std::tan(shape.inclination[0]) == Approx(shape.offset[0] / height).epsilon(1e-13));
                CHECK(shape.arc_length[0] == 0);
                CHECK(shape.arc_length[shape.arc_length.size() - 1] == 1);
                CHECK(shape.offset[shape.offset.size() - 1] == 0);
                CHECK(shape.height[shape.height.size() - 1] == 0);
                CHECK(shape.tension[0] == Approx(tip * std::hypot(1.0, shape.offset[0] / height)).margin(1e-300));
                for (Index i = 0; i < shape.arc_length.size(); i += 7) {
                    const auto place = shape(shape.arc_length[i]);
                    CHECK(std::abs(place.offset - shape.offset[i]) <= 4 * shape.error_bound);
                    CHECK(std::abs(place.inclination - shape.inclination[i]) <= 4 * shape.error_bound);
                }
            }
        }
    }
}

TEST_CASE("units do not matter", "[finite]") {
    const auto found = shapes_at(cord(1), 1.0 / 64), scaled = shapes_at(cord(1024), 16.0);
    REQUIRE(found.shapes.size() == scaled.shapes.size());
    for (std::size_t j = 0; j < found.shapes.size(); ++j) {
        CHECK(scaled.shapes[j].offset[0] == 1024 * found.shapes[j].offset[0]);
        CHECK(scaled.shapes[j].inclination == found.shapes[j].inclination);
    }
    // a density that is a number; weights in any unit
    for (const double weight : {1.0, 1e-200, 1e200}) {
        const auto density = std::make_shared<LineDensity>([=](double) { return weight; }, 1);
        const auto dense = shapes_at(cord(1, 0, density), 1.0 / 64);
        REQUIRE(dense.shapes.size() == found.shapes.size());
        for (std::size_t j = 0; j < found.shapes.size(); ++j) {
            CHECK(std::abs(dense.shapes[j].offset[0] - found.shapes[j].offset[0]) <= 2 * found.shapes[j].error_bound);
            CHECK(dense.shapes[j](1).tension == Approx(weight * found.shapes[j](1).tension).epsilon(1e-13));
        }
    }
}

TEST_CASE("a density made again from its pieces is the same", "[finite]") {
    for (const double power : {0.0, 0.5, -0.5}) {
        const LineDensity density([=](double s) { return (1 + (s > 0.4 ? s : 0)) * std::pow(s, power); }, 1);
        const LineDensity again(density.length(), density.pieces());
        CHECK(again.total() == density.total());
        for (const double s : {1e-14, 1e-3, 0.3, 0.4, 0.7, 1.0}) {
            CAPTURE(power, s);
            CHECK(again.weight_below(s) == density.weight_below(s));
            CHECK(again.about(s) == density.about(s));
        }
    }
    CHECK_THROWS_AS(LineDensity(1.0, {}), revchain::InvalidArgument);
}

TEST_CASE("pieces that are no density are refused", "[finite]") {
    using revchain::InvalidArgument;
    using Pieces = std::vector<LineDensity::Piece>;
    support::Random random(7);
    for (int i = 0; i < 300; ++i) {
        const double power = i % 2 == 0 ? 0 : random.between(-0.9, 3), length = std::exp(random.between(-9, 9));
        const double jump = random.between(0.1, 0.9) * length, height = random.between(0, 5);
        const LineDensity density([=](double s) { return (1 + (s > jump ? height : 0)) * std::pow(s / length, power); },
                                  length);
        const Pieces& pieces = density.pieces();
        REQUIRE(LineDensity(length, pieces).total() == density.total());
        const auto at = static_cast<std::size_t>(random.between(0, static_cast<double>(pieces.size())));
        const auto refused = [&](const auto& change) {
            Pieces changed = pieces;
            change(changed, changed[at]);
            CHECK_THROWS_AS(LineDensity(length, changed), InvalidArgument);
        };
        CAPTURE(power, length, at, pieces.size());
        refused([](Pieces&, auto& piece) { piece.half = -piece.half; });
        refused([&](Pieces&, auto& piece) { piece.middle += 1e-3 * length; });
        refused([](Pieces&, auto& piece) { piece.factor[0] = -piece.factor[0]; });
        if (pieces[at].power == 0) refused([](Pieces&, auto& piece) { piece.factor[1] += 100 * piece.factor[0]; });
        refused([](Pieces&, auto& piece) { piece.factor[3] = std::nan(""); });
        refused([](Pieces&, auto& piece) { piece.power = -1; });
        refused([&](Pieces& changed, auto&) { changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(at)); });
        CHECK_THROWS_AS(LineDensity(length * 1.01, pieces), InvalidArgument);
    }
}

TEST_CASE("critical heights of a chain with a tip mass, of a power law, of two halves", "[finite]") {
    double worst = 0;
    int rows = 0;
    for (const auto& row : support::table(REVCHAIN_TEST_DATA "/tip_mass.csv")) {
        const double tip = std::stod(row[0]);
        const int mode = std::stoi(row[1]);
        if (tip > 1000 || mode > 14) continue;
        const auto heights = critical_heights(cord(1, tip), mode);
        worst = std::max(worst, static_cast<double>(fabsq(heights[mode - 1] / support::quad_of(row[2]) - 1)));
        ++rows;
    }
    CHECK(rows == 60);
    CHECK(worst <= 4e-15);
    // s^(1/2): zeros of J_1/2 are those of the sine
    const auto root = std::make_shared<LineDensity>([](double s) { return std::sqrt(s); }, 30);
    const auto of_root = critical_heights(cord(30, 0, root), 4);
    for (Index k = 1; k <= 4; ++k)
        CHECK(of_root[k - 1] == Approx(180 / std::pow(pi * static_cast<double>(k), 2)).epsilon(3e-14));
    // A jump half way up: below it J_0, above it J_0 and Y_0 of a chain that hangs from what is below.
    const auto halves = std::make_shared<LineDensity>([](double s) { return s < 0.5 ? 1.0 : 4.0; }, 1);
    const auto of_halves = critical_heights(cord(1, 0, halves), 3);
    for (Index k = 0; k < 3; ++k) {
        const double x = 1 / of_halves[k], r = std::sqrt(x);
        // y = J_0(2 sqrt(x s)); above, 4 (V y')' ... with V = 1/2 + 4 (s - 1/2): y of z = 2 sqrt(x V / 4)
        const double z1 = 2 * std::sqrt(x * 0.5), w1 = 2 * std::sqrt(x * 0.5 / 4), w2 = 2 * std::sqrt(x * 2.5 / 4);
        const double y = j0(z1), slope = -j1(z1) * r / std::sqrt(0.5);  // dy/ds
        const double dw = w1 / (2 * 0.5) * 4;                           // dw/ds
        const double wronskian = 2 / (pi * w1);
        const double a = (y * -y1(w1) - slope / dw * y0(w1)) / wronskian,
                     b = (j0(w1) * slope / dw + y * j1(w1)) / wronskian;
        CHECK(std::abs(a * j0(w2) + b * y0(w2)) <= 3e-14);
    }
}

TEST_CASE("beads on a light thread: more shapes than critical heights", "[finite]") {
    // Three plummets have five shapes once length of a link over height exceeds 15.24 (steady_shapes), where their three
    // conical heights promise three: what is true of the uniform chain is not of every chain.
    const auto density = std::make_shared<LineDensity>(beads, 3);
    const auto few = shapes_at(cord(3, 0, density), 0.1), many = shapes_at(cord(3, 0, density), 0.06);
    const auto critical = critical_heights(cord(3, 0, density), 4);
    CHECK((critical.array() > 0.06).count() == 3);
    CHECK(few.shapes.size() == 3);
    CHECK(many.shapes.size() == 5);
    CHECK_FALSE(many.complete);
    for (const CordShape& shape : many.shapes) CHECK(shape.error_bound <= 2e-13);
    CHECK(with(many, 3) != nullptr);
    // one critical height above: one shape, by the theorem
    const auto one = shapes_at(cord(3, 0, density), 0.5);
    CHECK(one.complete);
    CHECK(one.shapes.size() == 1);
}

TEST_CASE("jumps of the density", "[finite]") {
    // Light, a hundred times as heavy, and all but weightless: many more shapes than heights of small amplitude.
    const auto weight = [](double s) { return s < 0.3 ? 1.0 : s < 0.7 ? 100.0 : 0.01; };
    const auto density = std::make_shared<LineDensity>(weight, 1);
    CHECK(density->total() == Approx(40.303).epsilon(1e-13));
    const auto found = shapes_at(cord(1, 0, density), 0.003);
    CHECK(found.shapes.size() == 31);
    for (const CordShape& shape : found.shapes) {
        CHECK(shape.error_bound <= 1e-11);
        CHECK(shape.residual <= 1e-14);
        double pull = 0, along = 0, worst = 0;
        for (Index i = 1; i < shape.arc_length.size(); ++i) {
            const double from = shape.arc_length[i - 1], to = shape.arc_length[i], middle = from + (to - from) / 2;
            pull += weight(middle) * (to - from) * (shape.offset[i - 1] + 4 * shape(middle).offset + shape.offset[i]) /
                    6 / 0.003;
            along += weight(middle) * (to - from);
            worst = std::max({worst, std::abs(shape.tension[i] * std::sin(shape.inclination[i]) - pull),
                              std::abs(shape.tension[i] * std::cos(shape.inclination[i]) - along)});
        }
        CHECK(worst <= 2e-6 * shape.tension.maxCoeff());  // Simpson's rule
    }
}

TEST_CASE("near the free end: the inclination falls as the series says", "[finite]") {
    // tan psi = eta_0 - s eta_0 m/sqrt(1 + eta_0^2) + ..., m = (p + 1)/(p + 2) for a density s^p; over the height.
    for (const double power : {0.0, 0.5, 2.0}) {
        const auto density = std::make_shared<LineDensity>([=](double s) { return 3 * std::pow(s, power); }, 1);
        for (const bool uniform : {true, false}) {
            if (uniform && power != 0) continue;
            for (const CordShape& shape : shapes_at(cord(1, 0, uniform ? nullptr : density), 0.02).shapes) {
                const double tip = shape.offset[0] / 0.02, m = (power + 1) / (power + 2);
                for (double s = 1e-15; s < 1e-6; s *= 3) {
                    const double slope = -tip * m / std::sqrt(1 + tip * tip) / (1 + tip * tip);
                    CAPTURE(power, uniform, shape.half_waves, s);
                    CHECK(std::abs(shape(s).inclination - (std::atan(tip) + slope * s / 0.02)) <=
                          2e-9 * s / 1e-6 + 1e-15);
                }
                for (Index i = 1; i < shape.arc_length.size(); ++i)
                    CHECK(shape.arc_length[i] >= shape.arc_length[i - 1]);
            }
        }
    }
}

TEST_CASE("line densities are what they were given", "[finite]") {
    for (const std::string name : {"power:0.5", "power:2", "power:-0.25", "linear", "bump"}) {
        CAPTURE(name);
        const auto f = function_of(name, 7);
        const auto density = std::make_shared<LineDensity>(f, 7);
        std::mt19937 random(5);
        double worst = 0;
        for (int i = 0; i < 2000; ++i) {
            const double s = 7 * std::pow(std::uniform_real_distribution<>(0, 1)(random), 3);
            worst = std::max(worst, std::abs(density->about(s)[0] / f(s) - 1));
        }
        CHECK(worst <= 2e-14);
        if (name.rfind("power", 0) == 0) {
            const double p = std::stod(name.substr(6));
            for (const double s : {1e-12, 1e-5, 0.4, 7.0})
                CHECK(density->weight_below(s) == Approx(std::pow(s / 7, p) * s / (p + 1)).epsilon(3e-14));
        }
    }
}

TEST_CASE("line densities: narrow features are found wherever they are", "[finite]") {
    // Jumps up and down again, 1/1000 to 1/10 of the length apart. Weights below places are known; critical heights are
    // those of three pieces, whose errors are as great.
    std::mt19937 random(7);
    std::uniform_real_distribution<> any(0, 1);
    double weights = 0, heights = 0;  // over what a rounding of a place does; over both bounds
    for (int i = 0; i < 200; ++i) {
        const double length = std::pow(10, 2 * any(random) - 1), wide = length * std::pow(10, -1 - 2 * any(random));
        const double low = (length - wide) * any(random), high = low + wide, extra = std::pow(10, 4 * any(random) - 2);
        const auto f = [=](double s) { return s >= low && s < high ? 1 + extra : 1.0; };
        CAPTURE(length, low, wide, extra);
        const auto density = std::make_shared<LineDensity>(f, length);
        const auto piece = [](double from, double to, double value) {
            return LineDensity::Piece{(from + to) / 2, (to - from) / 2, {value}};
        };
        const auto exact = std::make_shared<LineDensity>(
            length, std::vector{piece(0, low, 1), piece(low, high, 1 + extra), piece(high, length, 1)});
        for (const double s : {low / 2, low + wide / 3, high + (length - high) / 9, length})
            weights = std::max(
                weights, std::abs(density->weight_below(s) / (s + extra * std::clamp(s - low, 0.0, high - low)) - 1) /
                             (2e-15 + 1e-16 * extra));
        CHECK(density->error(low / 2) < 1e-15);
        if (i >= 40) continue;
        const double tip = length * any(random);
        const auto found = critical_heights(cord(length, tip, density), 3),
                   truth = critical_heights(cord(length, tip, exact), 3);
        for (Index j = 0; j < 3; ++j)
            heights = std::max(heights,
                               std::abs(found[j] / truth[j] - 1) / (4e-15 + 2 * density->rounding_at_jumps(found[j])));
    }
    CAPTURE(weights, heights);
    CHECK(weights <= 1);
    CHECK(heights <= 1);
}

TEST_CASE("line densities: smooth steps and bumps are found wherever they are", "[finite]") {
    std::mt19937 random(8);
    std::uniform_real_distribution<> any(0, 1);
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        const double at = 0.01 + 0.98 * any(random), wide = std::pow(10, -3 + 2 * any(random)), size = any(random) * 30;
        const double p = i % 4 == 0 ? 2 * any(random) - 0.5 : 0.0;
        const bool step = i % 2 == 0;
        const auto f = [=](double s) {
            const double x = (s - at) / wide, bump = step ? 0.5 + 0.5 * std::tanh(x) : std::exp(-x * x);
            return std::pow(s, p) + size * bump;
        };
        CAPTURE(at, wide, size, p, step);
        const LineDensity density(f, 1);
        const auto log_cosh = [](double x) { return std::abs(x) + std::log1p(std::exp(-2 * std::abs(x))); };
        const double whole =
            1 / (p + 1) + size * (step ? 0.5 + wide / 2 * (log_cosh((1 - at) / wide) - log_cosh(at / wide))
                                       : wide * std::sqrt(pi) / 2 * (std::erf((1 - at) / wide) + std::erf(at / wide)));
        worst = std::max(worst, std::abs(density.total() / whole - 1) - density.error(1));
    }
    CAPTURE(worst);
    CHECK(worst <= 3e-15);
}

TEST_CASE("line densities: the error of singular ones is in the estimate, or they are refused", "[finite]") {
    using Catch::Matchers::ContainsSubstring;
    const LineDensity root([](double s) { return 1 / std::sqrt(3 - s); }, 3);
    const double off = std::abs(root.total() / std::sqrt(12.0) - 1);
    CAPTURE(off, root.error(3));
    CHECK(off <= root.error(3));
    CHECK(root.error(3) < 1e-7);
    CHECK_THROWS_WITH(LineDensity([](double s) { return std::pow(std::abs(s - std::sqrt(0.5)) + 1e-25, -0.9); }, 3),
                      ContainsSubstring("cannot be resolved") && ContainsSubstring("chain of many short links") &&
                          ContainsSubstring("near s, got 0.7071"));
}

TEST_CASE("wrong chains are refused", "[finite]") {
    using Catch::Matchers::ContainsSubstring;
    using revchain::InvalidArgument;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double wrong : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_AS(cord(wrong), InvalidArgument);
        CHECK_THROWS_AS(shapes_at(cord(1), wrong), InvalidArgument);
        CHECK_THROWS_AS(revchain::steady_shapes(cord(1), {.angular_speed = wrong}), InvalidArgument);
        CHECK_THROWS_AS(LineDensity([=](double) { return wrong; }, 1.0), InvalidArgument);
    }
    CHECK_THROWS_WITH(cord(1, -0.5), ContainsSubstring("tip weight") && ContainsSubstring("-0.5"));
    CHECK_THROWS_WITH(shapes_at(cord(1e7), 1.0), ContainsSubstring("at most 1e6"));
    CHECK_THROWS_AS(revchain::steady_shapes(cord(1), {.conical_height = 1.0, .scanned = 0}), InvalidArgument);
    CHECK_THROWS_AS(critical_heights(cord(1), 0), InvalidArgument);
    const auto density = std::make_shared<LineDensity>([](double) { return 1.0; }, 2);
    CHECK_THROWS_WITH(cord(1, 0, density), ContainsSubstring("over the length"));
    std::mt19937 random(1);
    CHECK_THROWS_WITH(LineDensity([&](double) { return std::uniform_real_distribution<>(1, 2)(random); }, 1),
                      ContainsSubstring("rough"));
    const auto shape = shapes_at(cord(1), 0.5).shapes.at(0);
    CHECK_THROWS_AS(shape(-0.1), InvalidArgument);
    CHECK_THROWS_AS(shape(1.1), InvalidArgument);
    CHECK_THROWS_AS(shape(nan), InvalidArgument);
}

TEST_CASE("continuous chain: every crossing rises where a theorem says so") {
    // one shape for each critical height, whatever the tip: the free end's offset is looked at by a scan of its own
    for (const double p : {-0.9, -0.5, 0.0, 1.0, 5.0})
        for (const double tip : {0.0, 1e-3, 0.3, 30.0}) {
            if (p > 0 && tip > 0) continue;
            CAPTURE(p, tip);
            const Cord of(1.0, {.density = p, .tip_weight = tip});
            const double height = 0.9 * revchain::finite::critical_heights(revchain::finite::ContinuousChain(of), 5)[4];
            const auto found = revchain::steady_shapes(of, {.conical_height = height});
            CHECK(found.complete);
            REQUIRE(found.shapes.size() == 5);
            const revchain::finite::ContinuousChain chain(of);
            const auto kind = revchain::finite::kind_of(chain, height, 1);
            std::vector<double> last(5, 0.0);
            for (int i = 1; i <= 60; ++i) {
                const revchain::finite::Path path(kind, std::sinh(0.15 * i), {.crossings = 5});
                REQUIRE(path.crossings().size() == 5);
                for (std::size_t j = 0; j < 5; ++j) {
                    if (path.crossings()[j].arc * height > 1) continue;  // the cord ends there, and its density
                    CHECK(path.crossings()[j].rate > 0);
                    CHECK(path.crossings()[j].arc > last[j]);
                    last[j] = path.crossings()[j].arc;
                }
            }
        }
    CHECK_FALSE(
        revchain::steady_shapes(Cord(1.0, {.density = 1.0, .tip_weight = 0.2}), {.conical_height = 0.03}).complete);
}

TEST_CASE("continuous chain: rates of crossings next to the vertical") {
    // there a crossing moves with the square of the free end's offset, so that its rate is in proportion
    for (const auto& [p, tip] : {std::pair(1.0, 0.2), std::pair(-0.5, 0.2), std::pair(1.0, 0.0), std::pair(0.0, 0.2)}) {
        const Cord of(1.0, {.density = p, .tip_weight = tip});
        const revchain::finite::ContinuousChain chain(of);
        const auto kind = revchain::finite::kind_of(chain, 0.1, 1);
        const auto rate = [&](double offset) {
            return revchain::finite::Path(kind, offset, {.crossings = 2}).crossings().at(1).rate / offset;
        };
        CAPTURE(p, tip);
        CHECK(std::abs(rate(1e-5) / rate(1e-3) - 1) < 2e-3);
    }
}

TEST_CASE("a cord that the series cannot follow is refused, not counted", "[finite]") {
    using Catch::Matchers::ContainsSubstring;
    for (const double power : {12.0, 15.0, 16.0}) {
        const CordShapes found = shapes_at(Cord(1.0, {.density = power}), 0.05);
        CAPTURE(power);
        CHECK(found.shapes.size() == 5);  // 2 sqrt(20 (power + 1)) is beyond five zeros of J_power
        CHECK(found.complete);
    }
    for (const double power : {17.0, 18.0, 20.0})
        CHECK_THROWS_WITH(shapes_at(Cord(1.0, {.density = power}), 0.05), ContainsSubstring("too rough"));
    for (const double height : {0.3, 0.9}) {
        const CordShapes found = shapes_at(cord(1.0, 1e20), height);
        CHECK(found.shapes.size() == 1);
        CHECK(found.complete);
        CHECK_THROWS_WITH(shapes_at(cord(1.0, 1e30), height), ContainsSubstring("too heavy"));
    }
}
