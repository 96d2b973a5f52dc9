// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <functional>

#include "revchain/numeric/progress.hpp"
#include "revchain/pencil/sturm.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// A bracket by count: lower < eigenvalue <= upper. `isolated`: no other eigenvalue shares it.
template <Real T>
struct Bracket {
    T lower{};
    T upper{};
    bool isolated = true;
};

/// Returns a mean of two positive numbers: the geometric mean if they differ by a factor above 4.
template <Real T>
T between(const T& lower, const T& upper) {
    using std::sqrt;
    return upper > T(4) * lower ? sqrt(lower) * sqrt(upper) : lower + (upper - lower) / T(2);
}

namespace detail {

/// An interval that holds the eigenvalues `first` ... `last - 1` (descending, from 0).
template <Real T>
struct Segment {
    T lower{}, upper{};
    Index first = 0, last = 0;
};

/// Returns an interval that holds the eigenvalues `first` ... `last - 1`, by counts from `guess`.
template <class Pencil, Real T>
Segment<T> enclose(const Pencil& pencil, Index first, Index last, T guess) {
    using std::ldexp;
    Segment<T> all{guess, guess, first, last};
    std::array<T, lanes> shifts;
    for (bool found = false; !found;) {  // search upwards, by factors of 4
        for (std::size_t i = 0; i < lanes; ++i)
            shifts[i] = all.upper = i == 0 ? all.upper : all.upper * T(4);
        const auto above = count_above(pencil, shifts);
        for (std::size_t i = 0; i < lanes && !found; ++i)
            if (above[i] <= first) {
                all.upper = shifts[i];
                found = true;
            } else {
                all.lower = shifts[i];
            }
        // The number overflowed, or the guess was not positive.
        if (!(all.upper > T(0) &&
              all.upper <= ldexp(T(1), std::numeric_limits<T>::max_exponent - 10)))
            return all;
    }
    all.lower = std::min(all.lower, all.upper / T(4));
    T ratio(4);  // search downwards, squaring the stride: the modes may lie far below
    for (bool found = false; !found;) {
        shifts[0] = all.lower;
        for (std::size_t i = 1; i < lanes; ++i) shifts[i] = shifts[i - 1] / ratio;
        const auto above = count_above(pencil, shifts);
        for (std::size_t i = 0; i < lanes && !found; ++i) {
            all.lower = shifts[i];
            found = above[i] >= last;
            if (above[i] <= first) all.upper = shifts[i];
        }
        if (ratio < T(256)) ratio = ratio * ratio;
        if (all.lower < std::numeric_limits<T>::min() * T(1e12)) break;
    }
    return all;
}

/// Writes the 2^levels - 1 inner points that halve (lower, upper) repeatedly, ascending.
template <Real T>
void subdivide(T* points, std::size_t count, const T& lower, const T& upper) {
    if (count == 0) return;
    const std::size_t half = count / 2;
    points[half] = between(lower, upper);
    subdivide(points, half, lower, points[half]);
    subdivide(points + half + 1, half, points[half], upper);
}

/// Cuts `segment` at the shifts, and calls `keep(piece)` for each piece that holds eigenvalues.
template <Real T, class Keep>
void split(const Segment<T>& segment, const T* shifts, const Index* above, std::size_t count,
           Keep keep) {
    T lower = segment.lower;
    Index last = segment.last;
    for (std::size_t c = 0; c <= count; ++c) {
        const T upper = c < count ? shifts[c] : segment.upper;
        // Rounding may shift counts within a few ulp; clamping keeps the pieces nested.
        const Index first = c < count ? std::clamp(above[c], segment.first, last) : segment.first;
        if (last > first) keep(Segment<T>{lower, upper, first, last});
        lower = upper;
        last = first;
    }
}

}  // namespace detail

/// Returns brackets of `count` eigenvalues from number `first` on (from 0, descending). Each is no
/// wider than a relative `tolerance` or a few ulp; shared brackets are bisected further, down to a
/// few ulp. `pencil` needs a `count_above` for `lanes` shifts, which limits the accuracy.
/// `finished(done)` receives the number found after every pass, and may throw. Preconditions: first
/// >= 0; count >= 1; first + count <= number of finite eigenvalues; tolerance >= 0; guess > 0.
/// Cost: about log2(1/tolerance) passes for every `lanes` eigenvalues.
template <class Pencil, Real T>
std::vector<Bracket<T>> bisect(const Pencil& pencil, Index first, Index count, T tolerance, T guess,
                               const std::function<void(Index)>& finished = {}) {
    const T finest = T(4) * epsilon<T>();
    std::vector<Bracket<T>> brackets(static_cast<std::size_t>(count));
    std::vector<detail::Segment<T>> work{detail::enclose(pencil, first, first + count, guess)}, now;
    std::array<T, lanes> shifts;
    shifts.fill(guess);
    Index done = 0;
    const auto keep = [&](const detail::Segment<T>& s) {
        const T width = s.upper - s.lower;
        const bool alone = s.last - s.first == 1;
        const T middle = between(s.lower, s.upper);
        const bool divisible = s.lower < middle && middle < s.upper;  // false for some subnormals
        if (divisible && width > finest * s.lower && (width > tolerance * s.lower || !alone)) {
            work.push_back(s);
        } else {
            for (Index j = s.first; j < s.last; ++j)
                brackets[static_cast<std::size_t>(j - first)] = {s.lower, s.upper, alone};
            done += s.last - s.first;
        }
    };
    while (!work.empty()) {
        revchain::detail::check_interrupt();
        const std::size_t taken = std::min(lanes, work.size());
        now.assign(work.end() - static_cast<std::ptrdiff_t>(taken), work.end());
        work.resize(work.size() - taken);
        // One segment is cut into 8 parts, two segments into 4 each, to fill all lanes.
        const std::size_t cuts = taken == 1 ? 7 : taken == 2 ? 3 : 1;
        for (std::size_t i = 0; i < taken; ++i)
            detail::subdivide(&shifts[i * cuts], cuts, now[i].lower, now[i].upper);
        const auto above = count_above(pencil, shifts);
        for (std::size_t i = 0; i < taken; ++i)
            detail::split(now[i], &shifts[i * cuts], &above[i * cuts], cuts, keep);
        if (finished) finished(done);
    }
    return brackets;
}

}  // namespace revchain::pencil
