// SPDX-License-Identifier: MPL-2.0
#include <quadmath.h>

#include "revchain/rig_modes.hpp"
#include "revchain/swing.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/tier.hpp"
#include "support/truth.hpp"

using Catch::Matchers::ContainsSubstring;
using revchain::Chain;
using revchain::Index;
using revchain::Rig;
using revchain::Vector;
using support::Quad;

namespace {

using Complex = std::complex<double>;
using Quads = std::vector<Quad>;
using Dense = std::vector<Quads>;

/// The truth: M u'' - i g G u' + g K u = 0 in Taylor's series of short steps in quadruple precision, from matrices that
/// are added up body by body.
class Motion {
   public:
    Motion(const Rig& rig, Quad gravity)
        : n_(static_cast<std::size_t>(rig.size()) + (rig.support().is_firm() ? 0 : 1)), gravity_(gravity) {
        K_ = G_ = M_ = Dense(n_, Quads(n_, 0));
        Quad below = 0;
        for (Index m = 0; m < rig.size(); ++m) {
            const auto link = rig.chain().link(m);
            const auto fluid = rig.displaced(m);
            const Quad W = link.weight, a = link.length, h = link.centroid, sign = rig.stands(m) ? -1 : 1;
            const auto i = static_cast<std::size_t>(m);
            const auto lean = [&](Dense& to, Quad x) { add(to, i, x / (a * a), -x / (a * a), x / (a * a)); };
            const auto body = [&](Quad moves, Quad depth, Quad turn) {
                const Quad p = depth / a, q = 1 - p;
                add(M_, i, moves * p * p, moves * p * q, moves * q * q);
                lean(M_, moves * turn * a * a);
            };
            lean(K_, sign * (W * h - Quad(fluid.weight) * Quad(fluid.centroid) + a * below));
            lean(G_, sign * support::quad(rig.flywheel(m).momentum));
            body(W, h, support::quad(link.gyration_ratio));
            body(fluid.added_weight, fluid.centroid, support::quad(fluid.gyration_ratio));
            below += W - Quad(fluid.weight);
        }
        if (!rig.support().is_firm())
            K_[n_ - 1][n_ - 1] += support::quad(rig.support().stiffness),
                M_[n_ - 1][n_ - 1] += rig.support().carriage_weight;
        inverse_ = inverse(M_);
        Quad size = 0;
        for (const Quads& row : product(inverse_, K_))
            for (const Quad& x : row) size = fmaxq(size, fabsq(x) * gravity);
        for (const Quads& row : product(inverse_, G_))
            for (const Quad& x : row) size = fmaxq(size, x * x * gravity * gravity);
        step_ = 1 / sqrtq(size);
    }
    struct State {
        Quads x, y, u, v;  ///< offsets and velocities along x and y
    };
    State after(State s, double time) const {
        const int steps = static_cast<int>(ceilq(fabsq(Quad(time)) / step_));
        for (int i = 0; i < steps; ++i) s = stepped(s, Quad(time) / steps);
        return s;
    }
    Quad energy(const State& s) const {
        Quad sum = 0;
        for (std::size_t i = 0; i < n_; ++i)
            for (std::size_t j = 0; j < n_; ++j)
                sum += K_[i][j] * (s.x[i] * s.x[j] + s.y[i] * s.y[j]) +
                       M_[i][j] * (s.u[i] * s.u[j] + s.v[i] * s.v[j]) / gravity_;
        return sum / 2;
    }
    std::size_t size() const { return n_; }

