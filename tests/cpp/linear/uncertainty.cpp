// SPDX-License-Identifier: MPL-2.0
#include "revchain/sensitivity.hpp"

#include <numbers>

#include "revchain/modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::Chain;
using revchain::Datum;
using revchain::Index;

namespace {

/// Normal deviates, the same on every platform.
class Normal {
   public:
    explicit Normal(std::uint64_t seed) : random_(seed) {}
    double operator()() {
        const double u = 1 - random_(), v = random_();
        return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
    }

   private:
    support::Random random_;
};

revchain::Deviation<double> each(double x) { return {revchain::Vector<double>::Constant(1, x), {}}; }

}  // namespace

TEST_CASE("standard deviations are those of a sample of 20,000 chains", "[linear]") {
    constexpr Index n = 4;
    constexpr int samples = 20000;
    const double weight = 0.01, length = 0.002, centroid = 0.003, radius = 0.004, common = 0.005;
    const auto link = [](Index m) {
        return revchain::compound_pendulum<double>(
            {.weight = 1.0 + static_cast<double>(m), .length = 1.0, .centroid = 0.4, .radius_of_gyration = 0.3});
    };
    const auto chain = support::chain_of(n, link);
    const auto m = revchain::modes(chain, {.count = revchain::all_modes});
    revchain::Deviations<double> deviations;
    deviations[0] = {{},
                     revchain::Matrix<double>::Constant(n, n, common * common) +
                         revchain::Matrix<double>(revchain::Vector<double>::Constant(n, weight * weight).asDiagonal())};
    deviations[1] = each(length), deviations[2] = each(centroid), deviations[3] = each(radius);
    const auto found = revchain::uncertainty(revchain::sensitivity(chain, m), m.conical_height, deviations);

    Normal normal(17);
    revchain::Vector<double> sum = revchain::Vector<double>::Zero(n), squares = sum;
    for (int i = 0; i < samples; ++i) {
        const double all = common * normal();
        const auto some = support::chain_of(n, [&](Index at) {
            const auto it = link(at);
            const double w = it.weight + all + weight * normal(), a = it.length + length * normal(),
                         h = it.centroid + centroid * normal(), rho = 0.3 + radius * normal();
            return revchain::compound_pendulum<double>(
                {.weight = w, .length = a, .centroid = h, .radius_of_gyration = rho});
        });
        const revchain::Vector<double> off =
            revchain::modes(some, {.count = revchain::all_modes, .rtol = 1e-9}).conical_height - m.conical_height;
        sum += off, squares += off.cwiseProduct(off);
    }
    for (Index j = 0; j < n; ++j) {
        const double mean = sum[j] / samples, sampled = std::sqrt(squares[j] / samples - mean * mean);
        CAPTURE(j, sampled, found.conical_height[j]);
        CHECK(std::abs(found.conical_height[j] / sampled - 1) < 0.02);  // the sample's own deviation: 0.005
        CHECK(found.relative[j] == found.conical_height[j] / m.conical_height[j]);
        double shares = 0;
        for (const auto& share : found.share) shares += share.row(j).sum();
        CHECK(std::abs(shares - 1) < 1e-14);
    }
}

TEST_CASE("one datum alone: its derivative times its deviation, and it contributes most", "[linear]") {
    const auto chain = Chain<double>::uniform_rods(5);
    const auto m = revchain::modes(chain, {.count = revchain::all_modes});
    const auto sensitivity = revchain::sensitivity(chain, m);
    revchain::Deviations<double> deviations;
    revchain::Vector<double> third = revchain::Vector<double>::Zero(5);
    third[2] = 0.25;
    deviations[static_cast<std::size_t>(Datum::radius_of_gyration)] = {third, {}};
    const auto found = revchain::uncertainty(sensitivity, m.conical_height, deviations);
    for (Index j = 0; j < 5; ++j) {
        CHECK(std::abs(found.conical_height[j] / (0.25 * sensitivity.radius_of_gyration().value(j, 2)) - 1) < 4e-16);
        CHECK(found.datum[static_cast<std::size_t>(j)] == Datum::radius_of_gyration);
        CHECK(found.link[static_cast<std::size_t>(j)] == 2);
    }
    // all weights wrong by one factor: nothing, since weights act by their ratios
    deviations = {};
    deviations[0] = {{}, revchain::Matrix<double>::Constant(5, 5, 1e-4)};
    const auto none = revchain::uncertainty(sensitivity, m.conical_height, deviations);
    CHECK(none.conical_height.maxCoeff() < 1e-9);
    CHECK(revchain::uncertainty(sensitivity, m.conical_height, {}).conical_height.maxCoeff() == 0);
}

TEST_CASE("deviations that are none are refused", "[linear]") {
    const auto chain = Chain<double>::uniform_rods(3);
    const auto m = revchain::modes(chain, {.count = revchain::all_modes});
    const auto sensitivity = revchain::sensitivity(chain, m);
    const auto with = [&](const revchain::Deviation<double>& deviation) {
        revchain::Deviations<double> deviations;
        deviations[1] = deviation;
        return revchain::uncertainty(sensitivity, m.conical_height, deviations);
    };
    using revchain::Matrix;
    using revchain::Vector;
    CHECK_THROWS_AS(with(each(-1)), revchain::InvalidArgument);
    CHECK_THROWS_AS(with(each(std::nan(""))), revchain::InvalidArgument);
    CHECK_THROWS_AS(with({Vector<double>::Ones(2), {}}), revchain::InvalidArgument);
    CHECK_THROWS_AS(with({{}, Matrix<double>::Identity(2, 2)}), revchain::InvalidArgument);
    Matrix<double> skew = Matrix<double>::Identity(3, 3);
    skew(0, 1) = 0.5;
    CHECK_THROWS_AS(with({{}, skew}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::uncertainty(sensitivity, Vector<double>(2), {}), revchain::InvalidArgument);
}
