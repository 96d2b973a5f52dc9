// SPDX-License-Identifier: MPL-2.0
// Shapes of chains held at both ends against the bodies' Lagrangian in quadruple precision.
#pragma once

#include "revchain/held.hpp"
#include "support/solved.hpp"
#include "support/truth.hpp"

namespace support {

/// Newton's method in quadruple precision on the offset of the lower end, all inclinations, and the forces that hold the
/// upper end along the axis and firm ends across it, from a shape found: the potential energy and that of the springs
/// less half of y^2 over all mass. Returns the largest difference of an inclination.
inline double held_against_truth(const revchain::Chain<double>& chain, const revchain::HeldBy& by,
                                 const revchain::HeldShape& shape) {
    const auto n = static_cast<std::size_t>(chain.size()), angles = n + 1, size = n + 4;  // y_0, angles, three forces
    std::vector<Quad> x(size, 0);
    x[0] = shape.offset[0];
    for (std::size_t m = 0; m < n; ++m) x[m + 1] = shape.inclination[static_cast<revchain::Index>(m)];
    x[angles] = shape.upper_pull[1], x[angles + 1] = shape.lower_pull[0], x[angles + 2] = shape.upper_pull[0];
    const Quad lambda = shape.conical_height, span = shape.span;
    for (int round = 0; round < 8; ++round) {
        std::vector<Numbers<Quad>> A(size, Numbers<Quad>(size, 0));
        Numbers<Quad> b(size, 0);
        std::vector<Quad> dy(angles), dz(angles), body_y(angles), body_z(angles);
        Quad y = x[0], z = 0;
        dy[0] = 1;
        const auto spring = [&](const revchain::Support& end, Quad at) {  // on an offset with the changes dy
            const Quad stiffness = lambda * quad(end.stiffness), carriage = end.carriage_weight;
            const Quad force = stiffness * (at - Quad(end.radius)) - carriage * at;
            for (std::size_t j = 0; j < angles; ++j) {
                b[j] += force * dy[j];
                for (std::size_t k = 0; k < angles; ++k) A[j][k] += (stiffness - carriage) * dy[j] * dy[k];
            }
            return force;
        };
        Quad bent = 0;  // force at the upper end that second changes of its offset meet
        if (!by.lower.is_firm()) spring(by.lower, y);
        for (std::size_t m = 0; m < n; ++m) {
            const auto link = chain.link(static_cast<revchain::Index>(m));
            const Quad W = link.weight, a = link.length, h = link.centroid, turn = quad(link.gyration_ratio) * a * a;
            const Quad s = sinq(x[m + 1]), c = cosq(x[m + 1]);
            body_y = dy, body_z = dz;
            body_y[m + 1] = -(a - h) * c, body_z[m + 1] = -(a - h) * s;
            const Quad at = y - (a - h) * s;
            for (std::size_t j = 0; j < angles; ++j) {
                b[j] += W * (lambda * body_z[j] - at * body_y[j]);
                for (std::size_t k = 0; k < angles; ++k) A[j][k] -= W * body_y[j] * body_y[k];
            }
            for (std::size_t j = 1; j <= m + 1; ++j) {  // second changes of the centroid
                const Quad sine = sinq(x[j]), cosine = cosq(x[j]);
                const Quad arm = j == m + 1 ? a - h : Quad(chain.link(static_cast<revchain::Index>(j - 1)).length);
                A[j][j] += W * (lambda * -arm * cosine - at * arm * sine);
            }
            b[m + 1] -= W * turn * s * c, A[m + 1][m + 1] -= W * turn * (c * c - s * s);
            y -= a * s, z += a * c;
            dy[m + 1] = -a * c, dz[m + 1] = -a * s;
        }
        if (!by.upper.is_firm()) bent = spring(by.upper, y);
        const auto second = [&](Quad across, Quad along) {
            for (std::size_t j = 1; j < angles; ++j) {
                const Quad a = chain.link(static_cast<revchain::Index>(j - 1)).length;
                A[j][j] += across * a * sinq(x[j]) - along * a * cosq(x[j]);
            }
        };
        second(bent, 0);
        const auto hold = [&](std::size_t row, bool held, const std::vector<Quad>& change, Quad gap) {
            if (!held) {
                A[row][row] = 1, b[row] = x[row];
                return;
            }
            b[row] = gap;
            for (std::size_t j = 0; j < angles; ++j)
                A[row][j] += change[j], A[j][row] += change[j], b[j] += x[row] * change[j];
        };
        std::vector<Quad> foot(angles, 0);
        foot[0] = 1;
        hold(angles, true, dz, z - span), second(0, x[angles]);
        hold(angles + 1, by.lower.is_firm(), foot, x[0] - Quad(by.lower.radius));
        hold(angles + 2, by.upper.is_firm(), dy, y - Quad(by.upper.radius));
        if (by.upper.is_firm()) second(x[angles + 2], 0);
        const auto change = solved(std::move(A), std::move(b));
        for (std::size_t k = 0; k < size; ++k) x[k] -= change.value()[k];
    }
    double worst = 0;
    for (std::size_t m = 0; m < n; ++m)
        worst = std::max(
            worst, std::abs(static_cast<double>(x[m + 1] - Quad(shape.inclination[static_cast<revchain::Index>(m)]))));
    return worst;
}

}  // namespace support
