// SPDX-License-Identifier: MPL-2.0
// Defines what two_links.hpp declares.
#pragma once

#include "revchain/compound_link.hpp"
#include "revchain/paper/two_links_shapes.hpp"
#include "revchain/system/link.hpp"

namespace revchain::inline REVCHAIN_BUILD {

template <Real T>
struct JointedLinks;  // two_links.hpp

namespace detail {

/// 2^-e with 2^e near x. Lengths are multiplied by it before they are squared.
template <Real T>
T inverse_power_near(const T& x) {
    using std::frexp, std::ldexp;
    int exponent = 0;
    frexp(x, &exponent);
    return ldexp(T(1), std::min(-exponent, std::numeric_limits<T>::max_exponent - 1));
}

/// Roots of (lambda - p)(lambda - q) = coupling, the larger first, for positive numbers with
/// rest = p q - coupling > 0.
template <Real T>
std::array<T, 2> coupled_roots(const T& p, const T& q, const T& coupling, const T& rest) {
    using std::sqrt;
    const T half_difference = (p - q) / T(2), half_sum = (p + q) / T(2);
    const T larger = half_sum + sqrt(half_difference * half_difference + coupling);
    return {larger, rest / larger};
}

/// Roots of the same equation for numbers whose products may overflow or underflow.
template <Real T>
std::array<T, 2> coupled_roots(std::string_view place, const T& p, const T& q,
                               const Product<Wide<T>>& coupling, const Product<Wide<T>>& rest) {
    using std::abs, std::hypot, std::max;
    const T half_difference = abs(p - q) / T(2), root = static_cast<T>(coupling.root().value());
    const T divisor =
        half_difference + hypot(half_difference, root);  // 0 where all numbers are tiny
    const T larger =
        max(p, q) + (divisor > T(0) ? static_cast<T>(coupling.over(divisor).value()) : root);
    require_positive(place, "the larger height", larger);
    return {larger, static_cast<T>(rest.over(larger).value())};
}

/// The positive root of (p + lambda)(q - lambda) = coupling with rest = p q - coupling > 0.
template <Real T>
T standing_root(const T& p_less_q, const Product<Wide<T>>& rest) {
    using std::hypot;
    const T b = p_less_q / T(2), root = hypot(b, static_cast<T>(rest.root().value()));
    return b > T(0) ? static_cast<T>(rest.over(b + root).value()) : root - b;
}

/// The upper plummet's share of both weights, times both threads.
template <Real T>
Product<Wide<T>> upper_share(const T& lower_weight, const T& lower_thread, const T& upper_weight,
                             const T& upper_thread) {
    using P = Product<Wide<T>>;
    const P both = P::of(Wide<T>(lower_weight)).plus(upper_weight);
    return P::of(Wide<T>(upper_weight)).times(lower_thread).times(upper_thread).over(both);
}

/// Heights of a link on a thread, or on a spring that yields as the thread called `name`.
template <Real T>
std::array<T, 2> hung_link(std::string_view place, std::string_view name, const T& thread,
                           const CompoundLink<T>& link) {
    require_positive(place, name, thread);
    check(place, link);
    const auto coupling = Product<Wide<T>>{}.times(thread).times(link.centroid);
    return coupled_roots(place, link.pendulum_length(), thread, coupling,
                         squares_over_centroid(link).times(thread));
}

/// With m = W2 h2/(W1 a2), §8 (14) is (lambda sec d1 - l1)(lambda sec d2 - p) = c, p = (m l2 +
/// a2)/(m + 1), c = a2 h1/(m + 1). Lengths are times `unit`, a power of two.
template <Real T>
struct JointedNumbers {
    T unit;
    Wide<T> l1, p;
    Wide<T> share, other;  ///< c/(l1 p) and 1 - c/(l1 p), without a difference
};

template <Real T>
JointedNumbers<T> jointed_numbers(std::string_view place, const JointedLinks<T>& links) {
    using std::abs, std::max;
    require_positive(place, "lower weight", links.lower_weight);
    check(place, links.lower);
    require_positive(place, "upper weight", links.upper_weight, "upper length", links.upper_length);
    require_finite(place, "upper centroid", links.upper_centroid);
    require_not_negative(place, "upper radius of gyration", links.upper_radius_of_gyration);
    const T unit =
        inverse_power_near(max(max(links.lower.pendulum_length(), links.upper_length),
                               max(abs(links.upper_centroid), links.upper_radius_of_gyration)));
    const T by = inverse_power_near(max(links.lower_weight, links.upper_weight));
    const auto too_small = [](const T& share) { return share * length_span<T>() < T(1); };
    if (too_small(links.upper_length * unit) || too_small(links.lower.centroid * unit))
        throw_invalid(place,
                      "lengths, the lower link's pendulum length among them, must not be more than "
                      "1e77 apart; upper length",
                      links.upper_length);
    if (too_small(links.lower_weight * by) || too_small(links.upper_weight * by))
        throw_invalid(place, "weights must not be more than 1e77 apart; lower weight",
                      links.lower_weight);
    using S = Wide<T>;  // the moment of a bell hung below its centroid is a difference
    const S w1(links.lower_weight * by), w2(links.upper_weight * by);
    const S a2(links.upper_length * unit), h2(links.upper_centroid * unit),
        k2(links.upper_radius_of_gyration * unit);
    const S hung = w1 * a2 + w2 * h2;  // W1 a2 (m + 1)
    if (!(hung > S(T(0))))
        throw_invalid(place,
                      "the upper link would stand, not hang: upper weight x upper centroid + upper "
                      "length x lower weight must be positive; upper centroid",
                      links.upper_centroid);
    const CompoundLink<S> lower{S(links.lower.centroid * unit),
                                S(links.lower.radius_of_gyration * unit)};
    const S l1 = lower.pendulum_length(), turn = w2 * (h2 * h2 + k2 * k2), pull = w1 * a2 * a2;
    return {unit, l1, (turn + pull) / hung,
            pull / (turn + pull) * lower.share_at_centre_of_oscillation(),
            (turn + pull * (lower.square_over_centroid() / l1)) / (turn + pull)};
}

/// Two plummets at the speed with this conical height. Callers check the numbers.
template <Real T>
Pair<T> plummet_pair(std::string_view place, const T& lower_weight, const T& lower_thread,
                     const T& upper_weight, const T& upper_thread, const T& height) {
    using S = Wide<T>;
    const T unit = inverse_power_near(std::max(lower_weight, upper_weight));
    const S w1(lower_weight * unit), w2(upper_weight * unit), both = w1 + w2;
    return pair_of(place, S(lower_thread), S(upper_thread), S(w1 / both), S(w2 / both), height);
}

/// A compound link on a thread at the speed with this conical height.
template <Real T>
Pair<T> link_pair(std::string_view place, const T& thread, const CompoundLink<T>& link,
                  const T& height) {
    using S = Wide<T>;
    require_positive(place, "thread", thread);
    check(place, link);
    require_positive(place, "height", height);
    const CompoundLink<S> body{S(link.centroid), S(link.radius_of_gyration)};
    const S length = body.pendulum_length();
    return pair_of(place, length, S(thread), body.share_at_centre_of_oscillation(),
                   S(body.square_over_centroid() / length), height);
}

}  // namespace detail
}  // namespace revchain
