// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "revchain/system/column.hpp"
#include "revchain/system/link.hpp"
#include "revchain/system/tapered_links.hpp"

/// A chain of rigid links that hangs from a firm point on the axis.
///
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5),     // weight, length; lowest link first
///                                          revchain::uniform_rod(2.0, 0.3)});
///     chain.total_length();                                                 // 0.8 m
///     chain.mode_count();                                                   // 2 whirl speeds
///     const auto rods = revchain::Chain<double>::uniform_rods(120, 0.36);   // a watch chain
///     rods.link(0).length;                                                  // 0.003 m
///
/// `plummet`, `uniform_rod` and `compound_pendulum` make links. Lengths and weights may be in any
/// unit: speeds depend on ratios of weights only. Numbers are stored exactly as given. Greenhill
/// (1908) §8.
namespace revchain::inline REVCHAIN_BUILD {

/// Powers of two that bring the total weight and the largest length to the order of 1. Scaling by
/// them is exact and prevents overflow in any units.
struct ChainUnits {
    int weight_exponent = 0;
    int length_exponent = 0;
};

/// A hanging chain of links, lowest first: link m joins pin m (lower) and pin m + 1 (upper), pin 0
/// is the free end, pin `size()` the support. The constructor checks it; a chain is immutable.
///
/// Throws InvalidArgument, naming the link (from 0, lowest first), for: no links; numbers not
/// finite; lengths <= 0; negative weights; a massless lowest link; weights whose sum overflows; a
/// link that would stand, not hang (W h + a S <= 0, S the weight below it); lengths, centroids or
/// radii of gyration too far apart for T (2^(max_exponent/4): 1e77 in double). Cost O(N) once;
/// memory one number per stored number.
template <Real T>
class Chain {
   public:
    explicit Chain(const std::vector<Link<T>>& links)
        : Chain(static_cast<Index>(links.size()), column(links, &Link<T>::weight), column(links, &Link<T>::length),
                column(links, &Link<T>::centroid), column(links, &Link<T>::gyration_ratio)) {}

    /// `size` links from columns of `size` numbers or one.
    Chain(Index size, Column<T> weight, Column<T> length, Column<T> centroid, Column<Wide<T>> gyration_ratio)
        : size_(size),
          weight_(std::move(weight)),
          length_(std::move(length)),
          centroid_(std::move(centroid)),
          gyration_ratio_(std::move(gyration_ratio)) {
        check();
    }

    /// `count` equal plummets: `length` and `weight` are those of the whole chain.
    [[nodiscard]] static Chain uniform_plummets(Index count, T length = T(1), T weight = T(1)) {
        return repeated("Chain::uniform_plummets", count, length, weight, &plummet<T>);
    }

    /// `count` equal uniform rods: `length` and `weight` are those of the whole chain.
    [[nodiscard]] static Chain uniform_rods(Index count, T length = T(1), T weight = T(1)) {
        return repeated("Chain::uniform_rods", count, length, weight, &uniform_rod<T>);
    }

    /// `count` straight links of equal length, cut from a cord whose line density is proportional
    /// to x^exponent, x from the free end. Exponent 0 gives `uniform_rods`, 1 a cord that thickens
    /// upwards; towards -1 the mass is near the free end. Greenhill (1908) §4. `length` and
    /// `weight` are those of the whole chain. Also throws InvalidArgument for an exponent not above
    /// -1 or above 1000, and if the weight of the lowest link is too small for T. Accuracy and
    /// cost: system/tapered_links.hpp.
    [[nodiscard]] static Chain tapered(Index count, T length, double exponent, T weight = T(1)) {
        constexpr std::string_view place = "Chain::tapered";
        if (!is_taper(exponent)) detail::throw_invalid(place, "exponent must be above -1 and at most 1000", exponent);
        Chain rods = repeated(place, count, length, weight, &uniform_rod<T>);
        rods.taper_ = exponent;
        if (exponent == 0) return rods;
        const T link = rods.length_[0];
        detail::TaperedLinks<T> links = detail::tapered_links<T>(count, link, exponent, weight);
        if (!(links.weight[0] >= std::numeric_limits<T>::min() / std::numeric_limits<T>::epsilon()))
            detail::throw_invalid(
                place,
                "the weight of the lowest link is too small for this scalar; use fewer links or a smaller exponent",
                exponent);
        Chain chain(count, std::move(links.weight), link, std::move(links.centroid), std::move(links.gyration_ratio));
        chain.taper_ = exponent;
        return chain;
    }
    /// Returns this chain with `taper` set to the exponent from which `tapered` made its links, as
    /// after reading them from a file. Throws InvalidArgument where a link is not one that
    /// `tapered` makes, to 4 ulp. Cost: that of `tapered`.
    [[nodiscard]] Chain as_tapered(double exponent) const;
    /// Whether `tapered` accepts this exponent.
    static bool is_taper(double exponent) { return exponent > -1 && exponent <= 1000; }

