// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <optional>

#include "revchain/pencil/complex/isolation.hpp"

/// All x with det Q(x) = 0, real or not, of a family whose numbers have any sign: what counts cannot number.
namespace revchain::inline REVCHAIN_BUILD::pencil {

/// An x, how far (in the plane) the exact one may be from it, and whether that is proved.
struct EnclosedRoot {
    ComplexWord x{};                                          ///< to some 30 digits where roots are apart
    std::complex<double> value{};                             ///< rounded
    double radius = std::numeric_limits<double>::infinity();  ///< about `value`; finite: an exact root lies within
    bool is_real = false;
};

/// Roots by size, largest first. `proved`: each disc holds exactly one root, all others of det Q are 0.
struct ComplexSpectrum {
    std::vector<EnclosedRoot> roots;
    bool proved = false;
};

namespace detail {

/// P'/P - zeros/x of P(x) = det Q(x): the sum of p'/p over the pivots.
inline ComplexWord log_derivative(const SignedPencil<Wide<double>>& pencil, const ComplexWord& x, Index zeros) {
    using S = Wide<double>;
    using V = ComplexWord;
    const V one = S(1.0), two_x = x + x;
    const Factors<V> f = pencil.factors(x), g = pencil.quadratic ? Factors<V>{two_x, one} : Factors<V>{one, S(0.0)};
    V below = S(0.0), slope_below = S(0.0), sum = S(0.0);
    for (const SignedElement<S>& e : pencil.elements) {
        const V L = e.stiffness_at(f), slope = e.stiffness_at(g);
        const V p = below + (L - V(e.lower)), q = (L + V(e.cross)) / p;
        const V p_slope = slope_below + slope;
        sum = sum + p_slope / p;
        below = (L - V(e.upper)) - (L + V(e.cross)) * q;
        slope_below = slope - (q + q) * slope + q * q * p_slope;
    }
    return zeros == 0 ? sum : sum - V(S(static_cast<double>(zeros))) / x;
}

/// Those roots that are `meant`, by Newton's method in two words with all others divided out, until they stand still.
inline void refine(const SignedPencil<Wide<double>>& pencil, Index zeros, std::vector<ComplexWord>& roots,
                   const std::vector<bool>& meant, const std::function<void(double)>& advance) {
    using S = Wide<double>;
    constexpr int sweeps = 60;
    std::vector<double> last(roots.size(), std::numeric_limits<double>::infinity());
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        bool moved = false;
        for (std::size_t i = 0; i < roots.size(); ++i) {
            if (!meant[i] || last[i] == 0) continue;
            ComplexWord rate = log_derivative(pencil, roots[i], zeros);
            for (std::size_t j = 0; j < roots.size(); ++j) {
                if (j == i) continue;
                const ComplexWord apart = roots[i] - roots[j];
                if (size_of(apart) > 0) rate = rate - ComplexWord(S(1.0)) / apart;
            }
            const ComplexWord step = ComplexWord(S(1.0)) / rate;
            const double share = size_of(step) / size_of(roots[i]);
            const bool finite = std::isfinite(share);
            if (finite) roots[i] = roots[i] - step;
            // At the last digits steps no longer shrink.
            const bool stands = !finite || share < 1e-29 || (share < 1e-20 && share > last[i] / 4);
            last[i] = stands ? 0 : share;
            moved = moved || !stands;
            advance(static_cast<double>(sweep) / sweeps);
        }
        if (!moved) break;
    }
}

/// Roots as the polynomial has them, which is real: those within a share `flat` of the real axis on it, first; then
/// pairs. Nothing where there are not as many above the axis as below.
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
    for (const ComplexWord& x : above) result.roots.push_back(x), result.roots.push_back({x.real, -x.imag});
    return result;
}

