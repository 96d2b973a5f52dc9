// SPDX-License-Identifier: MPL-2.0
// Random small systems against references in quadruple precision that share nothing with the library: how many numbers
// are outside their bounds, and the worst error over its bound. A list with nothing undecided is searched for
// what it lacks.
//
//     random_systems [how many of each kind] [seed] [part of the name of a kind]
#include <Eigen/Eigenvalues>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>

#include "revchain/cord.hpp"
#include "revchain/rig_modes.hpp"
#include "revchain/stability.hpp"
#include "revchain/steady_shapes.hpp"
#include "support/chains.hpp"
#include "support/quad_motion.hpp"
#include "support/rig_equations.hpp"

namespace {

using revchain::Chain;
using revchain::Index;
using revchain::Rig;
using support::Quad;
using support::Random;
using Complex = std::complex<double>;

/// Counts of one kind of system: numbers compared, numbers outside their bound, the worst error.
struct Tally {
    long numbers = 0, outside = 0, unproved = 0, systems_outside = 0, refused = 0;
    double worst = 0;
    bool spoilt = false;  ///< of the present system

    void add(double error, double bound) {
        ++numbers;
        if (!std::isfinite(bound)) {
            ++unproved;
            return;
        }
        if (!(error <= bound)) ++outside, spoilt = true;
        if (error > 0) worst = std::max(worst, error / bound);
    }
    void require(bool holds) {
        ++numbers;
        if (!holds) ++outside, spoilt = true;
    }
};

/// The parts that the rigs of one kind may have.
struct Kind {
    bool spring = false, wheels = false, driven = false, still = false, turning = false, stands = false, arm = false;
    Index most = 6;
    bool inertia = false;  ///< of every link about its centre of gravity
};

Rig random_rig(Random& random, const Kind& kind) {
    const Index size = 1 + static_cast<Index>(random() * static_cast<double>(kind.most));
    const bool plummets = !kind.inertia && random() < 0.3;
    std::vector<revchain::Link<double>> links;
    for (Index m = 0; m < size; ++m) {
        const double weight = random.log_between(0.05, 20), a = random.log_between(0.2, 5);
        if (plummets)
            links.push_back(revchain::plummet(weight, a));
        else
            links.push_back(revchain::compound_pendulum<double>({.weight = weight,
                                                                 .length = a,
                                                                 .centroid = a * random.between(0.05, 1.2),
                                                                 .radius_of_gyration = a * random.between(0.05, 0.7)}));
    }
    const Chain<double> chain(links);
    const double weight = chain.total_weight(), length = chain.total_length();
    revchain::Rigging with;
    if (kind.spring) {
        const double carriage = random() < 0.3 && !kind.inertia ? 0 : weight * random.log_between(0.01, 10);
        with.support = revchain::horizontal_spring(weight / length * random.log_between(0.3, 100), carriage);
    }
    if (kind.arm) with.support.radius = length * random.between(0.05, 1);
    for (Index m = 0; m < size; ++m) {
        const auto link = chain.link(m);
        const double wheel = link.weight * link.length * link.length;
        if (kind.wheels)
            with.flywheels.push_back(
                {wheel * random.between(-3, 3), kind.driven ? wheel * random.between(0, 0.5) : 0.0});
        if (kind.still || kind.turning) {
            auto fluid = revchain::displaced_by(link, link.weight * random.between(0, kind.turning ? 1.5 : 0.9),
                                                kind.still ? link.weight * random.between(0, 1) : 0.0);
            if (random() < 0.5) fluid.centroid *= random.between(0.8, 1.0);
            with.displaced.push_back(fluid);
        }
        if (kind.stands) with.posture.push_back(random() < 0.4 ? revchain::Posture::stands : revchain::Posture::hangs);
    }
    if (kind.turning) with.fluid = revchain::Fluid::turning;
    return {chain, with};
}

/// How far a root of one sign change is from x, relative, where `before(x)` counts the roots up to x; found within
/// `within` of x, else infinite.
double off(double x, int number, double within, const std::function<int(Quad)>& before) {
    Quad low = Quad(x) * (1 - Quad(within)), high = Quad(x) * (1 + Quad(within));
    if (before(low) >= number || before(high) < number) return std::numeric_limits<double>::infinity();
    for (int i = 0; i < 30; ++i) {
        const Quad middle = low + (high - low) / 2;
        (before(middle) < number ? low : high) = middle;
    }
    return static_cast<double>(fabsq(low / Quad(x) - 1));
}

void check_modes(Random& random, const Kind& kind, Tally& tally) {
    const Rig rig = random_rig(random, kind);
    const auto found = revchain::modes(rig, {.count = revchain::all_modes});
    const support::QuadPencil truth(rig);
    tally.require(found.complete);
    if (!found.has_momentum) {
        for (Index j = 0; j < found.forward.size(); ++j) {
            const double h = found.forward.conical_height[j], bound = found.forward.error_bound[j];
            const auto up_to = [&](Quad x) { return -truth.above(x); };  // rises by one at each height
            tally.add(off(h, -static_cast<int>(j), 2 * bound, up_to), bound);
        }
        tally.require(truth.above(Quad(1e-12)) == found.forward.size() ||
                      found.forward.size() < found.forward.available);
        return;
    }
    for (const int sense : {1, -1}) {
        const auto& modes = sense > 0 ? found.forward : found.backward;
        for (Index j = 0; j < modes.size(); ++j)
            tally.add(off(modes.angular_speed[j], static_cast<int>(j) + 1, 2 * modes.speed_error_bound[j],
                          [&](Quad n) { return truth.slower(sense * n); }),
                      modes.speed_error_bound[j]);
    }
}

/// All roots, real or not, by Newton's method from each that was found; as many as there are, and no two the same.
void check_all_roots(Random& random, const Kind& kind, Tally& tally) {
    const Rig rig = random_rig(random, kind);
    const auto found = revchain::modes(rig, {.count = revchain::all_modes});
    const support::QuadPencil truth(rig);
    const bool height = !found.has_momentum;
    struct Root {
        Complex value;
        double bound;
        bool of_height;
    };
    std::vector<Root> roots;
    for (const int sense : {1, -1}) {
        const auto& modes = sense > 0 ? found.forward : found.backward;
        for (Index j = 0; j < modes.size(); ++j)
            roots.push_back(height ? Root{modes.conical_height[j], modes.error_bound[j], true}
                                   : Root{sense * modes.angular_speed[j], modes.speed_error_bound[j], false});
    }
    for (const auto& other : found.other)
        roots.push_back({height ? other.conical_height : other.angular_speed, other.error_bound, true});
    tally.require(found.complete && roots.size() == truth.size() * (height ? 1 : 2));
    std::vector<std::complex<Quad>> exact;
    for (const Root& root : roots) {
        const std::complex<Quad> x(root.value.real(), root.value.imag()), y = truth.root(x, height);
        const auto ratio = y / x - std::complex<Quad>(1);
        const double size = static_cast<double>(hypotq(ratio.real(), ratio.imag()));
        tally.add(root.of_height && !height ? 2 * size : size, root.bound);  // lambda = g/n^2
        for (const auto& z : exact) {
            const auto apart = y / z - std::complex<Quad>(1);
            tally.require(hypotq(apart.real(), apart.imag()) > Quad(1e-25));
        }
        exact.push_back(y);
    }
}

void check_counts(Random& random, const Kind& kind, Tally& tally) {
    const Rig rig = random_rig(random, kind);
    const support::QuadPencil truth(rig);
    for (int i = 0; i < 5; ++i) {
        const double speed = random.log_between(0.1, 1e3),
                     signed_speed = rig.has_momentum() && random() < 0.5 ? -speed : speed;
        const auto count = revchain::count_modes(rig, {.angular_speed = signed_speed});
        const Quad n = signed_speed, height = Quad(9.80665) / (n * n);
        tally.require(count == (rig.has_momentum() ? truth.slower(n) : truth.above(height)));
    }
}

void check_shapes(Random& random, const Kind& kind, Tally& tally) {
    const Rig rig = random_rig(random, kind);
    const double height = rig.chain().total_length() * random.log_between(0.03, 1.0);
    const bool forward = random() < 0.5;
    const auto direction = forward ? revchain::Rotation::forward : revchain::Rotation::backward;
    const revchain::RigShapesOptions options{
        .conical_height = height, .budget = 300'000, .hanging_only = false, .direction = direction};
    const auto found = revchain::steady_shapes(rig, options, revchain::thorough);
    const Quad speed = (forward ? 1 : -1) * sqrtq(Quad(9.80665) / Quad(height));
    const support::ShapeEquations<Quad> truth(rig, height, speed);
    const support::ShapeEquations<double> rough(rig, height, static_cast<double>(speed));
    const auto size = static_cast<std::size_t>(rig.size());
    for (const auto& shape : found.shapes) {
        std::vector<Quad> place(shape.inclination.begin(), shape.inclination.end());
        if (truth.size() > size) place.push_back(shape.offset[rig.size()]);
        const auto exact = truth.solved_from(place, 12, 1e-25);
        if (!exact) {
            tally.require(shape.condition > 1e8);  // next to a fold
            continue;
        }
        Quad worst = 0;
        for (std::size_t m = 0; m < size; ++m) worst = std::max(worst, fabsq((*exact)[m] - place[m]));
        tally.add(static_cast<double>(worst), shape.error_bound);
    }
    if (!found.undecided.empty()) {
        ++tally.unproved;
        return;
    }
    for (int i = 0; i < 40; ++i) {  // is one missing?
        std::vector<double> start(rough.size());
        for (double& x : start) x = random.between(-3.2, 3.2);
        if (rough.size() > size) start[size] *= rig.chain().total_length();
        const auto other = rough.solved_from(start, 60, 1e-13);
        if (!other) continue;
        double largest = 0;
        for (std::size_t m = 0; m < size; ++m) largest = std::max(largest, std::abs(std::sin((*other)[m])));
        if (largest < 1e-6) continue;  // straight
        const bool listed = std::any_of(found.shapes.begin(), found.shapes.end(), [&](const auto& shape) {
            double near[2] = {0, 0};
            for (std::size_t m = 0; m < size; ++m)
                for (const int side : {0, 1}) {
                    const double d = (side ? -1 : 1) * shape.inclination[static_cast<Index>(m)] - (*other)[m];
                    near[side] = std::max(near[side], std::abs(std::remainder(d, 2 * std::numbers::pi)));
                }
            return (rig.support().radius == 0 ? std::min(near[0], near[1]) : near[0]) < 1e-6;
        });
        tally.require(listed);
    }
}

const Quad pi = Quad(3.141592653589793) + Quad(1.2246467991473532e-16);

/// (V y')' + w s^p y/lambda = 0 from the tip of a cord, V its tension, in steps of Taylor's series; y and its
/// derivative by lambda at the support.
std::pair<Quad, Quad> at_support(Quad length, Quad weight, int p, Quad tip, Quad height) {
    constexpr std::size_t terms = 110;
    const Quad density = weight * (p + 1) / powq(length, p + 1);  // of s^p
    const Quad nearest = powq(tip * (p + 1) / density, Quad(1) / (p + 1)) * (p == 0 ? Quad(1) : sinq(pi / (p + 1)));
    Quad s = 0, y = 1, slope = -1 / height, dy = 0, dslope = 1 / (height * height);
    const Quad mu = 1 / height;
    while (s < length) {
        const Quad step = std::min(length - s, (p == 0 ? s + nearest : std::max(nearest, s * sinq(pi / (p + 1)))) / 3);
        std::array<Quad, 8> w{}, V{};  // of powers of the distance from s
        for (int j = 0; j <= p; ++j) {
            Quad choose = 1;
            for (int i = 0; i < j; ++i) choose = choose * (p - i) / (i + 1);
            w[static_cast<std::size_t>(j)] = density * choose * powq(s, p - j);
        }
        V[0] = tip + density * powq(s, p + 1) / (p + 1);
        for (std::size_t j = 0; j <= static_cast<std::size_t>(p); ++j) V[j + 1] = w[j] / Quad(j + 1);
        std::array<Quad, terms> c{}, d{};
        c[0] = y, c[1] = slope, d[0] = dy, d[1] = dslope;
        for (std::size_t k = 0; k + 2 < terms;
             ++k) {  // coefficient k of (V y')' is (k + 1) sum V_j (k + 2 - j) c_{k+2-j}
            Quad sum = 0, dsum = 0;
            for (std::size_t j = 1; j <= std::min<std::size_t>(static_cast<std::size_t>(p) + 1, k + 1); ++j)
                sum += V[j] * Quad(k + 2 - j) * c[k + 2 - j], dsum += V[j] * Quad(k + 2 - j) * d[k + 2 - j];
            Quad load = 0, dload = 0;
            for (std::size_t j = 0; j <= std::min<std::size_t>(static_cast<std::size_t>(p), k); ++j)
                load += w[j] * c[k - j], dload += w[j] * (mu * d[k - j] - mu * mu * c[k - j]);
            c[k + 2] = (-mu * load / Quad(k + 1) - sum) / (V[0] * Quad(k + 2));
            d[k + 2] = (-dload / Quad(k + 1) - dsum) / (V[0] * Quad(k + 2));
        }
        y = slope = dy = dslope = 0;
        for (std::size_t k = terms; k-- > 0;) {
            y = y * step + c[k], dy = dy * step + d[k];
            if (k > 0) slope = slope * step + Quad(k) * c[k], dslope = dslope * step + Quad(k) * d[k];
        }
        s += step;
    }
    return {y, dy};
}

void check_cord(Random& random, Tally& tally) {
    const double length = random.log_between(0.1, 10), weight = random.log_between(0.1, 10),
                 tip = weight * random.log_between(1e-3, 10);
    const int p = static_cast<int>(random() * 4);
    const revchain::Cord cord(length, {.weight = weight, .density = static_cast<double>(p), .tip_weight = tip});
    const auto found = revchain::modes(cord, {.count = 3});
    for (Index j = 0; j < found.size(); ++j) {
        const double h = found.conical_height[j];
        const auto [y, slope] = at_support(length, weight, p, tip, h);
        tally.add(static_cast<double>(fabsq(y / slope / Quad(h))), found.error_bound[j]);
    }
}

/// Exponents of a steady shape: eigenvalues, in long double, of the first-order system.
std::vector<std::complex<long double>> exponents_of(const support::QuadMotion& motion) {
    using Real = long double;
    const auto given = motion.matrices();
    const auto n = static_cast<Index>(motion.size());
    std::vector<support::Numbers<Quad>> right;  // M^-1 K, M^-1 G, a column at a time
    Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> A =
        Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>::Zero(2 * n, 2 * n);
    for (Index j = 0; j < n; ++j) {
        A(j, n + j) = 1;
        for (const auto* matrix : {&given.K, &given.G}) {
            support::Numbers<Quad> column;
            for (const auto& row : *matrix) column.push_back(row[static_cast<std::size_t>(j)]);
            const auto found = support::solved(given.M, column);
            for (Index i = 0; i < n; ++i)
                A(n + i, matrix == &given.K ? j : n + j) = -static_cast<Real>((*found)[static_cast<std::size_t>(i)]);
        }
    }
    const Eigen::EigenSolver<decltype(A)> solver(A, false);
    return {solver.eigenvalues().begin(), solver.eigenvalues().end()};
}

/// Exponents, as documented 1e-13 of the largest where simple; and the verdict.
void check_stability(Random& random, const Kind& kind, Tally& tally) {
    const Rig rig = random_rig(random, kind);
    const double height = rig.chain().total_length() * random.log_between(0.05, 0.7);
    const revchain::RigShapesOptions options{.conical_height = height, .budget = 100'000, .hanging_only = false};
    const auto found = revchain::steady_shapes(rig, options, revchain::thorough);
    if (found.shapes.empty()) return;
    const auto& shape = found.shapes[static_cast<std::size_t>(random() * static_cast<double>(found.shapes.size()))];
    if (shape.condition > 1e4) return;
    const Quad speed = sqrtq(Quad(9.80665) / Quad(height));
    const support::ShapeEquations<Quad> truth(rig, height, speed);
    std::vector<Quad> place(shape.inclination.begin(), shape.inclination.end());
    if (truth.size() > place.size()) place.push_back(shape.offset[rig.size()]);
    const auto exact = truth.solved_from(place, 12, 1e-25);
    if (!exact) return;
    const auto got = revchain::stability(rig, shape, {}, revchain::thorough);
    const auto want = exponents_of(support::QuadMotion(rig, *exact, speed));
    long double largest = 0;
    for (const auto& s : got.exponents) largest = std::max<long double>(largest, std::abs(s));
    for (const auto& s : got.exponents) {
        long double nearest = 1e300L, next = 1e300L;
        for (const auto& t : want) {
            const long double d = std::abs(std::complex<long double>(s) - t);
            if (d < nearest)
                next = nearest, nearest = d;
            else
                next = std::min(next, d);
        }
        if (next < 0.03L * largest) continue;  // not simple
        tally.add(static_cast<double>(nearest / largest), 1e-13);
    }
    long double growth = 0;
    for (const auto& t : want)
        if (std::abs(t) > 1e-5L * largest) growth = std::max(growth, t.real());
    if (got.verdict == revchain::Verdict::unstable) tally.require(growth > 0);
    if (got.verdict == revchain::Verdict::minimum || got.verdict == revchain::Verdict::spectrally_stable)
        tally.require(growth < 2 * static_cast<long double>(got.margin) + 1e-6L * largest);
}

struct Row {
    const char* name;
    std::function<void(Random&, Tally&)> check;
};

std::vector<Row> rows() {
    const auto of = [](auto check, Kind kind) {
        return [=](Random& random, Tally& tally) { check(random, kind, tally); };
    };
    const Kind plain{.most = 3}, stable{.most = 3, .inertia = true};
    const auto with = [](Kind kind, auto change) {
        change(kind);
        return kind;
    };
    return {
        {"modes: springs, still fluid", of(check_modes, {.spring = true, .still = true})},
        {"modes: standing links", of(check_modes, {.stands = true, .inertia = true})},
        {"modes: flywheels", of(check_modes, {.wheels = true, .inertia = true})},
        {"modes: flywheels, springs, still fluid",
         of(check_modes, {.spring = true, .wheels = true, .still = true, .inertia = true})},
        {"all roots: standing flywheels", of(check_all_roots, {.wheels = true, .stands = true, .inertia = true})},
        {"all roots: driven flywheels, springs",
         of(check_all_roots, {.spring = true, .wheels = true, .driven = true, .inertia = true})},
        {"all roots: fluid that turns", of(check_all_roots, {.turning = true, .stands = true, .inertia = true})},
        {"counts: springs, still fluid", of(check_counts, {.spring = true, .still = true, .inertia = true})},
        {"counts: flywheels", of(check_counts, {.wheels = true, .inertia = true})},
        {"shapes: chains", of(check_shapes, plain)},
        {"shapes: arms", of(check_shapes, with(plain, [](Kind& k) { k.arm = true; }))},
        {"shapes: springs, arms", of(check_shapes, with(plain, [](Kind& k) { k.spring = k.arm = true; }))},
        {"shapes: flywheels", of(check_shapes, with(plain, [](Kind& k) { k.wheels = k.driven = true; }))},
        {"shapes: fluid that turns", of(check_shapes, with(plain, [](Kind& k) { k.turning = true; }))},
        {"shapes: still fluid, springs", of(check_shapes, with(plain, [](Kind& k) { k.still = k.spring = true; }))},
        {"stability: chains", of(check_stability, stable)},
        {"stability: springs, still fluid",
         of(check_stability, with(stable, [](Kind& k) { k.spring = k.still = true; }))},
        {"stability: flywheels, arms", of(check_stability, with(stable, [](Kind& k) { k.wheels = k.arm = true; }))},
        {"modes: cords with a tip, s^p", [](Random& random, Tally& tally) { check_cord(random, tally); }},
    };
}

}  // namespace

int main(int count, char** given) {
    const long systems = count > 1 ? std::atol(given[1]) : 200;
    const auto seed = static_cast<std::uint64_t>(count > 2 ? std::atoll(given[2]) : 1);
    const std::string only = count > 3 ? given[3] : "";
    std::printf("kind,systems,numbers,outside,unproved,worst_error_over_bound\n");
    long outside = 0;
    for (const Row& row : rows()) {
        if (std::string(row.name).find(only) == std::string::npos) continue;
        Tally tally;
        for (long i = 0; i < systems; ++i) {
            Random random(seed * 1'000'003 + static_cast<std::uint64_t>(i));
            tally.spoilt = false;
            try {
                row.check(random, tally);
            } catch (const revchain::InvalidArgument& refused) {
                if (tally.refused++ == 0) std::fprintf(stderr, "%s: system %ld: %s\n", row.name, i, refused.what());
            }
            if (tally.spoilt && tally.systems_outside++ < 5)
                std::fprintf(stderr, "%s: system %ld is outside\n", row.name, i);
        }
        std::printf("\"%s\",%ld,%ld,%ld,%ld,%.3g\n", row.name, systems - tally.refused, tally.numbers, tally.outside,
                    tally.unproved, tally.worst);
        std::fflush(stdout);
        if (!std::string_view(row.name).starts_with("stability"))
            outside += tally.outside;  // which has no proved bound
    }
    return outside == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
