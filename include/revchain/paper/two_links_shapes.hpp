// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "revchain/numeric/zero_between.hpp"
#include "revchain/two_links.hpp"

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
/// Where l2 in sec d2 is not the length a2 between the pins (jointed links), a2 stands for l2 in front of (1 - cos^2
/// d2), the bracket is 1 - l1/(l1-B)^3 - (a2/l2)^2 s l1/(B - s l1)^3 with its maximum at B - s l1 : l1 - B = (s
/// (a2/l2)^2)^(1/4) : 1, and all else is the same.
namespace revchain {

/// A steady figure, lowest link first; of two mirror images that with the free end (or lowest centre of oscillation) at
/// a positive offset.
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

    /// (1 - l1)(1 - l2) - s l1 l2 of §2 (5), negative between the two heights; of its two forms that with the smaller
    /// terms.
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

/// Where, from `low` to `high`, a function of x and of what is left of the width goes through zero once, upwards (sign
/// 1) or downwards (sign -1).
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

template <Real T, class S>
PairShape<T> pair_shape(const Pair<S>& pair, int side, const S& arm, const S& versed, const S& rest, const T& height) {
    using std::atan;
    using std::sqrt;
    const S excess = rest / arm, secant2 = S(1) + excess;
    const S square1 = versed * (S(2) + versed), square2 = excess * (S(2) + excess);
    const T tangent1 = sqrt(static_cast<T>(square1)), tangent2 = T(side) * sqrt(static_cast<T>(square2));
    return {{atan(tangent1), atan(tangent2)},
            {height * tangent1, height * (static_cast<T>(pair.upper / secant2) * tangent2)},
            {static_cast<T>(pair.share * (S(1) + versed)), static_cast<T>(secant2)}};
}

/// Figures leaning to one side: one, if any.
template <Real S, Real T>
void add_same_side(const Pair<S>& pair, const T& height, std::vector<PairShape<T>>& shapes) {
    const S chi = pair.characteristic();
    if (!(chi < S(0)) && !(pair.l1 > S(1) && pair.l2 > S(1))) return;
    // From A = 0 or d1 = 0; rest = (l2 - 1) A + s l1 l2, which is -chi where d1 = 0.
    const S arm0 = std::max(S(0), S(1) - pair.l1), versed0 = std::max(S(0), pair.l1 - S(1));
    const S rest0 = pair.l1 < S(1) ? -chi : pair.share * pair.l1 * pair.l2;
    const auto add = [&](const S& x, const S& rest) {
        shapes.push_back(pair_shape(pair, 1, S(arm0 + x), S(versed0 + x), rest, height));
    };
    const auto at = [&](const S& x, const S& rest) {
        return balance(pair, 1, S(pair.share * pair.l1), S(arm0 + x), S(versed0 + x), rest);
    };
    if (pair.l2 < S(1)) {  // up to where d2 = 0
        const S falls = S(1) - pair.l2, width = rest0 / falls;
        const auto [x, left] =
            zero_within(width, {S(0), width}, {width, S(0)}, S(1),
                        [&](const S& from_low, const S& from_high) { return at(from_low, S(falls * from_high)); });
        add(x, S(falls * left));
    } else {
        const auto rest = [&](const S& x) { return rest0 + (pair.l2 - S(1)) * x; };
        const S x =
            zero_between(S(0), S(pair.l1 + pair.upper + S(1)), [&](const S& from) { return at(from, rest(from)); });
        add(x, rest(x));
    }
}

/// Figures leaning to both sides: one or three, if any.
template <Real S, Real T>
void add_opposite_sides(const Pair<S>& pair, const T& height, std::vector<PairShape<T>>& shapes) {
    using std::sqrt;
    const S chi = pair.characteristic();
    if (!(chi > S(0) && pair.l1 > S(1) && pair.l2 > S(1))) return;
    // B from s l1 l2/(l2 - 1), where d2 = 0, over a width of chi/(l2 - 1) to l1 - 1, where d1 = 0.
    const S rises = pair.l2 - S(1), first = pair.share * pair.l1 * (pair.l2 / rises), width = chi / rises;
    const auto at = [&](const S& x, const S& versed) {
        return balance(pair, -1, S(-pair.share * pair.l1), S(first + x), versed, S(rises * x));
    };
    const Place<S> start{S(0), width}, end{width, S(0)};
    const auto add_between = [&](const Place<S>& low, const Place<S>& high, int sign) {
        const auto [x, versed] = zero_within(width, low, high, S(sign), at);
        shapes.push_back(pair_shape(pair, -1, S(first + x), versed, S(rises * x), height));
    };
    // F turns where  1 - l1/P^3 - r^2 s l1/Q^3 = 0,  r = a2/l2, P = l1 - B = 1 + versed and Q = B - s l1 = x + s l1/(l2
    // - 1): the bracket has its maximum at Q : P = (r^2 s)^(1/4), and a zero on either side.
    const S both = pair.other * pair.l1, lower = pair.share * pair.l1, ratio = pair.upper / pair.l2;
    const S root = sqrt(sqrt(pair.share) * ratio), top_p = both / (S(1) + root), top_q = root * top_p;
    const auto first_part = [&](const S& p) { return pair.l1 / p / p / p; };  // cubes may leave the range
    const auto second_part = [&](const S& q) { return lower / q * (ratio / q) * (ratio / q); };
    const auto turning = [&](const S& p, const S& q) { return S(1) - first_part(p) - second_part(q); };
    Place<S> low = start, high = start;  // F grows between
    if (turning(top_p, top_q) > S(0)) {
        const auto slope = [&](const S& p, const S& q) {  // along Q
            return S(3) * (second_part(q) / q - first_part(p) / p);
        };
        const S q = zero_between(S(0), top_q, [&](const S& at_q) {
            return std::pair<S, S>(turning(S(both - at_q), at_q), slope(S(both - at_q), at_q));
        });
        const S p = zero_between(S(0), top_p, [&](const S& at_p) {
            return std::pair<S, S>(turning(at_p, S(both - at_p)), -slope(at_p, S(both - at_p)));
        });
        const S x = std::clamp(S(q - lower / rises), S(0), width), versed = std::clamp(S(p - S(1)), S(0), width);
        low = {x, S(width - x)}, high = {S(width - versed), versed};
    }
    const auto value = [&](const Place<S>& place) { return at(place.x, place.left).first; };
    if (!(low.x < high.x)) {
        add_between(start, end, -1);
    } else if (!(value(low) < S(0))) {
        add_between(high, end, -1);
    } else if (!(value(high) > S(0))) {
        add_between(start, low, -1);
    } else {
        add_between(high, end, -1);
        add_between(low, high, 1);
        add_between(start, low, -1);
    }
}

/// The lower link upside down: l1 + sec d1 for A, and d1 from the upward vertical. F grows from sec d1 = 1.
template <Real S, Real T>
std::optional<PairShape<T>> standing_shape(const Pair<S>& pair, const T& height) {
    const S arm0 = S(1) + pair.l1, rest0 = (pair.l2 - S(1)) * arm0 - pair.share * pair.l1 * pair.l2;
    if (!(rest0 > S(0))) return std::nullopt;
    const auto function = [&](const S& x) {
        return balance(pair, 1, S(-pair.share * pair.l1), S(arm0 + x), x, S(rest0 + (pair.l2 - S(1)) * x));
    };
    const S x = detail::zero_between(S(0), pair.l2, function);
    auto shape = pair_shape(pair, 1, S(arm0 + x), x, S(rest0 + (pair.l2 - S(1)) * x), height);
    shape.tension[0] = -shape.tension[0];
    return shape;
}

template <Real T>
Wide<T> over_height(const Wide<T>& length, const T& height) {
    using std::frexp;
    using std::ldexp;
    int power = 0;
    const T digits = frexp(height, &power);
    return ldexp(length, -power) / Wide<T>(digits);
}

/// Lengths over the height, in two words: next to a fold and to the vertical inclinations are ill-conditioned. Throws
/// where cubes of them would leave the range.
template <Real T>
Pair<Wide<T>> pair_of(std::string_view place, const Wide<T>& lower, const Wide<T>& upper, const Wide<T>& share,
                      const Wide<T>& other, const T& height) {
    using std::ldexp;
    const Pair<Wide<T>> pair{over_height(lower, height), over_height(upper, height), share, other};
    const T limit = ldexp(T(1), std::numeric_limits<T>::max_exponent / 3 - 2);
    if (!(static_cast<T>(pair.l1) <= limit && static_cast<T>(pair.l2) <= limit))
        throw_invalid(place, "height must not be smaller than the lengths by more than a third of the range", height);
    return pair;
}

template <Real T>
auto pair_of(std::string_view place, const CompoundLink<T>& link, const T& thread, const T& height) {
    using S = Wide<T>;
    const CompoundLink<S> body{S(link.centroid), S(link.radius_of_gyration)};
    const S length = body.pendulum_length();
    return pair_of(place, length, S(thread), body.share_at_centre_of_oscillation(),
                   S(body.square_over_centroid() / length), height);
}

/// Two plummets as they are asked with, checked.
template <Real T>
auto pair_of(std::string_view place, const std::array<std::string_view, 4>& names, const T& lower_weight,
             const T& lower_thread, const T& upper_weight, const T& upper_thread, const T& height) {
    using S = Wide<T>;
    check_plummets(place, names, lower_weight, lower_thread, upper_weight, upper_thread);
    require_positive(place, "height", height);
    const T unit = inverse_power_near(std::max(lower_weight, upper_weight));
    const S w1(lower_weight * unit), w2(upper_weight * unit), both = w1 + w2;
    return pair_of(place, S(lower_thread), S(upper_thread), S(w1 / both), S(w2 / both), height);
}

template <Real S, Real T>
std::vector<PairShape<T>> pair_shapes(const Pair<S>& pair, const T& height) {
    std::vector<PairShape<T>> shapes;
    add_same_side(pair, height, shapes);
    add_opposite_sides(pair, height, shapes);
    return shapes;
}

}  // namespace detail

