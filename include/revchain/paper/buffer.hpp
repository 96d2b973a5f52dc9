// SPDX-License-Identifier: MPL-2.0
// Defines what buffer.hpp declares.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "revchain/buffer.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/two_links.hpp"

namespace revchain::inline REVCHAIN_BUILD {

inline CarriageState BufferImpact::Phase::at(double t) const {
    CarriageState s{centre + drift * t, centre + drift * t, drift, drift, 0};
    for (std::size_t k = 0; k < 2; ++k) {
        const double c = std::cos(frequency[k] * t), d = std::sin(frequency[k] * t);
        const double offset = cosine[k] * c + sine[k] * d,
                     speed = frequency[k] * (sine[k] * c - cosine[k] * d);
        s.front += offset, s.rear += ratio[k] * offset;
        s.front_speed += speed, s.rear_speed += ratio[k] * speed;
    }
    return s;
}

/// Returns the first time after 0, at most `end`, at which the front carriage returns to 0 from the
/// side `sign`; infinity if there is none. No return is missed, because each step is the time in
/// which the largest acceleration would bring it there.
inline double BufferImpact::Phase::first_zero(double sign, double end, long& steps) const {
    constexpr long most_steps = 10'000'000;
    double largest = 0, t = 0;
    for (std::size_t k = 0; k < 2; ++k)
        largest += std::hypot(cosine[k], sine[k]) * frequency[k] * frequency[k];
    largest *= 1 + 1e-12;
    while (t <= end) {
        if (++steps % 1024 == 0) detail::check_interrupt();
        if (steps > most_steps)
            detail::throw_invalid(
                "BufferImpact",
                "masses and stiffnesses must be nearer each other: the times of the blows take too "
                "many steps; angular frequency of the faster swing",
                *std::max_element(frequency.begin(), frequency.end()));
        const CarriageState s = at(t);
        const double offset = t == 0 ? 0 : std::max(0.0, sign * s.front),
                     speed = sign * s.front_speed;
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
        const double rear = given_.rear_mass * ratio_[k],
                     whole = given_.front_mass + rear * ratio_[k];
        phase.cosine[k] = rear * from.rear / whole;  // the front one is at 0
        phase.sine[k] =
            (given_.front_mass * from.front_speed + rear * from.rear_speed) / whole / frequency_[k];
    }
    return phase;
}

inline BufferImpact::Phase BufferImpact::freedom(double start, const CarriageState& from) const {
    const double front = given_.front_mass, rear = given_.rear_mass, whole = front + rear;
    Phase phase{start, rear / whole * from.rear,
                front / whole * from.front_speed + rear / whole * from.rear_speed};
    phase.frequency[0] = std::sqrt(given_.coupling_stiffness) * std::sqrt(1 / front + 1 / rear);
    phase.ratio[0] = -front / rear;
    phase.cosine[0] = -rear / whole * from.rear;
    phase.sine[0] = rear / whole * (from.front_speed - from.rear_speed) / phase.frequency[0];
    return phase;
}

inline BufferImpact::BufferImpact(const Carriages& given) : given_(given) {
    const double front = given.front_mass, rear = given.rear_mass;
    detail::require_positive("BufferImpact", "front mass", front, "rear mass", rear,
                             "buffer stiffness", given.buffer_stiffness, "coupling stiffness",
                             given.coupling_stiffness, "speed", given.speed);
    // Frequencies and ratios in contact are those of two plummets with g = 1, on threads as long as
    // the deflections of the springs under the weights they carry, §2 (7).
    const double l1 = rear / given.coupling_stiffness, l2 = (front + rear) / given.buffer_stiffness;
    detail::require_positive("BufferImpact", "rear mass over coupling stiffness", l1,
                             "masses over buffer stiffness", l2);
    const HeightPair<double> height = two_plummets(rear, l1, front, l2);
    const double half = (l2 - l1) / 2, share = rear / (front + rear);
    const double coupling = std::sqrt(share) * std::sqrt(l1) * std::sqrt(l2),
                 root = std::hypot(half, coupling);
    const double above =
        half > 0 ? half + root : coupling * (coupling / (root - half));  // first height over l1
    const double ratio = height[0] / above;                              // l / (l - l1)
    ratio_ = {ratio, -(front / rear) / ratio};  // modes are orthogonal in the masses
    frequency_ = {1 / std::sqrt(height[0]), 1 / std::sqrt(height[1])};
    find_blows();
}

inline void BufferImpact::find_blows() {
    constexpr std::size_t most = 100'000;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double front = given_.front_mass, rear = given_.rear_mass;
    CarriageState state{0, 0, 1, 1, 0};  // in units of the speed: times do not depend on it
    double time = 0;
    long steps = 0;
    while (blows_.size() < most) {
        phases_.push_back(contact(time, state));
        const double inwards = front * state.front_speed + rear * state.rear_speed;
        const double lasts = phases_.back().first_zero(1, infinity, steps);
        state = phases_.back().at(lasts);
        blows_.push_back(
            {time, time + lasts,
             given_.speed * (inwards - front * state.front_speed - rear * state.rear_speed)});
        if (!std::isfinite(blows_.back().impulse) || !std::isfinite(blows_.back().end))
            detail::throw_invalid("BufferImpact",
                                  "speed, masses and stiffnesses must be so near 1 that impulses "
                                  "and times do not overflow; speed",
                                  given_.speed);
        time += lasts;
        phases_.push_back(freedom(time, state));
        const Phase& free = phases_.back();
        // It can return only while it swings farther than it drifts or, without drift, within a
        // period.
        const double reach = std::hypot(free.cosine[0], free.sine[0]) + free.centre;
        const double until =
            free.drift < 0 ? std::max(0.0, reach / -free.drift) : 7 / free.frequency[0];
        const double away = free.first_zero(-1, free.drift > 0 ? infinity : until, steps);
        if (!(away < infinity)) return;
        state = free.at(away);
        time += away;
    }
    detail::throw_invalid("BufferImpact",
                          "masses must be so near each other that there are at most 100,000 blows; "
                          "rear over front mass",
                          rear / front);
}

inline CarriageState BufferImpact::operator()(double time) const {
    if (!(time >= 0) || !std::isfinite(time))
        detail::throw_invalid("BufferImpact", "time must not be negative, and finite", time);
    const auto after =
        std::upper_bound(phases_.begin(), phases_.end(), time,
                         [](double t, const Phase& phase) { return t < phase.start; });
    const auto phase = after - 1;
    CarriageState state = phase->at(time - phase->start);
    for (double* each : {&state.front, &state.rear, &state.front_speed, &state.rear_speed})
        *each *= given_.speed;
    if ((phase - phases_.begin()) % 2 == 0)
        state.buffer_force = given_.buffer_stiffness * std::max(0.0, state.front);
    if (!std::isfinite(state.front + state.rear) ||
        !std::isfinite(state.front_speed + state.rear_speed) || !std::isfinite(state.buffer_force))
        detail::throw_invalid("BufferImpact",
                              "time must be so small that places and speeds do not overflow", time);
    return state;
}

}  // namespace revchain
