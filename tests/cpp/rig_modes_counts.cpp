// SPDX-License-Identifier: MPL-2.0
// Truth: counts on assembled matrices in quadruple precision (support/rig_truth.hpp) and, where no count numbers the
// modes, eigenvalues of the dense companion matrix.
#include <Eigen/Eigenvalues>

#include "revchain/rig_modes.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/checked_rig_modes.hpp"
#include "support/rig_truth.hpp"

using namespace revchain;
using Catch::Matchers::ContainsSubstring;
using support::Quad;
using support::Random;
using support::RigTruth;
using support::rig_modes::g;
using support::rig_modes::random_body;

namespace {

enum class Kind { spring, standing, afloat, spinning, both, turning };
constexpr Kind kinds[] = {Kind::spring, Kind::standing, Kind::afloat, Kind::spinning, Kind::both, Kind::turning};
constexpr bool by_discs(Kind kind) { return kind == Kind::both || kind == Kind::turning; }

Rig random_rig(Random& random, Kind kind, Index n) {
    std::vector<Link<double>> links;
    Rigging with;
    if (kind == Kind::turning) with.fluid = Fluid::turning;
    for (Index m = 0; m < n; ++m) {
        links.push_back(random_body(random));
        const Link<double>& b = links.back();
        if (kind == Kind::standing || kind == Kind::both)
            with.posture.push_back(random() < 0.4 ? Posture::stands : Posture::hangs);
        if (kind == Kind::spinning || kind == Kind::both)
            with.flywheels.push_back({b.weight * random.between(-1, 1), 0});
        if (kind == Kind::afloat || kind == Kind::turning)
            with.displaced.push_back({b.weight * random.between(0, kind == Kind::afloat ? 0.9 : 1.8), b.centroid,
                                      b.gyration_ratio, kind == Kind::afloat ? b.weight * random() : 0});
    }
    if (kind == Kind::spring) with.support = {random.log_between(0.1, 100), 0.3, 0};
    return Rig(Chain<double>(links), with);
}

/// The modes of a sense that are slower than a speed, by the truth.
Index slower(const RigTruth& truth, const Rig& rig, Kind kind, double speed) {
    const Quad n = speed;
    if (kind == Kind::spinning) return truth.at_speed(n);
    Index before = 0;
    if (kind == Kind::standing)
        for (Index m = 0; m < rig.size(); ++m) before += rig.stands(m) ? 1 : 0;
    return truth.negative(1, 0, n * n / Quad(g)) - before;
}

}  // namespace

TEST_CASE("count_modes of rigs: counts in quadruple precision, and next to every speed", "[linear]") {
    Random random(81);
    int discs = 0;
    for (const Kind kind : kinds)
        for (const Index n : {1, 2, 5, 12, 60}) {
            const Rig rig = random_rig(random, kind, n);
            const RigTruth truth(rig);
            const auto m = modes(rig, {.count = all_modes});
            CAPTURE(static_cast<int>(kind), n, m.method);
            discs += m.method == revchain::RigMethod::discs ? 1 : 0;
            if (!by_discs(kind)) CHECK(m.method != revchain::RigMethod::discs);
            REQUIRE(m.complete);
            const RigModeCounter counter(rig);
            CHECK(static_cast<Index>(m.other.size()) == m.other_available);
            for (const bool forward : {true, false}) {
                const WhirlModes& sense = forward ? m.forward : m.backward;
                const double sign = forward ? 1 : -1;
                for (Index j = 0; j < sense.size(); ++j) {
                    const double speed = sign * sense.angular_speed[j];
                    CHECK(counter.below_speed(speed * (1 + 3 * 0x1p-52)) == j + 1);
                    CHECK(counter.below_speed(speed * (1 - 3 * 0x1p-52)) == j);
                    if (!m.has_momentum) CHECK(counter.below_speed(-speed * (1 + 1e-9)) == j + 1);
                    const double height = sense.conical_height[j];
                    Index opposite = 0;
                    if (m.has_momentum)
                        for (const double other : (forward ? m.backward : m.forward).conical_height)
                            opposite += other > height;
                    CHECK(counter.above_height(height * (1 - 5 * 0x1p-52)) == j + 1 + opposite);
                    CHECK(counter.above_height(height * (1 + 5 * 0x1p-52)) == j + opposite);
                }
                if (sense.size() > 0) {
                    CHECK(counter.below_speed(sign * 1e150) == sense.available);
                    CHECK(counter.below_speed(sign * 1e-150) == 0);
                }
            }
            CHECK(counter.above_height(1e-250) == m.forward.available + m.backward.available);
            CHECK(counter.above_height(1e250) == 0);
            if (by_discs(kind)) continue;
            for (int i = 0; i < 40; ++i) {
                const double speed = random.log_between(0.1, 1e3) * (kind == Kind::spinning && i % 2 == 0 ? -1 : 1);
                CHECK(count_modes(rig, {.angular_speed = speed}) == slower(truth, rig, kind, speed));
            }
        }
    CHECK(discs >= 6);
}

