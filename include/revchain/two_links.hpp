// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>

#include "revchain/compound_link.hpp"
#include "revchain/numeric/double_word.hpp"
#include "revchain/system/link.hpp"

/// Two links, or one with something that yields: every case is a quadratic  lambda^2 - sum lambda + product = 0  in the
/// conical height, its roots taken without a difference of like numbers. Greenhill (1908) §2 and §6. No product leaves
/// the range: a height is 0 only where it is below the range itself. Accuracy: 3 ulp for every root, measured
/// (tests/cpp/paper/section_2.cpp). All throw InvalidArgument for lengths and weights that are not positive and finite,
/// unless said otherwise.
namespace revchain {

/// Two conical heights, the larger (slower) first.
template <Real T>
using HeightPair = std::array<T, 2>;

namespace detail {

/// 2^-e with 2^e near x: what lengths are multiplied by before they are squared.
template <Real T>
T inverse_power_near(const T& x) {
    using std::frexp;
    using std::ldexp;
    int exponent = 0;
    frexp(x, &exponent);
    return ldexp(T(1), std::min(-exponent, std::numeric_limits<T>::max_exponent - 1));
}

/// Roots of (lambda - p)(lambda - q) = coupling, p, q, coupling > 0 and coupling < p q given as  rest = p q - coupling.
template <Real T>
HeightPair<T> coupled_roots(const T& p, const T& q, const T& coupling, const T& rest) {
    using std::sqrt;
    const T half_difference = (p - q) / T(2), half_sum = (p + q) / T(2);
    const T larger = half_sum + sqrt(half_difference * half_difference + coupling);
    return {larger, rest / larger};
}

/// Roots of (lambda - p)(lambda - q) = coupling for numbers whose products may overflow or underflow.
template <Real T>
HeightPair<T> coupled_roots(std::string_view place, const T& p, const T& q, const Product<Wide<T>>& coupling,
                            const Product<Wide<T>>& rest) {
    using std::abs;
    using std::hypot;
    using std::max;
    const T half_difference = abs(p - q) / T(2), root = static_cast<T>(coupling.root().value());
    const T divisor = half_difference + hypot(half_difference, root);  // 0 where all is next to nothing
    const T larger = max(p, q) + (divisor > T(0) ? static_cast<T>(coupling.over(divisor).value()) : root);
    require_positive(place, "the larger height", larger);
    return {larger, static_cast<T>(rest.over(larger).value())};
}

/// The positive root of (p + lambda)(q - lambda) = coupling,  rest = p q - coupling > 0.
template <Real T>
T standing_root(const T& p_less_q, const Product<Wide<T>>& rest) {
    using std::hypot;
    const T b = p_less_q / T(2), root = hypot(b, static_cast<T>(rest.root().value()));
    return b > T(0) ? static_cast<T>(rest.over(b + root).value()) : root - b;
}

/// The upper one's share of both weights, times both threads.
template <Real T>
Product<Wide<T>> upper_share(const T& lower_weight, const T& lower_thread, const T& upper_weight,
                             const T& upper_thread) {
    using S = Wide<T>;
    using P = Product<S>;
    const P both = P::of(S(lower_weight)).plus(upper_weight);
    return P::of(S(upper_weight)).times(lower_thread).times(upper_thread).over(both);
}

/// Refuses two plummets as they are asked with: `names` are of the lower weight and thread, then the upper ones.
template <Real T>
void check_plummets(std::string_view place, const std::array<std::string_view, 4>& names, const T& lower_weight,
                    const T& lower_thread, const T& upper_weight, const T& upper_thread) {
    require_positive(place, names[0], lower_weight);
    require_positive(place, names[1], lower_thread);
    require_positive(place, names[2], upper_weight);
    require_positive(place, names[3], upper_thread);
}
inline constexpr std::array<std::string_view, 4> plummet_names{"lower weight", "lower thread", "upper weight",
                                                               "upper thread"};
inline constexpr std::array<std::string_view, 4> standing_names{"standing weight", "rod", "hung weight", "thread"};

}  // namespace detail

/// Both heights of two plummets, the lower of weight `lower_weight` on `lower_thread`. (lambda - l1)(lambda - l2) =
/// W1 l1 l2 / (W1 + W2), §2 (5).
template <Real T>
HeightPair<T> two_plummets(const T& lower_weight, const T& lower_thread, const T& upper_weight, const T& upper_thread) {
    constexpr std::string_view place = "two_plummets";
    detail::check_plummets(place, detail::plummet_names, lower_weight, lower_thread, upper_weight, upper_thread);
    const auto coupling = detail::upper_share(upper_weight, upper_thread, lower_weight, lower_thread);
    return detail::coupled_roots(place, lower_thread, upper_thread, coupling,
                                 detail::upper_share(lower_weight, lower_thread, upper_weight, upper_thread));
}

/// The same from the total length of thread 2 a, the distance x of the upper plummet from its middle (either side) and
/// mu = W1/W2. (lambda - a)^2 = (mu a^2 + x^2) / (1 + mu), §2 (6). mu < 0 is a float below, lighter than what it
/// displaces, in a fluid that turns with it: then motion exists where |x| >= a sqrt(-mu) alone (Stokes). Throws
/// InvalidArgument where it does not, for |x| >= a and for mu <= -1.
template <Real T>
HeightPair<T> two_plummets_from_the_middle(const T& half_length, const T& x, const T& weight_ratio) {
    using std::abs;
    using std::sqrt;
    constexpr std::string_view place = "two_plummets_from_the_middle";
    detail::require_positive(place, "half length", half_length);
    if (!(abs(x) < half_length)) detail::throw_invalid(place, "x must lie within the half length on either side", x);
    if (!(weight_ratio > T(-1)) || !(weight_ratio <= std::numeric_limits<T>::max()))
        detail::throw_invalid(place, "weight ratio must be greater than -1 and finite", weight_ratio);
    const T share = x / half_length, whole = T(1) + weight_ratio;
    T square = (weight_ratio + share * share) / whole;
    if (weight_ratio < T(0)) {  // a difference: formed in two words
        using S = Wide<T>;
        const T unit = detail::inverse_power_near(half_length);
        const S half(static_cast<Narrow<S>>(T(half_length * unit))), at(static_cast<Narrow<S>>(T(x * unit)));
        const S ratio(static_cast<Narrow<S>>(weight_ratio));
        square = static_cast<T>(S((ratio * half * half + at * at) / (half * half))) / whole;
    }
    if (square < T(0))
        detail::throw_invalid(
            place, "x must be at least half length sqrt(-ratio) on either side, else both heights are complex", x);
    const T larger = T(1) + sqrt(square);
    return {half_length * larger, (half_length - x) / whole / larger * ((half_length + x) / half_length)};
}

namespace detail {
/// Of a link on a thread, or on what yields as one, by `name`.
template <Real T>
HeightPair<T> hung_link(std::string_view place, std::string_view name, const T& thread, const CompoundLink<T>& link) {
    require_positive(place, name, thread);
    check(place, link);
    const auto coupling = Product<Wide<T>>{}.times(thread).times(link.centroid);
    return coupled_roots(place, link.pendulum_length(), thread, coupling, link.squares_over_centroid().times(thread));
}
}  // namespace detail

/// Both heights of a compound link hung by a thread: a boat from its davits, a bag in the hand.
/// (lambda - l)(lambda - a) = a h, §6 (11).
template <Real T>
HeightPair<T> link_on_thread(const T& thread, const CompoundLink<T>& link) {
    return detail::hung_link("link_on_thread", "thread", thread, link);
}

/// Height of the motion in which a link stands on its lowest point, balanced above a thread or a moving hand; h and l
/// upwards from that point. (l + lambda)(a - lambda) = a h, §6 (12).
template <Real T>
T standing_link(const T& thread, const CompoundLink<T>& link) {
    detail::require_positive("standing_link", "thread", thread);
    detail::check("standing_link", link);
    return detail::standing_root(T((link.centroid - thread) + link.square_over_centroid()),
                                 link.squares_over_centroid().times(thread));
}

/// The thread on which a link stands at a given height lambda: a = lambda (l + lambda) / (l + lambda - h), §6 (13).
template <Real T>
T thread_of_standing_link(const T& height, const CompoundLink<T>& link) {
    detail::require_positive("thread_of_standing_link", "height", height);
    detail::check("thread_of_standing_link", link);
    const Wide<T> rest = link.squares_over_centroid().value() + Wide<T>(height);
    using P = detail::Product<Wide<T>>;
    return static_cast<T>(P::of(rest + Wide<T>(link.centroid)).over(rest).times(height).value());
}

/// Height of a plummet that stands above another on a stiff weightless rod, the lower one hung by a thread:
/// (l1 + lambda)(l2 - lambda) = W1 l1 l2 / (W1 + W2), §2 (8). For small inclinations there always is one.
template <Real T>
T standing_plummet(const T& standing_weight, const T& rod, const T& hung_weight, const T& thread) {
    detail::check_plummets("standing_plummet", detail::standing_names, standing_weight, rod, hung_weight, thread);
    return detail::standing_root(T(rod - thread), detail::upper_share(standing_weight, rod, hung_weight, thread));
}

/// What a spring of stiffness E yields to the weight hung from it, W/E: it moves as a thread of that length does, §2
/// (7).
template <Real T>
T spring_deflection(const T& weight, const T& stiffness) {
    detail::require_positive("spring_deflection", "weight", weight);
    detail::require_positive("spring_deflection", "stiffness", stiffness);
    return weight / stiffness;
}

/// Both heights of a link whose support yields sideways: exactly those of a thread as long as the spring's deflection.
/// The paper's lambda = l + c is the first order, and that for a plummet.
template <Real T>
HeightPair<T> link_on_spring(const T& deflection, const CompoundLink<T>& link) {
    return detail::hung_link("link_on_spring", "deflection", deflection, link);
}

/// By how much a clock is slow, seconds a day, whose pendulum hangs from a support that yields by `deflection` to its
/// weight: 86400 (1 - sqrt(l / lambda)) for a clock right on a firm one. Accuracy: 8 ulp however small, and however
/// near deflection and pendulum length l are.
template <Real T>
T seconds_lost_per_day(const T& deflection, const CompoundLink<T>& link) {
    using std::max;
    using std::sqrt;
    detail::require_positive("seconds_lost_per_day", "deflection", deflection);
    detail::check("seconds_lost_per_day", link);
    const T unit = detail::inverse_power_near(max(deflection, link.pendulum_length()));
    const T l = link.pendulum_length() * unit, c = deflection * unit;
    const T half = detail::pendulum_difference(CompoundLink<T>{deflection, T(0)}, link) * unit / T(2);
    const T coupling = c * (link.centroid * unit), root = sqrt(half * half + coupling);
    const T whole_square = l + (half < T(0) ? coupling / (root - half) : half + root),
            whole = sqrt(whole_square);  // lambda
    const T over = whole * (whole + sqrt(l));
    // 86400 (lambda - l) / over, the day first: what the rest is may be below the range
    return half < T(0) ? T(86400) * c * (link.centroid * unit / (root - half)) / over
                       : T(86400) * ((half + root) / over);
}

}  // namespace revchain

