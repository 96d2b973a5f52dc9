// SPDX-License-Identifier: MPL-2.0
#include "revchain/stability.hpp"

#include <Eigen/Dense>

#include "revchain/modes.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::Stability;
using revchain::StabilityFrame;
using revchain::SteadyShape;
using revchain::Verdict;

namespace {

using State = Eigen::VectorXd;

/// The disturbed chain of plummets in three dimensions, seen from the turning frame, n = 1, g = lambda: positions of the
/// weights, threads as rigid constraints. Accelerations for positions and velocities, by Lagrange's multipliers.
struct Plummets {
    std::vector<double> weight, length;  // lowest first
    double gravity;

    State accelerations(const State& x, const State& v) const {
        const auto n = static_cast<Index>(weight.size());
        Eigen::MatrixXd constraint = Eigen::MatrixXd::Zero(n, 3 * n);
        State force(3 * n), wanted(n), mass(3 * n);
        for (Index m = 0; m < n; ++m) {
            const Eigen::Vector3d r = x.segment<3>(3 * m), u = v.segment<3>(3 * m);
            const double w = weight[static_cast<std::size_t>(m)];
            mass.segment<3>(3 * m).setConstant(w);
            force.segment<3>(3 * m) = w * Eigen::Vector3d(r[0] + 2 * u[1], r[1] - 2 * u[0], -gravity);
            Eigen::Vector3d d = r, e = u;
            if (m + 1 < n) d -= x.segment<3>(3 * m + 3), e -= v.segment<3>(3 * m + 3);
            constraint.block<1, 3>(m, 3 * m) = d.transpose();
            if (m + 1 < n) constraint.block<1, 3>(m, 3 * m + 3) = -d.transpose();
            wanted[m] = -e.squaredNorm();
        }
        const Eigen::MatrixXd side = constraint * mass.cwiseInverse().asDiagonal();
        const State multiplier =
            (side * constraint.transpose()).ldlt().solve(wanted - constraint * force.cwiseQuotient(mass));
        return (force + constraint.transpose() * multiplier).cwiseQuotient(mass);
    }
};

}  // namespace

TEST_CASE("one plummet: sqrt(1 + 3 cos^2 d) free, sin d driven", "[finite]") {
    for (const double cosine : {0.1, 0.5, 0.9, 0.999}) {
        const Chain<double> chain({revchain::plummet(2.0, 3.0)});
        const SteadyShape shape = revchain::steady_shapes(chain, {.conical_height = 3.0 * cosine}).shapes.at(0);
        const Stability free = revchain::stability(chain, shape);
        CHECK(free.verdict == Verdict::minimum);
        CHECK(free.exponents.size() == 2);
        CHECK(free.exponents.back().imag() == Approx(std::sqrt(1 + 3 * cosine * cosine)).epsilon(1e-13));
        const Stability driven = revchain::stability(chain, shape, StabilityFrame::driven);
        CHECK(driven.exponents.back().imag() == Approx(std::sqrt((1 - cosine) * (1 + cosine))).epsilon(1e-13));
        CHECK(driven.verdict == Verdict::minimum);
    }
    // a compound link: the same free equation with its own inertia; driven, section 7 (6), n sin d whatever the link
    const Chain<double> rod({revchain::uniform_rod(1.0, 2.0)});
    const SteadyShape shape = revchain::steady_shapes(rod, {.conical_height = 0.5}).shapes.at(0);
    CHECK(revchain::stability(rod, shape, StabilityFrame::driven).exponents.back().imag() ==
          Approx(std::sin(shape.inclination[0])).epsilon(1e-13));
}

