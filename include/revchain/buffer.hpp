// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/numeric/progress.hpp"
#include "revchain/two_links.hpp"

/// Two railway carriages, coupled by a spring, that run against a buffer stop: in contact they swing as two plummets
/// do, and "the system is seen to deal a double blow". Greenhill (1908) §2.
namespace revchain {

/// What is given, in any consistent units. The coupling is slack at first, both carriages run with `speed`.
struct Carriages {
    double front_mass, rear_mass;
    double buffer_stiffness;    ///< it pushes alone, and is left where it would pull
    double coupling_stiffness;  ///< pulls and pushes
    double speed;               ///< towards the buffer, at time 0 when the front one touches it
};

/// Where the carriages are, in the direction of the buffer from where they were at time 0.
struct CarriageState {
    double front, rear, front_speed, rear_speed;
    double buffer_force;  ///< 0 where the buffer is left
};

/// One contact with the buffer.
struct Blow {
    double start, end;
    double impulse;  ///< what the buffer takes from the momentum, the integral of its force
};

/// The motion in time. Accuracy: 1e-13 of speed x time for places, of the speed and acceleration x time for speeds, of
/// the end for times (measured: tests/cpp/paper/section_2.cpp), where no blow only grazes. Cost: 2 microseconds a blow
/// (carriages of about one mass deal one to three, a heavy one behind a light one hundreds), 0.1 for a state.
class BufferImpact {
   public:
    /// Throws InvalidArgument unless all numbers are positive and finite, and their quotients, or for over 100,000
    /// blows or ten million steps to find their times.
    explicit BufferImpact(const Carriages& given);

    const std::vector<Blow>& blows() const { return blows_; }
    /// Throws InvalidArgument for a time that is negative or not finite.
    CarriageState operator()(double time) const;

   private:
    static constexpr long most_steps = 10'000'000;
    /// Offset of the front carriage c + v t + sum of a cos(w t) + b sin(w t), of the rear one with `ratio` a and b for
    /// a, b.
    struct Phase {
        double start, centre = 0, drift = 0;
        std::array<double, 2> cosine{}, sine{}, frequency{}, ratio{};

        CarriageState at(double t) const;
        double first_zero(double sign, double end, long& steps) const;
    };
    Phase contact(double start, const CarriageState& from) const;
    Phase freedom(double start, const CarriageState& from) const;

