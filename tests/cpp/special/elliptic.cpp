// SPDX-License-Identifier: GPL-3.0-or-later
#include "revchain/special/elliptic.hpp"

#include <fstream>
#include <map>
#include <sstream>

#include "revchain/special/incomplete_elliptic.hpp"
#include "revchain/special/jacobi.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::analytic::EllipticModulus;
using revchain::analytic::JacobiFunctions;
using support::Quad;

namespace {

/// The numbers of a row, and the same as doubles.
struct Row {
    std::vector<Quad> exact;
    double operator[](std::size_t i) const { return static_cast<double>(exact[i]); }
};

template <class Check>
int for_rows(const char* name, const Check& check) {
    std::ifstream file(std::string(REVCHAIN_TEST_DATA "/elliptic_") + name + ".csv");
    std::string line, field;
    REQUIRE(std::getline(file, line));
    int rows = 0;
    for (; std::getline(file, line); ++rows) {
        Row row;
        for (std::istringstream fields(line); std::getline(fields, field, ',');)
            row.exact.push_back(strtoflt128(field.c_str(), nullptr));
        INFO(line);
        check(row);
    }
    return rows;
}

/// The worst of errors by name, relative to `size`.
struct Worst {
    std::map<std::string, double> error;
    void note(const std::string& name, double value, Quad exact, Quad size) {
        if (value == static_cast<double>(exact)) return;
        const double relative = static_cast<double>(fabsq(Quad(value) - exact) / size);
        error[name] = std::max(error[name], std::isnan(value) ? 1 : relative);
    }
};

}  // namespace

// Size of an error: |f| + |u df/du|, for u itself is known to half an ulp only.
TEST_CASE("Jacobi's functions against 20 digits, kappa' from 1 to 1e-150", "[analytic]") {
    Worst worst;
    const int rows = for_rows("jacobi", [&](const Row& row) {
        const auto modulus = EllipticModulus::of_complement(row[0]);
        const auto f = JacobiFunctions(modulus)(row[1]);
        const Quad u = fabsq(row.exact[1]), sn = row.exact[3], cn = row.exact[4], dn = row.exact[5];
        const Quad m = 1 - row.exact[0] * row.exact[0];
        worst.note("am", f.amplitude, row.exact[2], fabsq(row.exact[2]) + u * dn);
        worst.note("sn", f.sn, sn, fabsq(sn) + u * fabsq(cn * dn));
        worst.note("cn", f.cn, cn, fabsq(cn) + u * fabsq(sn * dn));
        worst.note("dn", f.dn, dn, dn + u * m * fabsq(sn * cn));
        worst.note("epsilon", f.epsilon, row.exact[6], fabsq(row.exact[6]) + u * dn * dn);
        CHECK(std::abs(f.sn * f.sn + f.cn * f.cn - 1) <= 1.5e-15);
    });
    CHECK(rows == 312);
    CHECK(worst.error["am"] <= 4e-16);
    CHECK(worst.error["sn"] <= 6e-16);
    CHECK(worst.error["cn"] <= 9e-16);
    CHECK(worst.error["dn"] <= 9e-16);
    CHECK(worst.error["epsilon"] <= 1e-15);
}

TEST_CASE("complete integrals against 20 digits", "[analytic]") {
    Worst worst;
    const int rows = for_rows("complete", [&](const Row& row) {
        const auto modulus = EllipticModulus::of_complement(row[0]);
        const auto c = revchain::analytic::complete_integrals(modulus);
        worst.note("K", c.K, row.exact[2], row.exact[2]);
        worst.note("E", c.E, row.exact[3], row.exact[3]);
        worst.note("D", c.D, row.exact[4], row.exact[4]);
        worst.note("B", c.B, row.exact[5], row.exact[5]);
        worst.note("Pi", revchain::analytic::complete_pi(row[1], modulus), row.exact[6], row.exact[6]);
    });
    CHECK(rows == 104);
    for (const auto& [name, error] : worst.error) {
        CAPTURE(name);
        CHECK(error <= 8e-16);
    }
}

TEST_CASE("incomplete integrals against 20 digits", "[analytic]") {
    Worst worst;
    const int rows = for_rows("incomplete", [&](const Row& row) {
        const auto modulus = EllipticModulus::of_complement(row[0]);
        const auto i = revchain::analytic::incomplete_integrals(row[1], modulus);
        worst.note("F", i.F, row.exact[3], fabsq(row.exact[3]));
        worst.note("E", i.E, row.exact[4], fabsq(row.exact[4]));
        worst.note("D", i.D, row.exact[5], fabsq(row.exact[5]));
        worst.note("Pi", revchain::analytic::incomplete_pi(row[2], row[1], modulus), row.exact[6], fabsq(row.exact[6]));
    });
    CHECK(rows == 1560);
    CHECK(worst.error["F"] <= 1.5e-15);
    CHECK(worst.error["E"] <= 1.5e-15);
    CHECK(worst.error["D"] <= 1.5e-15);
    CHECK(worst.error["Pi"] <= 2.5e-15);
}

