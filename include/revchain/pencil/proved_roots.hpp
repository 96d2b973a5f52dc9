// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

#include "revchain/numeric/parallel.hpp"
#include "revchain/pencil/grouped.hpp"
#include "revchain/pencil/quotient_lanes.hpp"

/// This header proves some or all roots of a pencil to the last digit, eight at a time.
namespace revchain::inline REVCHAIN_BUILD::pencil {

/// A root and the proved bound `off` of its absolute error; infinite if there is no proof.
template <std::floating_point T>
struct ProvedRoot {
    DoubleWord<T> root;
    T off;

    /// Returns the relative error bound of the rounded root. `rounded` is the error of rounding.
    T bound(const T& rounded = epsilon<T>() / T(2)) const {
        return (off / root.high + rounded) * (T(1) + T(0x1p-30));
    }
};

template <std::floating_point T>
using ProvedRoots = std::optional<std::vector<ProvedRoot<T>>>;

/// Calls f(first, there, scratch) by `parallel_for`, for `shape_lanes` of `count` roots at a time.
template <std::floating_point T, class F>
void for_lanes(std::size_t count, std::size_t links, const F& f) {
    revchain::detail::parallel_for(count, shape_lanes, [&](std::size_t begin, std::size_t end) {
        with_shapes_in_lanes<T>(links, [&](ShapesInLanes<T>& scratch) {
            for (std::size_t first = begin; first < end; first += shape_lanes) {
                revchain::detail::check_interrupt();
                f(first, std::min(shape_lanes, end - first), scratch);
            }
        });
    });
}

/// Proves the roots of Rayleigh quotients, numbers `first`, `first` + 1, ..., descending. On entry
/// `off` is the distance of `root` from the quotient's root, and an exact root lies within `reach`
/// of the latter. On return `off` is proved. Exactly these roots lie between `below` and `above`,
/// so an interval that meets no other holds one root. Its distance from the quotient is at most the
/// square of `reach` over the room to the next interval (Kato, Temple). Where intervals meet,
/// counts `certified(x)` on either side number the other roots; false if they cannot. `worst` is
/// the wanted relative error.
template <std::floating_point T, class Certified>
bool prove(std::vector<ProvedRoot<T>>& roots, const std::vector<T>& reach, Index first,
           const T& below, const T& above, const T& worst, const Certified& certified) {
    const T infinity = std::numeric_limits<T>::infinity();
    const std::size_t count = roots.size();
    // Returns one end of the interval that holds root j, with the low word and rounding.
    const auto end = [&](std::size_t j, int side) {
        const T far = (reach[j] + roots[j].off) * (T(1) + T(0x1p-20)), root = roots[j].root.high;
        return root + T(side) * (far + T(2) * epsilon<T>() * root);
    };
    if (!(end(0, 1) < above && end(count - 1, -1) > below)) return false;
    struct Gap {           // a gap above the interval of root j
        T width;           // not positive (or NaN) if the intervals meet
        T down_to, up_to;  // limits of the roots above the gap and of the roots below it
    };
    std::vector<Gap> gap(count + 1, Gap{infinity, above, below});
    for (std::size_t j = 1; j < count; ++j) {
        const T down_to = end(j - 1, -1), up_to = end(j, 1);
        gap[j] = {down_to - up_to, down_to, up_to};
    }
    // Returns true if the interval of root j meets the one above it.
    const auto meets = [&](std::size_t j) { return !(gap[j].width > T(0)); };
    // Roots that meet may lie outside their intervals: a count must prove their side of the gap.
    for (std::size_t j = 1; j < count; ++j) {
        if (meets(j) || !(meets(j - 1) || meets(j + 1))) continue;
        const T middle = gap[j].up_to + gap[j].width / T(2);
        const CertifiedCount there = certified(middle);
        if (!there.proved || there.above != first + static_cast<Index>(j)) return false;
        gap[j].down_to = gap[j].up_to = middle;
    }
    for (std::size_t j = 0; j < count; ++j) {
        const T root = roots[j].root.high, blur = roots[j].off;
        const T nearest = std::min(gap[j].down_to - root, root - gap[j + 1].up_to);
        const T room = nearest - blur - T(4) * epsilon<T>() * root;
        const T off = (reach[j] * (reach[j] / room) + blur) * (T(1) + T(0x1p-20));
        const bool proved = !meets(j) && !meets(j + 1) && room > reach[j] && off <= worst * root;
        roots[j].off = proved ? off : infinity;
    }
    return true;
}

/// Returns the roots number `first`, `first` + 1, ... next to `starts`, descending. `prove` proves
/// them, with `reach` from residuals. Preconditions: those of `quotients_in_lanes`.
template <std::floating_point T, bool Spins, class Certified>
ProvedRoots<T> proved_roots(const ElementPencil<DoubleWord<T>, Spins>& pencil, bool lumped,
                            const std::vector<T>& starts, Index first, const T& below,
                            const T& above, const T& worst, const Certified& certified) {
    const std::size_t count = starts.size();
    std::vector<ProvedRoot<T>> roots(count);
    std::vector<T> reach(count);
    for_lanes<T>(
        count, pencil.elements.size(),
        [&](std::size_t from, std::size_t there, ShapesInLanes<T>& scratch) {
            QuotientsInLanes<T> found;
            for (std::size_t i = 0; i < shape_lanes; ++i)
                found.start[i] = starts[from + std::min(i, there - 1)];
            quotients_in_lanes(pencil, lumped, scratch, found);
            for (std::size_t i = 0; i < there; ++i)
                roots[from + i] = {found.root[i], found.blur[i]}, reach[from + i] = found.reach[i];
        });
    if (!prove(roots, reach, first, below, above, worst, certified)) return std::nullopt;
    return roots;
}

/// The least number of elements, for each mode up to the last, at which groups give brackets.
/// Groups are a fifth to a third faster with 32 to 1000 elements for each mode. They are no faster
/// with 10.
inline constexpr Index least_for_groups = 32;

namespace detail {

/// Returns brackets of a few of many heights from groups of elements, each about 3 per cent wide,
/// or none if there would be too many or too few groups. Group sizes follow from the last mode's
/// height, estimated by the phase integral (WKB: a few per cent for like links). All is proved
/// later.
template <std::floating_point T>
std::vector<Bracket<T>> brackets_of_groups(const ElementPencil<T>& pencil, Index first,
                                           Index count) {
    using std::sqrt;
    const Index last = first + count;
    if (pencil.size() < least_for_groups * last) return {};
    T phase(0);
    for (const Element<T>& e : pencil.elements) phase += sqrt(e.weight / e.stiffness);
    const T each = phase / ((T(last) - T(0.25)) * std::numbers::pi_v<T>), height = each * each;
    if (!(height > T(0))) return {};  // weights are 0 or too small
    const GroupedPencil<T> groups = grouped(pencil, height / T(2), T(0.03) * height);
    if (groups.pencil.size() > pencil.size() / 3 || groups.pencil.size() < 2 * last) return {};
    std::vector<Bracket<T>> brackets = bisect(groups.pencil, first, count, T(0.004), height);
    for (Bracket<T>& bracket : brackets) {  // these factors exceed the rounding errors
        bracket.lower *= T(1) - T(0x1p-20);
        bracket.upper = (bracket.upper + groups.spread) * (T(1) + T(0x1p-20));
    }
    return brackets;
}

}  // namespace detail

/// Returns proved roots number `first` ... `first + count - 1` (from 0, descending) of `available`.
/// `counter` has a `count_above` for `bisect`, and `guess` is as there; the rest is as in
/// `proved_roots`.
template <std::floating_point T, bool Spins, class Counter, class Certified>
ProvedRoots<T> proved_range(const ElementPencil<DoubleWord<T>, Spins>& pencil,
                            const Counter& counter, const Certified& certified, Index first,
                            Index count, Index available, const T& guess, const T& worst,
                            const std::function<void(Index)>& finished) {
    const bool lumped = is_lumped(pencil);
    std::vector<Bracket<T>> brackets;
    if constexpr (std::is_same_v<Counter, ElementPencil<T>>)
        brackets = detail::brackets_of_groups(counter, first, count);
    if (brackets.empty()) {
        // Include the next root on either side, so that the outermost brackets hold one root.
        const Index before = std::min<Index>(first, 1),
                    after = std::min<Index>(available - first - count, 1);
        brackets = bisect(counter, first - before, before + count + after, T(1), guess, finished);
        brackets.erase(brackets.begin(), brackets.begin() + before);
        brackets.resize(static_cast<std::size_t>(count));
    }
    const std::vector<T> starts = approached(pencil, lumped, first, std::move(brackets));
    // Returns a point next to an end root, with a proved count, if there are other roots beyond it.
    const auto end_beside = [&](const T& start, int side, Index expected) -> std::optional<T> {
        for (const T& apart : {T(0x1p-12), T(0x1p-20)}) {
            const T end = start * (T(1) + T(side) * apart);
            const CertifiedCount there = certified(end);
            if (there.proved && there.above == expected) return end;
        }
        return std::nullopt;
    };
    std::optional<T> above = std::numeric_limits<T>::infinity(), below(0);
    if (first > 0) above = end_beside(starts.front(), 1, first);
    if (first + count < available) below = end_beside(starts.back(), -1, first + count);
    if (!above || !below) return std::nullopt;
    return proved_roots(pencil, lumped, starts, first, *below, *above, worst, certified);
}

}  // namespace revchain::pencil
