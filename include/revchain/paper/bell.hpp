// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>

#include "revchain/bell.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// The zeros of G(r) = h1 r^2 - [(m + 1) l1 - m l2 - a2] r - (m + 1) a2 are the ratios of
/// inclinations of the modes. G is §8 (14) with lambda = l1 + a2/r, from the moment of the clapper
/// about its pin. With f the ratio of the weights, a2 (m + 1) = f h2 + a2 and a2 m l2 = f (h2^2 +
/// rho2^2). Lengths are in the chain's unit.
template <Real T>
struct BellNumbers {
    using S = Wide<T>;
    Link<T> clapper, bell;
    T pin;                              ///< from the axle down to the clapper's pin
    int exponent;                       ///< the chain's unit of length is 2^exponent
    S h1, square1, a2, h2, square2, f;  ///< squares of radii of gyration
    S l1, moment, turning;              ///< moment = (m + 1) a2, turning = a2 m l2

    BellNumbers(std::string_view place, const Chain<T>& chain, const std::optional<T>& joint) {
        using std::ldexp;
        if (chain.size() != 2)
            throw_invalid(place, "the chain must have two links, clapper and bell", chain.size());
        clapper = chain.link(0), bell = chain.link(1), exponent = chain.units().length_exponent;
        require_positive(place, "the bell's weight", bell.weight);
        const auto scaled = [&](const T& x) { return S(x * ldexp(T(1), -exponent)); };
        const auto square = [&](const Link<T>& link) {
            return link.gyration_ratio * (scaled(link.length) * scaled(link.length));
        };
        h1 = scaled(clapper.centroid), square1 = square(clapper);
        if (joint) require_finite(place, "joint", *joint);
        pin = joint.value_or(bell.length), a2 = scaled(pin), h2 = scaled(bell.centroid),
        square2 = square(bell);
        const int weight = -chain.units().weight_exponent;
        f = S(ldexp(bell.weight, weight)) / S(ldexp(clapper.weight, weight));
        l1 = h1 + square1 / h1, moment = f * h2 + a2, turning = f * (h2 * h2 + square2);
    }
    T length(const S& x) const {
        using std::ldexp;
        return ldexp(static_cast<T>(x), exponent);
    }
    ByBellDatum<T> data() const {
        return {
            clapper.weight, clapper.centroid,        radius_of_gyration(clapper), bell.weight, pin,
            bell.centroid,  radius_of_gyration(bell)};
    }
};

/// The modes of a clapper whose pin is in the axle: each swings alone. Their order and ratios are
/// the limits of a small positive joint.
template <Real T>
BellAndClapper<T> apart(const BellNumbers<T>& n) {
    using S = Wide<T>;
    const T none = std::numeric_limits<T>::quiet_NaN(),
            infinite = std::numeric_limits<T>::infinity();
    const S l2 = n.h2 + n.square2 / n.h2;
    const bool clapper_first = n.l1 > l2;
    BellAndClapper<T> result;
    result.conical_height = {n.length(clapper_first ? n.l1 : l2),
                             n.length(clapper_first ? l2 : n.l1)};
    result.inclination_ratio = {clapper_first ? infinite : T(0), clapper_first ? T(0) : -infinite};
    result.silent_height = n.length(n.l1), result.mismatch = none;
    result.present = n.data();
    result.derivative.fill(none);
    return result;
}

/// Returns the root of a x^2 + b x + c = 0 nearest to x0 among those for which `may` is true, or
/// NaN.
template <class S, class May>
S nearest_root(const S& a, const S& b, const S& c, const S& x0, const May& may) {
    using std::abs, std::sqrt;
    using M = Narrow<S>;
    S best(std::numeric_limits<M>::quiet_NaN());
    const auto offer = [&](const S& x) {
        if (!(abs(static_cast<M>(x)) <= std::numeric_limits<M>::max()) || !may(x)) return;
        if (!(abs(x - x0) >= abs(best - x0))) best = x;
    };
    if (a == S(M(0))) {
        offer(-c / b);
        return best;
    }
    const S half = b / S(M(-2)), square = half * half - a * c;
    if (square < S(M(0))) return best;
    const S root = sqrt(square), sum = half < S(M(0)) ? half - root : half + root;
    offer(sum / a);
    if (!(sum == S(M(0)))) offer(c / sum);
    return best;
}

}  // namespace detail