/// Discs that hold exactly one root each. With P of leading coefficient c and degree d and x_j the approximations, let
/// w_j = P(x_j)/(c prod (x_j - x_k)). All roots lie within d |w_j| of the x_j, and where such discs are apart each
/// holds one (Smith). Then x_j - root = w_j prod (x_j - x_k)/(x_j - root_k) is w_j within |w_j| (exp(s) - 1), s the sum
/// of r_k/(|x_j - x_k| - r_k). Returns which discs meet others; `found` has the roots if none does.
inline std::vector<bool> isolate(const SignedPencil<Wide<double>>& pencil, Index zeros, Conjugates& at,
                                 std::vector<EnclosedRoot>& found, const std::function<void(double)>& advance) {
    using S = Wide<double>;
    constexpr double infinity = std::numeric_limits<double>::infinity(), slack = 1 + 0x1p-32;
    const std::size_t n = at.roots.size(), heads = at.real + (n - at.real) / 2;
    const auto place = [&](std::size_t head) { return head < at.real ? head : at.real + 2 * (head - at.real); };
    const auto mirrored = [&](std::size_t head) {
        ComplexWord& x = at.roots[place(head)];
        if (head >= at.real) at.roots[place(head) + 1] = {x.real, -x.imag};
    };
    std::vector<ScaledValue> values(heads + value_lanes), products(heads + value_lanes);
    std::vector<double> nearest(heads + value_lanes), shares(heads + value_lanes);
    const auto lanes_of = [&](const std::vector<std::size_t>& which, const auto& f) {
        revchain::detail::parallel_for(which.size(), value_lanes, [&](std::size_t begin, std::size_t end) {
            for (std::size_t first = begin; first < end; first += value_lanes) {
                advance(0.6);
                std::size_t lane[value_lanes];
                for (std::size_t i = 0; i < value_lanes; ++i) lane[i] = which[std::min(first + i, end - 1)];
                f(lane, std::min(value_lanes, end - first));
            }
        });
    };
    std::vector<std::size_t> all(heads), left;
    for (std::size_t i = 0; i < heads; ++i) all[i] = i;
    left = all;
    // At the very root, or where a pivot vanishes, nothing is proved: then beside it.
    for (const double aside : {0.0, 0x1p-64, 0x1p-56, 0x1p-48, 0x1p-40}) {
        for (const std::size_t i : left) {
            ComplexWord& x = at.roots[place(i)];
            x = x + x * ComplexWord(S(aside)), mirrored(i);
        }
        lanes_of(left, [&](const std::size_t* lane, std::size_t count) {
            ComplexWord x[value_lanes];
            ScaledValue found_here[value_lanes];
            for (std::size_t i = 0; i < value_lanes; ++i) x[i] = at.roots[place(lane[i])];
            simd([&](auto where) REVCHAIN_INLINED { values_in_lanes(where, pencil, x, found_here); });
            for (std::size_t i = 0; i < count; ++i) values[lane[i]] = found_here[i];
        });
        std::erase_if(left, [&](std::size_t i) { return std::isfinite(values[i].error); });
        if (left.empty()) break;
    }
    SplitWords split(at.roots);
    const auto places = [&](const std::size_t* lane, std::size_t* of) {
        for (std::size_t i = 0; i < value_lanes; ++i) of[i] = place(lane[i]);
    };
    lanes_of(all, [&](const std::size_t* lane, std::size_t count) {
        std::size_t of[value_lanes];
        ScaledValue found_here[value_lanes];
        places(lane, of);
        simd([&](auto where) REVCHAIN_INLINED { products_in_lanes(where, split, of, found_here); });
        for (std::size_t i = 0; i < count; ++i) products[lane[i]] = found_here[i];
    });
    const ScaledValue leading = leading_term(pencil).coefficient;
    std::vector<std::complex<double>> step(heads);
    std::vector<double> blur(heads);
    std::vector<bool> known(heads);
    for (std::size_t i = 0; i < heads; ++i) {
        ScaledValue under = products[i];
        under.times(leading.fraction);
        const std::complex<double> x(at.roots[place(i)]);
        for (Index k = 0; k < zeros; ++k) under.times(x);
        const double exponent = values[i].exponent - under.exponent - leading.exponent;
        const auto shift = static_cast<int>(std::clamp(exponent, -3000.0, 3000.0));
        const std::complex<double> ratio = values[i].fraction / under.fraction;
        step[i] = {std::ldexp(ratio.real(), shift), i < at.real ? 0.0 : std::ldexp(ratio.imag(), shift)};
        blur[i] =
            (values[i].error + leading.error + under.error + static_cast<double>(16 * n + 64) * epsilon<double>()) *
            slack;
        const double radius = static_cast<double>(n) * std::abs(step[i]) * (1 + 2 * blur[i]) * slack;
        known[i] = blur[i] < 0.25 && radius < infinity;
        if (known[i]) split.radius[place(i)] = radius;
        if (i >= at.real) split.radius[place(i) + 1] = split.radius[place(i)];
    }
    lanes_of(all, [&](const std::size_t* lane, std::size_t count) {
        std::size_t of[value_lanes];
        double near[value_lanes], sums[value_lanes];
        places(lane, of);
        simd([&](auto where) REVCHAIN_INLINED { distances_in_lanes(where, split, of, near, sums); });
        for (std::size_t i = 0; i < count; ++i) nearest[lane[i]] = near[i], shares[lane[i]] = sums[i];
    });
    std::vector<bool> meets(n, false);
    bool apart = true;
    found.clear();
    for (std::size_t i = 0; i < heads; ++i) {
        const ComplexWord& x = at.roots[place(i)];
        const double radius = split.radius[place(i)], size = size_of(x);
        const bool alone = known[i] && nearest[i] > radius * slack && nearest[i] > 0x1p-46 * size &&
                           radius < size / 2 && shares[i] < 0.5 && size > 0x1p-900 && size < 0x1p900;
        apart = apart && alone;
        meets[place(i)] = !alone;
        if (i >= at.real) meets[place(i) + 1] = !alone;
        EnclosedRoot root{x - ComplexWord(step[i])};
        root.value = std::complex<double>(root.x);
        root.is_real = i < at.real;
        const double rounded = size_of(root.x - ComplexWord(root.value)), spread = shares[i] * (1 + shares[i]);
        root.radius = ((spread + 2 * blur[i]) * (1 + spread) * std::abs(step[i]) + rounded) * slack + 0x1p-98 * size;
        found.push_back(root);
        if (root.is_real) continue;
        root.x.imag = -root.x.imag, root.value = std::conj(root.value);
        found.push_back(root);
    }
    if (apart) return {};
    for (EnclosedRoot& root : found) root.radius = infinity;
    return meets;
}

}  // namespace detail

