// SPDX-License-Identifier: MPL-2.0
// Which modes: ranges of numbers, windows of heights and speeds; and the certificates that go with them.
#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::HeightWindow;
using revchain::Index;
using revchain::modes;
using revchain::SpeedWindow;
using support::Quad;

namespace {

const double infinite = std::numeric_limits<double>::infinity();

/// The same modes, number for number; heights may differ in the last digit, each being within its bound.
void require_part(const revchain::Modes<double>& part, const revchain::Modes<double>& all) {
    for (Index j = 0; j < part.size(); ++j) {
        const Index i = part.first - all.first + j;
        REQUIRE(i < all.size());
        REQUIRE(std::abs(part.conical_height[j] / all.conical_height[i] - 1) <= 0x1p-52);
        if (part.shapes().size() == 0) continue;
        REQUIRE((part.shapes().row(j) - all.shapes().row(i)).cwiseAbs().maxCoeff() <= 1e-15);
        REQUIRE(part.nodes()[static_cast<std::size_t>(j)].size() == all.nodes()[static_cast<std::size_t>(i)].size());
    }
}

/// Each interval holds its height by counts in quadruple precision, is what the bound says, and its counts are those
/// of `count_modes`.
void require_certificate(const Chain<double>& chain, const revchain::Modes<double>& m) {
    const support::Truth truth(chain);
    const auto& c = m.certificate;
    REQUIRE(c.lower.size() == m.size());
    for (Index j = 0; j < m.size(); ++j) {
        const Index number = m.first + j;
        CAPTURE(number, m.conical_height[j], c.lower[j], c.upper[j]);
        REQUIRE(c.lower[j] < m.conical_height[j]);
        REQUIRE(m.conical_height[j] < c.upper[j]);
        REQUIRE(c.above_lower[j] >= number);
        REQUIRE(c.above_upper[j] <= number - 1);
        REQUIRE(revchain::count_modes(chain, {.conical_height = c.lower[j]}) == c.above_lower[j]);
        REQUIRE(revchain::count_modes(chain, {.conical_height = c.upper[j]}) == c.above_upper[j]);
        REQUIRE(truth.above(c.lower[j]) == c.above_lower[j]);
        REQUIRE(truth.above(c.upper[j]) == c.above_upper[j]);
        const double width = (c.upper[j] - c.lower[j]) / c.lower[j];
        REQUIRE(width <= 2 * m.error_bound[j] / (1 - m.error_bound[j]) + 0x1p-51);  // the ends are rounded
    }
}

}  // namespace

TEST_CASE("any range of mode numbers, without the ones before", "[linear]") {
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 3, 7, 60}) {
            const auto chain = family.make(n);
            const auto all = modes(chain, {.count = revchain::all_modes});
            for (Index first = 1; first <= all.size(); first += n > 10 ? 7 : 1) {
                for (const Index count : {Index(1), Index(2), Index(5), all.size() - first + 1}) {
                    if (first + count - 1 > all.size()) continue;
                    const auto part = modes(chain, {.first = first, .count = count, .certify = true});
                    CAPTURE(family.name, n, first, count);
                    REQUIRE(part.first == first);
                    REQUIRE(part.size() == count);
                    REQUIRE(part.status == revchain::Status::success);
                    require_part(part, all);
                    require_certificate(chain, part);
                }
                CHECK(modes(chain, {.first = first, .count = revchain::all_modes}).size() == all.size() - first + 1);
            }
        }
    }
}

TEST_CASE("ten modes in the middle of 2000", "[linear]") {
    for (const auto& family : support::families()) {
        const auto chain = family.make(2000);
        const auto part = modes(chain, {.first = chain.mode_count() / 2, .count = 10, .certify = true});
        CAPTURE(family.name);
        CHECK(part.error_bound.maxCoeff() <= 0x1.0001p-51);
        require_certificate(chain, part);
    }
}

TEST_CASE("windows of heights are what counts say", "[linear]") {
    support::Random random(71);
    for (const auto& family : support::families()) {
        const auto chain = family.make(40);
        const auto all = modes(chain, {.count = revchain::all_modes});
        const double slowest = all.conical_height[0], fastest = all.conical_height[all.size() - 1];
        Index empty = 0;
        for (int i = 0; i < 40; ++i) {
            const double low = random.log_between(fastest / 2, slowest * 2);
            const double high = low * random.log_between(1.001, i % 2 ? 1.2 : 100);
            const auto part = modes(chain, {.conical_height = HeightWindow<double>{low, high}, .certify = i < 8});
            CAPTURE(family.name, low, high);
            REQUIRE(part.first == revchain::count_modes(chain, {.conical_height = high}) + 1);
            REQUIRE(part.size() == (all.conical_height.array() > low && all.conical_height.array() <= high).count());
            require_part(part, all);
            if (i < 8) require_certificate(chain, part);
            empty += part.size() == 0 ? 1 : 0;
            const double gravity = random.log_between(0.1, 10);
            const auto fast =
                modes(chain, {.angular_speed = SpeedWindow<double>{std::sqrt(gravity / high), std::sqrt(gravity / low)},
                              .gravity = gravity});
            REQUIRE(fast.first == part.first);
            REQUIRE(fast.size() == part.size());
        }
        CHECK(empty < 40);
    }
}

