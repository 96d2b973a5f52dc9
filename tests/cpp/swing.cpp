// SPDX-License-Identifier: MPL-2.0
#include "revchain/swing.hpp"

#include "revchain/modes.hpp"

#include <quadmath.h>

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::Vector;
using support::Quad;

namespace {

using Quads = std::vector<Quad>;

/// The truth: y'' = -g M^-1 K y by the power series of its solution in quadruple precision; no eigenvalues.
class Swing {
   public:
    Swing(const Chain<double>& chain, Quad gravity) : n_(static_cast<std::size_t>(chain.size())) {
        for (auto* v : {&k0_, &k1_, &m0_, &m1_}) v->assign(n_, 0);
        Quad below = 0;
        for (std::size_t m = 0; m < n_; ++m) {
            const auto link = chain.link(static_cast<Index>(m));
            const Quad W = link.weight, a = link.length, p = Quad(link.centroid) / a, q = (a - Quad(link.centroid)) / a;
            const Quad turn = support::quad(link.gyration_ratio), k = gravity * (W * p + below) / a;
            below += W;
            k0_[m] += k, m0_[m] += W * (p * p + turn);
            if (m + 1 == n_) break;
            k1_[m] = -k, m1_[m] = W * (p * q - turn);
            k0_[m + 1] += k, m0_[m + 1] += W * (q * q + turn);
        }
    }
    /// Offsets and velocities at a time so short that the series' terms stay below 1e12.
    std::pair<Quads, Quads> at(const Vector<double>& offsets, const Vector<double>& velocities, Quad t) const {
        Quads y(offsets.begin(), offsets.end()), v(velocities.begin(), velocities.end());
        y.resize(n_), v.resize(n_);
        Quads a = y, b = v, offset = y, velocity = v;  // terms of the series
        for (std::size_t m = 0; m < n_; ++m) offset[m] += t * b[m];
        for (int i = 1; i < 400; ++i) {
            a = accelerated(a), b = accelerated(b);
            const Quad j = 2 * i;
            Quad size = 0;
            for (std::size_t m = 0; m < n_; ++m) {
                a[m] *= t * t / (j * (j - 1)), b[m] *= t * t / (j * (j - 1));  // of t^j / j!
                offset[m] += a[m] + t * b[m] / (j + 1);
                if (t != 0) velocity[m] += j * a[m] / t + b[m];
                size = fmaxq(size, fmaxq(fabsq(a[m]), fabsq(b[m])));
            }
            if (size < Quad(1e-40)) break;
        }
        return {offset, velocity};
    }
    Quad energy(const Quads& y, const Quads& v) const {
        Quad sum = 0;
        for (std::size_t m = 0; m < n_; ++m) {
            sum += k0_[m] * y[m] * y[m] + m0_[m] * v[m] * v[m];
            if (m + 1 < n_) sum += 2 * (k1_[m] * y[m] * y[m + 1] + m1_[m] * v[m] * v[m + 1]);
        }
        return sum / 2;
    }

   private:
    Quads accelerated(const Quads& y) const {  // -M^-1 K y
        Quads f(n_), d = m0_;
        for (std::size_t m = 0; m < n_; ++m) {
            f[m] = -k0_[m] * y[m];
            if (m > 0) f[m] -= k1_[m - 1] * y[m - 1];
            if (m + 1 < n_) f[m] -= k1_[m] * y[m + 1];
        }
        for (std::size_t m = 1; m < n_; ++m) {
            const Quad factor = m1_[m - 1] / d[m - 1];
            d[m] -= factor * m1_[m - 1], f[m] -= factor * f[m - 1];
        }
        for (std::size_t m = n_; m-- > 0;) f[m] = (f[m] - (m + 1 < n_ ? m1_[m] * f[m + 1] : Quad(0))) / d[m];
        return f;
    }
    std::size_t n_;
    Quads k0_, k1_, m0_, m1_;
};

Vector<double> random_start(support::Random& random, Index size, double scale) {
    Vector<double> result = Vector<double>::Zero(size + 1);
    for (Index m = 0; m < size; ++m) result[m] = scale * random.between(-1, 1);
    return result;
}

}  // namespace

