// SPDX-License-Identifier: MPL-2.0
// Chains held at both ends on arms and springs: against the bodies' Lagrangian in quadruple precision, limits, refusals.
#include "revchain/held.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

namespace {

using revchain::Chain;
using revchain::Held;
using revchain::HeldBy;
using revchain::HeldShape;
using revchain::Index;
using revchain::Support;
using support::Quad;
using support::quad;

using Rows = std::vector<std::vector<Quad>>;

/// Solves by Gauss and Jordan; the last column is the right side, and then the solution.
void solve_rows(Rows& A) {
    const std::size_t size = A.size();
    for (std::size_t k = 0; k < size; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k; i < size; ++i)
            if (fabsq(A[i][k]) > fabsq(A[pivot][k])) pivot = i;
        std::swap(A[k], A[pivot]);
        for (std::size_t i = 0; i < size; ++i) {
            if (i == k) continue;
            const Quad share = A[i][k] / A[k][k];
            for (std::size_t j = k; j <= size; ++j) A[i][j] -= share * A[k][j];
        }
    }
    for (std::size_t k = 0; k < size; ++k) A[k][size] /= A[k][k];
}

/// Newton's method in quadruple precision on the offset of the lower end, all inclinations, and the forces that hold the
/// upper end along the axis and firm ends across it, from a shape found: the potential energy and that of the springs
/// less half of y^2 over all mass. Returns the largest difference of an inclination.
double against_truth(const Chain<double>& chain, const HeldBy& by, const HeldShape& shape) {
    const auto n = static_cast<std::size_t>(chain.size()), angles = n + 1, size = n + 4;  // y_0, angles, three forces
    std::vector<Quad> x(size, 0);
    x[0] = shape.offset[0];
    for (std::size_t m = 0; m < n; ++m) x[m + 1] = shape.inclination[static_cast<Index>(m)];
    x[angles] = shape.upper_pull[1], x[angles + 1] = shape.lower_pull[0], x[angles + 2] = shape.upper_pull[0];
    const Quad lambda = shape.conical_height, span = shape.span;
    for (int round = 0; round < 8; ++round) {
        Rows A(size, std::vector<Quad>(size + 1, 0));
        std::vector<Quad> dy(angles), dz(angles), body_y(angles), body_z(angles);
        Quad y = x[0], z = 0;
        dy[0] = 1;
        const auto spring = [&](const Support& end, Quad at) {  // on an offset with the changes dy
            const Quad stiffness = lambda * Quad(end.stiffness), carriage = end.carriage_weight;
            const Quad force = stiffness * (at - Quad(end.radius)) - carriage * at;
            for (std::size_t j = 0; j < angles; ++j) {
                A[j][size] += force * dy[j];
                for (std::size_t k = 0; k < angles; ++k) A[j][k] += (stiffness - carriage) * dy[j] * dy[k];
            }
            return force;
        };
        Quad bent = 0;  // force at the upper end that second changes of its offset meet
        if (!by.lower.is_firm()) spring(by.lower, y);
        for (std::size_t m = 0; m < n; ++m) {
            const auto link = chain.link(static_cast<Index>(m));
            const Quad W = link.weight, a = link.length, h = link.centroid, turn = quad(link.gyration_ratio) * a * a;
            const Quad s = sinq(x[m + 1]), c = cosq(x[m + 1]);
            body_y = dy, body_z = dz;
            body_y[m + 1] = -(a - h) * c, body_z[m + 1] = -(a - h) * s;
            const Quad at = y - (a - h) * s;
            for (std::size_t j = 0; j < angles; ++j) {
                A[j][size] += W * (lambda * body_z[j] - at * body_y[j]);
                for (std::size_t k = 0; k < angles; ++k) A[j][k] -= W * body_y[j] * body_y[k];
            }
            for (std::size_t j = 1; j <= m + 1; ++j) {  // second changes of the centroid
                const Quad sine = sinq(x[j]), cosine = cosq(x[j]);
                const Quad arm = j == m + 1 ? a - h : Quad(chain.link(static_cast<Index>(j - 1)).length);
                A[j][j] += W * (lambda * -arm * cosine - at * arm * sine);
            }
            A[m + 1][size] -= W * turn * s * c, A[m + 1][m + 1] -= W * turn * (c * c - s * s);
            y -= a * s, z += a * c;
            dy[m + 1] = -a * c, dz[m + 1] = -a * s;
        }
        if (!by.upper.is_firm()) bent = spring(by.upper, y);
        const auto second = [&](Quad across, Quad along) {
            for (std::size_t j = 1; j < angles; ++j) {
                const Quad a = chain.link(static_cast<Index>(j - 1)).length;
                A[j][j] += across * a * sinq(x[j]) - along * a * cosq(x[j]);
            }
        };
        second(bent, 0);
        const auto hold = [&](std::size_t row, bool held, const std::vector<Quad>& change, Quad gap) {
            if (!held) {
                A[row][row] = 1, A[row][size] = x[row];
                return;
            }
            A[row][size] = gap;
            for (std::size_t j = 0; j < angles; ++j)
                A[row][j] += change[j], A[j][row] += change[j], A[j][size] += x[row] * change[j];
        };
        std::vector<Quad> foot(angles, 0);
        foot[0] = 1;
        hold(angles, true, dz, z - span), second(0, x[angles]);
        hold(angles + 1, by.lower.is_firm(), foot, x[0] - Quad(by.lower.radius));
        hold(angles + 2, by.upper.is_firm(), dy, y - Quad(by.upper.radius));
        if (by.upper.is_firm()) second(x[angles + 2], 0);
        solve_rows(A);
        for (std::size_t k = 0; k < size; ++k) x[k] -= A[k][size];
    }
    double worst = 0;
    for (std::size_t m = 0; m < n; ++m)
        worst =
            std::max(worst, std::abs(static_cast<double>(x[m + 1] - Quad(shape.inclination[static_cast<Index>(m)]))));
    return worst;
}

