// SPDX-License-Identifier: MPL-2.0
// Motion in time under a moving support against the exponential of the first-order form in quadruple precision, with the
// support's offset as one more coordinate; and closed forms.
#include "revchain/transient.hpp"

#include "revchain/swing.hpp"
#include "support/catch.hpp"
#include "support/damped_truth.hpp"

using namespace revchain;
using support::Quad;
using support::quad;
using support::random_rig;
using support::Z;
using Given = SupportMotion::Given;

namespace {

using Square = std::vector<std::vector<Z>>;

Square product(const Square& x, const Square& y) {
    const std::size_t n = x.size();
    Square result(n, std::vector<Z>(n));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < n; ++k) {
            if (x[i][k].re == 0 && x[i][k].im == 0) continue;
            for (std::size_t j = 0; j < n; ++j) result[i][j] = result[i][j] + x[i][k] * y[k][j];
        }
    return result;
}

/// exp(A): Taylor's series of A over a power of 2, squared as often.
Square exponential(Square A) {
    const std::size_t n = A.size();
    Quad norm = 0;
    for (const auto& row : A) {
        Quad sum = 0;
        for (const Z& z : row) sum += size_of(z);
        norm = std::max(norm, sum);
    }
    int halvings = 0;
    for (; norm > 0.25; norm /= 2) ++halvings;
    const Z share{Quad(1) / powq(2, halvings), 0};
    for (auto& row : A)
        for (Z& z : row) z = z * share;
    Square sum(n, std::vector<Z>(n)), term = sum;
    for (std::size_t i = 0; i < n; ++i) sum[i][i] = term[i][i] = Z{1, 0};
    for (int k = 1; k < 22; ++k) {
        term = product(term, A);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) {
                term[i][j] = term[i][j] / Z{Quad(k), 0};
                sum[i][j] = sum[i][j] + term[i][j];
            }
    }
    for (int k = 0; k < halvings; ++k) sum = product(sum, sum);
    return sum;
}

/// The state (coordinates, rates, and of a prescribed support offset, velocity, acceleration and its slope, or force and its
/// slope) of a rig, moved by exponentials of one matrix.
class Integrated {
   public:
    Integrated(const Rig& rig, double gravity, bool by_force)
        : truth_(rig, gravity, true), rig_(rig), by_force_(by_force) {
        const Support& support = rig.support();
        itself_ = !by_force && (support.is_firm() || support.is_free());
        const std::size_t links = truth_.links, n = links + (itself_ ? 0 : 1);
        n_ = n;
        Square both(n, std::vector<Z>(3 * n + 4));  // M x'' = -K x - (C - i G) x' + load . (b, b', b'', b''')
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t l = 0; l < n; ++l) {
                both[k][l] = {truth_.M[k][l], 0}, both[k][n + l] = {-truth_.K[k][l], 0};
                both[k][2 * n + l] = {-truth_.C[k][l], truth_.G[k][l]};
            }
        for (std::size_t k = 0; k < n; ++k) {
            if (itself_) both[k][3 * n + 1] = {-truth_.C[k][links], 0}, both[k][3 * n + 2] = {-truth_.M[k][links], 0};
            if (!itself_ && k == links) both[k][3 * n] = {by_force ? Quad(1) : quad(support.stiffness), 0};
        }
        support::reduce(both);
        A_.assign(2 * n + 4, std::vector<Z>(2 * n + 4));
        for (std::size_t k = 0; k < n; ++k) {
            A_[k][n + k] = Z{1, 0};
            for (std::size_t l = 0; l < 2 * n + 4; ++l) A_[n + k][l] = both[k][n + l] / both[k][k];
        }
        for (std::size_t k = 0; k < 3; ++k) A_[2 * n + k][2 * n + k + 1] = Z{1, 0};
        state.assign(2 * n + 4, Z{});
    }
    std::vector<Z> state;
    void set_support(double y, double v, double a, double slope) {
        const double values[] = {y, v, a, slope};
        for (std::size_t k = 0; k < 4; ++k) state[2 * n_ + k] = {values[k], 0};
    }
    void set_value(double y, double slope) {  // a force
        state[2 * n_] = {y, 0}, state[2 * n_ + 1] = {slope, 0};
    }
    void set_acceleration(double a, double slope) { state[2 * n_ + 2] = {a, 0}, state[2 * n_ + 3] = {slope, 0}; }
    void go(Quad h) {
        Square step = A_;
        for (auto& row : step)
            for (Z& z : row) z = z * Z{h, 0};
        step = exponential(step);
        std::vector<Z> after(state.size());
        for (std::size_t i = 0; i < after.size(); ++i)
            for (std::size_t j = 0; j < after.size(); ++j) after[i] = after[i] + step[i][j] * state[j];
        state = after;
    }
    std::vector<Z> offsets(bool velocities = false) const {
        const std::size_t links = truth_.links, from = velocities ? n_ : 0;
        std::vector<Z> y(links + 1);
        y[links] = itself_ ? state[2 * n_ + (velocities ? 1 : 0)] : state[from + links];
        for (std::size_t m = links; m-- > 0;) y[m] = y[m + 1] + Z{truth_.lever(rig_, m), 0} * state[from + m];
        return y;
    }
    void set_pins(const Vector<std::complex<double>>& y, const Vector<std::complex<double>>& v) {
        for (std::size_t m = 0; m < truth_.links; ++m) {
            const auto i = static_cast<Index>(m);
            const Z lever{truth_.lever(rig_, m), 0};
            const auto word = [](std::complex<double> z) { return Z{z.real(), z.imag()}; };
            state[m] = (word(y[i]) - word(y[i + 1])) / lever, state[n_ + m] = (word(v[i]) - word(v[i + 1])) / lever;
        }
        if (itself_) return;
        const Index last = y.size() - 1;
        state[truth_.links] = {y[last].real(), y[last].imag()};
        state[n_ + truth_.links] = {v[last].real(), v[last].imag()};
    }

   private:
    support::DampedTruth truth_;
    const Rig& rig_;
    bool by_force_, itself_;
    std::size_t n_ = 0;
    Square A_;
};

