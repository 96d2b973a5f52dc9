// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <vector>

#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/element.hpp"
#include "revchain/simd/pack.hpp"

/// This header computes unproved starts for all roots of det Q(x), in double, one root a lane.
namespace revchain::inline REVCHAIN_BUILD::pencil {

template <class V>
struct ComplexLanes {
    V re{}, im{};

    [[gnu::always_inline]] friend ComplexLanes operator+(const ComplexLanes& x,
                                                         const ComplexLanes& y) {
        return {x.re + y.re, x.im + y.im};
    }
    [[gnu::always_inline]] friend ComplexLanes operator-(const ComplexLanes& x,
                                                         const ComplexLanes& y) {
        return {x.re - y.re, x.im - y.im};
    }
    [[gnu::always_inline]] friend ComplexLanes operator*(const ComplexLanes& x,
                                                         const ComplexLanes& y) {
        return {x.re * y.re - x.im * y.im, x.re * y.im + x.im * y.re};
    }
    [[gnu::always_inline]] friend ComplexLanes operator*(const ComplexLanes& x, const V& y) {
        return {x.re * y, x.im * y};
    }
    [[gnu::always_inline]] friend ComplexLanes operator+(const ComplexLanes& x, const V& y) {
        return {x.re + y, x.im};
    }
    [[gnu::always_inline]] friend ComplexLanes inverse(const ComplexLanes& x) {
        const V square = x.re * x.re + x.im * x.im;
        return {x.re / square, -(x.im / square)};
    }
};

namespace detail {

using RoundedElement = SignedElement<double>;

/// Returns P'/P of P = det Q at x: the sum of p'/p over the pivots, by equation (1) differentiated.
template <bool quadratic, class V>
[[gnu::always_inline]] inline ComplexLanes<V> log_derivative_in_lanes(const RoundedElement* rows,
                                                                      std::size_t count,
                                                                      const ComplexLanes<V>& x) {
    using Z = ComplexLanes<V>;
    const Z square = x * x, twice = x + x;
    Z below{}, slope_below{}, sum{};
    for (std::size_t m = 0; m < count; ++m) {
        const RoundedElement& e = rows[m];
        const V k(e.stiffness), lower(e.lower), cross(e.cross);
        Z L = x * k, slope{k, V{}};
        if constexpr (quadratic) {
            const V s(e.spin);
            L = square * k + x * s;
            slope = twice * k + s;
        }
        const Z inverse_pivot = inverse(below + (L + -lower));
        const Z q = (L + cross) * inverse_pivot, rest = (below + -(lower + cross)) * inverse_pivot;
        sum = sum + (slope_below + slope) * inverse_pivot;
        slope_below = rest * rest * slope + q * q * slope_below;
        below = ((L + -V(e.upper)) * below - (L * V(e.weight) + -V(e.turning))) * inverse_pivot;
    }
    return sum;
}

/// Roots in double, with separate real and imaginary parts for loads into lanes.
struct SplitRoots {
    std::vector<double> re, im;

    std::size_t size() const { return re.size(); }
    void push_back(const std::complex<double>& x) {
        re.push_back(x.real()), im.push_back(x.imag());
    }
    std::complex<double> operator[](std::size_t i) const { return {re[i], im[i]}; }
};

/// Moves each root by up to 0.04/n of its size: equal roots would stay equal, real roots real.
inline void scatter(SplitRoots& roots) {
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const double turn =
            4e-4 * static_cast<double>(i % 97 + 1) / static_cast<double>(roots.size());
        const std::complex<double> x =
            roots[i] * std::complex<double>(1 + turn / 7, i % 2 == 0 ? turn : -turn);
        roots.re[i] = x.real(), roots.im[i] = x.imag();
    }
}

/// Computes Newton steps of the roots listed in `active`, with the others divided out (Ehrlich,
/// Aberth). All steps use the same roots, so results do not depend on the number of threads.
inline void aberth_steps(const RoundedElement* rows, std::size_t links, bool quadratic, Index zeros,
                         const SplitRoots& roots, const std::vector<std::size_t>& active,
                         SplitRoots& step) {
    constexpr std::size_t L = 2 * most_doubles;
    revchain::detail::parallel_for(active.size(), L, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += L) {
            revchain::detail::check_interrupt();
            alignas(64) double re[L], im[L];
            for (std::size_t i = 0; i < L; ++i) {
                const std::size_t at = active[std::min(first + i, end - 1)];
                re[i] = roots.re[at], im[i] = roots.im[at];
            }
            simd([&](auto where) REVCHAIN_INLINED {
                constexpr std::size_t width = decltype(where)::doubles;
                using V = Pack<double, width, L / width>;
                using Z = ComplexLanes<V>;
                const Z x{V::load(re), V::load(im)};
                const Z rate = quadratic ? log_derivative_in_lanes<true>(rows, links, x)
                                         : log_derivative_in_lanes<false>(rows, links, x);
                Z others = inverse(x) * V(static_cast<double>(zeros));
                const V none(0.0);
                for (std::size_t j = 0; j < roots.size(); ++j) {
                    const Z apart{x.re - V(roots.re[j]), x.im - V(roots.im[j])};
                    const V square = apart.re * apart.re + apart.im * apart.im;
                    const V over = select(square > none, V(1.0) / square, none);
                    others = {others.re + apart.re * over, others.im - apart.im * over};
                }
                const Z moved = inverse(rate - others);
                moved.re.store(re), moved.im.store(im);
            });
            for (std::size_t i = 0; i < L && first + i < end; ++i)
                step.re[active[first + i]] = re[i], step.im[active[first + i]] = im[i];
        }
    });
}

