// SPDX-License-Identifier: MPL-2.0
#include <random>

#include "revchain/stability_windows.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/catch.hpp"

namespace {

using namespace revchain;
using Links = std::vector<Link<double>>;

bool is_sound(const SteadyShape& shape) {
    return shape.inclination.allFinite() && shape.offset.allFinite() && shape.height.allFinite() &&
           shape.tension.allFinite() && shape.error_bound == shape.error_bound;
}

/// How many shapes two plummets have with both links hanging as the height tends to 0. Each link is horizontal, or what
/// draws it sideways vanishes: both outwards; where the lower or the upper may be the one not drawn; and opposite ones.
std::size_t limit_count(const Link<double>& lower, const Link<double>& upper) {
    const bool lower_undrawn = upper.length < lower.length,
               upper_undrawn = lower.length * lower.weight < (lower.weight + upper.weight) * upper.length;
    return 1U + lower_undrawn + upper_undrawn + (lower_undrawn && upper_undrawn);
}

TEST_CASE("one link at every height: one shape below its pendulum length, none above", "[steady]") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> exponent(-300, 300), unit(-2, 2), share(0.05, 1);
    for (int i = 0; i < 3000; ++i) {
        const double a = std::pow(10, unit(random)), h = i % 3 == 0 ? a : a * share(random);
        const double ratio = i % 3 == 2 ? 4 * share(random) : 0;
        const Chain<double> chain(Links{{1.0, a, h, Wide<double>(ratio)}});
        const double pendulum = h + ratio * a * a / h, height = std::pow(10, i % 4 == 0   ? exponent(random)
                                                                             : i % 4 == 1 ? exponent(random) / 20
                                                                                          : unit(random));
        if (std::abs(height / pendulum - 1) < 1e-6) continue;
        const auto found =
            steady_shapes(chain, {.conical_height = height, .hanging_only = i % 5 != 0}, revchain::thorough);
        INFO("length " << a << ", pendulum length " << pendulum << ", height " << height);
        const double unit_of_length = std::ldexp(1.0, chain.units().length_exponent);
        CHECK(found.complete == (height >= 0x1p-50 * unit_of_length));
        if (!found.complete) continue;
        REQUIRE(found.shapes.size() == (height < pendulum ? 1U : 0U));
        if (height > pendulum) continue;
        CHECK(is_sound(found.shapes[0]));
        const double cosine = height / pendulum;
        CHECK(std::abs(found.shapes[0].inclination[0] - std::atan2(std::sqrt((1 - cosine) * (1 + cosine)), cosine)) <=
              4e-16 + found.shapes[0].error_bound + 4e-16 / std::sqrt(1 - cosine));
    }
}

TEST_CASE("two plummets at small heights: as many shapes as in the limit, or not complete", "[steady]") {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> exponent(-15, -3), number(0.2, 1.2);
    int complete = 0, unproved = 0;
    for (int i = 0; i < 300; ++i) {
        const Link<double> lower = plummet(number(random), number(random)),
                           upper = plummet(number(random), number(random));
        const Chain<double> chain(Links{lower, upper});
        const auto found = steady_shapes(chain, {.conical_height = std::pow(10, exponent(random))}, revchain::thorough);
        for (const SteadyShape& shape : found.shapes) {
            CHECK(is_sound(shape));
            unproved += shape.error_bound > 1e-14;
        }
        CHECK(found.shapes.size() <= limit_count(lower, upper));
        if (found.complete) CHECK(found.shapes.size() == limit_count(lower, upper));
        complete += found.complete;
    }
    CHECK(complete > 250);
    CHECK(unproved < 5);
}

TEST_CASE("lists of shapes end at every height", "[steady]") {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> number(0.2, 1.2), exponent(-300, 300), small(-20, 0);
    for (int i = 0; i < 200; ++i) {
        Links links;
        for (int m = 0; m < 1 + i % 3; ++m) {
            const double a = number(random), ratio = i % 4 == 0 ? 0 : i % 4 == 1 ? 4.0 : number(random);
            links.push_back({number(random), a, i % 4 == 0 ? a : a * number(random) / 1.2, Wide<double>(ratio)});
        }
        const Chain<double> chain(links);
        const double height = std::pow(10, i % 2 == 0 ? exponent(random) : small(random));
        for (const bool hanging_only : {true, false}) {
            const auto found = steady_shapes(
                chain, {.conical_height = height, .budget = 30'000, .hanging_only = hanging_only}, revchain::thorough);
            CHECK(std::all_of(found.shapes.begin(), found.shapes.end(), is_sound));
            if (height > 20) CHECK((found.shapes.empty() && found.complete));
        }
    }
    const Chain<double> rods(Links(2, {1.0, 1.0, 0.5, Wide<double>(4.0)})), plummets(Links(2, plummet(1.0, 1.0)));
    for (const double height : {1e-300, 1e-200, 1e-170, 1e300})
        for (const Chain<double>& chain : {rods, plummets}) {
            const auto found =
                steady_shapes(chain, {.conical_height = height, .hanging_only = false}, revchain::thorough);
            CHECK(found.complete >= (height > 1));
        }
}

TEST_CASE("windows of stability down to heights of 1e-11 have heights", "[steady][stability]") {
    for (const Index links : {1, 2, 3}) {
        const auto chain = Chain<double>::uniform_plummets(links);
        for (Index mode = 1; mode <= links; ++mode) {
            const Branch followed = branch(chain, {.mode = mode, .min_conical_height = conical_pendulum::height(1e6)});
            for (const StabilityWindow& window :
                 stability_windows(chain, followed, {.frame = StabilityFrame::driven, .samples = 2})) {
                CHECK(window.height_from >= window.height_to);
                CHECK(window.height_to >= followed.conical_height.back() * (1 - 1e-12));
            }
        }
    }
}

}  // namespace