TEST_CASE("windows that meet share no mode and lose none", "[linear]") {
    const auto chain = support::families()[6].make(30);
    const auto all = modes(chain, {.count = revchain::all_modes});
    std::vector<double> ends{0, infinite};
    for (const double height : all.conical_height) ends.push_back(height);  // the hardest places to cut
    std::sort(ends.begin(), ends.end());
    Index next = 1;
    for (std::size_t i = ends.size() - 1; i-- > 0;) {
        const auto part = modes(chain, {.conical_height = HeightWindow<double>{ends[i], ends[i + 1]}});
        CHECK(part.first == next);
        next += part.size();
    }
    CHECK(next == 31);
    next = 1;
    ends = {0, infinite};
    for (const double speed : all.angular_speed()) ends.push_back(speed);
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const auto part = modes(chain, {.angular_speed = SpeedWindow<double>{ends[i], ends[i + 1]}});
        CHECK(part.first == next);
        next += part.size();
    }
    CHECK(next == 31);
}

TEST_CASE("a height exactly at the end of a window", "[linear]") {
    // Greenhill §2: heights 3/2 and 1/2, exact in double
    const Chain<double> chain(std::vector{revchain::plummet(1.0, 1.0), revchain::plummet(3.0, 1.0)});
    const auto in = [&](double low, double high) {
        return modes(chain, {.conical_height = HeightWindow<double>{low, high}}).range();
    };
    using Range = revchain::ModeRange;
    CHECK(in(0.5, 1.5) == Range{1, 1});  // low excluded, high included
    CHECK(in(1.5, 2.0) == Range{1, 0});
    CHECK(in(std::nextafter(1.5, 0.0), 1.5) == Range{1, 1});
    CHECK(in(0.25, 0.5) == Range{2, 1});
    CHECK(in(0.25, std::nextafter(0.5, 0.0)) == Range{3, 0});
    CHECK(in(std::nextafter(0.5, 0.0), infinite) == Range{1, 2});
    CHECK(in(0, infinite) == Range{1, 2});
    // n^2 = g / lambda: with g = 6 the speeds are 2 and sqrt(12), with g = 8 the second is 4
    const auto at = [&](double low, double high, double gravity) {
        return modes(chain, {.angular_speed = SpeedWindow<double>{low, high}, .gravity = gravity}).range();
    };
    CHECK(at(2, 3, 6) == Range{1, 1});  // low included, high excluded
    CHECK(at(1, 2, 6) == Range{1, 0});
    CHECK(at(std::nextafter(2, 3), 3, 6) == Range{2, 0});
    CHECK(at(3, 4, 8) == Range{2, 0});
    CHECK(at(4, infinite, 8) == Range{2, 1});
    CHECK(at(0, infinite, 8) == Range{1, 2});
}

TEST_CASE("an empty window is an empty table", "[linear]") {
    const auto chain = Chain<double>::uniform_rods(5);
    const auto none = modes(chain, {.conical_height = HeightWindow<double>{1, 2}, .certify = true});
    CHECK(none.size() == 0);
    CHECK(none.first == 1);
    CHECK(none.status == revchain::Status::success);
    CHECK(none.angular_speed().size() == 0);
    CHECK(none.certificate.lower.size() == 0);
    CHECK(none.nodes().empty());
    CHECK(none.shapes().rows() == 0);
    CHECK(none.shapes().cols() == 6);
    CHECK(modes(chain, {.conical_height = HeightWindow<double>{0, 1e-9}}).first == 6);
}

