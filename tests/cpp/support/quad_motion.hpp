// SPDX-License-Identifier: MPL-2.0
// Small motions about a steady shape of a rig, in still fluid or none, with ball joints: second differences of
// Lagrange's function in quadruple precision.
#pragma once

#include "support/rig_equations.hpp"

namespace support {

/// Seen from the turning frame. Coordinates: inclinations in the plane of the shape, those out of it, and behind each
/// the offset of a support that yields. Links keep the angular momentum about their own axes.
class QuadMotion {
   public:
    using Vector = std::array<Quad, 3>;

    /// Place: inclinations, then that support's offset.
    QuadMotion(const Rig& rig, Numbers<Quad> place, Quad speed, Quad gravity = 9.80665)
        : data_(rig), rest_(std::move(place)), speed_(speed), gravity_(gravity) {
        if (data_.yields && !(data_.carriage > 0)) data_.carriage = 1e-30;  // it may move by itself
    }
    std::size_t size() const { return 2 * data_.unknowns(); }

    /// M a'' + G a' + K a = 0, times in 1/n.
    struct Matrices {
        std::vector<Numbers<Quad>> M, G, K;
    };
    Matrices matrices() const {
        const std::size_t n = size();
        const Quad step = 1e-6;
        Matrices result;
        for (auto* matrix : {&result.M, &result.G, &result.K}) matrix->assign(n, Numbers<Quad>(n, 0));
        const auto second = [&](const auto& function) {  // two steps, extrapolated: an error of step^4
            const auto of = [&](Quad h) {
                Quad sum = 0;
                for (const int p : {1, -1})
                    for (const int q : {1, -1}) sum += p * q * function(p * h, q * h);
                return sum / (4 * h * h);
            };
            return (4 * of(step) - of(2 * step)) / 3;
        };
        const Numbers<Quad> zero(n, 0);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) {
                const auto moved = [&](Quad x, Quad y) {
                    Numbers<Quad> a = zero;
                    a[i] += x, a[j] += y;
                    return a;
                };
                const auto at = [&](std::size_t k, Quad x) {
                    Numbers<Quad> a = zero;
                    a[k] = x;
                    return a;
                };
                if (j <= i) {
                    result.M[i][j] = result.M[j][i] =
                        second([&](Quad x, Quad y) { return lagrangian(zero, moved(x, y)); }) * speed_ * speed_;
                    result.K[i][j] = result.K[j][i] =
                        -second([&](Quad x, Quad y) { return lagrangian(moved(x, y), zero); });
                }
                const Quad mixed = second([&](Quad x, Quad y) { return lagrangian(at(j, y), at(i, x)); });
                result.G[i][j] += mixed * speed_, result.G[j][i] -= mixed * speed_;
            }
        return result;
    }

   private:
    Quad lagrangian(const Numbers<Quad>& a, const Numbers<Quad>& rate) const {
        const std::size_t links = data_.size(), all = data_.unknowns();
        std::vector<Vector> e(links + 1), f(links + 1);
        for (std::size_t m = 0; m < links; ++m) {
            const Quad s = sinq(rest_[m] + a[m]), c = cosq(rest_[m] + a[m]), so = sinq(a[all + m]),
                       co = cosq(a[all + m]);
            const Quad u = rate[m], v = rate[all + m];
            e[m] = {s * co, so, -c * co};
            f[m] = {c * co * u - s * so * v, co * v, s * co * u + c * so * v};
        }
        const Quad top = data_.yields ? rest_[links] : data_.radius;
        e[links] = {top, 0, 0};
        if (data_.yields)
            e[links][0] += a[links], e[links][1] = a[all + links], f[links] = {rate[links], rate[all + links], 0};
        Quad sum = 0;
        for (const auto& body : data_.bodies) {
            Vector place = e[links], moves = f[links];
            for (std::size_t r = body.link; r < links; ++r)
                for (std::size_t k = 0; k < 3; ++k) {
                    const Quad arm = r == body.link ? body.depth : data_.a[r];
                    place[k] += arm * e[r][k], moves[k] += arm * f[r][k];
                }
            sum +=
                body.moves / (2 * gravity_) * (kinetic(place, moves) + body.turn * kinetic(e[body.link], f[body.link]));
            sum -= body.bears * place[2];
        }
        for (std::size_t m = 0; m < links; ++m) {
            const Quad kept = data_.momentum[m] + data_.axial[m] / gravity_ * speed_ * cosq(rest_[m]);
            if (kept == 0) continue;
            const auto& [x, y, z] = e[m];
            // z times the rate of the azimuth, but for a constant times that rate: then nothing is singular upright
            const Quad turned = x * f[m][1] - y * f[m][0];
            sum -= kept * ((cosq(rest_[m]) > 0 ? turned / (1 - z) : -turned / (1 + z)) + z * speed_);
        }
        if (data_.yields) {
            const auto& [x, y, z] = e[links];
            sum += data_.carriage / (2 * gravity_) * kinetic(e[links], f[links]);
            sum -= data_.stiffness / 2 * ((x - data_.radius) * (x - data_.radius) + y * y);
        }
        return sum;
    }
    Quad kinetic(const Vector& place, const Vector& rate) const {
        const Quad x = rate[0] - speed_ * place[1], y = rate[1] + speed_ * place[0];
        return x * x + y * y + rate[2] * rate[2];
    }
    RigData<Quad> data_;
    Numbers<Quad> rest_;
    Quad speed_, gravity_;
};

}  // namespace support