/// Every x with det Q(x) = 0, but for `zeros` that are surely at 0. Preconditions: at least one element.
///
/// Method: all roots at once in double (Ehrlich and Aberth, from the roots of either half of the chain), then one step
/// in two words, with discs that are proved to hold one root each. Where discs meet, roots are first refined in two
/// words. A disc about a real approximation holds a real root, since the conjugate of another would be in it, too.
/// Cost, N elements (AVX-512): 0.15 microseconds N^2, with momentum 0.3. `advance(share)` is called after every sweep
/// and may throw, on any thread.
inline ComplexSpectrum complex_spectrum(const SignedPencil<Wide<double>>& pencil, Index zeros,
                                        const std::function<void(double)>& advance) {
    const Index degree = detail::leading_term(pencil).degree - zeros;
    ComplexSpectrum result;
    if (degree < 1) {
        result.proved = degree == 0;
        return result;
    }
    std::vector<ComplexWord> words;
    for (const std::complex<double>& x : detail::first_roots(pencil, zeros, degree, advance)) words.emplace_back(x);
    constexpr double most_work = 4e6;  // 4 seconds a sweep
    for (const double flat : {0x1p-40, 1e-22}) {
        std::vector<bool> meets(words.size(), true);
        if (auto there = detail::conjugates(words, flat)) {
            meets = detail::isolate(pencil, zeros, *there, result.roots, advance);
            result.proved = meets.empty();
            if (result.proved) break;
            words = std::move(there->roots);
            for (std::size_t i = 0; i < there->real; ++i)  // two that meet on the real axis may belong beside it
                if (meets[i]) words[i].imag = words[i].real * Wide<double>(i % 2 == 0 ? 0x1p-44 : -0x1p-44);
        }
        const double work = static_cast<double>(std::count(meets.begin(), meets.end(), true) * pencil.size());
        if (flat < 0x1p-40 || work > most_work) break;
        detail::refine(pencil, zeros, words, meets, [&](double share) { advance(0.6 + 0.4 * share); });
    }
    std::sort(result.roots.begin(), result.roots.end(), [](const EnclosedRoot& x, const EnclosedRoot& y) {
        return std::pair(std::abs(x.value), x.value.imag()) > std::pair(std::abs(y.value), y.value.imag());
    });
    return result;
}

}  // namespace revchain::pencil
