// SPDX-License-Identifier: MPL-2.0
#include "revchain/finite/shapes/several_inclinations.hpp"

#include <map>

#include "revchain/modes.hpp"
#include "revchain/steady_shapes.hpp"
#include "revchain/two_links.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/tier.hpp"
#include "support/truth.hpp"

using revchain::Chain;
using revchain::Index;
using revchain::SteadyShape;
using revchain::SteadyShapes;
using support::Quad;
using support::quad;
using support::Random;

namespace {

using Angles = std::vector<Quad>;

/// The steady state from the effective potential itself, in quadruple precision, with nothing in common with the library:
/// U = -sum kappa cos d - (1/2 lambda) sum (W y_G^2 + W rho^2 sin^2 d), its gradient  lambda kappa sin d - cos d (G sin d)
/// in the angles of the links.
class Potential {
   public:
    Potential(const Chain<double>& chain, double height) : n_(static_cast<std::size_t>(chain.size())), lambda_(height) {
        G_.assign(n_ * n_, 0), kappa_.assign(n_, 0), length_.assign(n_, 0);
        Quad below = 0;
        for (std::size_t m = 0; m < n_; ++m) length_[m] = chain.link(static_cast<Index>(m)).length;
        for (std::size_t m = 0; m < n_; ++m) {
            const auto link = chain.link(static_cast<Index>(m));
            const Quad W = link.weight, h = link.centroid, a = link.length;
            kappa_[m] = W * h + a * below;
            below += W;
            Angles reach(n_, 0);  // y_G of the sines
            reach[m] = h;
            for (std::size_t r = m + 1; r < n_; ++r) reach[r] = length_[r];
            for (std::size_t r = 0; r < n_; ++r)
                for (std::size_t q = 0; q < n_; ++q) G_[r * n_ + q] += W * reach[r] * reach[q];
            G_[m * n_ + m] += W * quad(link.gyration_ratio) * a * a;
        }
    }

    /// Newton's method; false where it does not settle.
    bool refine(Angles& d, int rounds) const {
        for (int round = 0; round < rounds; ++round) {
            std::vector<Quad> J(n_ * n_), F(n_), s(n_), c(n_);
            for (std::size_t m = 0; m < n_; ++m) s[m] = sinq(d[m]), c[m] = cosq(d[m]);
            for (std::size_t m = 0; m < n_; ++m) {
                Quad pull = 0;
                for (std::size_t r = 0; r < n_; ++r) {
                    pull += G_[m * n_ + r] * s[r];
                    J[m * n_ + r] = -c[m] * G_[m * n_ + r] * c[r];
                }
                F[m] = lambda_ * kappa_[m] * s[m] - c[m] * pull;
                J[m * n_ + m] += lambda_ * kappa_[m] * c[m] + s[m] * pull;
            }
            if (eliminate(J, F) == 0) return false;
            Quad largest = 0;
            for (const Quad& step : F) largest = fmaxq(largest, fabsq(step));
            for (std::size_t m = 0; m < n_; ++m) d[m] -= F[m] * (largest > Quad(0.5) ? Quad(0.5) / largest : Quad(1));
            if (largest < Quad(1e-30)) return true;
        }
        return false;
    }

    /// (-1)^index of the potential: the sign of  det(lambda diag(kappa sec^3 d) - G).
    int sign_at(const std::vector<Quad>& cosine) const {
        std::vector<Quad> H(n_ * n_), none(n_);
        for (std::size_t i = 0; i < n_ * n_; ++i) H[i] = -G_[i];
        for (std::size_t m = 0; m < n_; ++m) H[m * n_ + m] += lambda_ * kappa_[m] / (cosine[m] * cosine[m] * cosine[m]);
        return eliminate(H, none);
    }

