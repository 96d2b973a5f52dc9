// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <optional>

#include "revchain/pencil/bisection.hpp"
#include "revchain/pencil/twisted.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// An eigenvalue and its relative error bound, proved by two counts; infinite if there is no proof.
template <Real T>
struct Certified {
    T eigenvalue{};
    T error_bound = std::numeric_limits<T>::infinity();
    Wide<T> unrounded{};  ///< the value before rounding, at which the eigenvector is computed
};

/// Returns true if counts at both ends of an interval prove that it holds eigenvalue number `j`.
inline bool bracketed(const std::array<CertifiedCount, 2>& count, Index j) {
    return count[0].proved && count[1].proved && count[0].above > j && count[1].above <= j;
}

/// Returns true if root number `j` (from 0, descending) is proved to lie within a relative `margin`
/// of `centre`. `count(two shifts)` returns certified counts of the roots above them.
template <Real S, class Count>
bool root_within(const Count& count, Index j, const S& centre, const Narrow<S>& margin) {
    const S reach = centre * S(margin);
    return bracketed(count(std::array<S, 2>{centre - reach, centre + reach}), j);
}

/// Returns true if eigenvalue number `j` of the exact pencil is proved to lie within a relative
/// `margin` of `eigenvalue`. Cost: one pass of two shifts in S.
template <Real S, Real T>
bool lies_within(const ElementPencil<S>& pencil, Index j, const T& eigenvalue,
                 const Narrow<S>& margin) {
    const auto count = [&](const std::array<S, 2>& shifts) {
        return certified_count(pencil, shifts);
    };
    return root_within(count, j, S(static_cast<Narrow<S>>(eigenvalue)), margin);
}

/// Returns the bound that `lies_within` proves, relative to the exact eigenvalue, with all
/// roundings.
template <Real S, Real T>
T bound_of_margin(const T& margin) {
    return margin * (T(1) + T(2) * margin + T(4) * epsilon<T>()) +
           T(4) * static_cast<T>(operation_error<S>());
}

template <Real S>
struct ProvedInterval {
    S lower, upper;
    S middle() const { return lower + (upper - lower) / S(Narrow<S>(2)); }
    /// Returns the largest possible distance of the root from `x`, relative to the root.
    Narrow<S> reach(const S& x) const {
        using M = Narrow<S>;
        const M worst = std::max(static_cast<M>(x - lower), static_cast<M>(upper - x));
        return worst / static_cast<M>(lower) * (M(1) + M(8) * epsilon<M>());
    }
};

/// Returns a proved interval of eigenvalue number `j`, or nothing. Its relative width is `finest`,
/// or the least possible in S. `count(two shifts)` returns certified counts. Cost: about 60 calls.
template <Real S, class Count>
std::optional<ProvedInterval<S>> proved_interval(const Count& count, Index j, const S& guess,
                                                 const Narrow<S>& finest) {
    using M = Narrow<S>;
    S lower = guess, upper = guess;
    bool has_lower = false, has_upper = false;
    for (M margin = M(32) * finest; !(has_lower && has_upper); margin = margin * M(16)) {
        if (margin > M(1e6)) return std::nullopt;
        const S stretch = S(M(1)) + S(margin);
        const std::array<CertifiedCount, 2> ends = count({guess / stretch, guess * stretch});
        if (!has_lower && ends[0].proved && ends[0].above > j)
            lower = guess / stretch, has_lower = true;
        if (!has_upper && ends[1].proved && ends[1].above <= j)
            upper = guess * stretch, has_upper = true;
    }
    for (bool moved = true;
         moved && static_cast<M>(upper - lower) > finest * static_cast<M>(lower);) {
        const S third = (upper - lower) / S(M(3));
        const std::array<S, 2> shifts{lower + third, upper - third};
        const std::array<CertifiedCount, 2> inner = count(shifts);
        moved = false;
        for (std::size_t i = 0; i < 2; ++i) {
            if (!inner[i].proved) continue;
            if (inner[i].above > j && shifts[i] > lower) lower = shifts[i], moved = true;
            if (inner[i].above <= j && shifts[i] < upper) upper = shifts[i], moved = true;
        }
    }
    return ProvedInterval<S>{lower, upper};
}

/// Returns eigenvalue number `j` by proved counts alone, for use if a faster certificate fails. The
/// bound is infinite if 1/2 is not proved (seen where weights span 1e37 and lengths 1e23 together).
template <Real S, Real T>
Certified<T> bisect_certified(const ElementPencil<S>& pencil, Index j, const T& guess) {
    using M = Narrow<S>;
    const auto count = [&](const std::array<S, 2>& shifts) {
        return certified_count(pencil, shifts);
    };
    const M finest = static_cast<M>(epsilon<T>()) / M(4);
    Certified<T> result{guess};
    if (const auto found = proved_interval(count, j, S(static_cast<M>(guess)), finest)) {
        result.eigenvalue = static_cast<T>(found->middle());
        const M worst = found->reach(S(static_cast<M>(result.eigenvalue)));
        if (worst <= M(0.5)) result.error_bound = bound_of_margin<S>(static_cast<T>(worst));
    }
    result.unrounded = Wide<T>(static_cast<Narrow<Wide<T>>>(result.eigenvalue));
    return result;
}

/// Returns eigenvalue number `j` (from 0, descending) to 2 ulp. `start` must be nearer to it than
/// to any other. The result is the Rayleigh quotient in S of the vector in T, proved by two counts.
/// If that fails, proved counts alone find it.
template <Real S, Real T>
Certified<T> certified_eigenvalue(const ElementPencil<S>& wide, const ElementPencil<T>& rounded,
                                  Index j, const T& start) {
    // One or two rounds suffice: the quotient's error is the square of the vector's. If S is T,
    // rounding limits the proof, and the margin grows by factors of 2.
    T margin = T(2) * epsilon<T>() * (T(1) - T(32) * epsilon<T>());  // at most 2 ulp with roundings
    T eigenvalue = start;
    S fine(static_cast<Narrow<S>>(start));
    for (int round = 0; round < (std::is_same_v<S, T> ? 24 : 2); ++round) {
        if (round < 2) fine = rayleigh_quotient<S>(wide, eigenvector(rounded, eigenvalue).offset);
        eigenvalue = static_cast<T>(fine);
        if (lies_within<S>(wide, j, eigenvalue, static_cast<Narrow<S>>(margin)))
            return {eigenvalue, bound_of_margin<S>(margin), fine};
        if constexpr (std::is_same_v<S, T>) margin = margin * T(2);
    }
    return bisect_certified<S>(wide, j, start);
}

}  // namespace revchain::pencil
