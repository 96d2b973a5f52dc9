// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <random>

#include "revchain/finite/balance/taylor.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::finite {

/// Where the tangent of the lowest link lies at a steady shape: in low ... high, once and nowhere twice.
template <class T>
struct Bracket {
    T low, high;
};

/// Steady shapes isolated by proof.
template <class T>
struct Isolation {
    std::vector<Bracket<T>> shapes;     ///< ascending
    std::vector<Bracket<T>> undecided;  ///< ascending: there may be shapes more in these; empty if the list is complete
    long cells = 0;                     ///< looked at
};

namespace detail {

template <Real T>
struct Part {
    T low, high;
    int low_sign, high_sign;
};

/// Whether what a function is seen to do over a cell is not much wider than at its centre alone, where nothing but
/// rounding makes it wide (or is not known at all): splitting the cell would show no more.
template <Real T>
bool rounding_rules(const Interval<T>& over, const Interval<T>& centre) {
    return !(T(4) * centre.width() < over.width());
}

/// Where ranges of tangents, or of what grows in proportion, are cut in two: 0 at the least.
template <Real T>
class Cutting {
   public:
    /// Nearly a half, at random, since a cut in the middle can meet a shape for ever.
    T share() { return T(0.45 + 0.1 * static_cast<double>(random_()) / static_cast<double>(random_.max())); }
    /// At the geometric mean where the ends differ by more than a factor of 2, and next to 0 by sixteenths.
    T between(const T& low, const T& high) {
        using std::sqrt;
        const T at = share();
        if (low == T(0)) return high / T(16);
        if (high > T(2) * low) return sqrt(low) * sqrt(high) * (T(1) + (at - T(0.5)) / T(4));
        return low + at * (high - low);
    }
    /// None where the range is narrower than `narrowest` of its upper end, or next to 0 of `last` and of 1.
    std::optional<T> between(const T& low, const T& high, const T& narrowest, const T& last) {
        const T cut = between(low, high);
        const bool narrow = low == T(0) ? high < narrowest * std::min(last, T(1))
                                        : high - low < narrowest * high || !(low < cut && cut < high);
        return narrow ? std::nullopt : std::optional<T>(cut);
    }

   private:
    std::minstd_rand random_{1};
};

/// Splits 0 ... `last` until each cell is seen to hold no shape or one, or is narrower than `narrowest` of its upper
/// end, or next to 0 of `last` and of 1. The straight chain, at 0, is left out.
template <Real T, class End = OnAxis>
Isolation<T> isolate(const std::vector<Link<Interval<T>>>& links, const Interval<T>& height, const Part<T>& whole,
                     const T& narrowest, long budget, const End& support = {}) {
    Isolation<T> found;
    std::vector<Part<T>> stack{whole};
    Cutting<T> cutting;
    while (!stack.empty()) {
        revchain::detail::look();
        const Part<T> part = stack.back();
        stack.pop_back();
        if (found.cells++ >= budget) {
            found.undecided.push_back({part.low, part.high});
            continue;
        }
        const auto end = support_offset(links, height, Cell<T, 1>(Interval<T>(part.low, part.high)), support);
        const bool from_zero = part.low == T(0) && support.is_symmetric();
        if (!from_zero && !end.value.may_vanish()) continue;
        if (!end.slope[0].may_vanish()) {
            if (from_zero) continue;  // the straight chain alone
            if (part.low_sign * part.high_sign != 0) {
                if (part.low_sign != part.high_sign) found.shapes.push_back({part.low, part.high});
                continue;
            }
        }
        const auto cut = cutting.between(part.low, part.high, narrowest, whole.high);
        if (!cut ||
            rounding_rules(from_zero ? end.slope[0] : end.value, from_zero ? end.centre_slope[0] : end.centre_value)) {
            found.undecided.push_back({part.low, part.high});
            continue;
        }
        const int sign = sign_at(links, height, *cut, support);
        stack.push_back({*cut, part.high, sign, part.high_sign});
        stack.push_back({part.low, *cut, part.low_sign, sign});
    }
    return found;
}

}  // namespace detail

}  // namespace revchain::finite
