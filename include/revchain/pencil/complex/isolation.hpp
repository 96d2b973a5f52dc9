// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/numeric/interval.hpp"
#include "revchain/pencil/complex/roots_in_lanes.hpp"
#include "revchain/pencil/complex/word.hpp"

/// This header computes values of det Q with error bounds, and distances between approximate roots,
/// to prove all roots.
namespace revchain::inline REVCHAIN_BUILD::pencil {

namespace detail {

inline constexpr std::size_t value_lanes = most_doubles;

/// A complex number times 2^exponent with a relative error, which is infinite if it is unknown.
struct ScaledValue {
    std::complex<double> fraction{1.0};
    double exponent = 0, error = 0;

    void times(const std::complex<double>& x) {
        fraction = {fraction.real() * x.real() - fraction.imag() * x.imag(),
                    fraction.real() * x.imag() + fraction.imag() * x.real()};
        int shift = 0;
        std::frexp(std::max(std::abs(fraction.real()), std::abs(fraction.imag())), &shift);
        fraction = {std::ldexp(fraction.real(), -shift), std::ldexp(fraction.imag(), -shift)};
        exponent += shift, error += 4 * epsilon<double>();
    }
};

/// A product of complex numbers in each lane. Its error, 4 ulp a factor, is not tracked.
template <class V>
struct ProductInLanes {
    ComplexLanes<V> fraction{V(1.0), V(0.0)};
    typename V::Mask scale{};

