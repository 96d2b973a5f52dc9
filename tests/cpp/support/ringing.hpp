// SPDX-License-Identifier: MPL-2.0
// The first blow of a clapper by Hamilton's equations in long double, with extrapolated midpoint steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

namespace support {

/// Angle x of the bell to the downward vertical, angle u of the clapper in the bell, momenta px, pu. Energy:
/// 2 T = m2 (h2^2 + k2^2) x'^2 + m1 [a^2 x'^2 + 2 a h1 cos u x' (x' + u') + (h1^2 + k1^2) (x' + u')^2],
/// V = -(m2 h2 + m1 a) cos x - m1 h1 cos(x + u), gravity 1. A clapper that points the other way has h1 < 0.
class RingingTruth {
   public:
    using R = long double;
    using State = std::array<R, 4>;
    struct Blow {
        std::string_view status = "too_long";
        R side = 0, way = 0, bell = 0, speed = 0, time = 0;  ///< side and way as angles of the bell count
        R closest = 1;  ///< how near a decision was to the other one: of clearance, or of the push
    };

    RingingTruth(const std::array<double, 7>& data, bool opposite, double clearance) : limit(clearance) {
        const R m1 = data[0], k1 = data[2], m2 = data[3], a = data[4], h2 = data[5], k2 = data[6];
        const R h1 = opposite ? -R(data[1]) : R(data[1]);
        own = m1 * (h1 * h1 + k1 * k1), cross = m1 * a * h1, bell = m2 * (h2 * h2 + k2 * k2) + m1 * a * a;
        down = m2 * h2 + m1 * a, swing = m1 * h1;
        unit = 1 / std::sqrt(std::max(std::abs(down) / bell, std::abs(swing) / own));
    }

    /// From rest at x, or down from the balance with the clapper at u if `circle`.
    Blow first_blow(R x, R u, bool circle) const {
        Blow result;
        const R side = std::abs(u) == limit ? std::copysign(R(1), u) : R(0), both = inertia(u)[0];
        if (circle) {
            const R line = std::hypot(down + swing * std::cos(u), swing * std::sin(u));
            const R top = std::numbers::pi_v<R> - std::atan2(swing * std::sin(u), down + swing * std::cos(u));
            const auto at = [&](R angle) {
                const R spin = -2 * std::sqrt(line / both) * std::sin(angle / 2);
                return State{top - angle, u, both * spin, inertia(u)[1] * spin};
            };
            return follow(at(R(1e-4)), side, -1, top);
        }
        State y{x, u, 0, 0};
        const bool rests = side * push(y) < 0;
        const auto r = rates(y, rests);
        if (std::abs(r[2]) + std::abs(r[3]) <= R(1e-15) * (std::abs(down) + std::abs(swing))) {
            result.status = "at_rest";
            return result;
        }
        const R w = spin(advanced(y, rests, unit / 50), rests);
        return follow(y, side, w > 0 ? 1 : w < 0 ? -1 : 0, 0);
    }
    R unit;

   private:
    R own, cross, bell, down, swing, limit;

