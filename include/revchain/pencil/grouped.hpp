// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/element.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// A pencil of groups of elements. Each of its eigenvalues, in descending order, is a lower bound
/// of the eigenvalue of the same number of the given pencil:
///
///     coarse <= exact <= coarse + spread.
template <std::floating_point T>
struct GroupedPencil {
    ElementPencil<T> pencil;
    T spread{};
};

namespace detail {

/// Neighbouring elements condensed into one. The pins inside take the offsets that they have
/// without inertia. Let c be the flexibility between the lower end of the group and a pin inside,
/// and F the flexibility of the whole group. The offset of that pin is then the mean of the offsets
/// of the two ends, with weight 1 - c/F for the lower end and c/F for the upper one.
template <std::floating_point T>
class Group {
   public:
    /// Returns the group with one more element on top. No terms cancel; cross masses would cancel.
    Group with(const Element<T>& e) const {
        Group more = *this;
        const T c = flexibility_, f = T(1) / e.stiffness, leaning = (e.cross + e.upper) * f;
        more.flexibility_ = c + f, more.weight_ += e.weight, more.size_ += 1;
        more.first_moment_ += e.weight * c + leaning;
        more.trace_ += e.weight * c + e.upper * f;
        more.second_moment_ += c * (e.weight * c + T(2) * leaning) + f * (e.upper * f);
        more.far_ = far_ || !(e.upper - e.turning <= T(4) * e.weight);
        return more;
    }
    Index size() const { return size_; }

    /// Returns a bound of the group's largest eigenvalue between held ends: the trace of K^-1 M of
    /// the pins inside.
    T spread() const {
        return size_ < 2 ? T(0) : trace_ - second_moment_ / flexibility_ + rounding(size_) * trace_;
    }
    /// Returns true if three conditions hold: `spread` is at most `most_spread`; no mass or moment
    /// of the group, as a mass, exceeds 8 `least_shift` times the group's stiffness (about the
    /// square of the largest phase that a mode has across it); and every centroid is within two
    /// link lengths of the lower pin of its link.
    bool is_within(const T& least_shift, const T& most_spread) const {
        return (trace_ * (T(1) + rounding(size_)) - most_spread) * flexibility_ <= second_moment_ &&
               weight_ * flexibility_ <= T(8) * least_shift && trace_ <= T(8) * least_shift &&
               !far_;
    }
    /// Returns the relative rounding error of a sum of n terms, each a few products.
    static T rounding(Index n) { return epsilon<T>() * T(n + 10); }

    Element<T> element() const {
        const T mean = first_moment_ / flexibility_,
                square = second_moment_ / (flexibility_ * flexibility_);
        return {.stiffness = T(1) / flexibility_,
                .lower = weight_ - T(2) * mean + square,
                .upper = square,
                .cross = mean - square,
                .turning = weight_ > T(0) ? square - mean * (mean / weight_) : T(0),
                .weight = weight_};
    }

   private:
    T flexibility_{}, weight_{};
    T first_moment_{}, second_moment_{};  // sums of mass times c and times c^2
    T trace_{};         // as first_moment_, but each cross mass has the c of its lower pin
    bool far_ = false;  // true if a centroid is far from its link
    Index size_ = 0;
};

}  // namespace detail

/// Groups elements from the lowest on, each group as long as its spread stays within `most_spread`.
/// An element that is a group by itself is unchanged.
///
/// Restricting pins to such shapes lowers every eigenvalue (Courant, Fischer). Let K_i and M_i be
/// the stiffnesses and masses of the pins inside a group, C the masses that couple them to its
/// ends, and C^T its transpose. Let t be the largest eigenvalue of a group between held ends
/// (lambda K_i y = M_i y), and x = 1/lambda < 1/t. Elimination of the pins inside subtracts
/// x^2 C^T (K_i - x M_i)^-1 C from the condensed K - x M. As C^T M_i^-1 C <= M and M_i <= t K_i,
/// this is at most x^2 t/(1 - x t) M. So the exact count at lambda is at most the coarse count at
/// lambda - t.
///
/// `entry_error` includes the roundings made here, relative to lambda k and the entry. Let A, B, X
/// and W be the masses of an element (see `Element`), f its flexibility, q the distance of its
/// centroid from its lower pin over its length (|q| <= 2), and F the flexibility of its group.
/// Terms are at most W, W q f/F and B f/F, each at most 8 lambda k in a group of stiffness k = 1/F.
/// Cross masses enter as X + B = W q with an error of |X| + B <= 2 B + 2.5 W. The total is at most
/// 120 times the errors of elements and sums; the code takes 128 times.
/// Preconditions: the pencil is not empty and has one unit; counts are made at shifts lambda of
/// `least_shift` or more. Cost: 6 ns an element.
template <std::floating_point T>
GroupedPencil<T> grouped(const ElementPencil<T>& pencil, const T& least_shift,
                         const T& most_spread) {
    GroupedPencil<T> result;
    detail::Group<T> group;
    const Element<T>* lowest = nullptr;
    Index longest = 1;
    const auto close = [&] {
        result.pencil.elements.push_back(group.size() == 1 ? *lowest : group.element());
        result.spread = std::max(result.spread, group.spread());
        longest = std::max(longest, group.size());
    };
    for (const Element<T>& e : pencil.elements) {
        const detail::Group<T> more = group.with(e);
        if (group.size() > 0 && !more.is_within(least_shift, most_spread)) {
            close();
            group = detail::Group<T>().with(e);
        } else {
            group = more;
        }
        if (group.size() == 1) lowest = &e;
    }
    close();
    result.pencil.entry_error = pencil.entry_error;
    if (longest > 1)
        result.pencil.entry_error =
            T(128) * (pencil.entry_error + detail::Group<T>::rounding(longest));
    result.pencil.stiffness_underflow = pencil.stiffness_underflow;
    result.spread *= T(1) + result.pencil.entry_error;
    return result;
}

}  // namespace revchain::pencil
