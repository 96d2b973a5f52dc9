// SPDX-License-Identifier: MPL-2.0
// Truth: pivots of assembled tridiagonal matrices, and Newton's step, in complex quadruple precision.
#include "revchain/pencil/complex/spectrum.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Index;
using revchain::pencil::ComplexWord;
using revchain::pencil::SignedElement;
using revchain::pencil::SignedPencil;
using support::Quad;
using support::quad;
using support::Random;
using S = revchain::Wide<double>;

namespace {

using Complex = __complex128;

Complex complex(Quad re, Quad im) {
    Complex z = 0;
    __real__ z = re, __imag__ z = im;
    return z;
}

/// Numbers of an element in quadruple precision, each moved by up to so many times its error.
struct Entries {
    Quad k, s, lower, upper, cross;
};
std::vector<Entries> moved(const SignedPencil<S>& pencil, Random& random, double share) {
    std::vector<Entries> entries;
    for (const auto& e : pencil.elements) {
        const auto by = [&](const S& x, double error) { return quad(x) + Quad(share * error * random.between(-1, 1)); };
        entries.push_back({by(e.stiffness, e.error.stiffness), by(e.spin, e.error.spin), by(e.lower, e.error.lower),
                           by(e.upper, e.error.upper), by(e.cross, e.error.cross)});
    }
    return entries;
}

/// det Q(x) over 2^exponent, and P'/P.
struct Value {
    Complex fraction, rate;
    int exponent = 0;
};
Value value(const std::vector<Entries>& entries, bool quadratic, Complex x) {
    Value result{complex(1, 0), complex(0, 0)};
    const std::size_t n = entries.size();
    Complex pivot = complex(1, 0), slope = complex(0, 0), off = complex(0, 0), off_slope = complex(0, 0);
    Quad upper = 0;
    Complex L_below = complex(0, 0), L_slope_below = complex(0, 0);
    for (std::size_t m = 0; m < n; ++m) {
        const Entries& e = entries[m];
        const Complex L = quadratic ? x * x * e.k + x * e.s : x * e.k;
        const Complex L_slope = quadratic ? 2 * x * e.k + e.s : complex(e.k, 0);
        Complex p = L - e.lower, dp = L_slope;
        if (m > 0) {
            p += L_below - upper - off * off / pivot;
            dp += L_slope_below - 2 * off * off_slope / pivot + off * off * slope / (pivot * pivot);
        }
        pivot = p, slope = dp;
        off = -(L + e.cross), off_slope = -L_slope, upper = e.upper, L_below = L, L_slope_below = L_slope;
        result.rate += dp / p;
        result.fraction *= p;
        int shift = 0;
        frexpq(fmaxq(fabsq(__real__ result.fraction), fabsq(__imag__ result.fraction)), &shift);
        result.fraction = complex(ldexpq(__real__ result.fraction, -shift), ldexpq(__imag__ result.fraction, -shift));
        result.exponent += shift;
    }
    return result;
}

SignedPencil<S> random_pencil(Random& random, bool quadratic, Index n, double error) {
    SignedPencil<S> pencil;
    pencil.quadratic = quadratic;
    for (Index m = 0; m < n; ++m) {
        const auto number = [&] { return S(random.between(-1, 1)) + S(1e-17 * random()); };
        const std::array<S, 5> any{number(), quadratic ? number() : S(0.0), number(), number(), number()};
        auto e = SignedElement<S>::of(any[0], any[1], any[2], any[3], any[4]);
        e.error = {error, error, error, error, error};
        pencil.elements.push_back(e);
    }
    return pencil;
}

Complex in_quad(const ComplexWord& x) { return complex(quad(x.real), quad(x.imag)); }

}  // namespace

TEST_CASE("det Q in lanes: within its bound of the exact one of any numbers within their errors", "[linalg]") {
    using namespace revchain::pencil::detail;
    Random random(91);
    double nearest = 0;
    for (int i = 0; i < 400; ++i) {
        const bool quadratic = i % 2 == 0;
        const double error = i % 3 == 0 ? 0 : random.log_between(1e-30, 1e-9);
        const auto pencil = random_pencil(random, quadratic, 1 + i % 17, error);
        ComplexWord x[value_lanes];
        // Next to roots, as approximations are, and anywhere.
        const auto spectrum = revchain::pencil::complex_spectrum(pencil, 0, [](double) {});
        for (std::size_t k = 0; k < value_lanes; ++k) {
            x[k] = ComplexWord(S(random.between(-2, 2)), S(k % 2 == 0 ? 0.0 : random.between(-2, 2)));
            if (k < 4 && !spectrum.roots.empty())
                x[k] = ComplexWord(spectrum.roots[k % spectrum.roots.size()].value *
                                   (1 + random.log_between(1e-17, 1e-2)));
        }
        ScaledValue found[value_lanes];
        revchain::simd([&](auto where) REVCHAIN_INLINED { values_in_lanes(where, pencil, x, found); });
        const auto entries = moved(pencil, random, 1);
        for (std::size_t k = 0; k < value_lanes; ++k) {
            const Value truth = value(entries, quadratic, in_quad(x[k]));
            const int shift = static_cast<int>(found[k].exponent) - truth.exponent;
            const Complex mine =
                complex(ldexpq(Quad(found[k].fraction.real()), shift), ldexpq(Quad(found[k].fraction.imag()), shift));
            const double off = static_cast<double>(cabsq(mine - truth.fraction) / cabsq(truth.fraction));
            CAPTURE(i, k, off, found[k].error);
            if (std::isinf(found[k].error)) continue;
            REQUIRE(off <= found[k].error);
            nearest = std::max(nearest, off / found[k].error);
            if (error == 0 && k >= 4) CHECK(found[k].error <= 1e-13);
        }
    }
    CHECK(nearest >= 1e-2);  // the bound is not idle
}