    /// Solves A x = b in b; the sign of the determinant.
    int eliminate(std::vector<Quad>& A, std::vector<Quad>& b) const {
        int sign = 1;
        for (std::size_t j = 0; j < n_; ++j) {
            std::size_t pivot = j;
            for (std::size_t i = j + 1; i < n_; ++i)
                if (fabsq(A[i * n_ + j]) > fabsq(A[pivot * n_ + j])) pivot = i;
            if (A[pivot * n_ + j] == 0) return 0;
            if (pivot != j) {
                sign = -sign;
                for (std::size_t r = 0; r < n_; ++r) std::swap(A[j * n_ + r], A[pivot * n_ + r]);
                std::swap(b[j], b[pivot]);
            }
            if (A[j * n_ + j] < 0) sign = -sign;
            for (std::size_t i = j + 1; i < n_; ++i) {
                const Quad share = A[i * n_ + j] / A[j * n_ + j];
                for (std::size_t r = j; r < n_; ++r) A[i * n_ + r] -= share * A[j * n_ + r];
                b[i] -= share * b[j];
            }
        }
        for (std::size_t j = n_; j-- > 0;) {
            for (std::size_t r = j + 1; r < n_; ++r) b[j] -= A[j * n_ + r] * b[r];
            b[j] /= A[j * n_ + j];
        }
        return sign;
    }

    /// The number of shapes as the height goes to 0: each link is horizontal (sine +-1) or bears no load, (G s)_m = 0,
    /// and then hangs or stands.
    long count_at_no_height() const {
        long count = 0;
        for (unsigned free = 0; free + 1 < 1U << n_; ++free)
            for (unsigned to_left = 0; to_left < 1U << n_; ++to_left) {
                if (to_left & free) continue;
                std::vector<Quad> A(n_ * n_, 0), s(n_, 0);
                for (std::size_t m = 0; m < n_; ++m) {
                    if (free >> m & 1U) {
                        for (std::size_t r = 0; r < n_; ++r) A[m * n_ + r] = G_[m * n_ + r];
                    } else {
                        A[m * n_ + m] = 1;
                        s[m] = to_left >> m & 1U ? -1 : 1;
                    }
                }
                REQUIRE(eliminate(A, s) != 0);
                bool within = true;
                long postures = 1;
                for (std::size_t m = 0; m < n_; ++m) {
                    if (!(free >> m & 1U)) continue;
                    within = within && fabsq(s[m]) < 1;
                    postures *= 2;
                }
                if (within) count += postures;
            }
        return count / 2;  // mirror images
    }

    /// Of two mirror images, that with the free end at a positive offset; angles in (-pi, pi].
    void turn(Angles& d) const {
        Quad tip = 0, reach = 0, lowest = 0;
        for (std::size_t m = n_; m-- > 0;) {
            tip += length_[m] * sinq(d[m]), reach += length_[m];
            if (fabsq(sinq(d[m])) > Quad(1e-15)) lowest = sinq(d[m]);
        }
        const bool mirror = fabsq(tip) > Quad(1e-15) * reach ? tip < 0 : lowest < 0;
        for (Quad& angle : d) angle = atan2q(mirror ? -sinq(angle) : sinq(angle), cosq(angle));
    }

