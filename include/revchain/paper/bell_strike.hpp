// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "revchain/bell.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// A function of time as a Taylor series about the start of a step. Rates of a pendulum are entire
/// functions of sines, so that order 24 is exact to rounding in steps of about half a radian.
struct BellSeries {
    static constexpr std::size_t order = 24;
    std::array<double, order + 1> c{};

    double at(double t) const {
        double sum = 0;
        for (std::size_t i = order + 1; i-- > 0;) sum = sum * t + c[i];
        return sum;
    }
    double rate(double t) const {
        double sum = 0;
        for (std::size_t i = order; i > 0; --i) sum = sum * t + static_cast<double>(i) * c[i];
        return sum;
    }
    /// Term n of the product with another series.
    double times(const BellSeries& other, std::size_t n) const {
        double sum = 0;
        for (std::size_t i = 0; i <= n; ++i) sum += c[i] * other.c[n - i];
        return sum;
    }
    /// Terms n + 1 of this sine and of a cosine from terms up to n + 1 of the angle.
    static void turn(const BellSeries& angle, BellSeries& sine, BellSeries& cosine, std::size_t n) {
        double up = 0, down = 0;
        for (std::size_t i = 1; i <= n + 1; ++i) {
            up += static_cast<double>(i) * angle.c[i] * cosine.c[n + 1 - i];
            down += static_cast<double>(i) * angle.c[i] * sine.c[n + 1 - i];
        }
        sine.c[n + 1] = up / static_cast<double>(n + 1);
        cosine.c[n + 1] = -down / static_cast<double>(n + 1);
    }
};

/// The first time in (0, end] at which a function that is negative at first is not, or NaN. A peak
/// between two of the places looked at is found by its rate.
inline double first_rise(const BellSeries& f, double level, double sign, double end) {
    constexpr int parts = 8;
    const auto value = [&](double t) { return sign * f.at(t) - level; };
    const auto rate = [&](double t) { return sign * f.rate(t); };
    const auto change = [](double low, double high, const auto& after) {
        for (int i = 0; i < 100; ++i) {
            const double middle = low + (high - low) / 2;
            if (!(middle > low && middle < high)) break;
            (after(middle) ? high : low) = middle;
        }
        return high;
    };
    for (int i = 0; i < parts; ++i) {
        const double low = end * i / parts, high = end * (i + 1) / parts;
        double top = high;
        if (value(high) < 0) {
            if (!(rate(low) > 0 && rate(high) < 0)) continue;
            top = change(low, high, [&](double t) { return !(rate(t) > 0); });
            if (value(top) < 0) continue;
        }
        return change(low, top, [&](double t) { return !(value(t) < 0); });
    }
    return std::numeric_limits<double>::quiet_NaN();
}

/// Bell and clapper as a double pendulum in a plane. `bell` is the angle of the bell to the
/// downward vertical, `clapper` that of the clapper in the bell. Unit of time: that of the fastest
/// pendulum's radian. A clapper that is turned over in the bell has its centroid above its pin.
class RingingPair {
   public:
    struct State {
        double bell, clapper, spin, swing;
    };
    struct Step {
        BellSeries bell, clapper, spin, swing, push;
        double end = 0;
    };

    RingingPair(const ByBellDatum<double>& data, bool opposite, double nudge) {
        const auto [W1, size1, k1, W2, a, h2, k2] = data;
        const double h1 = (opposite ? -size1 : size1) * (1 + nudge), f = W1 / W2;
        const double own1 = h1 * h1 + k1 * k1, own2 = h2 * h2 + k2 * k2 * (1 + 2 * nudge);
        const double inertia = own2 + f * a * a;
        pull_ = (h2 + f * a) / inertia, weight_ = h1 / own1;
        drag_ = f * a * h1 / inertia, lead_ = a * h1 / own1, share_ = f * own1 / inertia;
        apart_ = own2 / inertia + f * a * a / inertia * (k1 * k1 / own1);
        unit_ = std::max(std::abs(pull_), std::abs(weight_));
        slowest_ = std::min(std::abs(pull_), std::abs(weight_)) / unit_;
        pull_ /= unit_, weight_ /= unit_;
    }

