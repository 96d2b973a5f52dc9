// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "revchain/pencil/condensed/transfer.hpp"
#include "revchain/pencil/sturm.hpp"
#include "revchain/pencil/twisted.hpp"

namespace revchain::inline REVCHAIN_BUILD::pencil {

/// A run of links condensed to its two end pins, exact up to rounding and truncation. It is a
/// spring between the pins and a mass at each, which depend on mu = 1/lambda. With z = -mu and
/// t = 1 + b1 z + b2 z^2 + ... the spring and the two masses are
///
///     lambda k / t + cross,    (lower + a1 z + ...) / t,    (upper + d1 z + ...) / t.
///
/// The leading numbers are in `Wide<T>`. The rest, smaller by mu (mass)/(stiffness), is in T.
template <Real T>
struct Block {
    static constexpr std::size_t degree = 6;
    Wide<T> stiffness{}, lower{}, upper{};
    Wide<T> cross{};  ///< off-diagonal mass of a single link; its spring may be negative
    std::array<T, degree> b{};
    std::array<T, degree - 1> a{}, d{};
    Index links = 0;
};

/// Blocks, lowest first; the upper pin of the last is held. Valid for lambda >= `least_shift`.
template <Real T>
struct CondensedPencil {
    std::vector<Block<T>> blocks;
    T least_shift{};
    /// Bound on the relative difference to the exact chain's eigenvalues: docs/theory/blocks.md.
    T error{};
};

/// The dynamic stiffness lambda K - M of a block at one shift,
///
///     spring [ 1 -1 ; -1 1 ]  -  [ lower 0 ; 0 upper ].
template <class S>
struct LumpedElement {
    S spring{}, lower{}, upper{};
};

namespace detail {

/// Returns a number of `Wide<T>` in S, which is a scalar or pack of T, or a double word of one.
template <class S, class W>
[[gnu::always_inline]] inline S spread(const W& x) {
    if constexpr (IsPack<S>) {
        return S(static_cast<Lane<S>>(x));
    } else if constexpr (revchain::detail::is_double_word<S> &&
                         revchain::detail::is_double_word<W>) {
        using N = Narrow<S>;
        return {N(x.high), N(x.low)};
    } else {
        return static_cast<S>(x);
    }
}

template <class N, class T, std::size_t Count>
[[gnu::always_inline]] inline N horner(const std::array<T, Count>& coefficient, const N& z) {
    N value(coefficient[Count - 1]);
    for (std::size_t i = Count - 1; i-- > 0;) value = N(coefficient[i]) + z * value;
    return z * value;
}

}  // namespace detail

/// Returns the block's dynamic stiffness at a shift in S: T, `Wide<T>`, packs of T or double words
/// of packs, one shift a lane. The corrections are small and evaluated in T.
template <class S, Real T>
[[gnu::always_inline]] inline LumpedElement<S> element_at(const Block<T>& block, const S& shift) {
    using N = Narrow<S>;
    const N z = N(T(-1)) / static_cast<N>(shift);
    const N series = detail::horner(block.b, z);
    const S change(-series / (N(T(1)) + series));  // 1/t - 1
    const S stiffness = shift * detail::spread<S>(block.stiffness);
    const S lower = detail::spread<S>(block.lower) + S(detail::horner(block.a, z));
    const S upper = detail::spread<S>(block.upper) + S(detail::horner(block.d, z));
    return {stiffness + stiffness * change + detail::spread<S>(block.cross), lower + lower * change,
            upper + upper * change};
}

/// Returns elements of all blocks. Cost: 7 ns per block in packs of doubles, 35 in double words.
template <class S, Real T>
std::vector<LumpedElement<S>> elements_at(const CondensedPencil<T>& pencil, const S& shift) {
    std::vector<LumpedElement<S>> elements(pencil.blocks.size());
    simd([&](auto) REVCHAIN_INLINED {
        for (std::size_t m = 0; m < elements.size(); ++m)
            elements[m] = element_at<S>(pencil.blocks[m], shift);
    });
    return elements;
}

/// Returns the number of eigenvalues above each shift >= least_shift. Cost: 15 ns a block (8
/// shifts).
template <Real T, std::size_t L>
std::array<Index, L> count_above(const CondensedPencil<T>& pencil, const std::array<T, L>& shifts) {
    using V = Pack<T>;
    return simd([&](auto) REVCHAIN_INLINED {
        constexpr std::size_t packs = (L + pack_size - 1) / pack_size;
        std::array<V, packs> shift, below{}, negative{};
        for (std::size_t i = 0; i < packs * pack_size; ++i)
            shift[i / pack_size].set(i % pack_size, shifts[std::min(i, L - 1)]);
        for (const Block<T>& block : pencil.blocks)
            for (std::size_t i = 0; i < packs; ++i) {
                const LumpedElement<V> e = element_at<V>(block, shift[i]);
                const V hung = below[i] - e.lower;
                const V sum = e.spring + hung;
                const V pivot = if_equal(sum, V{}, e.spring * (epsilon<T>() * epsilon<T>()), sum);
                negative[i] += if_less(pivot, V{}, V(T(1)), V{});
                below[i] = e.spring * (hung / pivot) - e.upper;
            }
        std::array<Index, L> result;
        for (std::size_t i = 0; i < L; ++i)
            result[i] = static_cast<Index>(negative[i / pack_size][i % pack_size]);
        return result;
    });
}

/// Counts at the shifts of a pack of double words, as numbers of T. `proved` is 1 or 0.
template <class V>
struct CertifiedCounts {
    V above{}, proved{};
};

/// Returns the count with a running bound on the rounding error, for the chain of exactly these
/// blocks. `proved` is as in sturm.hpp, with fewer terms, because elements change with the shift
/// and have no cross mass. The loop of sturm.hpp would need more lines. Cost: 40 ns per block for
/// four shifts.
template <Real T>
CertifiedCounts<Pack<T>> certified_count(const CondensedPencil<T>& pencil,
                                         const DoubleWord<Pack<T>>& shift) {
    using V = Pack<T>;
    using S = DoubleWord<V>;
    return simd([&](auto) REVCHAIN_INLINED {
        const T unit = T(2) * operation_error<DoubleWord<T>>();
        const T inflate = T(1) + T(16) * epsilon<T>();
        const T underflow = std::numeric_limits<T>::min() * T(4);
        const V zero{}, one(T(1));
        S below{};
        V error{};
        CertifiedCounts<V> result{zero, one};
        for (const Block<T>& block : pencil.blocks) {
            const LumpedElement<S> e = element_at<S>(block, shift);  // while the division waits
            const S hung = below - e.lower;
            const S pivot = hung + e.spring;
            const V spring = abs(e.spring.high), size = abs(pivot.high);
            const V hung_error = (error + unit * abs(hung.high)) * inflate + underflow;
            const V least = size * (T(1) - T(4) * epsilon<T>());
            const V least_with_below = least - hung_error;
            result.proved = if_less(zero, least_with_below, result.proved, zero);
            result.above += if_less(pivot.high, zero, one, zero);
            const S carried = e.spring * (hung / pivot);  // a pivot of 0 leaves the count unproved
            below = carried - e.upper;
            error = inflate * ((spring / least) * (spring / least_with_below) * hung_error +
                               (T(3) * unit) * abs(carried.high) + unit * abs(below.high)) +
                    underflow;
        }
        return result;
    });
}

/// Returns offsets of the pins between blocks, free end first, the held pin last (0), from the
/// elements at an eigenvalue in each lane. The offset is 1 at the pin where upper and lower part
/// balance best. S is a pack, or a double word of one. Cost for four modes: 30 ns per block in
/// packs of doubles, 150 in double words of packs; `eigenvector` of one mode would take 2.8 times
/// as long.
template <class S>
std::vector<S> offsets_between(const std::vector<LumpedElement<S>>& elements) {
    using V = Narrow<S>;
    using T = Lane<V>;
    return simd([&](auto) REVCHAIN_INLINED {
        const auto across = [](const S& spring, const S& hung, const S& far) REVCHAIN_INLINED {
            const S sum = spring + hung;
            const V tiny = static_cast<V>(spring) * (epsilon<T>() * epsilon<T>());
            const S ratio = spring / (sum + S(if_equal(static_cast<V>(sum), V{}, tiny, V{})));
            return detail::Across<S>{ratio * hung - far, ratio};
        };
        const auto rise = [&](std::size_t m, const S& below) REVCHAIN_INLINED {
            const LumpedElement<S>& e = elements[m];
            return across(e.spring, below - e.lower, e.upper);
        };
        const auto sink = [&](std::size_t m, const S& above) REVCHAIN_INLINED {
            const LumpedElement<S>& e = elements[m];
            if (m + 1 == elements.size()) return detail::Across<S>{e.spring - e.lower, S{}};
            return across(e.spring, above - e.upper, e.lower);
        };
        const auto forces = [&](std::size_t m) REVCHAIN_INLINED {
            const V own = static_cast<V>(elements[m].spring) + static_cast<V>(elements[m].lower);
            if (m == 0) return own;
            return own +
                   (static_cast<V>(elements[m - 1].spring) + static_cast<V>(elements[m - 1].upper));
        };
        return detail::twisted<S>(elements.size(), rise, sink, forces).offset;
    });
}

template <class S>
struct Improved {
    S shift{};
    Narrow<S> change{};
};

/// Makes one step of Newton's method on  y^T (lambda K - M) y = 0  in each lane, with y the twisted
/// vector at `shift`. Next to a single eigenvalue it cubes the error. S is the accuracy of the
/// form's sum: a pack or a double word of one. Cost: 100 to 200 ns per block.
template <class S, Real T>
Improved<S> improved(const CondensedPencil<T>& pencil, const S& shift) {
    using V = Pack<T>;
    const V at = static_cast<V>(shift), step = at * T(1e-5);
    const std::vector<V> offset = offsets_between(elements_at(pencil, at));
    const std::vector<LumpedElement<S>> here = elements_at(pencil, shift);
    const std::vector<LumpedElement<V>> there = elements_at(pencil, at + step);
    return simd([&](auto) REVCHAIN_INLINED {
        // The form at the shift is in S; its derivative follows from a second value, in T.
        S form{};
        V ahead{};
        for (std::size_t m = 0; m < here.size(); ++m) {
            const V lower = offset[m], upper = offset[m + 1], stretched = lower - upper;
            const S stretch = S(lower) - S(upper);
            const LumpedElement<S>& e = here[m];
            const S inertia = S(lower) * S(lower) * e.lower + S(upper) * S(upper) * e.upper;
            form = form + (stretch * stretch * e.spring - inertia);
            const LumpedElement<V>& f = there[m];
            ahead += f.spring * stretched * stretched -
                     (f.lower * lower * lower + f.upper * upper * upper);
        }
        const S change = form / S((ahead - static_cast<V>(form)) / step);
        return Improved<S>{shift - change, -static_cast<V>(change)};
    });
}

}  // namespace revchain::pencil