   private:
    std::size_t n_;
    Quad lambda_;
    std::vector<Quad> G_, kappa_, length_;
};

Quad gap(const Angles& x, const SteadyShape& y) {
    Quad worst = 0;
    for (std::size_t m = 0; m < x.size(); ++m) {
        const Quad off = x[m] - Quad(y.inclination[static_cast<Index>(m)]);
        worst = fmaxq(worst, fabsq(2 * sinq(off / 2)));
    }
    return worst;
}

unsigned posture_of(const SteadyShape& shape) {
    unsigned standing = 0;
    for (Index m = 0; m < shape.inclination.size(); ++m)
        if (std::cos(shape.inclination[m]) < 0) standing |= 1U << m;
    return standing;
}

/// The degree of the balance in every posture. The gradient of U points outwards where a hanging link becomes horizontal
/// and inwards where a standing one does, so that in the cell of a posture with p links standing the signs (-1)^index add
/// up to (-1)^p: the straight chain's and two for each pair of mirror images. Over all postures: 0, the torus's number.
void check_degrees(const Chain<double>& chain, double height, const SteadyShapes& found, bool hanging_only) {
    const Potential potential(chain, height);
    const auto n = static_cast<std::size_t>(chain.size());
    std::map<unsigned, int> sum;
    for (const SteadyShape& shape : found.shapes) {
        std::vector<Quad> cosine;
        for (const double d : shape.inclination) cosine.push_back(cosq(Quad(d)));
        sum[posture_of(shape)] += potential.sign_at(cosine);
    }
    int whole = 0;
    for (unsigned standing = 0; standing < 1U << n; ++standing) {
        std::vector<Quad> cosine;
        int degree = 1;
        for (std::size_t m = 0; m < n; ++m) {
            cosine.push_back(standing >> m & 1U ? -1 : 1);
            if (standing >> m & 1U) degree = -degree;
        }
        const int straight = potential.sign_at(cosine);
        if (hanging_only && standing > 0) continue;
        CAPTURE(standing);
        CHECK(2 * sum[standing] + straight == degree);
        whole += 2 * sum[standing] + straight;
    }
    if (!hanging_only) CHECK(whole == 0);
}

/// Everything a list promises but completeness.
void check_list(const Chain<double>& chain, double height, const SteadyShapes& found, bool hanging_only = false) {
    REQUIRE(found.undecided.empty());
    const Potential potential(chain, height);
    const double pi = std::numbers::pi;
    for (std::size_t i = 0; i < found.shapes.size(); ++i) {
        const SteadyShape& shape = found.shapes[i];
        Angles truth(shape.inclination.begin(), shape.inclination.end());
        REQUIRE(potential.refine(truth, 8));
        CHECK(gap(truth, shape) <= shape.error_bound);
        CHECK(shape.error_bound <= 4.5e-16);
        CHECK(shape.residual <= 1e-20);
        CHECK(shape.offset[0] >= 0);
        CHECK(shape.inclination.maxCoeff() <= pi);
        CHECK(shape.inclination.minCoeff() > -pi);
        double y = 0, z = 0, reach = 0;
        for (Index m = chain.size(); m-- > 0;) {
            const double a = chain.link(m).length, d = shape.inclination[m];
            y += a * std::sin(d), z -= a * std::cos(d), reach += a;
            CHECK(std::abs(shape.offset[m] - y) <= 1e-15 * reach);
            CHECK(std::abs(shape.height[m] - z) <= 1e-15 * reach);
        }
        if (hanging_only) CHECK(posture_of(shape) == 0);
        for (std::size_t j = 0; j < i; ++j) {
            const SteadyShape& before = found.shapes[j];
            CHECK((before.inclination - shape.inclination).cwiseAbs().maxCoeff() > 1e-12);
            CHECK((before.half_waves < shape.half_waves ||
                   (before.half_waves == shape.half_waves && before.inclination[0] <= shape.inclination[0])));
        }
    }
    check_degrees(chain, height, found, hanging_only);
}

/// Shapes that Newton's method falls upon from many starts, some all but vertical or horizontal: a number that can miss.
std::vector<Angles> fallen_upon(const Chain<double>& chain, double height, int starts, std::uint64_t seed) {
    const Potential potential(chain, height);
    const auto n = static_cast<std::size_t>(chain.size());
    Random random(seed);
    std::vector<Angles> found;
    for (int i = 0; i < starts; ++i) {
        Angles d(n);
        Quad most = 0;
        for (Quad& angle : d) {
            const double kind = random(), off = (random() < 0.5 ? -1 : 1) * random.log_between(1e-4, 1.0);
            angle = random.between(-3.14, 3.14);
            if (kind < 0.4) angle = (random() < 0.5 ? -1 : 1) * 1.5707963267948966 + off;
            if (kind > 0.7) angle = (random() < 0.5 ? 0 : 3.141592653589793) + off;
        }
        if (!potential.refine(d, 60)) continue;
        potential.turn(d);
        for (const Quad& angle : d) most = fmaxq(most, fabsq(sinq(angle)));
        if (most < Quad(1e-12)) continue;
        const bool known = std::any_of(found.begin(), found.end(), [&](const Angles& x) {
            Quad worst = 0;
            for (std::size_t m = 0; m < n; ++m) worst = fmaxq(worst, fabsq(sinq((x[m] - d[m]) / 2)));
            return worst < Quad(1e-12);
        });
        if (!known) found.push_back(d);
    }
    return found;
}

/// Links of four kinds: plummets, rods, pendulums of l up to 5 a and of l up to 100 a.
Chain<double> chain_of_kind(int kind, Index n, Random& random) {
    return support::chain_of(n, [&](Index) {
        const double weight = random.log_between(0.1, 10.0), a = random.log_between(0.3, 3.0);
        if (kind == 0) return revchain::plummet<double>(weight, a);
        if (kind == 1) return revchain::uniform_rod<double>(weight, a);
        const double h = a * random.between(0.2, kind == 2 ? 1.5 : 1.0);
        const double beyond = kind == 2 ? random.between(0.0, 5.0) : random.log_between(1.0, 100.0);
        return revchain::compound_pendulum<double>(
            {.weight = weight, .length = a, .centroid = h, .pendulum_length = h + a * beyond});
    });
}

SteadyShapes all_shapes(const Chain<double>& chain, double height) {
    return revchain::steady_shapes(chain, {.conical_height = height, .hanging_only = false}, revchain::thorough);
}

std::size_t hanging(const SteadyShapes& found) {
    return static_cast<std::size_t>(std::count_if(found.shapes.begin(), found.shapes.end(),
                                                  [](const SteadyShape& shape) { return posture_of(shape) == 0; }));
}

}  // namespace

