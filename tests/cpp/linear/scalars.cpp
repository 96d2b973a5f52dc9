// SPDX-License-Identifier: MPL-2.0
// Scalars wider than double against 45 digits of mpmath: tests/data/make_heights.py, which has the same chains.
#include <fstream>
#include <map>
#include <sstream>

#include "revchain/modes.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/questions/modes.hpp"
#include "revchain/system/converted.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/quad_scalar.hpp"
#include "support/truth.hpp"

using revchain::DoubleDouble;
using revchain::Index;
using support::Quad;
using support::QuadScalar;

namespace {

std::map<std::string, std::vector<Quad>> expected() {
    std::ifstream file(REVCHAIN_TEST_DATA "/heights.csv");
    std::map<std::string, std::vector<Quad>> heights;
    std::string line, name, mode, height;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::istringstream fields(line);
        std::getline(fields, name, ',');
        std::getline(fields, mode, ',');
        std::getline(fields, height, ',');
        heights[name].push_back(strtoflt128(height.c_str(), nullptr));
    }
    return heights;
}

template <class T>
revchain::Chain<T> chain(const std::string& name) {
    std::vector<revchain::Link<T>> links;
    const auto add = [&](double weight, double length, double centroid, double radius) {
        links.push_back(revchain::compound_pendulum<T>(
            {.weight = T(weight), .length = T(length), .centroid = T(centroid), .radius_of_gyration = T(radius)}));
    };
    if (name == "bodies")
        for (int m = 0; m < 40; ++m) add(1 + m % 7, 0.5 * (1 + m % 3), 0.25 * (1 + m % 2), 0.125 * (m % 4));
    if (name == "upward")
        for (int m = 0; m < 20; ++m) add(std::ldexp(1.0, 2 * m), 1, 1, 0);
    if (name == "heavy tip")
        for (int m = 0; m < 20; ++m) add(std::ldexp(1.0, 2 * (19 - m)), 1, 0.5, 0.25);
    return revchain::Chain<T>(links);
}

const Quad pi = strtoflt128("3.14159265358979323846264338327950288419717", nullptr);
Quad quad(const DoubleDouble& x) { return support::quad(x.word()); }
Quad quad(const QuadScalar& x) { return x.value(); }
Quad quad(long double x) { return x; }

}  // namespace

TEMPLATE_TEST_CASE("heights, bounds and certificates in more than double", "[linear]", DoubleDouble, QuadScalar,
                   long double) {
    using T = TestType;
    constexpr bool is_wider_at_hand = std::is_same_v<T, long double>;
    const double ulp = static_cast<double>(revchain::epsilon<T>());
    for (const auto& [name, heights] : expected()) {
        const auto links = chain<T>(name);
        const auto m = revchain::modes(links, {.count = revchain::all_modes, .certify = true});
        REQUIRE(m.size() == static_cast<Index>(heights.size()));
        CHECK(m.status == revchain::Status::success);
        double worst = 0, worst_bound = 0;  // all in ulp
        for (Index j = 0; j < m.size(); ++j) {
            const Quad exact = heights[static_cast<std::size_t>(j)];
            const double error = static_cast<double>(fabsq(quad(m.conical_height[j]) / exact - 1)) / ulp;
            const double bound = static_cast<double>(m.error_bound[j]) / ulp;
            const auto& c = m.certificate;
            const double width = static_cast<double>((quad(c.upper[j]) - quad(c.lower[j])) / exact) / ulp;
            CAPTURE(name, j, error, bound, width);
            CHECK(error <= bound);
            worst = std::max(worst, error);
            worst_bound = std::max(worst_bound, bound);
            CHECK(quad(c.lower[j]) < exact);
            CHECK(exact <= quad(c.upper[j]));
            CHECK(c.above_lower[j] > j);
            CHECK(c.above_upper[j] <= j);
            CHECK(revchain::count_modes(links, {.conical_height = c.lower[j]}) == c.above_lower[j]);
            CHECK(revchain::count_modes(links, {.conical_height = c.upper[j]}) == c.above_upper[j]);
            CHECK(width <= 2 * bound + 1);  // each end is rounded
        }
        CAPTURE(name, worst, worst_bound);
        CHECK(worst <= (std::is_same_v<T, QuadScalar> ? 4.01 : 0.501));
        CHECK(worst_bound <= (is_wider_at_hand ? 2.001 : 2100));
    }
}

