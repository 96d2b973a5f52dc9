// SPDX-License-Identifier: MPL-2.0
#pragma once

#include "revchain/pencil/element.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// A pencil of fewer elements, for which descending eigenvalues satisfy
///
///     coarse <= exact <= coarse + spread.
template <std::floating_point T>
struct GroupedPencil {
    ElementPencil<T> pencil;
    T spread{};
};

namespace detail {

/// Neighbouring elements condensed into one by their shape without inertia. A pin inside lies at (1
/// - c/F) (lower end) + (c/F) (upper end), with c the flexibility below it and F the total.
template <std::floating_point T>
class Group {
   public:
    /// Returns the group with one more element on top. No terms cancel; cross masses would cancel.
    Group with(const Element<T>& e) const {
        Group more = *this;
        const T c = flexibility_, f = T(1) / e.stiffness, leaning = (e.cross + e.upper) * f;
        more.flexibility_ = c + f, more.weight_ += e.weight, more.size_ += 1;
        more.first_ += e.weight * c + leaning;
        more.bound_ += e.weight * c + e.upper * f;
        more.second_ += c * (e.weight * c + T(2) * leaning) + f * (e.upper * f);
        more.far_ = far_ || !(e.upper - e.turning <= T(4) * e.weight);
        return more;
    }
    Index size() const { return size_; }

    /// Returns a bound of the group's largest eigenvalue between held ends: the trace of K^-1 M.
    T spread() const {
        return size_ < 2 ? T(0) : bound_ - second_ / flexibility_ + rounding(size_) * bound_;
    }
    /// Returns true if the group's bound is at most `spread`, no number exceeds 8 lambda k, and
    /// every centroid is within twice its link's length. (8 lambda k is about the largest square of
    /// a mode's phase.)
    bool is_within(const T& spread, const T& least) const {
        return (bound_ * (T(1) + rounding(size_)) - spread) * flexibility_ <= second_ &&
               weight_ * flexibility_ <= T(8) * least && bound_ <= T(8) * least && !far_;
    }
    /// Returns the relative rounding error of a sum of n terms, each a few products.
    static T rounding(Index n) { return epsilon<T>() * T(n + 10); }

    Element<T> element() const {
        const T mean = first_ / flexibility_, square = second_ / (flexibility_ * flexibility_);
        const T beside = weight_ > T(0) ? square - mean * (mean / weight_) : T(0);
        return {T(1) / flexibility_,
                weight_ - T(2) * mean + square,
                square,
                mean - square,
                beside,
                weight_};
    }

   private:
    T flexibility_{}, weight_{};
    T first_{}, second_{}, bound_{};  // sums of mass times c, of mass times c^2, and for the trace
    bool far_ = false;                // true if a centroid is far from its link
    Index size_ = 0;
};

}  // namespace detail

/// Groups elements as long as their spread stays within `spread`; a single element is unchanged.
///
/// Restricting pins to such shapes lowers every eigenvalue (Courant, Fischer). Let t be the largest
/// eigenvalue of a group between held ends, and x = 1/lambda < 1/t. The pins inside subtract x^2 C'
/// (K_i - x M_i)^-1 C from the condensed K - x M. As C' M_i^-1 C <= M and M_i <= t K_i, that is at
/// most x^2 t/(1 - x t) M: the exact count at lambda is at most the coarse count at lambda - t.
///
/// `entry_error` includes the roundings here, relative to lambda k and the entry. Let f be the
/// flexibility of an element, q its centroid's position (|q| <= 2), and F its group's flexibility.
/// Terms are at most W, W q f/F and B f/F, each at most 8 lambda k in a group. Cross masses enter
/// as X + B = W q with an error of |X| + B <= 2 B + 2.5 W. The total is at most 120 times the
/// errors of elements and sums. Preconditions: one unit; shifts lambda >= `least`. Cost: 6 ns an
/// element.
template <std::floating_point T>
GroupedPencil<T> grouped(const ElementPencil<T>& pencil, const T& least, const T& spread) {
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
        if (group.size() > 0 && !more.is_within(spread, least)) {
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
