// SPDX-License-Identifier: MPL-2.0
#include "revchain/stability.hpp"

#include <Eigen/Eigenvalues>

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/held.hpp"

using revchain::Chain;
using revchain::HeldShape;
using revchain::Index;
using revchain::Matrix;

namespace {

/// Exponents s of  M x'' + G x' + K x = 0  as eigenvalues of the first-order system, all of it.
std::vector<std::complex<double>> gyroscopic_exponents(const Matrix<double>& M, const Matrix<double>& G,
                                                       const Matrix<double>& K) {
    const Index n = M.rows();
    const Eigen::LLT<Matrix<double>> factor(M);
    const auto reduced = [&](const Matrix<double>& A) {
        const Matrix<double> half = factor.matrixL().solve(A);
        return Matrix<double>(factor.matrixL().solve(half.transpose()).transpose());
    };
    const Matrix<double> stiffness = reduced(K);
    const double pace = std::sqrt(stiffness.cwiseAbs().rowwise().sum().maxCoeff());
    Matrix<double> system = Matrix<double>::Zero(2 * n, 2 * n);
    system.topRightCorner(n, n).setIdentity();
    system.bottomLeftCorner(n, n) = -stiffness / (pace * pace);
    system.bottomRightCorner(n, n) = -reduced(G) / pace;
    const Eigen::EigenSolver<Matrix<double>> solver(system, false);
    std::vector<std::complex<double>> exponents;
    for (Index i = 0; i < 2 * n; ++i) exponents.push_back(solver.eigenvalues()[i] * pace);
    return exponents;
}

/// Exponents of plummets as points in space, three coordinates each, their threads as constraints whose forces are the
/// tensions, less the two of the rotation; in the plane alone if driven.
std::vector<std::complex<double>> by_points(const Chain<double>& chain, const HeldShape& shape, bool driven) {
    const Index n = chain.size(), pins = n - 1, d = driven ? 2 : 3;
    Matrix<double> mass = Matrix<double>::Zero(d * pins, d * pins), spin = mass, stiffness = mass;
    Matrix<double> threads = Matrix<double>::Zero(d * pins, n);
    double below = shape.lower_pull[1];
    for (Index m = 0; m < n; ++m) {
        const auto link = chain.link(m);
        below += shape.conical_height * link.weight;  // lambda times the vertical pull of the thread
        const double s = std::sin(shape.inclination[m]), c = std::cos(shape.inclination[m]);
        const double k = below / c / link.length;
        for (Index i = 0; i < d; ++i) {
            const Index lower = d * (m - 1) + i, upper = d * m + i;
            if (m > 0) stiffness(lower, lower) += k;
            if (m < pins) stiffness(upper, upper) += k;
            if (m > 0 && m < pins) stiffness(lower, upper) -= k, stiffness(upper, lower) -= k;
        }
        for (Index i = 0; i < 2; ++i) {  // coordinates: out from the axis, up, across
            const double e = i == 0 ? -s : c;
            if (m < pins) threads(d * m + i, m) += e;
            if (m > 0) threads(d * (m - 1) + i, m) -= e;
        }
        if (m == 0) continue;  // its plummet lies on the lower bearing
        const Index at = d * (m - 1);
        for (Index i = 0; i < d; ++i) mass(at + i, at + i) = link.weight;
        stiffness(at, at) -= link.weight;
        if (driven) continue;
        stiffness(at + 2, at + 2) -= link.weight;
        spin(at, at + 2) = -2 * link.weight, spin(at + 2, at) = 2 * link.weight;
    }
    const Matrix<double> whole = Eigen::HouseholderQR<Matrix<double>>(threads).householderQ();
    const Matrix<double> free = whole.rightCols(d * pins - n);
    auto exponents = gyroscopic_exponents(free.transpose() * mass * free, free.transpose() * spin * free,
                                          free.transpose() * stiffness * free);
    std::sort(exponents.begin(), exponents.end(), [](auto x, auto y) { return std::abs(x) < std::abs(y); });
    if (!driven) exponents.erase(exponents.begin(), exponents.begin() + 2);
    return exponents;
}

}  // namespace

TEST_CASE("held at both ends: exponents of small disturbances against points in space") {
    double worst = 0;
    int shapes = 0, unstable = 0, gyroscopic = 0;
    for (const char* name : {"equal plummets", "random plummets"})
        for (const auto& family : support::families()) {
            if (family.name != name) continue;
            for (const Index size : {3, 4, 7, 12})
                for (const double share : {0.9, 0.5})
                    for (const double slow : {0.0, 0.01}) {
                        const Chain<double> chain = family.make(size);
                        const auto found = support::held_shapes(chain, share * chain.total_length(),
                                                                slow * chain.total_length(), {.max_half_waves = 3});
                        for (const HeldShape& shape : found.shapes)
                            for (const bool driven : {false, true}) {
                                INFO(name << " " << size << " span " << share << " height " << slow << " "
                                          << shape.half_waves << (driven ? " driven" : " free"));
                                const auto result = revchain::stability(
                                    chain, shape,
                                    driven ? revchain::StabilityFrame::driven : revchain::StabilityFrame::free);
                                const auto truth = by_points(chain, shape, driven);
                                REQUIRE(result.exponents.size() == truth.size());
                                CHECK(result.exponents.size() ==
                                      static_cast<std::size_t>((driven ? 2 : 4) * (size - 2)));
                                double largest = 0, off = 0;
                                for (const auto& s : truth) {
                                    double nearest = 1e300;
                                    for (const auto& t : result.exponents) nearest = std::min(nearest, std::abs(s - t));
                                    largest = std::max(largest, std::abs(s)), off = std::max(off, nearest);
                                }
                                Index grow = 0;  // motions of negative energy, with friction
                                for (const double rate : result.internal_damping) grow += rate > 0;
                                if (result.verdict == revchain::Verdict::spectrally_stable)
                                    CHECK(grow == result.negative_directions);
                                if (result.verdict == revchain::Verdict::minimum) CHECK(grow == 0);
                                ++shapes;
                                unstable += result.verdict == revchain::Verdict::unstable;
                                gyroscopic += result.verdict == revchain::Verdict::spectrally_stable;
                                worst = std::max(worst, off / largest);
                                if (shape.half_waves == 1 && slow == 0)
                                    CHECK(result.verdict == revchain::Verdict::minimum);
                            }
                    }
        }
    CAPTURE(shapes, unstable, gyroscopic, worst);
    CHECK(unstable > 50);
    CHECK(gyroscopic > 20);
    CHECK(worst < 1.5e-14);
}

TEST_CASE("held at both ends: two links can only turn, refusals") {
    const Chain<double> pair = Chain<double>::uniform_plummets(2, 2.0);
    const HeldShape shape = support::held_shapes(pair, 1.0, 0.1).shapes.at(0);
    CHECK(revchain::stability(pair, shape).verdict == revchain::Verdict::minimum);
    CHECK(revchain::stability(pair, shape).exponents.empty());
    CHECK_THROWS_AS(revchain::stability(Chain<double>::uniform_plummets(3), shape), revchain::InvalidArgument);
}
