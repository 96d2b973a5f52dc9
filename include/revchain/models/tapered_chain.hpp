// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <numbers>

#include "revchain/models/model.hpp"
#include "revchain/models/straight_links.hpp"
#include "revchain/numeric/zeros_of_j.hpp"

namespace revchain::inline REVCHAIN_BUILD::models {

/// Heights of chains made by `Chain::tapered`. The height of the cord from which they are cut is
/// lambda = 4 (p+1) L/j^2, j = j_{p,k}, Greenhill (1908) §4. The reduction by straight links is
/// subtracted, to the order 1/N^2 (straight_links.hpp). Error bound: half of a bound of the next
/// order, and roundings. Measured: tests/cpp/models/tapered.cpp. Cost: 1 to 5 microseconds for each
/// of the first modes, less for later ones.
struct TaperedChain {
    static constexpr std::string_view name = "tapered chain";

    Fit applies(const ChainKind& kind, const Question& question) const {
        if (!kind.taper) return Fit::no("not cut from a cord of power-law density");
        if (*kind.taper == 0) return Fit::no("equal rods, a continuous chain");
        if (!(*kind.taper >= -0.98 && *kind.taper <= 100))
            return Fit::no("an exponent below -0.98 or above 100");
        if (2 * question.last() > kind.size) return Fit::no("more than half of the modes");
        return {};
    }
    double error_bound(const ChainKind& kind, const Question& question) const {
        const double p = *kind.taper;
        const Index k = question.last();
        const double bound = predicted_bound(kind, p, k);
        return question.first == 1 && k > 1 ? std::max(bound, predicted_bound(kind, p, 1)) : bound;
    }
    double cost(const ChainKind& kind, const Question& question) const {
        const double p = *kind.taper, first = detail::real(question.first);
        // Modes before number `series` need Bessel functions by recurrence.
        const double series = std::max(30.0, 8 * p) / std::numbers::pi + 0.25 - p / 2;
        const double count = detail::real(question.count),
                     near = std::clamp(series - first + 1, 0.0, count);
        const auto steps = [&](double k) {
            const double turns = std::numbers::pi * k;
            return 12 + turns + 10 * std::cbrt(std::max(0.0, p) + turns);
        };
        return 3e-7 + near * (2e-7 + 2.4e-8 * steps(first + near / 2)) +
               (count - near) * (1.5e-7 + 2.2e-9 * steps(first + near + (count - near) / 2));
    }
    Answer solve(const Chain<double>&, const ChainKind& kind, const Question& question) const {
        const double p = *kind.taper, n = detail::real(kind.size);
        const revchain::detail::ZerosOfJ zeros(p);
        return answer_of_each(question, [&](Index k) {
            const double j = zeros(k), half = j / 2, cord = (p + 1) * (kind.length / half / half);
            return detail::enclosed(cord, detail::second_order(p, j) / (n * n),
                                    detail::next_order(p, k, share(kind, p, j)), rounding(p));
        });
    }

   private:
    /// Length of a link over the height of the cord.
    static double share(const ChainKind& kind, double p, double j) {
        return j * j / (4 * (p + 1) * detail::real(kind.size));
    }
    /// Rounding errors of the zero, of this function, and of the links: three in each stiffness and
    /// mass. If almost all weight is in the lowest link, its radius of gyration is the small
    /// difference of two lengths.
    static double rounding(double p) {
        return epsilon<double>() * (6 + (p < 0 ? 1 / std::sqrt(p + 1) : 1));
    }

    /// Returns the error bound before the zero is known, from above and without Bessel functions.
    static double predicted_bound(const ChainKind& kind, double p, Index k) {
        const double n = detail::real(kind.size), j = zero_at_most(p, k);
        const double lost = second_order_at_most(p, k, j) / (n * n);
        return detail::enclosed(1, lost, detail::next_order(p, k, share(kind, p, j)), rounding(p))
                   .error_bound *
               (1 + 1e-12);
    }
    /// |a_k|, the k-th zero of Ai, to within 2e-3 from above: DLMF 9.9.18, one correction.
    static double airy_zero(Index k) {
        const double t = 3 * std::numbers::pi / 8 * (4 * detail::real(k) - 1);
        return std::cbrt(t * t) * (1 + 5.0 / 48 / (t * t));
    }
    /// An upper bound of j_{p,k}. It is McMahon's leading term, for |p| <= 1/2 with the next one
    /// (DLMF 10.21.19). For p < 0 and k = 1, j^2 <= 4 (p+1)(p+2) from Rayleigh's sums. For large p
    /// it is Qu and Wong's bound (doi:10.1090/S0002-9947-99-02165-0).
    static double zero_at_most(double p, Index k) {
        const double beta = std::numbers::pi * (detail::real(k) + p / 2 - 0.25);
        double j = std::abs(p) <= 0.5 ? beta + (1 - 4 * p * p) / (8 * beta) : beta;
        if (p < 0 && k == 1) j = std::min(j, 2 * std::sqrt((p + 1) * (p + 2)));
        if (p > 0.5) {
            const double a = airy_zero(k), g = std::cbrt(p / 2);
            j = std::min(j, p + a * g + 0.15 * a * a / g);
        }
        return j * (1 + 4 * epsilon<double>());
    }
    /// An upper bound of c, from 1/J^2 < (pi j/2)/sqrt(1 - p^2/j^2), without the root for |p| < 1/2
    /// (Watson, §13.74: z (J^2 + Y^2)), and I <= arccos(p/j)/(pi (p + 2)), I <= 1/(2 (p + 2)) for p
    /// < 0. For the first mode c <= 0.09 (p + 1)^2. The last two are measured for p > 0: they give
    /// 1.06 to 2.2 of c, and error bounds up to twice those of the answer
    /// (tests/cpp/models/tapered.cpp).
    static double second_order_at_most(double p, Index k, double j) {
        const double first = 0.09 * (p + 1) * (p + 1);
        if (p < 0 && k == 1) return first;
        double inverse = std::numbers::pi / 2 * j;
        if (p > 0.5) {
            const double ratio =
                p / (p + (airy_zero(k) - 0.01) * std::cbrt(p / 2));  // j from below, Qu and Wong
            inverse /= std::sqrt((1 - ratio) * (1 + ratio));
        } else if (p < -0.5) {
            const double ratio =
                p / (std::numbers::pi * (detail::real(k) - 0.75));  // j_{-1,k} > ..., k > 1
            inverse /= std::sqrt((1 - ratio) * (1 + ratio));
        }
        const double part = (p > 0 ? std::acos(p / j) / std::numbers::pi : 0.5) / (p + 2);
        const double bound = j * j / 24 * part * inverse;
        return k == 1 ? std::min(bound, first) : bound;
    }
};

}  // namespace revchain::models
