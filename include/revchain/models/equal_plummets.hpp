// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/models/model.hpp"
#include "revchain/numeric/zero_of_j0.hpp"

namespace revchain::inline REVCHAIN_BUILD::models {

using revchain::detail::zero_of_j0;

/// Heights of N equal plummets at distances a: a/lambda are the zeros of the Laguerre polynomial
/// L_N. Tricomi's expansion of them (DLMF 18.16(v)), with j = j_{0,k} and nu = 4 N + 2, is taken
/// four terms farther,
///
///     (j^2/nu) (1 + (j^2 - 2)/(3 nu^2) + (11 j^4 - 57 j^2 + 94)/(45 nu^4) + ...),
///
/// from u'' + u'/z + (1 - z^2/nu^2) u = 0, z^2 = nu x, solved by powers of 1/nu^2 in z^m J_0(z) and
/// z^m J_1(z).
/// Error bound: twice the last term, which is left out, plus 4 ulp. Measured for N = 1 to 1e6: 0.93
/// of the last term if j < nu/2 (tests/cpp/models/models.cpp). Cost: 20 ns a mode.
struct EqualPlummets {
    static constexpr std::string_view name = "Laguerre asymptotics";

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (!kind.plummets) return Fit::no("not equal plummets");
        if (!(2 * zero_of_j0(question.last()) < nu(kind)))
            return Fit::no("too fast a mode of too few links");
        return {};
    }
    double error_bound(const ChainKind& kind, const Question& question) const {
        return bound(terms(kind, question.last()));
    }
    double cost(const ChainKind&, const Question& question) const {
        return 1.1e-7 + 2e-8 * detail::real(question.count);
    }
    Answer solve(const Chain<double>& chain, const ChainKind& kind,
                 const Question& question) const {
        return answer_of_each(question, [&](Index k) {
            const Terms t = terms(kind, k);
            const double half = zero_of_j0(k) / 2;
            return BoundedHeight{
                chain.length()[0] * (detail::real(kind.size) + 0.5) / (half * half) / t.sum,
                bound(t)};
        });
    }

   private:
    struct Terms {
        double sum, last;
    };
    static double nu(const ChainKind& kind) { return 4 * detail::real(kind.size) + 2; }
    static double bound(const Terms& terms) {
        return 2 * std::abs(terms.last) + 4 * epsilon<double>();
    }
    static Terms terms(const ChainKind& kind, Index k) {
        const double j = zero_of_j0(k), p = j * j, e = 1 / (nu(kind) * nu(kind));
        const double first = e * (p - 2) / 3, second = e * e * ((11 * p - 57) * p + 94) / 45;
        const double third = e * e * e * (((657 * p - 6516) * p + 28102) * p - 48308) / 2835;
        const double fourth =
            e * e * e * e * ((((10644 * p - 172740) * p + 1456807) * p - 6605817) * p + 12059918) /
            42525;
        return {1 + (first + (second + third)), fourth};
    }
};

}  // namespace revchain::models
