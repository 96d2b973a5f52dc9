// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <string_view>

#include "revchain/chain.hpp"

/// When a bell and its clapper swing as one piece, so that the bell is silent, and what to change about it.
/// Greenhill (1908) §8 (13)-(16).
namespace revchain {

/// The data of a bell and its clapper. The paper's suffix 1 is the clapper, 2 the bell. `joint` is a2, the distance
/// from the bell's axle to the clapper's pin.
enum class BellDatum {
    clapper_weight,
    clapper_centroid,
    clapper_radius_of_gyration,
    bell_weight,
    joint,
    bell_centroid,
    bell_radius_of_gyration
};

inline constexpr std::array<std::string_view, 7> bell_datum_names{
    "clapper_weight", "clapper_centroid", "clapper_radius_of_gyration", "bell_weight",
    "joint",          "bell_centroid",    "bell_radius_of_gyration"};

template <Real T>
using ByBellDatum = std::array<T, bell_datum_names.size()>;

/// The two modes, slower first. In the slower one bell and clapper lean the same way, in the faster one opposite ways:
/// they can be one piece in the slower one alone.
template <Real T>
struct BellAndClapper {
    std::array<T, 2> conical_height;
    std::array<T, 2> inclination_ratio;  ///< clapper's over bell's; one piece where the first is 1
    T silent_height;                     ///< l1 + a2: the conical height of the slower mode where they are one piece
    T mismatch;  ///< h1 - (m + 1) l1 - m (a2 - l2), m = W2 h2/(W1 a2): a length, 0 where they are one piece, §8 (16)
    ByBellDatum<T> present;
    ByBellDatum<T> derivative;  ///< of the first inclination ratio
};

namespace detail {

/// G(r) = h1 r^2 - [(m + 1) l1 - m l2 - a2] r - (m + 1) a2, 0 where r is a mode's ratio of inclinations: (14) with
/// lambda = l1 + a2/r, the moment of the clapper about its pin. In lengths, f the ratio of the weights:
/// a2 (m + 1) = f h2 + a2, a2 m l2 = f (h2^2 + rho2^2).
template <class S>
struct BellNumbers {
    S h1, square1, a2, h2, square2, f;  ///< squares of radii of gyration

