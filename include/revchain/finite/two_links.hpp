// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "revchain/core/zero_between.hpp"
#include "revchain/linear/two_links.hpp"

/// Two links at any inclination: every hanging figure of two plummets, or of a compound link on a thread, at a given
/// speed. Greenhill (1908) §2 (4), (8), §6 (10). Of any two links: finite/jointed_links.hpp.
///
/// In units of the conical height, l1 and l2 the lengths, s l1 l2 the coupling (s = W1/(W1+W2), or h/l) and
/// A = sec d1 - l1, the paper's (4) and (A) sin d1 = l2 sin d2 leave one equation in A,
///     F = A^2 (1 - cos^2 d1) - l2^2 (1 - cos^2 d2) = 0,      sec d2 = l2 + s l1 l2 / A.
/// A > 0: both lean to one side. F grows with A, so there is one figure if the height lies below the first of (5), else
/// none. A < 0, B = -A: dF/dB is 2B (1 - l1/(l1-B)^3 - s l1/(B - s l1)^3), whose bracket is concave with its maximum at
/// B = s^(1/4) l1 (1 - s^(1/4) + s^(1/2)): between its two zeros F grows, elsewhere it falls, so that there are one or
/// three figures if the height lies below the second of (5), else none. All are found, and no more exist.
///
/// Where l2 in sec d2 is not the length a2 between the pins (jointed links), a2 stands for l2 in front of (1 - cos^2 d2), the
/// bracket is 1 - l1/(l1-B)^3 - (a2/l2)^2 s l1/(B - s l1)^3 with its maximum at B - s l1 : l1 - B = (s (a2/l2)^2)^(1/4) : 1,
/// and all else is the same.
namespace revchain {

/// A steady figure, lowest link first; of two mirror images that with the free end (or lowest centre of oscillation) at a
/// positive offset.
template <Real T>
struct PairShape {
    std::array<T, 2> inclination;  ///< to the vertical, rad
    std::array<T, 2> offset;       ///< from the axis, of P1 (L1 for a compound link) and of the joint
    std::array<T, 2> tension;  ///< of either thread over the whole weight; for a compound link both are the thread's

    /// Sign changes of the offsets, and one.
    int half_waves() const { return offset[1] < T(0) ? 2 : 1; }
};

namespace detail {

/// Lengths in units of the conical height; `other` = 1 - s; `upper` = a2, between the pins of the upper link.
template <Real T>
struct Pair {
    T l1, l2, share, other, upper = l2;