    /// The exponent of a chain that `tapered` or `as_tapered` made; no value for other chains.
    std::optional<double> taper() const noexcept { return taper_; }

    Index size() const noexcept { return size_; }
    Link<T> link(Index m) const { return {weight_[m], length_[m], centroid_[m], gyration_ratio_[m]}; }
    const Column<T>& weight() const noexcept { return weight_; }
    const Column<T>& length() const noexcept { return length_; }
    const Column<T>& centroid() const noexcept { return centroid_; }
    const Column<Wide<T>>& gyration_ratio() const noexcept { return gyration_ratio_; }

    /// The number of finite conical heights: N, less one for each coordinate that carries no
    /// inertia.
    Index mode_count() const noexcept { return mode_count_; }
    T total_weight() const { return total_weight_; }
    /// Weight below link m, 0 <= m <= size(), as `Wide<T>`. Its error is at most that of 14
    /// operations of a double word (measured: 0.27), and of one operation if all weights are one
    /// number. Cost: O(1) where m is a multiple of `segment_size`, else O(segment_size) (70 ns in
    /// double).
    [[nodiscard]] Wide<T> weight_below(Index m) const {
        const Index whole = m / detail::segment_size, rest = m % detail::segment_size;
        if (weight_.is_scalar()) return detail::times(weight_[0], m);
        if (m == size_) return partial_weights().back();
        const Wide<T>& below = partial_weights()[static_cast<std::size_t>(whole)];
        return rest == 0 ? below : below + detail::summary(weight_.data() + whole * detail::segment_size, rest).sum;
    }
    /// Weights below links 0, `segment_size`, 2 `segment_size` ... and of all links; empty if all
    /// weights are one number.
    const std::vector<Wide<T>>& partial_weights() const {
        static const std::vector<Wide<T>> none;
        return partial_weights_ ? *partial_weights_ : none;
    }
    /// Whether no centroid lies above its link's upper pin.
    bool centroids_below() const noexcept { return centroids_below_; }
    /// Whether the weights are close enough together for one unit (ratios up to 1e123 in double).
    bool has_one_weight_unit() const noexcept { return one_weight_unit_; }
    /// Straight length from the support to the free end.
    T total_length() const { return total_length_; }
    ChainUnits units() const {
        using std::frexp;
        ChainUnits units;
        frexp(total_weight_, &units.weight_exponent);
        frexp(largest_length_, &units.length_exponent);
        return units;
    }

    /// Whether the links are the same, however they are stored or were made.
    friend bool operator==(const Chain& x, const Chain& y) {
        if (x.size_ != y.size_) return false;
        for (Index m = 0; m < std::max(x.distinct_links(), y.distinct_links()); ++m)
            if (!(x.link(m) == y.link(m))) return false;
        return true;
    }

   private:
    template <class V>
    static Column<V> column(const std::vector<Link<T>>& links, V Link<T>::*member) {
        std::vector<V> values(links.size());
        std::transform(links.begin(), links.end(), values.begin(), [&](const Link<T>& link) { return link.*member; });
        return values;
    }