    double rate_unit(double gravity) const { return std::sqrt(gravity * unit_); }
    /// Time up to which a motion is followed: 300 periods of the slower pendulum, at most 30,000 of
    /// the faster one.
    double longest() const { return 2000 / std::sqrt(std::max(slowest_, 1e-4)); }

    /// Angle, mouth up, at which both as one body balance with the clapper at this angle.
    double balance(double clapper) const {
        const double hold = share_ * weight_;
        return std::numbers::pi -
               std::atan2(hold * std::sin(clapper), pull_ + hold * std::cos(clapper));
    }
    /// (gravity / pendulum length) of both as one body.
    double stiffness(double clapper) const {
        const double hold = share_ * weight_;
        return std::hypot(pull_ + hold * std::cos(clapper), hold * std::sin(clapper)) /
               inertia(clapper);
    }
    /// The pair as one piece at an angle from its balance, falling from there since ever.
    State beside_balance(double clapper, double angle) const {
        return {balance(clapper) - angle, clapper,
                -2 * std::sqrt(stiffness(clapper)) * std::sin(angle / 2), 0};
    }
    /// Whether the bell pushes the clapper between two angles from the balance: the push has no
    /// minimum between them, and has the right sign at both.
    bool stays(double clapper, double low, double high) const {
        const double side = clapper > 0 ? 1 : -1;
        const auto push = [&](double angle) {
            return step(beside_balance(clapper, angle), true, 1).push;
        };
        const BellSeries first = push(low), last = push(high);
        return side * first.c[0] < 0 && side * last.c[0] < 0 && first.c[1] * last.c[1] > 0;
    }
    double inertia(double clapper) const { return 1 + share_ + 2 * drag_ * std::cos(clapper); }

    /// The motion of a clapper in free flight, or at rest in the bell.
    Step step(const State& s, bool rests, double shorter) const {
        Step r;
        BellSeries sine, cosine, sine1, cosine1, both, turn, square, square1, f1, f2, d, one, two;
        r.bell.c[0] = s.bell, r.clapper.c[0] = s.clapper, r.spin.c[0] = s.spin;
        r.swing.c[0] = s.swing;
        sine.c[0] = std::sin(s.bell), cosine.c[0] = std::cos(s.bell);
        sine1.c[0] = std::sin(s.clapper), cosine1.c[0] = std::cos(s.clapper);
        for (std::size_t n = 0; n < BellSeries::order; ++n) {
            const double next = static_cast<double>(n + 1);
            both.c[n] = sine.times(cosine1, n) + cosine.times(sine1, n);
            square.c[n] = r.spin.times(r.spin, n);
            turn.c[n] = r.spin.c[n] + r.swing.c[n];
            if (rests) {
                const double moment = pull_ * sine.c[n] + share_ * weight_ * both.c[n];
                const double of_both = -moment / inertia(s.clapper);
                r.push.c[n] = of_both * (1 + lead_ * cosine1.c[0]) +
                              lead_ * sine1.c[0] * square.c[n] + weight_ * both.c[n];
                r.spin.c[n + 1] = of_both / next;
            } else {
                square1.c[n] = turn.times(turn, n);
                f1.c[n] = drag_ * sine1.times(square1, n) - pull_ * sine.c[n];
                f2.c[n] = -lead_ * sine1.times(square, n) - weight_ * both.c[n];
                d.c[n] = (n ? 0.0 : apart_) + drag_ * lead_ * sine1.times(sine1, n);
                const auto divided = [&](const BellSeries& done, double x) {
                    for (std::size_t i = 1; i <= n; ++i) x -= d.c[i] * done.c[n - i];
                    return x / d.c[0];
                };
                one.c[n] = divided(one, f1.c[n] - drag_ * cosine1.times(f2, n));
                two.c[n] = divided(two, f2.c[n] - lead_ * cosine1.times(f1, n));
                r.spin.c[n + 1] = one.c[n] / next;
                r.swing.c[n + 1] = (two.c[n] - one.c[n]) / next;
            }
            r.bell.c[n + 1] = r.spin.c[n] / next;
            r.clapper.c[n + 1] = r.swing.c[n] / next;
            BellSeries::turn(r.bell, sine, cosine, n);
            BellSeries::turn(r.clapper, sine1, cosine1, n);
        }
        double end = 1;
        for (std::size_t n = BellSeries::order - 1; n <= BellSeries::order; ++n) {
            const double last = std::max(std::abs(r.spin.c[n]), std::abs(r.swing.c[n]));
            if (last > 0) end = std::min(end, std::pow(1e-18 / last, 1 / static_cast<double>(n)));
        }
        r.end = shorter * end;
        return r;
    }
    static State after(const Step& step, double t) {
        return {step.bell.at(t), step.clapper.at(t), step.spin.at(t), step.swing.at(t)};
    }
    /// Whether nothing moves from here, to rounding.
    bool in_balance(const Step& step, bool rests) const {
        const double least = 8 * std::numeric_limits<double>::epsilon();
        const double hold = std::abs(pull_) + std::abs(share_ * weight_);
        if (rests) return std::abs(step.spin.c[1]) * inertia(step.clapper.c[0]) <= least * hold;
        return std::abs(step.spin.c[1]) + std::abs(step.swing.c[1]) <= 4 * least / apart_;
    }

