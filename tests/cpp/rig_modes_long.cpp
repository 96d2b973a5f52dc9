// SPDX-License-Identifier: MPL-2.0
// Long rigs whose speeds may be complex. Truths: Newton's step on assembled matrices in quadruple precision, counts of
// sign changes there, and eigenvalues of the dense companion matrix.
#include <Eigen/Eigenvalues>

#include "support/checked_rig_modes.hpp"

using namespace revchain;
using Catch::Matchers::ContainsSubstring;
using support::Random;
using support::RigTruth;
using support::rig_modes::g;
using support::rig_modes::random_body;
using support::rig_modes::worst_error;

namespace {

enum class Kind { standing_gyrostats, driven_wheels, floats, rods };
constexpr Kind kinds[] = {Kind::standing_gyrostats, Kind::driven_wheels, Kind::floats, Kind::rods};

Rig long_rig(Kind kind, Index n) {
    Random random(67);
    std::vector<Link<double>> links;
    Rigging with;
    if (kind == Kind::floats) with.fluid = Fluid::turning;
    for (Index m = 0; m < n; ++m) {
        links.push_back(kind == Kind::rods ? uniform_rod(1.0, 1.0) : random_body(random));
        const Link<double>& b = links.back();
        const double momentum = random.between(0.2, 1) * b.weight * b.length;
        if (kind == Kind::standing_gyrostats || kind == Kind::rods) {
            with.flywheels.push_back({momentum, 0});
            with.posture.push_back(m % 2 == 0 ? Posture::stands : Posture::hangs);
        } else if (kind == Kind::driven_wheels) {
            with.flywheels.push_back({momentum, b.weight * b.length * b.length * random.between(0, 0.5)});
        } else {
            with.displaced.push_back({b.weight * random.between(0, 1.8), b.centroid, b.gyration_ratio, 0});
        }
    }
    return Rig(Chain<double>(links), with);
}

}  // namespace

TEST_CASE("long rigs by discs: every root, each proved", "[linear]") {
    for (const Kind kind : kinds)
        for (const Index n : {250, 700}) {
            const Rig rig = long_rig(kind, n);
            const auto m = modes(rig, {.count = all_modes});
            CAPTURE(static_cast<int>(kind), n);
            REQUIRE(m.method == revchain::RigMethod::discs);
            REQUIRE(m.complete);
            CHECK(m.status == Status::success);
            CHECK(m.forward.size() + m.backward.size() + m.other_available == (m.has_momentum ? 2 : 1) * n);
            const RigTruth truth(rig);
            CHECK(worst_error(truth, m, n / 20) <= 0.51);
            for (const WhirlModes* sense : {&m.forward, &m.backward})
                if (sense->size() > 0) CHECK(sense->speed_error_bound.maxCoeff() <= 4.5e-16);
            for (std::size_t i = 0; i < m.other.size(); i += m.other.size() / 40 + 1) {
                const OtherMode& other = m.other[i];
                CHECK(other.error_bound <= 4e-15);
                CHECK(truth.newton_step(m.has_momentum ? other.angular_speed : other.conical_height, m.has_momentum) <=
                      4e-16);
            }
        }
}

TEST_CASE("long rigs by discs: the eigenvalues of the dense companion matrix", "[linear]") {
    const Index n = 210;
    const Rig rig = long_rig(Kind::standing_gyrostats, n);
    const RigTruth truth(rig);
    const auto m = modes(rig, {.count = all_modes});
    Matrix<double> C(2 * n, 2 * n);
    const Matrix<double> inverse = (truth.dense<double>(truth.M) / g).inverse();
    C << Matrix<double>::Zero(n, n), Matrix<double>::Identity(n, n), inverse * truth.dense<double>(truth.K),
        inverse * truth.dense<double>(truth.G);
    const Eigen::EigenSolver<Matrix<double>> dense(C, false);
    std::vector<std::complex<double>> mine;
    for (const double s : m.forward.angular_speed) mine.emplace_back(s);
    for (const double s : m.backward.angular_speed) mine.emplace_back(-s);
    for (const auto& other : m.other) mine.push_back(other.angular_speed);
    const double largest = dense.eigenvalues().cwiseAbs().maxCoeff();
    for (Index i = 0; i < 2 * n; ++i) {
        double best = 1e300;
        for (const auto& z : mine) best = std::min(best, std::abs(z - dense.eigenvalues()[i]));
        CHECK(best <= 1e-9 * largest);
    }
}

TEST_CASE("long rigs by discs: whatever the number of threads; counted, cancelled, and too long", "[linear]") {
    const Rig rig = long_rig(Kind::standing_gyrostats, 400);
    const auto one = modes(rig, {.count = 5}), three = modes(rig, {.count = 5, .threads = 3});
    CHECK(one.forward.angular_speed == three.forward.angular_speed);
    CHECK(one.backward.speed_error_bound == three.backward.speed_error_bound);
    const RigModeCounter counter(rig);
    CHECK(counter.below_speed(one.forward.angular_speed[3] * (1 + 4e-16)) == 4);
    CHECK(counter.below_speed(one.forward.angular_speed[3] * (1 - 4e-16)) == 3);
    CHECK(counter.below_speed(-one.backward.angular_speed[4] * (1 + 4e-16)) == 5);
    Progress progress;
    progress.cancel();
    CHECK_THROWS_AS(modes(rig, {.progress = &progress}), Cancelled);
    CHECK_THROWS_WITH(modes(long_rig(Kind::floats, 20'001)), ContainsSubstring("at most 20000"));
    CHECK_THROWS_WITH(count_modes(long_rig(Kind::floats, 20'001), {.angular_speed = 1.0}), ContainsSubstring("20001"));
}