TEST_CASE("small oscillations: the power series in quadruple precision", "[linear]") {
    support::Random random(4);
    double worst = 0, largest_bound = 0, worst_speed = 0;
    for (const std::size_t kind : {0U, 1U, 2U, 3U, 7U, 8U})
        for (const Index n : {1, 2, 3, 6, 12}) {
            const auto chain = support::families()[kind].make(n);
            const double gravity = 2.5;
            const auto from = random_start(random, n, 0.1), speed = random_start(random, n, 0.3);
            const double fastest = std::sqrt(
                gravity / revchain::modes(chain, {.first = n, .count = revchain::all_modes}).conical_height[0]);
            const std::vector<double> times{0, 1 / fastest, -8 / fastest,
                                            20 / fastest};  // the series' terms reach e^20
            const auto found =
                revchain::swing(chain, {.offset = from, .velocity = speed, .time = times, .gravity = gravity});
            const Swing truth(chain, gravity);
            const double size = found.cosine.cwiseAbs().sum() + found.sine.cwiseAbs().sum();
            CHECK(!found.projected);
            Quad energy = 0;
            for (Index k = 0; k < n; ++k) energy += found.energy[k];
            for (Index i = 0; i < 4; ++i) {
                const auto [y, v] = truth.at(from, speed, times[static_cast<std::size_t>(i)]);
                CAPTURE(kind, n, i);
                for (Index m = 0; m < n; ++m) {
                    const double bound = found.error_bound[i] + found.truncation_error[m];
                    const double error =
                        static_cast<double>(fabsq(Quad(found.offset(i, m)) - y[static_cast<std::size_t>(m)]));
                    CHECK(error <= bound);
                    worst = std::max(worst, error / size);
                    largest_bound = std::max(largest_bound, bound / size);
                    const double off =
                        static_cast<double>(fabsq(Quad(found.velocity(i, m)) - v[static_cast<std::size_t>(m)]));
                    worst_speed = std::max(worst_speed, off / size / found.angular_frequency[n - 1]);
                }
                CHECK(found.offset(i, n) == 0);
                CHECK(static_cast<double>(fabsq(truth.energy(y, v) / Quad(gravity) / energy - 1)) <= 1e-15);
            }
        }
    CHECK(worst <= 2e-16);  // measured 1.8e-16
    CHECK(worst_speed <= 2e-16);
    CHECK(largest_bound <= 1.7e-15);
}

TEST_CASE("small oscillations: two plummets of unlike weights beat", "[linear]") {
    // lambda = 1 +- mu, mu = sqrt(W1 / (W1 + W2)), of threads of length 1; after 1e9 swings, too
    const double light = 1e-4;
    const Chain<double> chain({revchain::plummet(light, 1.0), revchain::plummet(1.0, 1.0)});
    const Vector<double> from = Eigen::Vector3d(0.01, 0.01, 0), still = Vector<double>::Zero(3);
    const std::vector<double> times{0.0, 12.5, 1e4, 6.3e9, 1e12};
    const auto found = revchain::swing(chain, {.offset = from, .velocity = still, .time = times, .gravity = 1});
    const Quad mu = sqrtq(Quad(light) / (Quad(light) + 1));
    const Quad slow = sqrtq(1 / (1 + mu)), fast = sqrtq(1 / (1 - mu));
    for (std::size_t i = 0; i < times.size(); ++i) {
        const Quad t = times[i];
        const auto row = static_cast<Index>(i);
        // y_1 = A cos(slow t) + B cos(fast t), in each mode y_0 = lambda y_1 / (lambda - 1)
        const Quad up = (1 + mu) / mu, down = -(1 - mu) / mu;
        const Quad A = (Quad(from[0]) - down * Quad(from[1])) / (up - down), B = Quad(from[1]) - A;
        const Quad upper = A * cosq(slow * t) + B * cosq(fast * t);
        const Quad lower = up * A * cosq(slow * t) + down * B * cosq(fast * t);
        CAPTURE(times[i], found.error_bound[row]);
        CHECK(static_cast<double>(fabsq(Quad(found.offset(row, 0)) - lower)) <=
              found.error_bound[row] + found.truncation_error[0]);
        CHECK(static_cast<double>(fabsq(Quad(found.offset(row, 1)) - upper)) <=
              found.error_bound[row] + found.truncation_error[1]);
        CHECK(found.error_bound[row] <= (times[i] < 1e10 ? 1.7e-15 : 1e-13));
    }
}

