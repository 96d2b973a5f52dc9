// SPDX-License-Identifier: MPL-2.0
// Transfer polynomials against products of polynomial matrices, in integers: no rounding, no tolerance.
#include "revchain/pencil/condensed/transfer.hpp"

#include <vector>

#include "support/catch.hpp"
#include "support/chains.hpp"

using namespace revchain::pencil;
using support::Random;

namespace {

using Whole = long long;
using Polynomial = std::vector<Whole>;  // in z, cut off at `terms`
constexpr std::size_t terms = 8;

Polynomial product(const Polynomial& p, const Polynomial& q) {
    Polynomial r(terms);
    for (std::size_t i = 0; i < terms; ++i)
        for (std::size_t j = 0; i + j < terms; ++j) r[i + j] += p[i] * q[j];
    return r;
}

struct Matrix {
    Polynomial a = constant(1), b = constant(0), c = constant(0), d = constant(1);
    static Polynomial constant(Whole x) {
        Polynomial p(terms);
        p[0] = x;
        return p;
    }
};

Polynomial sum(Polynomial p, const Polynomial& q) {
    for (std::size_t i = 0; i < terms; ++i) p[i] += q[i];
    return p;
}

Matrix operator*(const Matrix& upper, const Matrix& lower) {
    return {sum(product(upper.a, lower.a), product(upper.b, lower.c)),
            sum(product(upper.a, lower.b), product(upper.b, lower.d)),
            sum(product(upper.c, lower.a), product(upper.d, lower.c)),
            sum(product(upper.c, lower.b), product(upper.d, lower.d))};
}

/// A run of masses and springs, some with inertia, both ways.
template <std::size_t Degree>
struct Run {
    Transfer<Whole, Degree> transfer;
    Matrix exact;

    Run(Random& random, int parts) {
        const auto whole = [&](int most) { return static_cast<Whole>(random() * (most + 1)); };
        for (int i = 0; i < parts; ++i) {
            const Whole mass = whole(3), flexibility = whole(2), cross = whole(1);
            append_mass(transfer, mass);
            Matrix step;
            step.c[0] = mass;
            exact = step * exact;
            step = {};
            Whole power = flexibility;
            const bool turns = random() < 0.5;
            for (std::size_t k = 1; k < terms; ++k, power *= cross) step.b[k] = turns || k == 1 ? power : 0;
            exact = step * exact;
            if (turns)
                append_spring(transfer, flexibility, cross);
            else
                append_spring(transfer, flexibility);
        }
    }
};

template <std::size_t Degree>
void require_equal(const Transfer<Whole, Degree>& run, const Matrix& exact) {
    CHECK(exact.a[0] == 1);
    CHECK(exact.d[0] == 1);
    CHECK(exact.b[0] == 0);
    for (std::size_t i = 0; i < Degree; ++i) {
        CAPTURE(Degree, i);
        CHECK(run.a[i] == exact.a[i + 1]);
        CHECK(run.c[i] == exact.c[i]);
        CHECK(run.d[i] == exact.d[i + 1]);
    }
    for (std::size_t i = 0; i <= Degree; ++i) CHECK(run.b[i] == exact.b[i + 1]);
}

}  // namespace

TEST_CASE("masses and springs appended: the product of their matrices, cut off", "[blocks]") {
    Random random(31);
    for (int parts = 0; parts < 8; ++parts)
        for (int i = 0; i < 20; ++i) {
            const Run<6> six(random, parts);
            require_equal(six.transfer, six.exact);
            const Run<3> three(random, parts);
            require_equal(three.transfer, three.exact);
        }
}

TEST_CASE("runs merged: the product of their matrices, cut off", "[blocks]") {
    Random random(32);
    for (int i = 0; i < 200; ++i) {
        const Run<6> lower(random, 1 + i % 3), upper(random, 1 + i % 4);
        require_equal(merged(lower.transfer, upper.transfer), upper.exact * lower.exact);
        // An upper run of fewer terms: those it does not have count as 0.
        const Run<3> leaf(random, 3);
        require_equal(merged(lower.transfer, leaf.transfer), [&] {
            Matrix cut = leaf.exact;
            for (std::size_t k = 4; k < terms; ++k) cut.a[k] = cut.d[k] = 0;
            for (std::size_t k = 5; k < terms; ++k) cut.b[k] = 0;
            for (std::size_t k = 3; k < terms; ++k) cut.c[k] = 0;
            return cut * lower.exact;
        }());
        const auto longer = extended<6>(leaf.transfer);
        CHECK(merged(lower.transfer, longer).a == merged(lower.transfer, leaf.transfer).a);
        CHECK(merged(lower.transfer, longer).b == merged(lower.transfer, leaf.transfer).b);
    }
}

TEST_CASE("the determinant is 1", "[blocks]") {
    Random random(33);
    for (int i = 0; i < 100; ++i) {
        const Run<7> run(random, 4);
        const auto& t = run.transfer;
        for (std::size_t k = 1; k <= 7; ++k) {  // coefficient of z^k in A D - B C
            Whole sum = t.a[k - 1] + t.d[k - 1];
            for (std::size_t j = 1; j < k; ++j) sum += t.a[j - 1] * t.d[k - j - 1];
            for (std::size_t j = 1; j <= k; ++j) sum -= t.b[j - 1] * t.c[k - j];
            CHECK(sum == 0);
        }
    }
}

// What truncation and rounding are bounded with: zeros are real, so that coefficients are log-concave, and the second
// ones are at most a quarter of the phase b1 c0.
TEST_CASE("coefficients of any run are log-concave and fall with a quarter of its phase", "[blocks]") {
    Random random(34);
    double largest = 0;
    for (int i = 0; i < 3000; ++i) {
        Transfer<long double, 7> t;
        const double spread = std::pow(10.0, 4 * random());
        const int links = 1 + static_cast<int>(8 * random());
        for (int m = 0; m < links; ++m) {
            const long double weight = random.log_between(1, spread), p = random.between(0, 1);
            const long double turning = weight * p * (1 - p) * (random() < 0.5 ? 1.0 : random());  // X
            const long double flexibility = random.log_between(1, spread);
            append_mass(t, weight * p);
            append_spring(t, flexibility, turning * flexibility);
            append_mass(t, weight * (1 - p));
        }
        const long double phase = t.b[0] * t.c[0], slack = 1 + 1e-15L;
        const auto require_concave = [&](const auto& coefficient, std::size_t count) {
            CHECK(coefficient(1) <= phase / 4 * coefficient(0) * slack);
            largest = std::max(largest, static_cast<double>(coefficient(1) / (phase * coefficient(0))));
            for (std::size_t k = 2; k < count; ++k)
                CHECK(coefficient(k) * coefficient(k - 2) <= coefficient(k - 1) * coefficient(k - 1) * slack);
        };
        CAPTURE(i, links);
        require_concave([&](std::size_t k) { return t.b[k]; }, 8);
        require_concave([&](std::size_t k) { return t.c[k]; }, 7);
        require_concave([&](std::size_t k) { return t.a[k] + t.d[k]; }, 7);
        for (std::size_t k = 2; k < 7; ++k) {
            CHECK(t.a[k] * t.a[k - 2] <= t.a[k - 1] * t.a[k - 1] * slack);
            CHECK(t.d[k] * t.d[k - 2] <= t.d[k - 1] * t.d[k - 1] * slack);
        }
    }
    CHECK(largest > 0.24);  // the quarter is reached: half the mass at each end, or a point mass in mid link
}