/// Any two links jointed together, a bell and its clapper among them. Greenhill (1908) §8 (13)-(17).
namespace revchain {

/// Two jointed links; weights and lengths in any units. Suffix 1 of the paper is `lower`, 2 `upper`.
template <Real T>
struct JointedLinks {
    T lower_weight;              ///< W1 > 0
    CompoundLink<T> lower;       ///< h1, k1
    T upper_weight;              ///< W2 > 0
    T upper_length;              ///< a2 > 0, from the support to the joint
    T upper_centroid;            ///< h2, from the support; negative where it lies above, as a bell's may
    T upper_radius_of_gyration;  ///< k2 >= 0, about the centroid
};

namespace detail {

/// With m = W2 h2/(W1 a2), (14) is  (lambda sec d1 - l1)(lambda sec d2 - p) = c,  p = (m l2 + a2)/(m + 1),
/// c = a2 h1/(m + 1). Lengths times `unit`, a power of two. In two words.
template <Real T>
struct JointedNumbers {
    T unit;
    Wide<T> l1, p;
    Wide<T> share, other;  ///< c/(l1 p) and 1 - c/(l1 p), without a difference
};

template <Real T>
JointedNumbers<T> jointed_numbers(std::string_view place, const JointedLinks<T>& links) {
    using std::abs;
    using std::isfinite;
    using std::max;
    require_positive(place, "lower weight", links.lower_weight);
    check(place, links.lower);
    require_positive(place, "upper weight", links.upper_weight);
    require_positive(place, "upper length", links.upper_length);
    if (!isfinite(links.upper_centroid)) throw_invalid(place, "upper centroid must be finite", links.upper_centroid);
    if (!(links.upper_radius_of_gyration >= T(0)) || !isfinite(links.upper_radius_of_gyration))
        throw_invalid(place, "upper radius of gyration must be finite and not negative",
                      links.upper_radius_of_gyration);
    const T largest = max(max(links.lower.pendulum_length(), links.upper_length),
                          max(abs(links.upper_centroid), links.upper_radius_of_gyration));
    const T unit = inverse_power_near(largest);
    if (links.upper_length * unit * length_span<T>() < T(1) || links.lower.centroid * unit * length_span<T>() < T(1))
        throw_invalid(
            place,
            "lengths, the lower link's pendulum length among them, must not be more than 1e77 apart; upper length",
            links.upper_length);
    const T by = inverse_power_near(max(links.lower_weight, links.upper_weight));
    if (links.lower_weight * by * length_span<T>() < T(1) || links.upper_weight * by * length_span<T>() < T(1))
        throw_invalid(place, "weights must not be more than 1e77 apart; lower weight", links.lower_weight);
    using S = Wide<T>;  // of a bell hung below its centroid the moment is a difference
    const S w1(links.lower_weight * by), w2(links.upper_weight * by);
    const S a2(links.upper_length * unit), h2(links.upper_centroid * unit), k2(links.upper_radius_of_gyration * unit);
    const S hung = w1 * a2 + w2 * h2;  // W1 a2 (m + 1)
    if (!(hung > S(T(0))))
        throw_invalid(
            place,
            "the upper link would stand, not hang: upper weight x upper centroid + upper length x lower weight "
            "must be positive, with an upper centroid of",
            links.upper_centroid);
    const CompoundLink<S> lower{S(links.lower.centroid * unit), S(links.lower.radius_of_gyration * unit)};
    const S l1 = lower.pendulum_length(), turn = w2 * (h2 * h2 + k2 * k2), pull = w1 * a2 * a2;
    return {unit, l1, (turn + pull) / hung, pull / (turn + pull) * lower.share_at_centre_of_oscillation(),
            (turn + pull * (lower.square_over_centroid() / l1)) / (turn + pull)};
}

}  // namespace detail

/// Both conical heights of two jointed links: of a2 h1/(lambda - l1) = (m + 1)(lambda - l2) + l2 - a2, §8 (14), and
/// where l2 = a2, of (lambda - l1)(lambda - l2) = l2 h1/(m + 1), (15). The lower is 0 where neither link has a radius
/// of gyration and the upper one's centroid is at its support. Accuracy: 3 ulp for every root, measured
/// (tests/cpp/two_links.cpp).
/// Throws InvalidArgument for numbers out of range, lengths or weights more than 1e77 apart (in double), and where
/// W2 h2 + W1 a2 is not positive.
template <Real T>
HeightPair<T> jointed_links(const JointedLinks<T>& links) {
    const auto n = detail::jointed_numbers("jointed_links", links);
    const Wide<T> product = n.l1 * n.p;
    const auto roots = detail::coupled_roots<Wide<T>>(n.l1, n.p, n.share * product, n.other * product);
    return {static_cast<T>(roots[0]) / n.unit, static_cast<T>(roots[1]) / n.unit};
}

/// How far below its support a bell must carry its clapper's pin so that both swing, or whirl at any inclination, in
/// one line as if clamped, and the bell never rings:  h1 = (m + 1) l1 + m (a2 - l2), §8 (16), is a2 = w (l2 - l1)/(w +
/// l1 - h1),  w = W2 h2/W1. The height of that motion is l1 + a2.
/// Accuracy: 4 ulp, for the data as given, however near l1 and l2 are; the pin changes by up to
/// 3 (l1 + l2)/(l2 - l1) + 6 times as much as the data, in ratio. Throws InvalidArgument for numbers out of range, and
/// where the clapper's pendulum length is not the shorter: then every pin lets it ring.
template <Real T>
T pin_of_silent_clapper(const T& bell_weight, const CompoundLink<T>& bell, const T& clapper_weight,
                        const CompoundLink<T>& clapper) {
    constexpr std::string_view place = "pin_of_silent_clapper";
    detail::require_positive(place, "bell weight", bell_weight);
    detail::check(place, bell);
    detail::require_positive(place, "clapper weight", clapper_weight);
    detail::check(place, clapper);
    using std::max;
    const T longer = detail::pendulum_difference(bell, clapper);
    if (!(longer > T(0)))
        detail::throw_invalid(place, "the clapper's pendulum length must be less than the bell's",
                              clapper.pendulum_length());
    const T heavy = max(bell_weight, clapper_weight), w1 = clapper_weight / heavy, w2 = bell_weight / heavy;
    return w2 * bell.centroid / (w2 * bell.centroid + w1 * clapper.square_over_centroid()) * longer;
}

/// How far below its pin C a uniform rod, hung at C off its middle G, may be jointed at D and still swing, or whirl, as
/// one straight rod: CG.CD = CA^2, A the end above C, §8 (17). `pin` is CG. At D the rod does not bend.
/// Accuracy: 2.5 ulp for pins up to 0.49 length. Throws InvalidArgument unless length/6 < pin < length/2: with C
/// within the middle third, D would lie beyond the rod.
template <Real T>
T joint_without_bending(const T& length, const T& pin) {
    constexpr std::string_view place = "joint_without_bending";
    detail::require_positive(place, "length", length);
    const T above = length / T(2) - pin;  // CA
    if (!(above > T(0) && pin > length / T(6)))
        detail::throw_invalid(place, "the pin must lie outside the middle third of the rod and within the rod", pin);
    return above / pin * above;
}

}  // namespace revchain