    static Chain repeated(std::string_view place, Index count, T length, T weight, Link<T> (*make)(T, T)) {
        if (count < 1) detail::throw_invalid(place, "count must be at least 1", count);
        detail::require_positive(place, "length", length, "weight", weight);
        const Link<T> one = make(weight / T(count), length / T(count));
        return Chain(count, one.weight, one.length, one.centroid, one.gyration_ratio);
    }

    void check();
    void check_each_link() const;
    void check_that_links_hang(const detail::Summary<T>& centroids) const;
    Index inertialess_coordinates() const;
    /// The number of links that a check reads: one if all links are the same.
    Index distinct_links() const {
        const bool uniform =
            weight_.is_scalar() && length_.is_scalar() && centroid_.is_scalar() && gyration_ratio_.is_scalar();
        return uniform ? 1 : size_;
    }

    Index size_ = 0;
    Column<T> weight_;
    Column<T> length_;
    Column<T> centroid_;
    Column<Wide<T>> gyration_ratio_;
    std::shared_ptr<const std::vector<Wide<T>>> partial_weights_;
    Index mode_count_ = 0;
    T total_weight_{};
    T total_length_{};
    T largest_length_{};  // a or |h|
    bool one_weight_unit_ = true;
    bool centroids_below_ = true;
    std::optional<double> taper_;  // stays true, because the numbers cannot change
};

namespace detail {

/// The least |x| that is not 0 in a column with the least x `given`.
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
Chain<T> Chain<T>::as_tapered(double exponent) const {
    using std::abs;
    const Chain cut = tapered(size_, total_length_, exponent, total_weight_);
    // Where there are no words to spare, the weights found from above carry a rounding of every
    // link.
    const T ulps = std::is_same_v<Wide<T>, T> ? T(4) + T(2) * T(size_) : T(4);
    const auto near = [&](const T& x, const T& y) {
        return abs(x - y) <= ulps * epsilon<T>() * abs(y) + ulps * std::numeric_limits<T>::denorm_min();
    };
    for (Index m = 0; m < std::max(distinct_links(), cut.distinct_links()); ++m) {
        const Link<T> x = link(m), y = cut.link(m);
        if (!(near(x.weight, y.weight) && near(x.length, y.length) && near(x.centroid, y.centroid) &&
              near(static_cast<T>(x.gyration_ratio), static_cast<T>(y.gyration_ratio))))
            detail::throw_invalid("Chain::as_tapered",
                                  "links[" + std::to_string(m) + "] is not as Chain::tapered makes it with exponent",
                                  exponent);
    }
    Chain chain(*this);
    chain.taper_ = exponent;
    return chain;
}

/// One vectorised pass over each column. Links are read one by one only if it finds a fault.
template <Real T>
void Chain<T>::check() {
    using std::isfinite;
    using std::ldexp;
    if (size_ < 1) detail::throw_invalid("Chain", "a chain needs at least one link", size_);
    const auto check_stored = [&](const auto& column, std::string_view name) {
        if (!column.is_scalar() && column.stored() != static_cast<std::size_t>(size_))
            detail::throw_invalid("Chain",
                                  std::string(name) + " must have one number for each of the " + std::to_string(size_) +
                                      " links or be a single number",
                                  column.stored());
    };
    check_stored(weight_, "weight"), check_stored(length_, "length");
    check_stored(centroid_, "centroid"), check_stored(gyration_ratio_, "gyration_ratio");

    std::vector<Wide<T>> partial;
    const detail::Summary<T> weights = detail::summary(weight_, size_, &partial);
    if (!partial.empty()) partial_weights_ = std::make_shared<const std::vector<Wide<T>>>(std::move(partial));
    const detail::Summary<T> lengths = detail::summary(length_, size_);
    const bool same = !centroid_.is_scalar() && centroid_.data() == length_.data();  // plummets: one column for both
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
    if (!(isfinite(weights.sum) && weights.least >= T(0) && weight_[0] > T(0) && isfinite(lengths.sum) &&
          lengths.least > T(0) && isfinite(centroids.sum) && radii))
        check_each_link();
    if (!isfinite(weights.sum))
        detail::throw_invalid("Chain", "the weights add up to infinity; use a larger unit; each weight", weight_[0]);
    if (!isfinite(lengths.sum))
        detail::throw_invalid("Chain", "the lengths add up to infinity; use a larger unit; each length", length_[0]);

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
                              "a radius of gyration is too far from its link's length for this scalar; "
                              "(radius of gyration / length)^2",
                              largest_ratio > T(1) ? largest_ratio : least_ratio);
    check_that_links_hang(centroids);
    // Every link with weight, and none with all of it in the upper pin: each holds a coordinate of
    // its own.
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
        if (m == 0 && it.weight == T(0)) detail::throw_invalid(at(m), "the lowest link must have weight", it.weight);
        detail::require_positive(at(m), "length", it.length);
        detail::require_finite(at(m), "centroid", it.centroid);
        if (!is_normalised(it.gyration_ratio) || it.gyration_ratio < Wide<T>(T(0)))
            detail::throw_invalid(at(m), "(radius of gyration / length)^2 must be finite and not negative",
                                  static_cast<T>(it.gyration_ratio));
        below = below + Wide<T>(it.weight);
        straight = straight + Wide<T>(it.length);
        if (!isfinite(below))
            detail::throw_invalid(at(m), "the weights add up to infinity; use a larger unit; its weight", it.weight);
        if (!isfinite(straight))
            detail::throw_invalid(at(m), "the lengths add up to infinity; use a larger unit; its length", it.length);
    }
}