// Laws, at moduli no table holds.
TEST_CASE("elliptic integrals and functions keep their laws", "[analytic]") {
    support::Random random(7);
    for (int i = 0; i < 2000; ++i) {
        const double logarithm = random.between(-100, 100);
        const auto modulus = EllipticModulus::of_ratio(std::exp(0.5 * logarithm), std::exp(-0.5 * logarithm));
        const JacobiFunctions functions(modulus);
        const auto own = functions.complete(), other = revchain::analytic::complete_integrals(modulus.swapped());
        CAPTURE(logarithm);
        // Legendre, without a difference: E K' + E' K - K K' = K' B + K kappa'^2 D' ... as E = kappa'^2 K + kappa^2 B.
        const double k2 = modulus.modulus() * modulus.modulus();
        const double c2 = modulus.complementary_modulus() * modulus.complementary_modulus();
        CHECK(std::abs((k2 * own.B * other.K + c2 * other.B * own.K) / (M_PI / 2) - 1) <= 3e-15);
        CHECK(std::abs(own.B + own.D - own.K) <= 1e-15 * own.K);
        // u and back.
        const double u = random.between(-3, 3) * own.K;
        const auto f = functions(u);
        const double size = 1e-15 * (std::abs(u) + own.K);
        if (f.dn > 1e-3)
            CHECK(std::abs(revchain::analytic::incomplete_integrals(f.amplitude, modulus).F - u) <= 20 * size / f.dn);
        CHECK(std::abs(std::hypot(modulus.complementary_modulus(), modulus.modulus() * f.cn) - f.dn) <=
              4e-15 * (1 + std::abs(u)) * f.dn);
        // A third integral with characteristic 0 is the first; from sn and cn, not from the amplitude, next to K too.
        CHECK(std::abs(revchain::analytic::incomplete_pi(0, f, modulus) - u) <= 3e-15 * (std::abs(u) + own.K));
        const auto back = functions(-u), next = functions(u + 2 * own.K);
        CHECK(back.sn == -f.sn);
        CHECK(back.cn == f.cn);
        CHECK(std::abs(next.dn - f.dn) <= 1e-13 * own.K);
    }
}

TEST_CASE("the ratio of two sides may be given in any unit", "[analytic]") {
    // the hypotenuse of the first pair overflows; in the unit of the last two it has few digits
    for (const double unit : {0x1p1022, 0x1p-1000, 0x1p-1074}) {
        CAPTURE(unit);
        const EllipticModulus modulus = EllipticModulus::of_ratio(3 * unit, 3 * unit);
        CHECK(std::abs(modulus.modulus() - std::sqrt(0.5)) <= 2.3e-16);
        CHECK(modulus.complementary_modulus() == modulus.modulus());
    }
    CHECK(EllipticModulus::of_ratio(0, 5e-324).complementary_modulus() == 1);
    CHECK(EllipticModulus::of_ratio(1.7e308, 1e-10).complementary_modulus() > 0);
}

TEST_CASE("the ends of the range of kappa", "[analytic]") {
    const JacobiFunctions straight(EllipticModulus::of_complement(0)), round(EllipticModulus::of(0));
    CHECK(straight.complete().K == std::numeric_limits<double>::infinity());
    CHECK(straight.complete().E == 1);
    for (const double u : {-700.0, -3.0, 0.0, 1e-200, 0.5, 20.0, 800.0, 1e300}) {
        CAPTURE(u);
        CHECK(straight(u).sn == std::tanh(u));
        CHECK(straight(u).cn == 1 / std::cosh(u));
        CHECK(straight(u).dn == 1 / std::cosh(u));
        CHECK(straight(u).epsilon == std::tanh(u));
        if (std::abs(u) > 1e3) continue;
        CHECK(round(u).dn == 1);
        CHECK(std::abs(round(u).sn - std::sin(u)) <= 2e-16 * (1 + std::abs(u)));
    }
    CHECK_THROWS_AS(EllipticModulus::of(1.5), revchain::InvalidArgument);
    CHECK_THROWS_AS(EllipticModulus::of(std::nan("")), revchain::InvalidArgument);
    CHECK_THROWS_AS(EllipticModulus::of_complement(-0.1), revchain::InvalidArgument);
    CHECK_THROWS_AS(EllipticModulus::of_ratio(0, 0), revchain::InvalidArgument);
    CHECK_THROWS_AS(EllipticModulus::of_ratio(1, std::nan("")), revchain::InvalidArgument);
    CHECK_THROWS_AS(EllipticModulus::of_ratio(std::numeric_limits<double>::infinity(), 1), revchain::InvalidArgument);
    CHECK_THROWS_AS(round(std::numeric_limits<double>::infinity()), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::analytic::complete_pi(1, EllipticModulus::of(0.5)), revchain::InvalidArgument);
    CHECK_THROWS_AS(revchain::analytic::incomplete_pi(0.5, std::nan(""), EllipticModulus::of(0.5)),
                    revchain::InvalidArgument);
}
