// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <optional>

#include "revchain/pencil/complex/isolation.hpp"

/// This header finds all x with det Q(x) = 0, real or not; the numbers of Q may have any sign.
namespace revchain::inline REVCHAIN_BUILD::pencil {

/// A root x, and the radius of a disc that holds the exact root.
struct EnclosedRoot {
    ComplexWord x{};                                          ///< to about 30 digits if isolated
    std::complex<double> value{};                             ///< rounded
    double radius = std::numeric_limits<double>::infinity();  ///< about `value`; proved if finite
    bool is_real = false;
};

/// Roots by size, largest first. `proved`: each disc holds exactly one root, and all others are 0.
struct ComplexSpectrum {
    std::vector<EnclosedRoot> roots;
    bool proved = false;
};

namespace detail {

/// Steps of Weierstrass's method from approximate roots x_j to x_j - w_j: w_j = P(x_j)/(c prod (x_j
/// - x_k)), with c the leading coefficient of P = det Q without its zeros at 0.
struct WeierstrassSteps {
    std::vector<std::complex<double>> step;
    std::vector<double> blur;  ///< the relative error of a step; infinite if unknown
};

/// Calls f(lanes, number of lanes in use) for all numbers in `which`.
template <class F>
void for_lanes(const std::vector<std::size_t>& which, const std::function<void(double)>& advance,
               const F& f) {
    constexpr std::size_t L = value_lanes;
    revchain::detail::parallel_for(which.size(), L, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += L) {
            advance(0.6);
            std::size_t lane[L];
            for (std::size_t i = 0; i < L; ++i) lane[i] = which[std::min(first + i, end - 1)];
            f(lane, std::min(L, end - first));
        }
    });
}

inline void evaluate(const SignedPencil<Wide<double>>& pencil,
                     const std::vector<ComplexWord>& roots, const std::vector<std::size_t>& which,
                     std::vector<ScaledValue>& values, const std::function<void(double)>& advance) {
    for_lanes(which, advance, [&](const std::size_t* lane, std::size_t count) {
        ComplexWord x[value_lanes];
        ScaledValue found[value_lanes];
        for (std::size_t i = 0; i < value_lanes; ++i) x[i] = roots[lane[i]];
        simd([&](auto where) REVCHAIN_INLINED { values_in_lanes(where, pencil, x, found); });
        for (std::size_t i = 0; i < count; ++i) values[lane[i]] = found[i];
    });
}

inline WeierstrassSteps steps(const SignedPencil<Wide<double>>& pencil, Index zeros,
                              const std::vector<ComplexWord>& roots,
                              const std::vector<std::size_t>& which,
                              const std::vector<ScaledValue>& values,
                              const std::function<void(double)>& advance) {
    const std::size_t n = roots.size();
    const double sums = static_cast<double>(16 * n + 64) * epsilon<double>();
    const SplitWords split(roots);
    const ScaledValue leading = leading_term(pencil).coefficient;
    WeierstrassSteps result{std::vector<std::complex<double>>(n), std::vector<double>(n)};
    for_lanes(which, advance, [&](const std::size_t* lane, std::size_t count) {
        ScaledValue products[value_lanes];
        simd([&](auto where) REVCHAIN_INLINED { products_in_lanes(where, split, lane, products); });
        for (std::size_t i = 0; i < count; ++i) {
            const ScaledValue& value = values[lane[i]];
            ScaledValue& under = products[i];
            under.times(leading.fraction);
            for (Index k = 0; k < zeros; ++k) under.times(std::complex<double>(roots[lane[i]]));
            const double exponent = value.exponent - under.exponent - leading.exponent;
            const auto shift = static_cast<int>(std::clamp(exponent, -3000.0, 3000.0));
            const std::complex<double> ratio = value.fraction / under.fraction;
            result.step[lane[i]] = {std::ldexp(ratio.real(), shift),
                                    std::ldexp(ratio.imag(), shift)};
            result.blur[lane[i]] =
                (value.error + leading.error + under.error + sums) * (1 + 0x1p-32);
        }
    });
    return result;
}

