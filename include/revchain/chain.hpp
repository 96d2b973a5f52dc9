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
///     const revchain::Chain<double> chain({revchain::plummet(1.0, 0.5),  // lowest first: weight, length
///                                          revchain::uniform_rod(2.0, 0.3)});
///     chain.total_length();                                                 // 0.8 m
///     chain.mode_count();                                                   // 2 whirl speeds
///     const auto rods = revchain::Chain<double>::uniform_rods(120, 0.36);   // a watch chain
///     rods.link(0).length;                                                  // 0.003 m
///
/// `plummet`, `uniform_rod` and `compound_pendulum` make links. Lengths and weights may be in any
/// unit; only ratios of weights matter to speeds. Numbers are stored as given. Greenhill (1908) §8.
namespace revchain::inline REVCHAIN_BUILD {

/// The exponents e of the total weight and of the largest length or centroid: division by 2^e
/// brings each to the order of 1, which prevents overflow in any units.
struct ChainUnits {
    int weight_exponent = 0;
    int length_exponent = 0;
};

/// A hanging chain of links, lowest first: link m joins pin m (lower) and pin m + 1 (upper), pin 0
/// is the free end, pin `size()` the support. The constructor checks it; a chain is immutable.
///
/// Throws InvalidArgument, naming the link (from 0, lowest first), for no links, numbers out of
/// range, a massless lowest link, a link that would stand (W h + a S <= 0, S the weight below it),
/// and lengths, centroids or radii of gyration too far apart for T (2^(max_exponent/4): 1e77 in
/// double). Cost O(N) once.
template <Real T>
class Chain {
   public:
    /// If all links are equal, one is stored. Cost: 2 ns a link, 6 ns if they differ.
    explicit Chain(const std::vector<Link<T>>& links) : Chain(links, equal_links(links)) {}

    /// `size` links from columns of `size` numbers or one.
    Chain(Index size, Column<T> weight, Column<T> length, Column<T> centroid,
          Column<Wide<T>> gyration_ratio)
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
    /// -1 or above 1000, and if the weight of the lowest link is too small for T.
    [[nodiscard]] static Chain tapered(Index count, T length, double exponent, T weight = T(1));
    /// Returns this chain with `taper` set to the exponent from which `tapered` made its links.
    /// Throws InvalidArgument if a link is not the one that `tapered` makes, to 4 ulp (if `Wide<T>`
    /// is T, to 4 + 2N). Cost: that of `tapered`.
    [[nodiscard]] Chain as_tapered(double exponent) const;

    /// The exponent of a chain that `tapered` or `as_tapered` made; no value for other chains.
    std::optional<double> taper() const noexcept { return taper_; }

    Index size() const noexcept { return size_; }
    Link<T> link(Index m) const {
        return {weight_[m], length_[m], centroid_[m], gyration_ratio_[m]};
    }
    const Column<T>& weight() const noexcept { return weight_; }
    const Column<T>& length() const noexcept { return length_; }
    const Column<T>& centroid() const noexcept { return centroid_; }
    const Column<Wide<T>>& gyration_ratio() const noexcept { return gyration_ratio_; }

    /// The number of modes, which have positive heights: N, less 1 for each massless coordinate.
    Index mode_count() const noexcept { return mode_count_; }
    T total_weight() const { return total_weight_; }
    /// Weight below link m, 0 <= m <= size(), as `Wide<T>`. If that is a double word, its error is
    /// at most that of 14 operations, and of one operation if one weight is stored for all.
    /// Cost: O(1) if m is a multiple of `segment_size`, else O(segment_size).
    [[nodiscard]] Wide<T> weight_below(Index m) const;
    /// Weights below links 0, `segment_size`, 2 `segment_size` ... and of all; empty for one
    /// weight.
    const std::vector<Wide<T>>& partial_weights() const {
        static const std::vector<Wide<T>> none;
        return partial_weights_ ? *partial_weights_ : none;
    }
    /// True if no centroid lies above its link's upper pin.
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

    friend bool operator==(const Chain& x, const Chain& y) {
        if (x.size_ != y.size_) return false;
        for (Index m = 0; m < std::max(x.distinct_links(), y.distinct_links()); ++m)
            if (!(x.link(m) == y.link(m))) return false;
        return true;
    }

   private:
    static bool equal_links(const std::vector<Link<T>>& links) {
        const auto as_first = [&](const Link<T>& link) { return link == links.front(); };
        return !links.empty() && std::all_of(links.begin(), links.end(), as_first);
    }
    template <class V>
    static Column<V> column(const std::vector<Link<T>>& links, bool equal, V Link<T>::*member);
    Chain(const std::vector<Link<T>>& links, bool equal)
        : Chain(static_cast<Index>(links.size()), column(links, equal, &Link<T>::weight),
                column(links, equal, &Link<T>::length), column(links, equal, &Link<T>::centroid),
                column(links, equal, &Link<T>::gyration_ratio)) {}

    static Chain repeated(std::string_view place, Index count, T length, T weight,
                          Link<T> (*make)(T, T));

    void check();
    void check_each_link() const;
    void check_that_links_hang(const detail::Summary<T>& centroids) const;
    Index inertialess_coordinates() const;
    /// The number of links that a check reads: one if one number is stored for all in each column.
    Index distinct_links() const {
        const bool uniform = weight_.is_scalar() && length_.is_scalar() && centroid_.is_scalar() &&
                             gyration_ratio_.is_scalar();
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
    std::optional<double> taper_;  // stays valid, because the numbers cannot change
};

}  // namespace revchain

#include "revchain/system/chain.hpp"