struct Checked {
    Index rows = 0, poor = 0, stepped = 0;
    double worst = 0;  ///< of the largest offset of all times
};
Checked check(Index count, std::uint64_t seed, const support::DampedOptions& options) {
    support::Random random(seed);
    Checked result;
    for (Index k = 0; k < count; ++k) {
        const Rig rig = random_rig(random, options);
        const bool by_force = !rig.support().is_firm() && random() < 0.4;
        const double unit = std::sqrt(rig.chain().total_length() / 9.81);
        const std::vector<double> ends{0.3 * unit, 1.1 * unit, 1.1 * unit, 2.0 * unit};
        std::vector<double> values;
        for (int i = 0; i < 4; ++i) values.push_back(random.between(-1, 1));
        TransientOptions with{.time = {0, 0.5 * unit, 1.5 * unit, 3 * unit},
                              .motion = {by_force ? Given::force : Given::acceleration, ends, values},
                              .gravity = 9.81};
        const Index pins = rig.size() + 1;
        with.offset.resize(pins), with.velocity.resize(pins);
        const bool yields = !rig.support().is_firm() && (by_force || !rig.support().is_free());
        for (Index m = 0; m < pins; ++m) {
            const auto number = [&] {
                return std::complex<double>(random.between(-1, 1), options.momentum ? random.between(-1, 1) : 0);
            };
            with.offset[m] = m + 1 < pins || yields ? number() : 0;
            with.velocity[m] = (m + 1 < pins || yields ? number() : 0) / unit;
        }
        const Transient found = transient(rig, with);
        Integrated truth(rig, 9.81, by_force);
        truth.set_pins(with.offset, with.velocity);
        const auto slope = [&](std::size_t i) { return (values[i + 1] - values[i]) / (ends[i + 1] - ends[i]); };
        const auto set = [&](double value, double rise) {
            by_force ? truth.set_value(value, rise) : truth.set_acceleration(value, rise);
        };
        std::vector<std::vector<Z>> y{truth.offsets()}, v{truth.offsets(true)};
        const auto note = [&] { y.push_back(truth.offsets()), v.push_back(truth.offsets(true)); };
        truth.go(Quad(ends[0]));
        set(values[0], slope(0)), truth.go(Quad(with.time[1]) - Quad(ends[0])), note();
        truth.go(Quad(ends[1]) - Quad(with.time[1]));
        set(values[2], slope(2)), truth.go(Quad(with.time[2]) - Quad(ends[1])), note();
        truth.go(Quad(ends[3]) - Quad(with.time[2]));
        set(0, 0), truth.go(Quad(with.time[3]) - Quad(ends[3])), note();
        Quad largest = 0, fastest = 0;
        for (const auto& row : y)
            for (const Z& each : row) largest = std::max(largest, size_of(each));
        for (const auto& row : v)
            for (const Z& each : row) fastest = std::max(fastest, size_of(each));
        result.stepped += found.in_modes ? 0 : 1;
        for (Index i = 0; i < 4; ++i) {
            Quad off = 0, rate = 0;
            for (Index m = 0; m < pins; ++m) {
                const auto a = found.offset(i, m), b = found.velocity(i, m);
                const auto row = static_cast<std::size_t>(i), pin = static_cast<std::size_t>(m);
                off = std::max(off, size_of(y[row][pin] - Z{a.real(), a.imag()}));
                rate = std::max(rate, size_of(v[row][pin] - Z{b.real(), b.imag()}));
            }
            CAPTURE(k, i, rig.size(), by_force, static_cast<double>(off / largest), static_cast<double>(rate / fastest),
                    found.error_estimate[i], static_cast<double>(largest), found.in_modes);
            // With masses 1e16 apart, or by exponentials, there is the estimate alone.
            if (found.in_modes && !options.extreme) {
                CHECK(off <= 1e-11 * largest);
                CHECK(rate <= 1e-9 * fastest);
            }
            ++result.rows, result.poor += off > 10 * Quad(found.error_estimate[i]) ? 1 : 0;
            result.worst = std::max(result.worst, static_cast<double>(off / largest));
        }
    }
    return result;
}

}  // namespace

