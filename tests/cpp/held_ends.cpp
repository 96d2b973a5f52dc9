// SPDX-License-Identifier: MPL-2.0
// Chains held at both ends on arms and springs: against the bodies' Lagrangian in quadruple precision, limits, refusals.
#include "revchain/held.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/held_truth.hpp"
#include "support/tier.hpp"
#include "support/truth.hpp"

namespace {

using revchain::Chain;
using revchain::Held;
using revchain::HeldBy;
using revchain::HeldShape;
using revchain::Index;
using revchain::Support;

Support random_end(support::Random& random, double length, double weight, double height) {
    Support end{.radius = random.between(-0.25, 0.25) * length};
    const double kind = random.between(0, 4);
    if (kind < 1) end.radius = 0;
    if (kind > 2) return end;
    end.stiffness = weight / height * std::exp(random.between(-1, 6));
    end.carriage_weight = kind > 1.5 ? 0 : random.between(0, 0.5) * weight;
    return end;
}

}  // namespace

TEST_CASE("held on arms and springs: 10,000 random systems within their proved bound") {
    support::Random random(20);
    int systems = 0, shapes = 0, sharp = 0, unproved = 0;
    double worst = 0, largest = 0;
    const int many = support::by_tier(400, 10'000);
    while (systems < many) {
        const auto size = static_cast<Index>(random.between(2, 7));
        const Chain<double> chain = support::chain_of(size, [&](Index) {
            const double weight = random.between(0.2, 2), length = random.between(0.2, 2), kind = random.between(0, 3);
            if (kind < 1) return revchain::plummet(weight, length);
            if (kind < 2) return revchain::uniform_rod(weight, length);
            return revchain::compound_pendulum<double>({.weight = weight,
                                                        .length = length,
                                                        .centroid = random.between(0.1, 1.0) * length,
                                                        .radius_of_gyration = random.between(0.1, 0.5) * length});
        });
        const double length = chain.total_length(), height = std::exp(random.between(-6, 0)) * length;
        HeldBy by{.span = random.between(0.1, 0.9) * length};
        by.lower = random_end(random, length, chain.total_weight(), height);
        by.upper = random_end(random, length, chain.total_weight(), height);
        if (by.firm() && std::hypot(*by.span, by.upper.radius - by.lower.radius) >= length) continue;
        ++systems;
        const auto found = revchain::steady_shapes(
            Held(chain, by), {.conical_height = height, .max_half_waves = 2, .prove = true, .budget = 0});
        for (const HeldShape& shape : found.shapes) {
            const double error = support::held_against_truth(chain, by, shape);
            ++shapes, unproved += !shape.proved;
            sharp += shape.error_bound < 9e-16;
            if (shape.proved) worst = std::max(worst, error / shape.error_bound);
            if (shape.proved) largest = std::max(largest, error);
            INFO("system " << systems << ", " << size << " links, height " << height);
            if (shape.proved) CHECK(error <= shape.error_bound);
        }
    }
    CAPTURE(systems, shapes, sharp, unproved, worst, largest);
    CHECK(worst <= 1);
    CHECK(shapes > many);
    CHECK(unproved < shapes / 500);
    CHECK(sharp > 0.95 * shapes);
}

TEST_CASE("held on two arms: no list is complete, because shapes may leave the plane") {
    support::Random random(21);
    int planar = 0, twisted = 0;
    for (int i = 0; i < 60; ++i) {
        const Chain<double> chain = support::chain_of(
            3, [&](Index) { return revchain::plummet(random.between(0.2, 2), random.between(0.2, 2)); });
        const double length = chain.total_length(), height = std::exp(random.between(-3, 0)) * length;
        HeldBy by{.span = random.between(0.1, 0.8) * length};
        by.lower = random_end(random, length, chain.total_weight(), height);
        by.upper = random_end(random, length, chain.total_weight(), height);
        if (by.firm() && std::hypot(*by.span, by.upper.radius - by.lower.radius) >= length) continue;
        const auto found = revchain::steady_shapes(Held(chain, by), {.conical_height = height});
        CHECK(by.planar() == (by.lower.radius == 0 || by.upper.radius == 0));
        CHECK(found.complete == (by.planar() && found.undecided.empty()));
        planar += found.complete, twisted += !by.planar() && found.undecided.empty();
    }
    CHECK(planar > 10);
    CHECK(twisted > 10);
}