TEST_CASE("the leading coefficient of det Q, with elements that do not stiffen", "[linalg]") {
    using revchain::pencil::detail::leading_term;
    Random random(92);
    for (int i = 0; i < 200; ++i) {
        const bool quadratic = i % 2 == 0;
        auto pencil = random_pencil(random, quadratic, 1 + i % 9, 0);
        int degree = 0;
        for (auto& e : pencil.elements) {
            if (random() < 0.3) e.stiffness = S(0.0);
            if (random() < 0.5) e.spin = S(0.0);
            degree += !(e.stiffness == S(0.0)) ? (quadratic ? 2 : 1) : quadratic && !(e.spin == S(0.0)) ? 1 : 0;
        }
        // det Q / far^degree, link by link: assembled entries would cancel at such an x.
        const Quad far = ldexpq(Quad(1), 200);
        Quad below = 0, truth = ldexpq(Quad(1), -200 * degree);
        for (const Entries& e : moved(pencil, random, 0)) {
            const Quad L = quadratic ? far * far * e.k + far * e.s : far * e.k, p = below + L - e.lower;
            truth *= p;
            below = ((L - e.upper) * below -
                     (L * (e.lower + e.upper + 2 * e.cross) - e.lower * e.upper + e.cross * e.cross)) /
                    p;
        }
        const auto term = leading_term(pencil);
        const auto& found = term.coefficient;
        CHECK(term.degree == degree);
        const Quad mine = ldexpq(Quad(found.fraction.real()), static_cast<int>(found.exponent));
        CAPTURE(i, degree);
        CHECK(static_cast<double>(fabsq(mine / truth - 1)) <= 1e-13);
        CHECK(found.error <= 1e-13);
    }
    SignedPencil<S> unsure = random_pencil(random, false, 3, 0);
    unsure.elements[1].stiffness = S(1e-12), unsure.elements[1].error.stiffness = 1e-11;
    CHECK(std::isinf(leading_term(unsure).coefficient.error));
}

TEST_CASE("all roots of det Q: as many as its degree, each in a disc of its own", "[linalg]") {
    Random random(93);
    int proved = 0;
    double worst = 0;
    for (int i = 0; i < 300; ++i) {
        const bool quadratic = i % 2 == 0;
        const Index n = i % 50 == 0 ? 150 : 1 + i % 23;
        const double error = i % 3 == 0 ? 1e-28 : 0;
        const auto pencil = random_pencil(random, quadratic, n, error);
        const auto spectrum = revchain::pencil::complex_spectrum(pencil, 0, [](double) {});
        REQUIRE(static_cast<Index>(spectrum.roots.size()) == (quadratic ? 2 : 1) * n);
        proved += spectrum.proved ? 1 : 0;
        if (!spectrum.proved) {
            CHECK(std::isinf(spectrum.roots.front().radius));
            continue;
        }
        const auto entries = moved(pencil, random, 1);
        Complex sum = complex(0, 0);
        for (const auto& root : spectrum.roots) {
            // With all others known, P'/P less theirs is 1/(x - root): the distance, to the square of what is left.
            const Complex z = complex(Quad(root.value.real()), Quad(root.value.imag()));
            Complex rate = value(entries, quadratic, z).rate;
            for (const auto& other : spectrum.roots)
                if (&other != &root) rate -= complex(1, 0) / (z - in_quad(other.x));
            const double off = static_cast<double>(1 / cabsq(rate));
            CAPTURE(i, n, off, root.radius);
            if (std::isfinite(off)) CHECK(off <= root.radius * (1 + 1e-9));
            worst = std::max(worst, off / std::abs(root.value));
            CHECK(root.is_real == (root.value.imag() == 0));
            sum += in_quad(root.x);
        }
        CHECK(fabsq(__imag__ sum) <= Quad(1e-25));
    }
    CHECK(proved >= 297);
    CHECK(worst <= 1.2e-16);
}

TEST_CASE("roots that meet are not claimed to be apart", "[linalg]") {
    for (const double apart : {0.0, 1e-18, 1e-9, 1e-3}) {
        SignedPencil<S> pencil;  // (x - 1)(x - 1 - apart)
        pencil.quadratic = true;
        pencil.elements = {SignedElement<S>::of(S(1.0), -(S(2.0) + S(apart)), -(S(1.0) + S(apart)), S(0.0), S(0.0))};
        const auto spectrum = revchain::pencil::complex_spectrum(pencil, 0, [](double) {});
        CAPTURE(apart);
        CHECK(spectrum.proved == (apart > 1e-12));
    }
}