/// Moves the roots in `meant` until they converge: Weierstrass's steps, each divided by 1 plus the
/// sum of w_j/(x_i - x_j) over the others (Börsch-Supan). This also separates close roots.
inline void refine(const SignedPencil<Wide<double>>& pencil, Index zeros,
                   std::vector<ComplexWord>& roots, const std::vector<bool>& meant,
                   const std::function<void(double)>& advance) {
    constexpr int sweeps = 60;
    std::vector<double> last(roots.size(), std::numeric_limits<double>::infinity());
    std::vector<ScaledValue> values(roots.size());
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < roots.size(); ++i)
        if (meant[i]) moving.push_back(i);
    for (int sweep = 0; sweep < sweeps && !moving.empty(); ++sweep) {
        evaluate(pencil, roots, moving, values, advance);
        const WeierstrassSteps w = steps(pencil, zeros, roots, moving, values, advance);
        std::vector<ComplexWord> next = roots;
        std::vector<std::size_t> left;
        for (const std::size_t i : moving) {
            std::complex<double> rate = 1;
            for (const std::size_t j : moving)
                if (j != i) rate += w.step[j] / std::complex<double>(roots[i] - roots[j]);
            const std::complex<double> step = w.step[i] / rate;
            const double share = std::abs(step) / size_of(roots[i]);
            if (!std::isfinite(share)) continue;
            next[i] = roots[i] - ComplexWord(step);
            // At the last digits the steps stop shrinking.
            if (!(share < 1e-29 || (share < 1e-20 && share > last[i] / 4))) left.push_back(i);
            last[i] = share;
        }
        roots = std::move(next), moving = std::move(left);
    }
}

/// Roots of the real polynomial: first the roots on the real axis, within the share `flat`, then
/// pairs. The result is empty unless as many roots lie above the axis as below.
struct Conjugates {
    std::vector<ComplexWord> roots;
    std::size_t real = 0;
};
inline std::optional<Conjugates> conjugates(const std::vector<ComplexWord>& roots, double flat) {
    Conjugates result;
    std::vector<ComplexWord> above;
    for (const ComplexWord& x : roots)
        if (std::abs(x.imag.high) <= flat * size_of(x))
            result.roots.push_back(x.real);
        else if (x.imag.high > 0)
            above.push_back(x);
    result.real = result.roots.size();
    if (result.real + 2 * above.size() != roots.size()) return std::nullopt;
    for (const ComplexWord& x : above)
        result.roots.push_back(x), result.roots.push_back({x.real, -x.imag});
    return result;
}

/// Computes discs that hold exactly one root each. All roots lie within d |w_j| of the x_j; d is
/// the degree and w_j are Weierstrass's steps. A disc that meets no other holds one root (Smith).
/// Then x_j - root = w_j prod (x_j - x_k)/(x_j - root_k) is w_j within |w_j| (exp(s) - 1). Here s
/// is the sum of r_k/(|x_j - x_k| - r_k). Returns marks of the discs that meet others; without any,
/// `found` is valid.
inline std::vector<bool> isolate_in_discs(const SignedPencil<Wide<double>>& pencil, Index zeros,
                                          Conjugates& at, std::vector<EnclosedRoot>& found,
                                          const std::function<void(double)>& advance) {
    using S = Wide<double>;
    constexpr double infinity = std::numeric_limits<double>::infinity(), slack = 1 + 0x1p-32;
    const std::size_t n = at.roots.size();
    std::vector<std::size_t> heads;  // the real roots, and one of each pair
    for (std::size_t i = 0; i < n; i += i < at.real ? 1 : 2) heads.push_back(i);
    std::vector<std::size_t> left = heads;
    std::vector<ScaledValue> values(n);
    // At the exact root, or where a pivot vanishes, there is no proof: points beside it are tried.
    for (const double aside : {0.0, 0x1p-64, 0x1p-56, 0x1p-48, 0x1p-40}) {
        for (const std::size_t i : left) {
            ComplexWord& x = at.roots[i];
            x = x + x * ComplexWord(S(aside));
            if (i >= at.real) at.roots[i + 1] = {x.real, -x.imag};
        }
        evaluate(pencil, at.roots, left, values, advance);
        std::erase_if(left, [&](std::size_t i) { return std::isfinite(values[i].error); });
        if (left.empty()) break;
    }
    WeierstrassSteps w = steps(pencil, zeros, at.roots, heads, values, advance);
    SplitWords split(at.roots);
    std::vector<bool> known(n);
    for (const std::size_t i : heads) {
        if (i < at.real) w.step[i] = w.step[i].real();
        const double size = std::abs(w.step[i]) * (1 + 2 * w.blur[i]);
        const double radius = static_cast<double>(n) * size * slack;
        known[i] = w.blur[i] < 0.25 && radius < infinity;
        if (known[i]) split.radius[i] = radius;
        if (i >= at.real) split.radius[i + 1] = split.radius[i];
    }
    std::vector<double> nearest(n), shares(n);
    for_lanes(heads, advance, [&](const std::size_t* lane, std::size_t count) {
        double near[value_lanes], sums[value_lanes];
        simd([&](auto where)
                 REVCHAIN_INLINED { distances_in_lanes(where, split, lane, near, sums); });
        for (std::size_t i = 0; i < count; ++i)
            nearest[lane[i]] = near[i], shares[lane[i]] = sums[i];
    });
    std::vector<bool> meets(n, false);
    bool apart = true;
    found.clear();
    for (const std::size_t i : heads) {
        const ComplexWord& x = at.roots[i];
        const double radius = split.radius[i], size = size_of(x);
        const bool far =
            nearest[i] > radius * slack && nearest[i] > 0x1p-46 * size && radius < size / 2;
        const bool alone = known[i] && far && shares[i] < 0.5 && size > 0x1p-900 && size < 0x1p900;
        apart = apart && alone;
        meets[i] = !alone;
        EnclosedRoot root{x - ComplexWord(w.step[i])};
        root.value = std::complex<double>(root.x);
        root.is_real = i < at.real;
        const double rounded = size_of(root.x - ComplexWord(root.value));
        const double spread = shares[i] * (1 + shares[i]);
        const double off = (spread + 2 * w.blur[i]) * (1 + spread) * std::abs(w.step[i]);
        root.radius = (off + rounded) * slack + 0x1p-98 * size;
        found.push_back(root);
        if (root.is_real) continue;
        meets[i + 1] = !alone;
        root.x.imag = -root.x.imag, root.value = std::conj(root.value);
        found.push_back(root);
    }
    if (apart) return {};
    for (EnclosedRoot& root : found) root.radius = infinity;
    return meets;
}

}  // namespace detail