TEST_CASE("small oscillations: what modes left out may do is within the bound", "[linear]") {
    support::Random random(7);
    double sharpest = 0;
    for (const std::size_t kind : {0U, 3U, 6U, 9U}) {
        const auto chain = support::families()[kind].make(30);
        const auto from = random_start(random, 30, 0.1), speed = random_start(random, 30, 0.1);
        std::vector<double> times;
        for (int i = 0; i < 60; ++i) times.push_back(random.between(0, 10));
        const auto all = revchain::swing(chain, {.offset = from, .velocity = speed, .time = times});
        double before = HUGE_VAL;
        for (const Index count : {0, 1, 3, 10, 18}) {
            const auto some =
                revchain::swing(chain, {.offset = from, .velocity = speed, .time = times, .count = count});
            CAPTURE(kind, count);
            CHECK(some.energy_left_out <= before);
            before = some.energy_left_out;
            double kept = 0;
            for (Index k = 0; k < count; ++k) kept += some.energy[k];
            double whole = 0;
            for (const double e : all.energy) whole += e;
            CHECK(some.energy_left_out == Approx(whole - kept).epsilon(1e-9));
            for (Index i = 0; i < 60; ++i)
                for (Index m = 0; m < 30; ++m) {
                    const double off = std::abs(some.offset(i, m) - all.offset(i, m));
                    const double bound =
                        some.truncation_error[m] + all.truncation_error[m] + some.error_bound[i] + all.error_bound[i];
                    CHECK(off <= bound);
                    sharpest = std::max(sharpest, off / bound);
                }
        }
    }
    CHECK(sharpest > 0.3);  // measured 0.59: the bound is no empty one
}

TEST_CASE("small oscillations: pins without inertia snap into line", "[linear]") {
    // weight 2 at the end of two threads of length 1: a pendulum of length 2
    const Chain<double> chain({revchain::plummet(2.0, 1.0), revchain::plummet(0.0, 1.0)});
    const Vector<double> from = Eigen::Vector3d(0.02, 0.5, 0), speed = Eigen::Vector3d(0.03, -4, 0);
    const double n = std::sqrt(9.80665 / 2);
    const auto found = revchain::swing(chain, {.offset = from, .velocity = speed, .time = {0.0, 0.4}});
    CHECK(found.projected);
    CHECK(found.start[0] == 0.02);
    CHECK(found.start[1] == 0.01);
    CHECK(found.offset(0, 1) == Approx(0.01).epsilon(1e-15));
    CHECK(found.velocity(0, 1) == Approx(0.015).epsilon(1e-15));
    CHECK(found.offset(1, 0) == Approx(0.02 * std::cos(n * 0.4) + 0.03 / n * std::sin(n * 0.4)).epsilon(1e-14));
    CHECK(found.energy.size() == 1);
    // potential W y^2 / (2 a) and kinetic W v^2 / (2 g)
    CHECK(found.energy[0] == Approx(2 * 0.02 * 0.02 / 4 + 2 * 0.03 * 0.03 / 2 / 9.80665).epsilon(1e-14));
    CHECK(found.truncation_error.maxCoeff() <= 1e-20);
    const Vector<double> straight = Eigen::Vector3d(0.02, 0.01, 0);
    CHECK(!revchain::swing(chain, {.offset = straight, .velocity = Vector<double>::Zero(3), .time = {0.0}}).projected);
    for (const Index size : {3, 10, 40}) {
        const auto mixed = support::families()[9].make(size);
        support::Random random(2);
        const auto start = random_start(random, size, 1);
        const auto swings =
            revchain::swing(mixed, {.offset = start, .velocity = Vector<double>::Zero(size), .time = {0.0}});
        CHECK(swings.projected);
        CHECK(swings.truncation_error.maxCoeff() <= 1e-19);
        for (Index m = 0; m < size; ++m) {
            CHECK(std::abs(swings.offset(0, m) - swings.start[m]) <=
                  swings.error_bound[0] + swings.truncation_error[m]);
            if (mixed.link(m).weight > 0) CHECK(std::abs(swings.start[m] - start[m]) <= 1e-15);
        }
    }
}