    /// (1 - l1)(1 - l2) - s l1 l2 of §2 (5), negative between the two heights; of its two forms that with the smaller terms.
    T characteristic() const {
        using std::abs;
        const T p = (T(1) - l1) * (T(1) - l2), q = share * l1 * l2, r = other * l1 * l2, rest = l1 + l2 - T(1);
        return abs(p) + q < r + abs(rest) ? p - q : r - rest;
    }
};

/// F/a2^2 and its slope along |A|. `versed` = sec d1 - 1, growing with |A| or falling as `direction` says; `arm` = |A|;
/// `rest` = arm (sec d2 - 1); `joint` = +- s l1, so that arm sec d2 = l2 (arm + joint).
template <Real T>
std::pair<T, T> balance(const Pair<T>& pair, int direction, const T& joint, const T& arm, const T& versed,
                        const T& rest) {
    const T cosine1 = T(1) / (T(1) + versed), sine1_squared = versed * cosine1 * (T(1) + cosine1);
    const T lever = arm + rest, cosine2 = arm / lever, ratio = arm / pair.upper;
    return {ratio * ratio * sine1_squared - rest / lever * (T(1) + cosine2),
            T(2) * (ratio / pair.upper * (sine1_squared + T(direction) * arm * cosine1 * cosine1 * cosine1) +
                    cosine2 * cosine2 * (joint * pair.l2 / lever) / arm)};
}

/// A place within a width, told from both ends, each to its own last digit.
template <Real T>
struct Place {
    T x, left;
};

/// Where, from `low` to `high`, a function of x and of what is left of the width goes through zero once, upwards (sign 1)
/// or downwards (sign -1).
template <Real T, class F>
Place<T> zero_within(const T& width, const Place<T>& low, const Place<T>& high, const T& sign,
                     const F& value_and_slope) {
    const T middle = width / T(2);
    const auto from_low = [&](const T& x) {
        const auto [value, slope] = value_and_slope(x, T(width - x));
        return std::pair<T, T>(sign * value, sign * slope);
    };
    const auto from_high = [&](const T& left) {
        const auto [value, slope] = value_and_slope(T(width - left), left);
        return std::pair<T, T>(-sign * value, sign * slope);
    };
    if (high.x > middle && (low.x >= middle || !(from_low(middle).first > T(0)))) {
        const T left = zero_between(high.left, std::min(low.left, middle), from_high);
        return {T(width - left), left};
    }
    const T x = zero_between(low.x, std::min(high.x, middle), from_low);
    return {x, T(width - x)};
}

template <Real T>
PairShape<T> pair_shape(const Pair<T>& pair, int side, const T& arm, const T& versed, const T& rest, const T& height) {
    using std::atan;
    using std::sqrt;
    const T excess = rest / arm, secant2 = T(1) + excess;
    const T tangent1 = sqrt(versed) * sqrt(T(2) + versed), tangent2 = T(side) * sqrt(excess) * sqrt(T(2) + excess);
    return {{atan(tangent1), atan(tangent2)},
            {height * tangent1, height * (pair.upper * (tangent2 / secant2))},
            {pair.share * (T(1) + versed), secant2}};
}

/// Figures leaning to one side: one, if any.
template <Real T>
void add_same_side(const Pair<T>& pair, const T& height, std::vector<PairShape<T>>& shapes) {
    const T chi = pair.characteristic();
    if (!(chi < T(0)) && !(pair.l1 > T(1) && pair.l2 > T(1))) return;
    // From A = 0 or d1 = 0; rest = (l2 - 1) A + s l1 l2, which is -chi where d1 = 0.
    const T arm0 = std::max(T(0), T(1) - pair.l1), versed0 = std::max(T(0), pair.l1 - T(1));
    const T rest0 = pair.l1 < T(1) ? -chi : pair.share * pair.l1 * pair.l2;
    const auto add = [&](const T& x, const T& rest) {
        shapes.push_back(pair_shape(pair, 1, T(arm0 + x), T(versed0 + x), rest, height));
    };
    const auto at = [&](const T& x, const T& rest) {
        return balance(pair, 1, T(pair.share * pair.l1), T(arm0 + x), T(versed0 + x), rest);
    };
    if (pair.l2 < T(1)) {  // up to where d2 = 0
        const T falls = T(1) - pair.l2, width = rest0 / falls;
        const auto [x, left] =
            zero_within(width, {T(0), width}, {width, T(0)}, T(1),
                        [&](const T& from_low, const T& from_high) { return at(from_low, T(falls * from_high)); });
        add(x, T(falls * left));
    } else {
        const auto rest = [&](const T& x) { return rest0 + (pair.l2 - T(1)) * x; };
        const T x =
            zero_between(T(0), T(pair.l1 + pair.upper + T(1)), [&](const T& from) { return at(from, rest(from)); });
        add(x, rest(x));
    }
}

/// Figures leaning to both sides: one or three, if any.
template <Real T>
void add_opposite_sides(const Pair<T>& pair, const T& height, std::vector<PairShape<T>>& shapes) {
    using std::sqrt;
    const T chi = pair.characteristic();
    if (!(chi > T(0) && pair.l1 > T(1) && pair.l2 > T(1))) return;
    // B from s l1 l2/(l2 - 1), where d2 = 0, over a width of chi/(l2 - 1) to l1 - 1, where d1 = 0.
    const T rises = pair.l2 - T(1), first = pair.share * pair.l1 * (pair.l2 / rises), width = chi / rises;
    const auto at = [&](const T& x, const T& versed) {
        return balance(pair, -1, T(-pair.share * pair.l1), T(first + x), versed, T(rises * x));
    };
    const Place<T> start{T(0), width}, end{width, T(0)};
    const auto add_between = [&](const Place<T>& low, const Place<T>& high, int sign) {
        const auto [x, versed] = zero_within(width, low, high, T(sign), at);
        shapes.push_back(pair_shape(pair, -1, T(first + x), versed, T(rises * x), height));
    };
    // F turns where  1 - l1/P^3 - r^2 s l1/Q^3 = 0,  r = a2/l2, P = l1 - B = 1 + versed and Q = B - s l1 = x + s l1/(l2 - 1):
    // the bracket has its maximum at Q : P = (r^2 s)^(1/4), and a zero on either side.
    const T both = pair.other * pair.l1, lower = pair.share * pair.l1, ratio = pair.upper / pair.l2;
    const T root = sqrt(sqrt(pair.share) * ratio), pull = ratio * lower * ratio;
    const T top_p = both / (T(1) + root), top_q = root * top_p;
    const auto turning = [&](const T& p, const T& q) { return T(1) - pair.l1 / (p * p * p) - pull / (q * q * q); };
    Place<T> low = start, high = start;  // F grows between
    if (turning(top_p, top_q) > T(0)) {
        const auto slope = [&](const T& p, const T& q) {  // along Q
            return T(3) * (pull / (q * q * q) / q - pair.l1 / (p * p * p) / p);
        };
        const T q = zero_between(T(0), top_q, [&](const T& at_q) {
            return std::pair<T, T>(turning(T(both - at_q), at_q), slope(T(both - at_q), at_q));
        });
        const T p = zero_between(T(0), top_p, [&](const T& at_p) {
            return std::pair<T, T>(turning(at_p, T(both - at_p)), -slope(at_p, T(both - at_p)));
        });
        const T x = std::clamp(T(q - lower / rises), T(0), width), versed = std::clamp(T(p - T(1)), T(0), width);
        low = {x, T(width - x)}, high = {T(width - versed), versed};
    }
    const auto value = [&](const Place<T>& place) { return at(place.x, place.left).first; };
    if (!(low.x < high.x)) {
        add_between(start, end, -1);
    } else if (!(value(low) < T(0))) {
        add_between(high, end, -1);
    } else if (!(value(high) > T(0))) {
        add_between(start, low, -1);
    } else {
        add_between(high, end, -1);
        add_between(low, high, 1);
        add_between(start, low, -1);
    }
}

/// The lower link upside down: l1 + sec d1 for A, and d1 from the upward vertical. F grows from sec d1 = 1.
template <Real T>
std::optional<PairShape<T>> standing_shape(const Pair<T>& pair, const T& height) {
    const T arm0 = T(1) + pair.l1, rest0 = (pair.l2 - T(1)) * arm0 - pair.share * pair.l1 * pair.l2;
    if (!(rest0 > T(0))) return std::nullopt;
    const auto function = [&](const T& x) {
        return balance(pair, 1, T(-pair.share * pair.l1), T(arm0 + x), x, T(rest0 + (pair.l2 - T(1)) * x));
    };
    const T x = detail::zero_between(T(0), pair.l2, function);
    auto shape = pair_shape(pair, 1, T(arm0 + x), x, T(rest0 + (pair.l2 - T(1)) * x), height);
    shape.tension[0] = -shape.tension[0];
    return shape;
}

/// Lengths over the height. Throws where cubes of them would leave the range.
template <Real T>
Pair<T> pair_of(std::string_view place, const T& lower, const T& upper, const T& share, const T& other,
                const T& height) {
    using std::ldexp;
    const Pair<T> pair{lower / height, upper / height, share, other};
    const T limit = ldexp(T(1), std::numeric_limits<T>::max_exponent / 3 - 2);
    if (!(pair.l1 <= limit && pair.l2 <= limit))
        refuse(place, "height must not be smaller than the lengths by more than a third of the range", height);
    return pair;
}

template <Real T>
Pair<T> pair_of(std::string_view place, const CompoundLink<T>& link, const T& thread, const T& height) {
    const T length = link.pendulum_length();
    return pair_of(place, length, thread, link.share_at_centre_of_oscillation(),
                   T(link.square_over_centroid() / length), height);
}

template <Real T>
std::vector<PairShape<T>> pair_shapes(const Pair<T>& pair, const T& height) {
    std::vector<PairShape<T>> shapes;
    add_same_side(pair, height, shapes);
    add_opposite_sides(pair, height, shapes);
    return shapes;
}

}  // namespace detail

/// All hanging figures of two plummets at the speed of conical height `height`, by sign changes, then inclination of the
/// lower thread: §2 (4). Empty above the first of `two_plummets`; at most four.
/// Accuracy: tangents to 1e-15 height_k / (height_k - height) where the figure leaves the vertical at height_k, and as
/// the square root of that next to a fold. Cost: a microsecond. Throws InvalidArgument unless all are positive and finite.
template <Real T>
std::vector<PairShape<T>> two_plummets_shapes(const T& lower_weight, const T& lower_thread, const T& upper_weight,
                                              const T& upper_thread, const T& height) {
    constexpr std::string_view place = "two_plummets_shapes";
    const auto share =
        detail::shares_of(place, detail::plummet_names, lower_weight, lower_thread, upper_weight, upper_thread);
    detail::require_positive(place, "height", height);
    return detail::pair_shapes(detail::pair_of(place, lower_thread, upper_thread, share.lower, share.upper, height),
                               height);
}

/// All hanging figures of a compound link on a thread, §6 (10): likewise.
template <Real T>
std::vector<PairShape<T>> link_on_thread_shapes(const T& thread, const CompoundLink<T>& link, const T& height) {
    constexpr std::string_view place = "link_on_thread_shapes";
    detail::require_positive(place, "thread", thread);
    detail::check(place, link);
    detail::require_positive(place, "height", height);
    auto shapes = detail::pair_shapes(detail::pair_of(place, link, thread, height), height);
    for (PairShape<T>& shape : shapes) shape.tension[0] = shape.tension[1];
    return shapes;
}

/// The figure in which a plummet stands above the other on a stiff weightless rod, §2 (8): inclination[0] is the rod's to
/// the upward vertical, tension[0] its thrust, negative. Exactly one where `standing_plummet` lies above the height, else
/// none: F grows with sec d1.
template <Real T>
std::optional<PairShape<T>> standing_plummet_shape(const T& standing_weight, const T& rod, const T& hung_weight,
                                                   const T& thread, const T& height) {
    constexpr std::string_view place = "standing_plummet_shape";
    const auto share = detail::shares_of(place, detail::standing_names, standing_weight, rod, hung_weight, thread);
    detail::require_positive(place, "height", height);
    return detail::standing_shape(detail::pair_of(place, rod, thread, share.lower, share.upper, height), height);
}

/// The same of a compound link that stands on its lowest point, §6 (12) with the secants of (10): both tensions are that
/// of the thread, or of the hand that moves as its end does.
template <Real T>
std::optional<PairShape<T>> standing_link_shape(const T& thread, const CompoundLink<T>& link, const T& height) {
    constexpr std::string_view place = "standing_link_shape";
    detail::require_positive(place, "thread", thread);
    detail::check(place, link);
    detail::require_positive(place, "height", height);
    auto shape = detail::standing_shape(detail::pair_of(place, link, thread, height), height);
    if (shape) shape->tension[0] = shape->tension[1];
    return shape;
}

}  // namespace revchain
