// SPDX-License-Identifier: MPL-2.0
#include "revchain/count.hpp"
#include "revchain/modes.hpp"
#include "revchain/recurrence.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/quad_scalar.hpp"
#include "support/truth.hpp"

using revchain::Index;
using support::Quad;
using support::QuadScalar;

TEST_CASE("a user's own scalar", "[linear]") {
    STATIC_REQUIRE(revchain::Real<QuadScalar>);
    STATIC_REQUIRE_FALSE(revchain::Real<int>);
    STATIC_REQUIRE_FALSE(revchain::Real<std::string>);
    const auto chain = revchain::Chain<QuadScalar>::uniform_plummets(12);
    const auto m = revchain::modes(chain, {.count = revchain::all_modes});
    CHECK(m.status == revchain::Status::success);
    // Laguerre: the product of the zeros of L_N is N!, their sum N^2; heights are 1 / (N x)
    Quad sum = 0, product = 1, factorial = 1;
    for (Index j = 0; j < 12; ++j) {
        const Quad zero = 1 / (12 * m.conical_height[j].value());
        sum += zero;
        product *= zero;
        factorial *= static_cast<double>(j + 1);
        CHECK(static_cast<double>(m.error_bound[j]) <= 1e-30);
        CHECK(revchain::count_modes(chain, {.conical_height = m.conical_height[j] * QuadScalar(1 - 1e-15)}) == j + 1);
    }
    CHECK(static_cast<double>(fabsq(sum / 144 - 1)) <= 1e-31);
    CHECK(static_cast<double>(fabsq(product / factorial - 1)) <= 1e-30);
    CHECK(static_cast<double>(m.angular_speed(QuadScalar(9.8))[0]) ==
          Approx(std::sqrt(9.8 / static_cast<double>(m.conical_height[0]))));
    CHECK(revchain::recurrence_matrices(chain).A.rows() == 12);
}

// One chain in four scalars: each within its own bound of the widest.
TEST_CASE("the same headers in every scalar", "[linear]") {
    const auto heights = [](auto one) {
        using T = decltype(one);
        std::vector<revchain::Link<T>> links;
        for (int m = 0; m < 40; ++m)  // data exact in every scalar
            links.push_back(revchain::compound_pendulum<T>({.weight = T(1 + m % 7),
                                                            .length = T(0.5) * T(1 + m % 3),
                                                            .centroid = T(0.25) * T(1 + m % 2),
                                                            .radius_of_gyration = T(0.125) * T(m % 4)}));
        const auto m = revchain::modes(revchain::Chain<T>(links), {.count = revchain::all_modes});
        std::vector<std::pair<Quad, double>> result;
        for (Index j = 0; j < m.size(); ++j) {
            if constexpr (std::is_same_v<T, QuadScalar>)
                result.emplace_back(m.conical_height[j].value(), static_cast<double>(m.error_bound[j]));
            else
                result.emplace_back(Quad(m.conical_height[j]), static_cast<double>(m.error_bound[j]));
        }
        return result;
    };
    const auto truth = heights(QuadScalar(1));
    const auto f = heights(1.0F);
    const auto d = heights(1.0);
    const auto l = heights(1.0L);
    REQUIRE(truth.size() == 40);
    for (std::size_t j = 0; j < 40; ++j) {
        const auto check = [&](const std::pair<Quad, double>& height, double limit) {
            CAPTURE(j, height.second);
            CHECK(static_cast<double>(fabsq(height.first / truth[j].first - 1)) <= height.second + truth[j].second);
            CHECK(height.second <= limit);
        };
        check(f[j], 2.4e-7);
        check(d[j], 4.5e-16);
        check(l[j], 2.2e-19);
    }
}
