// SPDX-License-Identifier: MPL-2.0
#include "revchain/pencil/sturm.hpp"

#include "revchain/linear/assembly.hpp"
#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Index;
using revchain::pencil::SignedElement;
using revchain::pencil::SignedPencil;
using support::Quad;
using support::quad;
using support::Random;
using support::Truth;
namespace pencil = revchain::pencil;
using WideDouble = revchain::Wide<double>;
using S = WideDouble;

// A proved count has to be right at any shift: random ones, and ones next to eigenvalues.
TEST_CASE("proved counts agree with quadruple precision", "[linalg]") {
    Index proved_in_double = 0, proved_in_wide = 0, asked = 0;
    for (const auto& family : support::families()) {
        for (const Index n : {1, 2, 3, 7, 40, 200}) {
            const auto chain = family.make(n);
            const auto assembled = revchain::assemble(chain);
            const auto pencil = pencil::rounded<double>(assembled.pencil);
            const double unit = std::ldexp(1.0, assembled.units.length_exponent);
            const Truth truth(chain);
            support::Random random(static_cast<std::uint64_t>(n));
            for (int i = 0; i < 40; ++i) {
                const double shift = random.log_between(1e-12, 2.0) * chain.total_length() / unit;
                const Index expected = truth.above(Quad(shift) * unit);
                const auto wide = pencil::certified_count<WideDouble, 2>(assembled.pencil, {shift, shift * 0.5})[0];
                const auto narrow = pencil::certified_count<double, 1>(pencil, {shift})[0];
                const auto plain = pencil::count_above<double, 2>(pencil, {shift, shift})[1];
                CAPTURE(family.name, n, shift);
                CHECK(wide.proved);
                CHECK(wide.above == expected);
                if (narrow.proved) CHECK(narrow.above == expected);
                CHECK(plain == expected);  // not proved, but no random shift comes near enough to matter
                ++asked;
                proved_in_double += narrow.proved ? 1 : 0;
                proved_in_wide += wide.proved ? 1 : 0;
            }
        }
    }
    CAPTURE(asked, proved_in_double, proved_in_wide);
    CHECK(proved_in_wide == asked);
    CHECK(static_cast<double>(proved_in_double) >= 0.99 * static_cast<double>(asked));
}

TEST_CASE("next to an eigenvalue double doubts and the double word decides", "[linalg]") {
    const auto chain = revchain::Chain<double>::uniform_plummets(1000);
    const auto assembled = revchain::assemble(chain);
    const auto pencil = pencil::rounded<double>(assembled.pencil);
    const double unit = std::ldexp(1.0, assembled.units.length_exponent);
    const Truth truth(chain);
    const Quad height = truth.height(4, 1e-6, 2.0, 1e-30) / unit;
    const double high = static_cast<double>(height);
    const WideDouble exact(high, static_cast<double>(height - high));
    for (const double away : {1e-16, 1e-18, 1e-20, 1e-22}) {
        const auto count = pencil::certified_count<WideDouble, 2>(
            assembled.pencil, {exact * (WideDouble(1) - away), exact * (WideDouble(1) + away)});
        CAPTURE(away);
        CHECK(count[0].proved);
        CHECK(count[1].proved);
        CHECK(count[0].above == 5);
        CHECK(count[1].above == 4);
    }
    const auto at = pencil::certified_count<double, 1>(pencil, {high})[0];
    CHECK_FALSE(at.proved);
    // far enough off, double proves it too: about an ulp for each link
    CHECK(pencil::certified_count<double, 1>(pencil, {high * (1 + 64 * 1000 * 0x1p-52)})[0].proved);
    CHECK(pencil::certified_count<double, 1>(pencil, {high * (1 + 64 * 1000 * 0x1p-52)})[0].above == 4);
}

TEST_CASE("an eigenvalue at the shift is not above it", "[linalg]") {
    // one plummet of length 1: everything exact, the pivot is exactly 0
    const auto assembled = revchain::assemble(revchain::Chain<double>(std::vector{revchain::plummet(1.0, 1.0)}));
    const auto pencil = pencil::rounded<double>(assembled.pencil);
    const double height = std::ldexp(1.0, -assembled.units.length_exponent);
    CHECK(pencil::count_above<double, 1>(pencil, {height})[0] == 0);
    CHECK(pencil::certified_count<double, 1>(pencil, {height})[0].above == 0);
    CHECK_FALSE(pencil::certified_count<double, 1>(pencil, {height})[0].proved);
    CHECK(pencil::count_above<double, 1>(pencil, {std::nextafter(height, 0.0)})[0] == 1);
}

