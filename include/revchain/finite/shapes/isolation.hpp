// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>
#include <random>

#include "revchain/finite/balance/taylor.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// Where the tangent of the lowest link lies at a steady shape: in low ... high, once and nowhere twice.
template <class T>
struct Bracket {
    T low, high;
};
template <class T>
bool goes_on(const Bracket<T>& part, const Bracket<T>& next) {
    return part.high == next.low;
}

/// Parts in their order, those that touch as one.
template <class Part>
std::vector<Part> joined(const std::vector<Part>& parts) {
    std::vector<Part> result;
    for (const Part& part : parts) {
        if (!result.empty() && goes_on(result.back(), part))
            result.back().high = part.high;
        else
            result.push_back(part);
    }
    return result;
}

/// Steady shapes isolated by proof.
template <class T>
struct Isolation {
    std::vector<Bracket<T>> shapes;     ///< ascending
    std::vector<Bracket<T>> undecided;  ///< ascending: there may be shapes more in these; empty if the list is complete
    long cells = 0;                     ///< looked at
};

namespace detail {

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
    /// Returns no cut where the range is narrower than `narrowest` of its upper end, or next to 0 of `last` and of 1.
    std::optional<T> between(const T& low, const T& high, const T& narrowest, const T& last) {
        const T cut = between(low, high);
        const bool narrow = low == T(0) ? high < narrowest * std::min(last, T(1))
                                        : high - low < narrowest * high || !(low < cut && cut < high);
        return narrow ? std::nullopt : std::optional<T>(cut);
    }

   private:
    std::minstd_rand random_{1};
};

/// State of a range of tangents: all its shapes are known; splitting it may decide more; rounding prevents more.
enum class Seen { settled, open, ruled_by_rounding };

/// Splits `whole` until `classify(part, cells)` finds every part settled. Calls `leave_open(part)` for parts ruled by
/// rounding, for parts narrower than `narrowest` of their upper end (next to 0 of `last` and of 1), and for what is
/// beyond the budget. Returns the number of parts looked at, to which `classify` may add.
template <class T, class Classify, class LeaveOpen>
long split(const Bracket<T>& whole, const T& last, const T& narrowest, long budget, const Classify& classify,
           const LeaveOpen& leave_open) {
    std::vector<Bracket<T>> stack{whole};
    Cutting<T> cutting;
    long cells = 0;
    while (!stack.empty()) {
        revchain::detail::look();
        const Bracket<T> part = stack.back();
        stack.pop_back();
        if (cells >= budget) {
            leave_open(part);
            continue;
        }
        ++cells;
        const Seen seen = classify(part, cells);
        if (seen == Seen::settled) continue;
        const auto cut = cutting.between(part.low, part.high, narrowest, last);
        if (!cut || seen == Seen::ruled_by_rounding) {
            leave_open(part);
            continue;
        }
        stack.push_back({*cut, part.high});
        stack.push_back({part.low, *cut});
    }
    return cells;
}

/// Splits `whole` until each part is seen to hold no shape or one. The straight chain, at 0, is left out.
template <Real T, class End = OnAxis>
Isolation<T> isolate(const EnclosedLinks<T>& links, const Interval<T>& height, const Bracket<T>& whole,
                     const T& narrowest, long budget, const End& support = {}) {
    Isolation<T> found;
    const auto classify = [&](const Bracket<T>& part, long&) {
        const auto end = support_offset(links, height, Cell<T, 1>(Interval<T>(part.low, part.high)), support);
        const bool from_zero = part.low == T(0) && support.is_symmetric();
        if (!from_zero && !end.value.may_vanish()) return Seen::settled;
        if (!end.slope[0].may_vanish()) {
            if (from_zero) return Seen::settled;  // the straight chain alone
            const int low = sign_at(links, height, part.low, support),
                      high = sign_at(links, height, part.high, support);
            if (low * high == -1) found.shapes.push_back(part);
            if (low * high != 0) return Seen::settled;
        }
        const bool rounding =
            from_zero ? rounding_rules(end.slope[0], end.centre_slope[0]) : rounding_rules(end.value, end.centre_value);
        return rounding ? Seen::ruled_by_rounding : Seen::open;
    };
    found.cells = split(whole, whole.high, narrowest, budget, classify,
                        [&](const Bracket<T>& part) { found.undecided.push_back(part); });
    return found;
}

}  // namespace detail

}  // namespace revchain::finite