TEST_CASE("random rigs whose support is moved: against the exponential of a matrix", "[linear]") {
    for (const Checked& each : {check(60, 1, {.most = 4}), check(30, 2, {.momentum = true, .most = 3}),
                                check(30, 3, {.stands = true, .most = 4}), check(30, 4, {.damped = false, .most = 4}),
                                check(30, 5, {.extreme = true, .most = 3}), check(60, 6, {.drag = true, .most = 4})}) {
        CHECK(each.poor * 100 <= each.rows);
    }
}

TEST_CASE("10,000 random rigs whose support is moved", "[.slow]") {
    for (const Checked& each :
         {check(5000, 11, {.most = 4}), check(1500, 12, {.momentum = true, .most = 3}),
          check(1500, 13, {.stands = true, .most = 4}), check(1000, 14, {.damped = false, .most = 4}),
          check(1000, 15, {.extreme = true, .most = 3})}) {
        WARN(each.rows << " rows, " << each.poor << " estimates below a tenth of the error, " << each.stepped
                       << " by matrix exponentials, largest error " << each.worst);
        CHECK(each.poor * 100 <= each.rows);
    }
}

TEST_CASE("a load that is accelerated for exactly one of its periods does not swing afterwards", "[linear]") {
    const double period = 2 * M_PI * std::sqrt(10.0 / 9.81);
    const Rig crane(Chain<double>({plummet(9.81, 10.0)}), {});
    for (const double share : {1.0, 0.5}) {
        const double T = share * period;
        const auto found =
            transient(crane, {.time = {0, T, T + 7}, .motion = {Given::velocity, {0, T}, {0, 2}}, .gravity = 9.81});
        // half a period: twice the deflection 2 m/s / T * l/g at which the load would ride along
        CHECK(std::abs(found.sway[0] - (share == 1 ? 0 : 2 * 2 / T * 10 / 9.81)) <= 1e-14);
        CHECK(std::abs(found.offset(2, 1) - (2 * T / 2 + 14)) <= 1e-14 * 20);
        CHECK(found.sway[1] == 0);
        CHECK(found.end == T);
    }
}

TEST_CASE("without dashpots and a moving support the motion is that of `swing`", "[linear]") {
    const Chain<double> chain({plummet(3.0, 1.0), uniform_rod(2.0, 0.5), plummet(1.0, 0.7)});
    const Rig rig(chain, {.support = horizontal_spring(20.0, 0.5)});
    Vector<double> offset(4), velocity(4);
    offset << 0.1, 0.05, -0.02, 0.01, velocity << 0, 0.2, 0, -0.1;
    const std::vector<double> time{0, 0.3, 7, 1000};
    const auto known = swing(rig, {.offset = offset, .velocity = velocity, .time = time});
    const auto found = transient(rig, {.offset = offset.cast<std::complex<double>>(),
                                       .velocity = velocity.cast<std::complex<double>>(),
                                       .time = time});
    CHECK((known.offset - found.offset.real()).cwiseAbs().maxCoeff() <= 1e-15);
    CHECK((known.velocity - found.velocity.real()).cwiseAbs().maxCoeff() <= 1e-14);
    CHECK(found.error_estimate.maxCoeff() <= 1e-14);
    for (Index k = 0; k < 4; ++k) CHECK(std::abs(found.exponent[k].imag() - known.angular_frequency[k]) <= 1e-14);
}

