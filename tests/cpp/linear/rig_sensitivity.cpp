// SPDX-License-Identifier: MPL-2.0
#include "revchain/sensitivity.hpp"

#include "revchain/rig_modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/rig_truth.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using support::Quad;

namespace {

/// Three links with a flywheel each, in a fluid, the top one's support on a spring, the middle one standing; all energies
/// written out in quadruple precision, y of four pins.
struct Rigged {
    static constexpr std::size_t n = 3;
    std::array<Quad, n> W{3, 1, 2}, a{1, 0.5, 2}, h{0.75, 0.25, 1.25}, k{0.5, 0.125, 0.75};
    std::array<Quad, n> H{0.5, -0.25, 1.5}, B{0.25, 0.0625, 0.5}, hB{0.5, 0.25, 1}, kB{0.25, 0.125, 0.5},
        added{0.5, 0, 0.25}, C{0.125, 0, 0.375};
    std::array<int, n> sign{1, -1, 1};
    Quad E = 40, carriage = 1.5, g = Quad(9.8125);
    bool turning = false;

    using Matrix = std::array<std::array<Quad, 4>, 4>;
    /// K + n G - n^2 M/g
    Matrix matrix(Quad speed) const {
        Matrix A{};
        const auto square = [&](std::size_t m, Quad lower, Quad upper, Quad by) {  // by (lower y_m + upper y_{m+1})^2
            A[m][m] += by * lower * lower, A[m + 1][m + 1] += by * upper * upper;
            A[m][m + 1] += by * lower * upper, A[m + 1][m] += by * lower * upper;
        };
        Quad below = 0;
        const Quad turn = speed * speed / g;
        for (std::size_t m = 0; m < n; ++m) {
            const Quad kappa = W[m] * h[m] - B[m] * hB[m] + a[m] * below;
            square(m, 1, -1, sign[m] * (kappa + speed * H[m]) / (a[m] * a[m]));
            const auto body = [&](Quad w, Quad c, Quad r) {
                square(m, c / a[m], 1 - c / a[m], -turn * w);
                square(m, 1, -1, -turn * w * r * r / (a[m] * a[m]));
            };
            square(m, 1, -1, turn * C[m] / (a[m] * a[m]));
            body(W[m], h[m], k[m]);
            body(turning ? -B[m] : added[m], hB[m], kB[m]);
            below += W[m] - B[m];
        }
        A[3][3] += E - turn * carriage;
        return A;
    }
    Quad determinant(Quad speed) const {
        Matrix A = matrix(speed);
        Quad d = 1;
        for (std::size_t i = 0; i < 4; ++i) {
            d *= A[i][i];
            for (std::size_t r = i + 1; r < 4; ++r) {
                const Quad f = A[r][i] / A[i][i];
                for (std::size_t c = i; c < 4; ++c) A[r][c] -= f * A[i][c];
            }
        }
        return d;
    }
    /// The whirl speed next to one.
    Quad speed(Quad from) const {
        for (int round = 0; round < 80; ++round) {
            const Quad step = Quad(1e-12) * from, d = determinant(from);
            const Quad change = d * 2 * step / (determinant(from + step) - determinant(from - step));
            from -= change;
            if (fabsq(change) < 1e-30 * fabsq(from)) break;
        }
        return from;
    }
    revchain::Vector<double> shape(Quad at) const {
        const Matrix A = matrix(at);
        std::array<Quad, 4> y{1, 0, 0, 0};
        for (std::size_t m = 0; m < 3; ++m) {
            Quad sum = 0;
            for (std::size_t c = 0; c <= m; ++c) sum += A[m][c] * y[c];
            y[m + 1] = -sum / A[m][m + 1];
        }
        revchain::Vector<double> result(4);
        for (std::size_t m = 0; m < 4; ++m) result[static_cast<Index>(m)] = static_cast<double>(y[m]);
        return result;
    }
    revchain::Rig rig() const {
        const auto d = [](Quad x) { return static_cast<double>(x); };
        std::vector<revchain::Link<double>> links;
        revchain::Rigging with{.support = revchain::horizontal_spring(d(E), d(carriage)),
                               .fluid = turning ? revchain::Fluid::turning : revchain::Fluid::still};
        for (std::size_t m = 0; m < n; ++m) {
            links.push_back(revchain::compound_pendulum<double>(
                {.weight = d(W[m]), .length = d(a[m]), .centroid = d(h[m]), .radius_of_gyration = d(k[m])}));
            with.posture.push_back(sign[m] > 0 ? revchain::Posture::hangs : revchain::Posture::stands);
            with.flywheels.push_back({d(H[m]), d(C[m])});
            const double ratio = d(kB[m] * kB[m] / (a[m] * a[m]));
            with.displaced.push_back({d(B[m]), d(hB[m]), ratio, turning ? 0 : d(added[m])});
        }
        return {Chain<double>(links), with};
    }
};

}  // namespace

