// SPDX-License-Identifier: MPL-2.0
// Defines what bell.hpp declares.
#pragma once

#include <limits>

#include "revchain/bell.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// The zeros of G(r) = h1 r^2 - [(m + 1) l1 - m l2 - a2] r - (m + 1) a2 are the ratios of
/// inclinations of the modes. G is §8 (14) with lambda = l1 + a2/r, from the moment of the clapper
/// about its pin. With f the ratio of the weights, a2 (m + 1) = f h2 + a2 and a2 m l2 = f (h2^2 +
/// rho2^2). An inverted body changes the sign of its moment: lambda is clapper_sign l1 +
/// bell_sign a2/r, and G has `sign`, the product of both, before a2 r - (m + 1) a2 + m l2 r.
/// Lengths are in the chain's unit.
template <Real T>
struct BellNumbers {
    using S = Wide<T>;
    Link<T> clapper, bell;
    T pin;         ///< from the axle down to the clapper's pin
    int exponent;  ///< the chain's unit of length is 2^exponent
    std::array<bool, 2> inverted;
    S clapper_sign, bell_sign, sign;    ///< -1 if inverted; their product
    S h1, square1, a2, h2, square2, f;  ///< squares of radii of gyration
    S l1, moment, turning;              ///< moment = (m + 1) a2, turning = a2 m l2

    BellNumbers(std::string_view place, const Chain<T>& chain, const std::optional<T>& joint,
                const std::array<bool, 2>& stand)
        : inverted(stand),
          clapper_sign(T(stand[0] ? -1 : 1)),
          bell_sign(T(stand[1] ? -1 : 1)),
          sign(clapper_sign * bell_sign) {
        using std::ldexp;
        if (chain.size() != 2)
            throw_invalid(place, "the chain must have two links, clapper and bell", chain.size());
        clapper = chain.link(0), bell = chain.link(1), exponent = chain.units().length_exponent;
        require_positive(place, "the bell's weight", bell.weight);
        const auto scaled = [&](const T& x) { return S(x * ldexp(T(1), -exponent)); };
        if (joint && *joint != T(0)) {  // its square and that of its inverse must be numbers
            using std::abs;
            constexpr int most = std::numeric_limits<T>::max_exponent / 3;
            const T far = abs(*joint * ldexp(T(1), -exponent));
            if (!(far >= ldexp(T(1), -most) && far <= ldexp(T(1), most)))
                throw_invalid(place,
                              "joint must be 0, or not more than 2^" + std::to_string(most) +
                                  " times longer or shorter than the bodies",
                              *joint);
        }
        const auto square = [&](const Link<T>& link) {
            return link.gyration_ratio * (scaled(link.length) * scaled(link.length));
        };
        h1 = scaled(clapper.centroid), square1 = square(clapper);
        pin = joint.value_or(bell.length), a2 = scaled(pin), h2 = scaled(bell.centroid),
        square2 = square(bell);
        const int weight = -chain.units().weight_exponent;
        f = S(ldexp(bell.weight, weight)) / S(ldexp(clapper.weight, weight));
        l1 = h1 + square1 / h1, moment = f * h2 + a2, turning = f * (h2 * h2 + square2);
    }
    S height(const S& r) const { return clapper_sign * l1 + bell_sign * (a2 / r); }
    /// Whether one mode swings and the other falls.
    bool half_stands() const { return sign * moment < S(T(0)); }
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
    const S l2 = n.bell_sign * (n.h2 + n.square2 / n.h2), l1 = n.clapper_sign * n.l1;
    const bool clapper_first = l1 > l2;
    BellAndClapper<T> result;
    result.conical_height = {n.length(clapper_first ? l1 : l2), n.length(clapper_first ? l2 : l1)};
    result.inclination_ratio = {clapper_first ? infinite : T(0), clapper_first ? T(0) : -infinite};
    result.silent_height = n.length(l1), result.mismatch = none;
    result.present = n.data(), result.inverted = n.inverted;
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
                                   const std::optional<std::type_identity_t<T>>& joint,
                                   const std::array<bool, 2>& inverted) {
    using std::ldexp, std::sqrt;
    using S = Wide<T>;
    const detail::BellNumbers<T> n("bell_and_clapper", chain, joint, inverted);
    if (n.pin == T(0)) return detail::apart(n);
    const S two(T(2)), one(T(1)), zero(T(0)), bend = n.turning / n.a2 + n.a2;
    const S slope = n.moment / n.a2 * n.l1 - n.sign * bend, last = n.sign * n.moment;
    const S square = slope * slope + S(T(4)) * n.h1 * last;
    const S root = square > zero ? sqrt(square) : zero;
    const bool rising = !(slope < zero);
    const S far = (rising ? slope + root : slope - root) / (two * n.h1),
            near = -last / (n.h1 * far);
    // the positive one; if the other body stands, the one that swings
    const bool far_first = n.half_stands() ? n.height(far) > zero : rising;
    const S r = far_first ? far : near, other = far_first ? near : far;
    const S steep = far_first == rising ? root : -root;  // dG/dr

    BellAndClapper<T> result;
    result.conical_height = {n.length(n.height(r)), n.length(n.height(other))};
    result.inclination_ratio = {static_cast<T>(r), static_cast<T>(other)};
    result.silent_height = n.length(n.height(one));
    result.mismatch = n.length(n.h1 - slope - last);
    result.present = n.data(), result.inverted = n.inverted;
    // dr/dx = -(dG/dx)/(dG/dr)
    const S m1 = n.moment / n.a2, lean = n.l1 / n.a2 * r + n.sign, radius1 = sqrt(n.square1),
            radius2 = sqrt(n.square2);
    const S by_weights = n.sign * n.turning * r / n.a2 - n.f * n.h2 * lean;  // f dG/df
    const S by_joint =
        (n.f * n.h2 * n.l1 - n.sign * n.turning) / (n.a2 * n.a2) * r + n.sign * (r - one);
    const auto weight = [&](const S& x, const T& w) { return static_cast<T>(-x / steep) / w; };
    const auto per_length = [&](const S& x) {
        return ldexp(static_cast<T>(-x / steep), -n.exponent);
    };
    result.derivative = {weight(-by_weights, n.clapper.weight),
                         per_length(r * r - m1 * (one - n.square1 / (n.h1 * n.h1)) * r),
                         per_length(-m1 * two * radius1 / n.h1 * r),
                         weight(by_weights, n.bell.weight),
                         per_length(by_joint),
                         per_length(n.f * (n.sign * two * n.h2 * r / n.a2 - lean)),
                         per_length(n.sign * n.f * two * radius2 * r / n.a2)};
    return result;
}