TEST_CASE("critical damping: two motions become one", "[linear]") {
    const Rig rig(Chain<double>({plummet(1.0, 1.0)}), {.pins = {{.damping = 2.0}}});
    Vector<std::complex<double>> offset(1);
    offset << 1.0;
    const auto found = transient(rig, {.offset = offset, .time = {0, 0.5, 1, 4}, .gravity = 1});
    CHECK_FALSE(found.in_modes);
    for (Index i = 0; i < 4; ++i) {
        const double t = std::array{0.0, 0.5, 1.0, 4.0}[static_cast<std::size_t>(i)];
        CHECK(std::abs(found.offset(i, 0) - (1 + t) * std::exp(-t)) <= 4e-16);
        CHECK(std::abs(found.velocity(i, 0) + t * std::exp(-t)) <= 4e-16);
        CHECK(found.error_estimate[i] <= 1e-13);
    }
    CHECK(found.sway[0] == 1);
    const auto no_times = transient(rig, {.offset = offset, .gravity = 1});
    CHECK(no_times.sway[0] == 1);
    CHECK_FALSE(no_times.in_modes);
    // The start, too, is what was given. With velocity 1 the offset is (1 + 2 t) exp(-t), at most 2 exp(-1/2).
    for (const double off : {0.0, 1e-15, -1e-15, 1e-14, -1e-14, 1e-12, 1e-10, 1e-8})
        for (const std::vector<double>& time : {std::vector<double>{}, std::vector<double>{0, 1}}) {
            const Rig close(rig.chain(), {.pins = {{.damping = 2 * (1 + off)}}});
            const auto thrown = transient(close, {.offset = offset, .velocity = offset, .time = time, .gravity = 1});
            CAPTURE(off, time.size());
            CHECK(thrown.start[0] == 1.0);
            CHECK_FALSE(thrown.projected);
            CHECK(std::abs(thrown.sway[0] - 2 * std::exp(-0.5)) <= 3e-6);
        }
    // nearly critical: the modes lose eight digits, the exponential none
    const Rig near(Chain<double>({plummet(1.0, 1.0)}), {.pins = {{.damping = 2 * (1 + 1e-15)}}});
    CHECK(std::abs(transient(near, {.offset = offset, .time = {1}, .gravity = 1}).offset(0, 0) - 2 / M_E) <= 1e-14);
}

TEST_CASE("pins without inertia go where they are pulled", "[linear]") {
    // A mass of weight 1 on a thread of 1 below a massless ring on a spring of 1, which is pushed with 0.5: the ring is at
    // y = (x + 0.5) / 2, and x'' = y - x = (0.5 - x) / 2 with g = 1.
    const Rig rig(Chain<double>({plummet(1.0, 1.0)}), {.support = horizontal_spring(1.0)});
    Vector<std::complex<double>> offset(2);
    offset << 0.2, 0.7;
    const auto found = transient(
        rig, {.offset = offset, .time = {0, 1, 3}, .motion = {Given::force, {0, 100}, {0.5, 0.5}}, .gravity = 1});
    CHECK(found.projected);
    for (Index i = 0; i < 3; ++i) {
        const double t = std::array{0.0, 1.0, 3.0}[static_cast<std::size_t>(i)];
        const double x = 0.5 - 0.3 * std::cos(t * std::sqrt(0.5)),
                     v = 0.3 * std::sqrt(0.5) * std::sin(t * std::sqrt(0.5));
        CHECK(std::abs(found.offset(i, 0) - x) <= 1e-15);
        CHECK(std::abs(found.offset(i, 1) - (x + 0.5) / 2) <= 1e-15);
        CHECK(std::abs(found.velocity(i, 1) - v / 2) <= 1e-15);
    }
    // the far end of the spring moves: x'' = (b - x) / 2 with b = t
    const auto moved = transient(rig, {
                                          .time = {2},
                                          .motion = {Given::velocity, {0, 9}, {1, 1}},
                                          .gravity = 1,
                                      });
    const double w = std::sqrt(0.5);
    CHECK(std::abs(moved.offset(0, 0) - 2.0) <= 1e-15);  // it starts moving along
    Vector<std::complex<double>> rest = Vector<std::complex<double>>::Zero(2);
    const auto pulled = transient(
        rig,
        {.offset = rest, .velocity = rest, .time = {2}, .motion = {Given::velocity, {0, 9}, {1, 1}}, .gravity = 1});
    CHECK(std::abs(pulled.offset(0, 0) - (2 - std::sin(2 * w) / w)) <= 1e-15);
}

