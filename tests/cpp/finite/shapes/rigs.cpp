// SPDX-License-Identifier: MPL-2.0
// Steady shapes of rigs against: closed forms (N = 1); torques on the bodies as vectors in quadruple precision, whose
// zeros Newton's method finds from random starts (support/quad_rig.hpp); a sweep in long double, scanned for changes of
// sign. Error: the largest of an inclination, rad. A zero that is not in the list is a failure, whatever found it.
#include "revchain/steady_shapes.hpp"

#include "revchain/conical_pendulum.hpp"
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

/// Reactions, energy, moment of inertia, over the sizes of what they are sums of.
void check_forces(const Rig& rig, const QuadRig::Balance& exact, const SteadyShape& shape) {
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
void check_shapes(const Rig& rig, double height, const SteadyShapes& found, int sense, Measured& measured) {
    const QuadRig truth = truth_of(rig, height, sense);
    ++measured.lists, measured.incomplete += !found.complete;
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

TEST_CASE("a compound link on a spring, at any inclination", "[finite][rig]") {
    Random random(8);
    Measured measured;
    long met = 0;
    for (int i = 0; i < 40; ++i) {
        const auto chain = random_chain(1, random);
        const double l = chain.total_length(), lambda = l * random.log_between(0.05, 2);
        const Rig rig(chain, {.support = horizontal_spring(chain.total_weight() / l * random.log_between(0.3, 100))});
        for (const bool hanging : {true, false}) {
            const auto found = revchain::steady_shapes(rig, lambda, {.hanging_only = hanging});
            check_shapes(rig, lambda, found, 1, measured);
            if (!hanging) check_by_random_starts(rig, lambda, found, 1, 60, random, met);
        }
    }
    print("compound link on a spring", measured);
    CHECK(measured.incomplete == 0);
    CHECK(met > 200);
    CHECK(measured.error <= 4.5e-16);
}

TEST_CASE("a rig with nothing is its chain, bit for bit; with zeros, to the last digit", "[finite][rig]") {
    Random random(9);
    for (int i = 0; i < 20; ++i) {
        const auto chain = random_chain(1 + i % 5, random);
        const double lambda = chain.total_length() * random.log_between(0.02, 0.5);
        for (const bool hanging : {true, false}) {
            if (!hanging && chain.size() > 3) continue;
            const auto want = revchain::steady_shapes(chain, lambda, {.hanging_only = hanging});
            const auto found = revchain::steady_shapes(Rig(chain, {}), lambda, {.hanging_only = hanging});
            REQUIRE(found.shapes.size() == want.shapes.size());
            CHECK(found.cells == want.cells);
            for (std::size_t k = 0; k < want.shapes.size(); ++k) {
                CHECK(found.shapes[k].inclination == want.shapes[k].inclination);
                CHECK(found.shapes[k].effective_energy == want.shapes[k].effective_energy);
            }
            // wheels at rest, a fluid of no weight: the same numbers by what is made for rigs
            const auto size = static_cast<std::size_t>(chain.size());
            const Rig zeros(chain,
                            {.flywheels = std::vector<Flywheel>(size), .displaced = std::vector<Displaced>(size)});
            const auto same = revchain::steady_shapes(zeros, lambda, {.hanging_only = hanging});
            REQUIRE(same.shapes.size() == want.shapes.size());
            CHECK(same.complete == want.complete);
            for (std::size_t k = 0; k < want.shapes.size(); ++k) {
                const SteadyShape &x = same.shapes[k], &y = want.shapes[k];
                CHECK((x.inclination - y.inclination).cwiseAbs().maxCoeff() <= 2.3e-16);
                CHECK((x.tension - y.tension).cwiseAbs().maxCoeff() <= 1e-15 * y.tension.maxCoeff());
                CHECK(x.half_waves == y.half_waves);
                CHECK(x.error_bound <= 1.01 * y.error_bound + 1e-18);
            }
        }
    }
}

TEST_CASE("a support hardly off the axis: each shape twice, and the chain all but straight", "[finite][rig]") {
    Random random(10);
    for (int i = 0; i < 12; ++i) {
        const auto chain = i % 2 == 0 ? Chain<double>::uniform_plummets(1 + i % 4, 1.0, 1.0)
                                      : Chain<double>::uniform_rods(1 + i % 4, 1.0, 1.0);
        const double lambda = random.log_between(0.02, 0.9);
        const auto axis = revchain::steady_shapes(chain, lambda);
        REQUIRE(axis.complete);
        double before = 0;
        for (const double b : {1e-6, 1e-9}) {
            const auto found = revchain::steady_shapes(Rig(chain, {.support = carried_round(b)}), lambda);
            REQUIRE(found.complete);
            REQUIRE(found.shapes.size() == 2 * axis.shapes.size() + 1);
            double worst = 0;
            int straight = 0;
            for (const SteadyShape& shape : found.shapes) {
                double nearest = shape.inclination.cwiseAbs().maxCoeff();
                bool is_straight = true;
                for (const SteadyShape& other : axis.shapes)
                    for (const int sign : {1, -1}) {
                        const double off = (shape.inclination - sign * other.inclination).cwiseAbs().maxCoeff();
                        if (off < nearest) nearest = off, is_straight = false;
                    }
                straight += is_straight;
                worst = std::max(worst, nearest);
            }
            CHECK(straight == 1);
            CHECK(worst <= 1e5 * b);
            if (before > 0) CHECK(worst <= 1.1e-3 * before);  // in proportion to b
            before = worst;
        }
        // on the axis itself, with the shape of the spring's place alone changed
        const auto none = revchain::steady_shapes(Rig(chain, {.support = carried_round(0)}), lambda);
        CHECK(none.shapes.size() == axis.shapes.size());
    }
}

TEST_CASE("floats: a cork under water stands, and whirls where the turning water does not", "[finite][rig]") {
    // One plummet lighter than water by half its weight, W - B = -W/2, moves with W: it stands, and nothing lifts it.
    const Chain<double> one({plummet<double>(1.0, 1.0)});
    const auto in = [&](double weight, double added, Fluid fluid) {
        Rigging with;
        with.fluid = fluid;
        Displaced cork = revchain::displaced_by(one.link(0), weight, added);
        with.displaced = {cork};
        return Rig(one, with);
    };
    for (const double lambda : {0.2, 0.9}) {
        // hanging: lambda (W - B)/cos d = W + added: cos d of either sign
        for (const double B : {0.5, 0.9, 1.1, 1.5}) {
            const Quad cosine = Quad(lambda) * (1 - Quad(B)) / (1 + Quad(0.5));
            const auto found = revchain::steady_shapes(in(B, 0.5, Fluid::still), lambda, {.hanging_only = false});
            REQUIRE(found.complete);
            REQUIRE(found.shapes.size() == 1);
            CHECK(apart(found.shapes[0].inclination[0], acosq(cosine)) <= found.shapes[0].error_bound);
        }
        // turning: net weights in both
        const auto found = revchain::steady_shapes(in(1.5, 0, Fluid::turning), lambda, {.hanging_only = false});
        REQUIRE(found.complete);
        REQUIRE(found.shapes.size() == 1);
        CHECK(apart(found.shapes[0].inclination[0], acosq(Quad(lambda))) <= found.shapes[0].error_bound);
    }
    CHECK_THROWS_WITH(revchain::steady_shapes(in(1.0, 0, Fluid::still), 0.5), ContainsSubstring("effective tension"));
    CHECK_THROWS_WITH(revchain::steady_shapes(in(1.0, 0, Fluid::turning), 0.5), ContainsSubstring("link 1"));
}

TEST_CASE("a rig's own posture: a broomstick on a hanging rod, and nothing else", "[finite][rig]") {
    Random random(11);
    Measured measured;
    int stood = 0;
    for (int i = 0; i < 20; ++i) {
        const auto chain = random_chain(2, random);
        const Rig rig(chain, {.support = carried_round(0.05), .posture = {Posture::stands, Posture::hangs}});
        const double lambda = chain.total_length() * random.log_between(0.05, 1);
        const auto own = revchain::steady_shapes(rig, lambda),
                   any = revchain::steady_shapes(rig, lambda, {.hanging_only = false});
        check_shapes(rig, lambda, own, 1, measured);
        std::size_t count = 0;
        for (const SteadyShape& shape : any.shapes)
            count += std::cos(shape.inclination[0]) < 0 && std::cos(shape.inclination[1]) > 0;
        CHECK(own.shapes.size() == count);
        stood += static_cast<int>(count);
    }
    CHECK(measured.incomplete == 0);
    CHECK(stood > 10);
}

TEST_CASE("bells carried round, the lowest link in the axis: met from both sides, counted once", "[finite][rig]") {
    // Link 2 carries no load and leans either way, as lambda sigma/cos d = -a X: link 1 hangs straight in the axis if the
    // support is where link 2 then ends.
    const Chain<double> chain(
        {plummet<double>(1.0, 1.0), revchain::compound_pendulum<double>(
                                        {.weight = 1.0, .length = 1.0, .centroid = 0.5, .radius_of_gyration = 1.5})});
    // sigma = 1.5, -a X = 2.25 - 0.25 = 2: cos d = lambda 0.75
    const double lambda = 0.8;
    const double b = 0.8;  // sin d = 0.8 where cos d = 0.6
    const auto found =
        revchain::steady_shapes(Rig(chain, {.support = carried_round(b)}), lambda, {.hanging_only = false});
    CHECK(found.complete);
    Measured measured;
    const Rig rig(chain, {.support = carried_round(b)});
    check_shapes(rig, lambda, found, 1, measured);
    long met = 0;
    Random random(12);
    check_by_random_starts(rig, lambda, found, 1, 400, random, met);
    CHECK(met > 100);
    for (std::size_t i = 0; i < found.shapes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            CHECK((found.shapes[i].inclination - found.shapes[j].inclination).cwiseAbs().maxCoeff() > 1e-6);
    int in_axis = 0;
    for (const SteadyShape& shape : found.shapes) in_axis += std::abs(shape.inclination[0]) < 1e-12;
    CHECK(in_axis == 1);
}

TEST_CASE("rods on end, carried round: every list proved, and no shape in it twice", "[finite][rig]") {
    // The lowest leans so little that its box, with tangents to one side, reaches across 0.
    int lists = 0;
    for (Index size = 1; size <= 6; ++size)
        for (const double each : {0.15, 0.25, 0.3, 0.5})
            for (const double turns : {0.5, 1.0, 1.2, 1.5, 2.0})
                for (const double b : {0.01, 0.05}) {
                    const auto chain = Chain<double>::uniform_rods(size, each * static_cast<double>(size), 1.0);
                    const std::vector<Posture> stand(static_cast<std::size_t>(size), Posture::stands);
                    const Rig rig(chain, {.support = carried_round(b), .posture = stand});
                    const auto found = revchain::steady_shapes_at_speed(rig, 2 * std::numbers::pi * turns);
                    CAPTURE(size, each, turns, b);
                    CHECK(found.complete);
                    REQUIRE(!found.shapes.empty());
                    for (std::size_t i = 0; i < found.shapes.size(); ++i)
                        for (std::size_t j = 0; j < i; ++j) {
                            const auto off = found.shapes[i].inclination - found.shapes[j].inclination;
                            CHECK(off.cwiseAbs().maxCoeff() > 1e-9);
                        }
                    ++lists;
                }
    CHECK(lists == 240);
}

TEST_CASE("long carousels: outwards at rest and at speed", "[finite][rig]") {
    for (const Index size : {100, 1000}) {
        const auto chain = Chain<double>::uniform_rods(size, 1.0, 1.0);
        const Rig rig(chain, {.support = carried_round(0.5)});
        const auto found = revchain::steady_shapes(rig, 2.0);
        CHECK(found.complete);
        REQUIRE(found.shapes.size() == 1);
        CHECK(found.shapes[0].residual <= 1e-20);
        CHECK(found.shapes[0].inclination.minCoeff() > 0);
        CHECK(found.shapes[0].error_bound < 3e-16);
    }
}

TEST_CASE("what cannot be told is said", "[finite][rig]") {
    const auto chain = Chain<double>::uniform_plummets(2, 1.0, 1.0);
    // lambda E is all the weight: nothing keeps the support from running away
    for (const double radius : {0.0, 0.1}) {
        auto held = horizontal_spring(4.0);
        held.radius = radius;
        const auto found = revchain::steady_shapes(Rig(chain, {.support = held}), 0.25);
        CHECK_FALSE(found.complete);
        CHECK_FALSE(found.undecided.empty());
    }
    const auto poor = revchain::steady_shapes(Rig(chain, {.support = carried_round(0.1)}), 0.1, {.budget = 4});
    CHECK_FALSE(poor.complete);
    // wheels against the rotation on a chain too long for boxes of all its tangents
    const Rig many(Chain<double>::uniform_rods(300, 1.0, 1.0), {.flywheels = std::vector<Flywheel>(300, {-1e-3})});
    CHECK_FALSE(revchain::steady_shapes(many, 0.1).complete);
    const Rig rig(chain, {.flywheels = {{-1.0}, {0.0}}});
    for (const double bad : {0.0, -1.0, std::nan("")}) {
        CHECK_THROWS_AS(revchain::steady_shapes(rig, bad), revchain::InvalidArgument);
        CHECK_THROWS_AS(revchain::steady_shapes(rig, 1.0, {.gravity = bad}), revchain::InvalidArgument);
    }
    CHECK_THROWS_AS(revchain::steady_shapes(rig, 1.0, {.sense = 0}), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::steady_shapes_at_speed(rig, 0.0), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::steady_shapes_at_speed(rig, 1e-200), revchain::InvalidArgument);
    CHECK_FALSE(revchain::steady_shapes_at_speed(rig, 1e200).complete);
}
