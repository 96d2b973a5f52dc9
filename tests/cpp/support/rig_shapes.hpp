// SPDX-License-Identifier: MPL-2.0
// Checks of the steady shapes of rigs: torques on the bodies as vectors in quadruple precision, whose zeros Newton's
// method finds from random starts (support/quad_rig.hpp); a sweep in long double, scanned for changes of sign. Error: the
// largest of an inclination, rad. A zero that is not in the list is a failure, whatever found it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "revchain/conical_pendulum.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/quad_rig.hpp"

namespace support::rig_shapes {

using revchain::Chain;
using revchain::Index;
using revchain::plummet;
using revchain::Rig;
using revchain::SteadyShape;
using revchain::SteadyShapes;

inline constexpr double gravity = revchain::conical_pendulum::standard_gravity;

inline QuadRig truth_of(const Rig& rig, double height, int sense = 1) {
    return {rig, sense * sqrtq(Quad(gravity) / Quad(height)), gravity};
}

/// The direction of rotation of a sign.
inline revchain::Rotation turning(int sense) {
    return sense > 0 ? revchain::Rotation::forward : revchain::Rotation::backward;
}

inline Quad apart(Quad x, Quad y) { return fabsq(remainderq(x - y, 8 * atanq(1))); }

/// Largest difference of inclinations.
inline Quad apart(const SteadyShape& shape, const QuadRig::State& state, int sign = 1) {
    Quad worst = 0;
    for (Index m = 0; m < shape.inclination.size(); ++m)
        worst = std::max(worst, apart(shape.inclination[m], sign * state.inclination[static_cast<std::size_t>(m)]));
    return worst;
}

inline QuadRig::State state_of(const SteadyShape& shape) {
    QuadRig::State state;
    for (const double d : shape.inclination) state.inclination.push_back(d);
    state.top = shape.offset[shape.offset.size() - 1];
    return state;
}

struct Measured {
    double error = 0, relative = 0, residual = 0, bound = 0;  // relative: error beyond 1e-16, over condition
    long shapes = 0, lists = 0, incomplete = 0;
};

/// Reactions, energy, moment of inertia, over the sizes of what they are sums of.
inline void check_forces(const Rig& rig, const QuadRig::Balance& exact, const SteadyShape& shape) {
    const Index n = rig.size();
    for (Index m = 0; m < n; ++m) {
        const Quad x = exact.sideways[static_cast<std::size_t>(m)], z = exact.upright[static_cast<std::size_t>(m)];
        const Quad size = hypotq(x, z), tension = shape.tension[m], phi = shape.reaction_inclination[m];
        const double weight = rig.chain().total_weight();
        CHECK(fabsq(tension - size) <= 1e-14 * (size + weight));
        // the pin's pull is towards the axis where the chain's is away from it
        CHECK(fabsq(tension * sinq(phi) + x) <= 1e-14 * (size + weight));
        CHECK(fabsq(tension * cosq(phi) - z) <= 1e-14 * (size + weight));
    }
    CHECK(fabsq(exact.inertia - shape.moment_of_inertia) <= 1e-14 * fabsq(exact.inertia));
    const Quad size = fabsq(exact.energy) + rig.chain().total_weight() * rig.chain().total_length() +
                      fabsq(exact.inertia) / shape.conical_height;
    CHECK(fabsq(exact.energy - shape.effective_energy) <= 1e-15 * size);
}

/// Every shape of a list is one, within its bound.
inline void check_shapes(const Rig& rig, double height, const SteadyShapes& found, int sense, Measured& measured) {
    const QuadRig truth = truth_of(rig, height, sense);
    ++measured.lists, measured.incomplete += !found.undecided.empty();
    for (const SteadyShape& shape : found.shapes) {
        ++measured.shapes;
        CHECK(truth.balance(state_of(shape)).worst <= 1e-14);
        const auto exact = truth.settled(state_of(shape));
        REQUIRE(exact);
        check_forces(rig, truth.balance(*exact), shape);
        const double off = static_cast<double>(apart(shape, *exact));
        CHECK(off <= shape.error_bound);
        measured.error = std::max(measured.error, off);
        measured.residual = std::max(measured.residual, shape.residual);
        measured.bound = std::max(measured.bound, shape.error_bound);
        const Index n = rig.size();
        Quad y = exact->top;
        const double reach = rig.chain().total_length() + std::abs(shape.offset[n]);
        CHECK(fabsq(y - shape.offset[n]) <= 1e-15 * reach);
        for (Index m = n; m-- > 0;) {
            y += Quad(rig.chain().link(m).length) * sinq(exact->inclination[static_cast<std::size_t>(m)]);
            CHECK(fabsq(y - shape.offset[m]) <= 1e-15 * reach);
        }
        if (rig.support().radius == 0) CHECK(shape.offset[0] > -1e-20);
    }
}

inline bool listed(const SteadyShapes& found, const QuadRig::State& state, bool symmetric) {
    return std::any_of(found.shapes.begin(), found.shapes.end(), [&](const SteadyShape& shape) {
        return apart(shape, state) <= 1e-12 || (symmetric && apart(shape, state, -1) <= 1e-12);
    });
}

/// No zero that Newton's method finds from random starts is missing.
inline void check_by_random_starts(const Rig& rig, double height, const SteadyShapes& found, int sense, int starts,
                                   Random& random, long& met) {
    if (!found.undecided.empty()) return;
    const QuadRig truth = truth_of(rig, height, sense);
    const bool symmetric = rig.support().radius == 0;
    for (int i = 0; i < starts; ++i) {
        QuadRig::State start;
        for (Index m = 0; m < rig.size(); ++m) start.inclination.push_back(random.between(-3.15, 3.15));
        start.top = random.between(-2, 2);
        const auto state = truth.settled(start);
        if (!state) continue;
        Quad steepest = 0;
        for (const Quad d : state->inclination) steepest = std::max(steepest, fabsq(sinq(d)));
        if (symmetric && steepest < 1e-9) continue;
        ++met;
        const bool known = listed(found, *state, symmetric);
        if (!known) {
            CAPTURE(static_cast<double>(state->top), static_cast<double>(state->inclination[0]));
            CHECK(known);
        }
    }
}

inline Chain<double> random_chain(Index size, Random& random) {
    return support::chain_of(size, [&](Index) {
        const double W = random.log_between(0.2, 5), a = random.log_between(0.3, 3);
        const double kind = random();
        if (kind < 0.4) return plummet<double>(W, a);
        if (kind < 0.6) return revchain::uniform_rod<double>(W, a);
        return revchain::compound_pendulum<double>({.weight = W,
                                                    .length = a,
                                                    .centroid = a * random.between(0.2, 0.9),
                                                    .radius_of_gyration = a * random.between(0.1, 0.7)});
    });
}

/// How far the topmost pin of hanging links misses its place in the axis or out of it, by Greenhill's sweep.
struct Sweep {
    const Rig& rig;
    long double lambda;