TEST_CASE("small oscillations: the start comes back, whatever the chain", "[linear]") {
    for (const auto& family : support::families())
        for (const Index n : {1, 5, 40, 200}) {
            const auto chain = family.make(n);
            support::Random random(static_cast<std::uint64_t>(n));
            const auto from = random_start(random, n, 1);
            const auto found =
                revchain::swing(chain, {.offset = from, .velocity = Vector<double>::Zero(n), .time = {0.0, 1e3}});
            CAPTURE(family.name, n, found.error_bound[0], found.error_bound[1], found.truncation_error.maxCoeff());
            double worst = 0;
            for (Index m = 0; m < n; ++m) worst = std::max(worst, std::abs(found.offset(0, m) - found.start[m]));
            CHECK(worst <= found.error_bound[0] + found.truncation_error.maxCoeff());
            CHECK(worst <= 2.5e-16 * (1 + found.cosine.cwiseAbs().sum()));
            CHECK(found.truncation_error.maxCoeff() <= 2e-22);  // measured 1.2e-22: all modes are kept
        }
}

TEST_CASE("small oscillations: wrong calls", "[linear]") {
    const auto chain = Chain<double>::uniform_rods(3);
    const Vector<double> good = Vector<double>::Zero(3), moved = Eigen::Vector4d(0, 0, 0, 1);
    const Vector<double> wrong = Eigen::Vector3d(0, std::nan(""), 0);
    const auto call = [&](const Vector<double>& y, const Vector<double>& v, double t,
                          revchain::SwingOptions options = {}) {
        options.offset = y, options.velocity = v, options.time = {t};
        return revchain::swing(chain, options);
    };
    CHECK_NOTHROW(call(good, good, 1));
    CHECK_THROWS_AS(call(moved, good, 1), revchain::InvalidArgument);
    CHECK_THROWS_AS(call(good, wrong, 1), revchain::InvalidArgument);
    CHECK_THROWS_AS(call(good, Vector<double>::Zero(2), 1), revchain::InvalidArgument);
    CHECK_THROWS_AS(call(good, good, HUGE_VAL), revchain::InvalidArgument);
    CHECK_THROWS_AS(call(good, good, 1, {.count = 4}), revchain::InvalidArgument);
    CHECK_THROWS_AS(call(good, good, 1, {.count = -1}), revchain::InvalidArgument);
    CHECK_THROWS_AS(call(good, good, 1, {.gravity = 0}), revchain::InvalidArgument);
    const revchain::Rig carried(chain, {.support = revchain::carried_round(0.1)});
    CHECK_THROWS_AS(revchain::swing(carried, {.time = {1.0}}), revchain::InvalidArgument);
    CHECK(revchain::swing(revchain::Rig(chain, {}), {.time = {1.0}}).offset.isZero());
    CHECK(revchain::swing(chain, {.time = {1.0}}).offset.isZero());  // nothing given: at rest on the axis
}