Support random_end(support::Random& random, double length, double weight, double height) {
    Support end{.radius = random.between(-0.25, 0.25) * length};
    const double kind = random.between(0, 4);
    if (kind < 1) end.radius = 0;
    if (kind > 2) return end;
    end.stiffness = weight / height * std::exp(random.between(-1, 6));
    end.carriage_weight = kind > 1.5 ? 0 : random.between(0, 0.5) * weight;
    return end;
}

}  // namespace

TEST_CASE("held on arms and springs: 10,000 random systems within their proved bound") {
    support::Random random(20);
    int systems = 0, shapes = 0, sharp = 0, unproved = 0;
    double worst = 0, largest = 0;
    while (systems < 10'000) {
        const auto size = static_cast<Index>(random.between(2, 7));
        const Chain<double> chain = support::chain_of(size, [&](Index) {
            const double weight = random.between(0.2, 2), length = random.between(0.2, 2), kind = random.between(0, 3);
            if (kind < 1) return revchain::plummet(weight, length);
            if (kind < 2) return revchain::uniform_rod(weight, length);
            return revchain::compound_pendulum<double>({.weight = weight,
                                                        .length = length,
                                                        .centroid = random.between(0.1, 1.0) * length,
                                                        .radius_of_gyration = random.between(0.1, 0.5) * length});
        });
        const double length = chain.total_length(), height = std::exp(random.between(-6, 0)) * length;
        HeldBy by{.span = random.between(0.1, 0.9) * length};
        by.lower = random_end(random, length, chain.total_weight(), height);
        by.upper = random_end(random, length, chain.total_weight(), height);
        if (by.firm() && std::hypot(*by.span, by.upper.radius - by.lower.radius) >= length) continue;
        ++systems;
        const auto found = revchain::steady_shapes(
            Held(chain, by), {.conical_height = height, .max_half_waves = 2, .prove = true, .budget = 0});
        for (const HeldShape& shape : found.shapes) {
            const double error = against_truth(chain, by, shape);
            ++shapes, unproved += !shape.proved;
            sharp += shape.error_bound < 9e-16;
            if (shape.proved) worst = std::max(worst, error / shape.error_bound);
            if (shape.proved) largest = std::max(largest, error);
            INFO("system " << systems << ", " << size << " links, height " << height);
            if (shape.proved) CHECK(error <= shape.error_bound);
        }
    }
    CAPTURE(systems, shapes, sharp, unproved, worst, largest);
    CHECK(worst <= 1);
    CHECK(shapes > 10'000);
    CHECK(unproved < shapes / 500);
    CHECK(sharp > 0.95 * shapes);
}
