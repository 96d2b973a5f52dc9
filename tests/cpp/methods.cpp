// SPDX-License-Identifier: MPL-2.0
#include "revchain/methods.hpp"

#include <tuple>

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::Modes;
using revchain::ModesOptions;
using support::Quad;
using support::Truth;

namespace methods = revchain::methods;

namespace {

/// As a program gets them that includes modes.hpp alone.
template <class T>
Modes<T> by_bisection(const Chain<T>& chain, const ModesOptions<T>& options = {}) {
    return revchain::detail::modes_through(revchain::detail::modes_in_scalar<double>, chain, options);
}

/// A model of one's own: the height of one plummet is the length of its thread.
struct OnePlummet {
    static constexpr std::string_view name = "one plummet";
    using Kind = revchain::models::ChainKind;
    using Question = revchain::models::Question;
    revchain::Fit applies(const Kind& kind, const Question&) const {
        return kind.size == 1 && kind.plummets ? revchain::Fit{} : revchain::Fit::no("not one plummet");
    }
    double error_bound(const Kind&, const Question&) const { return 1e-15; }
    double cost(const Kind&, const Question&) const { return 1e-9; }
    revchain::models::Answer solve(const Chain<double>& chain, const Kind&, const Question& question) const {
        return revchain::models::answer_of_each(question, [&](Index) {
            return revchain::models::BoundedHeight{chain.total_length(), 1e-15};
        });
    }
};

}  // namespace

TEST_CASE("a model of one's own is a method", "[linear]") {
    const std::tuple<OnePlummet> own;
    const auto m = revchain::modes(Chain<double>({revchain::plummet(2.0, 0.75)}), {.rtol = 1e-3}, own);
    CHECK(m.method == "one plummet");
    CHECK(m.conical_height[0] == 0.75);
    CHECK(m.shape(0) == revchain::Vector<double>{{1.0, 0.0}});
    const auto rods = revchain::modes(Chain<double>::uniform_rods(3), {.rtol = 1e-3}, own);
    CHECK(rods.method == "bisection");
}

TEST_CASE("without further methods every height is within its bound, and the nearest double", "[linear]") {
    double worst = 0;
    for (const auto& family : support::families())
        for (const Index n : {1, 2, 3, 5, 10, 31, 100, 300}) {
            const auto chain = family.make(n);
            const auto m = by_bisection(chain, {.count = revchain::all_modes});
            CAPTURE(family.name, n);
            REQUIRE(m.size() == chain.mode_count());
            CHECK(m.method == "bisection");
            CHECK(m.status == revchain::Status::success);
            CHECK(m.error_bound.maxCoeff() <= 0x1.0001p-51);
            const Truth truth(chain);
            for (Index j = 0; j < m.size(); j += n / 30 + 1) {
                const Quad h = m.conical_height[j];
                const Quad exact = truth.height(j, h * (1 - Quad(1e-15)), h * (1 + Quad(1e-15)), 1e-19);
                worst = std::max(worst, support::error_in_ulp(m.conical_height[j], exact));
                REQUIRE((h > exact ? h - exact : exact - h) <= m.error_bound[j] * exact);
            }
        }
    CAPTURE(worst);
    CHECK(worst <= 0.501);
}

TEST_CASE("methods agree within their bounds, in heights, shapes, residuals and nodes", "[linear]") {
    for (const auto& family : support::families())
        for (const Index n : {3, 12, 40, 400}) {
            const auto chain = family.make(n);
            CAPTURE(family.name, n);
            for (const auto& options : {ModesOptions<double>{}, ModesOptions<double>{.rtol = 1e-3},
                                        ModesOptions<double>{.rtol = 1e-9}, ModesOptions<double>{.certify = true}}) {
                const auto plain = by_bisection(chain, options);
                const auto all = revchain::modes(chain, options, methods::all);
                REQUIRE(plain.size() == all.size());
                CHECK(plain.status == all.status);
                for (Index j = 0; j < plain.size(); ++j) {
                    const double off = std::abs(plain.conical_height[j] / all.conical_height[j] - 1);
                    CHECK(off <= (plain.error_bound[j] + all.error_bound[j]) * (1 + 1e-6));
                }
                if (options.rtol) continue;
                CHECK((plain.shapes() - all.shapes()).cwiseAbs().maxCoeff() <= 1e-12);
                CHECK(plain.residual().maxCoeff() <= 1e-15);
                for (std::size_t j = 0; j < plain.nodes().size(); ++j)
                    CHECK(plain.nodes()[j].size() == all.nodes()[j].size());
            }
        }
}

TEST_CASE("a tolerance holds without further methods", "[linear]") {
    for (const auto& family : support::families()) {
        const auto chain = family.make(200);
        const Truth truth(chain);
        for (const double rtol : {0.3, 1e-2, 1e-6, 1e-11, 1e-15}) {
            const auto m = by_bisection(chain, {.count = 5, .rtol = rtol});
            CAPTURE(family.name, rtol);
            CHECK(m.status == revchain::Status::success);
            CHECK(m.error_bound.maxCoeff() <= rtol);
            for (Index j = 0; j < m.size(); ++j) {
                const Quad h = m.conical_height[j], bound = m.error_bound[j];
                CHECK(truth.above(h / (1 + bound) * (1 - Quad(1e-20))) > j);
                CHECK(truth.above(h / (1 - bound) * (1 + Quad(1e-20))) <= j);
            }
        }
    }
}

TEST_CASE("the methods given are those that are used", "[linear]") {
    const auto rods = Chain<double>::uniform_rods(2000);
    CHECK(revchain::modes(rods, {.count = 3}, std::tuple<>()).method == "bisection");
    CHECK(revchain::modes(rods, {.count = 3}, methods::many_modes).method == "bisection");
    CHECK(revchain::modes(rods, {.count = 3}, methods::long_chains).method == "condensed");
    CHECK(revchain::modes(rods, {.count = 3}, methods::within_tolerance).method == "bisection");
    CHECK(revchain::modes(rods, {.count = 3, .rtol = 1e-2}, methods::within_tolerance).method == "continuous chain");
    CHECK(revchain::modes(rods, {.count = 300}, methods::many_modes).method == "interpolated");
    const auto few = Chain<float>::uniform_rods(30);
    CHECK(revchain::modes(few, {.count = revchain::all_modes}, methods::all).method == "aberth");
    CHECK(by_bisection(few).method == "bisection");
    CHECK_THROWS_WITH(
        revchain::modes(rods, {.count = 3, .method = revchain::ModesMethod::condensed}, methods::many_modes),
        Catch::Matchers::ContainsSubstring("condensed"));
}
