// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "revchain/chain/link.hpp"

namespace revchain {

/// A quantity of every link: one number each, or a single number that serves all of them (and is stored once).
template <class V>
class Column {
   public:
    Column(V value) : values_(1, std::move(value)) {}                          // NOLINT(google-explicit-constructor)
    Column(std::vector<V> values) : values_(std::move(values)), stride_(1) {}  // NOLINT(google-explicit-constructor)

    bool is_scalar() const { return stride_ == 0; }
    std::size_t stored() const { return values_.size(); }
    const V* data() const { return values_.data(); }
    const V& operator[](Index m) const { return values_[static_cast<std::size_t>(m * stride_)]; }
    friend bool operator==(const Column&, const Column&) = default;

   private:
    std::vector<V> values_;
    Index stride_ = 0;
};

/// Powers of two that bring the total weight and the largest length to the order of 1: exact, and what keeps every
/// recursion in range whatever the user's units.
struct ChainUnits {
    int weight_exponent = 0;
    int length_exponent = 0;
};

/// A hanging chain of links, lowest first: link m joins pin m (lower) and pin m + 1 (upper), pin 0 is the free end, pin
/// `size()` the support. Checked once here, immutable, and trusted by everything that reads it.
///
/// Throws InvalidArgument, naming the link (counted from 1, lowest first), for: no links; numbers that are not finite;
/// lengths <= 0; negative weights; a massless lowest link; weights whose sum overflows; a link that would stand rather
/// than hang (W h + a S <= 0, S the weight hung below it); ratios of weights or of lengths too wide for T (above
/// 2^(2 max_exponent/5) and 2^(max_exponent/4): 1e123 and 1e77 in double), beyond which products would underflow.
/// Cost O(N) once; memory one number per stored number.
template <Real T>
class Chain {
   public:
    explicit Chain(const std::vector<Link<T>>& links)
        : size_(static_cast<Index>(links.size())),
          weight_(column(links, &Link<T>::weight)),
          length_(column(links, &Link<T>::length)),
          centroid_(column(links, &Link<T>::centroid)),
          gyration_squared_(column(links, &Link<T>::gyration_squared)) {
        check();
    }

    /// `size` links from columns, each of `size` numbers or one.
    Chain(Index size, Column<T> weight, Column<T> length, Column<T> centroid, Column<Wide<T>> gyration_squared)
        : size_(size),
          weight_(std::move(weight)),
          length_(std::move(length)),
          centroid_(std::move(centroid)),
          gyration_squared_(std::move(gyration_squared)) {
        check();
    }

    /// `count` equal plummets: `length` and `weight` are those of the whole chain.
    static Chain uniform_plummets(Index count, T length = T(1), T weight = T(1)) {
        return repeated("Chain::uniform_plummets", count, length, weight, &plummet<T>);
    }

    /// `count` equal uniform rods: `length` and `weight` are those of the whole chain.
    static Chain uniform_rods(Index count, T length = T(1), T weight = T(1)) {
        return repeated("Chain::uniform_rods", count, length, weight, &uniform_rod<T>);
    }

    Index size() const { return size_; }
    Link<T> link(Index m) const { return {weight_[m], length_[m], centroid_[m], gyration_squared_[m]}; }
    const Column<T>& weight() const { return weight_; }
    const Column<T>& length() const { return length_; }
    const Column<T>& centroid() const { return centroid_; }
    const Column<Wide<T>>& gyration_squared() const { return gyration_squared_; }

    /// How many finite conical heights the chain has: N, less one for each coordinate that carries no inertia.
    Index mode_count() const { return mode_count_; }
    T total_weight() const { return total_weight_; }
    /// Straight length from the support to the free end.
    T total_length() const { return total_length_; }
    ChainUnits units() const {
        using std::frexp;
        ChainUnits units;
        frexp(total_weight_, &units.weight_exponent);
        frexp(largest_length_, &units.length_exponent);
        return units;
    }

    /// The same links, however they are stored.
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
        if (count < 1) detail::refuse(place, "count must be at least 1", count);
        detail::require_positive(place, "length", length);
        detail::require_positive(place, "weight", weight);
        const Link<T> one = make(weight / T(count), length / T(count));
        return Chain(count, one.weight, one.length, one.centroid, one.gyration_squared);
    }

    void check();
    void check_that_links_hang() const;
    /// Links that a check has to look at: one where one number of each kind serves all.
    Index distinct_links() const {
        const bool uniform =
            weight_.is_scalar() && length_.is_scalar() && centroid_.is_scalar() && gyration_squared_.is_scalar();
        return uniform ? 1 : size_;
    }
    Index inertialess_coordinates() const;

    Index size_ = 0;
    Column<T> weight_;
    Column<T> length_;
    Column<T> centroid_;
    Column<Wide<T>> gyration_squared_;
    Index mode_count_ = 0;
    T total_weight_{};
    T total_length_{};
    T largest_length_{};  // of any kind: a, |h|, rho
};

