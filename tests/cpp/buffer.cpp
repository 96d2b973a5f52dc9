// SPDX-License-Identifier: MPL-2.0
#include "revchain/buffer.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using support::Quad;

namespace {

/// The impact once more: Taylor series of the equations of motion in quadruple precision, ends of contact by Newton.
struct Impact {
    revchain::Carriages given;
    Quad x1 = 0, x2 = 0, v1, v2, time = 0;
    bool touching = true;
    explicit Impact(const revchain::Carriages& c) : given(c), v1(c.speed), v2(c.speed) {}

    struct State {
        Quad x1, x2, v1, v2;
    };
    State after(Quad t) const {
        const Quad buffer = touching ? Quad(given.buffer_stiffness) : Quad(0);
        Quad a[30], b[30];
        a[0] = x1, a[1] = v1, b[0] = x2, b[1] = v2;
        for (int j = 0; j + 2 < 30; ++j) {
            const Quad pull = given.coupling_stiffness * (b[j] - a[j]);
            a[j + 2] = (pull - buffer * a[j]) / given.front_mass / ((j + 1) * (j + 2));
            b[j + 2] = -pull / given.rear_mass / ((j + 1) * (j + 2));
        }
        State s{0, 0, 0, 0};
        for (int j = 29; j > 0; --j) {
            s.x1 = s.x1 * t + a[j], s.x2 = s.x2 * t + b[j];
            s.v1 = s.v1 * t + j * a[j], s.v2 = s.v2 * t + j * b[j];
        }
        s.x1 = s.x1 * t + a[0], s.x2 = s.x2 * t + b[0];
        return s;
    }
    /// On by `t`, or to where the front carriage comes to 0 before; true if it did.
    bool step(Quad t) {
        State s = after(t);
        const bool crossed = touching ? s.x1 < 0 : s.x1 > 0;
        if (crossed) {
            Quad low = 0, high = t;
            for (int i = 0; i < 110; ++i) {
                const Quad middle = (low + high) / 2;
                s = after(middle);
                ((touching ? s.x1 < 0 : s.x1 > 0) ? high : low) = middle;
            }
            t = high;
            s = after(t);
            touching = !touching;
        }
        x1 = crossed ? 0 : s.x1, x2 = s.x2, v1 = s.v1, v2 = s.v2, time += t;
        return crossed;
    }
};

}  // namespace

TEST_CASE("§2 text: two carriages on a buffer stop, against integration", "[core]") {
    support::Random random(212);
    double places = 0, times = 0, momentum = 0;
    std::array<int, 8> blows{};
    for (int i = 0; i < 40; ++i) {
        const revchain::Carriages given{.front_mass = random.log_between(0.1, 10.0),
                                        .rear_mass = random.log_between(0.1, 10.0),
                                        .buffer_stiffness = random.log_between(0.1, 10.0),
                                        .coupling_stiffness = random.log_between(0.1, 10.0),
                                        .speed = random.log_between(0.1, 10.0)};
        const revchain::BufferImpact impact(given);
        ++blows[std::min<std::size_t>(7, impact.blows().size())];
        Impact truth(given);
        std::vector<Quad> ends;
        const double until = impact.blows().back().end * 1.5,
                     step = 0.02 / std::sqrt(given.buffer_stiffness / given.front_mass +
                                             given.coupling_stiffness / given.front_mass +
                                             given.coupling_stiffness / given.rear_mass);
        while (truth.time < until) {
            if (truth.step(step)) ends.push_back(truth.time);
            const double t = static_cast<double>(truth.time);
            const auto s = impact(t);
            const Quad reach = given.speed * std::max(t, 1e-3);
            places = std::max({places, static_cast<double>(fabsq(s.front - truth.x1) / reach),
                               static_cast<double>(fabsq(s.rear - truth.x2) / reach),
                               static_cast<double>(fabsq(s.front_speed - truth.v1) / given.speed),
                               static_cast<double>(fabsq(s.rear_speed - truth.v2) / given.speed)});
            const Quad force = truth.touching ? truth.x1 * given.buffer_stiffness : Quad(0);
            places =
                std::max(places, static_cast<double>(fabsq(s.buffer_force - force) / given.buffer_stiffness / reach));
        }
        REQUIRE(ends.size() == 2 * impact.blows().size() - 1);
        double whole = 0;
        for (std::size_t j = 0; j < impact.blows().size(); ++j) {
            const auto& blow = impact.blows()[j];
            times = std::max(times, static_cast<double>(fabsq(blow.end - ends[2 * j]) / blow.end));
            if (j > 0) times = std::max(times, static_cast<double>(fabsq(blow.start - ends[2 * j - 1]) / blow.start));
            CHECK(blow.impulse > 0);
            whole += blow.impulse;
        }
        const auto last = impact(until);
        const double before = (given.front_mass + given.rear_mass) * given.speed;
        const double after = given.front_mass * last.front_speed + given.rear_mass * last.rear_speed;
        momentum = std::max(momentum, std::abs(before - whole - after) / before);
    }
    CAPTURE(places, times, momentum, blows[1], blows[2], blows[3]);
    CHECK(places <= 1e-13);
    CHECK(times <= 1e-13);
    CHECK(momentum <= 1e-14);
    CHECK(blows[1] > 3);
    CHECK(blows[2] > 3);  // "the system is seen to deal a double blow"
}

TEST_CASE("§2 text: wrong numbers of two carriages", "[core]") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, nan, inf}) {
        CHECK_THROWS_AS(revchain::BufferImpact({bad, 1, 1, 1, 1}), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::BufferImpact({1, 1, 1, 1, bad}), revchain::InvalidArgument);
    }
    CHECK_THROWS_AS(revchain::BufferImpact({1, 1, 1, 1, 1})(-1), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::BufferImpact({1, 1, 1, 1, 1})(inf), revchain::InvalidArgument);
}