TEST_CASE("all postures, two and three links: what Newton's method falls upon and no more", "[finite]") {
    Random random(301);
    std::size_t fallen = 0, listed = 0;
    for (int i = 0; i < 24; ++i) {
        const Index n = 2 + i / 4 % 2;
        const auto chain = chain_of_kind(i % 4, n, random);
        const double height = chain.total_length() * random.log_between(1e-2, 3.0);
        CAPTURE(i, n, height);
        const auto found = all_shapes(chain, height);
        check_list(chain, height, found);
        const auto others = fallen_upon(chain, height, n == 2 ? 200 : 800, 400 + static_cast<std::uint64_t>(i));
        for (const Angles& d : others) {
            Quad nearest = 10;
            for (const SteadyShape& shape : found.shapes) nearest = fminq(nearest, gap(d, shape));
            CHECK(nearest <= Quad(1e-15));
        }
        fallen += others.size(), listed += found.shapes.size();
    }
    CAPTURE(fallen, listed);
    CHECK(fallen >= listed - 3);  // all that the proof lists, but where the starts are too few
}

TEST_CASE("all postures, one to four links: every shape proved, every degree", "[finite]") {
    Random random(302);
    for (int i = 0; i < 80; ++i) {
        const Index n = 1 + i % 4;
        const int kind = i / 4 % 4;
        const auto chain = chain_of_kind(kind, n, random);
        const double height = chain.total_length() * random.log_between(1e-3, 3.0);
        CAPTURE(i, n, kind, height);
        const auto all = all_shapes(chain, height),
                   hang = revchain::steady_shapes(chain, {.conical_height = height}, revchain::thorough);
        check_list(chain, height, all);
        check_list(chain, height, hang, true);
        CHECK(hanging(all) == hang.shapes.size());
    }
}

TEST_CASE("as the height goes to nothing the shapes can be counted", "[finite]") {
    Random random(303);
    CHECK(Potential(Chain<double>::uniform_plummets(3), 1).count_at_no_height() == 18);
    for (int i = 0; i < 20; ++i) {
        const Index n = 1 + i % support::by_tier(4, 5);
        const auto chain = chain_of_kind(i / 5, n, random);
        const double height = (n == 5 ? 1e-6 : 1e-7) * chain.total_length();
        const auto found = all_shapes(chain, height);
        CAPTURE(i, n);
        CHECK(found.undecided.empty());
        CHECK(static_cast<long>(found.shapes.size()) == Potential(chain, height).count_at_no_height());
    }
}

