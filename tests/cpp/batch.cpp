// SPDX-License-Identifier: MPL-2.0
// Batches against quadruple precision, against `modes`, and against themselves in other company.
#include "revchain/questions/batch.hpp"
#include "revchain/batch.hpp"
#include "revchain/modes.hpp"

#include <cstring>
#include <random>

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/error_metric.hpp"
#include "support/truth.hpp"

using revchain::BatchColumn;
using revchain::BatchOptions;
using revchain::Chain;
using revchain::ChainBatch;
using revchain::Index;
using revchain::Table;
using support::Quad;
using support::Random;

namespace {

/// Chains of equally many links with a radius of gyration, or plummets without.
template <class T>
struct Links {
    Index chains, size;
    std::vector<T> weight, length, centroid, radius;

    ChainBatch<T> batch() const {
        ChainBatch<T> b{chains, size, {weight.data(), size, 1}, {length.data(), size, 1}};
        if (centroid.empty()) return b;
        b.centroid = BatchColumn<T>{centroid.data(), size, 1};
        b.radius_of_gyration = BatchColumn<T>{radius.data(), size, 1};
        return b;
    }
    Chain<T> chain(Index c) const { return revchain::detail::chain_of(batch(), c); }
};

enum class Kind { plummets, plummets_over_decades, rods, bodies, bodies_over_decades, beads, odd };
constexpr std::array<Kind, 7> kinds{Kind::plummets, Kind::plummets_over_decades, Kind::rods,
                                    Kind::bodies,   Kind::bodies_over_decades,   Kind::beads,
                                    Kind::odd};

template <class T>
Links<T> random_links(Kind kind, Index chains, Index size, std::uint64_t seed) {
    Random random(seed);
    Links<T> links{chains, size, {}, {}, {}, {}};
    for (Index i = 0; i < chains * size; ++i) {
        double w = random.between(0.5, 2), a = random.between(0.5, 2), h = a, r = 0;
        const bool lowest = i % size == 0;
        switch (kind) {
            case Kind::plummets:
                break;
            case Kind::plummets_over_decades:
                w = random.log_between(1e-4, 1e4), a = random.log_between(1e-2, 1e2);
                break;
            case Kind::rods:
                h = a / 2, r = a / std::sqrt(12.0);
                break;
            case Kind::bodies:
                w = random.log_between(1e-2, 1e2), h = a * random.between(0.05, 1.5), r = a * random();
                break;
            case Kind::bodies_over_decades:
                w = random.log_between(1e-6, 1e6), a = random.log_between(1e-3, 1e3);
                h = a * random.between(0.02, 1), r = a * random.between(0, 0.5);
                break;
            case Kind::beads:
                h = a * random.between(0.2, 0.8);
                break;       // all the mass in one point of the link
            case Kind::odd:  // massless links, centroids at and above the pin, among others
                if (!lowest && random() < 0.2) w = 0;
                h = lowest ? a : a * std::array<double, 4>{-0.1, 0.0, 0.5, 1.3}[static_cast<std::size_t>(4 * random())];
                r = random() < 0.3 ? 0 : a * random.between(0.1, 1);
                break;
        }
        links.weight.push_back(static_cast<T>(w));
        links.length.push_back(static_cast<T>(a));
        if (kind == Kind::plummets || kind == Kind::plummets_over_decades) continue;
        links.centroid.push_back(static_cast<T>(h));
        links.radius.push_back(static_cast<T>(r));
    }
    return links;
}

bool same_bits(const Table<double>& x, const Table<double>& y) {
    return x.rows() == y.rows() && x.cols() == y.cols() &&
           std::memcmp(x.data(), y.data(), sizeof(double) * static_cast<std::size_t>(x.size())) == 0;
}

/// The worst error in ulp of all heights, each taken for the mode of its number.
template <class T>
double worst_error(const Links<T>& links, const Table<T>& heights) {
    double worst = 0;
    for (Index c = 0; c < links.chains; ++c) {
        const support::Truth truth(links.chain(c));
        for (Index j = 0; j < heights.cols(); ++j) {
            const Quad h = heights(c, j), reach = 1000 * Quad(std::numeric_limits<T>::epsilon());
            const Quad exact = truth.height(j, h * (1 - reach), h * (1 + reach), 1e-19);
            worst = std::max(worst, support::error_in_ulp(heights(c, j), exact));
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("batch: every height against quadruple precision") {
    const Kind kind = GENERATE(from_range(kinds));
    const auto [size, chains] = GENERATE(
        table<Index, Index>({{1, 50}, {2, 300}, {3, 200}, {5, 150}, {10, 50}, {16, 20}, {17, 20}, {40, 3}, {100, 1}}));
    const Links<double> links = random_links<double>(kind, chains, size, static_cast<std::uint64_t>(size));
    const BatchOptions options{.count = kind == Kind::odd ? std::optional<Index>(1) : std::nullopt};
    const double most = kind == Kind::plummets || kind == Kind::rods ? 2.8 : 4.2;
    CHECK(worst_error(links, revchain::conical_heights(links.batch(), options)) <= most);
}

TEST_CASE("batch: ten thousand random chains, none wrong") {
    for (const Kind kind : kinds) {
        Index wrong = 0;
        for (Index size = 1; size <= 6; ++size) {
            const Links<double> links = random_links<double>(kind, 240, size, 99);
            const BatchOptions options{.count = kind == Kind::odd ? std::optional<Index>(1) : std::nullopt};
            const auto heights = revchain::conical_heights(links.batch(), options);
            for (Index c = 0; c < links.chains; ++c) {
                const support::Truth truth(links.chain(c));
                for (Index j = 0; j < heights.cols(); ++j) {
                    const Quad h = heights(c, j), reach = 6 * Quad(0x1p-52);
                    wrong += truth.above(h * (1 - reach)) <= j || truth.above(h * (1 + reach)) > j;
                }
            }
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("batch: a pendulum length is as good as a radius of gyration; numbers that serve many are stored once") {
    const std::vector<double> weight{1, 2, 3};
    const double length = 1, centroid = 0.5, pendulum_length = 2.0 / 3;
    ChainBatch<double> batch{4, 3, {weight.data(), 0, 1}, {&length, 0, 0}};
    batch.centroid = BatchColumn<double>{&centroid, 0, 0};
    batch.pendulum_length = BatchColumn<double>{&pendulum_length, 0, 0};
    const auto heights = revchain::conical_heights(batch, {.count = 2});
    REQUIRE(heights.rows() == 4);
    REQUIRE(heights.cols() == 2);
    const auto one =
        revchain::modes(revchain::detail::chain_of(batch, 0), {.count = revchain::all_modes}).conical_height;
    for (Index c = 0; c < 4; ++c)
        for (Index j = 0; j < 2; ++j) CHECK(support::error_in_ulp(heights(c, j), one[j]) <= 3);
    batch.chains = 0;
    CHECK(revchain::conical_heights(batch).rows() == 0);
    CHECK(revchain::conical_heights(batch).cols() == 3);
}

TEST_CASE("batch: the same bits with any number of threads, at any place, in any company") {
    const Index size = GENERATE(3, 10, 16, 21);
    for (const Kind kind : kinds) {
        const Links<double> links = random_links<double>(kind, 75, size, 5);
        BatchOptions options{.count = kind == Kind::odd ? std::optional<Index>(1) : std::nullopt};
        const auto all = revchain::conical_heights(links.batch(), options);
        for (const Index threads : {2, 3, 100}) {
            options.threads = threads;
            CHECK(same_bits(all, revchain::conical_heights(links.batch(), options)));
        }
        options.threads = 1;
        std::vector<Index> order(75);
        for (Index c = 0; c < 75; ++c) order[static_cast<std::size_t>(c)] = c;
        std::shuffle(order.begin(), order.end(), std::mt19937(7));
        Links<double> mixed{75, size, {}, {}, {}, {}};
        const auto append = [&](std::vector<double>& to, const std::vector<double>& from, Index c) {
            if (!from.empty()) to.insert(to.end(), from.begin() + c * size, from.begin() + (c + 1) * size);
        };
        for (const Index c : order) {
            append(mixed.weight, links.weight, c);
            append(mixed.length, links.length, c);
            append(mixed.centroid, links.centroid, c);
            append(mixed.radius, links.radius, c);
        }
        const auto shuffled = revchain::conical_heights(mixed.batch(), options);
        for (Index i = 0; i < 75; ++i) {
            const Index c = order[static_cast<std::size_t>(i)];
            CHECK(same_bits(shuffled.row(i), all.row(c)));
            if (i % 15 != 0) continue;
            ChainBatch<double> single = links.batch();
            single.chains = 1;
            single.weight.data += c * size;
            single.length.data += c * size;
            if (single.centroid) single.centroid->data += c * size;
            if (single.radius_of_gyration) single.radius_of_gyration->data += c * size;
            CHECK(same_bits(revchain::conical_heights(single, options), all.row(c)));
        }
    }
}

TEST_CASE("batch: the same bits in any unit that is a power of two") {
    for (const Kind kind : {Kind::plummets_over_decades, Kind::bodies_over_decades, Kind::rods}) {
        const Links<double> links = random_links<double>(kind, 40, 7, 6);
        const auto heights = revchain::conical_heights(links.batch());
        for (const int exponent : {-300, -3, 5, 300}) {
            Links<double> scaled = links;
            for (double& w : scaled.weight) w = std::ldexp(w, exponent);
            CHECK(same_bits(heights, revchain::conical_heights(scaled.batch())));
            for (auto* lengths : {&scaled.length, &scaled.centroid, &scaled.radius})
                for (double& a : *lengths) a = std::ldexp(a, -exponent);
            CHECK(same_bits(heights, revchain::conical_heights(scaled.batch()) * std::ldexp(1.0, exponent)));
        }
    }
}

TEST_CASE("batch: chains that lanes cannot do are done alone, and their neighbours are not disturbed") {
    // Nearly equal heights, ratios of weights beyond the lanes, subnormal weights, a double height
    std::vector<double> weight, length;
    const auto add = [&](std::array<double, 3> w, std::array<double, 3> a) {
        weight.insert(weight.end(), w.begin(), w.end());
        length.insert(length.end(), a.begin(), a.end());
    };
    add({1, 1, 1}, {1, 1, 1});
    add({1, 0x1p-120, 1}, {1, 1, 1});
    add({1, 1e16, 1}, {1, 1, 1});
    add({1, 1e-30, 1e-10}, {1, 1e-8, 1});
    add({0x1p-1060, 0x1p-1060, 0x1p-1060}, {1, 1, 1});
    add({0x1p1000, 0x1p1000, 0x1p1000}, {1, 1, 1});
    add({1, 1e3, 1e6}, {1, 1e3, 1e6});
    add({1, 1, 1}, {1, 1, 1});
    const Index chains = static_cast<Index>(weight.size()) / 3;
    const ChainBatch<double> batch{chains, 3, {weight.data(), 3, 1}, {length.data(), 3, 1}};
    const auto heights = revchain::conical_heights(batch);
    for (Index c = 0; c < chains; ++c) {
        const auto sure =
            revchain::modes(revchain::detail::chain_of(batch, c), {.count = revchain::all_modes}).conical_height;
        for (Index j = 0; j < 3; ++j) CHECK(support::error_in_ulp(heights(c, j), sure[j]) <= 4);
    }
    CHECK(same_bits(heights.row(0), heights.row(7)));
}

TEST_CASE("batch: float is double rounded; other scalars one by one") {
    const Links<float> links = random_links<float>(Kind::bodies, 100, 6, 8);
    CHECK(worst_error(links, revchain::conical_heights(links.batch())) <= 0.5001);
    const Links<long double> wide = random_links<long double>(Kind::rods, 3, 4, 8);
    const auto heights = revchain::conical_heights(wide.batch());
    for (Index c = 0; c < 3; ++c)
        for (Index j = 0; j < 4; ++j)
            CHECK(heights(c, j) == revchain::modes(wide.chain(c), {.count = revchain::all_modes}).conical_height[j]);
}

TEST_CASE("batch: wrong numbers are named with their chain and link, before anything is computed") {
    using Catch::Matchers::ContainsSubstring;
    Links<double> links = random_links<double>(Kind::rods, 40, 4, 9);
    const auto message = [&](const BatchOptions& options = {}, std::vector<Index> shape = {}) -> std::string {
        ChainBatch<double> batch = links.batch();
        batch.shape = std::move(shape);
        try {
            (void)revchain::conical_heights(batch, options);
        } catch (const revchain::InvalidArgument& wrong) {
            return wrong.what();
        }
        return "nothing";
    };
    CHECK(message() == "nothing");
    CHECK_THAT(message({.count = 5}), ContainsSubstring("count must not exceed the 4 links of a chain, got 5"));
    CHECK_THAT(message({.count = 0}), ContainsSubstring("count must be at least 1, got 0"));
    CHECK_THAT(message({.threads = -1}), ContainsSubstring("threads must not be negative, got -1"));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (auto* column : {&links.weight, &links.length, &links.centroid, &links.radius}) {
        for (const double bad : {nan, std::numeric_limits<double>::infinity(), -1.0}) {
            if (column == &links.centroid && bad == -1.0) continue;
            const double good = (*column)[4 * 17 + 2];
            (*column)[4 * 17 + 2] = bad;
            CHECK_THAT(message(), ContainsSubstring("revchain::conical_heights: chain 17: links[2]: "));
            CHECK_THAT(message({.threads = 2}), ContainsSubstring("chain 17: links[2]: "));
            CHECK_THAT(message({}, {8, 5}), ContainsSubstring("chain (3, 2): links[2]: "));
            (*column)[4 * 17 + 2] = good;
        }
    }
    links.weight[4 * 30] = nan;
    links.weight[4 * 3] = -7;
    CHECK_THAT(message(), ContainsSubstring("chain 3: links[0]: weight must be finite and not negative, got -7"));
    links.weight[4 * 3] = links.weight[4 * 30] = 1;
    links.weight[4 * 5 + 1] = links.weight[4 * 5 + 2] = links.weight[4 * 5 + 3] = 0;
    CHECK_THAT(message(), ContainsSubstring("chain 5 has only 2 modes; count must not exceed them, got 4"));
    CHECK(message({.count = 2}) == "nothing");
}

TEST_CASE("batch: can be stopped") {
    const Links<double> links = random_links<double>(Kind::plummets, 1000, 5, 10);
    revchain::Progress progress;
    (void)revchain::conical_heights(links.batch(), {.threads = 2, .progress = &progress});
    progress.cancel();
    CHECK_THROWS_AS(revchain::conical_heights(links.batch(), {.threads = 2, .progress = &progress}),
                    revchain::Cancelled);
}
