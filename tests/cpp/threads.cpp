// SPDX-License-Identifier: MPL-2.0
// Every question that takes a number of threads: the same bits whatever it is.
#include <cstring>
#include <random>

#include "revchain/batch.hpp"
#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/questions/modes.hpp"
#include "revchain/response.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::Chain;
using revchain::DoubleDouble;
using revchain::Index;
using revchain::ModesMethod;

namespace {

constexpr Index several[] = {2, 3, 0};

template <class Numbers>
bool same_bits(const Numbers& x, const Numbers& y) {
    using T = typename Numbers::value_type;
    constexpr std::size_t bytes = std::is_same_v<T, long double> ? 10 : sizeof(T);  // the others are padding
    if (x.size() != y.size()) return false;
    for (Index i = 0; i < static_cast<Index>(x.size()); ++i)
        if (std::memcmp(x.data() + i, y.data() + i, bytes) != 0) return false;
    return true;
}

template <class T>
bool same(const revchain::Modes<T>& x, const revchain::Modes<T>& y) {
    bool nodes = true;
    for (std::size_t j = 0; j < x.nodes().size(); ++j) nodes = nodes && same_bits(x.nodes()[j], y.nodes()[j]);
    return nodes && x.method == y.method && same_bits(x.conical_height, y.conical_height) &&
           same_bits(x.error_bound, y.error_bound) && same_bits(x.certificate.lower, y.certificate.lower) &&
           same_bits(x.certificate.upper, y.certificate.upper) &&
           same_bits(x.certificate.above_lower, y.certificate.above_lower) &&
           same_bits(x.certificate.above_upper, y.certificate.above_upper) && same_bits(x.shapes(), y.shapes()) &&
           same_bits(x.residual(), y.residual());
}

template <class T>
void check_modes(const Chain<T>& chain, revchain::ModesOptions<T> options, const std::string& method) {
    options.certify = true;
    const auto one = revchain::modes(chain, options, revchain::methods::all);
    CHECK(one.method == method);
    for (const Index threads : several) {
        options.threads = threads;
        CAPTURE(chain.size(), method, threads);
        CHECK(same(one, revchain::modes(chain, options, revchain::methods::all)));
    }
}

template <class T>
Chain<T> unlike_links(Index size, bool rods) {
    std::mt19937 random(static_cast<unsigned>(size));
    std::uniform_real_distribution<double> about(0.5, 2);
    std::vector<revchain::Link<T>> links;
    for (Index m = 0; m < size; ++m) {
        const T weight = static_cast<T>(about(random)), length = static_cast<T>(about(random));
        links.push_back(rods ? revchain::uniform_rod(weight, length) : revchain::plummet(weight, length));
    }
    return Chain<T>(links);
}

}  // namespace

TEST_CASE("threads: modes by every method", "[linear]") {
    for (const bool rods : {false, true}) {
        check_modes(unlike_links<double>(50, rods), {.count = revchain::all_modes, .method = ModesMethod::aberth},
                    "aberth");
        const auto chain = unlike_links<double>(700, rods);
        check_modes(chain, {.count = revchain::all_modes, .method = ModesMethod::interpolated}, "interpolated");
        check_modes(chain, {.first = 30, .count = 55, .rtol = 1e-12, .method = ModesMethod::interpolated},
                    "interpolated");
        check_modes(chain, {.first = 2, .count = 13, .method = ModesMethod::condensed}, "condensed");
        check_modes(chain, {.first = 2, .count = 13, .method = ModesMethod::bisection}, "bisection");
        check_modes(chain, {.first = 2, .count = 13, .rtol = 1e-6, .method = ModesMethod::bisection}, "bisection");
        check_modes(unlike_links<float>(60, rods), {.count = revchain::all_modes}, "aberth");
        check_modes(unlike_links<long double>(30, rods), {.count = 11}, "bisection");
        check_modes(unlike_links<DoubleDouble>(20, rods), {.count = 5}, "bisection");
    }
    const auto chain = unlike_links<double>(5, false);
    CHECK_THROWS_WITH(revchain::modes(chain, {.threads = -1}), "revchain::modes: threads must not be negative, got -1");
}

