// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include "revchain/numeric/double_word.hpp"
#include "revchain/numeric/zero_between.hpp"
#include "revchain/system/link.hpp"

/// Two links at any inclination: all shapes at a given speed, and the proof that there are no
/// others. Greenhill (1908) §2 (4), (8), §6 (10).
///
/// Lengths are in units of the conical height. l1 and l2 are the lengths, s l1 l2 is the coupling
/// with s = W1/(W1+W2) or h/l, and A = sec d1 - l1. The paper's (4) and A sin d1 = l2 sin d2 leave
/// one equation in A,
///     F = A^2 (1 - cos^2 d1) - l2^2 (1 - cos^2 d2) = 0,      sec d2 = l2 + s l1 l2 / A.
/// A > 0: both links lean to one side. F grows with A, so there is one shape if the height is below
/// the first of (5), else none.
/// A < 0: the links lean to opposite sides. With B = -A,
///     dF/dB = 2B (1 - l1/(l1-B)^3 - s l1/(B - s l1)^3).
/// The bracket is concave with its maximum at B = s^(1/4) l1 (1 - s^(1/4) + s^(1/2)). F grows
/// between its two zeros and falls elsewhere, so there are one or three shapes if the height is
/// below the second of (5), else none.
///
/// For jointed links a2, between the pins of the upper link, replaces the l2 before (1 - cos^2 d2).
/// The bracket is then 1 - l1/(l1-B)^3 - (a2/l2)^2 s l1/(B - s l1)^3 with its maximum at
/// B - s l1 : l1 - B = (s (a2/l2)^2)^(1/4) : 1, and the rest holds unchanged.
namespace revchain::inline REVCHAIN_BUILD {

template <Real T>
struct PairShape;  // two_links.hpp

namespace detail {

/// Two links at a speed. Lengths are over the height, in two words, because inclinations are
/// ill-conditioned near a fold and near the vertical.
template <Real T>
struct Pair {
    using S = Wide<T>;
    S l1, l2, share, other;  ///< other = 1 - share
    T height;
    S upper = l2;  ///< a2, between the pins of the upper link