/// All hanging figures of two plummets at the speed of conical height `height`, by sign changes, then inclination of
/// the lower thread: §2 (4). Empty above the first of `two_plummets`; at most four.
/// Accuracy: inclinations 4 ulp for the data as given, next to a fold and next to the vertical too; computed in two
/// words. Rounded data change tangents by up to height_k / (height_k - height) times as much, where the figure leaves
/// the vertical at height_k, and by the square root of their error where two figures meet. Cost: 10 microseconds a
/// figure.
/// Throws InvalidArgument unless all are positive and finite.
template <Real T>
std::vector<PairShape<T>> two_plummets_shapes(const T& lower_weight, const T& lower_thread, const T& upper_weight,
                                              const T& upper_thread, const T& height) {
    return detail::pair_shapes(detail::pair_of("two_plummets_shapes", detail::plummet_names, lower_weight, lower_thread,
                                               upper_weight, upper_thread, height),
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

/// The figure in which a plummet stands above the other on a stiff weightless rod, §2 (8): inclination[0] is the rod's
/// to the upward vertical, tension[0] its thrust, negative. Exactly one where `standing_plummet` lies above the height,
/// else none: F grows with sec d1.
template <Real T>
std::optional<PairShape<T>> standing_plummet_shape(const T& standing_weight, const T& rod, const T& hung_weight,
                                                   const T& thread, const T& height) {
    return detail::standing_shape(detail::pair_of("standing_plummet_shape", detail::standing_names, standing_weight,
                                                  rod, hung_weight, thread, height),
                                  height);
}

/// The same of a compound link that stands on its lowest point, §6 (12) with the secants of (10): both tensions are
/// that of the thread, or of the hand that moves as its end does.
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

/// All hanging figures of two jointed links at a speed, at any inclination: (14) with its secants, (lambda sec d1 -
/// l1)(lambda sec d2 - p) = c, and (lambda sec d1 - l1) sin d1 = a2 sin d2. Method and count as of two plummets,
/// two_links_shapes.hpp: one figure to one side where the height lies below the first of `jointed_links`, one or three
/// to both sides where it lies below the second; no more exist, whatever l2 and a2 are. By half waves, then inclination
/// of the lower link. offset[0] is that of the lower link's centre of oscillation; tension the size of the reaction at
/// each upper pin over the whole weight.
/// Accuracy: 8 ulp of every inclination where figures are not about to meet (measured; tests/cpp/two_links.cpp).
/// Throws InvalidArgument as `jointed_links` does, and where lengths are more than a third of the range above the
/// height.
template <Real T>
std::vector<PairShape<T>> jointed_links_shapes(const JointedLinks<T>& links, const T& height) {
    using std::cos;
    using std::hypot;
    using std::sin;
    using std::tan;
    constexpr std::string_view place = "jointed_links_shapes";
    const auto n = detail::jointed_numbers(place, links);
    detail::require_positive(place, "height", height);
    using S = Wide<T>;
    const S scale(T(1) / n.unit);
    auto pair = detail::pair_of<T>(place, n.l1 * scale, n.p * scale, n.share, n.other, height);
    pair.upper = detail::over_height(S(links.upper_length), height);
    auto shapes = detail::pair_shapes(pair, height);
    const T whole = links.lower_weight + links.upper_weight;
    const T w1 = links.lower_weight / whole, w2 = links.upper_weight / whole;
    for (PairShape<T>& shape : shapes) {
        // offsets of both centroids over the height
        const T sine1 = sin(shape.inclination[0]), sine2 = sin(shape.inclination[1]);
        const T first = shape.offset[0] / height - links.lower.square_over_centroid() / height * sine1;
        const T second = links.upper_centroid / height * sine2;
        shape.tension = {w1 * hypot(T(1), first), hypot(T(1), w1 * first + w2 * second)};
    }
    return shapes;
}

}  // namespace revchain