TEST_CASE("what links and rigging do to whirl speeds is what central differences in quadruple precision say",
          "[linear]") {
    double worst = 0;
    for (const bool turning : {false, true})
        for (const double start : {-9.0, -5.0, -2.0, 1.5, 4.0, 8.0, 14.0}) {
            Rigged rigged;
            rigged.turning = turning;
            const Quad speed = rigged.speed(start);
            if (!(fabsq(rigged.determinant(speed)) < 1e-20)) continue;
            const auto found = revchain::sensitivity(rigged.rig(), static_cast<double>(speed), rigged.shape(speed),
                                                     static_cast<double>(rigged.g));
            const auto difference = [&](Quad& x) {
                const Quad was = x, step = 1e-10;
                x = was + step;
                const Quad up = rigged.speed(speed);
                x = was - step;
                const Quad down = rigged.speed(speed);
                x = was;
                return static_cast<double>((up - down) / (2 * step));
            };
            double largest = 0;
            std::vector<double> errors;
            const auto compare = [&](double value, double exact) {
                errors.push_back(std::abs(value - exact));
                largest = std::max(largest, std::abs(exact));
            };
            for (std::size_t m = 0; m < 3; ++m) {
                const Index i = static_cast<Index>(m);
                compare(found.momentum[i], difference(rigged.H[m]));
                compare(found.displaced_weight[i], difference(rigged.B[m]));
                compare(found.added_weight[i], turning ? 0 : difference(rigged.added[m]));
                const double by_length = difference(rigged.a[m]), by_centroid = difference(rigged.h[m]),
                             by_radius = difference(rigged.k[m]);
                compare(found.weight[i], difference(rigged.W[m]));
                compare(found.length[i], by_length);
                compare(found.centroid[i], by_centroid);
                compare(found.radius_of_gyration[i], by_radius);
                const auto d = [](Quad x) { return static_cast<double>(x); };
                compare(found.length_in_proportion[i],
                        by_length + (d(rigged.h[m]) * by_centroid + d(rigged.k[m]) * by_radius) / d(rigged.a[m]));
            }
            compare(found.stiffness, difference(rigged.E));
            compare(found.carriage_weight, difference(rigged.carriage));
            CAPTURE(turning, start, static_cast<double>(speed));
            for (const double error : errors) {
                CHECK(error <= 1e-13 * largest);
                worst = std::max(worst, error / largest);
            }
        }
    CAPTURE(worst);
    CHECK(worst > 0);
    CHECK(worst < 1e-14);
}

namespace {

/// A rig's data, each a number of few bits, so that a small change of it is exact.
struct Data {
    std::vector<double> weight, length, centroid, radius, momentum, displaced, buoyancy_centre, buoyancy_radius, added;
    double stiffness = 0, carriage = 0;
    bool firm = true, turning = false, fluid = false;