   private:
    void add(Dense& to, std::size_t m, Quad lower, Quad cross, Quad upper) const {
        to[m][m] += lower;
        if (m + 1 < n_) to[m][m + 1] += cross, to[m + 1][m] += cross, to[m + 1][m + 1] += upper;
    }
    static Dense product(const Dense& A, const Dense& B) {
        Dense C(A.size(), Quads(A.size(), 0));
        for (std::size_t i = 0; i < A.size(); ++i)
            for (std::size_t j = 0; j < A.size(); ++j)
                for (std::size_t k = 0; k < A.size(); ++k) C[i][j] += A[i][k] * B[k][j];
        return C;
    }
    static Dense inverse(Dense A) {  // positive definite
        const std::size_t n = A.size();
        Dense B(n, Quads(n, 0));
        for (std::size_t i = 0; i < n; ++i) B[i][i] = 1;
        for (std::size_t i = 0; i < n; ++i) {
            for (Quad& x : B[i]) x /= A[i][i];
            for (std::size_t j = n; j-- > 0;) A[i][j] /= A[i][i];
            for (std::size_t r = 0; r < n; ++r) {
                if (r == i) continue;
                const Quad f = A[r][i];
                for (std::size_t j = 0; j < n; ++j) A[r][j] -= f * A[i][j], B[r][j] -= f * B[i][j];
            }
        }
        return B;
    }
    Quads times(const Dense& A, const Quads& x) const {
        Quads y(n_, 0);
        for (std::size_t i = 0; i < n_; ++i)
            for (std::size_t j = 0; j < n_; ++j) y[i] += A[i][j] * x[j];
        return y;
    }
    /// u'' = g M^-1 (i G u' - K u): along x -G y' - K x, along y G x' - K y.
    State stepped(const State& s, Quad t) const {
        State sum = s, term = s;  // of t^k/k!, offsets and velocities
        for (int k = 1; k < 60; ++k) {
            const Quads gy = times(G_, term.v), gx = times(G_, term.u), kx = times(K_, term.x), ky = times(K_, term.y);
            Quads fx(n_), fy(n_);
            for (std::size_t m = 0; m < n_; ++m)
                fx[m] = gravity_ * (-gy[m] - kx[m]), fy[m] = gravity_ * (gx[m] - ky[m]);
            fx = times(inverse_, fx), fy = times(inverse_, fy);
            for (std::size_t m = 0; m < n_; ++m) {
                term.x[m] = term.u[m] * t / k, term.y[m] = term.v[m] * t / k;
                term.u[m] = fx[m] * t / k, term.v[m] = fy[m] * t / k;
                sum.x[m] += term.x[m], sum.y[m] += term.y[m], sum.u[m] += term.u[m], sum.v[m] += term.v[m];
            }
        }
        return sum;
    }
    std::size_t n_;
    Quad gravity_, step_;
    Dense K_, G_, M_, inverse_;
};

/// Rigs at random: 1 spring, 2 wheels, 4 still fluid.
Rig random_rig(support::Random& random, Index size, int kind) {
    std::vector<revchain::Link<double>> links;
    for (Index m = 0; m < size; ++m) {
        const double a = random.between(0.3, 1.5);
        links.push_back(revchain::compound_pendulum<double>({.weight = random.between(0.3, 3),
                                                             .length = a,
                                                             .centroid = a * random.between(0.2, 1),
                                                             .radius_of_gyration = a * random.between(0.1, 0.5)}));
    }
    const Chain<double> chain(links);
    revchain::Rigging with;
    if (kind & 1) with.support = revchain::horizontal_spring(random.between(2, 20), random.between(0.1, 2));
    for (Index m = 0; m < size; ++m) {
        if (kind & 2) with.flywheels.push_back({random.between(-1, 1), random.between(0, 0.1)});
        if (kind & 4)
            with.displaced.push_back(revchain::displaced_by(
                chain.link(m), chain.link(m).weight * random.between(0, 0.8), random.between(0, 1)));
    }
    return {chain, with};
}

Vector<Complex> random_start(support::Random& random, Index size, bool yields, bool plane) {
    Vector<Complex> result = Vector<Complex>::Zero(size + 1);
    for (Index m = 0; m < size + yields; ++m)
        result[m] = {random.between(-0.1, 0.1), plane ? random.between(-0.1, 0.1) : 0.0};
    return result;
}

Motion::State state(const Vector<Complex>& offset, const Vector<Complex>& velocity, std::size_t size) {
    Motion::State s{Quads(size), Quads(size), Quads(size), Quads(size)};
    for (std::size_t m = 0; m < size; ++m) {
        const Complex y = offset[static_cast<Index>(m)], v = velocity[static_cast<Index>(m)];
        s.x[m] = y.real(), s.y[m] = y.imag(), s.u[m] = v.real(), s.v[m] = v.imag();
    }
    return s;
}

const std::vector<double> times{0, 0.7, -3, 20};

}  // namespace

