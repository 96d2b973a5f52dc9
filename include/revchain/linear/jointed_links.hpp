// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/chain/link.hpp"
#include "revchain/linear/two_links.hpp"

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
    if (!isfinite(links.upper_centroid)) refuse(place, "upper centroid must be finite", links.upper_centroid);
    if (!(links.upper_radius_of_gyration >= T(0)) || !isfinite(links.upper_radius_of_gyration))
        refuse(place, "upper radius of gyration must be finite and not negative", links.upper_radius_of_gyration);
    const T largest = max(max(links.lower.pendulum_length(), links.upper_length),
                          max(abs(links.upper_centroid), links.upper_radius_of_gyration));
    const T unit = inverse_power_near(largest);
    if (links.upper_length * unit * length_span<T>() < T(1) || links.lower.centroid * unit * length_span<T>() < T(1))
        refuse(place,
               "lengths, the lower link's pendulum length among them, must not be more than 1e77 apart; upper length",
               links.upper_length);
    const T by = inverse_power_near(max(links.lower_weight, links.upper_weight));
    if (links.lower_weight * by * length_span<T>() < T(1) || links.upper_weight * by * length_span<T>() < T(1))
        refuse(place, "weights must not be more than 1e77 apart; lower weight", links.lower_weight);
    using S = Wide<T>;  // of a bell hung below its centroid the moment is a difference
    const S w1(links.lower_weight * by), w2(links.upper_weight * by);
    const S a2(links.upper_length * unit), h2(links.upper_centroid * unit), k2(links.upper_radius_of_gyration * unit);
    const S hung = w1 * a2 + w2 * h2;  // W1 a2 (m + 1)
    if (!(hung > S(T(0))))
        refuse(place,
               "the upper link would stand, not hang: upper weight x upper centroid + upper length x lower weight "
               "must be positive, with an upper centroid of",
               links.upper_centroid);
    const CompoundLink<S> lower{S(links.lower.centroid * unit), S(links.lower.radius_of_gyration * unit)};
    const S l1 = lower.pendulum_length(), turn = w2 * (h2 * h2 + k2 * k2), pull = w1 * a2 * a2;
    return {unit, l1, (turn + pull) / hung, pull / (turn + pull) * lower.share_at_centre_of_oscillation(),
            (turn + pull * (lower.square_over_centroid() / l1)) / (turn + pull)};
}

}  // namespace detail

/// Both conical heights of two jointed links: of a2 h1/(lambda - l1) = (m + 1)(lambda - l2) + l2 - a2, §8 (14), and where
/// l2 = a2, of (lambda - l1)(lambda - l2) = l2 h1/(m + 1), (15). The lower is 0 where neither link has a radius of gyration
/// and the upper one's centroid is at its support. Accuracy: 3 ulp for every root, measured
/// (tests/cpp/finite/jointed_links.cpp).
/// Throws InvalidArgument for numbers out of range, lengths or weights more than 1e77 apart (in double), and where
/// W2 h2 + W1 a2 is not positive.
template <Real T>
HeightPair<T> jointed_links(const JointedLinks<T>& links) {
    const auto n = detail::jointed_numbers("jointed_links", links);
    const Wide<T> product = n.l1 * n.p;
    const auto roots = detail::coupled_roots<Wide<T>>(n.l1, n.p, n.share * product, n.other * product);
    return {static_cast<T>(roots[0]) / n.unit, static_cast<T>(roots[1]) / n.unit};
}

/// How far below its support a bell must carry its clapper's pin so that both swing, or whirl at any inclination, in one
/// line as if clamped, and the bell never rings:  h1 = (m + 1) l1 + m (a2 - l2), §8 (16), is
/// a2 = w (l2 - l1)/(w + l1 - h1),  w = W2 h2/W1. The height of that motion is l1 + a2.
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
        detail::refuse(place, "the clapper's pendulum length must be less than the bell's", clapper.pendulum_length());
    const T heavy = max(bell_weight, clapper_weight), w1 = clapper_weight / heavy, w2 = bell_weight / heavy;
    return w2 * bell.centroid / (w2 * bell.centroid + w1 * clapper.square_over_centroid()) * longer;
}

/// How far below its pin C a uniform rod, hung at C off its middle G, may be jointed at D and still swing, or whirl, as one
/// straight rod: CG.CD = CA^2, A the end above C, §8 (17). `pin` is CG. At D the rod does not bend.
/// Accuracy: 2.5 ulp for pins up to 0.49 length. Throws InvalidArgument unless length/6 < pin < length/2: with C
/// within the middle third, D would lie beyond the rod.
template <Real T>
T joint_without_bending(const T& length, const T& pin) {
    constexpr std::string_view place = "joint_without_bending";
    detail::require_positive(place, "length", length);
    const T above = length / T(2) - pin;  // CA
    if (!(above > T(0) && pin > length / T(6)))
        detail::refuse(place, "the pin must lie outside the middle third of the rod and within the rod", pin);
    return above / pin * above;
}

}  // namespace revchain