TEST_CASE("three equal rods: eleven shapes with a link above the horizontal", "[finite]") {
    const struct {
        double height;  // over a rod's length
        std::size_t all, hanging;
    } known[]{{2.1, 0, 0},     {2.0, 1, 1},   {1.2, 2, 1},    {0.8, 3, 1},   {0.6, 4, 1},   {0.4, 5, 1},
              {0.35, 6, 1},    {0.31, 8, 2},  {0.2, 9, 2},    {0.15, 11, 2}, {0.12, 12, 2}, {0.11, 13, 2},
              {0.0625, 14, 3}, {0.04, 16, 5}, {0.025, 18, 7}, {0.02, 20, 7}, {0.001, 20, 7}};
    const auto rods = Chain<double>::uniform_rods(3, 3, 1);
    for (const auto& [height, all, hang] : known) {
        CAPTURE(height);
        const auto found = all_shapes(rods, height);
        check_list(rods, height, found);
        CHECK(found.shapes.size() == all);
        CHECK(hanging(found) == hang);
        if (height < 0.1127 && height > 0.02236) CHECK(all - hang == 11);
    }
}

TEST_CASE("two links: the closed forms, hanging and standing on the other", "[finite]") {
    Random random(304);
    int standing = 0;
    for (int i = 0; i < 100; ++i) {
        const double W1 = random.log_between(0.1, 10.0), W2 = random.log_between(0.1, 10.0);
        const double l1 = random.log_between(0.1, 10.0), l2 = random.log_between(0.1, 10.0);
        const double height = (l1 + l2) * random.log_between(1e-3, 1.0);
        CAPTURE(W1, W2, l1, l2, height);
        const auto found = all_shapes(Chain<double>({revchain::plummet(W1, l1), revchain::plummet(W2, l2)}), height);
        REQUIRE(found.complete);
        const auto closed = revchain::two_plummets_shapes(W1, l1, W2, l2, height);
        REQUIRE(hanging(found) == closed.size());
        std::size_t at = 0;
        for (const SteadyShape& shape : found.shapes)
            if (posture_of(shape) == 0) {
                const auto& angles = closed[at++].inclination;
                for (Index m = 0; m < 2; ++m)
                    CHECK(std::abs(shape.inclination[m] - angles[static_cast<std::size_t>(m)]) <= 1e-11);
            }
        const auto upright = revchain::standing_plummet_shape(W1, l1, W2, l2, height);
        std::size_t lower = 0;
        for (const SteadyShape& shape : found.shapes)
            if (posture_of(shape) == 1) {
                ++lower;
                REQUIRE(upright.has_value());
                CHECK(std::abs(shape.inclination[0] + std::numbers::pi - upright->inclination[0]) <= 1e-12);
                CHECK(std::abs(shape.inclination[1] - upright->inclination[1]) <= 1e-12);
            }
        CHECK(lower == (upright ? 1U : 0U));
        standing += upright.has_value();
    }
    CHECK(standing > 30);
}

TEST_CASE("one link: hanging at cos d = lambda/l, never standing", "[finite]") {
    Random random(305);
    for (int i = 0; i < 60; ++i) {
        const auto chain = chain_of_kind(i % 4, 1, random);
        const Quad l = revchain::pendulum_length(chain.link(0));
        const double height = static_cast<double>(l) * random.log_between(1e-3, 2.0);
        const auto found = all_shapes(chain, height);
        CHECK(found.complete);
        REQUIRE(found.shapes.size() == (height < l ? 1U : 0U));
        // l > a: the free end hangs on this side of the axis or across it
        if (height < l) CHECK(std::abs(std::abs(found.shapes[0].inclination[0]) - double(acosq(height / l))) <= 1e-14);
    }
}

TEST_CASE("above the first critical height there is no shape in any posture", "[finite]") {
    // E D s = G s with D >= lambda diag(kappa) > G has no s: |E w| = |w| > |D^-1/2 G D^-1/2 w|.
    Random random(306);
    for (int i = 0; i < 60; ++i) {
        const auto chain = chain_of_kind(i % 4, 1 + i % 4, random);
        const double first = revchain::modes(chain, {.count = 1}).conical_height[0];
        for (const double over : {1e-7, 0.01, 1.0}) {
            const auto found = all_shapes(chain, first * (1 + over));
            CHECK(found.undecided.empty());
            CHECK(found.shapes.empty());
        }
        CHECK_FALSE(all_shapes(chain, first * (1 - 1e-7)).shapes.empty());
    }
}

