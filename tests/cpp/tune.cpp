// SPDX-License-Identifier: MPL-2.0
#include "revchain/tune.hpp"

#include "revchain/questions/tune_candidates.hpp"

#include "revchain/compound_link.hpp"
#include "revchain/two_links.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::Chain;
using revchain::Datum;
using revchain::Index;
using revchain::Tuned;
using revchain::TuneStatus;

namespace {

Chain<double> plummets(double w1, double l1, double w2, double l2) {
    return Chain<double>({revchain::plummet(w1, l1), revchain::plummet(w2, l2)});
}

/// The mode of the chain found has the height wanted, as near as the value's last digits let it.
void require_height(const Tuned& tuned, Index mode, double wanted) {
    REQUIRE(tuned.status == TuneStatus::found);
    const auto low = revchain::modes(*tuned.chain, {.first = mode, .count = 1});
    CAPTURE(tuned.value, tuned.error_bound, low.conical_height[0], wanted);
    CHECK(std::abs(low.conical_height[0] / wanted - 1) <= 1e-14 + 20 * tuned.error_bound / std::abs(tuned.value));
}

}  // namespace

TEST_CASE("two plummets: the weight, the thread for a height, against §2 (5)", "[linear]") {
    // (x - l1)(x - l2) = W1 l1 l2/(W1 + W2)
    double worst = 0;
    support::Random random(31);
    for (int i = 0; i < 60; ++i) {
        const double l1 = random.between(0.5, 2), l2 = random.between(0.5, 2), w1 = random.log_between(0.1, 10);
        const double w2 = random.log_between(0.1, 10), goal = random.log_between(0.1, 10);
        const auto heights = revchain::two_plummets(goal, l1, w2, l2);
        for (const Index mode : {1, 2}) {
            const double height = heights[static_cast<std::size_t>(mode - 1)];
            const auto tuned =
                revchain::tune(plummets(w1, l1, w2, l2), {.mode = mode, .link = 0, .conical_height = height});
            CAPTURE(l1, l2, w1, w2, goal, mode, height);
            REQUIRE(tuned.status == TuneStatus::found);
            const __float128 share = (__float128(height) - l1) * (__float128(height) - l2) / l1 / l2;
            const double exact = static_cast<double>(share / (1 - share) * w2);
            CHECK(std::abs(tuned.value - exact) <= tuned.error_bound + 1e-16 * exact);
            worst = std::max(worst, tuned.error_bound / exact);
            // the same thread
            const auto thread = revchain::tune(
                plummets(goal, random.between(0.2, 4), w2, l2),
                {.mode = mode, .link = 0, .datum = Datum::length_in_proportion, .conical_height = height});
            REQUIRE(thread.status == TuneStatus::found);
            CHECK(thread.complete);
            CHECK(thread.values.size() == 1);
            CHECK(std::abs(thread.value / l1 - 1) < 2e-14);
            CHECK(thread.chain->link(0).centroid == thread.value);
        }
    }
    CAPTURE(worst);
    CHECK(worst < 1e-13);
}

TEST_CASE("one body: radius of gyration and centroid for a pendulum length, by hand", "[linear]") {
    const Chain<double> body(
        {revchain::compound_pendulum<double>({.weight = 1, .length = 2, .centroid = 0.5, .radius_of_gyration = 0.3})});
    // lambda = h + rho^2/h
    const auto radius = revchain::tune(body, {.datum = Datum::radius_of_gyration, .conical_height = 1.0});
    CHECK(std::abs(radius.value - 0.5) <= radius.error_bound);
    CHECK(radius.error_bound < 4e-16);
    const auto centroid = revchain::tune(body, {.datum = Datum::centroid, .conical_height = 1.0});
    REQUIRE(centroid.values.size() == 2);  // h^2 - h + 0.09 = 0
    CHECK(std::abs(centroid.values[0] - 0.1) < 2e-16);
    CHECK(std::abs(centroid.values[1] - 0.9) < 4e-16);
    CHECK(centroid.complete);
    CHECK(centroid.value ==
          centroid.values[0] +
              (centroid.values[1] - 0.5 < 0.5 - centroid.values[0] ? centroid.values[1] - centroid.values[0] : 0));
    // no centroid gives less than 2 rho
    const auto none = revchain::tune(body, {.datum = Datum::centroid, .conical_height = 0.5});
    CHECK(none.status == TuneStatus::no_value);
    CHECK(none.complete);
    CHECK(!none.chain);
    CHECK(none.lowest_height >= 0.6);
    CHECK(none.lowest_height < 0.62);
    // the lower pin of the lowest link matters to nothing
    CHECK(revchain::tune(body, {.datum = Datum::length, .conical_height = 0.5}).status == TuneStatus::no_value);
}