template <Real T>
void Chain<T>::check_that_links_hang(const detail::Summary<T>& centroids) const {
    using std::frexp;
    using std::ldexp;
    if (centroids.least >= T(0) && centroid_[0] > T(0)) return;  // all terms positive
    Wide<T> below(T(0));
    for (Index m = 0; m < distinct_links(); ++m) {  // of equal links, the lowest hangs least
        if (m % detail::segment_size == 0) below = weight_below(m);
        if (!(centroid_[m] > T(0))) {  // in the unit of the larger of W and S
            int exponent = 0;
            frexp(std::max(weight_[m], static_cast<T>(below)), &exponent);
            const Wide<T> share =
                Wide<T>(ldexp(weight_[m], -exponent)) * detail::in_lengths<T>(centroid_[m], length_[m]) +
                ldexp(below, -exponent);
            if (!(share > Wide<T>(T(0))))
                detail::throw_invalid(
                    "Chain: links[" + std::to_string(m) + "]",
                    "it would stand, not hang; lower its centroid or put more weight below it: weight x centroid + "
                    "length x (weight below) must be positive",
                    ldexp(detail::times_length(share, length_[m]), exponent));
        }
        below = below + Wide<T>(weight_[m]);
    }
}

/// Nullity of the mass matrix M = sum W (y_G^2 + rho^2 s^2), counted link by link from the support
/// down. `free` is true if the current pin can move without inertia. A massless thread between two
/// rods costs no mode (the rods' own inertia holds its pins); above a plummet it does.
template <Real T>
Index Chain<T>::inertialess_coordinates() const {
    bool free = false;  // the support does not move
    Index nullity = 0;
    for (Index m = size_ - 1; m >= 0; --m) {
        const Link<T> it = link(m);
        if (it.weight == T(0)) {
            nullity += free ? 1 : 0;  // both pins at liberty: the upper one is a coordinate of its own
            free = true;
        } else if (it.gyration_ratio > Wide<T>(T(0))) {
            free = false;  // two quadratic terms hold both pins
        } else if (it.centroid == T(0)) {
            free = true;  // the upper pin is held, the lower one is not
        } else if (it.centroid == it.length) {
            nullity += free ? 1 : 0;  // only the lower pin is held
            free = false;
        }  // else one combination of the pins is held: what was free stays so
    }
    return nullity + (free ? 1 : 0);
}

}  // namespace revchain