TEST_CASE("two links on the second branch: unstable below 0.463321 (plummets) and 0.500763 (rods)", "[finite]") {
    const auto growth = [](const Chain<double>& chain, double ratio) {
        const double second = revchain::modes(chain, {.count = revchain::all_modes}).conical_height[1];
        for (const SteadyShape& shape : revchain::steady_shapes(chain, {.conical_height = ratio * second}).shapes)
            if (shape.half_waves == 2) return revchain::stability(chain, shape);
        throw std::runtime_error("no such shape");
    };
    const auto plummets = Chain<double>::uniform_plummets(2, 2, 1), rods = Chain<double>::uniform_rods(2, 2, 1);
    CHECK(growth(plummets, 0.46333).verdict == Verdict::spectrally_stable);
    CHECK(growth(plummets, 0.46331).verdict == Verdict::unstable);
    CHECK(growth(rods, 0.50077).verdict == Verdict::spectrally_stable);
    CHECK(growth(rods, 0.50075).verdict == Verdict::unstable);
    CHECK(growth(plummets, 0.9).negative_directions == 2);
}

TEST_CASE("branch 1 is a minimum; exponents come in fours", "[finite]") {
    support::Random random(95);
    for (int i = 0; i < 40; ++i) {
        const Index n = 1 + i % 6;
        const auto chain = support::chain_of(n, [&](Index) {
            const double weight = random.log_between(0.1, 10.0), length = random.log_between(0.1, 10.0);
            return i % 2 == 0 ? revchain::uniform_rod<double>(weight, length)
                              : revchain::plummet<double>(weight, length);
        });
        const double first = revchain::modes(chain, {.count = 1}).conical_height[0];
        for (const SteadyShape& shape :
             revchain::steady_shapes(chain, {.conical_height = first * random.between(0.05, 0.95)}).shapes) {
            for (const auto frame : {StabilityFrame::free, StabilityFrame::driven}) {
                const Stability s = revchain::stability(chain, shape, frame);
                if (shape.half_waves == 1 && frame == StabilityFrame::free) CHECK(s.verdict == Verdict::minimum);
                CHECK(s.exponents.size() ==
                      static_cast<std::size_t>(frame == StabilityFrame::free ? 4 * n - 2 : 2 * n));
                std::complex<double> sum = 0;
                double largest = 0;
                for (const auto& each : s.exponents) sum += each, largest = std::max(largest, std::abs(each));
                CHECK(std::abs(sum) <= 1e-12 * largest * static_cast<double>(n));
                if (s.negative_directions % 2 == 1) CHECK(s.verdict == Verdict::unstable);
            }
        }
    }
}