template <Real T>
BellAndClapper<T> bell_and_clapper(const Chain<T>& chain,
                                   const std::optional<std::type_identity_t<T>>& joint) {
    using std::ldexp, std::sqrt;
    using S = Wide<T>;
    const detail::BellNumbers<T> n("bell_and_clapper", chain, joint);
    if (n.pin == T(0)) return detail::apart(n);
    const S two(T(2)), one(T(1)), slope = n.moment / n.a2 * n.l1 - n.turning / n.a2 - n.a2;
    const S root = sqrt(slope * slope + S(T(4)) * n.h1 * n.moment);
    const bool rising = !(slope < S(T(0)));
    const S far = (rising ? slope + root : slope - root) / (two * n.h1),
            near = -n.moment / (n.h1 * far);
    const S r = rising ? far : near, other = rising ? near : far;

    BellAndClapper<T> result;
    result.conical_height = {n.length(n.l1 + n.a2 / r), n.length(n.l1 + n.a2 / other)};
    result.inclination_ratio = {static_cast<T>(r), static_cast<T>(other)};
    result.silent_height = n.length(n.l1 + n.a2);
    result.mismatch = n.length(n.h1 - slope - n.moment);
    result.present = n.data();
    // dr/dx = -(dG/dx)/(dG/dr)
    const S m1 = n.moment / n.a2, lean = n.l1 / n.a2 * r + one, radius1 = sqrt(n.square1),
            radius2 = sqrt(n.square2);
    const S by_weights = n.turning * r / n.a2 - n.f * n.h2 * lean;  // f dG/df
    const S by_joint = (n.f * n.h2 * n.l1 - n.turning) / (n.a2 * n.a2) * r + r - one;
    const auto weight = [&](const S& x, const T& w) { return static_cast<T>(-x / root) / w; };
    const auto per_length = [&](const S& x) {
        return ldexp(static_cast<T>(-x / root), -n.exponent);
    };
    result.derivative = {weight(-by_weights, n.clapper.weight),
                         per_length(r * r - m1 * (one - n.square1 / (n.h1 * n.h1)) * r),
                         per_length(-m1 * two * radius1 / n.h1 * r),
                         weight(by_weights, n.bell.weight),
                         per_length(by_joint),
                         per_length(n.f * (two * n.h2 * r / n.a2 - lean)),
                         per_length(n.f * two * radius2 * r / n.a2)};
    return result;
}

template <Real T>
ByBellDatum<T> bell_and_clapper_with_ratio(const Chain<T>& chain, const T& ratio,
                                           const std::optional<std::type_identity_t<T>>& joint) {
    using std::sqrt;
    using S = Wide<T>;
    constexpr std::string_view place = "bell_and_clapper_with_ratio";
    detail::require_positive(place, "ratio", ratio);
    const detail::BellNumbers<T> n(place, chain, joint);
    if (n.pin == T(0))
        detail::throw_invalid(place, "clapper and bell do not move each other with the joint",
                              n.pin);
    const S zero(T(0)), one(T(1)), r(ratio), m1 = n.moment / n.a2, bend = n.turning / n.a2 + n.a2;
    const T none = std::numeric_limits<T>::quiet_NaN();
    const auto radius = [&](const S& square) {
        return square < zero ? none : n.length(sqrt(square));
    };
    // G = fixed + f by_weight
    const S fixed = n.h1 * r * r - n.l1 * r + n.a2 * (r - one), lean = n.l1 / n.a2 * r + one;
    const S by_weight = (n.h2 * n.h2 + n.square2) * r / n.a2 - n.h2 * lean;
    const S f = -fixed / by_weight;
    const T change = f > zero && f * n.h2 + n.a2 > zero ? static_cast<T>(f / n.f) : none;
    return {n.clapper.weight / change,
            n.length(detail::nearest_root(S(r * r - m1 * r), S(bend * r - n.moment),
                                          S(-m1 * r * n.square1), n.h1,
                                          [&](const S& x) { return x > zero; })),
            radius(n.h1 * (n.h1 * r * r + bend * r - n.moment) / (m1 * r) - n.h1 * n.h1),
            n.bell.weight * change,
            n.length(detail::nearest_root(
                S(r - one), S(n.h1 * r * r - n.l1 * r - n.f * n.h2),
                S(r * (n.turning - n.f * n.h2 * n.l1)), n.a2,
                [&](const S& a) { return a * n.a2 > zero && n.f * n.h2 + a > zero; })),
            n.length(detail::nearest_root(S(n.f * r / n.a2), S(-n.f * lean),
                                          S(n.f * n.square2 * r / n.a2 + fixed), n.h2,
                                          [&](const S& h) { return n.f * h + n.a2 > zero; })),
            radius((n.h2 * lean - fixed / n.f) * n.a2 / r - n.h2 * n.h2)};
}

}  // namespace revchain
