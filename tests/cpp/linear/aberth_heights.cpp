// SPDX-License-Identifier: MPL-2.0
#include "revchain/linear/aberth_heights.hpp"

#include "revchain/linear/rig_roots.hpp"
#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::ModeRange;
using support::Quad;

namespace {

constexpr double ulp = 0x1p-52;
using Found = std::optional<revchain::detail::Heights<double>>;

Found heights(const Chain<double>& chain, const ModeRange& range,
              const revchain::detail::HeightsOptions<double>& options) {
    revchain::detail::LazyCounter<double> assembled(chain);
    return revchain::detail::heights_by_aberth(chain, assembled, range, options);
}

Found all_heights(const Chain<double>& chain, double rtol = 1e-14) {
    return heights(chain, {1, chain.mode_count()}, {.rtol = rtol});
}

double worst_error(const Chain<double>& chain, const Found& found, double rtol = 1e-14) {
    REQUIRE(static_cast<Index>(found->size()) == chain.mode_count());
    const support::Truth truth(chain);
    const Quad unit = std::ldexp(1.0, chain.units().length_exponent);
    double worst = 0;
    for (Index j = 0; j < chain.mode_count(); ++j) {
        const auto& height = (*found)[static_cast<std::size_t>(j)];
        CAPTURE(j, height.eigenvalue, height.error_bound);
        REQUIRE(height.error_bound <= rtol);
        const Quad value = Quad(height.eigenvalue), reach = Quad(1e-12);
        const Quad exact = truth.height(j, value * (1 - reach) * unit, value * (1 + reach) * unit, 1e-21) / unit;
        const double error = static_cast<double>(fabsq((value - exact) / exact));
        REQUIRE(error <= height.error_bound);
        worst = std::max(worst, error / ulp);
    }
    return worst;
}

/// Plummets, rods, or compound pendulums with l < a.
Chain<double> random_chain(support::Random& random, Index n, int kind) {
    return support::chain_of(n, [&](Index) {
        const double weight = random.between(0.5, 2), a = random.between(0.5, 2);
        if (kind == 0) return revchain::plummet<double>(weight, a);
        if (kind == 1) return revchain::uniform_rod<double>(weight, a);
        const double p = random.between(0.2, 0.8);
        return revchain::compound_pendulum<double>(
            {.weight = weight,
             .length = a,
             .centroid = a * p,
             .radius_of_gyration = a * std::sqrt(p * (1 - p)) * random.between(0.3, 0.999)});
    });
}

}  // namespace

TEST_CASE("heights all together: every family, served or not, none wrong", "[linear]") {
    for (const auto& family : support::families())
        for (const Index n : {1, 2, 3, 5, 10, 16, 17, 40, 100}) {
            CAPTURE(family.name, n);
            const Chain<double> chain = family.make(n);
            const Found found = all_heights(chain);
            if (family.name.starts_with("equal") ||
                (family.name.starts_with("random") && n <= 10 && family.name.size() < 16))
                REQUIRE(found);
            if (found) CHECK(worst_error(chain, found) <= 5);
        }
}

TEST_CASE("heights all together: random chains", "[linear]") {
    support::Random random(2027);
    for (const int kind : {0, 1, 2}) {
        int served = 0;
        for (int i = 0; i < 1000; ++i) {
            const Index n = 1 + static_cast<Index>(random() * 12);
            const double rtol = kind == 2 ? 4e-14 : 1e-14;
            CAPTURE(kind, i, n);
            const Chain<double> chain = random_chain(random, n, kind);
            const Found found = all_heights(chain, rtol);
            if (!found) continue;
            ++served;
            CHECK(worst_error(chain, found, rtol) <= 5);
        }
        CAPTURE(kind);
        CHECK(served >= 995);
    }
}

TEST_CASE("heights all together: graded and scattered chains, any tolerance", "[linear]") {
    support::Random random(2028);
    for (const int kind : {0, 1, 2}) {
        int served = 0;
        for (int i = 0; i < 600; ++i) {
            const Index n = 1 + static_cast<Index>(random() * 10);
            const double weights = random.log_between(1, 0x1p20), lengths = random.log_between(0x1p-20, 1);
            const double rtol = i % 3 == 0 ? 4e-14 : i % 3 == 1 ? 1e-9 : 0.5;
            CAPTURE(kind, i, n, rtol);
            const Chain<double> chain = support::chain_of(n, [&](Index m) {
                const Index at = i % 2 == 0 ? m : n - 1 - m;
                const double w = i % 5 == 0 ? random.log_between(1, weights) : support::graded(at, n, weights);
                const double a = support::graded(at, n, lengths), p = random.between(0.02, 0.98);
                if (kind == 0) return revchain::plummet<double>(w, a);
                if (kind == 1) return revchain::uniform_rod<double>(w, a);
                return revchain::compound_pendulum<double>(
                    {.weight = w,
                     .length = a,
                     .centroid = a * p,
                     .radius_of_gyration = a * std::sqrt(p * (1 - p)) * random.between(0.1, 0.99)});
            });
            const Found found = all_heights(chain, rtol);
            if (!found) continue;
            ++served;
            CHECK(worst_error(chain, found, std::min(rtol, 0x1p-32)) <= 5);
        }
        CAPTURE(kind);
        CHECK(served >= (kind == 0 ? 590 : 300));
    }
}

