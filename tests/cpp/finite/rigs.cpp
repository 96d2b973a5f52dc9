// SPDX-License-Identifier: MPL-2.0
// Steady shapes of rigs against: closed forms (N = 1); torques on the bodies as vectors in quadruple precision, whose
// zeros Newton's method finds from random starts (support/quad_rig.hpp); a sweep in long double, scanned for changes of
// sign. Error: the largest of an inclination, rad. A zero that is not in the list is a failure, whatever found it.
#include "revchain/finite/rig_shapes.hpp"

#include "revchain/core/carried_support.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/quad_rig.hpp"

using Catch::Matchers::ContainsSubstring;
using revchain::carried_round;
using revchain::Chain;
using revchain::Displaced;
using revchain::Fluid;
using revchain::Flywheel;
using revchain::horizontal_spring;
using revchain::Index;
using revchain::plummet;
using revchain::Posture;
using revchain::Rig;
using revchain::Rigging;
using revchain::RigShapesOptions;
using revchain::SteadyShape;
using revchain::SteadyShapes;
using support::Quad;
using support::QuadRig;
using support::Random;

namespace {

constexpr double gravity = revchain::conical_pendulum::standard_gravity;

QuadRig truth_of(const Rig& rig, double height, int sense = 1) {
    return {rig, sense * sqrtq(Quad(gravity) / Quad(height)), gravity};
}

Quad apart(Quad x, Quad y) { return fabsq(remainderq(x - y, 8 * atanq(1))); }

/// Largest difference of inclinations.
Quad apart(const SteadyShape& shape, const QuadRig::State& state, int sign = 1) {
    Quad worst = 0;
    for (Index m = 0; m < shape.inclination.size(); ++m)
        worst = std::max(worst, apart(shape.inclination[m], sign * state.inclination[static_cast<std::size_t>(m)]));
    return worst;
}

QuadRig::State state_of(const SteadyShape& shape) {
    QuadRig::State state;
    for (const double d : shape.inclination) state.inclination.push_back(d);
    state.top = shape.offset[shape.offset.size() - 1];
    return state;
}

struct Measured {
    double error = 0, relative = 0, residual = 0, bound = 0;  // relative: error beyond 1e-16, over condition
    long shapes = 0, lists = 0, incomplete = 0;
};

/// Every shape of a list is one, within its bound.
void check_shapes(const Rig& rig, double height, const SteadyShapes& found, int sense, Measured& measured) {
    const QuadRig truth = truth_of(rig, height, sense);
    ++measured.lists, measured.incomplete += !found.complete;
    for (const SteadyShape& shape : found.shapes) {
        ++measured.shapes;
        CHECK(truth.balance(state_of(shape)).worst <= 1e-14);
        const auto exact = truth.settled(state_of(shape));
        REQUIRE(exact);
        const double off = static_cast<double>(apart(shape, *exact));
        CHECK(off <= shape.error_bound);
        measured.error = std::max(measured.error, off);
        measured.residual = std::max(measured.residual, shape.residual);
        measured.bound = std::max(measured.bound, shape.error_bound);
        const Index n = rig.size();
        Quad y = exact->top;
        const double reach = rig.chain().total_length() + std::abs(shape.offset[n]);
        CHECK(fabsq(y - shape.offset[n]) <= 1e-15 * reach * (1 + 0 * shape.condition));
        for (Index m = n; m-- > 0;) {
            y += Quad(rig.chain().link(m).length) * sinq(exact->inclination[static_cast<std::size_t>(m)]);
            CHECK(fabsq(y - shape.offset[m]) <= 1e-15 * reach);
        }
        if (rig.support().radius == 0) CHECK(shape.offset[0] > -1e-20);
    }
}

bool listed(const SteadyShapes& found, const QuadRig::State& state, bool symmetric) {
    return std::any_of(found.shapes.begin(), found.shapes.end(), [&](const SteadyShape& shape) {
        return apart(shape, state) <= 1e-12 || (symmetric && apart(shape, state, -1) <= 1e-12);
    });
}

/// No zero that Newton's method finds from random starts is missing.
void check_by_random_starts(const Rig& rig, double height, const SteadyShapes& found, int sense, int starts,
                            Random& random, long& met) {
    if (!found.complete) return;
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

Chain<double> random_chain(Index size, Random& random) {
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
            const long double n_H = std::sqrt(static_cast<long double>(gravity) / lambda) * rig.flywheel(m).momentum;
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
            support.is_firm() ? 0 : (H + support.carriage_weight * y) / (lambda * support.stiffness);
        return y - support.radius - pulled;
    }
};

/// Hanging shapes by changes of sign over tangents even in the angle and in the logarithm: never more than the list.
int check_by_scan(const Rig& rig, double height, const SteadyShapes& found, int steps) {
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

void print(const char* what, const Measured& m) {
    if (std::getenv("MEASURE"))
        std::printf("%s: %ld lists, %ld not complete, %ld shapes, error %.3g, bound %.3g, residual %.2g\n", what,
                    m.lists, m.incomplete, m.shapes, m.error, m.bound, m.residual);
}

}  // namespace

TEST_CASE("one plummet on a support carried round: the closed form's one or three", "[finite][rig]") {
    Random random(1);
    double worst = 0;
    int threes = 0;
    for (int i = 0; i < 300; ++i) {
        const double l = random.log_between(0.1, 10), lambda = l * random.log_between(0.02, 3);
        const double b = l * random.log_between(1e-6, 3);
        const auto exact = revchain::carried_inclinations(l, lambda, b);
        const Chain<double> one({plummet<double>(random.log_between(0.1, 10), l)});
        const auto found = revchain::steady_shapes(Rig(one, {.support = carried_round(b)}), lambda);
        REQUIRE(found.complete);
        REQUIRE(static_cast<int>(found.shapes.size()) == exact.count);
        threes += exact.count == 3;
        std::vector<double> inclinations;
        for (const SteadyShape& shape : found.shapes) inclinations.push_back(shape.inclination[0]);
        std::sort(inclinations.begin(), inclinations.end());
        for (int j = 0; j < exact.count; ++j) {
            const auto k = static_cast<std::size_t>(j);
            worst = std::max(worst, std::abs(inclinations[k] - exact.inclination[k]));
        }
    }
    CHECK(threes > 50);
    CHECK(worst < 2e-15);  // of the closed form in double
}

TEST_CASE("a plummet under a spring: (lambda - W/E) sec d = l", "[finite][rig]") {
    Random random(2);
    double worst = 0;
    int flown = 0;
    for (int i = 0; i < 300; ++i) {
        const double l = random.log_between(0.1, 10), W = random.log_between(0.1, 10),
                     E = W / l * random.log_between(0.2, 50);
        const double lambda = l * random.log_between(0.02, 3);
        const Quad c = Quad(W) / E, cosine = (Quad(lambda) - c) / l;
        const auto found = revchain::steady_shapes(
            Rig(Chain<double>({plummet<double>(W, l)}), {.support = horizontal_spring(E)}), lambda);
        REQUIRE(found.complete);
        const bool flies = cosine > 0 && cosine < 1;
        REQUIRE(found.shapes.size() == (flies ? 1U : 0U));
        if (!flies) continue;
        ++flown;
        const Quad d = found.shapes[0].inclination[0], exact = acosq(cosine);
        CHECK(fabsq(d - exact) <= found.shapes[0].error_bound);
        worst = std::max(worst, static_cast<double>(fabsq(d - exact)));
        const double top = static_cast<double>(c * tanq(exact));
        CHECK(std::abs(found.shapes[0].offset[1] - top) <= 1e-15 * std::abs(found.shapes[0].offset[0]));
    }
    CHECK(flown > 50);
    CHECK(worst < 2.3e-16);
}

TEST_CASE("one gyrostat: (I cos d) n^2 - p n - W h = 0, a top hung up", "[finite][rig]") {
    Random random(3);
    double worst = 0;
    int inclined = 0, standing = 0;
    for (int i = 0; i < 400; ++i) {
        const double W = random.log_between(0.1, 10), a = random.log_between(0.1, 10), h = a * random.between(0.1, 1);
        const double rho = a * random.between(0.05, 1), lambda = a * random.log_between(0.05, 10);
        const int sense = random() < 0.5 ? 1 : -1;
        const Chain<double> one({revchain::compound_pendulum<double>(
            {.weight = W, .length = a, .centroid = h, .radius_of_gyration = rho})});
        const Quad n = sense * sqrtq(Quad(gravity) / lambda), g = gravity;
        const Quad rho2 = support::quad(one.link(0).gyration_ratio) * Quad(a) * a,
                   I = Quad(W) / g * (Quad(h) * h + rho2);
        // of the size of what the others are, of either sign; half of the wheels driven by a motor
        const double H = static_cast<double>(I * fabsq(n)) * random.between(-1.5, 1.5);
        const double C = i % 2 == 0 ? 0 : static_cast<double>(I * g) * random.between(0, 1.5);
        const Rig rig(one, {.flywheels = {{H, C}}});
        const Quad cosine = (Quad(H) * n + Quad(W) * h) / ((I - Quad(C) / g) * n * n);
        for (const bool hanging : {true, false}) {
            const auto found = revchain::steady_shapes(rig, lambda, {.hanging_only = hanging, .sense = sense});
            REQUIRE(found.complete);
            const bool there = fabsq(cosine) < 1 && (cosine > 0 || !hanging);
            REQUIRE(found.shapes.size() == (there ? 1U : 0U));
            if (!there) continue;
            const Quad d = found.shapes[0].inclination[0];
            CHECK(apart(fabsq(d), acosq(cosine)) <= found.shapes[0].error_bound);
            worst = std::max(worst, static_cast<double>(fabsq(fabsq(d) - acosq(cosine))));
            inclined += cosine > 0, standing += cosine < 0;
        }
        // the same at the speed, the sense its sign
        const double speed = static_cast<double>(n);
        const auto again = revchain::steady_shapes_at_speed(rig, speed, {.hanging_only = false});
        if (fabsq(cosine) < 0.999)
            CHECK(again.shapes.size() ==
                  revchain::steady_shapes(rig, lambda, {.hanging_only = false, .sense = sense}).shapes.size());
    }
    CHECK(inclined > 50);
    CHECK(standing > 20);
    CHECK(worst < 4.5e-16);
}

TEST_CASE("two gyrostats, hanging and standing: torques on both", "[finite][rig]") {
    Random random(4);
    Measured measured;
    long met = 0;
    for (int i = 0; i < 40; ++i) {
        const auto chain = random_chain(2, random);
        const double lambda = chain.total_length() * random.log_between(0.02, 1);
        const double size = chain.total_weight() * chain.total_length() * std::sqrt(lambda / gravity);
        const bool driven = i % 3 == 0;
        std::vector<Flywheel> wheels;
        for (int m = 0; m < 2; ++m)
            wheels.push_back(
                {size * random.between(-0.5, 0.5), driven ? chain.link(m).weight * random.between(0, 0.5) : 0});
        const Rig rig(chain, {.flywheels = wheels});
        const int sense = i % 2 == 0 ? 1 : -1;
        for (const bool hanging : {true, false}) {
            const auto found = revchain::steady_shapes(rig, lambda, {.hanging_only = hanging, .sense = sense});
            CAPTURE(i, hanging, found.cells);
            check_shapes(rig, lambda, found, sense, measured);
            if (!hanging) check_by_random_starts(rig, lambda, found, sense, 100, random, met);
        }
    }
    print("two gyrostats", measured);
    CHECK(measured.incomplete == 0);
    CHECK(met > 500);
    CHECK(measured.error <= 4.5e-16);
    CHECK(measured.residual <= 1e-25);
}

TEST_CASE("swing carousels of one to eight links: all roots", "[finite][rig]") {
    Random random(5);
    Measured measured;
    int scanned = 0, multiple = 0;
    for (int i = 0; i < 48; ++i) {
        const Index size = 1 + i % 8;
        const auto chain = i % 3 == 0   ? Chain<double>::uniform_plummets(size, 1.0, 1.0)
                           : i % 3 == 1 ? Chain<double>::uniform_rods(size, 1.0, 1.0)
                                        : support::chain_of(size, [&](Index) {
                                              const double W = random.log_between(0.2, 5);
                                              return plummet<double>(W, random.log_between(0.3, 3));
                                          });
        const double lambda = chain.total_length() * random.log_between(0.02, 2);
        const double b = chain.total_length() * random.log_between(1e-3, 2);
        const Rig rig(chain, {.support = carried_round(b)});
        const auto found = revchain::steady_shapes(rig, lambda);
        CAPTURE(i, size, lambda, b);
        CHECK(found.complete);
        CHECK(found.shapes.size() % 2 == 1);  // from far inwards to far outwards
        multiple += found.shapes.size() > 1;
        check_shapes(rig, lambda, found, 1, measured);
        scanned += check_by_scan(rig, lambda, found, 3000);
    }
    print("carousels", measured);
    CHECK(multiple > 20);
    CHECK(scanned > 9 * measured.shapes / 10);
    CHECK(measured.error <= 2.3e-16);
    CHECK(measured.residual <= 1e-25);
}

TEST_CASE("chains on springs, carried round or not: all roots", "[finite][rig]") {
    Random random(6);
    Measured measured;
    int scanned = 0;
    for (int i = 0; i < 60; ++i) {
        const Index size = 1 + i % 5;
        const auto chain =
            i % 2 == 0 ? Chain<double>::uniform_rods(size, 1.0, 1.0) : support::chain_of(size, [&](Index) {
                const double W = random.log_between(0.2, 5);
                return plummet<double>(W, random.log_between(0.3, 3));
            });
        const double lambda = chain.total_length() * random.log_between(0.03, 2);
        auto held = horizontal_spring(chain.total_weight() / chain.total_length() * random.log_between(0.3, 100),
                                      i % 3 == 0 ? 0 : chain.total_weight() * random.log_between(0.01, 3));
        if (i % 4 >= 2) held.radius = chain.total_length() * random.log_between(1e-2, 1);
        std::vector<Flywheel> wheels;
        if (i % 5 == 4)
            wheels.assign(
                static_cast<std::size_t>(size),
                Flywheel{0.02 * chain.total_weight() * chain.total_length() * std::sqrt(lambda / gravity), 0});
        const Rig rig(chain, {.support = held, .flywheels = wheels});
        const auto found = revchain::steady_shapes(rig, lambda);
        CAPTURE(i, size, lambda, held.stiffness, held.radius, held.carriage_weight);
        CHECK(found.complete);
        check_shapes(rig, lambda, found, 1, measured);
        scanned += check_by_scan(rig, lambda, found, 2000);
    }
    print("springs", measured);
    CHECK(scanned > 9 * measured.shapes / 10);
    CHECK(measured.error <= 2.3e-16);
    CHECK(measured.residual <= 1e-25);
}

TEST_CASE("rigs of every kind, in any posture: nothing missing that random starts find", "[finite][rig]") {
    Random random(7);
    Measured measured;
    long met = 0;
    for (int i = 0; i < 36; ++i) {
        const Index size = 1 + i % 3;
        const auto chain = random_chain(size, random);
        const double lambda = chain.total_length() * random.log_between(0.05, 2);
        const double weight = chain.total_weight(), length = chain.total_length();
        Rigging with;
        if (i % 2 == 0)
            with.support =
                horizontal_spring(weight / length * random.log_between(0.3, 30), random() < 0.5 ? 0 : weight);
        if (i % 3 != 0) with.support.radius = length * random.log_between(0.01, 1);
        if (i % 4 >= 2)
            for (Index m = 0; m < size; ++m)
                with.flywheels.push_back({weight * length * std::sqrt(lambda / gravity) * random.between(-0.3, 0.3),
                                          random() < 0.5 ? 0 : weight * length * length * random.between(0, 0.1)});
        with.fluid = random() < 0.5 ? Fluid::still : Fluid::turning;
        if (i % 5 >= 2)
            for (Index m = 0; m < size; ++m) {
                const auto link = chain.link(m);
                auto fluid = revchain::displaced_by(link, link.weight * random.between(0, 1.6), 0);
                if (with.fluid == Fluid::still) fluid.added_weight = fluid.weight * random.between(0, 1);
                with.displaced.push_back(fluid);
            }
        const Rig rig(chain, with);
        const int sense = random() < 0.5 ? 1 : -1;
        const auto found = revchain::steady_shapes(rig, lambda, {.hanging_only = false, .sense = sense});
        CAPTURE(i, size, lambda, found.cells, found.shapes.size());
        check_shapes(rig, lambda, found, sense, measured);
        check_by_random_starts(rig, lambda, found, sense, 100, random, met);
    }
    print("every kind", measured);
    CHECK(measured.incomplete == 0);
    CHECK(met > 500);
    CHECK(measured.error <= 4.5e-16);
    CHECK(measured.residual <= 1e-25);
}