template <Real T>
void Chain<T>::check() {
    using std::abs;
    using std::isfinite;
    using std::ldexp;
    using std::sqrt;
    if (size_ < 1) detail::refuse("Chain", "a chain needs at least one link", size_);
    const auto at = [](Index m) { return "Chain: link " + std::to_string(m + 1); };
    const auto check_stored = [&](std::size_t stored, bool is_scalar, std::string_view name) {
        if (!is_scalar && stored != static_cast<std::size_t>(size_))
            detail::refuse("Chain",
                           std::string(name) + " must have one number for each of the " + std::to_string(size_) +
                               " links or be a single number",
                           stored);
    };
    check_stored(weight_.stored(), weight_.is_scalar(), "weight");
    check_stored(length_.stored(), length_.is_scalar(), "length");
    check_stored(centroid_.stored(), centroid_.is_scalar(), "centroid");
    check_stored(gyration_squared_.stored(), gyration_squared_.is_scalar(), "gyration_squared");

    T smallest_weight = std::numeric_limits<T>::infinity(), largest_weight{};
    T smallest_length = std::numeric_limits<T>::infinity();
    const auto note_length = [&](const T& x) {
        if (x == T(0)) return;
        smallest_length = std::min(smallest_length, x);
        largest_length_ = std::max(largest_length_, x);
    };
    Wide<T> below(T(0)), straight(T(0));  // weight hung below the link; length so far
    for (Index m = 0; m < distinct_links(); ++m) {
        const Link<T> it = link(m);
        if (!isfinite(it.weight) || it.weight < T(0))
            detail::refuse(at(m), "weight must be finite and not negative", it.weight);
        if (m == 0 && it.weight == T(0)) detail::refuse(at(m), "the lowest link must have weight", it.weight);
        if (!isfinite(it.length) || !(it.length > T(0)))
            detail::refuse(at(m), "length must be positive and finite", it.length);
        if (!isfinite(it.centroid)) detail::refuse(at(m), "centroid must be finite", it.centroid);
        // ... and, as a double word, normalised
        if (!isfinite(it.gyration_squared) || it.gyration_squared < Wide<T>(T(0)) ||
            !(it.gyration_squared + Wide<T>(T(0)) == it.gyration_squared))
            detail::refuse(at(m), "square of the radius of gyration must be finite and not negative",
                           static_cast<T>(it.gyration_squared));
        note_length(it.length);
        note_length(abs(it.centroid));
        note_length(sqrt(static_cast<T>(it.gyration_squared)));
        if (it.weight > T(0)) {
            smallest_weight = std::min(smallest_weight, it.weight);
            largest_weight = std::max(largest_weight, it.weight);
        }
        below = below + Wide<T>(it.weight);
        straight = straight + Wide<T>(it.length);
        if (!isfinite(below)) detail::refuse(at(m), "the weights add up to infinity, from this link's", it.weight);
        if (!isfinite(straight)) detail::refuse(at(m), "the lengths add up to infinity, from this link's", it.length);
    }
    if (distinct_links() < size_) {
        below = below * Wide<T>(T(size_));
        straight = straight * Wide<T>(T(size_));
        if (!isfinite(below)) detail::refuse("Chain", "the weights add up to infinity, each", weight_[0]);
        if (!isfinite(straight)) detail::refuse("Chain", "the lengths add up to infinity, each", length_[0]);
    }
    // Within these ratios no product of the recursions leaves the range of T, whatever its units.
    constexpr int reach = std::numeric_limits<T>::max_exponent;
    if (largest_weight / ldexp(T(1), 2 * reach / 5) > smallest_weight)
        detail::refuse("Chain", "the weights span too wide a ratio for this scalar, from " +
                                    detail::in_digits(smallest_weight) + " to " + detail::in_digits(largest_weight));
    if (largest_length_ / ldexp(T(1), reach / 4) > smallest_length)
        detail::refuse("Chain", "the lengths span too wide a ratio for this scalar, from " +
                                    detail::in_digits(smallest_length) + " to " + detail::in_digits(largest_length_));
    total_weight_ = static_cast<T>(below);
    total_length_ = static_cast<T>(straight);
    check_that_links_hang();
    mode_count_ = distinct_links() < size_ ? size_ : size_ - inertialess_coordinates();
}

template <Real T>
void Chain<T>::check_that_links_hang() const {
    using std::ldexp;
    const ChainUnits units = this->units();
    Wide<T> below(T(0));
    for (Index m = 0; m < distinct_links(); ++m) {  // of equal links, the lowest hangs least
        const T weight = ldexp(weight_[m], -units.weight_exponent);
        const Wide<T> kappa = Wide<T>(weight) * Wide<T>(ldexp(centroid_[m], -units.length_exponent)) +
                              Wide<T>(ldexp(length_[m], -units.length_exponent)) * below;
        if (!(kappa > Wide<T>(T(0))))
            detail::refuse("Chain: link " + std::to_string(m + 1),
                           "it would stand, not hang: weight x centroid + length x (weight below) must be positive",
                           ldexp(static_cast<T>(kappa), units.weight_exponent + units.length_exponent));
        below = below + Wide<T>(weight);
    }
}

/// Nullity of the mass matrix M = sum W (y_G^2 + rho^2 s^2), read off the links from the support down: `free` says
/// whether the pin reached so far can move with no inertia noticing.
/// A massless thread between two rods costs no mode (the rods' own inertia holds its pins); above a plummet it does.
template <Real T>
Index Chain<T>::inertialess_coordinates() const {
    bool free = false;  // the support does not move
    Index nullity = 0;
    for (Index m = size_ - 1; m >= 0; --m) {
        const Link<T> it = link(m);
        if (it.weight == T(0)) {
            nullity += free ? 1 : 0;  // both pins at liberty: the upper one is a coordinate of its own
            free = true;
        } else if (it.gyration_squared > Wide<T>(T(0))) {
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