    Data(support::Random& random, std::size_t n) {
        const auto number = [&](double low, double high) {
            return std::ldexp(std::rint(random.log_between(low, high) * 1024), -10);
        };
        firm = random() < 0.5, fluid = random() < 0.5, turning = random() < 0.5;
        const bool spins = random() < 0.6;
        stiffness = number(1, 100), carriage = number(0.1, 2);
        for (std::size_t m = 0; m < n; ++m) {
            weight.push_back(number(0.5, 8)), length.push_back(number(0.25, 2));
            centroid.push_back(length.back() * std::ldexp(std::rint(random.between(3, 30)), -5));
            radius.push_back(number(0.05, 0.5));
            momentum.push_back(spins ? number(0.1, 2) * (random() < 0.5 ? -1 : 1) : 0);
            displaced.push_back(fluid ? number(0.01, 0.3) : 0);
            added.push_back(fluid && !turning ? number(0.01, 0.3) : 0);
            buoyancy_centre.push_back(fluid ? length.back() / 2 : centroid.back());
            buoyancy_radius.push_back(fluid ? 0.125 : radius.back());
        }
    }
    /// With `in_default_fluid` the entries of links that displace nothing are left at their defaults.
    revchain::Rig rig(bool in_default_fluid) const {
        std::vector<revchain::Link<double>> links;
        revchain::Rigging with{.fluid = turning ? revchain::Fluid::turning : revchain::Fluid::still};
        if (!firm) with.support = revchain::horizontal_spring(stiffness, carriage);
        for (std::size_t m = 0; m < weight.size(); ++m) {
            links.push_back(revchain::compound_pendulum<double>(
                {.weight = weight[m], .length = length[m], .centroid = centroid[m], .radius_of_gyration = radius[m]}));
            with.flywheels.push_back({momentum[m], 0});
            const revchain::Wide<double> ratio =
                revchain::detail::gyration_from_radius<double>("test", length[m], buoyancy_radius[m]);
            if (!in_default_fluid) with.displaced.push_back({displaced[m], buoyancy_centre[m], ratio, added[m]});
        }
        return {Chain<double>(links), with};
    }
    Quad determinant(Quad n) const { return support::RigTruth(rig(false)).determinant(n); }
};

}  // namespace

