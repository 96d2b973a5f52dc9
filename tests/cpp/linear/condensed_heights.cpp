// SPDX-License-Identifier: MPL-2.0
#include "revchain/linear/condensed_heights.hpp"

#include "revchain/methods.hpp"
#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using namespace revchain;
using support::Random;

namespace {

/// Worst error in ulp, and in units of the bound, of the condensed heights of a range against those by bisection,
/// whose `unrounded` is good to 1e-20.
struct Comparison {
    double ulp = 0;
    double bounds = 0;
    double largest_bound = 0;
    bool found = false;
};

Comparison compare(const Chain<double>& chain, Index first, Index count) {
    const detail::HeightsOptions<double> options;
    const ModeRange range{first, count};
    const auto fast = detail::heights_by_condensation(chain, range, options);
    detail::LazyCounter<double> assembled(chain);
    const auto sure = detail::heights_by_bisection(chain, assembled, range, options);
    Comparison result;
    result.found = fast.has_value();
    if (!fast) return result;
    for (std::size_t j = 0; j < sure.size(); ++j) {
        const auto& truth = sure[j];
        const double error =
            std::abs(static_cast<double>(Wide<double>(fast->found[j].eigenvalue) - truth.unrounded)) / truth.eigenvalue;
        // A height that bisection itself is not sure of is compared within both bounds.
        const double bound = fast->found[j].error_bound + (truth.error_bound > 1e-15 ? truth.error_bound : 0.0);
        result.ulp = std::max(result.ulp, truth.error_bound > 1e-15 ? 0.0 : error * 0x1p52);
        result.bounds = std::max(result.bounds, error / bound);
        result.largest_bound = std::max(result.largest_bound, fast->found[j].error_bound);
    }
    return result;
}

Chain<double> any_chain(Random& random, Index size) {
    const double weights = std::pow(10.0, 12 * random()), lengths = std::pow(10.0, 4 * random());
    const bool plummets = random() < 0.3, same_length = random() < 0.3, odd = random() < 0.3;
    return support::chain_of(size, [&](Index m) -> Link<double> {
        const double weight = m > 0 && random() < 0.02 ? 0.0 : random.log_between(1.0, weights);
        const double length = same_length ? 1.0 : random.log_between(1.0, lengths);
        if (plummets) return plummet<double>(weight, length);
        double centroid = length * random();
        double gyration = length * std::sqrt(centroid / length * (1 - centroid / length)) * random();
        if (odd && random() < 0.05) centroid = length * random.between(1.0, 1.5);   // below the lower pin
        if (odd && m > 0 && random() < 0.01) centroid = -1e-3 * length * random();  // above the upper pin
        if (odd && random() < 0.05) gyration = length * random.between(0.5, 1.5);   // l > a
        return {weight, length, centroid, Wide<double>(gyration / length) * Wide<double>(gyration / length)};
    });
}

}  // namespace

TEST_CASE("Condensed heights agree with those by bisection for every kind of chain", "[condensation]") {
    const Index size = GENERATE(256, 1000, 4096, 10007);
    double worst = 0, bound = 0;
    for (const auto& family : support::families()) {
        const Chain<double> chain = family.make(size);
        const Index count = size <= 1000 ? 20 : 6;
        const Comparison result = compare(chain, 1, count);
        INFO(family.name << ", " << size << " links: " << result.ulp << " ulp, bound "
                         << result.largest_bound * 0x1p52);
        REQUIRE(result.found);
        CHECK(result.bounds <= 1.0);
        worst = std::max(worst, result.ulp);
        bound = std::max(bound, result.largest_bound);
    }
    CHECK(worst <= 1.2);  // ulp
    CHECK(bound <= 0x1.0001p-51);
    WARN(size << " links: worst error " << worst << " ulp, largest bound " << bound * 0x1p52 << " ulp");
}

