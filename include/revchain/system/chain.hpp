// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "revchain/chain.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

/// Returns the least non-zero |x| of a column. `given` is the least x of that column.
template <Real T>
T least_size(const Column<T>& column, const T& given) {
    using std::abs;
    if (given > T(0)) return given;
    T least = std::numeric_limits<T>::infinity();
    for (std::size_t m = 0; m < column.stored(); ++m) {
        const T x = abs(column.data()[m]);
        if (x > T(0) && x < least) least = x;
    }
    return least;
}

}  // namespace detail

template <Real T>
Chain<T> Chain<T>::tapered(Index count, T length, double exponent, T weight) {
    constexpr std::string_view place = "Chain::tapered";
    if (!(exponent > -1 && exponent <= 1000))
        detail::throw_invalid(place, "exponent must be above -1 and at most 1000", exponent);
    Chain rods = repeated(place, count, length, weight, &uniform_rod<T>);
    rods.taper_ = exponent;
    if (exponent == 0) return rods;
    const T link = rods.length_[0];
    detail::TaperedLinks<T> links = detail::tapered_links<T>(count, link, exponent, weight);
    if (!(links.weight[0] >= std::numeric_limits<T>::min() / std::numeric_limits<T>::epsilon()))
        detail::throw_invalid(place,
                              "the weight of the lowest link is too small for this scalar; use "
                              "fewer links or a smaller exponent",
                              exponent);
    Chain chain(count, std::move(links.weight), link, std::move(links.centroid),
                std::move(links.gyration_ratio));
    chain.taper_ = exponent;
    return chain;
}

template <Real T>
Wide<T> Chain<T>::weight_below(Index m) const {
    const Index whole = m / detail::segment_size, rest = m % detail::segment_size;
    if (weight_.is_scalar()) return detail::times(weight_[0], m);
    if (m == size_) return partial_weights().back();
    const Wide<T>& below = partial_weights()[static_cast<std::size_t>(whole)];
    const T* const part = weight_.data() + whole * detail::segment_size;
    return rest == 0 ? below : below + detail::summary(part, rest).sum;
}

template <Real T>
Chain<T> Chain<T>::repeated(std::string_view place, Index count, T length, T weight,
                            Link<T> (*make)(T, T)) {
    if (count < 1) detail::throw_invalid(place, "count must be at least 1", count);
    detail::require_positive(place, "length", length, "weight", weight);
    const Link<T> one = make(weight / T(count), length / T(count));
    return Chain(count, one.weight, one.length, one.centroid, one.gyration_ratio);
}

template <Real T>
template <class V>
Column<V> Chain<T>::column(const std::vector<Link<T>>& links, bool equal, V Link<T>::*member) {
    if (equal) return links.front().*member;
    std::vector<V> values(links.size());
    std::transform(links.begin(), links.end(), values.begin(),
                   [&](const Link<T>& link) { return link.*member; });
    return values;
}

template <Real T>
Chain<T> Chain<T>::as_tapered(double exponent) const {
    using std::abs;
    const Chain cut = tapered(size_, total_length_, exponent, total_weight_);
    // Weights are computed from the support down. If `Wide<T>` is T, they collect one rounding
    // error per link.
    const T ulps = std::is_same_v<Wide<T>, T> ? T(4) + T(2) * T(size_) : T(4);
    const auto near = [&](const T& x, const T& y) {
        return abs(x - y) <=
               ulps * epsilon<T>() * abs(y) + ulps * std::numeric_limits<T>::denorm_min();
    };
    for (Index m = 0; m < std::max(distinct_links(), cut.distinct_links()); ++m) {
        const Link<T> x = link(m), y = cut.link(m);
        if (!(near(x.weight, y.weight) && near(x.length, y.length) &&
              near(x.centroid, y.centroid) &&
              near(static_cast<T>(x.gyration_ratio), static_cast<T>(y.gyration_ratio))))
            detail::throw_invalid(
                "Chain::as_tapered",
                "links[" + std::to_string(m) + "] is not as Chain::tapered makes it with exponent",
                exponent);
    }
    Chain chain(*this);
    chain.taper_ = exponent;
    return chain;
}