TEST_CASE("places in time: a spline, of a sine within its fourth power of the step", "[linear]") {
    const Rig rig(Chain<double>({plummet(9.81, 1.0)}), {});
    double before = 0;
    for (const int n : {20, 40, 80}) {
        SupportMotion motion{Given::offset, {}, {}, false};
        for (int k = 0; k <= n; ++k) {
            motion.time.push_back(4.0 * k / n);
            motion.value.push_back(0.1 * std::sin(2 * motion.time.back()));
        }
        Vector<std::complex<double>> velocity(1);
        velocity << 0.0;
        const auto found = transient(rig, {.velocity = velocity, .time = {4.0}, .motion = motion, .gravity = 9.81});
        // x'' + w^2 x = w^2 b, x(0) = x'(0) = 0
        const double w = std::sqrt(9.81), b = 0.1 * 9.81 / (9.81 - 4);
        const double off = std::abs(found.offset(0, 0) - b * (std::sin(8.0) - 2 / w * std::sin(4 * w)));
        CAPTURE(n, off);
        CHECK(off <= 3e-4 * std::pow(20.0 / n, 4));
        if (before > 0) CHECK(off <= before / 12);
        before = off;
        CHECK(std::abs(found.offset(0, 1) - motion.value.back()) <= 1e-15);
    }
}

TEST_CASE("places in time: at rest before the first and after the last", "[linear]") {
    const Rig rig(Chain<double>({plummet(9.81, 1.0)}), {});
    for (const int n : {2, 3, 30}) {
        SupportMotion motion{Given::offset, {}, {}};
        for (int k = 0; k < n; ++k) {
            motion.time.push_back(1 + 2.0 * k / (n - 1));
            motion.value.push_back((1 - std::cos(M_PI * k / (n - 1))) / 2);
        }
        const auto found = transient(rig, {.time = {0, 1, 1.7, 3, 10}, .motion = motion, .gravity = 9.81});
        for (const Index i : {0, 1}) CHECK(std::abs(found.offset(i, 1)) + std::abs(found.velocity(i, 1)) <= 1e-15);
        for (const Index i : {3, 4})
            CHECK(std::abs(found.offset(i, 1) - 1.0) + std::abs(found.velocity(i, 1)) <= 2e-15);
        CHECK(std::abs(found.offset(2, 1) - (1 - std::cos(M_PI * 0.35)) / 2) <= (n == 30 ? 3e-6 : 0.03));
    }
}