TEST_CASE("no proof comes out of a NaN", "[linalg]") {
    auto pencil = pencil::rounded<double>(revchain::assemble(revchain::Chain<double>::uniform_rods(5)).pencil);
    CHECK_FALSE(pencil::certified_count<double, 1>(pencil, {std::nan("")})[0].proved);
    pencil.elements[2].stiffness = std::nan("");
    CHECK_FALSE(pencil::certified_count<double, 1>(pencil, {0.1})[0].proved);
    pencil.elements[2].stiffness = std::numeric_limits<double>::infinity();
    CHECK_FALSE(pencil::certified_count<double, 1>(pencil, {0.1})[0].proved);
}

// The running error bound itself: halving the working precision's honesty must be seen. D is compared with the truth
// through the count only, so here the bound is tested from the other side: it must not be so loose that a double word
// proves nothing at 1e5 links, nor so tight that float claims what it cannot know.
TEST_CASE("float counts, when proved, are right", "[linalg]") {
    support::Random random(9);
    Index proved = 0, asked = 0;
    for (const auto& family : support::families()) {
        if (family.name.find("1e12") != std::string::npos) continue;  // beyond float's range of weights
        const auto chain = family.make(60);
        const auto assembled = revchain::assemble(chain);
        const auto pencil = pencil::rounded<float>(pencil::rounded<double>(assembled.pencil));
        const double unit = std::ldexp(1.0, assembled.units.length_exponent);
        const Truth truth(chain);
        for (int i = 0; i < 2000; ++i) {
            const float shift = static_cast<float>(random.log_between(1e-3, 1.0) * chain.total_length() / unit);
            const auto count = pencil::certified_count<float, 1>(pencil, {shift})[0];
            ++asked;
            if (!count.proved) continue;
            ++proved;
            CAPTURE(family.name, shift);
            REQUIRE(count.above == truth.above(Quad(shift) * unit));
        }
    }
    CAPTURE(asked, proved);
    CHECK(static_cast<double>(proved) > 0.9 * static_cast<double>(asked));
    CHECK(proved < asked);
}