TEST_CASE("count_modes of rigs by discs: the real eigenvalues of the dense companion matrix", "[linear]") {
    Random random(82);
    for (const Index n : {2, 6, 20})
        for (const Kind kind : {Kind::both, Kind::turning}) {
            const Rig rig = random_rig(random, kind, n);
            const RigTruth truth(rig);
            const RigModeCounter counter(rig);
            const bool spins = kind == Kind::both;
            const Index size = spins ? 2 * n : n;
            Matrix<double> C = Matrix<double>::Zero(size, size);
            const Matrix<double> inverse = (truth.dense<double>(truth.M) / g).inverse();
            if (spins) {
                C << Matrix<double>::Zero(n, n), Matrix<double>::Identity(n, n), inverse * truth.dense<double>(truth.K),
                    inverse * truth.dense<double>(truth.G);
            } else {
                C = inverse * truth.dense<double>(truth.K);
            }
            const Eigen::EigenSolver<Matrix<double>> dense(C, false);
            std::vector<double> real;
            for (Index i = 0; i < size; ++i) {
                const std::complex<double> z = dense.eigenvalues()[i];
                if (std::abs(z.imag()) > 1e-9 * std::abs(z)) continue;
                if (spins)
                    real.push_back(z.real());
                else if (z.real() > 0)
                    real.push_back(std::sqrt(z.real()));
            }
            for (int i = 0; i < 60; ++i) {
                const double speed = random.log_between(0.3, 300) * (spins && i % 2 == 0 ? -1 : 1);
                const auto near = [&](double x) { return std::abs(x / speed - 1) < 1e-6; };
                if (std::any_of(real.begin(), real.end(), near)) continue;
                const auto slow = [&](double x) { return x / speed > 0 && x / speed < 1; };
                CAPTURE(n, spins, speed);
                CHECK(counter.below_speed(speed) == std::count_if(real.begin(), real.end(), slow));
            }
        }
}