TEST_CASE("Condensed heights of random chains of mixed links are within their bounds", "[condensation]") {
    Random random(20);
    double worst = 0;
    int found = 0;
    const int chains = 300;
    for (int i = 0; i < chains; ++i) {
        const Index size = 256 + static_cast<Index>(random() * 1500);
        const Chain<double> chain = any_chain(random, size);
        const Index most = std::min<Index>(chain.mode_count(), size / 8);
        const Index first = 1 + static_cast<Index>(random() * static_cast<double>(most) * 0.5);
        const Index count = 1 + static_cast<Index>(random() * 6);
        const Comparison result = compare(chain, first, count);
        INFO("ratio " << result.bounds << " chain " << i << ", " << size << " links, modes from " << first << ": "
                      << result.ulp << " ulp");
        found += result.found ? 1 : 0;
        CHECK(result.bounds <= 1.0);
        worst = std::max(worst, result.ulp);
    }
    CHECK(found >= chains * 95 / 100);
    CHECK(worst <= 0.51);  // ulp; measured 0.49
    WARN("found " << found << " of " << chains << ", worst error " << worst << " ulp");
}

TEST_CASE("A million links: counts on the whole chain prove what the blocks say", "[condensation]") {
    const bool rods = GENERATE(false, true);
    Random random(21);
    const Index size = 1000000;
    std::vector<double> weight(static_cast<std::size_t>(size));
    for (double& w : weight) w = random.between(0.5, 2.0);
    const Link<double> link = rods ? uniform_rod<double>(1.0, 0.01) : plummet<double>(1.0, 0.01);
    const Chain<double> chain(size, weight, link.length, link.centroid, link.gyration_ratio);
    ModesOptions<double> options;
    options.count = 10;
    options.certify = true;
    const auto found = modes(chain, options, revchain::methods::all);
    CHECK(found.method == "condensed");
    CHECK(found.status == Status::success);
    for (Index j = 0; j < 10; ++j) {
        INFO("mode " << j + 1 << ", bound " << found.error_bound[j] * 0x1p52 << " ulp");
        CHECK(found.error_bound[j] <= 0x1.0001p-51);
        const double reach = found.conical_height[j] * (found.error_bound[j] + 0x1p-51);  // ends are rounded outwards
        CHECK(found.certificate.lower[j] >= found.conical_height[j] - reach);
        CHECK(found.certificate.upper[j] <= found.conical_height[j] + reach);
        CHECK(found.certificate.above_lower[j] == j + 1);
        CHECK(found.certificate.above_upper[j] == j);
    }
}

TEST_CASE("Ten million plummets: Laguerre zeros by their asymptotics", "[condensation]") {
    // x_k = j^2/v (1 + (j^2 - 2)/(3 v^2) + O(v^-4)), v = 4 N + 2 (Tricomi); lambda = a / x_k.
    const Index size = 10000000;
    const double j[] = {2.4048255576957727686, 5.5200781102863106496, 8.6537279129110122170};
    const auto chain = Chain<double>(size, 1.0, 1.0, 1.0, Wide<double>(0.0));
    ModesOptions<double> options;
    options.count = 3;
    const auto found = modes(chain, options, revchain::methods::all);
    CHECK(found.method == "condensed");
    for (Index k = 0; k < 3; ++k) {
        const long double zero = j[k], v = 4.0L * static_cast<long double>(size) + 2;
        const long double height = v / (zero * zero) / (1 + (zero * zero - 2) / (3 * v * v));
        const double error =
            static_cast<double>(std::abs(static_cast<long double>(found.conical_height[k]) / height - 1));
        INFO("mode " << k + 1 << ": " << error * 0x1p52 << " ulp, bound " << found.error_bound[k] * 0x1p52);
        CHECK(error <= 1.5 * 0x1p-52);  // 1 of it from the zero, rounded to double
        CHECK(found.error_bound[k] <= 0x1.0001p-51);
    }
}