/// Checks each column in one vectorised pass. Links are read one by one only if it finds a fault.
template <Real T>
void Chain<T>::check() {
    using std::isfinite;
    using std::ldexp;
    if (size_ < 1) detail::throw_invalid("Chain", "a chain needs at least one link", size_);
    const auto check_stored = [&](const auto& column, std::string_view name) {
        if (!column.is_scalar() && column.stored() != static_cast<std::size_t>(size_))
            detail::throw_invalid("Chain",
                                  std::string(name) + " must have one number for each of the " +
                                      std::to_string(size_) + " links or be a single number",
                                  column.stored());
    };
    check_stored(weight_, "weight"), check_stored(length_, "length");
    check_stored(centroid_, "centroid"), check_stored(gyration_ratio_, "gyration_ratio");

    std::vector<Wide<T>> partial;
    const detail::Summary<T> weights = detail::summary(weight_, size_, &partial);
    if (!partial.empty())
        partial_weights_ = std::make_shared<const std::vector<Wide<T>>>(std::move(partial));
    const detail::Summary<T> lengths = detail::summary(length_, size_);
    const bool same = !centroid_.is_scalar() && centroid_.data() == length_.data();  // plummets
    const detail::Summary<T> centroids = same ? lengths : detail::summary(centroid_, size_);
    centroids_below_ = centroids.least >= T(0);
    bool radii = true, all_turn = true;
    T least_ratio = std::numeric_limits<T>::infinity(), largest_ratio{};
    for (std::size_t m = 0; m < gyration_ratio_.stored(); ++m) {
        const Wide<T>& ratio = gyration_ratio_.data()[m];
        const T size = static_cast<T>(ratio);
        radii = radii && is_normalised(ratio) && size >= T(0);
        all_turn = all_turn && size > T(0);
        if (size > T(0) && size < least_ratio) least_ratio = size;
        if (size > largest_ratio) largest_ratio = size;
    }
    if (!(isfinite(weights.sum) && weights.least >= T(0) && weight_[0] > T(0) &&
          isfinite(lengths.sum) && lengths.least > T(0) && isfinite(centroids.sum) && radii))
        check_each_link();
    if (!isfinite(weights.sum))
        detail::throw_invalid(
            "Chain", "the weights add up to infinity; use a larger unit; each weight", weight_[0]);
    if (!isfinite(lengths.sum))
        detail::throw_invalid(
            "Chain", "the lengths add up to infinity; use a larger unit; each length", length_[0]);

    total_weight_ = static_cast<T>(weights.sum);
    total_length_ = static_cast<T>(lengths.sum);
    one_weight_unit_ = total_weight_ * ldexp(T(1), -2 * std::numeric_limits<T>::max_exponent / 5) <=
                       detail::least_size(weight_, weights.least);
    const T least_length = std::min(lengths.least, detail::least_size(centroid_, centroids.least));
    const T span = detail::length_span<T>();
    largest_length_ = std::max(lengths.most, centroids.most);
    if (largest_length_ / span > least_length)
        detail::throw_invalid("Chain", "the lengths span too wide a ratio for this scalar, from " +
                                           detail::in_digits(least_length) + " to " +
                                           detail::in_digits(largest_length_));
    if (largest_ratio / span > span || least_ratio < T(1) / span / span)
        detail::throw_invalid("Chain",
                              "a radius of gyration is too far from its link's length for this "
                              "scalar; (radius of gyration / length)^2",
                              largest_ratio > T(1) ? largest_ratio : least_ratio);
    check_that_links_hang(centroids);
    // Each link has a coordinate of its own if all links have weight and none has all of it in the
    // upper pin.
    const bool all_hold = weights.least > T(0) && (centroids.least > T(0) || all_turn);
    mode_count_ = all_hold || distinct_links() < size_ ? size_ : size_ - inertialess_coordinates();
}