TEST_CASE("count_modes of rigs: ties, a chain without rigging, refusals", "[linear]") {
    // The height of a plummet on a spring is its length and weight/stiffness: 1 + 1/2.
    const Rig one(Chain<double>(std::vector{plummet(1.0, 1.0)}), {.support = {2, 0, 0}});
    CHECK(count_modes(one, {.conical_height = 1.5}) == 0);
    CHECK(count_modes(one, {.conical_height = std::nextafter(1.5, 0.0)}) == 1);
    CHECK(count_modes(one, {.angular_speed = 2.0, .gravity = 6.0}) == 0);  // n^2 = g / 1.5
    CHECK(count_modes(one, {.angular_speed = std::nextafter(2.0, 3.0), .gravity = 6.0}) == 1);
    // A n^2 - H n - W h = 0 with A = W a^2/g: n^2 - n - 2 = 0 has the roots 2 and -1.
    const Rig spun(Chain<double>(std::vector{plummet(2.0, 1.0)}), {.flywheels = {{1, 0}}});
    for (const double n : {2.0, -1.0}) {
        CHECK(count_modes(spun, {.angular_speed = n, .gravity = 2.0}) == 0);
        CHECK(count_modes(spun, {.angular_speed = n * (1 + 0x1p-52), .gravity = 2.0}) == 1);
        CHECK(count_modes(spun, {.angular_speed = n * (1 - 0x1p-52), .gravity = 2.0}) == 0);
    }
    CHECK(count_modes(spun, {.conical_height = 1.0, .gravity = 2.0}) == 1);
    // A wheel on a standing plummet, A n^2 + H n + W h = 0: n^2 - n + 2/9 = 0 has the roots 1/3 and 2/3, by discs.
    const Rig asleep(Chain<double>(std::vector{plummet(9.0, 2.0)}),
                     {.posture = {Posture::stands}, .flywheels = {{-81, 0}}});
    CHECK(modes(asleep, {.gravity = 4.0 / 9}).method == revchain::RigMethod::discs);
    for (const double n : {1 / 3.0, 2 / 3.0}) {
        CAPTURE(n);
        const Index slower = n > 0.5 ? 1 : 0;
        CHECK(count_modes(asleep, {.angular_speed = n * (1 + 4e-16), .gravity = 4.0 / 9}) == slower + 1);
        CHECK(count_modes(asleep, {.angular_speed = n * (1 - 4e-16), .gravity = 4.0 / 9}) == slower);
    }
    const auto rods = Chain<double>::uniform_rods(50);
    for (const double speed : {3.0, 40.0, 900.0})
        CHECK(count_modes(Rig(rods, {}), {.angular_speed = speed}) == count_modes(rods, {.angular_speed = speed}));
    CHECK(count_modes(Rig(rods, {}), {.conical_height = 0.1}) == count_modes(rods, {.conical_height = 0.1}));

    CHECK_THROWS_WITH(count_modes(one, {}), ContainsSubstring("give either"));
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
        CHECK_THROWS_WITH(count_modes(one, {.conical_height = bad}), ContainsSubstring("must be positive"));
        CHECK_THROWS_WITH(count_modes(one, {.angular_speed = 1.0, .gravity = bad}), ContainsSubstring("gravity"));
        if (bad != -1) CHECK_THROWS_WITH(count_modes(one, {.angular_speed = bad}), ContainsSubstring("not 0"));
    }
}

TEST_CASE("windows of rigs: the modes between two counts, none lost and none twice", "[linear]") {
    Random random(83);
    for (const Kind kind : kinds)
        for (const Index n : {1, 4, 25}) {
            const Rig rig = random_rig(random, kind, n);
            const auto all = modes(rig, {.count = all_modes});
            const double inf = std::numeric_limits<double>::infinity();
            std::vector<double> cuts{0.0};
            for (int i = 0; i < 5; ++i) cuts.push_back(cuts.back() + random.log_between(0.5, 30));
            if (all.forward.size() > 0) cuts.push_back(all.forward.angular_speed[0]);  // an end at a speed
            std::sort(cuts.begin(), cuts.end());
            cuts.push_back(inf);
            Index forward = 0, backward = 0;
            for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
                const auto part = modes(rig, {.angular_speed = {{cuts[i], cuts[i + 1]}}});
                for (const auto& [sense, whole, before] : {std::tuple(&part.forward, &all.forward, &forward),
                                                           std::tuple(&part.backward, &all.backward, &backward)}) {
                    CHECK(sense->first == *before + 1);
                    CHECK(sense->available == whole->available);
                    for (Index j = 0; j < sense->size(); ++j) {
                        const Index k = *before + j;
                        CHECK(std::abs(sense->angular_speed[j] / whole->angular_speed[k] - 1) <= 2.3e-16);
                        CHECK((sense->shape(j) - whole->shape(k)).cwiseAbs().maxCoeff() <= 1e-12);
                    }
                    *before += sense->size();
                }
            }
            CHECK(forward == all.forward.available);
            CHECK(backward == all.backward.available);
            const auto low = modes(rig, {.conical_height = {{0.2, inf}}}),
                       rest = modes(rig, {.conical_height = {{0, 0.2}}});
            CHECK(low.forward.size() + rest.forward.size() == all.forward.available);
            CHECK(rest.forward.first == low.forward.size() + 1);
            for (const double height : low.forward.conical_height) CHECK(height >= 0.2);
        }
    const Rig rig = random_rig(random, Kind::spring, 3);
    CHECK_THROWS_WITH(modes(rig, {.count = 2, .angular_speed = {{1.0, 2.0}}}), ContainsSubstring("not several"));
    CHECK_THROWS_WITH(modes(rig, {.angular_speed = {{2.0, 1.0}}}), ContainsSubstring("must exceed its low end"));
    CHECK_THROWS_WITH(modes(rig, {.conical_height = {{-1.0, 1.0}}}), ContainsSubstring("not negative"));
}