TEST_CASE("Condensed heights scale exactly with units that are powers of two", "[condensation]") {
    Random random(22);
    const Index size = 3000;
    std::vector<Link<double>> links;
    for (Index m = 0; m < size; ++m)
        links.push_back(compound_pendulum<double>({.weight = random.between(0.5, 2.0),
                                                   .length = random.between(0.5, 2.0),
                                                   .centroid = 0.25,
                                                   .radius_of_gyration = 0.1}));
    const auto heights = [&](int weight_exponent, int length_exponent) {
        std::vector<Link<double>> scaled = links;
        for (Link<double>& link : scaled) {
            link.weight = std::ldexp(link.weight, weight_exponent);
            link.length = std::ldexp(link.length, length_exponent);
            link.centroid = std::ldexp(link.centroid, length_exponent);
        }
        ModesOptions<double> options;
        options.count = 8;
        options.method = revchain::ModesMethod::condensed;
        const auto found = modes(Chain<double>(scaled), options, revchain::methods::all);
        CHECK(found.method == "condensed");
        return Vector<double>(
            found.conical_height.unaryExpr([=](double x) { return std::ldexp(x, -length_exponent); }));
    };
    const auto ordinary = heights(0, 0);
    CHECK(heights(300, 0) == ordinary);
    CHECK(heights(-300, 0) == ordinary);
    CHECK(heights(0, 300) == ordinary);
    CHECK(heights(200, -300) == ordinary);
}

TEST_CASE("A tolerance below what double holds is not met, and the bounds say so", "[condensation]") {
    const auto chain = Chain<double>::uniform_plummets(1000);
    ModesOptions<double> options;
    options.count = 3;
    options.rtol = 1e-16;
    const auto found = modes(chain, options, revchain::methods::all);
    CHECK(found.status == Status::tolerance_not_met);
    CHECK((found.error_bound.array() <= 0x1.0001p-51).all());
}

TEST_CASE("Shapes of condensed chains are as good as their heights", "[condensation]") {
    const Index size = GENERATE(256, 3001, 20000);
    for (const auto& family : support::families()) {
        const Chain<double> chain = family.make(size);
        ModesOptions<double> options;
        options.count = 9;  // not a multiple of a pack
        options.method = revchain::ModesMethod::condensed;
        const auto fast = modes(chain, options, revchain::methods::all);
        options.method = revchain::ModesMethod::bisection;
        const auto sure = modes(chain, options, revchain::methods::all);
        INFO(family.name << ", " << size << " links");
        REQUIRE(fast.method == "condensed");
        REQUIRE(sure.method == "bisection");
        for (Index j = 0; j < fast.size(); ++j) {
            const auto gap_to = [&](Index i) {
                return i < 0 || i >= fast.size()
                           ? 1.0
                           : std::min(1.0, std::abs(sure.conical_height[i] / sure.conical_height[j] - 1));
            };
            const double gap = std::min(gap_to(j - 1), gap_to(j + 1));
            INFO(family.name << ", " << size << " links, mode " << j + 1 << ", gap " << gap);
            CHECK((fast.shapes().row(j) - sure.shapes().row(j)).cwiseAbs().maxCoeff() * gap <= 3e-16);
            CHECK(std::abs(fast.shapes()(j, size - 1) / sure.shapes()(j, size - 1) - 1) * gap <= 4e-16);
            CHECK(fast.shapes().row(j).cwiseAbs().maxCoeff() <= 1 + 0x1p-52);
            CHECK(fast.shapes().row(j).cwiseAbs().maxCoeff() >= 1 - 0x1p-52);
            CHECK(fast.shapes()(j, 0) > 0);
            CHECK(fast.shapes()(j, size) == 0);
            CHECK(fast.residual()[j] <= 4e-16);
            const auto& nodes = fast.nodes()[static_cast<std::size_t>(j)];
            const auto& sure_nodes = sure.nodes()[static_cast<std::size_t>(j)];
            REQUIRE(nodes.size() == sure_nodes.size());
            for (Index i = 0; i < nodes.size(); ++i)
                CHECK(std::abs(nodes[i] - sure_nodes[i]) * gap <= 1e-14 * chain.total_length());
        }
    }
}