/// Throws InvalidArgument that names the first link at fault, if there is one.
template <Real T>
void Chain<T>::check_each_link() const {
    using std::isfinite;
    const auto at = [](Index m) { return "Chain: links[" + std::to_string(m) + "]"; };
    Wide<T> below(T(0)), straight(T(0));
    for (Index m = 0; m < distinct_links(); ++m) {
        const Link<T> it = link(m);
        detail::require_not_negative(at(m), "weight", it.weight);
        if (m == 0 && it.weight == T(0))
            detail::throw_invalid(at(m), "the lowest link must have weight", it.weight);
        detail::require_positive(at(m), "length", it.length);
        detail::require_finite(at(m), "centroid", it.centroid);
        if (!is_normalised(it.gyration_ratio) || it.gyration_ratio < Wide<T>(T(0)))
            detail::throw_invalid(at(m),
                                  "(radius of gyration / length)^2 must be finite and not negative",
                                  static_cast<T>(it.gyration_ratio));
        below = below + Wide<T>(it.weight);
        straight = straight + Wide<T>(it.length);
        if (!isfinite(below))
            detail::throw_invalid(
                at(m), "the weights add up to infinity; use a larger unit; its weight", it.weight);
        if (!isfinite(straight))
            detail::throw_invalid(
                at(m), "the lengths add up to infinity; use a larger unit; its length", it.length);
    }
}

template <Real T>
void Chain<T>::check_that_links_hang(const detail::Summary<T>& centroids) const {
    using std::frexp;
    using std::ldexp;
    if (centroids.least >= T(0) && centroid_[0] > T(0)) return;  // all terms positive
    Wide<T> below(T(0));
    for (Index m = 0; m < distinct_links(); ++m) {  // if the lowest of equal links hangs, all do
        if (m % detail::segment_size == 0) below = weight_below(m);
        if (!(centroid_[m] > T(0))) {  // scaled by the larger of W and S
            int exponent = 0;
            frexp(std::max(weight_[m], static_cast<T>(below)), &exponent);
            const Wide<T> share = Wide<T>(ldexp(weight_[m], -exponent)) *
                                      detail::in_lengths<T>(centroid_[m], length_[m]) +
                                  ldexp(below, -exponent);
            if (!(share > Wide<T>(T(0))))
                detail::throw_invalid(
                    "Chain: links[" + std::to_string(m) + "]",
                    "it would stand, not hang; lower its centroid or put more weight below it: "
                    "weight x centroid + length x (weight below) must be positive",
                    ldexp(detail::times_length(share, length_[m]), exponent));
        }
        below = below + Wide<T>(weight_[m]);
    }
}

/// Returns the nullity of the mass matrix M = sum W (y_G^2 + rho^2 s^2), counted link by link from
/// the support down. `free` is true if the current pin can move without inertia. A massless thread
/// between two rods costs no mode, because the rods' own inertia holds its pins. A massless thread
/// above a plummet costs one.
template <Real T>
Index Chain<T>::inertialess_coordinates() const {
    bool free = false;  // the support does not move
    Index nullity = 0;
    for (Index m = size_ - 1; m >= 0; --m) {
        const Link<T> it = link(m);
        if (it.weight == T(0)) {
            nullity += free ? 1 : 0;  // both pins are free: the upper one is a coordinate
            free = true;
        } else if (it.gyration_ratio > Wide<T>(T(0))) {
            free = false;  // two quadratic terms hold both pins
        } else if (it.centroid == T(0)) {
            free = true;  // the upper pin is held, the lower one is not
        } else if (it.centroid == it.length) {
            nullity += free ? 1 : 0;  // only the lower pin is held
            free = false;
        }  // else one combination of the pins is held, and `free` does not change
    }
    return nullity + (free ? 1 : 0);
}

namespace detail {

/// Throws InvalidArgument if the ratio of two weights exceeds 1e123 (in double).
template <Real T>
void require_one_weight_unit(std::string_view place, const Chain<T>& chain) {
    if (chain.has_one_weight_unit()) return;
    T least = chain.total_weight();
    for (Index m = 0; m < chain.size(); ++m)
        if (const T weight = chain.link(m).weight; weight > T(0)) least = std::min(least, weight);
    throw_invalid(place, "weights must not be more than 1e123 apart here; the smallest is", least);
}

}  // namespace detail

}  // namespace revchain