    long double operator()(long double t1, std::vector<double>* inclinations = nullptr, double* top = nullptr) const {
        long double y = 0, H = 0, S = 0;
        for (Index m = 0; m < rig.size(); ++m) {
            const auto link = rig.chain().link(m);
            const long double W = link.weight, a = link.length, h = link.centroid;
            const long double rho2 = static_cast<long double>(static_cast<double>(link.gyration_ratio)) * a * a;
            const long double n_H =
                std::sqrt(static_cast<long double>(gravity) / lambda) * rig.flywheel(m).momentum.high;
            const long double pull = lambda * (S + (W * h + n_H) / a), turn = W * h / a * (a - h - rho2 / h);
            long double t = t1;
            if (m > 0) {
                const long double R = H + W * h / a * y;
                t = turn > 0 ? R / (pull + turn) : R / pull;
                for (int i = 0; i < 100; ++i) {
                    const long double c = 1 / std::sqrt(1 + t * t), f = R - pull * t - turn * t * c;
                    const long double step = f / (pull + turn * c * c * c);
                    t += step;
                    if (std::abs(step) <= 1e-18L * std::abs(t)) break;
                }
            } else {
                y = (pull * t + turn * t / std::sqrt(1 + t * t)) / (W * h / a);
            }
            if (inclinations) inclinations->push_back(static_cast<double>(std::atan(t)));
            const long double s = t / std::sqrt(1 + t * t);
            y -= a * s;
            H += W * (y + h * s), S += W;
        }
        if (top) *top = static_cast<double>(y);
        const auto& support = rig.support();
        const long double pulled =
            support.is_firm() ? 0 : (H + support.carriage_weight * y) / (lambda * support.stiffness.high);
        return y - support.radius - pulled;
    }
};

/// Hanging shapes by changes of sign over tangents even in the angle and in the logarithm: never more than the list.
inline int check_by_scan(const Rig& rig, double height, const SteadyShapes& found, int steps) {
    const Sweep miss{rig, height};
    const QuadRig truth = truth_of(rig, height);
    std::vector<long double> tangents;
    for (int i = 0; i < steps; ++i) {
        tangents.push_back(std::tan(1.57079632L * (i + 0.5L) / steps));
        tangents.push_back(1e8L * std::pow(10.0L, -18 * (i + 0.5L) / steps));
    }
    const bool symmetric = rig.support().radius == 0;
    if (!symmetric)
        for (int i = 0; i < 2 * steps; ++i) tangents.push_back(-tangents[static_cast<std::size_t>(i)]);
    std::sort(tangents.begin(), tangents.end());
    int count = 0;
    for (std::size_t i = 1; i < tangents.size(); ++i) {
        long double low = tangents[i - 1], high = tangents[i];
        const bool rises = miss(low) < 0;
        if (rises == (miss(high) < 0)) continue;
        for (int j = 0; j < 70; ++j) {
            const long double middle = (low + high) / 2;
            ((miss(middle) < 0) == rises ? low : high) = middle;
        }
        QuadRig::State start;
        std::vector<double> inclinations;
        double top = 0;
        miss(low, &inclinations, &top);
        start.inclination.assign(inclinations.begin(), inclinations.end()), start.top = top;
        const auto state = truth.settled(start);
        REQUIRE(state);
        ++count;
        CHECK(listed(found, *state, symmetric));
    }
    CHECK(count <= static_cast<int>(found.shapes.size()));
    return count;
}

inline void print(const char* what, const Measured& m) {
    if (std::getenv("MEASURE"))
        std::printf("%s: %ld lists, %ld undecided, %ld shapes, error %.3g, bound %.3g, residual %.2g\n", what,
                    m.lists, m.incomplete, m.shapes, m.error, m.bound, m.residual);
}

}  // namespace support::rig_shapes