    /// (1 - l1)(1 - l2) - s l1 l2 of §2 (5), negative between the two heights. Of two forms the one
    /// with the smaller terms is used.
    S characteristic() const {
        using std::abs;
        const S one(1), p = (one - l1) * (one - l2), q = share * l1 * l2, r = other * l1 * l2,
                        rest = l1 + l2 - one;
        return abs(p) + q < r + abs(rest) ? p - q : r - rest;
    }
    /// F/a2^2 and its slope along arm = |A|. `versed` = sec d1 - 1 grows with the arm (`direction`
    /// 1) or falls, `rest` = arm (sec d2 - 1), and arm sec d2 = l2 (arm + joint), joint = +- s l1.
    std::pair<S, S> balance(int direction, const S& joint, const S& arm, const S& versed,
                            const S& rest) const {
        const S cosine1 = S(1) / (S(1) + versed),
                sine1_squared = versed * cosine1 * (S(1) + cosine1);
        const S lever = arm + rest, cosine2 = arm / lever, ratio = arm / upper;
        return {ratio * ratio * sine1_squared - rest / lever * (S(1) + cosine2),
                S(2) * (ratio / upper *
                            (sine1_squared + S(direction) * arm * cosine1 * cosine1 * cosine1) +
                        cosine2 * cosine2 * (joint * l2 / lever) / arm)};
    }
    PairShape<T> shape(int side, const S& arm, const S& versed, const S& rest) const {
        using std::atan, std::sqrt;
        const S excess = rest / arm, secant2 = S(1) + excess;
        const S square1 = versed * (S(2) + versed), square2 = excess * (S(2) + excess);
        const T tangent1 = sqrt(static_cast<T>(square1)),
                tangent2 = T(side) * sqrt(static_cast<T>(square2));
        return {{atan(tangent1), atan(tangent2)},
                {height * tangent1, height * (static_cast<T>(upper / secant2) * tangent2)},
                {static_cast<T>(share * (S(1) + versed)), static_cast<T>(secant2)}};
    }
};

/// A point within a width: its distances from both ends, each accurate to its last digit.
template <Real S>
struct Place {
    S x, left;
};

/// The point between `low` and `high` where a function of x and of the width left goes through zero
/// once, upwards (sign 1) or downwards (sign -1).
template <Real S, class F>
Place<S> zero_within(const S& width, const Place<S>& low, const Place<S>& high, const S& sign,
                     const F& value_and_slope) {
    const S middle = width / S(2);
    const auto from_low = [&](const S& x) {
        const auto [value, slope] = value_and_slope(x, S(width - x));
        return std::pair<S, S>(sign * value, sign * slope);
    };
    const auto from_high = [&](const S& left) {
        const auto [value, slope] = value_and_slope(S(width - left), left);
        return std::pair<S, S>(-sign * value, sign * slope);
    };
    if (high.x > middle && (low.x >= middle || !(from_low(middle).first > S(0)))) {
        const S left = zero_between(high.left, std::min(low.left, middle), from_high);
        return {S(width - left), left};
    }
    const S x = zero_between(low.x, std::min(high.x, middle), from_low);
    return {x, S(width - x)};
}

/// The one shape with arm = arm0 + x, sec d1 - 1 = versed0 + x, rest = rest0 + (l2 - 1) x for
/// 0 <= x <= farthest or, where l2 < 1, up to d2 = 0, where the rest is 0. F grows with x.
template <Real T, class S>
PairShape<T> growing_shape(const Pair<T>& pair, const S& joint, const S& arm0, const S& versed0,
                           const S& rest0, const S& farthest) {
    const auto at = [&](const S& x, const S& rest) {
        return pair.balance(1, joint, S(arm0 + x), S(versed0 + x), rest);
    };
    S x, rest;
    if (pair.l2 < S(1)) {
        const S falls = S(1) - pair.l2, width = rest0 / falls;
        const Place<S> place = zero_within(width, {S(0), width}, {width, S(0)}, S(1),
                                           [&](const S& from_low, const S& from_high) {
                                               return at(from_low, S(falls * from_high));
                                           });
        x = place.x, rest = falls * place.left;
    } else {
        const auto rest_at = [&](const S& from) { return rest0 + (pair.l2 - S(1)) * from; };
        x = zero_between(S(0), farthest, [&](const S& from) { return at(from, S(rest_at(from))); });
        rest = rest_at(x);
    }
    return pair.shape(1, S(arm0 + x), S(versed0 + x), rest);
}

/// Appends the shape that leans to one side, if there is one. The search begins at A = 0 or d1 = 0.
/// rest = (l2 - 1) A + s l1 l2, which is -chi where d1 = 0.
template <Real T>
void add_same_side(const Pair<T>& pair, std::vector<PairShape<T>>& shapes) {
    using S = Wide<T>;
    const S chi = pair.characteristic(), one(1);
    if (!(chi < S(0)) && !(pair.l1 > one && pair.l2 > one)) return;
    shapes.push_back(growing_shape(pair, S(pair.share * pair.l1), std::max(S(0), S(one - pair.l1)),
                                   std::max(S(0), S(pair.l1 - one)),
                                   pair.l1 < one ? S(-chi) : S(pair.share * pair.l1 * pair.l2),
                                   S(pair.l1 + pair.upper + one)));
}

/// The shape in which the lower link stands, if any: A = l1 + sec d1, d1 from the upward vertical.
template <Real T>
std::optional<PairShape<T>> standing_shape(const Pair<T>& pair) {
    using S = Wide<T>;
    const S arm0 = S(1) + pair.l1, rest0 = (pair.l2 - S(1)) * arm0 - pair.share * pair.l1 * pair.l2;
    if (!(rest0 > S(0))) return std::nullopt;  // so that l2 > 1
    auto shape = growing_shape(pair, S(-pair.share * pair.l1), arm0, S(0), rest0, pair.l2);
    shape.tension[0] = -shape.tension[0];
    return shape;
}

/// Appends the shapes that lean to opposite sides: none, one or three.
template <Real T>
void add_opposite_sides(const Pair<T>& pair, std::vector<PairShape<T>>& shapes) {
    using std::sqrt;
    using S = Wide<T>;
    const S chi = pair.characteristic();
    if (!(chi > S(0) && pair.l1 > S(1) && pair.l2 > S(1))) return;
    // B runs from s l1 l2/(l2 - 1), where d2 = 0, over chi/(l2 - 1) to l1 - 1, where d1 = 0.
    const S rises = pair.l2 - S(1), first = pair.share * pair.l1 * (pair.l2 / rises),
            width = chi / rises;
    const auto at = [&](const S& x, const S& versed) {
        return pair.balance(-1, S(-pair.share * pair.l1), S(first + x), versed, S(rises * x));
    };
    const Place<S> start{S(0), width}, end{width, S(0)};
    const auto add_between = [&](const Place<S>& low, const Place<S>& high, int sign) {
        const auto [x, versed] = zero_within(width, low, high, S(sign), at);
        shapes.push_back(pair.shape(-1, S(first + x), versed, S(rises * x)));
    };
    // F turns where 1 - l1/P^3 - r^2 s l1/Q^3 = 0, r = a2/l2, P = l1 - B = 1 + versed and Q = B - s
    // l1 = x + s l1/(l2 - 1). The bracket has its maximum at Q : P = (r^2 s)^(1/4), a zero on
    // either side.
    const S both = pair.other * pair.l1, lower = pair.share * pair.l1, ratio = pair.upper / pair.l2;
    const S root = sqrt(sqrt(pair.share) * ratio), top_p = both / (S(1) + root),
            top_q = root * top_p;
    const auto first_part = [&](const S& p) {
        return pair.l1 / p / p / p;
    };  // cubes may leave the range
    const auto second_part = [&](const S& q) { return lower / q * (ratio / q) * (ratio / q); };
    const auto turning = [&](const S& p, const S& q) {
        return S(1) - first_part(p) - second_part(q);
    };
    Place<S> low = start, high = start;  // F grows between the two
    if (turning(top_p, top_q) > S(0)) {
        const auto at_place = [&](const S& p, const S& q, int sign) {  // value, slope along +- Q
            const S slope = S(3) * (second_part(q) / q - first_part(p) / p);
            return std::pair<S, S>(turning(p, q), S(sign) * slope);
        };
        const S q = zero_between(S(0), top_q, [&](const S& x) { return at_place(both - x, x, 1); });
        const S p =
            zero_between(S(0), top_p, [&](const S& x) { return at_place(x, both - x, -1); });
        const S x = std::clamp(S(q - lower / rises), S(0), width),
                versed = std::clamp(S(p - S(1)), S(0), width);
        low = {x, S(width - x)}, high = {S(width - versed), versed};
    }
    const auto value = [&](const Place<S>& place) { return at(place.x, place.left).first; };
    if (!(low.x < high.x)) return add_between(start, end, -1);
    const bool zero_before = value(low) < S(0);
    const bool zero_after = !zero_before || value(high) > S(0);
    if (zero_after) add_between(high, end, -1);
    if (zero_before && zero_after) add_between(low, high, 1);
    if (zero_before) add_between(start, low, -1);
}

/// All shapes that hang, sorted for the public functions.
template <Real T>
std::vector<PairShape<T>> hanging_shapes(const Pair<T>& pair) {
    std::vector<PairShape<T>> shapes;
    add_same_side(pair, shapes);
    add_opposite_sides(pair, shapes);
    return shapes;
}

/// Returns a pair of links. Throws InvalidArgument if cubes of lengths over the height overflow.
template <Real T>
Pair<T> pair_of(std::string_view place, const Wide<T>& lower, const Wide<T>& upper,
                const Wide<T>& share, const Wide<T>& other, const T& height) {
    using std::ldexp;
    const Pair<T> pair{in_lengths<T>(lower, height), in_lengths<T>(upper, height), share, other,
                       height};
    const T limit = ldexp(T(1), std::numeric_limits<T>::max_exponent / 3 - 2);
    if (!(static_cast<T>(pair.l1) <= limit && static_cast<T>(pair.l2) <= limit))
        throw_invalid(
            place, "height must not be smaller than the lengths by more than a third of the range",
            height);
    return pair;
}

}  // namespace detail
}  // namespace revchain