TEST_CASE("sway is what is seen: heavy and critical damping, trolleys that coast, motions that grow", "[linear]") {
    const double g = 9.80665, critical = 2 * std::sqrt(g);
    std::vector<double> time;
    for (int i = 0; i <= 20000; ++i) time.push_back(1 + 0.001 * i);
    const SupportMotion start{Given::velocity, {0, 1}, {1, 0}};
    for (const double z : {0.01, 0.3, 0.9, 0.99, 0.999999, 1.0, 1.5, 20.0}) {
        const Rig rig(Chain<double>({plummet(1.0, 1.0)}), {.pins = {{.damping = z * critical / g}}});
        const auto found = transient(rig, {.time = time, .motion = start});
        const double seen = (found.offset.col(0) - found.offset.col(1)).cwiseAbs().maxCoeff();
        CAPTURE(z, seen, found.sway[0], found.in_modes);
        CHECK(found.sway[0] >= seen * 0.99);
        CHECK(found.sway[0] <= seen * (z < 0.05 ? 1.03 : 1.01));
    }
    // drag alike on all links damps the first mode critically: it comes back without passing the axis
    for (const Index n : {3, 6, 12, 24})
        for (const double off : {0.0, 1e-15, -1e-15, 1e-13}) {
            const auto rods = Chain<double>::uniform_rods(n, 2.0, g * static_cast<double>(n));
            const auto mode = revchain::modes(rods, {.count = 1});
            const double twice = 2 * std::sqrt(g / mode.conical_height[0]) * (1 + off);
            const Rig slowed(rods, {.drag = std::vector<revchain::Wide<double>>(static_cast<std::size_t>(n), twice)});
            const Vector<std::complex<double>> offset = (0.01 * mode.shape(0)).head(n).cast<std::complex<double>>();
            const auto found = transient(slowed, {.offset = offset, .time = {0, 1}, .gravity = g});
            CAPTURE(n, off, found.in_modes);
            CHECK(std::abs(found.sway[0] - 0.01) <= 1e-9);
            CHECK(std::abs(transient(slowed, {.offset = offset, .gravity = g}).sway[0] - 0.01) <= 1e-9);
            CHECK(found.in_modes == std::isfinite(found.amplitude[0].real()));
        }
    for (const double damping : {1e-6, 1e-3, 1.0}) {
        const Rig trolley(Chain<double>({plummet(4 * g, 2.0)}), {.support = {0.0, 10 * g, 0, damping}});
        const auto found = transient(trolley, {.time = time, .motion = {Given::force, {0, 1, 2}, {0, 5, 0}}});
        Vector<double> apart = (found.offset.col(0) - found.offset.col(1)).cwiseAbs();
        CHECK(found.sway[0] <= 1.05 * apart.tail(19000).maxCoeff());
        CHECK(found.sway[0] >= 0.98 * apart.tail(19000).maxCoeff());
    }
    const Rig upright(Chain<double>({plummet(1.0, 1.0)}), {.posture = {Posture::stands}});
    CHECK(std::isinf(transient(upright, {.time = {0, 1}, .motion = start}).sway[0]));
    CHECK_THROWS_WITH(transient(upright, {.time = {0, 1e4}, .motion = start}),
                      Catch::Matchers::Contains("grows beyond all numbers"));
    // undamped motions do not decay, and their phase is known as long as the estimate says
    const Rig plain(Chain<double>({plummet(g, 2.0)}), {});
    const auto late = transient(plain, {.time = {1, 1e60}, .motion = start});
    CHECK(late.error_estimate[1] > 1);
    CHECK(late.error_estimate[0] < 1e-14);
}

TEST_CASE("what motion in time refuses", "[linear]") {
    using Catch::Matchers::Contains;
    const Rig rig(Chain<double>({plummet(1.0, 1.0)}), {}), round(rig.chain(), {.support = {.radius = 2}});
    const auto moved = [&](Given given, std::vector<double> time, std::vector<double> value) {
        return transient(rig, {.time = {1}, .motion = {given, std::move(time), std::move(value)}});
    };
    CHECK_THROWS_WITH(moved(Given::velocity, {0, 1, 1}, {0, 1, 2}), Contains("a support cannot jump"));
    CHECK_THROWS_WITH(moved(Given::velocity, {0}, {1}), Contains("at least two times"));
    CHECK_THROWS_WITH(moved(Given::velocity, {0, 1}, {1}), Contains("a value for each time"));
    CHECK_THROWS_WITH(moved(Given::offset, {1, 0}, {1, 1}), Contains("must ascend"));
    CHECK_THROWS_WITH(moved(Given::acceleration, {-1, 0}, {1, 1}), Contains("must not be negative"));
    CHECK_THROWS_WITH(moved(Given::force, {0, 1}, {1, 1}), Contains("does not move a firm support"));
    CHECK_THROWS_WITH(transient(rig, {.time = {-1}}), Contains("must not be negative"));
    CHECK_THROWS_WITH(transient(rig, {.time = {1, 0}}), Contains("must ascend"));
    CHECK_THROWS_WITH(transient(rig, {.time = {0}, .gravity = 0}), Contains("gravity"));
    CHECK_THROWS_WITH(transient(round, {.time = {0}}), Contains("carried round"));
    Vector<std::complex<double>> three = Vector<std::complex<double>>::Zero(3), whirl(1), support(2);
    whirl << std::complex<double>(0, 1), support << 0.0, 1.0;
    CHECK_THROWS_WITH(transient(rig, {.offset = three, .time = {0}}), Contains("a number for each pin"));
    CHECK_THROWS_WITH(transient(rig, {.offset = whirl, .time = {0}}), Contains("must be real without momentum"));
    CHECK_THROWS_WITH(transient(rig, {.velocity = support, .time = {0}}),
                      Contains("leave out the velocity of the support"));
}