TEST_CASE("1e5 links", "[linalg]") {
    const auto assembled = revchain::assemble(revchain::Chain<double>::uniform_rods(100'000));
    CHECK(assembled.pencil.entry_error < 1e-25);
    const auto count = pencil::certified_count<WideDouble, 1>(assembled.pencil, {0.3})[0];
    CHECK(count.proved);
    CHECK(count.above == pencil::count_above<double, 1>(pencil::rounded<double>(assembled.pencil), {0.3})[0]);
}

// Families whose numbers have any sign, against pivots in quadruple precision of the same elements, closer and closer to
// an eigenvalue.
namespace {

Index negative(const SignedPencil<S>& pencil, Quad x) {
    const auto f = pencil.quadratic ? std::pair(x * x, x) : std::pair(x, Quad(0));
    Index count = 0;
    Quad below = 0;
    for (const SignedElement<S>& e : pencil.elements) {
        const Quad L = f.first * quad(e.stiffness) + f.second * quad(e.spin), X = quad(e.cross);
        const Quad A = quad(e.lower), B = quad(e.upper), p = below + L - A;
        count += p < 0;
        below = ((L - B) * below - (L * (A + B + 2 * X) - (A * B - X * X))) / p;
    }
    return count;
}

/// `stiff`: how many decades some links' stiffness is above the others'.
SignedPencil<S> random_pencil(Random& random, Index n, bool quadratic, double stiff = 0) {
    SignedPencil<S> pencil;
    pencil.quadratic = quadratic;
    for (Index m = 0; m < n; ++m) {
        const auto any = [&] { return S(random.log_between(1e-2, 1e2) * (random() < 0.3 ? -1 : 1)); };
        const S stiffness = any() * S(stiff > 0 ? std::pow(10.0, std::floor(stiff * random())) : 1.0);
        const std::array<S, 4> any_of{quadratic ? any() : S(0.0), any(), any(), any() * S(0.3)};
        pencil.elements.push_back(SignedElement<S>::of(stiffness, any_of[0], any_of[1], any_of[2], any_of[3]));
    }
    return pencil;
}

}  // namespace

TEST_CASE("a proved count is right, however close to an eigenvalue; and mostly proved to 1e-26", "[linalg]") {
    Random random(81);
    int proved = 0, asked = 0, unproved_at_it = 0, roots = 0;
    for (int i = 0; i < 800; ++i) {
        const auto pencil = random_pencil(random, 1 + i % 12, i % 2 == 0, i < 400 ? 0 : 30);
        Quad lower = random.log_between(1e-3, 1e3), upper = lower * random.between(2, 50);
        const Index low = negative(pencil, lower), high = negative(pencil, upper);
        if (low == high) continue;
        ++roots;
        for (int step = 0; step < 110; ++step) {
            const Quad middle = (lower + upper) / 2;
            (negative(pencil, middle) == low ? lower : upper) = middle;
        }
        for (int digits = 8; digits <= 30; digits += 2)
            for (const int side : {-1, 1}) {
                const Quad x = lower * (1 + side * powq(10, -digits));
                const double head = static_cast<double>(x);
                const S shift = revchain::fast_two_sum(head, static_cast<double>(x - Quad(head)));
                const auto count = revchain::pencil::certified_count<S, 1>(pencil, {shift})[0];
                if (count.proved) REQUIRE(count.above == negative(pencil, quad(shift)));
                if (digits <= 26) ++asked, proved += count.proved;
                if (digits == 30) unproved_at_it += !count.proved;
            }
    }
    CHECK(roots > 200);
    CHECK(proved >= asked * 0.98);
    CHECK(unproved_at_it >= roots);
}

TEST_CASE("errors of the entries withdraw a proof where they could change the count", "[linalg]") {
    SignedPencil<S> pencil;
    pencil.elements = {SignedElement<S>::of(S(1.0), S(0.0), S(1.0), S(0.0), S(0.0))};  // x - 1
    pencil.elements[0].error = {0, 0, 1e-10, 0, 0};
    for (const auto& [x, sure] :
         {std::pair(1 + 2e-10, true), std::pair(1 + 0.9e-10, false), std::pair(1 - 2e-10, true)})
        CHECK(revchain::pencil::certified_count<S, 1>(pencil, {S(x)})[0].proved == sure);
    pencil.elements[0].error.lower = std::nan("");
    CHECK(!revchain::pencil::certified_count<S, 1>(pencil, {S(3.0)})[0].proved);
}

TEST_CASE("elements of any sign in several units are counted as in one", "[linalg]") {
    Random random(82);
    int proved = 0;
    for (int i = 0; i < 200; ++i) {
        const auto pencil = random_pencil(random, 8, i % 2 == 0);
        auto in_units = pencil;  // the lowest three are in units of 2^-40, the next three of 2^-7
        in_units.units = {-40, -40, -40, -7, -7, -7, 0, 0};
        for (std::size_t m = 0; m < 8; ++m) {
            const auto scaled = [&](const S& x) { return ldexp(x, -in_units.units[m]); };
            const auto& e = pencil.elements[m];
            in_units.elements[m] = SignedElement<S>::of(scaled(e.stiffness), scaled(e.spin), scaled(e.lower),
                                                        scaled(e.upper), scaled(e.cross));
        }
        const S shift(random.log_between(1e-3, 1e3));
        const auto one = revchain::pencil::certified_count<S, 1>(pencil, {shift})[0];
        const auto several = revchain::pencil::certified_count<S, 1>(in_units, {shift})[0];
        const double rough = static_cast<double>(shift);
        const auto plain =
            revchain::pencil::count_above<double, 1>(revchain::pencil::rounded<double>(in_units), {rough});
        REQUIRE((one.above == several.above && several.proved == one.proved));
        if (one.proved) REQUIRE(plain[0] == one.above);
        proved += one.proved;
    }
    CHECK(proved > 190);
}