template <Real T>
ByBellDatum<T> bell_and_clapper_with_ratio(const Chain<T>& chain, const T& ratio,
                                           const std::optional<std::type_identity_t<T>>& joint,
                                           const std::array<bool, 2>& inverted) {
    using std::sqrt;
    using S = Wide<T>;
    constexpr std::string_view place = "bell_and_clapper_with_ratio";
    detail::require_positive(place, "ratio", ratio);
    const detail::BellNumbers<T> n(place, chain, joint, inverted);
    if (n.pin == T(0))
        detail::throw_invalid(place, "clapper and bell do not move each other with the joint",
                              n.pin);
    const S zero(T(0)), one(T(1)), r(ratio), s = n.sign, m1 = n.moment / n.a2,
                                             bend = n.turning / n.a2 + n.a2;
    const T none = std::numeric_limits<T>::quiet_NaN();
    const auto radius = [&](const S& square) {
        return square < zero ? none : n.length(sqrt(square));
    };
    // The first mode has the ratio: the position of rest stays of its kind, and if one of the
    // bodies stands, it is the mode that swings.
    const auto keeps = [&](const S& moment, const S& l1, const S& a2) {
        return moment * n.moment > zero &&
               (!n.half_stands() || n.clapper_sign * l1 + n.bell_sign * (a2 / r) > zero);
    };
    const auto with_l1 = [&](const S& l1, const T& value) {
        return keeps(n.moment, l1, n.a2) ? value : none;
    };
    // G = fixed + f by_weight
    const S fixed = n.h1 * r * r - n.l1 * r + s * n.a2 * (r - one), lean = n.l1 / n.a2 * r + s;
    const S by_weight = s * (n.h2 * n.h2 + n.square2) * r / n.a2 - n.h2 * lean;
    const S f = -fixed / by_weight;
    const bool may = f > zero && keeps(f * n.h2 + n.a2, n.l1, n.a2);
    const T change = may ? static_cast<T>(f / n.f) : none;
    const S rest = s * (bend * r - n.moment);
    const S square1 = n.h1 * (n.h1 * r * r + rest) / (m1 * r) - n.h1 * n.h1;
    return {
        n.clapper.weight / change,
        n.length(detail::nearest_root(
            S(r * r - m1 * r), rest, S(-m1 * r * n.square1), n.h1,
            [&](const S& x) { return x > zero && keeps(n.moment, S(x + n.square1 / x), n.a2); })),
        with_l1(n.h1 + square1 / n.h1, radius(square1)),
        n.bell.weight * change,
        n.length(detail::nearest_root(
            S(s * (r - one)), S(n.h1 * r * r - n.l1 * r - s * n.f * n.h2),
            S(r * (s * n.turning - n.f * n.h2 * n.l1)), n.a2,
            [&](const S& a) { return a * n.a2 > zero && keeps(n.f * n.h2 + a, n.l1, a); })),
        n.length(detail::nearest_root(
            S(s * n.f * r / n.a2), S(-n.f * lean), S(s * n.f * n.square2 * r / n.a2 + fixed), n.h2,
            [&](const S& h) { return keeps(n.f * h + n.a2, n.l1, n.a2); })),
        with_l1(n.l1, radius((n.h2 * lean - fixed / n.f) * n.a2 / (s * r) - n.h2 * n.h2))};
}

}  // namespace revchain