TEST_CASE("what was changed is found again, for every datum and mode", "[linear]") {
    support::Random random(37);
    int searched = 0, several = 0;
    for (int round = 0; round < 40; ++round) {
        const Index n = 2 + round % 6;
        const auto chain = support::chain_of(n, [&](Index) {
            const double a = random.between(0.5, 1.5);
            return revchain::compound_pendulum<double>({.weight = random.log_between(0.3, 3),
                                                        .length = a,
                                                        .centroid = a * random.between(0.2, 1),
                                                        .radius_of_gyration = a * random.between(0.05, 0.5)});
        });
        for (std::size_t d = 0; d < 5; ++d) {
            const Datum datum = static_cast<Datum>(d);
            const Index link = 1 + static_cast<Index>(random() * static_cast<double>(n));
            const Index mode = 1 + static_cast<Index>(random() * static_cast<double>(n));
            if (datum == Datum::length && link == 1) continue;
            const double present = revchain::detail::datum_of(chain.link(link - 1), datum);
            const double other = present * random.between(0.7, 1.3);
            std::vector<revchain::Link<double>> links;
            for (Index m = 0; m < n; ++m) links.push_back(chain.link(m));
            auto& it = links[static_cast<std::size_t>(link - 1)];
            it = revchain::detail::with_datum(it, datum, other);
            const double height = revchain::modes(Chain<double>(links), {.first = mode, .count = 1}).conical_height[0];
            const auto tuned = revchain::tune(chain, {.mode = mode,
                                                      .link = link - 1,
                                                      .datum = datum,
                                                      .conical_height = height,
                                                      .low = present / 4,
                                                      .high = present * 4});
            CAPTURE(round, n, d, link, mode, present, other, tuned.error_bound, tuned.value);
            require_height(tuned, mode, height);
            const double nearest = std::abs(tuned.value - present);
            // as near as the one we know, or nearer
            if (datum == Datum::weight)
                CHECK(std::abs(std::log(tuned.value / present)) <= std::abs(std::log(other / present)) + 1e-9);
            else {
                CHECK(tuned.complete);
                CHECK(nearest <= std::abs(other - present) * (1 + 1e-9) + 1e-9);
                CHECK(std::any_of(tuned.values.begin(), tuned.values.end(),
                                  [&](double x) { return std::abs(x / other - 1) < 1e-8; }));
            }
            ++searched;
            several += tuned.values.size() > 1;
        }
    }
    CHECK(searched > 150);
    CHECK(several > 5);
}

TEST_CASE("a speed, and a range in which none does", "[linear]") {
    const auto chain = plummets(1, 1, 3, 1);  // 1.5, 0.5
    const auto tuned = revchain::tune(chain, {.mode = 2, .link = 0, .angular_speed = 4.0, .gravity = 9.81});
    REQUIRE(tuned.status == TuneStatus::found);
    const double height = 9.81 / 16;
    CHECK(std::abs(tuned.value / (3 * (height - 1) * (height - 1) / (1 - (height - 1) * (height - 1))) - 1) < 1e-14);
    // no weights below give the slower mode a height beyond both threads
    const auto none = revchain::tune(chain, {.mode = 1, .link = 0, .conical_height = 2.5});
    CHECK(none.status == TuneStatus::no_value);
    CHECK(none.highest_height < 2);
    CHECK(none.highest_height > 1.99);
    CHECK(none.lowest_height < 1.02);
    const auto narrow =
        revchain::tune(chain, {.mode = 2, .link = 0, .angular_speed = 4.0, .gravity = 9.81, .low = 0.9, .high = 1.1});
    CHECK(narrow.status == TuneStatus::no_value);
}

TEST_CASE("a weight that does nothing of the kind is shown not to, up to the ends of the range", "[linear]") {
    // found or not, and if not, the heights reached are all on one side of the one wanted
    support::Random random(41);
    int found = 0, none = 0;
    for (int round = 0; round < 60; ++round) {
        const Index n = 1 + round % 6;
        const auto chain = support::chain_of(n, [&](Index) {
            const double a = random.log_between(0.1, 10);
            return revchain::compound_pendulum<double>({.weight = random.log_between(0.01, 100),
                                                        .length = a,
                                                        .centroid = a * random.between(0.05, 1.5),
                                                        .radius_of_gyration = a * random.log_between(0.02, 2)});
        });
        const Index mode = 1 + round % n, link = 1 + (round / 6) % n;
        const double wanted =
            revchain::modes(chain, {.first = mode, .count = 1}).conical_height[0] * random.log_between(0.6, 1.6);
        const auto tuned = revchain::tune(chain, {.mode = mode, .link = link - 1, .conical_height = wanted});
        CAPTURE(round, n, mode, link, tuned.lowest_height / wanted, tuned.highest_height / wanted);
        CHECK(tuned.status != TuneStatus::undecided);
        if (tuned.status == TuneStatus::found) {
            require_height(tuned, mode, wanted);
            ++found;
        } else {
            CHECK((tuned.lowest_height > wanted || tuned.highest_height < wanted));
            ++none;
        }
    }
    CHECK(found > 15);
    CHECK(none > 15);
}