   private:
    /// Inverse pendulum lengths of the bell with the clapper's weight in its pin and of the clapper.
    double pull_, weight_;
    double drag_, lead_, share_;  ///< W1 a2 h1 over the inertia of the bell, of the clapper; ratio
    double apart_;                ///< 1 - drag lead
    double unit_, slowest_;
};

/// Angle from the balance at which a full circle begins.
inline constexpr double near_balance = 1e-4;
/// Angle at which its integration begins if it can: rounding of this one matters less.
inline constexpr double late_start = 0.0625;

/// One integration up to the first blow.
inline Strike strike_of(const BellAndClapper<double>& bell, const StrikeStart& start, double nudge,
                        double shorter) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    const double c = start.clearance * (1 + nudge);
    const double fall_from = start.amplitude.value_or(0) * (1 - nudge);
    const bool opposite = bell.inverted[0] != bell.inverted[1], circle = !start.amplitude;
    const RingingPair pair(bell.present, opposite, nudge);
    const auto at = [&] {  // of the clapper in the bell, in the sense of the bell's angle
        if (!start.clapper_angle)
            return circle ? c : std::clamp((opposite ? std::numbers::pi : 0.0) - fall_from, -c, c);
        const double angle = opposite ? *start.clapper_angle : -*start.clapper_angle;
        return std::abs(angle) == start.clearance ? std::copysign(c, angle) : angle;
    }();
    const double side = std::abs(at) == c ? std::copysign(1.0, at) : 0.0;
    double way = circle ? -1 : 0, time = 0;
    RingingPair::State s =
        circle ? pair.beside_balance(at, near_balance) : RingingPair::State{fall_from, at, 0, 0};
    // A pair that stays one piece is a simple pendulum on its separatrix: this start is passed over.
    if (circle && pair.stays(at, near_balance, late_start)) {
        s = pair.beside_balance(at, late_start);
        time = std::log(std::tan(late_start / 4) / std::tan(near_balance / 4)) /
               std::sqrt(pair.stiffness(at));
    }
    const double other_balance =
        circle ? pair.balance(at) - 2 * std::numbers::pi : -std::numeric_limits<double>::infinity();
    const auto without = [&](StrikeStatus status) {
        return Strike{status, false, none, none, none, 0};
    };

    for (bool first = true, rests = side != 0; time < pair.longest(); first = false) {
        auto step = pair.step(s, rests, shorter);
        if (rests && !(side * step.push.c[0] < 0)) {
            rests = false;
            step = pair.step(s, rests, shorter);
        }
        if (first && !circle) {
            if (pair.in_balance(step, rests)) return without(StrikeStatus::at_rest);
            const double turn = step.spin.at(step.end / 8);
            way = turn > 0 ? 1 : turn < 0 ? -1 : 0;
        }
        double until = step.end;
        enum class Event { nothing, lift, turn, touch } event = Event::nothing;
        const auto offer = [&](double t, Event kind) {
            if (t <= until) until = t, event = kind;
        };
        if (way != 0) offer(first_rise(step.spin, 0, -way, step.end), Event::turn);
        if (rests) {
            offer(first_rise(step.push, 0, side, step.end), Event::lift);
        } else {
            for (const double each : {-1.0, 1.0})
                offer(first_rise(step.clapper, c, each, step.end), Event::touch);
        }
        s = RingingPair::after(step, until), time += until;
        if (event == Event::turn) return without(StrikeStatus::turns);
        if (rests) s.clapper = at, s.swing = 0;
        if (rests && s.bell < other_balance + near_balance) return without(StrikeStatus::turns);
        if (event == Event::lift) rests = false;
        if (event != Event::touch) continue;
        const double struck = std::copysign(1.0, s.clapper);
        if (struck == side && std::abs(s.swing) < 1e-9) {
            rests = true, s.clapper = at, s.swing = 0;
            continue;
        }
        const double forward = way == 0 ? -1 : way, unit = pair.rate_unit(start.gravity);
        // one that starts upwards may go over the top and fall on the other side
        const double lowest = s.bell > std::numbers::pi ? 2 * std::numbers::pi : 0.0;
        return {StrikeStatus::strikes,    struck * forward > 0, forward * (s.bell - lowest),
                forward * s.swing * unit, time / unit,          0};
    }
    return without(StrikeStatus::too_long);
}

}  // namespace detail