TEST_CASE("threads: conical heights of a batch", "[linear]") {
    for (const Index size : {3, 10, 21}) {
        const Index chains = 3000;
        std::mt19937 random(7);
        std::uniform_real_distribution<double> about(0.5, 2);
        std::vector<double> weight, length;
        for (Index i = 0; i < chains * size; ++i) weight.push_back(about(random)), length.push_back(about(random));
        for (Index c = 0; c < chains; c += 97) weight[static_cast<std::size_t>(c * size + 1)] = 1e17;  // not by lanes
        const revchain::ChainBatch<double> batch{
            .chains = chains, .size = size, .weight = {weight.data(), size, 1}, .length = {length.data(), size, 1}};
        const auto one = revchain::conical_heights(batch);
        for (const Index threads : several)
            CHECK(same_bits(one, revchain::conical_heights(batch, {.threads = threads})));
    }
}

TEST_CASE("threads: steady shapes", "[finite]") {
    const auto check = [](const auto& system, auto options) {
        const auto one = revchain::steady_shapes(system, options);
        CHECK(one.shapes.size() > 2);
        for (const Index threads : several) {
            options.threads = threads;
            const auto found = revchain::steady_shapes(system, options);
            REQUIRE(found.shapes.size() == one.shapes.size());
            CHECK(found.cells == one.cells);
            CHECK(found.complete == one.complete);
            for (std::size_t i = 0; i < one.shapes.size(); ++i) {
                const revchain::SteadyShape &x = one.shapes[i], &y = found.shapes[i];
                CHECK(same_bits(x.inclination, y.inclination));
                CHECK(same_bits(x.offset, y.offset));
                CHECK(same_bits(x.tension, y.tension));
                CHECK(x.error_bound == y.error_bound);
                CHECK(x.condition == y.condition);
            }
        }
    };
    const auto chain = Chain<double>::uniform_plummets(8, 8.0);
    check(chain, revchain::SteadyShapesOptions{.conical_height = 0.05});
    const revchain::SteadyShapesOptions any_posture{.conical_height = 0.2, .hanging_only = false};
    check(Chain<double>::uniform_plummets(3, 3.0), any_posture);
    check(revchain::Rig(chain, {.support = {.radius = 0.1}}), revchain::RigShapesOptions{.conical_height = 0.2});
    CHECK_THROWS_WITH(revchain::steady_shapes(chain, {.conical_height = 0.05, .threads = -2}),
                      "revchain::steady_shapes: threads must not be negative, got -2");
}

TEST_CASE("threads: response", "[linear]") {
    const auto check = [](const auto& system, double resonance) {
        std::vector<double> heights{resonance};  // the last digits of a height: in interval arithmetic
        for (int i = 1; i < 500; ++i) heights.push_back(0.01 * i);
        const auto one = revchain::response(system, {.conical_height = heights});
        for (const Index threads : several) {
            const auto found = revchain::response(system, {.conical_height = heights, .threads = threads});
            CAPTURE(threads);
            CHECK(same_bits(one.offset, found.offset));
            CHECK(same_bits(one.error_bound, found.error_bound));
            CHECK(same_bits(one.modes_below, found.modes_below));
            CHECK(same_bits(one.reversed, found.reversed));
            CHECK(same_bits(one.resonant, found.resonant));
            CHECK(same_bits(one.support_force, found.support_force));
            CHECK(same_bits(one.support_force_error, found.support_force_error));
        }
    };
    const auto chain = unlike_links<double>(40, true);
    const double resonance = revchain::modes(chain, {.first = 3, .count = 1}).conical_height[0];
    check(chain, resonance);
    check(revchain::Rig(chain, {.support = {.stiffness = 3.0}}), resonance);
    check(Chain<double>({revchain::plummet(1e-200, 1.0), revchain::plummet(1e200, 1.0)}), 1.0);  // several units
    CHECK_THROWS_WITH(revchain::response(chain, {.conical_height = {1.0}, .threads = -1}),
                      "revchain::response: threads must not be negative, got -1");
}
