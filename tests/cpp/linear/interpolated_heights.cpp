// SPDX-License-Identifier: MPL-2.0
// Many heights to the last digit at once.
#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::modes;
using revchain::ModesMethod;
using support::Quad;

namespace {

constexpr double ulp = 0x1p-52;

Chain<double> scaled(const Chain<double>& chain, double weight, double length) {
    return support::chain_of(chain.size(), [&](Index m) {
        auto link = chain.link(m);
        link.weight *= weight, link.length *= length, link.centroid *= length;
        return link;
    });
}

}  // namespace

TEST_CASE("many heights at once are those one by one", "[linear]") {
    for (const auto& family : support::families()) {
        for (const Index n : {12, 33, 150}) {
            const auto chain = family.make(n);
            const auto all = modes(chain, {.count = revchain::all_modes}, revchain::methods::all);
            const auto sure =
                modes(chain, {.count = revchain::all_modes, .method = ModesMethod::bisection}, revchain::methods::all);
            CAPTURE(family.name, n, all.method);
            CHECK(all.status == revchain::Status::success);
            CHECK(all.error_bound.maxCoeff() <= 2.0001 * ulp);
            CHECK(all.conical_height == sure.conical_height);
            if (all.method == "interpolated") CHECK(all.error_bound.maxCoeff() <= 0.51 * ulp);
        }
    }
}

TEST_CASE("what is taken where", "[linear]") {
    const auto method = [](Index n, Index count, std::optional<double> rtol = {}) {
        return modes(Chain<double>::uniform_rods(n), {.count = count, .rtol = rtol}, revchain::methods::all).method;
    };
    CHECK(method(1, 1) == "aberth");
    CHECK(method(12, 12) == "aberth");
    CHECK(method(100, 1) == "bisection");
    CHECK(method(100, 20) == "bisection");
    CHECK(method(100, 100) == "aberth");
    CHECK(method(200, 150) == "interpolated");
    CHECK(method(1000, 1) == "condensed");
    CHECK(method(1000, 4) == "bisection");
    CHECK(method(1000, 200) == "interpolated");
    CHECK(method(1000, 600, 1e-13) == "interpolated");
    CHECK(modes(support::families()[7].make(40), {.count = revchain::all_modes}, revchain::methods::all).method ==
          "bisection");
}

TEST_CASE("units do not matter to many heights", "[linear]") {
    for (const auto& family : support::families()) {
        const auto chain = family.make(40);
        const auto one = modes(chain, {.count = revchain::all_modes}, revchain::methods::all);
        for (const double weight : {0x1p-80, 0x1p7, 0x1p300}) {
            for (const double length : {0x1p-60, 0x1p3, 0x1p200}) {
                const auto other =
                    modes(scaled(chain, weight, length), {.count = revchain::all_modes}, revchain::methods::all);
                CAPTURE(family.name, weight, length);
                CHECK(other.conical_height == (one.conical_height * length).eval());
                CHECK(other.error_bound == one.error_bound);
            }
        }
    }
}

TEST_CASE("shapes of many modes are as good as one by one", "[linear]") {
    for (const auto& family : support::families()) {
        const auto chain = family.make(60);
        const auto all = modes(chain, {.count = revchain::all_modes}, revchain::methods::all);
        const auto sure =
            modes(chain, {.count = revchain::all_modes, .method = ModesMethod::bisection}, revchain::methods::all);
        CAPTURE(family.name, all.method);
        CHECK((all.shapes() - sure.shapes()).cwiseAbs().maxCoeff() <= 2.3e-16);
        for (std::size_t j = 0; j < all.nodes().size(); ++j) {
            REQUIRE(all.nodes()[j].size() == sure.nodes()[j].size());
            for (Index i = 0; i < all.nodes()[j].size(); ++i)
                CHECK(std::abs(all.nodes()[j][i] - sure.nodes()[j][i]) <= 2 * ulp * all.nodes()[j][i]);
        }
    }
}

TEST_CASE("tolerances between those of double and of two words", "[linear]") {
    const auto chain = Chain<double>::uniform_rods(200);
    for (double rtol = 2 * ulp; rtol < 1e-9; rtol *= 1.7) {
        const auto m = modes(chain, {.count = revchain::all_modes, .rtol = rtol}, revchain::methods::all);
        CAPTURE(rtol);
        CHECK(m.method == "interpolated");
        CHECK(m.status == revchain::Status::success);
        CHECK(m.error_bound.maxCoeff() <= rtol);
    }
    CHECK(modes(chain, {.count = revchain::all_modes, .rtol = 1e-17}, revchain::methods::all).status ==
          revchain::Status::tolerance_not_met);
}

TEST_CASE("many heights can be watched and stopped", "[linear]") {
    const auto chain = Chain<double>::uniform_rods(200);
    revchain::Progress progress;
    REQUIRE(modes(chain, {.count = revchain::all_modes, .progress = &progress}, revchain::methods::all).method ==
            "interpolated");
    CHECK(progress.fraction() == 1.0);
    progress.cancel();
    CHECK_THROWS_AS(modes(chain, {.count = revchain::all_modes, .progress = &progress}, revchain::methods::all),
                    revchain::Cancelled);
}