/// Returns every x with det Q(x) = 0 except `zeros` that are certainly at 0. Precondition: at least
/// one element. Method: all roots at once in double (Ehrlich and Aberth, from the roots of two
/// halves), then one step in two words, with discs proved to hold one root each. Where discs meet,
/// roots are first refined in two words. A disc about a real approximation holds a real root,
/// because it would also hold the conjugate of a complex one. Cost, N elements (AVX-512): 0.15
/// microseconds N^2, with momentum 0.3. `advance(share)` is called after every sweep and may throw,
/// on any thread.
inline ComplexSpectrum complex_spectrum(const SignedPencil<Wide<double>>& pencil, Index zeros,
                                        const std::function<void(double)>& advance) {
    const Index degree = detail::leading_term(pencil).degree - zeros;
    ComplexSpectrum result;
    if (degree < 1) {
        result.proved = degree == 0;
        return result;
    }
    std::vector<ComplexWord> words;
    for (const auto& x : detail::first_roots(pencil, zeros, degree, advance)) words.emplace_back(x);
    constexpr double most_work = 4e6;  // a tenth of a second a sweep
    for (const double flat : {0x1p-40, 1e-22}) {
        std::vector<bool> meets(words.size(), true);
        if (auto there = detail::conjugates(words, flat)) {
            meets = detail::isolate_in_discs(pencil, zeros, *there, result.roots, advance);
            result.proved = meets.empty();
            if (result.proved) break;
            words = std::move(there->roots);
            // Two roots on the real axis may be a complex pair, and a pair may be two real roots.
            for (std::size_t i = 0; i < words.size(); ++i) {
                if (!meets[i]) continue;
                if (i < there->real)
                    words[i].imag = words[i].real * Wide<double>(i % 2 == 0 ? 0x1p-44 : -0x1p-44);
                else if (words[i].imag.high > 0)
                    words[i].real = words[i].real + words[i].imag * Wide<double>(0.25);
            }
        }
        const auto meeting = std::count(meets.begin(), meets.end(), true);
        const double work = static_cast<double>(meeting * pencil.size());
        if (flat < 0x1p-40 || work > most_work) break;
        detail::refine(pencil, zeros, words, meets, advance);
    }
    std::sort(result.roots.begin(), result.roots.end(),
              [](const EnclosedRoot& x, const EnclosedRoot& y) {
                  return std::pair(std::abs(x.value), x.value.imag()) >
                         std::pair(std::abs(y.value), y.value.imag());
              });
    return result;
}

}  // namespace revchain::pencil