TEMPLATE_TEST_CASE("speeds, shapes, windows and ranges in more than double", "[linear]", DoubleDouble, QuadScalar) {
    using T = TestType;
    const auto links = chain<T>("bodies");
    const auto all = revchain::modes(links, {.count = revchain::all_modes});
    const auto narrow = revchain::modes(chain<double>("bodies"), {.count = revchain::all_modes});
    for (Index j = 0; j < all.size(); ++j) {
        CHECK(static_cast<double>(all.residual()[j]) <= 1e-30);
        CHECK(all.nodes()[static_cast<std::size_t>(j)].size() == narrow.nodes()[static_cast<std::size_t>(j)].size());
        for (Index m = 0; m <= links.size(); ++m)
            REQUIRE(std::abs(static_cast<double>(all.shapes()(j, m) - T(narrow.shapes()(j, m)))) <= 4e-16);
    }
    const auto some = revchain::modes(links, {.first = 11, .count = 5});
    CHECK(some.first == 11);
    for (Index j = 0; j < 5; ++j)
        CHECK(static_cast<double>(fabsq(quad(some.conical_height[j]) / quad(all.conical_height[10 + j]) - 1)) <= 4e-31);
    // g / n^2 with n = 2, g = 4: a height of exactly 1
    const auto low = revchain::modes(links, {.angular_speed = revchain::SpeedWindow<T>{T(0), T(2)}, .gravity = T(4)});
    const auto high = revchain::modes(links, {.conical_height = revchain::HeightWindow<T>{T(0), T(1)}});
    CHECK(low.size() + high.size() == 40);
    CHECK(high.first == low.size() + 1);
    const Quad turns = quad(all.angular_speed(T(1))[0]);
    CHECK(static_cast<double>(fabsq(turns * turns * quad(all.conical_height[0]) - 1)) <= 1e-30);
    if constexpr (std::is_same_v<T, DoubleDouble>)
        CHECK(static_cast<double>(fabsq(quad(all.period(T(1))[0]) * turns / (2 * pi) - 1)) <= 1e-30);
}

TEST_CASE("a thousand links in two doubles", "[linear]") {
    const auto rods = [](auto one) { return revchain::Chain<decltype(one)>::uniform_rods(1000, one * 1024, one); };
    const auto m = revchain::modes(rods(DoubleDouble(1)), {.count = 3});
    const auto wider = revchain::modes(rods(QuadScalar(1)), {.count = 3});
    for (Index j = 0; j < 3; ++j) {
        CAPTURE(j, static_cast<double>(m.error_bound[j]));
        CHECK(static_cast<double>(m.error_bound[j]) <= 2e-24);
        CHECK(static_cast<double>(fabsq(quad(m.conical_height[j]) / quad(wider.conical_height[j]) - 1)) <= 1e-30);
    }
}

TEST_CASE("what does not fit into float is refused", "[linear]") {
    const auto refusal = [](double weight, double length) -> std::string {
        try {
            const std::vector<revchain::Link<double>> links(2, revchain::plummet(weight, length));
            revchain::detail::converted<float>(revchain::Chain<double>(links));
        } catch (const revchain::InvalidArgument& error) {
            return error.what();
        }
        return "";
    };
    CHECK(refusal(1e-30, 1e30).empty());
    for (const double weight : {1e-60, 1e60})
        CHECK_THAT(refusal(weight, 1), Catch::Contains("links[0]: weight must lie in the range of the precision"));
    CHECK_THAT(refusal(1, 1e-300), Catch::Contains("length must lie in the range of the precision"));
}

// Counts in float would lose a million links altogether: float chains are solved in double.
TEST_CASE("a million links in float: the nearest floats", "[linear]") {
    support::Random random(32);
    const Index n = 1'000'000;
    std::vector<float> weight(static_cast<std::size_t>(n));
    for (float& w : weight) w = static_cast<float>(random.between(0.5, 2));
    const revchain::Chain<float> chain(n, std::move(weight), 1.0F, 1.0F, 0.0);
    const auto m = revchain::modes(chain, {.count = 5});
    const auto exact = revchain::modes(revchain::detail::converted<double>(chain), {.count = 5});
    CHECK(m.status == revchain::Status::success);
    for (Index j = 0; j < 5; ++j) {
        CHECK(m.conical_height[j] == static_cast<float>(exact.conical_height[j]));
        CHECK(m.error_bound[j] <= 0.50001F * revchain::epsilon<float>());
    }
}
