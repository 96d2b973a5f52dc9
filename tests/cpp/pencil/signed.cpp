// SPDX-License-Identifier: MPL-2.0
// Proved counts of families whose numbers have any sign, against pivots in quadruple precision of the same elements,
// closer and closer to an eigenvalue.
#include "revchain/pencil/sturm.hpp"

#include "support/catch.hpp"
#include "support/chains.hpp"
#include "support/truth.hpp"

using revchain::Index;
using revchain::Wide;
using revchain::pencil::SignedElement;
using revchain::pencil::SignedPencil;
using support::Quad;
using support::quad;
using support::Random;
using S = Wide<double>;

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
