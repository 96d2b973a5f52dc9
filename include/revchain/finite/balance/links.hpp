// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/chain.hpp"
#include "revchain/numeric/double_double.hpp"
#include "revchain/numeric/interval.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A link of steady motion at any inclination, lowest first in a chain. For offsets y, tangent t
/// and sine s of the inclination, Greenhill (1908) §8 (6)-(12) reads
///     R = H_below + moment y_below,  lambda pull t + length cross s = R,
///     y = y_below - length s,        H = R + rest y.
/// H, the sum of weights times offsets of centroids, is lambda times the sideways pull at the upper
/// pin. R is the moment of these forces about that pin over the height of the vertical link.
template <class S>
struct Link {
    S length;  ///< a
    S pull;    ///< sigma = (W h + a S)/a, S the weight hung below; positive
    S cross;   ///< X = W (h (a - h)/a^2 - rho^2/a^2): 0 for a plummet, positive where 0 < l < a
    S moment;  ///< W h/a: the weight at the lower pin, or the moment W h over a
    S rest;    ///< W (a - h)/a: the weight at the upper pin
};

/// The sine of a hanging (standing) link is + (-) t/sqrt(1 + t^2), and its balance
///     lambda pull t +- length cross t/sqrt(1 + t^2) = R.
using revchain::Posture;

/// Links whose numbers are all enclosed by intervals.
template <class T>
using EnclosedLinks = std::vector<Link<Interval<T>>>;

/// The arithmetic in which shapes are computed: two doubles a number.
using Fine = Wide<double>;
/// The arithmetic of proofs that fail in double.
using Far = DoubleDouble;
using Span = Interval<Far>;

template <class S>
double as_double(const S& x) {
    return static_cast<double>(x);
}

/// The upper end of a chain: its topmost pin is on the axis, as known at compile time.
struct OnAxis {
    static constexpr bool is_symmetric() { return true; }
    static constexpr bool yields() { return false; }

    /// Distance of the topmost pin at offset y, with lambda times the pull `sum`, from its support.
    template <class F>
    const F& miss(const F& y, const F&) const {
        return y;
    }
    /// Puts the topmost pin, the last of `offset`, on its support if the position needs no load.
    template <class S>
    void place(std::vector<S>& offset) const {
        offset.back() = S(0);
    }
};

/// The links of a chain, in units of 2^length_exponent and 2^weight_exponent, and what a list of
/// shapes asks of them. `RiggedLinks` has the same functions for a rig.
template <class S>
struct Links {
    std::vector<Link<S>> links;
    ChainUnits units;
    double total_weight = 0;

    static OnAxis upper_end() { return {}; }
    /// The postures of links where all hang, or stand as in the rig.
    std::vector<Posture> postures() const {
        return std::vector<Posture>(links.size(), Posture::hangs);
    }
    /// Whether shapes with all links standing exist; without a spring nothing would bear the load.
    static bool may_all_stand() { return false; }
    /// Whether the tangent of link m falls as its load grows.
    static bool turned(std::size_t) { return false; }
    /// The links whose balance is swept, in intervals.
    template <class T>
    EnclosedLinks<T> links_for_sweep() const;
    /// The weight that hangs on each upper pin.
    std::vector<double> hung() const {
        std::vector<double> weights;
        double total = 0;
        for (const Link<S>& link : links)
            weights.push_back(total += as_double(link.moment + link.rest));
        return weights;
    }
    /// Adds the parts of the support to the numbers of a shape.
    template <class Shape, class Found>
    void add_support(Shape&, const S&, const Found&) const {}
};

/// Returns the links of a chain. For T = double each number has a relative error of 1e-28 unless W
/// h + a S cancels. Throws InvalidArgument if weights differ by a factor of more than 1e123.
template <Real T>
Links<Wide<T>> links_of(const Chain<T>& chain) {
    using std::ldexp;
    using S = Wide<T>;
    using E = Narrow<S>;
    detail::require_one_weight_unit("Chain", chain);
    Links<S> result;
    result.units = chain.units();
    result.total_weight = as_double(ldexp(chain.total_weight(), -result.units.weight_exponent));
    result.links.reserve(static_cast<std::size_t>(chain.size()));
    S below(T(0));
    for (Index m = 0; m < chain.size(); ++m) {
        if (m % detail::segment_size == 0) below = chain.weight_below(m);
        const revchain::Link<T> link = chain.link(m);
        const S weight(E(ldexp(link.weight, -result.units.weight_exponent)));
        const S hung = ldexp(below, -result.units.weight_exponent);
        const S a(E(ldexp(link.length, -result.units.length_exponent)));
        const S h(E(ldexp(link.centroid, -result.units.length_exponent)));
        const S p = h / a, q = (a - h) / a, moment = p * weight;
        result.links.push_back(
            {a, moment + hung, (p * q - link.gyration_ratio) * weight, moment, q * weight});
        below = below + S(link.weight);
    }
    return result;
}

template <class To, class From, class Convert>
std::vector<Link<To>> converted(const std::vector<Link<From>>& links, const Convert& to) {
    std::vector<Link<To>> result;
    result.reserve(links.size());
    for (const Link<From>& l : links)
        result.push_back({to(l.length), to(l.pull), to(l.cross), to(l.moment), to(l.rest)});
    return result;
}
template <class To, class From>
std::vector<Link<To>> rounded(const std::vector<Link<From>>& links) {
    return converted<To>(links, [](const From& x) { return static_cast<To>(x); });
}

/// Encloses in T a number whose last digits in S are uncertain. Returns a point if T is narrower
/// than S and holds the number exactly.
template <class T, class S>
Interval<T> enclosed(const S& x) {
    const T near = static_cast<T>(x);
    if (near == T(0)) return Interval<T>(near);
    if constexpr (std::numeric_limits<T>::digits < std::numeric_limits<S>::digits) {
        if (S(near) == x) return Interval<T>(near);
        return Interval<T>(detail::down(near), detail::up(near));
    } else {
        using std::abs;
        const T off = abs(near) * T(256) * T(operation_error<S>());
        return Interval<T>(detail::down(T(near - off)), detail::up(T(near + off)));
    }
}
template <class T, class S>
EnclosedLinks<T> enclosed(const std::vector<Link<S>>& links) {
    return converted<Interval<T>>(links, [](const S& x) { return enclosed<T>(x); });
}
template <class S>
template <class T>
EnclosedLinks<T> Links<S>::links_for_sweep() const {
    return enclosed<T>(links);
}

/// Returns true if a tangent's inclination has sine 1 and cosine 1/|tangent| to every digit.
template <class S>
bool is_horizontal(const S& tangent) {
    using std::abs;
    return abs(tangent) > S(1e100);
}

/// Returns the cosine of the inclination of a tangent, even if the square of the tangent overflows
/// (in a pack, the cosine is then 0).
template <class S>
[[gnu::always_inline]] inline S cosine_at(const S& tangent) {
    using std::abs;
    using std::sqrt;
    if constexpr (IsPack<S>)
        return S(1) / root(S(1) + tangent * tangent);
    else
        return S(1) /
               (is_horizontal(tangent) ? S(abs(tangent)) : S(sqrt(S(1) + tangent * tangent)));
}

}  // namespace revchain::finite