    [[gnu::always_inline]] void times(const ComplexLanes<V>& x) {
        fraction = fraction * x;
        const V size = min(max(max(abs(fraction.re), abs(fraction.im)), V(0x1p-1000)), V(0x1p1000));
        scale += exponent(size);
        const V power = inverse_power(size);
        fraction = fraction * power;
    }
    [[gnu::always_inline]] void store(ScaledValue* to) const {
        for (std::size_t i = 0; i < V::size; ++i)
            to[i].fraction = {fraction.re[i], fraction.im[i]},
            to[i].exponent = static_cast<double>(scale[i]);
    }
};

/// Computes det Q at the x in each lane, with the running bound of `certified_count`. By the mean
/// value inequality it holds in the complex plane, too. A complex operation has at most 16
/// roundings.
template <class Where>
[[gnu::always_inline]] inline void values_in_lanes(Where, const SignedPencil<Wide<double>>& pencil,
                                                   const ComplexWord* at, ScaledValue* values) {
    constexpr std::size_t width = std::min(Where::doubles, value_lanes);
    using V = Pack<double, width, value_lanes / width>;
    using W = DoubleWord<V>;
    using Z = ComplexLanes<W>;
    alignas(64) double part[4][value_lanes];
    for (std::size_t i = 0; i < value_lanes; ++i) {
        part[0][i] = at[i].real.high, part[1][i] = at[i].real.low;
        part[2][i] = at[i].imag.high, part[3][i] = at[i].imag.low;
    }
    const Z x{W(V::load(part[0]), V::load(part[1])), W(V::load(part[2]), V::load(part[3]))};
    const Z square = x * x;
    const auto number = [](const Wide<double>& word)
                            REVCHAIN_INLINED { return revchain::detail::in_all_lanes<V>(word); };
    constexpr double eps = std::numeric_limits<double>::epsilon();
    const double u = 16 * operation_error<Wide<double>>();
    const V slack(1 + 8 * eps), inflate(1 + 64 * eps), one(1.0), tiny(2 * least_pivot<double>());
    const V unit4(4 * u), unit8(8 * u), unit3(3 * u),
        underflow(256 * std::numeric_limits<double>::denorm_min());
    const auto size_of = [&](const Z& z) REVCHAIN_INLINED {
        return root(z.re.high * z.re.high + z.im.high * z.im.high) * slack + V(0x1p-500);
    };
    const V a = pencil.quadratic ? size_of(square) : size_of(x),
            b = pencil.quadratic ? size_of(x) : V(0.0);
    Z below{};
    V error{}, share{}, unproved{};
    ProductInLanes<V> product;
    for (const SignedElement<Wide<double>>& e : pencil.elements) {
        const ElementError<double>& off = e.error;
        const double lower = std::abs(e.lower.high), upper = std::abs(e.upper.high),
                     cross = std::abs(e.cross.high);
        const Wide<double> weight = e.weight, determinant = e.turning;
        Z L = x * number(e.stiffness);
        if (pencil.quadratic) L = square * number(e.stiffness) + x * number(e.spin);
        const V L_size = (a * V(std::abs(e.stiffness.high)) + b * V(std::abs(e.spin.high))) * slack;
        const V L_error = a * V(off.stiffness) + b * V(off.spin) + unit4 * L_size + underflow;
        const Z p = below + (L + -number(e.lower));
        const V D_size = size_of(below), p_rounding = unit3 * (D_size + L_size + V(lower));
        const V wrong = inflate * (error + L_error + V(off.lower) + p_rounding);
        const V least =
            root(p.re.high * p.re.high + p.im.high * p.im.high) * V(1 - 8 * eps) - wrong;
        unproved = select(least > tiny, unproved, one);
        const V inverse_least = (one / least) * slack;
        share += wrong * inverse_least + V(8 * eps);
        product.times({p.re.high, p.im.high});

        const V q = (size_of(L + number(e.cross)) + L_error + V(off.cross)) * inverse_least;
        const V r = (D_size + error + V(lower + off.lower + cross + off.cross)) * inverse_least;
        const V slopes =
            q * q * (error + V(off.lower)) + r * r * L_error + V(off.upper) + V(2 * off.cross) * q;
        below = ((L + -number(e.upper)) * below - (L * number(weight) + -number(determinant))) *
                inverse(p);
        const V next_size = size_of(below);
        const V roundings =
            unit8 *
                ((L_size + V(upper)) * D_size + L_size * V(lower + upper + 2 * cross) +
                 V(lower * upper + cross * cross)) *
                inverse_least +
            next_size * (p_rounding * inverse_least + unit4);
        const V lost = underflow * (one + L_size + V(upper + lower + upper + 2 * cross) + D_size) *
                       (one + inverse_least);
        error = inflate * (slopes + roundings + lost);
    }
    product.store(values);
    for (std::size_t i = 0; i < value_lanes; ++i)
        values[i].error = unproved[i] == 0 && share[i] < 0.5
                              ? share[i] * (1 + share[i])
                              : std::numeric_limits<double>::infinity();
}

/// All approximations, with separate parts for loads into lanes, and the radii of their discs.
struct SplitWords {
    std::vector<double> re, im, re_low, im_low, radius;
    explicit SplitWords(const std::vector<ComplexWord>& x) : radius(x.size()) {
        for (const ComplexWord& each : x) {
            re.push_back(each.real.high), re_low.push_back(each.real.low);
            im.push_back(each.imag.high), im_low.push_back(each.imag.low);
        }
    }
    std::size_t size() const { return re.size(); }
};

/// Calls f(x - x_j, j, is x number j) for every j; x in each lane is number `lane[i]`.
template <class V, class F>
[[gnu::always_inline]] inline void for_differences(const SplitWords& all, const std::size_t* lane,
                                                   const F& f) {
    constexpr std::size_t L = V::size;
    alignas(64) double part[5][L];
    for (std::size_t i = 0; i < L; ++i) {
        part[0][i] = all.re[lane[i]], part[1][i] = all.re_low[lane[i]];
        part[2][i] = all.im[lane[i]], part[3][i] = all.im_low[lane[i]];
        part[4][i] = static_cast<double>(lane[i]);
    }
    const V re = V::load(part[0]), re_low = V::load(part[1]), im = V::load(part[2]),
            im_low = V::load(part[3]);
    const V own = V::load(part[4]);
    for (std::size_t j = 0; j < all.size(); ++j) {
        const ComplexLanes<V> apart{(re - V(all.re[j])) + (re_low - V(all.re_low[j])),
                                    (im - V(all.im[j])) + (im_low - V(all.im_low[j]))};
        f(apart, j, equal(own, V(static_cast<double>(j))));
    }
}

/// Computes in each lane prod (x - x_j) over all others; a factor has 4 ulp if high parts differ.
template <class Where>
[[gnu::always_inline]] inline void products_in_lanes(Where, const SplitWords& all,
                                                     const std::size_t* lane,
                                                     ScaledValue* products) {
    constexpr std::size_t width = std::min(Where::doubles, value_lanes);
    using V = Pack<double, width, value_lanes / width>;
    ProductInLanes<V> product;
    const auto take = [&](const ComplexLanes<V>& apart, std::size_t,
                          const typename V::Mask& own) REVCHAIN_INLINED {
        product.times({select(own, V(1.0), apart.re), select(own, V(0.0), apart.im)});
    };
    for_differences<V>(all, lane, take);
    product.store(products);
}

/// Computes in each lane, over all others, the least d = |x - x_j| - r_j, and the sum of r_j/d.
template <class Where>
[[gnu::always_inline]] inline void distances_in_lanes(Where, const SplitWords& all,
                                                      const std::size_t* lane, double* nearest,
                                                      double* shares) {
    constexpr std::size_t width = std::min(Where::doubles, value_lanes);
    using V = Pack<double, width, value_lanes / width>;
    V least(std::numeric_limits<double>::infinity()), sum{};
    for_differences<V>(all, lane,
                       [&](const ComplexLanes<V>& apart, std::size_t j, const typename V::Mask& own)
                           REVCHAIN_INLINED {
                               const V far = root(apart.re * apart.re + apart.im * apart.im);
                               const V radius(all.radius[j]), room = far * V(1 - 0x1p-48) - radius;
                               least = select(own, least, min(room, least));
                               sum += select(own, V(0.0), radius / room);
                           });
    least.store(nearest), sum.store(shares);
}

/// The degree and leading coefficient of det Q; the error is infinite if the degree may be less.
/// Elements that stiffen with x tie their pins together. The others have the masses between.
struct LeadingTerm {
    Index degree = 0;
    ScaledValue coefficient;
};
inline LeadingTerm leading_term(const SignedPencil<Wide<double>>& pencil) {
    using I = Interval<Wide<double>>;
    LeadingTerm leading;
    const auto factor = [&](Index degree, const Wide<double>& x, double off) {
        const double size = std::abs(x.high) * (1 - epsilon<double>()) - off;
        leading.coefficient.times(x.high);
        leading.coefficient.error +=
            size > 0 ? off / size + epsilon<double>() : std::numeric_limits<double>::infinity();
        leading.degree += degree;
    };
    using revchain::detail::around;
    I below;  // the dynamic stiffness of everything below, with all else rigid
    for (const auto& e : pencil.elements) {
        const auto& off = e.error;
        const I lower = around(e.lower, off.lower), upper = around(e.upper, off.upper);
        const I cross = around(e.cross, off.cross);
        if (!vanishes(e.stiffness, off.stiffness)) {
            factor(pencil.quadratic ? 2 : 1, e.stiffness, off.stiffness);
        } else if (pencil.quadratic && !vanishes(e.spin, off.spin)) {
            factor(1, e.spin, off.spin);
        } else {
            const I p = below - lower;
            factor(0, p.middle(), p.width().high);
            below = -upper - cross * cross / p;
            continue;
        }
        below = below - (lower + cross + cross + upper);
    }
    return leading;
}

}  // namespace detail
}  // namespace revchain::pencil
