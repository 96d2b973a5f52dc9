// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/quotient_lanes.hpp"

/// Some or all roots of a pencil to the last digit, each with a proof, eight at a time.
namespace revchain::pencil {

/// A root, and how far it may be from the exact one; infinitely far where that was not proved.
template <std::floating_point T>
struct ProvedRoot {
    DoubleWord<T> root;
    T off;
};

/// Calls f(first, count, scratch) for every eight of `count`, on `Threads::used()` threads.
template <std::floating_point T, class F>
void for_eights(std::size_t count, std::size_t links, const F& f) {
    revchain::detail::parallel_for(count, shape_lanes, [&](std::size_t begin, std::size_t end) {
        with_shapes_in_lanes<T>(links, [&](ShapesInLanes<T>& scratch) {
            for (std::size_t first = begin; first < end; first += shape_lanes) {
                revchain::detail::look();
                f(first, std::min(shape_lanes, end - first), scratch);
            }
        });
    });
}

/// The roots number `first`, `first` + 1, ... next to `starts`, descending. Proved: exactly as many roots as there are
/// starts lie between `below` and `above`, and around each start a residual shows one in an interval of its own. The
/// Rayleigh quotient is nearer to it than the square of the residual over the room to the next interval (Kato, Temple).
/// Where intervals meet, counts on either side, `certified(x)`, number the others. Nothing where they cannot, and
/// `worst`: how far a root may be off (relative) to count as proved. Preconditions as those of `quotients_in_lanes`.
template <bool spinning = false, std::floating_point T, class Certified>
std::optional<std::vector<ProvedRoot<T>>> proved_roots(const ElementPencil<DoubleWord<T>>& pencil, bool lumped,
                                                       const std::vector<T>& starts, Index first, const T& below,
                                                       const T& above, const T& worst, const Certified& certified) {
    const std::size_t count = starts.size();
    std::vector<ProvedRoot<T>> roots(count);
    std::vector<T> reach(count);
    for_eights<T>(count, pencil.elements.size(), [&](std::size_t from, std::size_t there, ShapesInLanes<T>& scratch) {
        QuotientsInLanes<T> found;
        for (std::size_t i = 0; i < shape_lanes; ++i) found.start[i] = starts[from + std::min(i, there - 1)];
        quotients_in_lanes<spinning>(pencil, lumped, scratch, found);
        for (std::size_t i = 0; i < there; ++i)
            roots[from + i] = {found.root[i], found.blur[i]}, reach[from + i] = found.reach[i];
    });
    const auto end = [&](std::size_t j, int side) {  // of the interval that holds root j
        return roots[j].root.high + T(side) * (reach[j] + roots[j].off) * (T(1) + T(0x1p-20));
    };
    if (!(end(0, 1) < above && end(count - 1, -1) > below)) return std::nullopt;
    std::vector<T> gap(count + 1);  // [j]: above the interval of root j; not positive (or NaN) where intervals meet
    for (std::size_t j = 1; j < count; ++j) gap[j] = end(j - 1, -1) - end(j, 1);
    gap[0] = gap[count] = std::numeric_limits<T>::infinity();
    const auto meets = [&](std::size_t j) { return !(gap[j] > T(0)); };  // its interval that above it
    // In each gap, where the roots above it may reach down to and those below it up to. Roots that meet need not lie in
    // their intervals: a count has to show that they are on their side of the gap.
    std::vector<T> down_to(count + 1, above), up_to(count + 1, below);
    for (std::size_t j = 1; j < count; ++j) {
        down_to[j] = end(j - 1, -1), up_to[j] = end(j, 1);
        if (meets(j) || !(meets(j - 1) || meets(j + 1))) continue;
        const T middle = up_to[j] + gap[j] / T(2);
        const CertifiedCount there = certified(middle);
        if (!there.proved || there.above != first + static_cast<Index>(j)) return std::nullopt;
        down_to[j] = up_to[j] = middle;
    }
    std::vector<T> off(count, std::numeric_limits<T>::infinity());
    for (std::size_t j = 0; j < count; ++j) {
        if (meets(j) || meets(j + 1)) continue;
        const T root = roots[j].root.high;
        const T room = std::min(down_to[j] - root, root - up_to[j + 1]) - roots[j].off - T(4) * epsilon<T>() * root;
        const T far = (reach[j] * (reach[j] / room) + roots[j].off) * (T(1) + T(0x1p-20));
        if (room > reach[j] && far <= worst * root) off[j] = far;
    }
    for (std::size_t j = 0; j < count; ++j) roots[j].off = off[j];
    return roots;
}

/// The `count` roots from number `first` on (from 0, descending), of `available`; `counter` has a `count_above` for
/// `bisect`, `guess` as there; the rest as in `proved_roots`.
template <bool spinning = false, std::floating_point T, class Counter, class Certified>
std::optional<std::vector<ProvedRoot<T>>> proved_range(const ElementPencil<DoubleWord<T>>& pencil,
                                                       const Counter& counter, const Certified& certified, Index first,
                                                       Index count, Index available, const T& guess, const T& worst,
                                                       const std::function<void(Index)>& finished) {
    const bool lumped = is_lumped(pencil);
    // With the next root on either side, so that the outermost brackets hold one root, too.
    const Index before = std::min<Index>(first, 1), after = std::min<Index>(available - first - count, 1);
    std::vector<Bracket<T>> brackets = bisect(counter, first - before, before + count + after, T(1), guess, finished);
    brackets.erase(brackets.begin(), brackets.begin() + before);
    brackets.resize(static_cast<std::size_t>(count));
    const std::vector<T> starts = approached<spinning>(pencil, lumped, first, std::move(brackets));
    // Counts next to the ends, where others lie beyond.
    constexpr T beside(0x1p-20);
    T above = std::numeric_limits<T>::infinity(), below(0);
    if (first > 0) {
        above = starts.front() * (T(1) + beside);
        const CertifiedCount there = certified(above);
        if (!there.proved || there.above != first) return std::nullopt;
    }
    if (first + count < available) {
        below = starts.back() * (T(1) - beside);
        const CertifiedCount there = certified(below);
        if (!there.proved || there.above != first + count) return std::nullopt;
    }
    return proved_roots<spinning>(pencil, lumped, starts, first, below, above, worst, certified);
}

}  // namespace revchain::pencil
