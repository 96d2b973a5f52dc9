// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "revchain/numeric/large_memory.hpp"
#include "revchain/pencil/forces_in_lanes.hpp"
#include "revchain/pencil/twisted.hpp"

/// This header computes eigenvectors of several modes at once: twisted factorisations in plain
/// arithmetic, one mode a lane, and one correction from residual forces in twice the digits.
namespace revchain::inline REVCHAIN_BUILD::pencil {

/// The number of modes computed at once.
inline constexpr std::size_t shape_lanes = revchain::detail::lanes_at_once;

/// Heights (or x with spins) of some modes, exact and rounded.
template <std::floating_point T>
struct RootsInLanes {
    std::array<DoubleWord<T>, shape_lanes> exact, rounded;
};

/// Offsets of pins 0 ... n in each lane, pin by pin, and their residuals.
template <std::floating_point T>
struct ShapesInLanes {
    static constexpr T least_offset{1e-290};
    std::span<T> offset;                         ///< (n + 1, shape_lanes); the largest is 1
    std::array<T, shape_lanes> residual;         ///< `relative_residual` as rounded
    std::array<bool, shape_lanes> found;         ///< true if the correction was small
    std::array<bool, shape_lanes> underflows;    ///< true if signs of neighbours need the ratios
    std::array<std::size_t, shape_lanes> twist;  ///< offsets use `down` below it, else `up`
    std::span<T> down, up;                       ///< (n, shape_lanes): ratios of neighbours
    std::span<T> below, above, rest, change;     ///< scratch

    /// Sets the sizes, not the numbers. There is one block, because the system takes several back.
    void make_room(std::size_t links) {
        const std::size_t each = links * shape_lanes, all = 7 * each + shape_lanes;
        if (all > size_) {
            numbers_ = std::make_unique_for_overwrite<T[]>(all), size_ = all;
            revchain::detail::will_be_filled(numbers_.get(), all * sizeof(T));
        }
        T* next = numbers_.get();
        offset = {next, each + shape_lanes}, next += offset.size();
        for (std::span<T>* part : {&down, &up, &below, &above, &rest, &change})
            *part = {next, each}, next += each;
    }
    /// Stores the first `pins` numbers of the first `count` lanes as rows `stride` numbers apart.
    void store_rows(T* rows, std::size_t stride, std::size_t pins, std::size_t count) const {
        constexpr std::size_t tile = 8;
        std::size_t m = 0;
        if (count == shape_lanes)
            for (; m + tile <= pins; m += tile)
                for (std::size_t i = 0; i < shape_lanes; ++i)
                    for (std::size_t k = 0; k < tile; ++k)
                        rows[i * stride + m + k] = offset[(m + k) * shape_lanes + i];
        for (; m < pins; ++m)
            for (std::size_t i = 0; i < count; ++i)
                rows[i * stride + m] = offset[m * shape_lanes + i];
    }
    /// Returns crossings of the mode in `lane` with offsets `row`, lowest first, without held pin.
    std::vector<Crossing<T>> crossings(std::size_t lane, const T* row) const {
        const std::size_t n = down.size() / shape_lanes;
        std::vector<Crossing<T>> crossed(n);
        std::size_t count = 0;
        for (std::size_t m = 0; m + 1 < n; ++m) {  // without branches, which are unpredictable here
            crossed[count].element = static_cast<Index>(m);
            count += (row[m] < T(0)) != (row[m + 1] < T(0)) ? 1 : 0;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const T *at = row + crossed[i].element, lower = at[0], upper = at[1];
            crossed[i].share = lower / (lower - upper);
        }
        crossed.resize(count);
        if (underflows[lane]) by_ratios(lane, row, crossed);
        return crossed;
    }

   private:
    void by_ratios(std::size_t lane, const T* row, std::vector<Crossing<T>>& crossed) const {
        using std::abs;
        crossed.clear();
        for (std::size_t m = 0; m + 1 < down.size() / shape_lanes; ++m) {
            const T lower = row[m], upper = row[m + 1];
            const T ratio =
                m < twist[lane] ? down[m * shape_lanes + lane] : up[m * shape_lanes + lane];
            const bool seen = std::min(abs(lower), abs(upper)) > least_offset;
            if (seen ? (lower < T(0)) == (upper < T(0)) : !(ratio < T(0))) continue;
            const T share = seen              ? lower / (lower - upper)
                            : m < twist[lane] ? ratio / (ratio - T(1))
                                              : T(1) / (T(1) - ratio);
            crossed.push_back({static_cast<Index>(m), share});
        }
    }

