// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <random>

#include "revchain/finite/balance/taylor.hpp"
#include "revchain/numeric/progress.hpp"

namespace revchain::inline REVCHAIN_BUILD::finite {

/// A range of tangents of the lowest link that contains exactly one steady shape.
template <class T>
struct Bracket {
    T low, high;
};
template <class T>
bool goes_on(const Bracket<T>& part, const Bracket<T>& next) {
    return part.high == next.low;
}

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

template <class T>
struct Isolation {
    std::vector<Bracket<T>> shapes;     ///< ascending
    std::vector<Bracket<T>> undecided;  ///< ascending; may contain more shapes; empty if complete
    long cells = 0;                     ///< number of cells examined
};

/// Returns true if rounding dominates an enclosure over a cell, or the enclosure is unknown. It is
/// then not much wider than at the centre, so splitting would not help.
template <Real T>
bool rounding_rules(const Interval<T>& over, const Interval<T>& centre) {
    return !(T(4) * centre.width() < over.width());
}

/// Chooses where to split ranges of numbers >= 0, such as tangents.
template <Real T>
class Cutting {
   public:
    /// Returns a random number near a half. Cuts at the middle could meet a shape again and again.
    T share() { return T(0.45 + 0.1 * as_double(random_()) / as_double(random_.max())); }
    /// Returns a cut near the geometric mean of ends a factor over 2 apart; from 0, at a sixteenth.
    T between(const T& low, const T& high) {
        using std::sqrt;
        const T at = share();
        if (low == T(0)) return high / T(16);
        if (high > T(2) * low) return sqrt(low) * sqrt(high) * (T(1) + (at - T(0.5)) / T(4));
        return low + at * (high - low);
    }
    /// Returns a cut; none if the width is below `narrowest` times `high` (from 0: min(`last`, 1)).
    std::optional<T> between(const T& low, const T& high, const T& narrowest, const T& last) {
        const T cut = between(low, high);
        const bool narrow = low == T(0)
                                ? high < narrowest * std::min(last, T(1))
                                : high - low < narrowest * high || !(low < cut && cut < high);
        return narrow ? std::nullopt : std::optional<T>(cut);
    }

   private:
    std::minstd_rand random_{1};
};

/// Visits cells and their parts until none waits, up to `batch` at once. The newest are first, so
/// that few wait; with `large_first` the oldest, so that remaining cells are small. `visit(cells,
/// wait)` decides each cell, leaves it open, or passes parts to `wait`. Once `spent()` is true, the
/// remaining cells are left open.
template <std::size_t batch = 1, bool large_first = false, class Cell, class Spent, class Visit,
          class LeaveOpen>
void each_cell(std::deque<Cell> waiting, const Spent& spent, const Visit& visit,
               const LeaveOpen& leave_open) {
    std::vector<Cell> cells;
    while (!waiting.empty()) {
        detail::check_interrupt();
        cells.clear();
        while (cells.size() < batch && !waiting.empty()) {
            cells.push_back(large_first ? waiting.front() : waiting.back());
            large_first ? waiting.pop_front() : waiting.pop_back();
        }
        if (spent())
            std::for_each(cells.begin(), cells.end(), leave_open);
        else
            visit(cells, [&](const Cell& part) { waiting.push_back(part); });
    }
}

/// The state of a range of tangents: all shapes known; undecided; undecided because of rounding.
enum class Seen { decided, open, ruled_by_rounding };

/// Splits `whole` until `classify(part, cells)` decides every part. Calls `leave_open(part)` for
/// parts ruled by rounding, too narrow (see `Cutting`) or over budget. Returns the number of cells.
template <class T, class Classify, class LeaveOpen>
long split(const Bracket<T>& whole, const T& last, const T& narrowest, long budget,
           const Classify& classify, const LeaveOpen& leave_open) {
    Cutting<T> cutting;
    long cells = 0;
    const auto visit = [&](const std::vector<Bracket<T>>& one, const auto& wait) {
        const Bracket<T>& part = one.front();
        ++cells;
        const Seen seen = classify(part, cells);
        if (seen == Seen::decided) return;
        const auto cut = cutting.between(part.low, part.high, narrowest, last);
        if (!cut || seen == Seen::ruled_by_rounding) return leave_open(part);
        wait({*cut, part.high});
        wait({part.low, *cut});
    };
    each_cell(
        std::deque{whole}, [&] { return cells >= budget; }, visit, leave_open);
    return cells;
}

/// Splits `whole` until each part has no shape or one. Leaves out the straight chain, at 0.
template <Real T, class End = OnAxis>
Isolation<T> isolate(const EnclosedLinks<T>& links, const Interval<T>& height,
                     const Bracket<T>& whole, const T& narrowest, long budget,
                     const End& support = {}) {
    Isolation<T> found;
    const auto classify = [&](const Bracket<T>& part, long&) {
        const auto end =
            support_offset(links, height, Cell<T, 1>(Interval<T>(part.low, part.high)), support);
        const bool from_zero = part.low == T(0) && support.is_symmetric();
        if (!from_zero && !end.value.may_vanish()) return Seen::decided;
        if (!end.slope[0].may_vanish()) {
            if (from_zero) return Seen::decided;  // contains only the straight chain
            const int low = sign_at(links, height, part.low, support),
                      high = sign_at(links, height, part.high, support);
            if (low * high == -1) found.shapes.push_back(part);
            if (low * high != 0) return Seen::decided;
        }
        const bool rounding = from_zero ? rounding_rules(end.slope[0], end.centre_slope[0])
                                        : rounding_rules(end.value, end.centre_value);
        return rounding ? Seen::ruled_by_rounding : Seen::open;
    };
    found.cells = split(whole, whole.high, narrowest, budget, classify,
                        [&](const Bracket<T>& part) { found.undecided.push_back(part); });
    return found;
}

}  // namespace revchain::finite
