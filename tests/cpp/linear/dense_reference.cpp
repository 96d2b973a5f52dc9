// SPDX-License-Identifier: MPL-2.0
#include "revchain/questions/dense_reference.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::Index;

// Three formulations that share only the chain: elements and counts; the assembled pencil; relation (21) and QZ.
TEST_CASE("three formulations give the same modes, each within its own bound", "[linear]") {
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 3, 5, 20}) {
            const auto chain = family.make(n);
            const auto fast = revchain::modes(chain, {.count = revchain::all_modes});
            for (const auto& slow : {revchain::modes_dense(chain, {.count = revchain::all_modes}),
                                     revchain::modes_recurrence(chain, {.count = revchain::all_modes})}) {
                REQUIRE(slow.size() == fast.size());
                for (Index j = 0; j < fast.size(); ++j) {
                    CAPTURE(family.name, n, j, slow.method, slow.error_bound[j]);
                    if (!std::isfinite(slow.error_bound[j])) continue;  // said so: no claim to hold it to
                    const double difference = std::abs(slow.conical_height[j] / fast.conical_height[j] - 1);
                    CHECK(difference <= 1.001 * (slow.error_bound[j] + fast.error_bound[j]));
                    // the bound is a power of two that would not do if halved
                    if (slow.error_bound[j] > 1e-14) CHECK(difference >= 0.2 * slow.error_bound[j]);
                }
            }
        }
    }
}

TEST_CASE("ordinary chains: the dense solvers agree to their accuracy", "[linear]") {
    const auto chain = revchain::Chain<double>::uniform_rods(30);
    const auto dense = revchain::modes_dense(chain, {.count = 3}),
               general = revchain::modes_recurrence(chain, {.count = 3});
    const auto fast = revchain::modes(chain, {.count = 3});
    CHECK(dense.method == "dense");
    CHECK(general.method == "recurrence");
    for (Index j = 0; j < 3; ++j) {
        CHECK(dense.error_bound[j] <= 1e-12);
        CHECK(general.error_bound[j] <= 1e-12);
        CHECK((dense.shapes().row(j) - fast.shapes().row(j)).cwiseAbs().maxCoeff() <= 1e-11);
        CHECK((general.shapes().row(j) - fast.shapes().row(j)).cwiseAbs().maxCoeff() <= 1e-11);
        CHECK(dense.nodes()[static_cast<std::size_t>(j)].size() == j);
    }
}

TEST_CASE("a dense solver that cannot keep the tolerance says so", "[linear]") {
    const auto chain = support::chain_of(
        30, [](Index m) { return revchain::plummet<double>(support::graded(29 - m, 30, 1e12), 1.0); });
    CHECK(revchain::modes(chain, {.count = revchain::all_modes, .rtol = 1e-14}).status == revchain::Status::success);
    CHECK(revchain::modes_dense(chain, {.count = revchain::all_modes, .rtol = 1e-14}).status ==
          revchain::Status::tolerance_not_met);
}

TEST_CASE("any modes by the dense solvers", "[linear]") {
    using Options = revchain::ModesOptions<double>;
    const auto chain = support::families()[3].make(9);
    const auto all = revchain::modes(chain, {.count = revchain::all_modes});
    for (const auto solve : {&revchain::modes_dense<double>, &revchain::modes_recurrence<double>}) {
        const auto part = solve(chain, Options{.first = 3, .count = 4, .certify = true});
        CHECK(part.first == 3);
        REQUIRE(part.size() == 4);
        CHECK((part.conical_height - all.conical_height.segment(2, 4)).cwiseAbs().maxCoeff() <= 1e-12);
        CHECK((part.shapes() - all.shapes().middleRows(2, 4)).cwiseAbs().maxCoeff() <= 1e-10);
        CHECK(part.nodes()[3].size() == 5);
        CHECK(part.residual().size() == 4);
        for (Index j = 0; j < 4; ++j) {
            CHECK(part.certificate.lower[j] < part.conical_height[j]);
            CHECK(part.conical_height[j] < part.certificate.upper[j]);
            CHECK(part.certificate.above_lower[j] == 3 + j);
            CHECK(part.certificate.above_upper[j] == 2 + j);
        }
        const double low = all.conical_height[5] * 0.999, high = all.conical_height[3] * 1.001;
        const auto window = solve(chain, Options{.conical_height = revchain::HeightWindow<double>{low, high}});
        CHECK(window.range() == revchain::ModeRange{4, 3});
        CHECK(solve(chain, Options{.conical_height = revchain::HeightWindow<double>{1e3, 1e4}}).size() == 0);
        CHECK(solve(chain, Options{.first = 2, .rtol = 1e-300}).status == revchain::Status::tolerance_not_met);
        CHECK_THROWS_AS(solve(chain, Options{.first = 10}), revchain::InvalidArgument);
    }
}