TEST_CASE("swing of rigs without momentum: Taylor's series in quadruple precision", "[linear][rigs]") {
    support::Random random(11);
    double worst = 0, largest_bound = 0;
    for (const int kind : {0, 1, 4, 5})
        for (const Index n : {1, 2, 3, 5, 8}) {
            const Rig rig = random_rig(random, n, kind);
            const auto from = random_start(random, n, kind & 1, false),
                       speed = random_start(random, n, kind & 1, false);
            const auto found = revchain::swing(rig, {.offset = from.real(), .velocity = speed.real(), .time = times});
            const Motion truth(rig, Quad(9.80665));
            const double size = found.cosine.cwiseAbs().sum() + found.sine.cwiseAbs().sum();
            CHECK(!found.projected);
            for (Index i = 0; i < 4; ++i) {
                const auto s = truth.after(state(from, speed, truth.size()), times[static_cast<std::size_t>(i)]);
                CAPTURE(kind, n, i);
                CHECK(static_cast<double>(truth.energy(s)) == Approx(found.energy.sum()).epsilon(1e-14));
                for (std::size_t m = 0; m < truth.size(); ++m) {
                    const auto pin = static_cast<Index>(m);
                    const double error = static_cast<double>(fabsq(Quad(found.offset(i, pin)) - s.x[m]));
                    const double bound = found.error_bound[i] + found.truncation_error[pin];
                    CHECK(error <= bound);
                    worst = std::max(worst, error / size), largest_bound = std::max(largest_bound, bound / size);
                }
            }
        }
    CHECK(worst <= 2e-16);  // measured 1.6e-16
    CHECK(largest_bound <= 2e-15);
}

TEST_CASE("swing of rigs with momentum: Taylor's series in quadruple precision", "[linear][rigs]") {
    support::Random random(12);
    double worst = 0, largest_bound = 0, worst_speed = 0;
    for (const int kind : {2, 3, 6, 7})
        for (const Index n : {1, 2, 3, 5, 8}) {
            if (n > support::by_tier(3, 8)) continue;
            const Rig rig = random_rig(random, n, kind);
            const auto from = random_start(random, n, kind & 1, true), speed = random_start(random, n, kind & 1, true);
            const auto found = revchain::whirl_swing(rig, {.offset = from, .velocity = speed, .time = times});
            const Motion truth(rig, Quad(9.80665));
            const double size = found.amplitude.cwiseAbs().sum(), fastest = found.angular_speed.cwiseAbs().maxCoeff();
            CHECK(found.angular_speed.size() == 2 * static_cast<Index>(truth.size()));
            for (Index i = 0; i < 4; ++i) {
                const auto s = truth.after(state(from, speed, truth.size()), times[static_cast<std::size_t>(i)]);
                CAPTURE(kind, n, i);
                CHECK(static_cast<double>(truth.energy(s)) == Approx(found.energy.sum()).epsilon(1e-14));
                for (std::size_t m = 0; m < truth.size(); ++m) {
                    const Complex y = found.offset(i, static_cast<Index>(m)),
                                  v = found.velocity(i, static_cast<Index>(m));
                    const double error = static_cast<double>(hypotq(Quad(y.real()) - s.x[m], Quad(y.imag()) - s.y[m]));
                    const double bound = found.error_bound[i] + found.truncation_error[static_cast<Index>(m)];
                    CHECK(error <= bound);
                    worst = std::max(worst, error / size), largest_bound = std::max(largest_bound, bound / size);
                    const double off = static_cast<double>(hypotq(Quad(v.real()) - s.u[m], Quad(v.imag()) - s.v[m]));
                    worst_speed = std::max(worst_speed, off / size / fastest);
                }
            }
        }
    CHECK(worst <= 2e-16);  // measured 1.3e-16
    CHECK(worst_speed <= 1e-16);
    CHECK(largest_bound <= 3e-15);
}

