// SPDX-License-Identifier: MPL-2.0
// All 2N whirl speeds of hanging gyrostats against a dense linearisation: with z = (n y, y) the quadratic pencil is
// [G K; K 0] z = n [M/g 0; 0 K] z, symmetric, its right side positive definite. Eigen's solver in long double loses what
// the slowest speed is less than the fastest: the metric is the difference over the fastest speed.
#include <Eigen/Eigenvalues>

#include "revchain/rig_modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/rig_truth.hpp"

using namespace revchain;
using Long = long double;

TEST_CASE("all 2N speeds of gyrostats, N to 200: as many as a dense linearisation has, and the same", "[linear]") {
    support::Random random(71);
    for (const Index n : {1, 2, 3, 10, 40, 100, 200}) {
        std::vector<Link<double>> links;
        Rigging with;
        for (Index m = 0; m < n; ++m) {
            const double W = random.between(0.5, 2), a = random.between(0.5, 2);
            links.push_back(m % 2 == 0 ? uniform_rod(W, a) : plummet(W, a));
            with.flywheels.push_back({3 * W * a * random.between(-1, 1), 0});
        }
        const Rig rig{Chain<double>(links), with};
        const RigModes found = modes(rig, {.count = revchain::all_modes});
        REQUIRE(found.complete);
        REQUIRE(found.forward.size() == n);
        REQUIRE(found.backward.size() == n);

        const support::RigTruth truth(rig);
        const Matrix<Long> K = truth.dense<Long>(truth.K), G = truth.dense<Long>(truth.G);
        Matrix<Long> left(2 * n, 2 * n), right = Matrix<Long>::Zero(2 * n, 2 * n);
        left << G, K, K, Matrix<Long>::Zero(n, n);
        right.topLeftCorner(n, n) = truth.dense<Long>(truth.M) / Long(conical_pendulum::standard_gravity);
        right.bottomRightCorner(n, n) = K;
        const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix<Long>> dense(left, right, Eigen::EigenvaluesOnly);
        REQUIRE(dense.info() == Eigen::Success);

        Long worst = 0;
        const Long fastest = std::max(-dense.eigenvalues()[0], dense.eigenvalues()[2 * n - 1]);
        for (Index j = 0; j < n; ++j) {  // ascending: the fastest backward one first
            const Long ahead = dense.eigenvalues()[n + j], back = -dense.eigenvalues()[n - 1 - j];
            REQUIRE(back > 0);
            REQUIRE(ahead > 0);
            worst = std::max({worst, std::abs(ahead - Long(found.forward.angular_speed[j])) / fastest,
                              std::abs(back - Long(found.backward.angular_speed[j])) / fastest});
        }
        CAPTURE(n);
        CHECK(worst <= 1.2e-16L);  // half an ulp: what is left is the rounding of the speeds themselves
    }
}
