// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "revchain/pencil/spectrum/aberth_walks.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// Eigenvalues lambda, descending, and a bound on the relative error of each.
struct AberthSpectrum {
    alignas(aberth::Four) std::array<double, aberth::most_walked> eigenvalue;
    std::array<double, aberth::most_links> bound;
};

namespace aberth {

/// Shifts of all roots, padded with copies of the last shift.
struct Roots {
    static constexpr std::size_t room = most_walked;
    std::size_t count;
    alignas(Four) double shift[room];

    void fill_up() {
        for (std::size_t i = count; i < walked<false>(count); ++i) shift[i] = shift[count - 1];
    }
    void sort() {
        if (!std::is_sorted(shift, shift + count)) std::sort(shift, shift + count);
        fill_up();
    }
    /// Returns true if all shifts lie in the range. A NaN gives false.
    bool lie_between(double lower, double upper) const {
        bool all = true;
        for (std::size_t i = 0; i < count; ++i) all = all && shift[i] >= lower && shift[i] <= upper;
        return all;
    }
};

/// Computes first approximations. Signs of the polynomial from pin to pin at 2 or 3 N points
/// between the bounds, uniform in a root of mu, count the zeros below each (Sturm). Single zeros
/// are interpolated.
template <bool rigid, bool several>
[[gnu::always_inline]] inline bool first_roots(const LumpedLinks& links, Roots& roots) {
    const std::size_t points = 4 * (((rigid || links.size > 12 ? 3 : 2) * links.size + 7) / 4);
    constexpr std::size_t room = 3 * most_links + 16;
    alignas(Four) double at[room], value[room], below[room];
    double root = std::sqrt(links.greatest_shift / links.least_shift);
    int squarings = 1;
    for (; squarings < 6 && root > 8 * static_cast<double>(links.size); ++squarings)
        root = std::sqrt(root);
    const double step = (root - 1) / static_cast<double>(points - 1);
    for_packs<several>(points, [&]<std::size_t P>(std::integral_constant<std::size_t, P>,
                                                  std::size_t i) REVCHAIN_INLINED {
        std::array<Four, P> mu, changes{};
        std::array<Offset<rigid>, P> y;
#pragma GCC unroll 3
        for (std::size_t p = 0; p < P; ++p) {
            mu[p] = Four(1.0) +
                    Four(step) * (Four(static_cast<double>(i + 4 * p)) + Four(0.0, 1.0, 2.0, 3.0));
            for (int s = 0; s < squarings; ++s) mu[p] = mu[p] * mu[p];
            mu[p] = mu[p] * Four(links.least_shift);
        }
        for (std::size_t m = 0; m < links.size; ++m)
#pragma GCC unroll 3
            for (std::size_t p = 0; p < P; ++p) {
                const Four before = y[p].value;
                y[p].rise(links, m, mu[p]);
                changes[p] += if_less(before * y[p].value, Four(0.0), Four(1.0), Four(0.0));
            }
#pragma GCC unroll 3
        for (std::size_t p = 0; p < P; ++p) {
            mu[p].store(at + i + 4 * p);
            y[p].value.store(value + i + 4 * p);
            changes[p].store(below + i + 4 * p);
        }
    });
    if (below[0] != 0 || below[points - 1] != static_cast<double>(links.size)) return false;
    at[points] = at[points - 1];
    value[points] = value[points - 1];
    std::fill_n(roots.shift, roots.count, 0.0);
    double guess[room];
    for (std::size_t i = 0; i < points; i += 4) {
        const Four from = Four::load(at + i), v = Four::load(value + i);
        const Four share = v / (v - Four::load(value + i + 1));
        const Four kept = max(Four(0.05), if_less(share, Four(0.95), share, Four(0.95)));
        (from + (Four::load(at + i + 1) - from) * kept).store(guess + i);
    }
    // The last point with j zeros below it is the one before zero j.
    double highest = 0;
    for (std::size_t i = 0; i + 1 < points; ++i) {
        const double number = below[i];
        if (!(number >= highest && number <= static_cast<double>(links.size))) return false;
        highest = number;
        roots.shift[std::min(static_cast<std::size_t>(number), roots.count - 1)] = guess[i];
    }
    if (std::all_of(roots.shift, roots.shift + roots.count,
                    [](double shift) { return shift > 0; })) {
        roots.fill_up();
        return true;
    }
    for (std::size_t i = 0; i + 1 < points; ++i) {  // several zeros lie between two points
        const double more = below[i + 1] - below[i];
        for (double j = 0; more > 1 && j < more; ++j)
            roots.shift[static_cast<std::size_t>(below[i] + j)] =
                at[i] + (at[i + 1] - at[i]) * (j + 0.5) / more;
    }
    roots.fill_up();
    return true;
}

/// Improves all zeros at once by Newton steps with the others divided out (Ehrlich, Aberth), until
/// steps are small. A step cubes the error. All steps use the zeros of the round before (Jacobi),
/// so results do not depend on the other lanes of a pack.
template <bool rigid, bool several>
[[gnu::always_inline]] inline void improve(const LumpedLinks& links, Roots& roots) {
    constexpr std::size_t chunk = 12;  // differences multiplied before one division
    constexpr double last_step = 2e-4;
    alignas(Four) double next[Roots::room];
    for (int round = 0; round < 16; ++round) {
        Four largest(0.0);
        for_packs<several>(roots.count, [&]<std::size_t P>(std::integral_constant<std::size_t, P>,
                                                           std::size_t i) REVCHAIN_INLINED {
            std::array<Four, P> mu, others{};
            std::array<OffsetAndSlope<rigid>, P> y;
#pragma GCC unroll 3
            for (std::size_t p = 0; p < P; ++p) mu[p] = Four::load(roots.shift + i + 4 * p);
            for (std::size_t m = 0; m < links.size; ++m)
#pragma GCC unroll 3
                for (std::size_t p = 0; p < P; ++p) y[p].rise(links, m, mu[p]);
            for (std::size_t first = 0; first < roots.count; first += chunk) {
                std::array<Four, P> product, derivative{};
                product.fill(Four(1.0));
                for (std::size_t j = first; j < std::min(first + chunk, roots.count); ++j)
#pragma GCC unroll 3
                    for (std::size_t p = 0; p < P; ++p) {
                        const Four distance = mu[p] - Four(roots.shift[j]), zero(0.0);
                        derivative[p] = if_equal(distance, zero, derivative[p],
                                                 derivative[p] * distance + product[p]);
                        product[p] = if_equal(distance, zero, product[p], product[p] * distance);
                    }
#pragma GCC unroll 3
                for (std::size_t p = 0; p < P; ++p) others[p] += derivative[p] / product[p];
            }
#pragma GCC unroll 3
            for (std::size_t p = 0; p < P; ++p) {
                const Four step = y[p].value / (y[p].slope - y[p].value * others[p]);
                (mu[p] - step).store(next + i + 4 * p);
                largest = max(largest, abs(step) - Four(last_step) * mu[p]);
            }
        });
        for (std::size_t i = 0; i < walked<several>(roots.count); i += 4)
            Four::load(next + i).store(roots.shift + i);
        if (!(largest[0] > 0 || largest[1] > 0 || largest[2] > 0 || largest[3] > 0)) return;
    }
}

/// Sets quotients and squared residuals at all shifts. Returns false if a number is unusable.
template <bool rigid, bool several>
[[gnu::always_inline]] inline bool set_quotients(const LumpedLinks& links,
                                                 const double* flexibility_above,
                                                 const Roots& roots, AberthSpectrum& result,
                                                 double* residual) {
    Four odd(0.0);
    for_packs<several>(links.size, [&]<std::size_t P>(std::integral_constant<std::size_t, P>,
                                                      std::size_t first) REVCHAIN_INLINED {
        std::array<Four, P> mu;
#pragma GCC unroll 3
        for (std::size_t p = 0; p < P; ++p) mu[p] = Four::load(roots.shift + first + 4 * p);
        // The form for a chain of one leg, if compiled, needs no sums of legs.
        const auto all = several && links.size <= leg
                             ? quotients<rigid, !several, P>(links, flexibility_above, mu)
                             : quotients<rigid, true, P>(links, flexibility_above, mu);
#pragma GCC unroll 3
        for (std::size_t p = 0; p < P; ++p) {
            const Quotients& q = all[p];
            (q.ratio / mu[p]).store(result.eigenvalue.data() + first + 4 * p);
            q.square.store(residual + first + 4 * p);
            odd += if_less(Four(0x1p-960), q.scale, Four(0.0), Four(1.0)) +
                   if_less(Four(0x1p-600), q.energy, Four(0.0), Four(1.0)) +
                   if_less(q.energy, Four(0x1p600), Four(0.0), Four(1.0)) +
                   if_less(Four(0.5), q.ratio, Four(0.0), Four(1.0)) +
                   if_less(q.ratio, Four(2.0), Four(0.0), Four(1.0));
        }
    });
    return odd[0] + odd[1] + odd[2] + odd[3] == 0;
}

/// Sets the bounds from quotients and residuals. Returns false if one exceeds the goal. Disjoint
/// intervals, as many as eigenvalues, hold one each; then the bounds follow (Kato, Temple).
/// `rounding` is the rounding error of the quotients. With `prove`, which needs lists, all modes of
/// up to 10 links took 1.15 to 1.25 times as long, and with the quotients of `proved_roots`, too,
/// twice as long.
inline bool set_bounds(AberthSpectrum& result, std::size_t n, const double* residual,
                       double rounding, double goal) {
    constexpr double slack = 1 + 0x1p-30;
    const double blurred = 1.01 * rounding + 0x1p-50;  // the stored quotient has rounding errors
    const auto& value = result.eigenvalue;
    double upper_end = std::numeric_limits<double>::infinity();  // of the gap about eigenvalue i
    bool good = true;
    for (std::size_t i = 0; i < n; ++i) {
        const double lower_end =
            i + 1 < n ? value[i + 1] + (residual[i + 1] + blurred) * value[i + 1] : 0.0;
        const double room =
            std::min(upper_end - value[i], value[i] - lower_end) - blurred * value[i];
        result.bound[i] = (residual[i] * (residual[i] * value[i]) / room + rounding) * slack;
        good = good && room > residual[i] * value[i] && result.bound[i] <= goal;
        upper_end = value[i] - (residual[i] + blurred) * value[i];
    }
    return good;
}

/// Implements `aberth_spectrum`. For the constants see docs/theory/spectrum.md, "Small chains".
template <bool rigid>
inline bool solve(const LumpedLinks& links, double tolerance, AberthSpectrum& result) {
    return simd([&]<class Registers>(Registers) REVCHAIN_INLINED {
        constexpr bool several = any_packs<Registers>;
        constexpr double unit = 0x1p-53, slack = 1 + 0x1p-30, largest = 0x1p64;
        const std::size_t n = links.size;
        const double lowest = 0.5 * links.least_shift, highest = 2 * links.greatest_shift;
        Roots roots;
        roots.count = n;
        double above[most_links], square = 0, sum = 0, cross_ratio = 0;
        bool fit = lowest > 1 / largest && highest < largest;
        for (std::size_t m = n; m-- > 0;) {
            const double mass = links.mass[m], k = links.stiffness[m],
                         flexibility = links.flexibility[m];
            sum += flexibility;
            above[m] = sum;
            square += k * sum;
            fit = fit && std::min({mass, k, flexibility}) > 1 / largest &&
                  std::max({mass, k, flexibility}) < largest;
            if constexpr (rigid) cross_ratio = std::max(cross_ratio, links.cross_ratio[m]);
        }
        const double root = std::sqrt(square);
        if (!fit || !first_roots<rigid, several>(links, roots)) return false;
        improve<rigid, several>(links, roots);
        if (!roots.lie_between(lowest, highest)) return false;
        roots.sort();

        const double additions = static_cast<double>(std::min(n, leg) + (n - 1) / leg - 1);
        const double rounding = unit *
                                (links.roundings.energies + (rigid ? 18 : 15) + 2 * additions +
                                 links.roundings.centroid) *
                                slack;
        const double goal = std::min(tolerance, 0x1p-32);  // else squares of bounds would matter
        alignas(Four) double residual[Roots::room];
        for (int round = 0; round < 2; ++round) {
            if (!set_quotients<rigid, several>(links, above, roots, result, residual)) return false;
            for (std::size_t i = 0; i < n; ++i) {
                const double stretch = rigid ? 1 + roots.shift[i] * cross_ratio : 1;
                const double rounded =
                    1.01 * unit * stretch *
                    ((10 + 2 * links.roundings.mass) * root + links.roundings.drop);
                residual[i] = 2 * (std::sqrt(residual[i]) * slack + rounded);  // 2 > 1 / ratio
            }
            if (set_bounds(result, n, residual, rounding, goal)) return true;
            for (std::size_t i = 0; i < n; ++i) roots.shift[i] = 1 / result.eigenvalue[i];
            if (!roots.lie_between(lowest, highest)) return false;
            roots.fill_up();
        }
        return false;
    });
}

}  // namespace aberth

/// Computes all eigenvalues lambda of lambda K y = M y for a small chain, each with a proved bound
/// of at most `tolerance` and 2^-32. Returns false, with no valid result, if neighbours are too
/// close or numbers leave the range of double.
///
/// Method: the characteristic polynomial, without division, at 2 or 3 points an eigenvalue.
/// Ehrlich's and Aberth's iteration finds all zeros at once, mostly in three rounds. Then come
/// Rayleigh quotients of twisted vectors, whose error is the square of the vectors'. Residuals give
/// as many disjoint intervals as eigenvalues, and so number them. Accuracy, measured: 4 ulp;
/// proved: about 20 ulp for 10 links, 33 for 100. Cost: bench_engines. Preconditions: 1 <= size <=
/// most_links; X >= 0, M positive definite. Numbers beyond 2^-64 ... 2^64 also give false.
inline bool aberth_spectrum(const aberth::LumpedLinks& links, double tolerance,
                            AberthSpectrum& result) {
    return links.rigid ? aberth::solve<true>(links, tolerance, result)
                       : aberth::solve<false>(links, tolerance, result);
}

}  // namespace revchain::pencil