TEST_CASE("exactly a critical height: what rounding leaves open is narrow, and told soon", "[finite]") {
    Random random(307);
    for (int i = 0; i < support::by_tier(48, 240); ++i) {
        const auto chain = chain_of_kind(i % 4, 1 + i % 3, random);
        const auto heights = revchain::modes(chain, {.count = revchain::all_modes}).conical_height;
        for (const double height : heights) {
            CAPTURE(i, chain.size(), height);
            const auto found = all_shapes(chain, height);
            CHECK(found.cells < 800);
            for (const auto& range : found.undecided) CHECK(range.high - range.low < 1e-9);
            // none that is certain is lost: there are as many just above
            const auto above = all_shapes(chain, height * (1 + 1e-9));
            REQUIRE(above.undecided.empty());
            CHECK(found.shapes.size() >= above.shapes.size());
        }
    }
}

TEST_CASE("a lowest link that hangs, or stands, in the axis", "[finite]") {
    // Link 2 carries no load and leans at 60 degrees, as lambda sigma/cos d = -a X does; link 3 leans as much against it.
    const Chain<double> chain(
        {revchain::plummet(1.0, 1.0), {1.0, 1.0, 0.5, revchain::Wide<double>(1.0)}, revchain::plummet(1.0, 1.0)});
    const auto hang = revchain::steady_shapes(chain, {.conical_height = 0.25}, revchain::thorough),
               all = all_shapes(chain, 0.25);
    CHECK(hang.undecided.empty());
    CHECK(all.undecided.empty());
    for (const auto* found : {&hang, &all}) {
        int in_axis = 0;
        for (const SteadyShape& shape : found->shapes) {
            if (std::abs(std::sin(shape.inclination[0])) > 1e-15) continue;
            ++in_axis;
            CHECK(std::abs(shape.inclination[1] - std::numbers::pi / 3) <= 4e-16);
            CHECK(std::abs(shape.inclination[2] + std::numbers::pi / 3) <= 4e-16);
            CHECK(std::abs(shape.offset[0]) <= 1e-16);
        }
        CHECK(in_axis == (found == &hang ? 1 : 2));
    }
}

TEST_CASE("a link that leans to any side: shapes out of the plane, of which no list is complete", "[finite]") {
    const std::array<Quad, 3> W{Quad(0.2), 1, 2}, h{1, Quad(0.5), 1}, l{1, 3, 1};  // a = 1
    const Quad lambda = 0.5;
    // The energy in the turning frame of two equal masses on each link, a radius of gyration from its centroid.
    const auto energy = [&](const std::array<Quad, 6>& angles) {
        Quad total = 0, x = 0, y = 0, z = 0;
        for (const std::size_t m : {2U, 1U, 0U}) {
            const Quad d = angles[m], to = angles[3 + m], rho = sqrtq(h[m] * (l[m] - h[m]));
            const Quad u = sinq(d) * cosq(to), v = sinq(d) * sinq(to), w = -cosq(d);
            for (const Quad at : {h[m] - rho, h[m] + rho}) {
                const Quad px = x + at * u, py = y + at * v;
                total += W[m] / 2 * (z + at * w - (px * px + py * py) / (2 * lambda));
            }
            x += u, y += v, z += w;
        }
        return total;
    };
    const auto unbalanced = [&](const std::array<Quad, 6>& angles) {
        Quad largest = 0;
        for (std::size_t i = 0; i < 6; ++i) {
            auto up = angles, down = angles;
            up[i] += Quad(1e-10), down[i] -= Quad(1e-10);
            largest = fmaxq(largest, fabsq(energy(up) - energy(down)) / Quad(2e-10));
        }
        return static_cast<double>(largest);
    };
    // Link 2 balances by itself, link 1 balances the force on it, and link 3 carries both.
    const Quad d2 = acosq(lambda * (W[1] * h[1] + W[0]) / (W[1] * h[1] * (l[1] - 1)));
    const Quad share = W[0] * h[0] / (W[0] + W[1] * h[1]);
    const Quad d1 = acosq(lambda / (l[0] - share));
    const Quad d3 = acosq(lambda * (W[2] * h[2] + W[0] + W[1]) / (W[1] * (1 - h[1]) + W[2] * h[2] * l[2]));
    const Quad upper = sinq(d3), lower = share * sinq(d1), across = sinq(d2);
    const Quad to2 = acosq((lower * lower - upper * upper - across * across) / (2 * upper * across));
    const Quad to1 = atan2q(-across * sinq(to2), -upper - across * cosq(to2));
    CHECK(unbalanced({d1, d2, d3, to1, to2, 0}) < 1e-18);
    CHECK(unbalanced({d1, d2, d3, to1, to2 + Quad(0.05), 0}) > 1e-3);
    CHECK(static_cast<double>(fabsq(sinq(to1))) > 0.6);

    const auto chain_of = [&](double pendulum_length) {
        return Chain<double>({revchain::plummet(0.2, 1.0),
                              revchain::compound_pendulum<double>(
                                  {.weight = 1, .length = 1, .centroid = 0.5, .pendulum_length = pendulum_length}),
                              revchain::plummet(2.0, 1.0)});
    };
    for (const bool hanging_only : {true, false}) {
        const auto found = revchain::steady_shapes(
            chain_of(3), {.conical_height = 0.5, .hanging_only = hanging_only}, revchain::thorough);
        CHECK(found.undecided.empty());
        CHECK_FALSE(found.complete);
    }
    // lambda (W h + a S) = 0.35 = W h (l - a) at l = 1.7; no link leans freely below, nor a thread in any posture
    CHECK(revchain::steady_shapes(chain_of(1.69), {.conical_height = 0.5}, revchain::thorough).complete);
    CHECK_FALSE(revchain::steady_shapes(chain_of(1.71), {.conical_height = 0.5}, revchain::thorough).complete);
    CHECK(all_shapes(Chain<double>::uniform_plummets(4), 0.1).complete);
    // rods that stand do, if they are between others: lambda <= a/3 W/(W + 2 S)
    CHECK(all_shapes(Chain<double>::uniform_rods(2), 0.02).complete);
    CHECK(all_shapes(Chain<double>::uniform_rods(3), 0.04).complete);
    CHECK_FALSE(all_shapes(Chain<double>::uniform_rods(3), 0.03).complete);
}