// Before they are rounded they differ from the exact ones by no more than bounds say beside half an ulp for rounding.
TEST_CASE("heights all together to the last digit: random chains", "[linear]") {
    support::Random random(2029);
    int served = 0;
    constexpr int chains = 10'000;
    for (int i = 0; i < chains; ++i) {
        const Index n = 1 + static_cast<Index>(random() * (i % 100 == 0 ? 100 : 12));
        const Chain<double> chain = random_chain(random, n, i % 3);
        const Found found = heights(chain, {1, n}, {});
        if (!found) continue;
        ++served;
        const support::Truth truth(chain);
        const Quad unit = std::ldexp(1.0, chain.units().length_exponent);
        for (Index j = 0; j<n; j += n> 12 ? 17 : 1) {
            const auto& height = (*found)[static_cast<std::size_t>(j)];
            CAPTURE(i, n, j, height.error_bound);
            REQUIRE(height.error_bound <= 2 * ulp);
            REQUIRE(height.eigenvalue == static_cast<double>(height.unrounded));
            const Quad value = (Quad(height.unrounded.high) + Quad(height.unrounded.low)) * unit;
            const Quad off = Quad(height.error_bound) - Quad(ulp / 2) + Quad(1e-30);
            REQUIRE(off > 0);
            REQUIRE(truth.above(value * (1 - off)) > j);
            REQUIRE(truth.above(value * (1 + off)) <= j);
        }
    }
    CHECK(served >= chains - 10);
}

TEST_CASE("heights all together: the unit does not matter", "[linear]") {
    support::Random random(5);
    for (const int kind : {0, 1, 2}) {
        std::vector<revchain::Link<double>> links, scaled;
        const Chain<double> chain = random_chain(random, 7, kind);
        for (Index m = 0; m < 7; ++m) {
            links.push_back(chain.link(m));
            scaled.push_back(chain.link(m));
            scaled.back().weight *= 0x1p400;
            scaled.back().length *= 0x1p-300;
            scaled.back().centroid *= 0x1p-300;
        }
        const auto one = all_heights(chain), other = all_heights(Chain<double>(scaled));
        REQUIRE((one && other));
        for (std::size_t j = 0; j < 7; ++j) {
            CHECK((*one)[j].eigenvalue == (*other)[j].eigenvalue);
            CHECK((*one)[j].error_bound == (*other)[j].error_bound);
        }
    }
}

TEST_CASE("heights all together: some of the modes, and tolerances out of reach", "[linear]") {
    support::Random random(6);
    const Chain<double> chain = random_chain(random, 10, 0);
    const Found all = all_heights(chain);
    const Found some = heights(chain, {4, 3}, {.rtol = 1e-14});
    REQUIRE((all && some));
    REQUIRE(some->size() == 3);
    for (std::size_t j = 0; j < 3; ++j) CHECK((*some)[j].eigenvalue == (*all)[j + 3].eigenvalue);
    CHECK_FALSE(all_heights(Chain<double>::uniform_plummets(129)));
    // massless threads, l > a, and links of both kinds are left to others
    CHECK_FALSE(all_heights(support::families().back().make(5)));
    CHECK_FALSE(all_heights(support::chain_of(
        3, [](Index m) { return m == 1 ? revchain::plummet<double>(1, 1) : revchain::uniform_rod<double>(1, 1); })));
}

TEST_CASE("modes() takes them all together and falls back", "[linear]") {
    support::Random random(9);
    for (const int kind : {0, 1}) {
        const Chain<double> chain = random_chain(random, 10, kind);
        const auto fast = revchain::modes(
            chain, {.count = revchain::all_modes, .rtol = 1e-14, .method = revchain::ModesMethod::aberth},
            revchain::methods::all);
        const auto best = revchain::modes(chain, {.count = revchain::all_modes}, revchain::methods::all);
        CHECK(fast.method == "aberth");
        CHECK(revchain::modes(chain, {.count = revchain::all_modes, .rtol = 1e-14}, revchain::methods::all).method ==
              "aberth");
        CHECK(revchain::modes(chain, {.count = 1, .rtol = 1e-8}, revchain::methods::all).method == "aberth");
        CHECK(best.method == "aberth");
        for (Index j = 0; j < 10; ++j) {
            CHECK(std::abs(fast.conical_height[j] / best.conical_height[j] - 1) <= fast.error_bound[j]);
            CHECK((fast.shapes().row(j) - best.shapes().row(j)).cwiseAbs().maxCoeff() < 1e-12);
        }
    }
    const auto other = revchain::modes(
        support::families().back().make(5),
        {.count = revchain::all_modes, .rtol = 1e-14, .method = revchain::ModesMethod::aberth}, revchain::methods::all);
    CHECK(other.method != "aberth");
    CHECK(other.status == revchain::Status::success);
}

TEST_CASE("heights all together under a spring: nearly every rig is served", "[linear]") {
    support::Random random(67);
    int served = 0;
    for (int i = 0; i < 240; ++i) {
        const Index n = 1 + i / 2;
        const auto chain = random_chain(random, n, i % 3);
        const double carriage = i % 2 == 0 ? 0 : random.log_between(1e-3, 1e3);
        const revchain::Rig rig(chain, {.support = {random.log_between(1e-3, 1e3), carriage, 0}});
        const auto elements = revchain::pencil::positive_elements<false>(revchain::rig_pencil(rig).pencil);
        REQUIRE(elements);
        const Index modes = n + (i % 3 == 0 && carriage == 0 ? 0 : 1);
        const auto roots = revchain::detail::roots_under_a_spring(rig, *elements, {1, modes}, modes);
        if (!roots) continue;
        ++served;
        REQUIRE(static_cast<Index>(roots->size()) == modes);
        for (std::size_t j = 1; j < roots->size(); ++j) CHECK((*roots)[j].unrounded < (*roots)[j - 1].unrounded);
        for (const auto& root : *roots) CHECK(root.error_bound <= 0x1p-52 * (1 + 0x1p-20));
    }
    CHECK(served >= 220);
}