TEST_CASE("10,000 random rigs: bounds of speeds, and derivatives against differences in quadruple precision",
          "[linear]") {
    support::Random random(16);
    double worst = 0;
    int compared = 0;
    for (int round = 0; round < 10'000; ++round) {
        const std::size_t n = 1 + static_cast<std::size_t>(random() * 3);
        Data data(random, n);
        const revchain::Rig rig = data.rig(!data.fluid && random() < 0.5);
        const auto modes = revchain::modes(rig, {.count = revchain::all_modes});
        const auto& some = modes.backward.size() > 0 && random() < 0.5 ? modes.backward : modes.forward;
        if (some.size() == 0) continue;
        const Index j = static_cast<Index>(random() * static_cast<double>(some.size()));
        const double speed = some.angular_speed[j] * (&some == &modes.backward ? -1 : 1);
        const auto found = revchain::sensitivity(rig, speed, some.shape(j));
        // dn/dx = -(d det/dx) / (d det/dn) at the exact speed, by differences of the fourth order
        const auto fourth = [](const auto& f, Quad step) {
            return (8 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12 * step);
        };
        Quad exact = speed;
        const auto by_speed = [&] {
            return fourth([&](Quad x) { return data.determinant(exact + x); }, exact * Quad(0x1p-20));
        };
        for (int step = 0; step < 3; ++step) exact -= data.determinant(exact) / by_speed();
        const Quad slope = by_speed();
        CHECK(static_cast<double>(fabsq((exact - Quad(speed)) / exact)) <= some.speed_error_bound[j]);
        std::vector<std::pair<double, double>> pairs;  // found and exact, per relative change of the datum
        const auto compare = [&](double value, double& datum, double size) {
            const double was = datum, unit = std::exp2(std::floor(std::log2(size)) - 20);
            const auto f = [&](Quad x) {
                datum = was + static_cast<double>(x);
                return data.determinant(exact);
            };
            // what cannot be negative is varied to one side of 0
            const Quad h = unit,
                       change = was != 0
                                    ? fourth(f, h)
                                    : (48 * f(h) - 25 * f(0) - 36 * f(2 * h) + 16 * f(3 * h) - 3 * f(4 * h)) / (12 * h);
            datum = was;
            pairs.emplace_back(value * size, static_cast<double>(-change / slope * size));
        };
        for (std::size_t m = 0; m < n; ++m) {
            const Index i = static_cast<Index>(m);
            compare(found.weight[i], data.weight[m], data.weight[m]);
            compare(found.length[i], data.length[m], data.length[m]);
            compare(found.centroid[i], data.centroid[m], data.length[m]);
            compare(found.radius_of_gyration[i], data.radius[m], data.radius[m]);
            compare(found.momentum[i], data.momentum[m], 1);
            compare(found.displaced_weight[i], data.displaced[m], data.weight[m]);
            if (data.fluid ? !data.turning : rig.fluid() == revchain::Fluid::still)
                compare(found.added_weight[i], data.added[m], data.weight[m]);
        }
        if (!data.firm) {
            compare(found.stiffness, data.stiffness, data.stiffness);
            compare(found.carriage_weight, data.carriage, data.carriage);
        }
        double largest = std::abs(speed), off = 0;
        for (const auto& [value, truth] : pairs)
            largest = std::max(largest, std::abs(truth)), off = std::max(off, std::abs(value - truth));
        CAPTURE(round, n, speed, data.fluid, data.turning, data.firm, off / largest);
        CHECK(off <= 1e-14 * largest);
        worst = std::max(worst, off / largest);
        ++compared;
    }
    CAPTURE(worst);
    CHECK(compared > 9000);
    CHECK(worst > 0);
}

TEST_CASE("a firm support has no stiffness to change, and units are units", "[linear]") {
    const Chain<double> one({revchain::plummet(2.0, 3.0)});
    const revchain::Rig rig(one, {.flywheels = {{0.75, 0}}});
    // A n^2 - H n - W h = 0, A = W h l/g: dn/dH = n/(2 A n - H)
    const double A = 18 / 9.80665, n = (0.75 + std::sqrt(0.75 * 0.75 + 4 * A * 6)) / (2 * A);
    const auto found = revchain::sensitivity(rig, n, (revchain::Vector<double>(2) << 1, 0).finished());
    CHECK(std::abs(found.momentum[0] / (n / (2 * A * n - 0.75)) - 1) < 1e-15);
    CHECK(found.stiffness == 0);
    CHECK(found.carriage_weight == 0);
    CHECK_THROWS_AS(revchain::sensitivity(rig, 0.0, revchain::Vector<double>::Ones(2)), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::sensitivity(rig, 1.0, revchain::Vector<double>::Ones(3)), revchain::InvalidArgument);
}

TEST_CASE("the momentum that a speed asks for makes it a whirl speed", "[linear]") {
    double worst = 0;
    for (const bool turning : {false, true})
        for (const double speed : {-7.0, -1.25, 2.5, 6.0})
            for (const std::size_t link : {1U, 2U, 3U}) {
                Rigged rigged;
                rigged.turning = turning;
                const double momentum =
                    revchain::momentum_for_speed(rigged.rig(), static_cast<Index>(link) - 1, speed, 9.8125);
                rigged.H[link - 1] = momentum;
                const Quad near = rigged.speed(speed);
                CAPTURE(turning, speed, link, momentum);
                worst = std::max(worst, std::abs(static_cast<double>(near - speed) / speed));
            }
    CAPTURE(worst);
    CHECK(worst < 1e-14);
    const Chain<double> one({revchain::plummet(2.0, 3.0)});
    const double A = 18 / 9.80665;
    CHECK(std::abs(revchain::momentum_for_speed(revchain::Rig(one, {}), 0, 2.0) / (A * 2 - 3) - 1) < 1e-15);
    CHECK_THROWS_AS(revchain::momentum_for_speed(revchain::Rig(one, {}), 1, 2.0), revchain::InvalidArgument);
}