TEST_CASE("windows and ranges that are none", "[linear]") {
    const Chain<double> chain(std::vector{revchain::plummet(1.0, 1.0), revchain::plummet(0.0, 1.0),
                                          revchain::plummet(1.0, 1.0), revchain::plummet(1.0, 1.0)});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    using Catch::Matchers::ContainsSubstring;
    const auto heights = [&](double low, double high) {
        (void)modes(chain, {.conical_height = HeightWindow<double>{low, high}});
    };
    CHECK_THROWS_WITH(heights(-1, 2), ContainsSubstring("not negative, got -1"));
    CHECK_THROWS_WITH(heights(2, 1), ContainsSubstring("exceed its low end 2, got 1"));
    CHECK_THROWS_WITH(heights(2, 2), ContainsSubstring("exceed its low end 2, got 2"));
    CHECK_THROWS_AS(heights(nan, 2), revchain::InvalidArgument);
    CHECK_THROWS_AS(heights(1, nan), revchain::InvalidArgument);
    CHECK_THROWS_AS(heights(infinite, infinite), revchain::InvalidArgument);
    CHECK_THROWS_WITH(modes(chain, {.angular_speed = SpeedWindow<double>{2, 1}}), ContainsSubstring("angular speed"));
    CHECK_THROWS_WITH(modes(chain, {.angular_speed = SpeedWindow<double>{0, infinite}, .gravity = -1}),
                      ContainsSubstring("gravity"));
    CHECK_THROWS_WITH(modes(chain, {.first = 0, .count = revchain::all_modes}),
                      ContainsSubstring("first must be at least 1, got 0"));
    CHECK_THROWS_WITH(modes(chain, {.first = 4, .count = revchain::all_modes}),
                      ContainsSubstring("the 3 modes of this chain, got 4"));
    CHECK_THROWS_WITH(modes(chain, {.first = 2, .count = 3}), ContainsSubstring("the 2 from number 2 on"));
    CHECK_THROWS_WITH(modes(chain, {.first = 1, .count = std::numeric_limits<Index>::max() - 1}),
                      ContainsSubstring("the 3 modes"));
    CHECK_THROWS_AS(modes(chain, {.first = std::numeric_limits<Index>::max(), .count = 5}), revchain::InvalidArgument);
    CHECK_THROWS_WITH(modes(chain, {.count = 1, .conical_height = HeightWindow<double>{1, 2}}),
                      ContainsSubstring("not several"));
    CHECK_THROWS_WITH(modes(chain, {.first = 2, .angular_speed = SpeedWindow<double>{1, 2}}),
                      ContainsSubstring("not several"));
    CHECK_THROWS_WITH(
        modes(chain, {.conical_height = HeightWindow<double>{1, 2}, .angular_speed = SpeedWindow<double>{1, 2}}),
        ContainsSubstring("not several"));
}

TEST_CASE("certificates at every tolerance, in every unit", "[linear]") {
    for (const auto& family : support::families()) {
        for (const double rtol : {1.0, 0.3, 1e-3, 1e-9, 1e-13, 1e-15}) {
            const auto chain = family.make(25);
            const auto m = modes(chain, {.count = revchain::all_modes, .rtol = rtol, .certify = true});
            CAPTURE(family.name, rtol);
            REQUIRE(m.status == revchain::Status::success);
            require_certificate(chain, m);
        }
    }
    for (const double unit : {1e-290, 1e-20, 1e290}) {
        const auto chain = Chain<double>::uniform_rods(6, unit);
        require_certificate(chain, modes(chain, {.count = revchain::all_modes, .certify = true}));
    }
    // subnormal heights: the interval grows with the bound, and is the whole axis where nothing is left
    const auto tiny = Chain<double>::uniform_plummets(1000, 1e-304);
    const auto m = modes(tiny, {.first = 900, .count = revchain::all_modes, .certify = true});
    for (Index j = 0; j < m.size(); ++j) {
        CHECK(m.certificate.above_lower[j] >= m.first + j);
        CHECK(m.certificate.above_upper[j] < m.first + j);
        CHECK(m.certificate.lower[j] <= m.conical_height[j]);
        CHECK(m.certificate.upper[j] >= m.conical_height[j]);
    }
}

TEST_CASE("coincident heights are certified together", "[linear]") {
    const Chain<double> chain({revchain::plummet(1.0, 3.0),
                               revchain::Link<double>{1.0, 1.0, 0.5, revchain::Wide<double>(1.75)},
                               revchain::plummet(0.0, 4.0)});
    const auto m = modes(chain, {.count = revchain::all_modes, .certify = true});  // 7, 1, 1
    for (Index j = 1; j < 3; ++j) {
        CHECK(m.certificate.above_lower[j] == 3);
        CHECK(m.certificate.above_upper[j] == 1);
        CHECK(m.certificate.lower[j] < 1);
        CHECK(m.certificate.upper[j] > 1);
    }
}

TEMPLATE_TEST_CASE("ranges and certificates in other scalars", "[linear]", float, long double) {
    using T = TestType;
    const auto chain = Chain<T>::uniform_rods(64, T(1), T(1));
    const support::Truth truth(chain);
    const auto m = modes(chain, {.first = 20, .count = 30, .certify = true});
    for (Index j = 0; j < m.size(); ++j) {
        CHECK(m.error_bound[j] <= T(2.001) * revchain::epsilon<T>());
        CHECK(m.certificate.above_lower[j] == 20 + j);
        CHECK(m.certificate.above_upper[j] == 19 + j);
        CHECK(truth.above(m.certificate.lower[j]) == 20 + j);
        CHECK(truth.above(m.certificate.upper[j]) == 19 + j);
        CHECK(revchain::count_modes(chain, {.conical_height = m.certificate.lower[j]}) == 20 + j);
    }
}