    std::array<R, 3> inertia(R u) const {  // of both, coupled, determinant
        const R c = cross * std::cos(u);
        return {bell + own + 2 * c, own + c, bell * own - c * c};
    }
    std::array<R, 2> speeds(const State& y) const {
        const auto [both, coupled, det] = inertia(y[1]);
        return {(own * y[2] - coupled * y[3]) / det, (both * y[3] - coupled * y[2]) / det};
    }
    R spin(const State& y, bool rests) const { return rests ? y[2] / inertia(y[1])[0] : speeds(y)[0]; }
    R moment(const State& y) const { return down * std::sin(y[0]) + swing * std::sin(y[0] + y[1]); }
    R on_clapper(const State& y, R vx, R vu) const {  // -dH/du
        return -cross * std::sin(y[1]) * vx * (vx + vu) - swing * std::sin(y[0] + y[1]);
    }
    /// Moment of the bell on a clapper that rests in it.
    R push(const State& y) const {
        const auto i = inertia(y[1]);
        return -moment(y) * i[1] / i[0] - on_clapper(y, y[2] / i[0], 0);
    }
    State rates(const State& y, bool rests) const {
        const auto i = inertia(y[1]);
        const R m = moment(y);
        if (rests) return {y[2] / i[0], 0, -m, -m * i[1] / i[0]};
        const auto [vx, vu] = speeds(y);
        return {vx, vu, -m, on_clapper(y, vx, vu)};
    }
    /// One step; `error` is the change by the last column.
    State advanced(const State& y, bool rests, R h, R* error = nullptr) const {
        constexpr int columns = 8;
        std::array<std::array<State, columns>, columns> table{};
        for (int j = 0; j < columns; ++j) {
            const int n = 2 * (j + 1);
            const R step = h / n;
            const auto moved = [&](const State& from, const State& at, R by) {
                const State r = rates(at, rests);
                return State{from[0] + by * r[0], from[1] + by * r[1], from[2] + by * r[2], from[3] + by * r[3]};
            };
            State before = y, now = moved(y, y, step);
            for (int i = 1; i < n; ++i) {
                const State next = moved(before, now, 2 * step);
                before = now, now = next;
            }
            const State over = moved(before, now, step);
            for (int c = 0; c < 4; ++c) {
                table[j][0][c] = (now[c] + over[c]) / 2;
                for (int k = 1; k <= j; ++k) {
                    const R q = R(j + 1) / R(j + 1 - k);
                    table[j][k][c] = table[j][k - 1][c] + (table[j][k - 1][c] - table[j - 1][k - 1][c]) / (q * q - 1);
                }
            }
        }
        const auto& last = table[columns - 1];
        if (error != nullptr) {
            *error = 0;
            for (int c = 0; c < 4; ++c)
                *error =
                    std::max(*error, std::abs(last[columns - 1][c] - last[columns - 2][c]) / (c < 2 ? 1 : bell / unit));
        }
        return last[columns - 1];
    }
    /// When a function that is below 0 at time `low` and not at `high` reaches 0.
    template <class F>
    R root(R low, R high, const F& f) const {
        for (int i = 0; i < 90; ++i) {
            const R t = (low + high) / 2;
            if (t == low || t == high) break;
            (f(t) >= 0 ? high : low) = t;
        }
        return high;
    }
    Blow follow(State y, R side, R way, R balance) const {
        Blow result;
        result.way = way;
        R time = 0;
        const R u = y[1];
        bool rests = side != 0;
        while (time < 2000 * unit) {
            if (rests && !(side * push(y) < 0)) rests = false;
            R h = unit / 8, error = 0;
            State end = advanced(y, rests, h, &error);
            while (error > 1e-17L && h > unit / 4096) h /= 2, end = advanced(y, rests, h, &error);
            R until = h;
            char event = ' ';
            const auto at = [&](R t) { return advanced(y, rests, t); };
            // when a function that is below 0 at first is not, looking for peaks inside the step, too
            const auto offer = [&](char kind, R low, const auto& f) {
                R high = h;
                if (f(h) < 0) {
                    std::array<R, 9> value;
                    for (int i = 0; i <= 8; ++i) value[i] = f(low + (h - low) * i / 8);
                    const auto best = std::max_element(value.begin() + 1, value.end() - 1) - value.begin();
                    if (value[best] <= value[0] || value[best] <= value[8]) return;
                    R left = low + (h - low) * (best - 1) / 8, right = low + (h - low) * (best + 1) / 8;
                    for (int i = 0; i < 60; ++i) {
                        const R one = left + (right - left) / 3, two = right - (right - left) / 3;
                        (f(one) < f(two) ? left : right) = f(one) < f(two) ? one : two;
                    }
                    high = (left + right) / 2;
                    result.closest = std::min(result.closest, std::abs(f(high)));
                    if (f(high) < 0) return;
                }
                const R t = root(low, high, f);
                if (t <= until) until = t, event = kind;
            };
            const R slow = R(0.05) / unit;
            if (way != 0 && (way * spin(end, rests) < slow || time == 0))
                offer('b', time == 0 ? h / 64 : 0, [&](R t) { return -way * spin(at(t), rests); });
            if (rests) {
                offer('l', 0, [&](R t) { return side * push(at(t)); });
            } else {
                for (const R s : {R(-1), R(1)})
                    if (s * end[1] > limit - R(0.1)) offer('t', 0, [&](R t) { return s * at(t)[1] - limit; });
            }
            y = at(until), time += until;
            if (rests) y[1] = u, y[3] = inertia(u)[1] * y[2] / inertia(u)[0];
            if (event == 'b' || (rests && balance != 0 && y[0] < balance - 2 * std::numbers::pi_v<R> + R(1e-4))) {
                result.status = "turns";
                return result;
            }
            if (event == 'l') rests = false;
            if (event != 't') continue;
            result.status = "strikes", result.side = std::copysign(R(1), y[1]);
            result.bell = y[0], result.speed = speeds(y)[1], result.time = time;
            return result;
        }
        return result;
    }
};

}  // namespace support