TEST_CASE("joints that coincide: one inclination becomes three", "[finite]") {
    // lambda (W h + a S) = W h (l - a), or the same of a link that stands, exactly and all but exactly
    const Chain<double> standing(
        {revchain::plummet(0.5, 1.0), {1.0, 1.0, 0.5, revchain::Wide<double>(0.0)}, revchain::plummet(1.0, 1.0)});
    const Chain<double> hanging_link(
        {revchain::plummet(0.5, 1.0), {1.0, 1.0, 0.5, revchain::Wide<double>(0.5)}, revchain::plummet(1.0, 1.0)});
    for (const auto* chain : {&standing, &hanging_link})
        for (const double off : {0.0, 1e-16, 1e-12, 1e-8, 1e-4, -1e-16, -1e-12, -1e-8, -1e-4}) {
            CAPTURE(off);
            const double height = 0.25 * (1 + 2 * off);
            const auto found = all_shapes(*chain, height);
            check_list(*chain, height, found);
            CHECK(found.shapes.size() == all_shapes(*chain, 0.25).shapes.size());
        }
}

TEST_CASE("a free end across the axis is told by its offset", "[finite]") {
    // A lowest link with l = 3 a above its critical speed: its lower pin swings over to the other side.
    const Chain<double> chain(
        {revchain::compound_pendulum<double>({.weight = 1, .length = 1, .centroid = 0.5, .pendulum_length = 3})});
    for (const double height : {2.9, 2.1, 1.9, 0.5}) {
        const auto found = revchain::steady_shapes(chain, {.conical_height = height}, revchain::thorough);
        REQUIRE(found.shapes.size() == 1);
        CHECK(found.shapes[0].offset[0] > 0);
    }
}

TEST_CASE("chains too long for the budget say so", "[finite]") {
    Random random(307);
    const auto chain = chain_of_kind(2, 30, random);
    for (const bool hanging_only : {false, true}) {
        const auto found = revchain::steady_shapes(
            chain, {.conical_height = 0.01 * chain.total_length(), .budget = 2000, .hanging_only = hanging_only},
            revchain::thorough);
        CHECK_FALSE(found.complete);
        CHECK_FALSE(found.undecided.empty());
    }
}