TEST_CASE("swing of rigs: fewer whirls than all, and what is left out", "[linear][rigs]") {
    support::Random random(13);
    for (const int kind : {1, 2, 7}) {
        const Rig rig = random_rig(random, 4, kind);
        const auto from = random_start(random, 4, kind & 1, true), speed = random_start(random, 4, kind & 1, true);
        if (kind == 1) {
            const revchain::SwingOptions all{.offset = from.real(), .velocity = speed.real(), .time = times};
            revchain::SwingOptions two = all;
            two.count = 2;
            const auto whole = revchain::swing(rig, all), part = revchain::swing(rig, two);
            CHECK(part.energy.sum() + part.energy_left_out == Approx(whole.energy.sum()).epsilon(1e-9));
            for (Index m = 0; m < 5; ++m) {
                const double off = (whole.offset.col(m) - part.offset.col(m)).cwiseAbs().maxCoeff();
                CHECK(off <= part.truncation_error[m] + part.error_bound.maxCoeff() + whole.error_bound.maxCoeff());
            }
            continue;
        }
        const revchain::WhirlSwingOptions all{.offset = from, .velocity = speed, .time = times};
        revchain::WhirlSwingOptions few = all;
        few.count = 3;
        const auto whole = revchain::whirl_swing(rig, all), part = revchain::whirl_swing(rig, few);
        CHECK(part.angular_speed == whole.angular_speed.head(3));
        CHECK(part.energy.sum() + part.energy_left_out == Approx(whole.energy.sum()).epsilon(1e-9));
        for (Index m = 0; m < 5; ++m) {
            const double off = (whole.offset.col(m) - part.offset.col(m)).cwiseAbs().maxCoeff();
            CHECK(off <= part.truncation_error[m] + part.error_bound.maxCoeff() + whole.error_bound.maxCoeff());
        }
    }
}

TEST_CASE("swing of rigs: a spring without carriage is a longer thread", "[linear][rigs]") {
    const double stiffness = 8;
    const Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::plummet(3.0, 0.75)}),
        longer({revchain::plummet(1.0, 0.5), revchain::plummet(3.0, 0.75 + 4 / stiffness)});
    const Rig rig(chain, {.support = revchain::horizontal_spring(stiffness)});
    const Vector<double> from = Eigen::Vector3d(0.02, 0.01, 0.5), two = from.head(2);
    const auto found = revchain::swing(rig, {.offset = from, .time = {0.0, 3.0}});
    const auto same = revchain::swing(longer, {.offset = two, .time = {0.0, 3.0}});
    CHECK(found.projected);  // the support goes at once to where the chain pulls it
    CHECK((found.angular_frequency - same.angular_frequency).cwiseAbs().maxCoeff() <= 1e-15);
    CHECK((found.offset.leftCols(2) - same.offset.leftCols(2)).cwiseAbs().maxCoeff() <= 1e-17);
    CHECK(found.start[2] == Approx(0.01 * (4 / stiffness) / (0.75 + 4 / stiffness)).epsilon(1e-15));
    CHECK(found.truncation_error.maxCoeff() <= 1e-17);
}