inline Strike first_strike(const BellAndClapper<double>& bell, const StrikeStart& start) {
    constexpr std::string_view place = "first_strike";
    constexpr double pi = std::numbers::pi;
    if (!(start.clearance > 0 && start.clearance < pi / 2))
        detail::throw_invalid(place, "clearance must be between 0 and pi / 2", start.clearance);
    if (start.amplitude && !(*start.amplitude >= 0 && *start.amplitude <= pi))
        detail::throw_invalid(place, "amplitude must be from 0 to pi", *start.amplitude);
    if (start.clapper_angle && !(std::abs(*start.clapper_angle) <= start.clearance))
        detail::throw_invalid(place, "clapper_angle must be from -clearance to clearance",
                              *start.clapper_angle);
    if (start.clapper_angle && !start.amplitude &&
        std::abs(*start.clapper_angle) != start.clearance)
        detail::throw_invalid(place,
                              "without amplitude, clapper_angle must be clearance or -clearance",
                              *start.clapper_angle);
    if (!start.amplitude && bell.inverted[0] != bell.inverted[1])
        detail::throw_invalid(
            place, "amplitude must be given if one of bell and clapper is inverted; those inverted",
            1);
    detail::require_positive(place, "gravity", start.gravity);
    Strike found = detail::strike_of(bell, start, 0, 1);
    // Again with shorter steps and data changed by their rounding; factors are from 10,000 bells.
    const double rounding = 4 * std::numeric_limits<double>::epsilon();
    if (found.status == StrikeStatus::at_rest) return found;
    if (found.status == StrikeStatus::strikes)
        found.error_estimate = (start.amplitude ? 8 : 8 + 4 / detail::late_start) * rounding;
    double differs = 0;
    for (const double nudge : {rounding, -rounding}) {
        const Strike again = detail::strike_of(bell, start, nudge, 0.7);
        if (again.status != found.status || again.leading != found.leading)
            differs = std::numeric_limits<double>::infinity();
        else if (found.status == StrikeStatus::strikes)
            differs = std::max({differs, std::abs(again.bell_angle - found.bell_angle),
                                std::abs(again.relative_speed / found.relative_speed - 1),
                                std::abs(again.time / found.time - 1)});
    }
    found.error_estimate += 100 * differs;
    return found;
}

}  // namespace revchain