    std::unique_ptr<T[]> numbers_;
    std::size_t size_ = 0;
};

/// The largest number of links for which scratch is reused from call to call: 1.8 MB.
inline constexpr std::size_t most_kept_links = 4096;

/// Calls f with scratch that the thread reuses: allocating costs more than computing.
template <std::floating_point T, class F>
void with_shapes_in_lanes(std::size_t links, const F& f) {
    static thread_local ShapesInLanes<T> kept;
    if (links <= most_kept_links) {
        f(kept);
    } else {
        ShapesInLanes<T> own;
        f(own);
    }
}

namespace detail {

/// Vectors at some x in plain arithmetic, 1 at the pin where the lower and the upper part balance
/// best. Offsets below that pin are in `s.offset`; those above follow from `s.up`.
template <class V>
struct TwistInLanes {
    V pin, side;  ///< the pin, and the side of the axis of the free end
    V above;      ///< the number of eigenvalues above x, by rounded arithmetic
};
template <class Terms, bool Spins, class V, class T>
[[gnu::always_inline]] inline TwistInLanes<V> twisted_in_lanes(
    Terms, const ElementPencil<DoubleWord<T>, Spins>& pencil, const V& x, ShapesInLanes<T>& s) {
    constexpr std::size_t L = shape_lanes;
    constexpr bool lumped = Terms::lumped;
    const std::size_t n = pencil.elements.size();
    const V zero{}, one(T(1));
    const Factors<V> at = pencil.factors(x);
    // Stiffness below each pin is carried up, above it down; each loop runs while the other waits.
    V below{}, above{}, negative{};
    for (std::size_t m = 0; m < n; ++m) {
        const auto e = high_part(pencil.elements[m]);
        const Across<V> rise = across<V, lumped>(e, e.stiffness_at(at), below, e.lower, e.upper);
        negative = if_less(rise.inverse, zero, negative + one, negative);
        const std::size_t i = n - 1 - m;
        const auto f = high_part(pencil.elements[i]);
        const V k = f.stiffness_at(at);
        Across<V> sink{k - V(f.lower), zero};
        if (m > 0) {
            sink = across<V, lumped>(f, k, above, f.upper, f.lower);
            sink.inverse.store(&s.above[(i + 1) * L]);
        }
        above = sink.stiffness;
        sink.ratio.store(&s.up[i * L]);
        above.store(&s.change[i * L]);
        below.store(&s.rest[m * L]);
        rise.inverse.store(&s.below[m * L]);
        rise.ratio.store(&s.down[m * L]);
        below = rise.stiffness;
    }
    // The two stiffnesses balance best where the mode is largest.
    V least(std::numeric_limits<T>::infinity()), least_forces(T(1)), twist{}, from_link{};
    for (std::size_t m = 0; m < n; ++m) {
        const auto e = high_part(pencil.elements[m]);
        const V k = e.size(e.stiffness_at(at)), forces = from_link + (k + V(e.lower));
        const V balance = abs(V::load(&s.rest[m * L]) + V::load(&s.change[m * L]));
        const auto better = balance * least_forces < least * forces;
        least = select(better, balance, least);
        least_forces = select(better, forces, least_forces);
        twist = select(better, V(static_cast<T>(m)), twist);
        from_link = k + V(e.upper);
    }
    // Offsets are 1 at the twist and follow outwards by ratios.
    V y = one, side = one;  // signs are known even where offsets underflow
    for (std::size_t m = n; m-- > 0;) {
        const V at_pin(static_cast<T>(m)), ratio = V::load(&s.down[m * L]);
        y = if_less(at_pin, twist, ratio * y, one);
        side = if_less(at_pin, twist, if_less(ratio, zero, -side, side), one);
        y.store(&s.offset[m * L]);
    }
    zero.store(&s.offset[n * L]);
    return {twist, side, negative};
}

/// Returns the offset of pin m from `twisted_in_lanes`, in the order of pins; `last` is that of m -
/// 1.
template <class V, class T>
[[gnu::always_inline]] inline V next_offset(ShapesInLanes<T>& s, std::size_t m, const V& twist,
                                            const V& last) {
    V offset = V::load(&s.offset[m * shape_lanes]);
    if (m > 0)
        offset = if_less(twist, V(static_cast<T>(m)), V::load(&s.up[(m - 1) * shape_lanes]) * last,
                         offset);
    return offset;
}

template <class Where, class Terms, bool Spins, class T>
[[gnu::always_inline]] inline void shapes_in_lanes(
    Where, Terms terms, const ElementPencil<DoubleWord<T>, Spins>& pencil,
    const RootsInLanes<T>& roots, bool residuals, ShapesInLanes<T>& s) {
    constexpr bool fused = Where::fused;
    constexpr std::size_t width = std::min(Where::doubles, shape_lanes), L = shape_lanes;
    using V = Pack<T, width, L / width>;
    const std::size_t n = pencil.elements.size();
    V x, x_low, rounded, rounded_low;
    for (std::size_t i = 0; i < L; ++i) {
        x.set(i, roots.exact[i].high);
        x_low.set(i, roots.exact[i].low);
        rounded.set(i, roots.rounded[i].high);
        rounded_low.set(i, roots.rounded[i].low);
    }
    const V zero{}, one(T(1));
    const TwistInLanes<V> joined = twisted_in_lanes(terms, pencil, x, s);
    const V twist = joined.pin, side = joined.side;
    V y{};
    // A correction, 0 at the twist, balances the forces at all other pins.
    V load{};
    forces_left<fused, false, V>(
        terms, pencil, factors_in_pairs<fused, Spins>(x, x_low),
        [&](std::size_t m) REVCHAIN_INLINED {
            y = next_offset(s, m, twist, y);
            y.store(&s.offset[m * L]);
            return y;
        },
        [&](std::size_t m, const V& force, const V&, const V&, const V&) REVCHAIN_INLINED {
            if (m > 0) load = V::load(&s.down[(m - 1) * L]) * load;
            load -= force;
            if_less(V(static_cast<T>(m)), twist, load, -force).store(&s.change[m * L]);
        });
    V change{};
    for (std::size_t m = n; m-- > 0;) {
        const V at(static_cast<T>(m)), given = V::load(&s.change[m * L]);
        const V lower = given * V::load(&s.below[m * L]) + V::load(&s.down[m * L]) * change;
        const V upper = given + V::load(&s.up[m * L]) * change;
        change = if_less(at, twist, lower, if_less(twist, at, upper, zero));
        change.store(&s.change[m * L]);
    }
    V largest{}, largest_low{}, size{}, most{}, smallest(std::numeric_limits<T>::infinity());
    for (std::size_t m = 0; m < n; ++m) {
        const V at(static_cast<T>(m)), given = V::load(&s.change[m * L]);
        if (m > 0)
            change = if_less(
                twist, at, given * V::load(&s.above[m * L]) + V::load(&s.up[(m - 1) * L]) * change,
                given);
        else
            change = given;
        change.store(&s.change[m * L]);
        const V offset = V::load(&s.offset[m * L]);
        const auto larger = size < abs(offset);
        size = select(larger, abs(offset), size);
        largest = select(larger, offset, largest);
        largest_low = select(larger, change, largest_low);
        most = max(most, abs(change));
        smallest = min(smallest, abs(offset));
    }
    // Offsets are scaled by 1 over the largest, in twice the digits. The free end is positive.
    const DoubleWord<V> whole = fast_two_sum(largest, largest_low);
    V scale = one / whole.high;
    const DoubleWord<V> unit = two_product<fused>(whole.high, scale);
    V scale_low = scale * (((one - unit.high) - unit.low) - whole.low * scale);
    const V turn = if_less(side * scale, zero, -one, one);
    scale *= turn;
    scale_low *= turn;
    for (std::size_t m = 0; m < n; ++m) {
        const V offset = V::load(&s.offset[m * L]);
        const DoubleWord<V> scaled = two_product<fused>(offset, scale);
        const V rest = scaled.low + (offset * scale_low + V::load(&s.change[m * L]) * scale);
        ((scaled.high + rest) + zero).store(&s.offset[m * L]);
    }
    for (std::size_t i = 0; i < L; ++i) {
        s.found[i] = most[i] < T(0x1p-28) * size[i] && size[i] < T(1e200);
        s.underflows[i] = !(smallest[i] > ShapesInLanes<T>::least_offset * T(4) * size[i]);
        s.twist[i] = static_cast<std::size_t>(twist[i]);
    }
    if (!residuals) return;
    V worst{}, meeting{};
    forces_left<fused, true, V>(
        terms, pencil, factors_in_pairs<fused, Spins>(rounded, rounded_low),
        [&](std::size_t m) REVCHAIN_INLINED { return V::load(&s.offset[m * L]); },
        [&](std::size_t, const V& force, const V& sizes, const V&, const V&) REVCHAIN_INLINED {
            worst = max(worst, abs(force));
            meeting = max(meeting, sizes);
        });
    const V residual = worst / meeting;
    for (std::size_t i = 0; i < L; ++i) s.residual[i] = residual[i];
}

}  // namespace detail

/// Computes shapes at some roots and, on request, residuals, as accurate as `eigenvector` in double
/// words. `found` is false where the correction is not small; `eigenvector` can still compute those
/// shapes. Precondition: the pencil is in one unit. Cost: 5 ns a link and mode (AVX-512), residuals
/// 2.
template <std::floating_point T, bool Spins>
void shapes_in_lanes(const ElementPencil<DoubleWord<T>, Spins>& pencil, bool lumped,
                     const RootsInLanes<T>& roots, bool residuals, ShapesInLanes<T>& shapes) {
    shapes.make_room(pencil.elements.size());
    simd([&](auto where) REVCHAIN_INLINED {
        if (lumped)
            detail::shapes_in_lanes(where, detail::Terms<true>(), pencil, roots, residuals, shapes);
        else
            detail::shapes_in_lanes(where, detail::Terms<false>(), pencil, roots, residuals,
                                    shapes);
    });
}

}  // namespace revchain::pencil