TEST_CASE("the stiffness that a speed asks for makes it a whirl speed", "[linear]") {
    double worst = 0;
    int found = 0;
    for (const bool turning : {false, true})
        for (const double speed : {-7.0, -3.0, -1.25, 1.0, 2.5, 4.0, 6.0}) {
            Rigged rigged;
            rigged.turning = turning;
            double stiffness = 0;
            try {
                stiffness = revchain::stiffness_for_speed(rigged.rig(), speed, 9.8125);
            } catch (const revchain::InvalidArgument&) {
                continue;  // a spring cannot pull outwards
            }
            ++found;
            rigged.E = stiffness;
            const Quad near = rigged.speed(speed);
            CAPTURE(turning, speed, stiffness);
            worst = std::max(worst, std::abs(static_cast<double>(near - speed) / speed));
        }
    CAPTURE(worst);
    CHECK(found >= 4);
    CHECK(worst < 1e-14);
    const Chain<double> one({revchain::plummet(2.0, 3.0)});  // height 6 = length 3 + weight/stiffness
    const revchain::Rig rig(one, {.support = {.stiffness = 1.0}});
    CHECK(std::abs(revchain::stiffness_for_speed(rig, 1.0, 6.0) / (2.0 / 3) - 1) < 1e-15);
    CHECK_THROWS_AS(revchain::stiffness_for_speed(rig, 2.0, 6.0), revchain::InvalidArgument);  // height 1.5
    CHECK_THROWS_AS(revchain::stiffness_for_speed(rig, 0.0), revchain::InvalidArgument);
}

TEST_CASE("what rig_modes finds: derivatives of its speeds, and the momentum that gives one back", "[linear]") {
    Rigged rigged;
    rigged.sign = {1, 1, 1};
    const auto speeds = [&] {
        return revchain::modes(rigged.rig(), {.count = revchain::all_modes, .gravity = 9.8125});
    };
    const auto modes = speeds();
    const double step = 0x1p-20;
    for (std::size_t m = 0; m < 3; ++m) {
        const Quad was = rigged.H[m];
        rigged.H[m] = was + step;
        const auto up = speeds();
        rigged.H[m] = was - step;
        const auto down = speeds();
        rigged.H[m] = was;
        for (const int sense : {1, -1}) {
            const auto& some = sense > 0 ? modes.forward : modes.backward;
            REQUIRE(some.size() == 3 + 1);  // the carriage's, too
            for (Index j = 0; j < some.size(); ++j) {
                const double n = sense * some.angular_speed[j];
                const double more = (sense > 0 ? up.forward : up.backward).angular_speed[j],
                             less = (sense > 0 ? down.forward : down.backward).angular_speed[j];
                const auto found = revchain::sensitivity(rigged.rig(), n, some.shape(j), 9.8125);
                CAPTURE(m, sense, j, n);
                // the step squared, and what is left of the speeds' digits
                CHECK(std::abs(found.momentum[static_cast<Index>(m)] - sense * (more - less) / (2 * step)) <
                      2e-9 * (1 + std::abs(n)));
                const double momentum = revchain::momentum_for_speed(rigged.rig(), static_cast<Index>(m), n, 9.8125);
                CHECK(std::abs(momentum - static_cast<double>(was)) * std::abs(found.momentum[static_cast<Index>(m)]) <=
                      4e-16 * std::abs(n) * (1 + std::abs(found.momentum[static_cast<Index>(m)])));
            }
        }
    }
}
