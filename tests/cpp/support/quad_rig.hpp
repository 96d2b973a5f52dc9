// SPDX-License-Identifier: MPL-2.0
// A whirling rig in quadruple precision, body by body: forces and angular momenta as vectors in the turning plane, the
// torque on each link about its upper pin, the force on the carriage; Newton's method on all of it by differences. No
// formula of the library is in it.
#pragma once

#include <optional>
#include <vector>

#include "revchain/rig.hpp"
#include "support/truth.hpp"

namespace support {

class QuadRig {
   public:
    struct State {
        std::vector<Quad> inclination;
        Quad top = 0;  // offset of the topmost pin
    };
    struct Balance {
        std::vector<Quad> torque;             // on each link; last, of a support that yields, the force on its carriage
        std::vector<Quad> sideways, upright;  // force with which each upper pin holds what hangs there
        Quad inertia = 0, energy = 0;         // about the axis, times gravity; potential, less what turning does
        Quad worst = 0;                       // of the torques, over weight times length, and of the force, over weight
    };

    QuadRig(const revchain::Rig& rig, Quad speed, Quad gravity) : rig_(rig), speed_(speed), gravity_(gravity) {}

    bool yields() const { return !rig_.support().is_firm(); }

    Balance balance(const State& at) const {
        const revchain::Index n = rig_.size();
        Balance result;
        std::vector<Quad> y(static_cast<std::size_t>(n) + 1, at.top), height(y.size(), 0);
        for (revchain::Index m = n; m-- > 0;) {
            const Quad a = rig_.chain().link(m).length, d = at.inclination[index(m)];
            y[index(m)] = y[index(m) + 1] + a * sinq(d), height[index(m)] = height[index(m) + 1] - a * cosq(d);
        }
        Quad Fx = 0, Fz = 0, weight = 0;  // on the lower pin, from below
        for (revchain::Index m = 0; m < n; ++m) {
            const auto link = rig_.chain().link(m);
            const Quad a = link.length, d = at.inclination[index(m)];
            const Quad ex = -sinq(d), ez = cosq(d);  // along the link, from its lower pin to its upper
            Quad torque = -a * ez * Fx + a * ex * Fz, force_x = Fx, force_z = Fz, momentum_x = 0;
            for (const Body& body : bodies(m)) {
                const Quad gx = y[index(m) + 1] - body.centroid * ex, x = -body.centroid * ex, z = -body.centroid * ez;
                const Quad outwards = body.moves / gravity_ * speed_ * speed_ * gx, down = -body.bears;
                result.inertia += body.moves * (gx * gx + body.gyration * ex * ex);
                result.energy += body.bears * (height[index(m) + 1] + z);
                torque += z * outwards - x * down, force_x += outwards, force_z += down;
                // turned with the speed (0, 0, n), less what is along the link
                const Quad along = speed_ * ez, across_x = -along * ex;
                momentum_x += body.moves / gravity_ * body.gyration * across_x;
            }
            const auto wheel = rig_.flywheel(m);
            momentum_x += (quad(wheel.momentum) + quad(wheel.axial_moment) / gravity_ * speed_ * ez) * ex;
            result.inertia += quad(wheel.axial_moment) * ez * ez;
            result.energy -= speed_ * quad(wheel.momentum) * ez;
            torque -= speed_ * momentum_x;  // of (0, 0, n) x momentum
            result.torque.push_back(torque);
            Fx = force_x, Fz = force_z;
            result.sideways.push_back(-Fx), result.upright.push_back(-Fz);
            weight += Quad(link.weight);
        }
        const Quad scale = weight * Quad(rig_.chain().total_length());
        for (const Quad torque : result.torque) result.worst = std::max(result.worst, fabsq(torque) / scale);
        if (yields()) {
            const auto& support = rig_.support();
            const Quad drawn = at.top - Quad(support.radius);
            result.inertia += Quad(support.carriage_weight) * at.top * at.top;
            result.energy += quad(support.stiffness) * drawn * drawn / 2;
            const Quad force = Fx + Quad(support.carriage_weight) / gravity_ * speed_ * speed_ * at.top -
                               quad(support.stiffness) * (at.top - Quad(support.radius));
            result.torque.push_back(force), result.worst = std::max(result.worst, fabsq(force) / weight);
        }
        result.energy -= result.inertia / gravity_ * speed_ * speed_ / 2;
        return result;
    }

    /// The steady state that Newton's method leads to, if any.
    std::optional<State> settled(State at) const {
        if (!yields()) at.top = rig_.support().radius;
        const std::size_t size = at.inclination.size() + (yields() ? 1 : 0);
        const auto unknown = [&](State& state, std::size_t i) -> Quad& {
            return i < state.inclination.size() ? state.inclination[i] : state.top;
        };
        for (int round = 0; round < 60; ++round) {
            std::vector<std::vector<Quad>> rows(size);
            std::vector<Quad> left = balance(at).torque;
            const Quad step = 1e-13;
            for (std::size_t j = 0; j < size; ++j) {
                State more = at, less = at;
                unknown(more, j) += step, unknown(less, j) -= step;
                const auto up = balance(more).torque, down = balance(less).torque;
                for (std::size_t i = 0; i < size; ++i) rows[i].push_back((up[i] - down[i]) / (2 * step));
            }
            if (!solve(rows, left)) return std::nullopt;
            Quad largest = 0;
            for (const Quad x : left) largest = std::max(largest, fabsq(x));
            const Quad share = largest > 1 ? 1 / largest : Quad(1);
            for (std::size_t i = 0; i < size; ++i) unknown(at, i) -= share * left[i];
            if (!(largest < 1e100)) return std::nullopt;
            if (largest < 1e-27) return at;
        }
        return std::nullopt;
    }

   private:
    struct Body {
        Quad bears, moves, centroid, gyration;  // gyration: radius squared
    };
    static std::size_t index(revchain::Index m) { return static_cast<std::size_t>(m); }

    std::vector<Body> bodies(revchain::Index m) const {
        const auto link = rig_.chain().link(m);
        const auto fluid = rig_.displaced(m);
        const Quad square = Quad(link.length) * Quad(link.length), borne = fluid.weight;
        const bool turning = rig_.fluid() == revchain::Fluid::turning;
        return {
            {link.weight, link.weight, link.centroid, quad(link.gyration_ratio) * square},
            {-borne, turning ? -borne : Quad(fluid.added_weight), fluid.centroid, quad(fluid.gyration_ratio) * square}};
    }

    static bool solve(std::vector<std::vector<Quad>>& a, std::vector<Quad>& x) {
        const std::size_t n = x.size();
        for (std::size_t j = 0; j < n; ++j) {
            std::size_t pivot = j;
            for (std::size_t i = j + 1; i < n; ++i)
                if (fabsq(a[i][j]) > fabsq(a[pivot][j])) pivot = i;
            if (!(fabsq(a[pivot][j]) > 0)) return false;
            std::swap(a[j], a[pivot]), std::swap(x[j], x[pivot]);
            for (std::size_t i = 0; i < n; ++i) {
                if (i == j) continue;
                const Quad share = a[i][j] / a[j][j];
                for (std::size_t r = j; r < n; ++r) a[i][r] -= share * a[j][r];
                x[i] -= share * x[j];
            }
        }
        for (std::size_t j = 0; j < n; ++j) x[j] /= a[j][j];
        return true;
    }

    const revchain::Rig& rig_;
    Quad speed_, gravity_;
};

}  // namespace support