    Carriages given_;
    std::array<double, 2> frequency_{}, ratio_{};  // in contact: offset of the rear carriage over that of the front one
    std::vector<Phase> phases_;                    // contact, freedom, contact, ..., freedom
    std::vector<Blow> blows_;
};

inline CarriageState BufferImpact::Phase::at(double t) const {
    CarriageState s{centre + drift * t, centre + drift * t, drift, drift, 0};
    for (std::size_t k = 0; k < 2; ++k) {
        const double c = std::cos(frequency[k] * t), d = std::sin(frequency[k] * t);
        const double offset = cosine[k] * c + sine[k] * d, speed = frequency[k] * (sine[k] * c - cosine[k] * d);
        s.front += offset, s.rear += ratio[k] * offset;
        s.front_speed += speed, s.rear_speed += ratio[k] * speed;
    }
    return s;
}

/// The first time after 0, at most `end`, at which the front carriage, first on the side `sign` of 0, is at 0 again;
/// infinity if there is none. Steps shorter than the largest acceleration would need to bring it there miss nothing.
inline double BufferImpact::Phase::first_zero(double sign, double end, long& steps) const {
    double largest = 0, t = 0;
    for (std::size_t k = 0; k < 2; ++k) largest += std::hypot(cosine[k], sine[k]) * frequency[k] * frequency[k];
    largest *= 1 + 1e-12;
    while (t <= end) {
        if (++steps % 1024 == 0) detail::look();
        if (steps > most_steps)
            detail::throw_invalid(
                "BufferImpact",
                "masses and stiffnesses must be nearer each other: the times of the blows take too many steps; "
                "angular frequency of the faster swing",
                *std::max_element(frequency.begin(), frequency.end()));
        const CarriageState s = at(t);
        const double offset = t == 0 ? 0 : std::max(0.0, sign * s.front), speed = sign * s.front_speed;
        const double root = std::sqrt(speed * speed + 2 * largest * offset);
        const double step = speed > 0 ? (speed + root) / largest : 2 * offset / (root - speed);
        if (!(step > std::numeric_limits<double>::epsilon() * t)) return t;
        t += step;
    }
    return std::numeric_limits<double>::infinity();
}

inline BufferImpact::Phase BufferImpact::contact(double start, const CarriageState& from) const {
    Phase phase{start};
    phase.frequency = frequency_, phase.ratio = ratio_;
    for (std::size_t k = 0; k < 2; ++k) {  // modes are orthogonal in the masses
        const double rear = given_.rear_mass * ratio_[k], whole = given_.front_mass + rear * ratio_[k];
        phase.cosine[k] = rear * from.rear / whole;  // the front one is at 0
        phase.sine[k] = (given_.front_mass * from.front_speed + rear * from.rear_speed) / whole / frequency_[k];
    }
    return phase;
}

inline BufferImpact::Phase BufferImpact::freedom(double start, const CarriageState& from) const {
    const double front = given_.front_mass, rear = given_.rear_mass, whole = front + rear;
    Phase phase{start, rear / whole * from.rear, front / whole * from.front_speed + rear / whole * from.rear_speed};
    phase.frequency[0] = std::sqrt(given_.coupling_stiffness) * std::sqrt(1 / front + 1 / rear);
    phase.ratio[0] = -front / rear;
    phase.cosine[0] = -rear / whole * from.rear;
    phase.sine[0] = rear / whole * (from.front_speed - from.rear_speed) / phase.frequency[0];
    return phase;
}

inline BufferImpact::BufferImpact(const Carriages& given) : given_(given) {
    const auto check = [](std::string_view name, double value) {
        detail::require_positive("BufferImpact", name, value);
    };
    check("front mass", given.front_mass), check("rear mass", given.rear_mass);
    check("buffer stiffness", given.buffer_stiffness), check("coupling stiffness", given.coupling_stiffness);
    check("speed", given.speed);
    // Two plummets with g = 1: the threads are what the springs would yield to the weights they carry, §2 (7).
    const double l1 = given.rear_mass / given.coupling_stiffness;
    const double l2 = (given.front_mass + given.rear_mass) / given.buffer_stiffness;
    check("rear mass over coupling stiffness", l1), check("masses over buffer stiffness", l2);
    const HeightPair<double> height = two_plummets(given.rear_mass, l1, given.front_mass, l2);
    const double half = (l2 - l1) / 2, share = given.rear_mass / (given.front_mass + given.rear_mass);
    const double coupling = std::sqrt(share) * std::sqrt(l1) * std::sqrt(l2), root = std::hypot(half, coupling);
    const double above = half > 0 ? half + root : coupling * (coupling / (root - half));  // first height over l1
    const double ratio = height[0] / above;                                               // l / (l - l1)
    ratio_ = {ratio, -(given.front_mass / given.rear_mass) / ratio};  // modes are orthogonal in the masses
    frequency_ = {1 / std::sqrt(height[0]), 1 / std::sqrt(height[1])};

    constexpr std::size_t most = 100'000;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    CarriageState state{0, 0, 1, 1, 0};  // in units of the speed: times do not depend on it
    double time = 0;
    long steps = 0;
    while (blows_.size() < most) {
        phases_.push_back(contact(time, state));
        const double inwards = given.front_mass * state.front_speed + given.rear_mass * state.rear_speed;
        const double lasts = phases_.back().first_zero(1, infinity, steps);
        state = phases_.back().at(lasts);
        blows_.push_back(
            {time, time + lasts,
             given.speed * (inwards - given.front_mass * state.front_speed - given.rear_mass * state.rear_speed)});
        if (!std::isfinite(blows_.back().impulse) || !std::isfinite(blows_.back().end))
            detail::throw_invalid("BufferImpact",
                                  "speed, masses and stiffnesses must be so near 1 that impulses and times do not "
                                  "overflow; speed",
                                  given.speed);
        time += lasts;
        phases_.push_back(freedom(time, state));
        const Phase& free = phases_.back();
        // It comes back while it swings farther than it has drifted, or within a period if it does not drift away.
        const double reach = std::hypot(free.cosine[0], free.sine[0]) + free.centre;
        const double until = free.drift < 0 ? std::max(0.0, reach / -free.drift) : 7 / free.frequency[0];
        const double away = free.first_zero(-1, free.drift > 0 ? infinity : until, steps);
        if (!(away < infinity)) return;
        state = free.at(away);
        time += away;
    }
    detail::throw_invalid("BufferImpact",
                          "masses must be so near each other that there are at most 100,000 blows; rear over front "
                          "mass",
                          given.rear_mass / given.front_mass);
}

inline CarriageState BufferImpact::operator()(double time) const {
    if (!(time >= 0) || !std::isfinite(time))
        detail::throw_invalid("BufferImpact", "time must not be negative, and finite", time);
    const auto after = std::upper_bound(phases_.begin(), phases_.end(), time,
                                        [](double t, const Phase& phase) { return t < phase.start; });
    const auto phase = after - 1;
    CarriageState state = phase->at(time - phase->start);
    for (double* each : {&state.front, &state.rear, &state.front_speed, &state.rear_speed}) *each *= given_.speed;
    if ((phase - phases_.begin()) % 2 == 0) state.buffer_force = given_.buffer_stiffness * std::max(0.0, state.front);
    if (!std::isfinite(state.front + state.rear) || !std::isfinite(state.front_speed + state.rear_speed) ||
        !std::isfinite(state.buffer_force))
        detail::throw_invalid("BufferImpact", "time must be so small that places and speeds do not overflow", time);
    return state;
}

}  // namespace revchain