    S clapper_length() const { return h1 + square1 / h1; }
    S moment() const { return f * h2 + a2; }  ///< (m + 1) a2
    S turning() const { return f * (h2 * h2 + square2); }
    /// G = h1 r^2 - slope() r - moment().
    S slope() const { return moment() / a2 * clapper_length() - turning() / a2 - a2; }
};

template <Real T>
BellNumbers<Wide<T>> bell_numbers(std::string_view place, const Chain<T>& chain, const T& unit) {
    using S = Wide<T>;
    if (chain.size() != 2) throw_invalid(place, "the chain must have two links, clapper and bell", chain.size());
    const Link<T> clapper = chain.link(0), bell = chain.link(1);
    require_positive(place, "the bell's weight", bell.weight);
    const auto scaled = [&](const T& x) { return S(x * unit); };
    const auto square = [&](const Link<T>& link) {
        return link.gyration_ratio * (scaled(link.length) * scaled(link.length));
    };
    using std::ldexp;
    const int exponent = -chain.units().weight_exponent;
    return {scaled(clapper.centroid),
            square(clapper),
            scaled(bell.length),
            scaled(bell.centroid),
            square(bell),
            S(ldexp(bell.weight, exponent)) / S(ldexp(clapper.weight, exponent))};
}

/// The root of a x^2 + b x + c = 0 nearest to x0 that `may` be taken; NaN where there is none.
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

/// Both modes of a bell (upper link) and its clapper (lower link), how far they are from swinging as one piece, and how
/// the slower mode's ratio of inclinations r changes with every datum: dr/dx = -(dG/dx)/(dG/dr).
/// Accuracy: heights and ratios 2 ulp, derivatives 4 ulp of the sum of their terms' sizes, measured
/// (tests/cpp/bell.cpp). Cost O(1). Throws InvalidArgument unless there are two links, both with weight.
template <Real T>
BellAndClapper<T> bell_and_clapper(const Chain<T>& chain) {
    using std::ldexp, std::sqrt;
    using S = Wide<T>;
    const int exponent = chain.units().length_exponent;
    const auto n = detail::bell_numbers("bell_and_clapper", chain, ldexp(T(1), -exponent));
    const S two(T(2)), one(T(1)), l1 = n.clapper_length(), slope = n.slope(), moment = n.moment();
    const S root = sqrt(slope * slope + S(T(4)) * n.h1 * moment);
    const bool rising = !(slope < S(T(0)));
    const S far = (rising ? slope + root : slope - root) / (two * n.h1), near = -moment / (n.h1 * far);
    const S r = rising ? far : near, other = rising ? near : far;

    BellAndClapper<T> result;
    const auto length = [&](const S& x) { return ldexp(static_cast<T>(x), exponent); };
    const auto height = [&](const S& ratio) { return length(l1 + n.a2 / ratio); };
    result.conical_height = {height(r), height(other)};
    result.inclination_ratio = {static_cast<T>(r), static_cast<T>(other)};
    result.silent_height = length(l1 + n.a2);
    result.mismatch = length(n.h1 - slope - moment);

    const Link<T> clapper = chain.link(0), bell = chain.link(1);
    const T rho1 = radius_of_gyration(clapper), rho2 = radius_of_gyration(bell);
    result.present = {clapper.weight, clapper.centroid, rho1, bell.weight, bell.length, bell.centroid, rho2};
    const S m1 = moment / n.a2, lean = l1 / n.a2 * r + one, radius1 = sqrt(n.square1), radius2 = sqrt(n.square2);
    const S by_weights = n.turning() * r / n.a2 - n.f * n.h2 * lean;  // f dG/df
    const S by_joint = (n.f * n.h2 * l1 - n.turning()) / (n.a2 * n.a2) * r + r - one;
    const auto weight = [&](const S& x, const T& w) { return static_cast<T>(-x / root) / w; };
    const auto per_length = [&](const S& x) { return ldexp(static_cast<T>(-x / root), -exponent); };
    result.derivative = {weight(-by_weights, clapper.weight),
                         per_length(r * r - m1 * (one - n.square1 / (n.h1 * n.h1)) * r),
                         per_length(-m1 * two * radius1 / n.h1 * r),
                         weight(by_weights, bell.weight),
                         per_length(by_joint),
                         per_length(n.f * (two * n.h2 * r / n.a2 - lean)),
                         per_length(n.f * two * radius2 * r / n.a2)};
    return result;
}

/// For each datum the value nearest to the present one that gives the slower mode a ratio of inclinations `ratio`, the
/// others held; NaN where none does. With a ratio of 1 bell and clapper become one piece; to keep them from it, ask for
/// one as far from 1 as it takes. Each is a root of a quadratic. Cost O(1). Throws as `bell_and_clapper` does, and for
/// a ratio not positive.
template <Real T>
ByBellDatum<T> bell_and_clapper_with_ratio(const Chain<T>& chain, const T& ratio) {
    using std::ldexp, std::sqrt;
    using S = Wide<T>;
    constexpr std::string_view place = "bell_and_clapper_with_ratio";
    detail::require_positive(place, "ratio", ratio);
    const int exponent = chain.units().length_exponent;
    const auto n = detail::bell_numbers(place, chain, ldexp(T(1), -exponent));
    const Link<T> clapper = chain.link(0), bell = chain.link(1);
    const S zero(T(0)), r(ratio), l1 = n.clapper_length(), moment = n.moment(), m1 = moment / n.a2,
                                  turning = n.turning(), bend = turning / n.a2 + n.a2,
                                  none(std::numeric_limits<T>::quiet_NaN());
    const auto positive = [&](const S& x) { return x > zero; };
    const auto hangs = [&](const S& h) { return n.f * h + n.a2 > zero; };
    const auto length = [&](const S& x) { return ldexp(static_cast<T>(x), exponent); };
    const auto radius = [&](const S& square) { return square < zero ? static_cast<T>(none) : length(sqrt(square)); };
    // G = fixed + f by_weight
    const S fixed = n.h1 * r * r - l1 * r + n.a2 * (r - S(T(1))), lean = l1 / n.a2 * r + S(T(1));
    const S by_weight = (n.h2 * n.h2 + n.square2) * r / n.a2 - n.h2 * lean;
    const S f = -fixed / by_weight;
    const bool weighs = f > zero && f * n.h2 + n.a2 > zero;
    const T change = static_cast<T>(weighs ? f / n.f : none);
    return {
        clapper.weight / change,
        length(detail::nearest_root(r * r - m1 * r, bend * r - moment, -m1 * r * n.square1, n.h1, positive)),
        radius(n.h1 * (n.h1 * r * r + bend * r - moment) / (m1 * r) - n.h1 * n.h1),
        bell.weight * change,
        length(detail::nearest_root(r - S(T(1)), n.h1 * r * r - l1 * r - n.f * n.h2, r * (turning - n.f * n.h2 * l1),
                                    n.a2, [&](const S& a) { return a > zero && n.f * n.h2 + a > zero; })),
        length(detail::nearest_root(n.f * r / n.a2, -n.f * lean, n.f * n.square2 * r / n.a2 + fixed, n.h2, hangs)),
        radius((n.h2 * lean - fixed / n.f) * n.a2 / r - n.h2 * n.h2)};
}

}  // namespace revchain