/// Moves roots until no step exceeds the share `finest` or grows. Returns the number of sweeps.
inline int aberth(const RoundedElement* rows, std::size_t links, bool quadratic, Index zeros,
                  SplitRoots& roots, double finest, int most,
                  const std::function<void()>& advance) {
    std::vector<std::size_t> active(roots.size());
    for (std::size_t i = 0; i < active.size(); ++i) active[i] = i;
    std::vector<double> last(roots.size(), std::numeric_limits<double>::infinity());
    SplitRoots step = roots;
    int sweep = 0;
    for (; sweep < most && !active.empty(); ++sweep) {
        aberth_steps(rows, links, quadratic, zeros, roots, active, step);
        std::vector<std::size_t> left;
        for (const std::size_t i : active) {
            const double share = std::abs(step[i]) / std::abs(roots[i]);
            if (!std::isfinite(share)) continue;
            roots.re[i] -= step.re[i], roots.im[i] -= step.im[i];
            if (share > finest && !(share < 1e-8 && share > last[i] / 4)) left.push_back(i);
            last[i] = share;
        }
        active = std::move(left);
        if (advance) advance();
    }
    return sweep;
}

/// Returns the roots of one element: of x k = A, or of x^2 k + x s = A.
inline SplitRoots roots_of(const RoundedElement& e, bool quadratic) {
    SplitRoots roots;
    if (e.stiffness == 0) {
        if (quadratic && e.spin != 0) roots.push_back(e.lower / e.spin);
    } else if (!quadratic) {
        roots.push_back(e.lower / e.stiffness);
    } else {
        const std::complex<double> discriminant = e.spin * e.spin + 4 * e.stiffness * e.lower;
        const std::complex<double> square = std::sqrt(discriminant);
        const std::complex<double> far =
            (e.spin < 0 ? square - e.spin : -e.spin - square) / (2 * e.stiffness);
        roots.push_back(far);
        roots.push_back(std::abs(far) > 0 ? -e.lower / (e.stiffness * far) : far);
    }
    return roots;
}

/// Returns approximate roots of `links` elements, from those of its halves, upper ends held.
inline SplitRoots halved_roots(const RoundedElement* rows, std::size_t links, bool quadratic,
                               const std::function<void()>& advance) {
    if (links == 1) return roots_of(rows[0], quadratic);
    SplitRoots roots = halved_roots(rows, links / 2, quadratic, advance);
    const SplitRoots above = halved_roots(rows + links / 2, links - links / 2, quadratic, advance);
    for (std::size_t i = 0; i < above.size(); ++i) roots.push_back(above[i]);
    scatter(roots);
    aberth(rows, links, quadratic, 0, roots, 1e-3, 12, advance);
    return roots;
}

/// Returns all `degree` roots in double, without the `zeros` roots at 0.
inline std::vector<std::complex<double>> first_roots(const SignedPencil<Wide<double>>& pencil,
                                                     Index zeros, Index degree,
                                                     const std::function<void(double)>& advance) {
    const auto rows = rounded<double>(pencil).elements;
    const std::size_t links = rows.size(), half = links / 2,
                      wanted = static_cast<std::size_t>(degree);
    std::vector<std::complex<double>> starts;
    const auto add = [&](const SplitRoots& part) {
        for (std::size_t i = 0; i < part.size(); ++i) starts.push_back(part[i]);
    };
    const auto tick = [&] { advance(0.1); };
    if (half > 0) add(halved_roots(rows.data(), half, pencil.quadratic, tick));
    add(halved_roots(rows.data() + half, links - half, pencil.quadratic, tick));
    // The smallest root replaces the roots that are 0.
    std::sort(starts.begin(), starts.end(),
              [](const auto& x, const auto& y) { return std::abs(x) > std::abs(y); });
    if (starts.empty()) starts.emplace_back(1.0);
    while (starts.size() < wanted) starts.push_back(starts.back() / 2.0);
    starts.resize(wanted);
    SplitRoots roots;
    for (const auto& x : starts)
        roots.push_back(std::isfinite(std::abs(x)) && std::abs(x) > 0 ? x : 1.0);
    scatter(roots);
    aberth(rows.data(), links, pencil.quadratic, zeros, roots, 1e-13, 100, [&] { advance(0.3); });
    for (std::size_t i = 0; i < wanted; ++i) starts[i] = roots[i];
    return starts;
}

}  // namespace detail
}  // namespace revchain::pencil