TEST_CASE("growth as the whole nonlinear chain shows it", "[finite]") {
    // three plummets, every shape: exponents against the linearised accelerations of masses on rigid threads in space
    const Plummets model{{1.0, 2.0, 0.5}, {1.0, 0.7, 1.3}, 0.03};
    const Chain<double> chain({revchain::plummet(1.0, 1.0), revchain::plummet(2.0, 0.7), revchain::plummet(0.5, 1.3)});
    const auto found = revchain::steady_shapes(chain, {.conical_height = 0.03});
    REQUIRE(found.shapes.size() >= 3);
    for (const SteadyShape& shape : found.shapes) {
        const Index n = 3;
        State rest(3 * n);
        for (Index m = 0; m < n; ++m) rest.segment<3>(3 * m) = Eigen::Vector3d(shape.offset[m], 0, shape.height[m]);
        CHECK(model.accelerations(rest, State::Zero(3 * n)).norm() <= 1e-13);
        // positions by angles of each thread in and out of the plane
        const auto place = [&](const State& angle) {
            State x(3 * n);
            Eigen::Vector3d at(0, 0, 0);
            for (Index m = n; m-- > 0;) {
                const double d = shape.inclination[m] + angle[m], out = angle[n + m], a = chain.link(m).length;
                at += a * Eigen::Vector3d(std::sin(d) * std::cos(out), std::sin(out), -std::cos(d) * std::cos(out));
                x.segment<3>(3 * m) = at;
            }
            return x;
        };
        const double step = 1e-5;
        Eigen::MatrixXd frame(3 * n, 2 * n);
        for (Index j = 0; j < 2 * n; ++j) {
            const State e = step * State::Unit(2 * n, j);
            frame.col(j) = (place(e) - place(-e)) / (2 * step);
        }
        const auto angular = [&](const State& force) { return State(frame.colPivHouseholderQr().solve(force)); };
        Eigen::MatrixXd system = Eigen::MatrixXd::Zero(4 * n, 4 * n);
        system.topRightCorner(2 * n, 2 * n).setIdentity();
        for (Index j = 0; j < 2 * n; ++j) {
            const State e = step * State::Unit(2 * n, j), zero = State::Zero(3 * n);
            system.col(j).tail(2 * n) =
                angular(model.accelerations(place(e), zero) - model.accelerations(place(-e), zero)) / (2 * step);
            const State v = step * frame.col(j);
            system.col(2 * n + j).tail(2 * n) =
                angular(model.accelerations(rest, v) - model.accelerations(rest, -v)) / (2 * step);
        }
        const Eigen::VectorXcd truth = system.eigenvalues();
        const Stability s = revchain::stability(chain, shape);
        CAPTURE(shape.half_waves, shape.inclination[0]);
        // each of ours is one of theirs, which has the rotation's double zero besides
        for (const auto& each : s.exponents)
            CHECK((truth.array() - each).abs().minCoeff() <= 1e-6 * truth.cwiseAbs().maxCoeff());
        double grows = 0;
        for (Index j = 0; j < truth.size(); ++j) grows = std::max(grows, truth[j].real());
        if (s.growth_rate > 1e-3) CHECK(std::abs(grows - s.growth_rate) <= 1e-5 * truth.cwiseAbs().maxCoeff());
    }
    CHECK_THROWS_AS(revchain::stability(Chain<double>::uniform_plummets(2, 2, 1), found.shapes[0]),
                    revchain::InvalidArgument);
    CHECK_THROWS_WITH(revchain::stability(Chain<double>::uniform_plummets(3, 3, 1), found.shapes[0]),
                      Catch::Matchers::ContainsSubstring("in it links[1] is as long as"));
}

TEST_CASE("links without weight: those in line are one", "[finite][stability]") {
    const auto exponents = [](const Chain<double>& chain, std::size_t which, revchain::StabilityFrame frame) {
        const auto shapes = revchain::steady_shapes(chain, {.conical_height = 0.13}).shapes;
        REQUIRE(shapes.size() > which);
        return revchain::stability(chain, shapes[which], frame);
    };
    const auto chain = [](std::vector<double> weight, std::vector<double> length) {
        return support::chain_of(static_cast<Index>(weight.size()), [&](Index m) {
            return revchain::plummet(weight[static_cast<std::size_t>(m)], length[static_cast<std::size_t>(m)]);
        });
    };
    const auto two = chain({1, 1}, {2, 1}), upper = chain({1, 1}, {1, 2});
    for (const auto frame : {revchain::StabilityFrame::free, revchain::StabilityFrame::driven})
        for (const std::size_t which : {0U, 1U}) {
            const auto check = [&](const Chain<double>& split, const Chain<double>& whole) {
                const auto x = exponents(split, which, frame), y = exponents(whole, which, frame);
                REQUIRE(x.exponents.size() == y.exponents.size());
                CHECK(x.verdict == y.verdict);
                CHECK(x.negative_directions == y.negative_directions);
                for (std::size_t i = 0; i < x.exponents.size(); ++i)
                    CHECK(std::abs(x.exponents[i] - y.exponents[i]) < 1e-12);
            };
            check(chain({1, 0, 1}, {1, 1, 1}), two);
            check(chain({1, 0, 0, 1}, {1, 0.5, 0.5, 1}), two);
            check(chain({1, 1, 0}, {1, 1, 1}), upper);
        }
}