TEST_CASE("a long chain, and a bell above its pin", "[linear]") {
    const auto rods = Chain<double>::uniform_rods(2000);
    const double wanted = revchain::modes(rods, {.first = 3, .count = 1}).conical_height[0] * 1.001;
    for (const Datum datum : {Datum::weight, Datum::length_in_proportion}) {
        CAPTURE(datum == Datum::weight);
        const auto tuned = revchain::tune(rods, {.mode = 3, .link = 1499, .datum = datum, .conical_height = wanted});
        require_height(tuned, 3, wanted);
    }
    const Chain<double> bell({revchain::compound_pendulum<double>(
                                  {.weight = 18, .length = 0.65, .centroid = 0.52, .radius_of_gyration = 0.08}),
                              revchain::compound_pendulum<double>(
                                  {.weight = 20, .length = 0.15, .centroid = -0.05, .radius_of_gyration = 0.36})});
    const double now = revchain::modes(bell, {.count = revchain::all_modes}).conical_height[0];
    require_height(revchain::tune(bell, {.mode = 1, .link = 1, .conical_height = now * 1.5}), 1, now * 1.5);
    require_height(revchain::tune(bell, {.mode = 1, .link = 1, .datum = Datum::centroid, .conical_height = now / 1.5}),
                   1, now / 1.5);
}

TEST_CASE("questions that are none are refused", "[linear]") {
    const auto chain = plummets(1, 1, 3, 1);
    using revchain::InvalidArgument;
    CHECK_THROWS_AS(revchain::tune(chain, {}), InvalidArgument);
    CHECK_THROWS_AS(revchain::tune(chain, {.conical_height = 1.0, .angular_speed = 1.0}), InvalidArgument);
    CHECK_THROWS_AS(revchain::tune(chain, {.mode = 3, .conical_height = 1.0}), InvalidArgument);
    CHECK_THROWS_AS(revchain::tune(chain, {.link = -1, .conical_height = 1.0}), InvalidArgument);
    CHECK_THROWS_AS(revchain::tune(chain, {.conical_height = -1.0}), InvalidArgument);
    CHECK_THROWS_AS(revchain::tune(chain, {.conical_height = 1.0, .low = 2, .high = 1}), InvalidArgument);
    CHECK_THROWS_AS(revchain::tune(chain, {.conical_height = 1.0, .low = 0}), InvalidArgument);
    CHECK_THROWS_AS(revchain::tune(chain, {.angular_speed = 1.0, .gravity = 0}), InvalidArgument);
}

template <class System>
concept Tunable = requires(const System& system, const revchain::TuneOptions& options) {
    tune(system, options);
};
static_assert(Tunable<Chain<double>> && !Tunable<revchain::Rig> && !Tunable<revchain::Cord> &&
              !Tunable<revchain::Held<Chain<double>>>);

TEST_CASE("a weight is not reduced so far that a link above would stand", "[linear]") {
    // The upper link's centroid is 2 above its pin: it hangs if the lower weight exceeds 2.
    const auto leaning = revchain::compound_pendulum<double>(
        {.weight = 1.0, .length = 1.0, .centroid = -2.0, .radius_of_gyration = 0.1});
    const auto below = [&](double weight) { return Chain<double>({revchain::plummet(weight, 0.5), leaning}); };
    const Chain<double> chain = below(10);
    double lowest = std::numeric_limits<double>::infinity();
    for (const double height : {0.3, 0.9, 2.0, 2.12, 2.5, 5.0, 50.0}) {
        const auto tuned = revchain::tune(chain, {.link = 0, .conical_height = height});
        CAPTURE(height, tuned.low, tuned.value);
        CHECK(tuned.low > 2);
        CHECK(tuned.low < 2 + 1e-5);
        REQUIRE(tuned.status != TuneStatus::undecided);
        lowest = std::min(lowest, tuned.lowest_height);
        if (tuned.status == TuneStatus::found) {
            require_height(tuned, 1, height);
        } else {
            // no weight of the range reaches it: all heights lie on one side, and do at both ends
            const auto end = [&](double weight) {
                return revchain::modes(below(weight), {.count = 1}).conical_height[0];
            };
            CHECK((end(tuned.low) > height) == (end(tuned.high) > height));
        }
    }
    CHECK(lowest < 2.2);
    CHECK_THROWS_WITH(revchain::tune(chain, {.link = 0, .conical_height = 1.0, .low = 0.1, .high = 1.0}),
                      Catch::Matchers::ContainsSubstring("a link would stand, not hang, up to"));
    // Two such links: the upper one, with more above it, limits the weight.
    const Chain<double> three({revchain::plummet(10.0, 0.5), leaning, revchain::plummet(0.5, 1.0),
                               revchain::compound_pendulum<double>(
                                   {.weight = 2.0, .length = 1.0, .centroid = -3.0, .radius_of_gyration = 0.1})});
    const auto tuned = revchain::tune(three, {.link = 0, .conical_height = 1.0});
    CHECK(tuned.low == Approx(6 - 1.5).epsilon(1e-5));
    CHECK(revchain::tune(three, {.link = 2, .conical_height = 1.0, .low = 0.01, .high = 5.0}).low == 0.01);
}