TEST_CASE("certificates of rigs: counts in quadruple precision", "[linear]") {
    Random random(84);
    for (const Kind kind : kinds)
        for (const Index n : {1, 3, 20}) {
            const Rig rig = random_rig(random, kind, n);
            const RigTruth truth(rig);
            const auto m = modes(rig, {.count = all_modes, .certify = true});
            CAPTURE(static_cast<int>(kind), n);
            for (const bool forward : {true, false}) {
                const WhirlModes& sense = forward ? m.forward : m.backward;
                const auto& proof = sense.certificate;
                REQUIRE(proof.lower.size() == sense.size());
                for (Index j = 0; j < sense.size(); ++j) {
                    CHECK(proof.lower[j] < sense.conical_height[j]);
                    CHECK(sense.conical_height[j] < proof.upper[j]);
                    CHECK(proof.upper[j] - proof.lower[j] <= 8e-15 * sense.conical_height[j]);
                    CHECK(proof.above_lower[j] == j + 1);
                    CHECK(proof.above_upper[j] == j);
                    for (const bool upper : {false, true}) {
                        if (by_discs(kind)) break;
                        const Quad height = (upper ? proof.upper : proof.lower)[j];
                        const Quad speed = (forward ? 1 : -1) * sqrtq(Quad(g) / height);
                        Index standing = 0;
                        for (Index k = 0; k < rig.size(); ++k) standing += rig.stands(k) ? 1 : 0;
                        const Index count = kind == Kind::spinning ? truth.at_speed(speed)
                                                                   : truth.negative(1, 0, 1 / height) - standing;
                        CHECK(count == (upper ? proof.above_upper : proof.above_lower)[j]);
                    }
                }
            }
        }
    const auto rods = Chain<double>::uniform_rods(9);
    const auto plain = modes(rods, {.count = 3, .certify = true}).certificate;
    const auto same = modes(Rig(rods, {}), {.count = 3, .certify = true}).forward.certificate;
    CHECK(same.lower == plain.lower);
    CHECK(same.above_upper == plain.above_upper);
}

TEST_CASE("modes of rigs: a tolerance is kept or said not to be; others are counted, and listed if asked for",
          "[linear]") {
    Random random(85);
    for (const Kind kind : kinds) {
        const Rig rig = random_rig(random, kind, 8);
        const auto m = modes(rig, {.count = 2}), loose = modes(rig, {.count = 2, .rtol = 1e-3});
        CHECK(loose.forward.conical_height == m.forward.conical_height);
        CHECK(loose.status == Status::success);
        if (m.forward.size() > 0) CHECK(modes(rig, {.count = 2, .rtol = 1e-17}).status == Status::tolerance_not_met);
        CHECK_THROWS_WITH(modes(rig, {.rtol = -1.0}), ContainsSubstring("rtol"));
        const auto brief = modes(rig, {.count = 2, .other = false});
        CHECK(brief.other_available == static_cast<Index>(m.other.size()));
        CHECK(brief.complete);
        if (!by_discs(kind)) CHECK(brief.other.empty());
    }
    std::vector<Posture> posture;
    for (Index m = 0; m < 10'000; ++m) posture.push_back(random() < 0.4 ? Posture::stands : Posture::hangs);
    const Rig column(Chain<double>::uniform_rods(10'000), {.posture = posture});
    const auto few = modes(column, {.count = 3, .other = false});
    CHECK(few.complete);
    CHECK(few.other_available == std::count(posture.begin(), posture.end(), Posture::stands));
    CHECK(few.forward.error_bound.maxCoeff() <= 2.3e-16);
}