TEST_CASE("swing of rigs: a sleeping top, its momentum holding it up; after 1e8 turns, too", "[linear][rigs]") {
    // A n^2 - H n - W a = 0 with A = W a^2/g; standing: A n^2 + H n + W a = 0 (u has the pin above the support's)
    const double W = 2, a = 0.5, g = 9.80665, H = -2.0;
    const Chain<double> chain({revchain::plummet(W, a)});
    const Rig top(chain, {.posture = {revchain::Posture::stands}, .flywheels = {{H, 0.3}}});
    Vector<Complex> from(1);
    from << Complex(0.01, 0.005);
    const std::vector<double> when{0.0, 1.0, 3e7};
    const auto found = revchain::whirl_swing(top, {.offset = from, .time = when});
    const Quad A = Quad(W) * a * a / g, root = sqrtq(Quad(H) * H - 4 * A * W * a);
    const Quad slow = (-Quad(H) - root) / (2 * A), fast = (-Quad(H) + root) / (2 * A);
    CHECK(found.angular_speed[0] == Approx(static_cast<double>(slow)).epsilon(1e-15));
    CHECK(found.angular_speed[1] == Approx(static_cast<double>(fast)).epsilon(1e-15));
    CHECK(found.energy[0] < 0);
    CHECK(std::isinf(found.error_bound[0]));
    for (std::size_t i = 0; i < when.size(); ++i) {  // c1 + c2 = u, n1 c1 + n2 c2 = 0
        const Quad c1 = fast / (fast - slow), c2 = -slow / (fast - slow), t = when[i];
        const Quad x = c1 * cosq(slow * t) + c2 * cosq(fast * t), y = c1 * sinq(slow * t) + c2 * sinq(fast * t);
        const Complex want = from[0] * Complex(static_cast<double>(x), static_cast<double>(y));
        CHECK(std::abs(found.offset(static_cast<Index>(i), 0) - want) <= 1e-15);
    }
    const Rig weak(chain, {.posture = {revchain::Posture::stands}, .flywheels = {{0.1, 0}}});
    CHECK_THROWS_WITH(revchain::whirl_swing(weak, {.offset = from, .time = when}),
                      ContainsSubstring("growth rate of small offsets"));
}

TEST_CASE("swing of rigs: what it refuses", "[linear][rigs]") {
    const Chain<double> chain({revchain::plummet(1.0, 0.5), revchain::uniform_rod(2.0, 0.3)});
    Vector<double> from(2);
    from << 0.01, 0.02;
    const auto refused = [&](const revchain::Rigging& with, const char* why) {
        CHECK_THROWS_WITH(revchain::swing(Rig(chain, with), {.offset = from, .time = {1.0}}), ContainsSubstring(why));
    };
    refused({.support = revchain::carried_round(0.1)}, "use response");
    refused({.fluid = revchain::Fluid::turning, .displaced = {{0.1}, {0.1}}}, "swings in a fluid at rest");
    refused({.posture = {revchain::Posture::hangs, revchain::Posture::stands}}, "growth rate of small offsets");
    refused({.flywheels = {{0.1, 0}, {}}}, "use whirl_swing");
    refused({.displaced = {revchain::displaced_by(chain.link(0), 2.0), {}}}, "growth rate of small offsets");
    CHECK_THROWS_WITH(revchain::whirl_swing(Rig(chain, {}), {.time = {1.0}}), ContainsSubstring("use swing"));
    const Vector<double> moved = Eigen::Vector3d(0.01, 0.02, 0.1);
    CHECK_THROWS_WITH(revchain::swing(Rig(chain, {}), {.offset = moved, .time = {1.0}}),
                      ContainsSubstring("offset of the support must be 0"));
    // wheels that a motor turns with their links, which do not turn in a swing
    const auto plain = revchain::swing(Rig(chain, {}), {.offset = from, .time = {1.0}});
    const auto driven =
        revchain::swing(Rig(chain, {.flywheels = {{0, 0.1}, {0, 0.2}}}), {.offset = from, .time = {1.0}});
    CHECK((plain.offset - driven.offset).cwiseAbs().maxCoeff() <= 1e-17);
}
